//! Loops over the nodes of a [`Jacobian`](super::Jacobian), compiled per instruction set.
//!
//! Symbols as there: e, e′ emissivities; C contrast; X = ΣVₖεₖB(Tₖ) lighting; G gain. Everything is per node.

use crate::simd::{LANES, Largest, dispatched};

/// Spectra that [`light_by_one`] reads and writes.
pub(super) struct LightSpectra<'a> {
    pub(super) value: &'a [f64],
    pub(super) base: &'a [f64],
    pub(super) difference: &'a [f64],
    pub(super) lit: &'a mut [f64],
    pub(super) contrast: &'a mut [f64],
}

dispatched! {
    /// Lighting and contrast for the common case of a single black object.
    pub(super) fn light_by_one<'a>(factor: f64, rest: f64, spectra: LightSpectra<'a>) {
        let LightSpectra { value, base, difference, lit, contrast } = spectra;
        let nodes = lit.iter_mut().zip(contrast).zip(base).zip(difference).zip(value);
        for ((((lit, contrast), base), difference), value) in nodes {
            *lit = factor * base;
            *contrast = factor.mul_add(*difference, rest * value);
        }
    }
}

/// A surface amid a single black object.
pub(super) struct OneObject<'a> {
    /// V, 1 − V and G.
    pub(super) factor: f64,
    pub(super) rest: f64,
    pub(super) gain: f64,
    pub(super) value: &'a [f64],
    pub(super) base: &'a [f64],
    pub(super) difference: &'a [f64],
    pub(super) emissivity: &'a [f64],
    pub(super) alternative: &'a [f64],
    /// S, ∂S/∂g and 1/S.
    pub(super) signal: &'a mut [f64],
    pub(super) mixing: &'a mut [f64],
    pub(super) inverse: &'a mut [f64],
}

dispatched! {
    /// [`light_by_one`], [`signal_into`], [`mixing_into`] and [`inverse_into`] in one pass, to the same bits:
    /// the divisions cost nothing while memory is waited for.
    pub(super) fn signal_and_mixing_by_one<'a>(work: OneObject<'a>) {
        let OneObject { factor, rest, gain, value, base, difference, emissivity, alternative, .. } = work;
        let spectra = value.iter().zip(base).zip(difference).zip(emissivity).zip(alternative);
        let out = work.signal.iter_mut().zip(work.mixing).zip(work.inverse);
        for (((signal, mixing), inverse), ((((value, base), difference), e), other)) in out.zip(spectra) {
            *signal = gain * e.mul_add(*value, (1.0 - e) * (factor * base));
            *mixing = gain * ((other - e) * factor.mul_add(*difference, rest * value));
            *inverse = if *signal > 0.0 { 1.0 / *signal } else { 0.0 };
        }
    }
}

dispatched! {
    /// 1/value, and 0 for a value of 0.
    pub(super) fn inverse_into<'a>(values: &'a [f64], out: &'a mut [f64]) {
        for (out, value) in out.iter_mut().zip(values) {
            *out = if *value > 0.0 { 1.0 / value } else { 0.0 };
        }
    }
}

dispatched! {
    /// Largest Σ|terms| and largest |sum| of the contrast that [`light_by_one`] forms. Both are made of
    /// blackbody radiances alone and change little from node to node: a few dozen nodes tell them.
    pub(super) fn largest_by_one<'a>(
        factor: f64,
        rest: f64,
        difference: &'a [f64],
        value: &'a [f64],
    ) -> (f64, f64) {
        let (d8, d_rest) = difference.as_chunks::<LANES>();
        let (v8, v_rest) = value.as_chunks::<LANES>();
        let (mut terms, mut sums) = (Largest::default(), Largest::default());
        for (difference, value) in d8.iter().zip(v8).step_by((d8.len() / 8).max(1)) {
            let (difference, value) = (*difference, *value);
            terms.see(std::array::from_fn(|i| (factor * difference[i]).abs() + rest * value[i]));
            sums.see(std::array::from_fn(|i| factor.mul_add(difference[i], rest * value[i])));
        }
        for (difference, value) in d_rest.iter().zip(v_rest) {
            terms.see([(factor * difference).abs() + rest * value; LANES]);
            sums.see([factor.mul_add(*difference, rest * value); LANES]);
        }
        (terms.value(), sums.value())
    }
}

/// One of several objects, or one that is not black.
pub(super) struct LightObject<'a> {
    pub(super) factor: f64,
    pub(super) emissivity: Option<&'a [f64]>,
    pub(super) base: &'a [f64],
    pub(super) difference: &'a [f64],
    pub(super) lit: &'a mut [f64],
    pub(super) contrast: &'a mut [f64],
    /// Σ|terms| of the contrast, and the part of the hemisphere that does not shine: 1 − ΣVₖεₖ.
    pub(super) terms: &'a mut [f64],
    pub(super) dark: &'a mut [f64],
}

dispatched! {
    /// Adds an object's share to lighting and contrast.
    pub(super) fn add_object<'a>(object: LightObject<'a>) {
        let LightObject { factor, emissivity, base, difference, lit, contrast, terms, dark } = object;
        let nodes = lit.iter_mut().zip(contrast).zip(terms).zip(base).zip(difference);
        match emissivity {
            None => {
                for ((((lit, contrast), terms), base), difference) in nodes {
                    *lit += factor * base;
                    *contrast += factor * difference;
                    *terms += (factor * difference).abs();
                }
            }
            Some(emissivity) => {
                for (((((lit, contrast), terms), base), difference), (e, dark)) in
                    nodes.zip(emissivity.iter().zip(dark))
                {
                    *lit += factor * e * base;
                    *contrast += factor * e * difference;
                    *terms += (factor * e * difference).abs();
                    *dark += factor * (1.0 - e);
                }
            }
        }
    }
}

dispatched! {
    /// Adds the missing light to the contrast and to Σ|terms| of it.
    pub(super) fn add_darkness<'a>(
        dark: &'a [f64],
        value: &'a [f64],
        terms: &'a mut [f64],
        contrast: &'a mut [f64],
    ) {
        for (((contrast, terms), dark), value) in contrast.iter_mut().zip(terms).zip(dark).zip(value) {
            *contrast += dark * value;
            *terms += dark * value;
        }
    }
}

dispatched! {
    pub(super) fn scale_by<'a>(factors: &'a [f64], out: &'a mut [f64]) {
        for (out, factor) in out.iter_mut().zip(factors) {
            *out *= factor;
        }
    }
}

dispatched! {
    /// factor·ε·spectrum, ε = 1 where there is none.
    pub(super) fn scaled_into<'a>(factor: f64, emissivity: Option<&'a [f64]>, spectrum: &'a [f64], out: &'a mut [f64]) {
        match emissivity {
            None => {
                for (out, spectrum) in out.iter_mut().zip(spectrum) {
                    *out = factor * spectrum;
                }
            }
            Some(emissivity) => {
                for ((out, spectrum), e) in out.iter_mut().zip(spectrum).zip(emissivity) {
                    *out = factor * e * spectrum;
                }
            }
        }
    }
}

dispatched! {
    /// out += factor·ε·spectrum, ε = 1 where there is none.
    pub(super) fn add_scaled<'a>(factor: f64, emissivity: Option<&'a [f64]>, spectrum: &'a [f64], out: &'a mut [f64]) {
        match emissivity {
            None => {
                for (out, spectrum) in out.iter_mut().zip(spectrum) {
                    *out += factor * spectrum;
                }
            }
            Some(emissivity) => {
                for ((out, spectrum), e) in out.iter_mut().zip(spectrum).zip(emissivity) {
                    *out += factor * e * spectrum;
                }
            }
        }
    }
}

dispatched! {
    pub(super) fn signal_into<'a>(emissivity: &'a [f64], value: &'a [f64], lit: &'a [f64], gain: f64, out: &'a mut [f64]) {
        for (((out, e), value), lit) in out.iter_mut().zip(emissivity).zip(value).zip(lit) {
            *out = gain * e.mul_add(*value, (1.0 - e) * lit);
        }
    }
}

dispatched! {
    pub(super) fn product_into<'a>(a: &'a [f64], b: &'a [f64], factor: f64, out: &'a mut [f64]) {
        for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
            *out = factor * (a * b);
        }
    }
}

dispatched! {
    pub(super) fn scattered_into<'a>(emissivity: &'a [f64], incident: &'a [f64], factor: f64, out: &'a mut [f64]) {
        for ((out, e), incident) in out.iter_mut().zip(emissivity).zip(incident) {
            *out = factor * ((1.0 - e) * incident);
        }
    }
}

dispatched! {
    pub(super) fn mixing_into<'a>(
        emissivity: &'a [f64],
        alternative: &'a [f64],
        contrast: &'a [f64],
        gain: f64,
        out: &'a mut [f64],
    ) {
        for (((out, e), other), contrast) in out.iter_mut().zip(emissivity).zip(alternative).zip(contrast) {
            *out = gain * ((other - e) * contrast);
        }
    }
}
