//! Thinned bands, and blackbody radiances at their nodes for a grid of temperatures.
//!
//! Temperatures grow by [`RATIO`] from the coldest there is, the same for every pair, so that what one search
//! has computed serves the next ones; around the temperatures of a scene there are more of them. Where bands have several nodes
//! the emission of one alternative is kept in its bands as well: whatever scene it is searched in, it is the same.

use crate::aligned::Aligned;
use crate::order;
use crate::planck;
use crate::simd::LANES;
use crate::spectrum::Bands;
use crate::units::SECOND_RADIATION_CM_K;

/// Bands that are enough to find where minima are.
const ENOUGH_BANDS: usize = 128;
/// Lowest temperature of the grid, K, and steps in which it grows by e.
const LOWEST_K: f64 = 0.1;
const STEPS_PER_E: f64 = 32.0;
/// What x changes by at the highest wavenumber from one temperature of a search to the next, where x is large: the fitted cost
/// is smooth in that.
const SPACING: f64 = 0.2;
/// More of them around the temperatures of the scene, as shares of these.
const AROUND: [f64; 7] = [-0.03, -0.01, -0.003, 0.0, 0.003, 0.01, 0.03];

/// Blackbody radiance and its slope along T at the thinned nodes, followed by zeros up to a whole chunk.
#[derive(Debug, Clone)]
pub(super) struct Emission {
    pub(super) temperature_k: f64,
    value: Aligned,
    slope: Aligned,
    /// The same of the alternative in bands of several nodes.
    banded: Option<[Aligned; 2]>,
}

impl Emission {
    fn of(nodes_cm1: &[f64], temperature_k: f64) -> Self {
        let whole = || Aligned::zeros(nodes_cm1.len().next_multiple_of(LANES));
        let (mut value, mut slope) = (whole(), whole());
        planck::photon_radiance_and_slope_into(nodes_cm1, temperature_k, &mut value, &mut slope);
        Self { temperature_k, value, slope, banded: None }
    }

    /// What the alternative sends, and its slope, to be multiplied by the strength of each band.
    pub(super) fn spectra(&self) -> [&[f64]; 2] {
        match &self.banded {
            Some([value, slope]) => [value, slope],
            None => [&self.value, &self.slope],
        }
    }

    /// Makes sure of the spectra in bands of several nodes.
    fn band(&mut self, bands: &Bands, emissivity: &[f64]) {
        if self.banded.is_none() {
            let of = |spectrum: &[f64]| {
                let sent: Vec<f64> = spectrum.iter().zip(emissivity).map(|(b, e)| b * e).collect();
                let mut banded = Aligned::zeros(bands.len().next_multiple_of(LANES));
                bands.weigh_into(&sent, &mut banded[..bands.len()]);
                banded
            };
            self.banded = Some([of(&self.value), of(&self.slope)]);
        }
    }
}

/// Every so many bands of a problem.
#[derive(Debug, Clone)]
pub(super) struct Thinned {
    pub(super) bands: Bands,
    /// Where their nodes stand among those of the whole.
    pub(super) nodes: Vec<usize>,
    /// Every so many bands are kept.
    pub(super) stride: usize,
}

/// Thinned bands with the emissions computed so far.
#[derive(Debug, Clone)]
pub(crate) struct EmissionTable {
    pub(super) thinned: Thinned,
    even: Vec<Option<Emission>>,
    around: Vec<Emission>,
    /// Emissivity of the alternative whose spectra stand in the bands, at the thinned nodes.
    emissivity: Vec<f64>,
}

impl EmissionTable {
    pub(crate) fn new(whole: &Bands) -> Self {
        let stride = (whole.len() / ENOUGH_BANDS).max(1);
        let (bands, nodes) = whole.every(stride);
        let thinned = Thinned { bands, nodes, stride };
        Self { thinned, even: Vec::new(), around: Vec::new(), emissivity: Vec::new() }
    }

    /// The first step of the grid at which `weights` emit `goal` or more, between two temperatures (K).
    pub(super) fn step_of_emission(&mut self, weights: &[f64], goal: f64, low_k: f64, high_k: f64) -> usize {
        let (mut below, mut above) = (step_at(low_k), step_at(high_k));
        while below < above {
            let middle = below.midpoint(above);
            if crate::sum::dot(weights, &self.even(middle).value) < goal {
                below = middle + 1;
            } else {
                above = middle;
            }
        }
        below
    }

    /// Emissions in the order of their temperatures: the even grid over `steps`, more around the
    /// temperatures of a scene, and the ends of the range where it cuts the grid. They are of an alternative of this emissivity at the
    /// thinned nodes.
    pub(super) fn grid(
        &mut self,
        emissivity: &[f64],
        steps: std::ops::RangeInclusive<usize>,
        scene_k: &[f64],
        [low_k, high_k]: [f64; 2],
    ) -> (&Thinned, Vec<&Emission>) {
        let (_, last_cm1) = self.thinned.bands.range_cm1();
        let mut chosen = vec![*steps.start()];
        while let Some(&step) = chosen.last().filter(|step| *step < steps.end()) {
            let x = SECOND_RADIATION_CM_K * last_cm1 / temperature_at(step);
            let stride = (STEPS_PER_E * SPACING / (1.0 + x)).max(1.0) as usize;
            chosen.push((step + stride).min(*steps.end()));
        }
        let reach = temperature_at(*steps.start())..=temperature_at(*steps.end());
        let nearby = scene_k.iter().flat_map(|t| AROUND.map(|share| t * (1.0 + share)));
        let ends = [low_k, high_k].into_iter().filter(|end| reach.contains(end));
        let mut wanted: Vec<f64> = nearby.map(|t| t.clamp(low_k, high_k)).chain(ends).collect();
        wanted.sort_by(f64::total_cmp);
        wanted.dedup();
        if self.around.iter().map(|emission| emission.temperature_k).ne(wanted.iter().copied()) {
            let mut had = std::mem::take(&mut self.around);
            self.around = wanted
                .iter()
                .map(|&t| match had.iter().position(|emission| emission.temperature_k == t) {
                    Some(place) => had.swap_remove(place),
                    None => Emission::of(self.thinned.bands.nodes_cm1(), t),
                })
                .collect();
        }
        for &step in &chosen {
            self.banded(emissivity, step);
        }
        let bands = &self.thinned.bands;
        if !bands.one_node_per_band() {
            self.around.iter_mut().for_each(|emission| emission.band(bands, emissivity));
        }
        let even = chosen.iter().filter_map(|&step| self.even.get(step)?.as_ref());
        let mut all: Vec<&Emission> = even
            .filter(|emission| (low_k..=high_k).contains(&emission.temperature_k))
            .chain(&self.around)
            .collect();
        order::ascending(&mut all, |a| a.temperature_k);
        all.dedup_by(|a, b| a.temperature_k == b.temperature_k);
        (&self.thinned, all)
    }

    /// The emission at a step of the grid, of an alternative of this emissivity at the thinned nodes.
    pub(super) fn banded(&mut self, emissivity: &[f64], step: usize) -> &Emission {
        self.even(step);
        let bands = &self.thinned.bands;
        let is_banded = !bands.one_node_per_band();
        if is_banded && self.emissivity != emissivity {
            self.emissivity = emissivity.to_vec();
            let all = self.even.iter_mut().flatten().chain(&mut self.around);
            all.for_each(|emission| emission.banded = None);
        }
        let nodes = bands.nodes_cm1();
        let emission = self.even[step].get_or_insert_with(|| Emission::of(nodes, temperature_at(step)));
        if is_banded {
            emission.band(bands, emissivity);
        }
        emission
    }

    fn even(&mut self, step: usize) -> &Emission {
        crate::stop::check();
        if self.even.len() <= step {
            self.even.resize(step + 1, None);
        }
        let nodes = self.thinned.bands.nodes_cm1();
        self.even[step].get_or_insert_with(|| Emission::of(nodes, temperature_at(step)))
    }
}

/// The last step at or below a temperature.
pub(super) fn step_at(temperature_k: f64) -> usize {
    ((temperature_k / LOWEST_K).ln() * STEPS_PER_E).floor().max(0.0) as usize
}

/// Temperature of a step, K.
fn temperature_at(step: usize) -> f64 {
    LOWEST_K * (step as f64 / STEPS_PER_E).exp()
}
