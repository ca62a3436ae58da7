//! The paper's inverse functions: the slope along wavenumber takes the lighting away, temperature and lighting follow (S46, S47).
//!
//! With F = S/(1 − e) and G = e/(1 − e) the signal is F = G·B(T) + X. Between neighbouring bands, Δ their difference and ¯ their mean,
//!
//! ΔF = ΔG·B̄ + [Ḡ·ΔB + ΔX]   (exact),
//!
//! of which S46 keeps the first term. T minimises Σ (ΔF − ΔG·B̄(T))²/var ΔF over the pairs of neighbours, var ΔF that of shot and
//! electronic noise of both bands; what is left out, Ḡ·ΔB + ΔX, is its bias ([`super::inverse_error`]). Then V follows by weighted least
//! squares from S − e·B(T) = (1 − e)·Σₖ Vₖ Sₖ, which for one of the surroundings is a weighted mean of S47 over the bands.
//! Every material of the library is tried; the one of the smallest Pearson's χ² of the counts is named.
//!
//! Assumptions: temperatures within their range; V free, of no known total; emissivity and radiance of a band are means over it. Bands in
//! which nothing is scattered (e = 1) have no S46. The paper combines bands, chooses materials and weighs in ways it does not state.
//!
//! | symbol | unit | what |
//! |---|---|---|
//! | S, F, X, B | photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ | mean over a band |
//! | e, G, V | | emissivity, e/(1 − e), lighting factors |

use super::model::Model;
use super::pixel::{Pixel, flag};
use super::ranked::Ranked;
use super::setting::Setting;
use hadar::error::Result;
use hadar::planck;
use hadar::spectrum::Bands;
use nalgebra::{DMatrix, DVector};

/// Share of light that a band must scatter to be divided by.
const LEAST_SCATTERED: f64 = 1e-6;
/// Fewest counts of a model, and the variance of a band without counts.
const FEWEST: f64 = 1e-6;
const LEAST_VAR: f64 = 1.0;
const MOST_STEPS: usize = 60;
/// Last step of the temperature, as a share of it.
const LAST_STEP: f64 = 1e-10;

/// What is the same for all pixels.
pub(super) struct Inverse<'a> {
    bands: &'a Bands,
    pub(super) model: Model,
    /// Counts for each unit of mean radiance in the bands that count.
    counts_per_mean: Vec<f64>,
    widths_cm1: Vec<f64>,
    materials: usize,
}

/// S46 of one material for one pixel: a row for each pair of neighbours.
pub(super) struct Differences {
    /// Bands of each pair, among those that count.
    pub(super) pairs: Vec<[usize; 2]>,
    /// ΔF.
    pub(super) signal: Vec<f64>,
    /// ΔG.
    pub(super) slope: Vec<f64>,
    /// 1/var ΔF.
    pub(super) weight: Vec<f64>,
    /// Variance of F in each band.
    pub(super) var: Vec<f64>,
}

/// A material at what S46 and S47 say.
struct Solved {
    temperature_k: f64,
    held: bool,
    lighting: Vec<f64>,
    chi_square: f64,
}

impl<'a> Inverse<'a> {
    pub(super) fn new(setting: &Setting<'a>) -> Result<Self> {
        // Vertices of the lighting: darkness, and each of the surroundings alone with V = 1.
        let model = Model::new(&Setting { lighting_total: None, ..*setting })?;
        let widths = setting.bands.widths_cm1();
        let widths_cm1: Vec<f64> = model.used.iter().map(|&band| widths[band]).collect();
        let counts_per_mean = model
            .used
            .iter()
            .zip(&widths_cm1)
            .map(|(&band, width)| setting.counts_per_radiance[band] * width);
        Ok(Self {
            bands: setting.bands,
            counts_per_mean: counts_per_mean.collect(),
            widths_cm1,
            materials: setting.library.len(),
            model,
        })
    }

    pub(super) fn pixel(&self, counts: &[f64]) -> Pixel {
        let solved = (0..self.materials).filter_map(|m| Some((m, self.solved(m, counts)?)));
        let best = solved.min_by(|a, b| a.1.chi_square.total_cmp(&b.1.chi_square));
        let mut pixel = Pixel { posterior: f64::NAN, flags: flag::TEMPERATURE_UNKNOWN, ..Pixel::SKIPPED };
        if let Some((m, solved)) = best {
            pixel.material = m as u16;
            pixel.ranked = Ranked::of(std::iter::once((m, f64::NAN)));
            pixel.temperature_k = solved.temperature_k;
            pixel.lighting.iter_mut().zip(&solved.lighting).for_each(|(to, v)| *to = *v);
            pixel.flags = if solved.held { flag::TEMPERATURE_AT_LIMIT } else { 0 };
        }
        pixel
    }

    fn solved(&self, m: usize, counts: &[f64]) -> Option<Solved> {
        let differences = self.differences(m, counts);
        let (temperature_k, held) = self.temperature_k(&differences)?;
        let (emitted, _) = self.model.emitted(m, temperature_k);
        let (lighting, chi_square) = self.lighting(m, counts, &emitted)?;
        chi_square.is_finite().then_some(Solved { temperature_k, held, lighting, chi_square })
    }

    /// S46 of material `m` for the counts in the bands that count.
    pub(super) fn differences(&self, m: usize, counts: &[f64]) -> Differences {
        let emissivity = self.model.emissivity(m);
        let lit: Vec<usize> = (0..counts.len()).filter(|&w| 1.0 - emissivity[w] > LEAST_SCATTERED).collect();
        let mut out = Differences {
            pairs: Vec::new(),
            signal: Vec::new(),
            slope: Vec::new(),
            weight: Vec::new(),
            var: vec![f64::INFINITY; counts.len()],
        };
        let scale = |w: usize| 1.0 / (self.counts_per_mean[w] * (1.0 - emissivity[w]));
        for &w in &lit {
            out.var[w] = f64::max(counts[w] + self.model.var_added[w], LEAST_VAR) * scale(w).powi(2);
        }
        for pair in lit.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let ratio = |w: usize| emissivity[w] / (1.0 - emissivity[w]);
            out.pairs.push([a, b]);
            out.signal.push(counts[b] * scale(b) - counts[a] * scale(a));
            out.slope.push(ratio(b) - ratio(a));
            out.weight.push(1.0 / (out.var[a] + out.var[b]));
        }
        out
    }

    /// Mean radiance of a blackbody in the bands that count, and its slope per kelvin.
    pub(super) fn blackbody(&self, temperature_k: f64) -> [Vec<f64>; 2] {
        let nodes = self.bands.nodes_cm1();
        let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        planck::photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
        [value, slope].map(|at_nodes| {
            let all = self.bands.weigh(&at_nodes);
            self.model.used.iter().zip(&self.widths_cm1).map(|(&band, width)| all[band] / width).collect()
        })
    }

    /// The temperature that S46 fits best, and whether the range holds it; none where the emissivity has no slope.
    fn temperature_k(&self, differences: &Differences) -> Option<(f64, bool)> {
        let [low, high] = self.model.range_k;
        let mut temperature_k = 0.5 * (low + high);
        for _ in 0..MOST_STEPS {
            let [value, slope] = self.blackbody(temperature_k);
            let (mut along, mut square) = (0.0, 0.0);
            for (i, [a, b]) in differences.pairs.iter().enumerate() {
                let change = differences.slope[i] * 0.5 * (slope[*a] + slope[*b]);
                let rest = differences.signal[i] - differences.slope[i] * 0.5 * (value[*a] + value[*b]);
                along += differences.weight[i] * change * rest;
                square += differences.weight[i] * change * change;
            }
            let step = along / square;
            if !step.is_finite() {
                return None;
            }
            let next = (temperature_k + step).clamp(low, high);
            let moved = (next - temperature_k).abs();
            temperature_k = next;
            if moved <= LAST_STEP * temperature_k {
                break;
            }
        }
        Some((temperature_k, temperature_k <= low || temperature_k >= high))
    }

    /// V by weighted least squares, and χ² with it.
    fn lighting(&self, m: usize, counts: &[f64], emitted: &[f64]) -> Option<(Vec<f64>, f64)> {
        let (model, count) = (&self.model, self.model.surroundings);
        let deviation = |w: usize| f64::max(counts[w] + model.var_added[w], LEAST_VAR).sqrt();
        let column = |k: usize| model.scattered_of(m, 1 + k);
        let mut lighting = vec![0.0; count];
        if count > 0 {
            let rows = DMatrix::from_fn(counts.len(), count, |w, k| column(k)[w] / deviation(w));
            let rest = DVector::from_fn(counts.len(), |w, _| (counts[w] - emitted[w]) / deviation(w));
            let normal = (rows.transpose() * &rows).cholesky()?;
            lighting = normal.solve(&(rows.transpose() * rest)).iter().copied().collect();
        }
        let chi_square = (0..counts.len()).map(|w| {
            let scattered: f64 = lighting.iter().enumerate().map(|(k, v)| v * column(k)[w]).sum();
            let mean = emitted[w] + scattered;
            (counts[w] - mean).powi(2) / f64::max(mean + model.var_added[w], FEWEST)
        });
        let chi_square = chi_square.sum();
        Some((lighting, chi_square))
    }
}
