//! How far apart are two materials if neither temperature nor lighting is known, and how many photons tell them apart?
//!
//!     cargo run --release --example nearest_distance [TARGET.csv ALTERNATIVE.csv]
//!
//! A file has a wavenumber (cm⁻¹) and an emissivity in each row. Without files it takes skin and aluminium: 8.85e-4 per
//! √photon and 1.28e6 photons, as `hadar size examples/human_vs_robot.toml` has them.

use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::detection::probability;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::material::Library;
use hadar::policy::photons_required;
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;

fn main() -> hadar::Result<()> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let (target, other) = match files.as_slice() {
        [target, other] => (
            hadar_formats::spectra::material(target.as_ref())?,
            hadar_formats::spectra::material(other.as_ref())?,
        ),
        _ => {
            let library = Library::embedded()?;
            (library.get("skin")?.clone(), library.get("aluminium")?.clone())
        }
    };

    // 536 bands of 1 cm⁻¹. The target is at 37 °C; surroundings at 20 °C fill half of what it sees, cold sky the rest.
    let bands = Bands::uniform(715.0, 1250.0, 1.0)?;
    let room = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![room])?;
    let state = surroundings.state(310.15, &[0.5])?;

    // The alternative may be at any temperature and in any lighting.
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
    let mut solver = NearestSolver::new(&bands, &surroundings, unknowns, StateRange::default());
    let spectra = [target.emissivity(bands.nodes_cm1())?, other.emissivity(bands.nodes_cm1())?];
    let nearest = solver.per_photon(&spectra[0], &spectra[1], &state, f64::INFINITY)?;

    println!("{} against {}: {:.2e} per √photon", target.name(), other.name(), nearest.distance);
    let celsius = nearest.state.temperature_k - 273.15;
    println!("most alike with {} at {celsius:.1} °C, V = {:.3}", other.name(), nearest.state.lighting[0]);
    match photons_required(1.0, nearest.distance) {
        Some(photons) => println!("{photons:.3e} photons for {:.1} % right", 100.0 * probability(1.0)),
        None => println!("no number of photons distinguishes them"),
    }
    Ok(())
}
