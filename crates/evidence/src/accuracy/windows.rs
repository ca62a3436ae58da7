//! Information of windows by derivative scheme: counts A(1 + c sin ωx) along a row, the same in every band.
//!
//! The exact derivative is Aωc cos ωx, so that J of a window is a sum that no scheme enters. The finer the texture, the
//! more each scheme misses. Windows within a quarter of the row of its ends are left out: what a scheme makes of the
//! ends is told where the schemes are (`hadar::ranging::derivative`).

use super::chart::{Chart, Measured};
use super::timing::{Budget, seconds_of};
use super::{Item, Order};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::error::Result;
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::{Cell, Request, Window, information};
use hadar::ranging::noise::{Joined, NoiseVariance};
use std::f64::consts::TAU;

const ROWS: usize = 9;
const COLUMNS: usize = 512;
const BANDS: usize = 8;
const SIDE: usize = 5;
const COUNTS: f64 = 1e4;
const CONTRAST: f64 = 0.2;
/// Cycles per pixel.
const FREQUENCIES: [f64; 9] = [0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3, 0.4];
/// What scenes are looked at with where nothing else is asked for.
const DEFAULT: Derivative = Derivative::CubicSpline;

pub(super) fn measure(order: Order) -> Result<Chart> {
    let shape = Shape::new(ROWS, COLUMNS, BANDS)?;
    let samples = shape.len() as f64;
    let noise = NoiseVariance::None;
    let mut measured = Vec::new();
    for derivative in Derivative::ALL {
        for frequency in order.some(&FREQUENCIES) {
            let omega = TAU * frequency;
            let row = |x: usize| COUNTS * (1.0 + CONTRAST * (omega * x as f64 + 0.3).sin());
            let counts = (0..shape.len()).map(|i| row(i / BANDS % COLUMNS)).collect();
            let cube = Cube::from(MemoryCube::<f64>::new(shape, counts)?);
            let request = Request {
                window: Window::new(SIDE, SIDE)?,
                derivative,
                noise: &noise,
                joined: Joined::SumOfReadings,
                cells: &[Cell::Full],
                centres: 0..usize::MAX,
            };
            let map = information(&cube, &request)?;
            let exact = |x: usize| {
                let slope = COUNTS * CONTRAST * omega * (omega * x as f64 + 0.3).cos();
                slope * slope / row(x)
            };
            let mut worst: f64 = 0.0;
            for (i, column) in map.columns.clone().enumerate() {
                if (COLUMNS / 4..3 * COLUMNS / 4).contains(&column) {
                    let half = SIDE / 2;
                    let sum: f64 = (column - half..=column + half).map(exact).sum();
                    let truth = (SIDE * BANDS) as f64 * sum;
                    worst = worst.max((map.cell(Cell::Full)[i] / truth - 1.0).abs());
                }
            }
            let seconds = seconds_of(Budget::of(order.quick), || information(&cube, &request)) / samples;
            let one = Measured::new(derivative.name(), frequency, seconds, worst);
            let question = format!("{frequency} cycles per pixel");
            measured.push(one.answering(question).default_if(derivative == DEFAULT));
        }
    }
    Ok(Chart {
        name: Item::Windows.name(),
        title: "Information of windows by derivative scheme",
        timed: "one sample of a heat cube",
        effort: "texture (cycles per pixel)",
        error: "relative error of the information of a 5 x 5 window, worst of a row",
        reference: "closed form of a sinusoid",
        measured,
        remark: "Scenes take cubic splines, cubes read from files the central difference, whose noise is the least; the \
                 texture is the scene's, not a knob. The Fourier derivative is better still far from the ends of the row, \
                 but rings near them."
            .into(),
    })
}
