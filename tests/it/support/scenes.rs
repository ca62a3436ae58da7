//! Random scenes for property tests, and the heat signal written down once more, independently of the crate.

use hadar::fisher::{Nuisance, Unknowns};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use num_dual::DualNum;
use proptest::prelude::*;

/// A smooth spectrum in (0, 1): a level and six cosines over 700–1300 cm⁻¹ that stay within it.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    level: f64,
    waves: Vec<(f64, f64)>,
}

impl Curve {
    pub(crate) fn at(&self, nu_cm1: f64) -> f64 {
        let t = (nu_cm1 - 700.0) / 600.0;
        let total: f64 = self.waves.iter().map(|wave| wave.0.abs()).sum::<f64>().max(1e-3);
        let reach = 0.95 * self.level.min(1.0 - self.level);
        let wave = self.waves.iter().enumerate().map(|(k, (amplitude, phase))| {
            amplitude / total * (std::f64::consts::PI * (k + 1) as f64 * t + phase).cos()
        });
        self.level + reach * wave.sum::<f64>()
    }

    pub(crate) fn on(&self, nodes_cm1: &[f64]) -> Vec<f64> {
        nodes_cm1.iter().map(|&nu| self.at(nu)).collect()
    }
}

pub(crate) fn curve() -> impl Strategy<Value = Curve> {
    (0.05..0.95, proptest::collection::vec((-1.0..1.0, 0.0..6.3), 6))
        .prop_map(|(level, waves)| Curve { level, waves })
}

/// An environment object as it was drawn.
#[derive(Debug, Clone)]
pub(crate) struct Object {
    pub temperature_k: f64,
    pub lighting: f64,
    pub emissivity: Option<Curve>,
}

/// What a scene is made of, so that it can be made again on other bands.
#[derive(Debug, Clone)]
pub(crate) struct Recipe {
    pub start_cm1: f64,
    pub step_cm1: f64,
    pub count: usize,
    pub target: Curve,
    pub other: Curve,
    pub temperature_k: f64,
    pub objects: Vec<Object>,
}

/// A scene on its bands.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub bands: Bands,
    pub surroundings: Surroundings,
    pub state: State,
    pub emissivity: Vec<f64>,
    pub alternative: Vec<f64>,
}

impl Recipe {
    /// Band centres.
    pub(crate) fn centers(&self) -> Vec<f64> {
        (0..self.count).map(|i| self.start_cm1 + i as f64 * self.step_cm1).collect()
    }

    /// The scene with one node per band.
    pub(crate) fn scene(&self) -> Scene {
        self.on(Bands::from_rows(self.centers().into_iter().map(|nu| (nu, self.step_cm1))).unwrap())
    }

    /// The same scene seen in other bands.
    pub(crate) fn on(&self, bands: Bands) -> Scene {
        let nodes = bands.nodes_cm1();
        let objects = self.objects.iter().map(|object| EnvironmentObject {
            temperature_k: object.temperature_k,
            emissivity: object.emissivity.as_ref().map(|curve| curve.on(nodes)),
        });
        let surroundings = Surroundings::new(nodes, objects.collect()).unwrap();
        let lighting: Vec<f64> = self.objects.iter().map(|object| object.lighting).collect();
        let state = surroundings.state(self.temperature_k, &lighting).unwrap();
        let (emissivity, alternative) = (self.target.on(nodes), self.other.on(nodes));
        Scene { bands, surroundings, state, emissivity, alternative }
    }

    /// The same scene with black surroundings.
    pub(crate) fn black(mut self) -> Self {
        self.objects.iter_mut().for_each(|object| object.emissivity = None);
        self
    }
}

prop_compose! {
    /// 5 to 600 bands between 700 and 1300 cm⁻¹, one or two objects that together leave some cold sky.
    pub fn recipe()(
        count in prop_oneof![5usize..20, 20usize..600],
        span in 0.5..1.0,
        shift in 0.0..1.0,
        target in curve(),
        other in curve(),
        temperature_k in 250.0..400.0,
        drawn in proptest::collection::vec((250.0..400.0, 0.05..0.95, proptest::option::of(curve())), 1..3),
        lit in 0.1..0.95,
    ) -> Recipe {
        let width = 600.0 * span;
        let total: f64 = drawn.iter().map(|object| object.1).sum();
        let objects = drawn.into_iter().map(|(temperature_k, share, emissivity)| Object {
            temperature_k,
            lighting: lit * share / total,
            emissivity,
        });
        Recipe {
            start_cm1: 700.0 + shift * (600.0 - width),
            step_cm1: width / (count - 1) as f64,
            count,
            target,
            other,
            temperature_k,
            objects: objects.collect(),
        }
    }
}

/// The sets of nuisances, each holding the one before; as many as `bands` bands can bear.
pub(crate) fn ever_more_unknowns(bands: usize, objects: usize) -> Vec<Unknowns> {
    (0..=4)
        .map(|count| Unknowns::new(Nuisance::ALL.into_iter().take(count)).unwrap())
        .filter(|unknowns| unknowns.parameters(objects).len() < bands)
        .collect()
}

/// Photon radiance 2cν²/(eˣ − 1) per cm⁻¹, ν in cm⁻¹, of any number that can be differentiated.
pub(crate) fn radiance<D: DualNum<Primitive = f64> + Copy>(nu_cm1: f64, temperature_k: D) -> D {
    let x = temperature_k.recip() * (1.438_776_877_503_933_8 * nu_cm1);
    x.exp_m1().recip() * (2.0 * 299_792_458.0 * 1e6 * nu_cm1 * nu_cm1)
}

/// What the heat signal at one node depends on.
#[derive(Debug, Clone)]
pub(crate) struct Inputs<D> {
    pub mixing: D,
    pub temperature_k: D,
    pub lighting: Vec<D>,
    pub gain: D,
    pub environment_k: Vec<D>,
}

impl<D: DualNum<Primitive = f64> + Copy> Inputs<D> {
    pub(crate) fn of(state: &State) -> Self {
        Self {
            mixing: D::from(0.0),
            temperature_k: D::from(state.temperature_k),
            lighting: state.lighting.iter().map(|&v| D::from(v)).collect(),
            gain: D::from(state.gain),
            environment_k: state.environment_k.iter().map(|&t| D::from(t)).collect(),
        }
    }

    /// G·[e B(T) + (1 − e) Σ Vₖ εₖ B(Tₖ)] with e = (1 − g) e₁ + g e₂.
    pub(crate) fn signal(&self, nu_cm1: f64, e1: f64, e2: f64, objects: &[Option<f64>]) -> D {
        let e = (D::from(1.0) - self.mixing) * e1 + self.mixing * e2;
        let lit = (0..objects.len()).fold(D::from(0.0), |sum, k| {
            sum + self.lighting[k] * radiance(nu_cm1, self.environment_k[k]) * objects[k].unwrap_or(1.0)
        });
        self.gain * (e * radiance(nu_cm1, self.temperature_k) + (D::from(1.0) - e) * lit)
    }
}

impl Scene {
    /// εₖ at node j.
    pub(crate) fn objects_at(&self, j: usize) -> Vec<Option<f64>> {
        self.surroundings.objects().iter().map(|o| o.emissivity.as_ref().map(|e| e[j])).collect()
    }

    /// The signal (or its derivative, with dual numbers) at every node.
    pub(crate) fn signal<D: DualNum<Primitive = f64> + Copy>(&self, inputs: &Inputs<D>) -> Vec<D> {
        let nodes = self.surroundings.nodes_cm1();
        (0..nodes.len())
            .map(|j| inputs.signal(nodes[j], self.emissivity[j], self.alternative[j], &self.objects_at(j)))
            .collect()
    }

    /// Signal of a surface in a state, band by band (one node each), by the formula above.
    pub(crate) fn counts(&self, surface: &[f64], state: &State) -> Vec<f64> {
        let inputs = Inputs::<f64>::of(state);
        let nodes = self.surroundings.nodes_cm1();
        let widths = self.bands.widths_cm1();
        (0..nodes.len())
            .map(|j| widths[j] * inputs.signal(nodes[j], surface[j], surface[j], &self.objects_at(j)))
            .collect()
    }

    /// Half the separation ½·‖2√p − 2√p′‖ per √photon of the target, straight from its definition.
    pub(crate) fn half_separation(&self, state: &State) -> f64 {
        let target = self.counts(&self.emissivity, &self.state);
        let other = self.counts(&self.alternative, state);
        let total: f64 = target.iter().sum();
        let square: f64 = target.iter().zip(&other).map(|(a, b)| (a.sqrt() - b.sqrt()).powi(2)).sum();
        (square / total).sqrt()
    }
}
