//! Tables S4 and S5: what resolution is worth, without noise and with a detector's.

use super::ledger::{Line, Verdict};
use super::order::{Figures, Made};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::error::Result;
use hadar::instrument::presets;
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::{Cell, Request, Window, information};
use hadar::ranging::noise::{Joined, NoiseVariance};
use hadar::words::significant;
use hadar_report::bundle::Bundle;
use hadar_report::range;
use hadar_report::table::{Table, number};
use std::f64::consts::PI;

/// Bands and photons per pixel and band of the paper's camera before a blackbody at 30 °C.
const BANDS: usize = 536;
const COLUMNS: usize = 24;

pub(super) fn make() -> Result<Made> {
    let camera = presets::get("flir-a325sc")?;
    let figures = camera.figures()?;
    let photons = figures.photons / figures.bands as f64;
    let var = figures.noise_counts * figures.noise_counts;
    // One texture in all bands, and one that turns with the band.
    let common = cube(photons, |_| 0.0)?;
    let turning = cube(photons, |band| 1.5 * PI * band as f64 / BANDS as f64)?;
    let mut table = Table::new([
        "texture",
        "noise",
        "joined_samples",
        "neither_per_px2",
        "spatial_per_px2",
        "spectral_per_px2",
        "both_per_px2",
    ]);
    let mut found = Vec::new();
    for (texture, cube) in [("common to all bands", &common), ("turning with the band", &turning)] {
        for (noise, variance) in
            [("shot noise", NoiseVariance::None), ("flir-a325sc", NoiseVariance::Uniform(var))]
        {
            for joined in Joined::ALL {
                let request = Request {
                    window: Window::new(5, 5)?,
                    derivative: Derivative::Central,
                    noise: &variance,
                    joined,
                    cells: &Cell::ALL,
                    centres: 0..5,
                };
                let map = information(cube, &request)?;
                let middle = map.columns.len() / 2;
                let cells = Cell::ALL.map(|cell| map.cell(cell).get(middle).copied().unwrap_or(f64::NAN));
                let mut row = vec![texture.to_owned(), noise.to_owned(), joined.name().to_owned()];
                row.extend(cells.map(number));
                table.push(row);
                found.push((texture, noise, joined, cells));
            }
        }
    }
    let cells = |texture: &str, noise: &str, joined: Joined| {
        let same =
            |row: &&(&str, &str, Joined, [f64; 4])| row.0 == texture && row.1 == noise && row.2 == joined;
        found.iter().find(same).map_or([f64::NAN; 4], |row| row.3)
    };
    let gain = |texture: &str, noise: &str, joined: Joined| {
        let [_, spatial, _, both] = cells(texture, noise, joined);
        both / spatial
    };
    let ordered = |[neither, spatial, spectral, both]: [f64; 4]| {
        const ROUNDING: f64 = 1.0 + 1e-12;
        neither <= spatial * ROUNDING
            && neither <= spectral * ROUNDING
            && spatial.max(spectral) <= both * ROUNDING
    };
    let shot = [
        cells("common to all bands", "shot noise", Joined::SumOfReadings),
        cells("turning with the band", "shot noise", Joined::SumOfReadings),
    ];
    let yes = |holds: bool| if holds { "yes" } else { "no" };
    let lost = gain("common to all bands", "flir-a325sc", Joined::OneReading);
    let won = gain("turning with the band", "flir-a325sc", Joined::OneReading);
    let lines = vec![
        Line::new(
            "Tables S4, S5",
            "no cell exceeds one with more resolution (shot noise)",
            "proved there",
            yes(shot.into_iter().all(ordered)),
            if shot.into_iter().all(ordered) { Verdict::Reproduced } else { Verdict::NotReproduced },
            "Cauchy-Schwarz; two textures here, random cubes in the tests",
        ),
        Line::new(
            "Tables S4, S5",
            "spectral resolution gives more information, texture common to 536 bands, noise of flir-a325sc in every reading",
            "more",
            format!(
                "{} times as much ({} = 1/536)",
                significant(lost, 3),
                significant(1.0 / BANDS as f64, 3)
            ),
            Verdict::PaperInError,
            "true for a fixed gamma alone: 536 readings have 536 times the noise of one",
        ),
        Line::new(
            "not in the paper",
            "the same for a texture that turns by three quarters of a cycle over the bands",
            "-",
            format!("{} times as much", significant(won, 3)),
            Verdict::NotInThePaper,
            "joined bands wash it out, bands apart do not; without noise the gain would be the larger of the two",
        ),
    ];
    let mut bundle = Bundle::default();
    bundle.add_table("cells.csv", table)?;
    bundle.add_plots(&[range::derivative_errors()?])?;
    let pictures = vec![("derivatives.png", "Error of derivatives on textures of known frequency")];
    Ok((bundle, lines, Figures { pictures, text: String::new() }))
}

/// Five rows with a texture along x of 2 % contrast, of a phase by band.
fn cube(photons: f64, phase: impl Fn(usize) -> f64) -> Result<Cube> {
    let mut samples = Vec::with_capacity(5 * COLUMNS * BANDS);
    for _ in 0..5 {
        for x in 0..COLUMNS {
            for band in 0..BANDS {
                samples.push(photons * (1.0 + 0.02 * (0.7 * x as f64 + phase(band)).sin()));
            }
        }
    }
    Ok(Cube::from(MemoryCube::new(Shape::new(5, COLUMNS, BANDS)?, samples)?))
}
