//! What a blackbody of a calibration sends: its own light, and what it reflects of its surroundings.
//!
//! L = e B(T) + (1 − e) B(T_s);   ∂L/∂T = e B′(T),   ∂L/∂e = B(T) − B(T_s),   ∂L/∂T_s = (1 − e) B′(T_s)
//!
//! | symbol | unit |
//! |---|---|
//! | L, B | photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ |
//! | T of the blackbody, T_s of what it reflects | K |
//! | e | 1 |
//!
//! Assumptions: one emissivity in all channels; surroundings that are black and the same in all directions. Source: S53.

use crate::error::{Error, Result, check};
use crate::planck;

/// A blackbody, as good as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sent {
    /// T, K.
    pub temperature_k: f64,
    /// e.
    pub emissivity: f64,
    /// T_s, K; of no account where e = 1 is exact.
    pub surroundings_k: f64,
}

/// Of what an error is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// T.
    Temperature,
    /// e.
    Emissivity,
    /// T_s.
    Surroundings,
}

/// Deviations of a blackbody's figures: of T (K), e and T_s (K).
pub type Deviations = [f64; 3];

/// An error of a blackbody, one number for all channels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unknown {
    /// Which blackbody.
    pub blackbody: usize,
    /// Of what.
    pub of: Of,
    /// Its deviation, K or 1.
    pub deviation: f64,
}

impl Unknown {
    /// Temperatures alone, of these deviations (K).
    #[must_use]
    pub fn temperatures(deviations_k: &[f64]) -> Vec<Self> {
        let one = |(blackbody, deviation): (usize, &f64)| Self {
            blackbody,
            of: Of::Temperature,
            deviation: *deviation,
        };
        deviations_k.iter().enumerate().map(one).collect()
    }

    /// Those of temperatures of all blackbodies, then those of emissivities and of surroundings where any is above 0.
    ///
    /// # Errors
    /// Deviations that are negative or no numbers.
    pub fn all(deviations: &[Deviations]) -> Result<Vec<Self>> {
        let kinds = [
            (Of::Temperature, "uncertainty of a blackbody's temperature", "K"),
            (Of::Emissivity, "error of a blackbody's emissivity", ""),
            (Of::Surroundings, "uncertainty of a blackbody's surroundings", "K"),
        ];
        let mut all = Vec::new();
        for (i, (of, what, unit)) in kinds.into_iter().enumerate() {
            for own in deviations {
                check::non_negative(what, own[i], unit)?;
            }
            if of == Of::Temperature || deviations.iter().any(|own| own[i] > 0.0) {
                let one = |(blackbody, own): (usize, &Deviations)| Self { blackbody, of, deviation: own[i] };
                all.extend(deviations.iter().enumerate().map(one));
            }
        }
        Ok(all)
    }
}

impl Sent {
    /// A blackbody that reflects nothing.
    #[must_use]
    pub fn black(temperature_k: f64) -> Self {
        Self { temperature_k, emissivity: 1.0, surroundings_k: temperature_k }
    }

    /// Refuses what is no blackbody.
    ///
    /// # Errors
    /// Temperatures that are not positive, an emissivity that is not above 0 and at most 1.
    pub fn check(&self) -> Result<()> {
        check::positive("temperature of a blackbody", self.temperature_k, "K")?;
        check::positive("temperature of a blackbody's surroundings", self.surroundings_k, "K")?;
        if !(self.emissivity > 0.0 && self.emissivity <= 1.0) {
            let expected = "above 0, at most 1";
            return Err(Error::out_of_range("emissivity of a blackbody", self.emissivity, "", expected));
        }
        Ok(())
    }

    /// The same, its figure off by `more`.
    #[must_use]
    pub fn shifted(mut self, of: Of, more: f64) -> Self {
        *match of {
            Of::Temperature => &mut self.temperature_k,
            Of::Emissivity => &mut self.emissivity,
            Of::Surroundings => &mut self.surroundings_k,
        } += more;
        self
    }

    /// L.
    pub fn radiance_into(&self, wavenumbers_cm1: &[f64], out: &mut [f64]) {
        planck::photon_radiance_into(wavenumbers_cm1, self.temperature_k, out);
        if self.emissivity != 1.0 {
            let reflected = spectrum(wavenumbers_cm1, self.surroundings_k);
            let e = self.emissivity;
            out.iter_mut().zip(reflected).for_each(|(out, s)| *out = e * *out + (1.0 - e) * s);
        }
    }

    /// L less that of another blackbody, of which nothing is lost where they are near each other.
    pub fn apart_into(&self, other: &Self, wavenumbers_cm1: &[f64], out: &mut [f64]) {
        let base = spectrum(wavenumbers_cm1, other.temperature_k);
        let more = self.temperature_k - other.temperature_k;
        planck::photon_radiance_difference_into(wavenumbers_cm1, other.temperature_k, more, &base, out);
        let (e, e0) = (self.emissivity, other.emissivity);
        if e == 1.0 && e0 == 1.0 {
            return;
        }
        let reflected = spectrum(wavenumbers_cm1, other.surroundings_k);
        let mut warmer = vec![0.0; out.len()];
        let more = self.surroundings_k - other.surroundings_k;
        planck::photon_radiance_difference_into(
            wavenumbers_cm1,
            other.surroundings_k,
            more,
            &reflected,
            &mut warmer,
        );
        for (((out, base), reflected), warmer) in out.iter_mut().zip(base).zip(reflected).zip(warmer) {
            *out = e * *out + (e - e0) * (base - reflected) + (1.0 - e) * warmer;
        }
    }

    /// ∂L by one of its figures.
    pub fn slope_into(&self, of: Of, wavenumbers_cm1: &[f64], out: &mut [f64]) {
        let (t, e) = match of {
            Of::Temperature => (self.temperature_k, self.emissivity),
            Of::Surroundings => (self.surroundings_k, 1.0 - self.emissivity),
            Of::Emissivity => {
                let more = self.temperature_k - self.surroundings_k;
                let base = spectrum(wavenumbers_cm1, self.surroundings_k);
                let from_k = self.surroundings_k;
                return planck::photon_radiance_difference_into(wavenumbers_cm1, from_k, more, &base, out);
            }
        };
        let mut radiance = vec![0.0; out.len()];
        planck::photon_radiance_and_slope_into(wavenumbers_cm1, t, &mut radiance, out);
        out.iter_mut().for_each(|slope| *slope *= e);
    }
}

fn spectrum(wavenumbers_cm1: &[f64], temperature_k: f64) -> Vec<f64> {
    let mut out = vec![0.0; wavenumbers_cm1.len()];
    planck::photon_radiance_into(wavenumbers_cm1, temperature_k, &mut out);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const NU: f64 = 950.0;
    const GREY: Sent = Sent { temperature_k: 333.15, emissivity: 0.98, surroundings_k: 295.15 };

    /// Planck's law by hand, of which nothing here makes use.
    fn planck_law(t: f64) -> f64 {
        let (h, c, k) = (6.626_070_15e-34, 299_792_458.0, 1.380_649e-23);
        let nu = 100.0 * NU;
        2.0 * c * nu * nu / (libm::exp(h * c * nu / (k * t)) - 1.0) * 100.0
    }

    fn by_hand(sent: &Sent) -> f64 {
        let e = sent.emissivity;
        e * planck_law(sent.temperature_k) + (1.0 - e) * planck_law(sent.surroundings_k)
    }

    fn at(of: impl Fn(&mut [f64])) -> f64 {
        let mut out = [0.0];
        of(&mut out);
        out[0]
    }

    #[test]
    fn a_grey_blackbody_sends_its_own_light_and_what_it_reflects() {
        let sent = at(|out| GREY.radiance_into(&[NU], out));
        assert!((sent / by_hand(&GREY) - 1.0).abs() < 1e-9);
        let other = Sent { temperature_k: 283.15, emissivity: 0.95, surroundings_k: 290.0 };
        let apart = at(|out| GREY.apart_into(&other, &[NU], out));
        assert!((apart / (by_hand(&GREY) - by_hand(&other)) - 1.0).abs() < 1e-8);
        // A black one is Planck's law bit by bit.
        let black = Sent::black(GREY.temperature_k);
        assert_eq!(at(|out| black.radiance_into(&[NU], out)), planck::photon_radiance(NU, 333.15));
    }

    #[test]
    fn slopes_are_those_of_differences() {
        for (of, step) in [(Of::Temperature, 1e-3), (Of::Emissivity, 1e-4), (Of::Surroundings, 1e-3)] {
            let [more, less] = [step, -step].map(|step| by_hand(&GREY.shifted(of, step)));
            let slope = at(|out| GREY.slope_into(of, &[NU], out));
            assert!((slope / ((more - less) / (2.0 * step)) - 1.0).abs() < 1e-5, "{of:?}");
        }
    }

    #[test]
    fn errors_that_nobody_has_are_no_unknowns() {
        let all = Unknown::all(&[[0.1, 0.0, 0.0], [0.0, 0.005, 0.0]]).unwrap();
        let of = |of: Of, blackbody, deviation| Unknown { blackbody, of, deviation };
        let (t, e) = (Of::Temperature, Of::Emissivity);
        assert_eq!(all, [of(t, 0, 0.1), of(t, 1, 0.0), of(e, 0, 0.0), of(e, 1, 0.005)]);
        assert!(Unknown::all(&[[0.0, -1.0, 0.0]]).is_err());
    }
}
