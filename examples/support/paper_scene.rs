//! What the programs that make reports share: the paper's scene, the readings of a distance, tables in Markdown.

#![allow(dead_code, reason = "every program uses a part of it")]

use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::report::plot::Series;
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::simulate::decision::DecisionScene;
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;

/// Bands amid surroundings at 20 °C; temperature and lighting of every material are unknown.
#[derive(Clone)]
pub struct PaperScene {
    pub bands: Bands,
    pub surroundings: Surroundings,
    pub unknowns: Unknowns,
    pub range: StateRange,
}

/// One pair by all readings, per √photon of the target.
pub struct Distances {
    pub local: f64,
    pub local_unknown_gain: f64,
    pub nearest: f64,
    pub nearest_state: State,
    /// From the nearest state back to the target's material, at the same exposure.
    pub back: f64,
    /// ΣS of the target, photons s⁻¹ m⁻² sr⁻¹.
    pub photon_radiance: f64,
}

impl Distances {
    /// Exposure at which the target sends so many photons that √N d_nearest = `distance`: N and κ.
    pub fn photons_at(&self, distance: f64) -> (f64, f64) {
        let photons = (distance / self.nearest).powi(2);
        (photons, photons / self.photon_radiance)
    }
}

impl PaperScene {
    pub fn new(bands: Bands) -> hadar::Result<Self> {
        let ambient = EnvironmentObject { temperature_k: 293.15, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![ambient])?;
        let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
        let range = StateRange { temperature_k: [250.0, 450.0], ..StateRange::default() };
        Ok(Self { bands, surroundings, unknowns, range })
    }

    pub fn state(&self, celsius: f64, lighting: f64) -> hadar::Result<State> {
        self.surroundings.state(celsius + 273.15, &[lighting])
    }

    /// Signal of every band.
    pub fn signal(&self, emissivity: &[f64], state: &State) -> Vec<f64> {
        self.bands.weigh(&self.surroundings.signal(emissivity, state))
    }

    pub fn distances(&self, target: &[f64], other: &[f64], state: &State) -> hadar::Result<Distances> {
        let local = |unknowns| {
            let mut solver = LocalSolver::new(&self.bands, &self.surroundings, unknowns);
            solver.per_photon(target, other, state, f64::INFINITY).map(|found| found.distance)
        };
        let photon_radiance: f64 = self.signal(target, state).iter().sum();
        let per_photon = Counting { counts_per_radiance: 1.0 / photon_radiance, var_added: Vec::new() };
        let solver =
            || NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), self.range);
        let nearest = solver().with_counting(target, other, state, &per_photon)?;
        let back = solver().with_counting(other, target, &nearest.state, &per_photon)?;
        Ok(Distances {
            local: local(self.unknowns.clone())?,
            local_unknown_gain: if self.bands.len() > 3 {
                local(self.unknowns.with(Nuisance::Gain))?
            } else {
                f64::NAN
            },
            nearest: nearest.distance,
            nearest_state: nearest.state,
            back: back.distance,
            photon_radiance,
        })
    }

    pub fn decisions<'a>(
        &'a self,
        counts_per_radiance: f64,
        statistics: &'a Statistics,
    ) -> DecisionScene<'a> {
        DecisionScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            unknowns: &self.unknowns,
            range: self.range,
            counts_per_radiance,
            statistics,
        }
    }
}

/// A table in Markdown.
pub fn markdown<S: AsRef<str>>(header: &[&str], rows: &[Vec<S>]) -> String {
    let line = |cells: Vec<&str>| format!("| {} |\n", cells.join(" | "));
    let mut text = line(header.to_vec()) + &line(vec!["---"; header.len()]);
    rows.iter().for_each(|row| text.push_str(&line(row.iter().map(AsRef::as_ref).collect())));
    text
}

/// Whether `--quick` is among the arguments, and the others.
pub fn arguments() -> (bool, Vec<String>) {
    let (quick, others): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|argument| argument == "--quick");
    (!quick.is_empty(), others)
}

/// Ends a program.
pub fn end(result: hadar::Result<()>) -> std::process::ExitCode {
    match result {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// Upright strokes from `low` to `high`, with gaps between them.
pub fn bars(label: &str, x: &[f64], low: &[f64], high: &[f64]) -> Series {
    let xs = x.iter().flat_map(|&x| [x, x, f64::NAN]).collect();
    let ys = low.iter().zip(high).flat_map(|(&low, &high)| [low, high, f64::NAN]).collect();
    Series::line(label, xs, ys)
}
