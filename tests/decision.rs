//! Decisions by Monte Carlo against what was found independently, against limits, and against the bounds.

use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::material::{Extrapolation, Library};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::simulate::decision::DecisionScene;
use hadar::simulate::sequential::Plan;
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use std::path::Path;

/// The authors' 54 channels with surroundings at 20 °C.
struct Published {
    bands: Bands,
    surroundings: Surroundings,
    library: Library,
}

impl Published {
    fn read() -> Option<Self> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/hadar-library/emissivity_54.csv");
        if !path.is_file() {
            println!("skipped: no {}", path.display());
            return None;
        }
        let mut library = Library::empty();
        library.add_file(&path).unwrap();
        let bands = Bands::uniform(720.0, 1250.0, 10.0).unwrap();
        let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
        Some(Self { bands, surroundings, library })
    }
    fn material(&self, name: &str) -> Vec<f64> {
        self.library.get(name).unwrap().clone().with_extrapolation(Extrapolation::Hold).emissivity(self.bands.nodes_cm1()).unwrap()
    }
    fn state(&self) -> State {
        self.surroundings.state(310.15, &[0.5]).unwrap()
    }
}

#[test]
fn explore() {
    let Some(p) = Published::read() else { return };
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    for (target, other, photons, most) in [("human", "al", 1e6, 1.0), ("al", "human", 1e6, 1.0), ("human", "crystal-glass", 6000.0, 3.0), ("human", "crystal-glass", 385.0, 1.0)] {
        let range = StateRange { lighting: [0.0, most], lighting_sum: most, ..StateRange::default() };
        let (a, b) = (p.material(target), p.material(other));
        let signal: f64 = p.bands.weigh(&p.surroundings.signal(&a, &p.state())).iter().sum();
        let scene = DecisionScene { bands: &p.bands, surroundings: &p.surroundings, unknowns: &unknowns, range, counts_per_radiance: photons / signal, statistics: &Statistics::Poisson };
        let start = std::time::Instant::now();
        let r = scene.balanced((&a, &b), &p.state(), &Plan::new(1, 0.005, 200_000).unwrap()).unwrap();
        let t = start.elapsed().as_secs_f64();
        println!("{target} {other} {photons}: d {:.4} {:?} P {:.4} {:?} classes {:.4} {:.4} trials {} unconv {} {}  {:.1} us per trial", r.distance, r.alternative_state, r.probability, r.interval, r.classes[0].probability, r.classes[1].probability, r.classes[0].trials, r.classes[0].unconverged, r.classes[1].unconverged, t * 1e6 / (2.0 * r.classes[0].trials as f64));
        let known = scene.known_states((&a, &p.state()), (&b, &r.alternative_state), &Plan::new(1, 0.005, 200_000).unwrap()).unwrap();
        println!("   known {:.4} {:?} vs {:.4}", known.probability, known.interval, hadar::identifiability::detection::probability(known.distance));
    }
}
