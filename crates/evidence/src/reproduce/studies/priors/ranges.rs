//! The nearest distance for ever narrower ranges of the alternative's state.

use super::photons::Task;
use hadar::error::Result;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::material::Library;
use hadar_report::table::Table;

/// Nearest distance in one range of the alternative's state.
pub(super) struct Ranged {
    pub(super) cells: [String; 2],
    pub(super) found: Vec<[String; 3]>,
}

/// Aluminium and glass, ever less free in temperature and lighting.
pub(super) fn ranges(task: &Task, library: &Library) -> Result<Vec<Ranged>> {
    let scene = &task.scene;
    let glass = library.get("soda-lime-glass")?.emissivity(scene.bands.nodes_cm1())?;
    let state = scene.state(37.0, 0.5)?;
    let own = state.temperature_k;
    let physical = StateRange::default();
    let mut rows = Vec::new();
    for (text, temperature_k) in [
        ("all that physics allows", physical.temperature_k),
        ("250 to 450 K", [250.0, 450.0]),
        ("273 to 323 K", [273.0, 323.0]),
        ("target ± 5 K", [own - 5.0, own + 5.0]),
        ("target ± 1 K", [own - 1.0, own + 1.0]),
    ] {
        for (lit, lighting) in [("0 to 1", [0.0, 1.0]), ("0.4 to 0.6", [0.4, 0.6])] {
            let range = StateRange { temperature_k, lighting, ..physical };
            let mut found = Vec::new();
            for other in [&task.aluminium, &glass] {
                let mut solver =
                    NearestSolver::new(&scene.bands, &scene.surroundings, scene.unknowns.clone(), range);
                let nearest = solver.per_photon(&task.skin, other, &state, f64::INFINITY)?;
                found.push([
                    format!("{:.2e}", nearest.distance),
                    format!("{:.2e}", nearest.distance.powi(-2)),
                    format!(
                        "{:.1} °C, {:.3}",
                        nearest.state.temperature_k - 273.15,
                        nearest.state.lighting.first().copied().unwrap_or(0.0)
                    ),
                ]);
            }
            rows.push(Ranged { cells: [text.into(), lit.into()], found });
        }
    }
    Ok(rows)
}

/// The table of the page.
pub(super) fn range_cells(rows: &[Ranged]) -> Vec<Vec<String>> {
    rows.iter().map(|row| row.cells.iter().chain(row.found.iter().flatten()).cloned().collect()).collect()
}

/// The same as a file.
pub(super) fn ranges_csv(rows: &[Ranged]) -> Result<String> {
    let mut table = Table::new([
        "temperature_range",
        "lighting_range",
        "nearest_aluminium_per_sqrt_photon",
        "photons_aluminium",
        "nearest_state_aluminium",
        "nearest_glass_per_sqrt_photon",
        "photons_glass",
        "nearest_state_glass",
    ]);
    range_cells(rows).into_iter().for_each(|row| table.push(row));
    table.to_csv()
}
