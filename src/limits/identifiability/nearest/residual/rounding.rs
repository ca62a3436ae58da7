//! What rounding may be of a distance: so many ulp of the separation with every term of S − S′ taken by its magnitude.
//!
//! Radiances are known to (10 + x)·10⁻¹⁵ ([`crate::planck`]), x = hcν/kT, which differences of them lose more of the deeper
//! they are in the Wien tail; measured by the stress suite.

use super::{Comparison, NO_GAIN, Separation, Target, is_other_scale};
use crate::scene::State;
use crate::simd::{Chunk, LANES, dispatched, fold, padded};
use crate::units::SECOND_RADIATION_CM_K;

/// Rounding of the terms that a separation is made of, times 10 + x as that of radiances, and the x beyond which there are none.
const ROUNDING_OF_TERMS: f64 = 1e-15;
const LARGEST_X: f64 = 708.0;
/// The x from which differences of radiances lose more than these themselves, by the stress suite.
const DEEP_IN_WIEN: f64 = 1.5;

impl Comparison<'_> {
    /// Relative error of a distance at a state by rounding, and what it is made of.
    pub(in super::super) fn rounding_at(
        &mut self,
        target: &Target<'_>,
        state: &State,
        distance: f64,
    ) -> (f64, f64) {
        let terms = self.terms(target, state);
        let (_, last_cm1) = self.range_cm1;
        let coldest = state.environment_k.iter().copied().fold(state.temperature_k, f64::min);
        let x = SECOND_RADIATION_CM_K * last_cm1 / coldest.min(target.state.temperature_k);
        let x = x.min(LARGEST_X);
        let rounding = ROUNDING_OF_TERMS * (10.0 + x) * (1.0 + x / DEEP_IN_WIEN);
        (NO_GAIN + rounding * (1.0 + terms / distance), terms)
    }

    /// The separation of the target from nothing at all.
    pub(in super::super) fn against_nothing(&self, target: &Target<'_>) -> f64 {
        let dark = vec![0.0; self.work.root.len()];
        let bands = [self.target.signal(), &dark, &self.work.root, &self.work.noise];
        square_of_terms(target.counts, bands, 0.0).sqrt()
    }

    /// The separation from a state with every term of S − S′ taken by its magnitude: what cancels in the distance.
    fn terms(&mut self, target: &Target<'_>, state: &State) -> f64 {
        match &self.measured {
            Some((known, terms)) if known == state => *terms,
            _ => {
                let terms = self.terms_anew(target, state);
                self.measured = Some((state.clone(), terms));
                terms
            }
        }
    }

    fn terms_anew(&mut self, target: &Target<'_>, state: &State) -> f64 {
        crate::stop::check();
        self.separate(target, state, false);
        if is_other_scale(target.state.gain, state.gain) {
            return self.size_of_terms(target, self.target.signal(), 1.0);
        }
        let (own, work, surface) = (target.state, &mut self.work, &self.surface);
        self.target.lighting_terms_into(own, surface, state, &mut work.lighting);
        self.target.sampling().sample(self.target.bands(), &mut work.node, &mut work.curvature, |out| {
            terms_into(
                Separation {
                    gain: own.gain,
                    emissivity: target.emissivity,
                    alternative: target.alternative,
                    contrast: self.target.contrast(),
                    difference: &work.difference,
                    lighting: &work.lighting,
                    out,
                },
                self.target.cancellation(),
            );
        });
        let gain = (state.gain - own.gain).abs() / state.gain;
        self.size_of_terms(target, &self.work.curvature, gain)
    }

    /// The separation by terms of the band and `more` times the signal of the candidate.
    fn size_of_terms(&self, target: &Target<'_>, terms: &[f64], more: f64) -> f64 {
        let Self { surface, work, .. } = self;
        square_of_terms(target.counts, [terms, surface.signal(), &work.root, &work.noise], more).sqrt()
    }
}

dispatched! {
    /// Σ (κ(term + more · S′)/(√(N + σ²) + √(N′ + σ²)))², over bands in which there is any.
    fn square_of_terms<'a>(counts: f64, bands: [&'a [f64]; 4], more: f64) -> f64 {
        let parts = bands.map(|x| x.as_chunks());
        let mut lanes = [0.0; LANES];
        for c in 0..parts[0].0.len() {
            lanes = squared_terms(counts, parts.map(|(chunks, _)| chunks[c]), more, lanes);
        }
        let lanes = squared_terms(counts, parts.map(|(_, rest)| padded(rest)), more, lanes);
        fold(&lanes)
    }
}

#[inline(always)]
fn squared_terms(counts: f64, [terms, signal, root, noise]: [Chunk; 4], more: f64, lanes: Chunk) -> Chunk {
    std::array::from_fn(|k| {
        let sum = root[k] + counts.mul_add(signal[k], noise[k]).sqrt();
        let term = counts * more.mul_add(signal[k], terms[k]) / sum;
        let term = if sum > 0.0 { term } else { 0.0 };
        term.mul_add(term, lanes[k])
    })
}

dispatched! {
    /// [`separation_into`] with every term by its magnitude, that of the contrast as many times as it is itself made of more.
    fn terms_into<'a>(spectra: Separation<'a>, cancellation: f64) {
        let Separation { gain, emissivity, alternative, contrast, difference, lighting, out } = spectra;
        let own = emissivity.iter().zip(alternative);
        let terms = contrast.iter().zip(difference).zip(lighting);
        for ((out, (e, other)), ((contrast, difference), lighting)) in out.iter_mut().zip(own).zip(terms) {
            let mixed = (cancellation * (e - other) * contrast).abs() + (other * difference).abs();
            *out = gain * (1.0 - other).mul_add(*lighting, mixed);
        }
    }
}
