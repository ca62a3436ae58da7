//! Can this camera tell a person from a robot, and which pixel or detector could?
//!
//!     cargo run --release --example size_a_camera
//!
//! d = 0.0569 where 1 is demanded; pixels of 50.3 µm would do, or an electronic noise of 1.01e5 counts, but no lens: as
//! `hadar size examples/human_vs_robot.toml` says.

use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::instrument::{View, presets};
use hadar::material::Library;
use hadar::policy::{CameraTask, Quantity, Trial};
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;

fn main() -> hadar::Result<()> {
    let camera = presets::get("flir-a325sc")?;
    let bands = camera.received(&Bands::uniform(715.0, 1250.0, 1.0)?);
    let library = Library::embedded()?;
    let skin = library.get("skin")?.emissivity(bands.nodes_cm1())?;
    let aluminium = library.get("aluminium")?.emissivity(bands.nodes_cm1())?;
    let room = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![room])?;
    let person = surroundings.state(310.15, &[0.5])?;

    // Temperature and lighting unknown; a trial is the camera with one of its figures changed.
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
    let mut solver = NearestSolver::new(&bands, &surroundings, unknowns, StateRange::default());
    let mut distance = |trial: &Trial| {
        let counting = trial.camera.counting(&bands, &View::at(trial.distance_m));
        Ok(solver.with_counting(&skin, &aluminium, &person, &counting)?.distance)
    };

    let task = CameraTask {
        camera: &camera,
        bands: &bands,
        required: 1.0,
        distance_m: Some(30.0),
        farthest_m: None,
        size_m: None,
        of_object: false,
    };
    println!(
        "{}: statistical distance d = {:.4}, demanded {}",
        camera.name,
        distance(&task.own())?,
        task.required
    );
    for (quantity, what, unit, scale) in [
        (Quantity::Pixel, "pixel", "µm", 1e6),
        (Quantity::FNumber, "f-number", "", 1.0),
        (Quantity::Noise, "noise", "counts per reading", 1.0),
    ] {
        let found = task.solve(quantity, &mut distance)?;
        match (found.value, found.reason) {
            (Some(value), _) => {
                println!("{what}: {:.4} {unit} (now {:.4})", scale * value, scale * found.camera);
            }
            (None, why) => println!("{what}: none suffices: {}", why.unwrap_or_default()),
        }
    }
    Ok(())
}
