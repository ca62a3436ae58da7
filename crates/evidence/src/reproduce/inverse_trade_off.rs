//! What the paper says of its inverse functions in words: resolution against noise (supplement, after S47).
//!
//! Its own scene: one of the surroundings, S = e·B(T) + (1 − e)·V₀·B(T₀), quartz at 310 K, V₀ = 0.5, T₀ = 293.15 K; 720 to 1250 cm⁻¹ in bands
//! of ever smaller width that leave no gap. The photons of a pixel are the same in all of them, so that those of a band go with its width.
//! Noise by first order ([`hadar_estimate::decompose::inverse_error`]), bias from spectra without noise, both together from drawn ones.

use super::ledger::{Line, Verdict};
use super::order::Order;
use super::pixels::{RANGE_K, rms};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::error::Result;
use hadar::fisher::precision::PrecisionSolver;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::material::Library;
use hadar::planck::photon_radiance;
use hadar::scene::{EnvironmentObject, Parameter, Surroundings};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_estimate::decompose::{Light, Method, Options, Setting, decompose_by, inverse_error};
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Series, Style};
use hadar_report::table::{Table, markdown};
use hadar_simulate::draws::{Draws, generator};

const MATERIAL: &str = "quartz";
const TARGET_K: f64 = 310.0;
const LIGHTING: f64 = 0.5;
const AMBIENT_K: f64 = 293.15;
/// Widths of the bands that divide the range, cm⁻¹.
const STEPS_CM1: [f64; 9] = [0.5, 1.0, 2.0, 5.0, 10.0, 26.5, 53.0, 106.0, 132.5];
const START_CM1: f64 = 720.0;
const STOP_CM1: f64 = 1250.0;
/// Photons of a pixel, and spectra that are drawn.
const PHOTONS: f64 = 1e8;
const DRAWN: usize = 200;

pub(super) struct TradeOff {
    pub(super) plot: Plot,
    pub(super) lines: Vec<Line>,
    pub(super) text: String,
}

/// Errors at one width of the bands, K, with [`PHOTONS`].
#[derive(Debug, Clone, Copy)]
struct Row {
    step_cm1: f64,
    bands: usize,
    bias_k: f64,
    sigma_k: f64,
    pair_sigma_k: f64,
    drawn_k: f64,
    bound_k: f64,
}

impl Row {
    /// Root mean square error with so many photons.
    fn total_k(&self, photons: f64) -> f64 {
        self.bias_k.hypot(self.sigma_k * (PHOTONS / photons).sqrt())
    }
}

pub(super) fn make(order: Order) -> Result<TradeOff> {
    let library = Library::embedded()?;
    let rows =
        STEPS_CM1.iter().enumerate().map(|(i, step)| row(&library, *step, order.seed, (i * DRAWN) as u64));
    let rows = rows.collect::<Result<Vec<_>>>()?;
    Ok(TradeOff { plot: plot(&rows), lines: lines(&rows), text: text(&rows) })
}

fn row(library: &Library, step_cm1: f64, seed: u64, stream: u64) -> Result<Row> {
    let count = ((STOP_CM1 - START_CM1) / step_cm1).round() as usize;
    let edge = |i: usize| START_CM1 + i as f64 * step_cm1;
    let ranges: Vec<(f64, f64)> = (0..count).map(|i| (edge(i), edge(i + 1))).collect();
    let bands = Bands::from_ranges(&ranges)?;
    let nodes = bands.nodes_cm1();
    let emissivity = library.get(MATERIAL)?.emissivity(nodes)?;
    let ambient = EnvironmentObject { temperature_k: AMBIENT_K, emissivity: None };
    let surroundings = Surroundings::new(nodes, vec![ambient])?;
    let state = surroundings.state(TARGET_K, &[LIGHTING])?;
    let signal = bands.weigh(&surroundings.signal(&emissivity, &state));
    let counts_per_radiance = PHOTONS / signal.iter().sum::<f64>();
    let means: Vec<f64> = signal.iter().map(|s| counts_per_radiance * s).collect();
    let light = Light::Radiance(nodes.iter().map(|nu| photon_radiance(*nu, AMBIENT_K)).collect());
    let setting = Setting {
        bands: &bands,
        library: std::slice::from_ref(&emissivity),
        surroundings: std::slice::from_ref(&light),
        counts_per_radiance: &vec![counts_per_radiance; bands.len()],
        var_added: &[],
        units_per_count: 1.0,
        temperature_k: RANGE_K,
        lighting_total: None,
        gain: false,
        bad_bands: &[],
        path: None,
        light_besides: &[],
    };
    // The first pixel without noise.
    let draws = Draws::new(&Statistics::Poisson, &means)?;
    let mut counts = means.clone();
    for i in 0..DRAWN as u64 {
        let mut drawn = vec![0.0; bands.len()];
        draws.draw_into(&mut generator(seed, stream + i), &mut drawn);
        counts.extend(drawn);
    }
    let cube = Cube::F64(Box::new(MemoryCube::new(Shape::new(DRAWN + 1, 1, bands.len())?, counts)?));
    let maps = decompose_by(Method::AnalyticInverse, &setting, &Options::default(), &cube, &|_| ())?;
    let off: Vec<f64> = maps.temperature_k.iter().map(|k| f64::from(*k) - TARGET_K).collect();
    let error = inverse_error(&setting, 0, TARGET_K, &[LIGHTING])?;
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
    let counting = Counting { counts_per_radiance, var_added: Vec::new() };
    let mut solver = PrecisionSolver::new(&bands, &surroundings, unknowns);
    let bound = solver.bound(&emissivity, &state, &counting, Parameter::Temperature)?;
    Ok(Row {
        step_cm1,
        bands: bands.len(),
        bias_k: off[0],
        sigma_k: error.sigma_k,
        pair_sigma_k: error.pair_sigma_k,
        drawn_k: rms(off[1..].iter().copied()),
        bound_k: bound.sigma,
    })
}

/// The width of the least error with so many photons.
fn best(rows: &[Row], photons: f64) -> Option<&Row> {
    rows.iter().min_by(|a, b| a.total_k(photons).total_cmp(&b.total_k(photons)))
}

fn plot(rows: &[Row]) -> Plot {
    let mut table = Table::new([
        "band_width_cm1",
        "bands",
        "bias_k",
        "noise_error_k",
        "noise_error_best_pair_k",
        "drawn_rmse_k",
        "cramer_rao_k",
    ]);
    for row in rows {
        let errors = [row.bias_k, row.sigma_k, row.pair_sigma_k, row.drawn_k, row.bound_k];
        table.push_numbers(&[[row.step_cm1, row.bands as f64].as_slice(), &errors].concat());
    }
    let x: Vec<f64> = rows.iter().map(|row| row.step_cm1).collect();
    let line =
        |label: &str, pick: fn(&Row) -> f64| Series::line(label, x.clone(), rows.iter().map(pick).collect());
    let figure = LineFigure::new(
        "Inverse functions: what resolution gives and takes",
        Axis::log("width of a band (cm⁻¹)"),
        Axis::log("temperature error (K)"),
    )
    .subtitle(format!(
        "Quartz at 310 K, surroundings at 293 K, V = 0.5; {PHOTONS:.0e} photons over 720 to 1250 cm⁻¹."
    ))
    .series(line("bias: what S46 leaves out", |row| row.bias_k.abs()).colour(0))
    .series(line("noise of all differences together", |row| row.sigma_k).colour(1))
    .series(
        line("noise of the best pair of bands alone", |row| row.pair_sigma_k).style(Style::Dashed).colour(1),
    )
    .series(
        Series::points("drawn spectra", x.clone(), rows.iter().map(|row| row.drawn_k).collect()).colour(2),
    )
    .series(line("Cramér–Rao bound", |row| row.bound_k).style(Style::Dashed).colour(6));
    Plot { name: "inverse_trade_off".into(), figure: figure.into(), table }
}

fn lines(rows: &[Row]) -> Vec<Line> {
    let place = "S46, S47";
    let at = |step: f64| rows.iter().find(|row| row.step_cm1 == step);
    let (Some(fine), Some(one), Some(ten)) = (rows.first(), at(1.0), at(10.0)) else { return Vec::new() };
    let Some(least) = best(rows, f64::INFINITY) else { return Vec::new() };
    let holds = |holds: bool| if holds { Verdict::UnderAChoice } else { Verdict::NotReproduced };
    let grows = (one.pair_sigma_k / ten.pair_sigma_k).log10();
    let step = |photons: f64| best(rows, photons).map_or(f64::NAN, |row| row.step_cm1);
    vec![
        Line::new(
            place,
            "noise of the best difference of two bands, bands of 1 cm^-1 over those of 10",
            "suffers from noise due to differentiation",
            format!("{:.1} times ({:.2} and {:.3} K)", 10f64.powf(grows), one.pair_sigma_k, ten.pair_sigma_k),
            holds(grows > 1.0),
            "expected 10^1.5 where the emissivity is resolved; 1e8 photons in all bands",
        ),
        Line::new(
            place,
            "the same of all differences together, weighted by their noise",
            "suffers from noise due to differentiation",
            format!(
                "{:.2} times; {:.2} times the Cramér–Rao bound at 1 cm^-1",
                one.sigma_k / ten.sigma_k,
                one.sigma_k / one.bound_k
            ),
            holds(one.sigma_k > 2.0 * ten.sigma_k),
            "neighbouring differences share a band with opposite signs, so that in a weighted sum over the spectrum the noise cancels",
        ),
        Line::new(
            place,
            "resolution of the least error at 1e4, 1e6, 1e8 photons of a pixel, cm^-1",
            "1 or below desired",
            format!("{}, {}, {}", step(1e4), step(1e6), step(1e8)),
            holds(step(1e8) <= 1.0),
            format!(
                "the bias is {:.2} K at {} cm^-1, {:.2} K at 1 and {:.2} K at 10; least at {} cm^-1",
                fine.bias_k, fine.step_cm1, one.bias_k, ten.bias_k, least.step_cm1
            ),
        ),
        Line::new(
            place,
            "error that no light removes at 1 cm^-1, K",
            "approximately only S and e survive the derivative",
            format!("{:.2}", one.bias_k.abs()),
            holds(one.bias_k.abs() < 1.0),
            format!(
                "the slopes of B(T) and B(T0) along wavenumber that S46 leaves out; the bound at 1e8 photons is {:.3} K",
                one.bound_k
            ),
        ),
    ]
}

fn text(rows: &[Row]) -> String {
    let cells = |row: &Row| {
        let kelvin = [row.bias_k, row.sigma_k, row.pair_sigma_k, row.drawn_k].map(|k| format!("{k:.3}"));
        let bound = format!("{:.4}", row.bound_k);
        std::iter::once(row.step_cm1.to_string()).chain(kelvin).chain([bound])
    };
    let head = [
        "band, cm^-1",
        "bias, K",
        "noise, K",
        "noise of the best pair alone, K",
        "drawn, K rms",
        "Cramér–Rao bound, K",
    ];
    let text = "The inverse functions S46 and S47, which the paper calls a trade-off of resolution and noise without computing it, quartz known, \
                1e8 photons of a pixel:\n\n";
    text.to_owned() + &markdown(&head, rows.iter().map(cells))
}
