//! Does a trained classifier come to the limit of telling a person from a robot?
//!
//!     cargo run --release --example classifier_against_limit
//!
//! Three bands, photons for a distance of 1, the robot in the state that looks most like the person: no classifier is right
//! more often than Φ(1) = 84.1 %, and the likelihood ratio, which knows both spectra, is as often.

use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::detection::probability;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::material::Library;
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_simulate::classifier::Method;
use hadar_simulate::draws::Draws;
use hadar_simulate::experiment::{Design, Experiment};

fn main() -> hadar::Result<()> {
    let bands = Bands::from_ranges(&[(715.0, 895.0), (895.0, 1070.0), (1070.0, 1250.0)])?;
    let library = Library::embedded()?;
    let skin = library.get("skin")?.emissivity(bands.nodes_cm1())?;
    let aluminium = library.get("aluminium")?.emissivity(bands.nodes_cm1())?;
    let room = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![room])?;
    let person = surroundings.state(310.15, &[0.5])?;
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
    let mut solver = NearestSolver::new(&bands, &surroundings, unknowns, StateRange::default());
    let nearest = solver.per_photon(&skin, &aluminium, &person, f64::INFINITY)?;

    // Mean counts of both, with an exposure that gives √N·d₀ = 1 for the N photons of the person.
    let photons = nearest.distance.powi(-2);
    let radiance = |emissivity: &[f64], state| bands.weigh(&surroundings.signal(emissivity, state));
    let spectra = [radiance(&skin, &person), radiance(&aluminium, &nearest.state)];
    let exposure = photons / spectra[0].iter().sum::<f64>();
    let means = spectra.map(|spectrum| spectrum.iter().map(|s| exposure * s).collect::<Vec<f64>>());

    let statistics = Statistics::Poisson;
    let draws = [Draws::new(&statistics, &means[0])?, Draws::new(&statistics, &means[1])?];
    let experiment =
        Experiment { draws: &draws, means: &means, statistics: &statistics, best_fits: None, trained: &[] };
    let methods = vec![Method::LikelihoodRatio, Method::Discriminant, Method::Logistic];
    let design = Design { per_class: 40_000, methods, seed: 1, level: 0.95, skip_spectra: false };
    println!("limit Φ(1) of {photons:.2e} photons: {:.2} % right", 100.0 * probability(1.0));
    for found in experiment.run(&design)?.0 {
        let [low, high] = [found.interval.low, found.interval.high].map(|share| 100.0 * share);
        println!("{}: {:.2} % ({low:.2} to {high:.2} %)", found.words(), 100.0 * found.accuracy);
    }
    Ok(())
}
