//! The core kernels, each made ready to be called again and again, for the benches that count and bound them.
//!
//! Skin against aluminium over 536 bands (715 to 1250 cm⁻¹), surroundings at 20 °C. Every call gets
//! another temperature than the call before, so that nothing may be kept from it.

use crate::made_up::{counts, library};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::multi::LocalMatrix;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::identifiability::ratio::RatioLaw;
use hadar::planck::{photon_radiance_and_slope_into, photon_radiance_difference_into};
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::{Cell, Request, Window, information};
use hadar::ranging::noise::{Joined, NoiseVariance};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_simulate::draws::{Draws, generator};
use std::hint::black_box;

/// Names of the kernels, in the order of the tables.
#[allow(dead_code, reason = "not every bench names them all")]
pub(crate) const NAMES: [&str; 8] = [
    "planck spectrum",
    "planck difference",
    "local pair",
    "local matrix",
    "nearest",
    "window information",
    "exact error",
    "poisson draws",
];

/// Bands of the spectra, samples of the cube.
pub(crate) const BANDS: usize = 536;
pub(crate) const CUBE: [usize; 3] = [32, 64, 54];

/// How many materials a matrix has: what its name says, or 30.
pub(crate) fn materials(name: &str) -> usize {
    name.rsplit(' ').next().and_then(|count| count.parse().ok()).unwrap_or(30)
}

/// What the kernels work on.
pub(crate) struct Scene {
    bands: Bands,
    surroundings: Surroundings,
    unknowns: Unknowns,
    skin: Vec<f64>,
    robot: Vec<f64>,
    state: State,
}

impl Scene {
    pub(crate) fn new() -> Self {
        let bands = Bands::uniform(715.0, 1250.0, 1.0).expect("valid bands");
        let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).expect("valid surroundings");
        let place = |nu: f64| (nu - 985.0) / 265.0;
        let robot = |&nu: &f64| 0.49287 - 0.0782 * place(nu) + 0.00892 * place(nu) * place(nu);
        Self {
            unknowns: Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).expect("distinct"),
            skin: vec![0.95; bands.len()],
            robot: bands.nodes_cm1().iter().map(robot).collect(),
            state: surroundings.state(310.15, &[0.5]).expect("valid state"),
            bands,
            surroundings,
        }
    }

    /// One call of a kernel; `call` counts them.
    pub(crate) fn kernel(&self, name: &str) -> Option<Box<dyn FnMut(usize) + '_>> {
        let nu = self.bands.nodes_cm1();
        let spectrum = || vec![0.0; BANDS];
        let at = |call: usize| State { temperature_k: 310.15 + (call % 2) as f64, ..self.state.clone() };
        Some(match name {
            "planck spectrum" => {
                let (mut value, mut slope) = (spectrum(), spectrum());
                Box::new(move |call| {
                    photon_radiance_and_slope_into(nu, 300.0 + call as f64, &mut value, &mut slope);
                    black_box(&value);
                })
            }
            "planck difference" => {
                let (mut base, mut slope, mut out) = (spectrum(), spectrum(), spectrum());
                photon_radiance_and_slope_into(nu, 300.0, &mut base, &mut slope);
                Box::new(move |call| {
                    photon_radiance_difference_into(nu, 300.0, 1.0 + call as f64, &base, &mut out);
                    black_box(&out);
                })
            }
            "local pair" => {
                let mut solver = LocalSolver::new(&self.bands, &self.surroundings, self.unknowns.clone());
                let states = [at(0), at(1)];
                Box::new(move |call| {
                    let state = &states[call % 2];
                    black_box(
                        solver.per_photon(&self.skin, &self.robot, state, f64::INFINITY).expect("sound"),
                    );
                })
            }
            "local matrix" | "local matrix of 300" | "local matrix of 1000" => {
                let library = library(nu, materials(name));
                let mut matrix = LocalMatrix::new(&self.bands, &self.surroundings, self.unknowns.clone());
                let states = [at(0), at(1)];
                Box::new(move |call| {
                    let materials: Vec<&[f64]> = library.iter().map(Vec::as_slice).collect();
                    black_box(matrix.per_photon(&materials, &states[call % 2]).expect("sound"));
                })
            }
            "nearest" => {
                let range = StateRange::default();
                let mut solver =
                    NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), range);
                let state = at(0);
                Box::new(move |_| {
                    black_box(
                        solver.per_photon(&self.skin, &self.robot, &state, f64::INFINITY).expect("sound"),
                    );
                })
            }
            "window information" => {
                let cube = cube();
                Box::new(move |_| {
                    let request = Request {
                        window: Window::new(5, 5).expect("odd"),
                        derivative: Derivative::Central,
                        noise: &NoiseVariance::None,
                        joined: Joined::SumOfReadings,
                        cells: &Cell::ALL,
                        centres: 0..usize::MAX,
                    };
                    black_box(information(&cube, &request).expect("sound"));
                })
            }
            "exact error" => {
                let means = self.means();
                Box::new(move |_| {
                    let law = RatioLaw::new(&means[0], &means[1], &Statistics::Poisson).expect("two states");
                    black_box(law.accuracy());
                })
            }
            "poisson draws" => {
                let [means, _] = self.means();
                let draws = Draws::new(&Statistics::Poisson, &means).expect("means to draw about");
                let mut counts = spectrum();
                Box::new(move |call| {
                    draws.draw_into(&mut generator(1, call as u64), &mut counts);
                    black_box(&counts);
                })
            }
            _ => return None,
        })
    }

    /// Mean counts of the person and of the nearest robot, 1.2763e6 photons in all: d = 1.
    fn means(&self) -> [Vec<f64>; 2] {
        let signal = |emissivity: &[f64], temperature_k: f64, lighting: f64| {
            let state = self.surroundings.state(temperature_k, &[lighting]).expect("valid state");
            self.surroundings.signal(emissivity, &state)
        };
        let [person, other] = [signal(&self.skin, 310.15, 0.5), signal(&self.robot, 355.951, 0.1867)];
        let counts = 1.2763e6 / person.iter().sum::<f64>();
        [person, other].map(|signal| signal.iter().map(|s| s * counts).collect())
    }
}

/// A cube with strong texture.
fn cube() -> Cube {
    let [rows, columns, bands] = CUBE;
    let shape = Shape::new(rows, columns, bands).expect("a shape");
    let samples = counts(shape.len(), bands);
    Cube::from(MemoryCube::new(shape, samples).expect("as many samples as the shape has"))
}
