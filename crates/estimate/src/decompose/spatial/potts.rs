//! Potts prior on the materials: posterior of every pixel by sum-product messages.
//!
//! p(m) ∝ Πᵢ Lᵢ(mᵢ) Π₍ᵢⱼ₎ exp(β κᵢⱼ [mᵢ = mⱼ]),  κᵢⱼ = exp(−½ (Tᵢ − Tⱼ)²/(σᵢ² + σⱼ² + τ²))
//!
//! over pairs of neighbours (four of each pixel), Lᵢ the profile likelihoods. β is what a neighbour of the same material adds to the
//! log-odds of that material; as far as their temperatures differ by more than their errors σ and the step τ, it adds less, and across
//! an edge of temperature nothing. All four together outweigh counts that speak for another material with a log-odds below 4β.
//!
//! Belief propagation: message of pixel j to its neighbour i about a material a
//! Mⱼᵢ(a) = 1 + (exp(β κᵢⱼ) − 1) hⱼ(a),  hⱼ(a) ∝ Lⱼ(a) Π₍ₖ ≠ ᵢ₎ Mₖⱼ(a),  Σₐ hⱼ(a) = 1,
//! all of a sweep from those of the sweep before, so no order and no number of threads matters. Exact on images of one row or column;
//! on others neighbours' neighbours are taken for independent, which makes posteriors too sure where β is large.
//!
//! | symbol | unit | what |
//! |---|---|---|
//! | β | | log-odds of a neighbour (weight) |
//! | T, σ | K | temperature of a pixel for the material, and its deviation |
//! | τ | K | deviation of the temperature from a pixel to the next |
//!
//! Source: Potts, Proc. Camb. Phil. Soc. 48, 106 (1952); Yedidia, Freeman and Weiss, IEEE Trans. Inf. Theory 51, 2282 (2005).

use super::kept::{Candidate, FOUR, Kept, beside};
use hadar::parallel;

/// Change of a message, as a share of it, below which nothing of note changes.
const SETTLED: f32 = 1e-4;
const MOST_SWEEPS: usize = 200;

/// Posterior of every candidate of every pixel.
#[derive(Debug)]
pub(super) struct Beliefs {
    beliefs: Vec<f32>,
    pub(super) sweeps: usize,
    pub(super) settled: bool,
}

/// Messages about one candidate from the four neighbours.
type Heard = [f32; 4];

impl Beliefs {
    pub(super) fn new(kept: &Kept, columns: usize, weight: f64, step_k: f64) -> Self {
        let pixels = kept.pixels();
        let mut heard: Vec<Heard> = vec![[1.0; 4]; kept.len()];
        let (mut sweeps, mut settled) = (0, false);
        while !settled && sweeps < MOST_SWEEPS {
            hadar::stop::check();
            let rows: Vec<(Vec<Heard>, f32)> = parallel::map(pixels.div_ceil(columns.max(1)), |row| {
                let (mut next, mut change) = (Vec::new(), 0.0f32);
                for i in row * columns..((row + 1) * columns).min(pixels) {
                    let old = heard.get(kept.places(i)).unwrap_or_default();
                    let start = next.len();
                    next.extend(old.iter().map(|_| [1.0f32; 4]));
                    // What is certain listens to nobody.
                    if old.len() > 1 {
                        listen(kept, &heard, i, columns, (weight, step_k), &mut next[start..]);
                    }
                    for (new, old) in next[start..].iter().flatten().zip(old.iter().flatten()) {
                        change = change.max((new / old - 1.0).abs());
                    }
                }
                (next, change)
            });
            let change = rows.iter().map(|(_, change)| *change).fold(0.0, f32::max);
            heard = rows.into_iter().flat_map(|(row, _)| row).collect();
            sweeps += 1;
            settled = change < SETTLED;
        }
        let beliefs = (0..pixels)
            .flat_map(|i| normalised(kept.of(i), heard.get(kept.places(i)).unwrap_or_default(), None))
            .collect();
        Self { beliefs, sweeps, settled }
    }

    /// Posterior of the candidates of pixel `i`.
    pub(super) fn of(&self, kept: &Kept, i: usize) -> &[f32] {
        self.beliefs.get(kept.places(i)).unwrap_or_default()
    }

    /// Place of the most probable of the candidates of pixel `i` that are kept one by one.
    pub(super) fn best(&self, kept: &Kept, i: usize) -> usize {
        let one_by_one = kept.of(i).iter().zip(self.of(kept, i)).enumerate();
        let known = one_by_one.filter(|(_, (candidate, _))| candidate.kind.is_some());
        // The first of equals: the one that the pixel's own counts prefer.
        known.fold((0, -1.0), |best, (place, (_, b))| if *b > best.1 { (place, *b) } else { best }).0
    }
}

/// Fills what pixel `i` hears about its candidates.
fn listen(
    kept: &Kept,
    heard: &[Heard],
    i: usize,
    columns: usize,
    (weight, step_k): (f64, f64),
    next: &mut [Heard],
) {
    let own = kept.of(i);
    for (from, j) in beside(i, columns, kept.pixels(), &FOUR) {
        let others = kept.of(j);
        // Seen from there this pixel is in the opposite direction.
        let to = from ^ 1;
        let said = normalised(others, heard.get(kept.places(j)).unwrap_or_default(), Some(to));
        for (candidate, next) in own.iter().zip(&mut *next) {
            let same =
                |(other, _): &(&Candidate, f32)| candidate.kind.is_some() && other.kind == candidate.kind;
            if let Some((other, share)) = others.iter().zip(said.iter().copied()).find(same) {
                let odds = libm::expm1(weight * closeness(candidate, other, step_k));
                next[from] = odds.mul_add(share.into(), 1.0) as f32;
            }
        }
    }
}

/// κ of two fits of one material.
fn closeness(a: &Candidate, b: &Candidate, step_k: f64) -> f64 {
    let var = f64::from(a.sigma_k).powi(2) + f64::from(b.sigma_k).powi(2) + step_k * step_k;
    let apart = f64::from(a.temperature_k) - f64::from(b.temperature_k);
    let closeness = libm::exp(-0.5 * apart * apart / var);
    if closeness.is_nan() { 0.0 } else { closeness }
}

/// Likelihoods times what was heard, but for one neighbour, as shares of 1.
fn normalised(candidates: &[Candidate], heard: &[Heard], but: Option<usize>) -> Vec<f32> {
    let one = |(candidate, heard): (&Candidate, &Heard)| {
        let told = heard.iter().enumerate().filter(|(from, _)| Some(*from) != but);
        told.fold(libm::expf(candidate.log_odds), |product, (_, message)| product * message)
    };
    let mut shares: Vec<f32> = candidates.iter().zip(heard).map(one).collect();
    let total: f32 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= total);
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(kind: Option<u16>, log_odds: f32, temperature_k: f32, sigma_k: f32) -> Candidate {
        Candidate { kind, log_odds, temperature_k, sigma_k }
    }

    /// A row and a column of five pixels: every labelling of them counted.
    #[test]
    fn posteriors_of_a_row_are_those_of_all_its_labellings() {
        let own = |i: u16| {
            let t = 300.0 + f32::from(i);
            vec![
                candidate(Some(i % 3), 0.0, t, 0.7),
                candidate(Some((i + 1) % 3), -0.4 * f32::from(i), t + 1.5, 1.2),
                candidate(None, -1.1, f32::NAN, f32::INFINITY),
                candidate(Some((i + 2) % 3), -2.0, t - 3.0, 0.4),
            ]
        };
        let pixels: Vec<Vec<Candidate>> = (0..5).map(own).collect();
        let (weight, step_k) = (1.3, 0.5);
        let mut expected = [[0.0f64; 4]; 5];
        for labelling in 0..4usize.pow(5) {
            let chosen: Vec<usize> = (0..5).map(|i| labelling / 4usize.pow(i) % 4).collect();
            let one = |i: usize| pixels[i][chosen[i]];
            let mut log = (0..5).map(|i| f64::from(one(i).log_odds)).sum::<f64>();
            for (a, b) in (0..4).map(|i| (one(i), one(i + 1))) {
                if a.kind.is_some() && a.kind == b.kind {
                    let var = f64::from(a.sigma_k).powi(2) + f64::from(b.sigma_k).powi(2) + step_k * step_k;
                    let apart = f64::from(a.temperature_k - b.temperature_k);
                    log += weight * f64::exp(-apart * apart / (2.0 * var));
                }
            }
            (0..5).for_each(|i| expected[i][chosen[i]] += log.exp());
        }
        let kept = Kept::of_pixels(&pixels, 0.0);
        for columns in [5, 1] {
            let beliefs = Beliefs::new(&kept, columns, weight, step_k);
            assert!(beliefs.settled && beliefs.sweeps <= 6, "{}", beliefs.sweeps);
            for (i, expected) in expected.iter().enumerate() {
                let total: f64 = expected.iter().sum();
                for (found, expected) in beliefs.of(&kept, i).iter().zip(expected) {
                    assert!(
                        (f64::from(*found) - expected / total).abs() < 1e-6,
                        "{found} {}",
                        expected / total
                    );
                }
            }
        }
    }
}
