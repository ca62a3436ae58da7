//! Measured spectra over the bands, and skies to look at them under.

use hadar::error::{Error, Result};
use hadar::fisher::emissivity::Smoothness;
use hadar::material::Library;
use hadar::planck::photon_radiance;
use hadar::statistics::Statistics;
use hadar_simulate::draws::{Draws, generator};

/// 13 to 8 µm, cm⁻¹.
pub(super) const RANGE_CM1: [f64; 2] = [770.0, 1250.0];
pub(super) const STEP_CM1: f64 = 5.0;
/// Mean emissivity from which on a spectrum is none of a bare metal.
const NO_METAL: f64 = 0.7;
/// Model atmosphere and temperature of its air at the ground, K.
const SKY: (&str, f64) = ("sky-us-standard", 288.2);
/// Width of the means that the model atmosphere gives, cm⁻¹.
const MEANS_CM1: f64 = 20.0;
/// Deviation of the logarithm of the optical depth within them.
pub(super) const LINES: f64 = 0.3;
/// Stream of the lines, the same for every seed: they are part of the scene.
const LINE_SEED: u64 = 20;

/// Where bands are, cm⁻¹.
pub(super) fn wavenumbers_cm1() -> Vec<f64> {
    let count = ((RANGE_CM1[1] - RANGE_CM1[0]) / STEP_CM1).round() as usize;
    (0..=count).map(|i| RANGE_CM1[0] + STEP_CM1 * i as f64).collect()
}

/// What comes from the sky.
pub(super) struct Sky {
    pub(super) name: &'static str,
    /// Photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹, in every band.
    pub(super) radiance: Vec<f64>,
    pub(super) air_k: f64,
}

/// The sky as the model has it, and with lines that its means may hide.
pub(super) fn skies(library: &Library) -> Result<Vec<Sky>> {
    let nu = wavenumbers_cm1();
    let smooth = library.get(SKY.0)?.emissivity(&nu)?;
    let radiance = |e: &[f64]| nu.iter().zip(e).map(|(nu, e)| e * photon_radiance(*nu, SKY.1)).collect();
    Ok(vec![
        Sky { name: "means over 20 cm⁻¹", radiance: radiance(&smooth), air_k: SKY.1 },
        Sky { name: "with lines", radiance: radiance(&with_lines(&smooth, LINES)?), air_k: SKY.1 },
    ])
}

/// Emissivities whose optical depths vary from band to band by a factor e^(±`deviation`), with the same means over 20 cm⁻¹.
pub(super) fn with_lines(smooth: &[f64], deviation: f64) -> Result<Vec<f64>> {
    let mut factors = vec![0.0; smooth.len()];
    Draws::new(&Statistics::gaussian(vec![1.0; smooth.len()])?, &vec![0.0; smooth.len()])?
        .draw_into(&mut generator(LINE_SEED, 0), &mut factors);
    factors.iter_mut().for_each(|x| *x = (deviation * *x).exp());
    let block = (MEANS_CM1 / STEP_CM1) as usize;
    let mut out = Vec::with_capacity(smooth.len());
    for (means, factors) in smooth.chunks(block).zip(factors.chunks(block)) {
        let wanted = means.iter().sum::<f64>();
        // 1 − e^(−D) of the scaled depths D.
        let at = |scale: f64| -> Vec<f64> {
            let each = means.iter().zip(factors);
            each.map(|(mean, factor)| -(scale * factor * (-mean.min(1.0 - 1e-9)).ln_1p()).exp_m1()).collect()
        };
        // The scale at which the mean is the same, by halving.
        let (mut low, mut high) = (1e-6_f64, 1e6_f64);
        for _ in 0..80 {
            let middle = (low * high).sqrt();
            if at(middle).iter().sum::<f64>() < wanted { low = middle } else { high = middle }
        }
        out.extend(at((low * high).sqrt()));
    }
    Ok(out)
}

/// Spectra that cover the bands.
pub(super) struct Spectra {
    pub(super) names: Vec<String>,
    pub(super) emissivity: Vec<Vec<f64>>,
    /// Bare metals among all, which are left out.
    pub(super) metals: usize,
    /// Spectra that do not cover the bands.
    pub(super) uncovered: usize,
}

impl Spectra {
    pub(super) fn of(library: &Library) -> Result<Self> {
        let nu = wavenumbers_cm1();
        let mut found = Self { names: Vec::new(), emissivity: Vec::new(), metals: 0, uncovered: 0 };
        for material in library.iter() {
            match material.emissivity(&nu) {
                Err(_) => found.uncovered += 1,
                Ok(e) if mean(&e) <= NO_METAL => found.metals += 1,
                Ok(e) => {
                    found.names.push(material.name().to_owned());
                    found.emissivity.push(e);
                }
            }
        }
        match found.names.len() {
            0..10 => Err(Error::malformed(
                format!(
                    "{} spectra that cover {} to {} cm^-1",
                    found.names.len(),
                    RANGE_CM1[0],
                    RANGE_CM1[1]
                ),
                "give a folder with at least ten of surfaces other than metals, as those of the ECOSTRESS library",
            )),
            _ => Ok(found),
        }
    }

    /// All spectra that have nothing to do with one: not itself, and none of the same kind by name.
    pub(super) fn others(&self, own: usize) -> Vec<&[f64]> {
        let kind = kind(&self.names[own]);
        let keep = |i: &usize| {
            *i != own && self::kind(&self.names[*i]) != kind && self.emissivity[*i] != self.emissivity[own]
        };
        (0..self.names.len()).filter(keep).map(|i| self.emissivity[i].as_slice()).collect()
    }
}

/// A name without numbers at its end, which count samples.
fn kind(name: &str) -> &str {
    name.trim_end_matches(|c: char| c.is_ascii_digit() || c == '-' || c == '_')
}

pub(super) fn mean(e: &[f64]) -> f64 {
    e.iter().sum::<f64>() / e.len().max(1) as f64
}

/// What spectra are like: mean, deviations of magnitude and shape, and where the shape's correlation has fallen to a quarter.
pub(super) fn smoothness(spectra: &[&[f64]]) -> Smoothness {
    let count = spectra.len().max(2) as f64;
    let means: Vec<f64> = spectra.iter().map(|e| mean(e)).collect();
    let middle = mean(&means);
    let magnitude = (means.iter().map(|m| (m - middle).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
    // Shapes about the mean shape.
    let bands = spectra.first().map_or(0, |e| e.len());
    let own_mean: Vec<f64> =
        (0..bands).map(|w| spectra.iter().zip(&means).map(|(e, m)| e[w] - m).sum::<f64>() / count).collect();
    let shape = |i: usize, w: usize| spectra[i][w] - means[i] - own_mean[w];
    let at_lag = |lag: usize| {
        let pairs = bands - lag;
        let each =
            (0..spectra.len()).map(|i| (0..pairs).map(|w| shape(i, w) * shape(i, w + lag)).sum::<f64>());
        each.sum::<f64>() / (count * pairs as f64)
    };
    let var = at_lag(0);
    let lag = (1..bands).find(|lag| at_lag(*lag) < 0.25 * var).unwrap_or(bands);
    Smoothness {
        mean: middle.clamp(0.0, 1.0),
        magnitude,
        shape: var.sqrt(),
        correlation_cm1: STEP_CM1 * lag as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines leave the means over 20 cm⁻¹ as they are.
    #[test]
    fn lines_keep_the_means() {
        let smooth: Vec<f64> = (0..97).map(|i| 0.5 + 0.4 * (f64::from(i) / 9.0).sin()).collect();
        let lined = with_lines(&smooth, 1.0).unwrap();
        for (a, b) in smooth.chunks(4).zip(lined.chunks(4)) {
            assert!((mean(a) - mean(b)).abs() < 1e-9);
        }
        assert!(lined.iter().zip(&smooth).any(|(a, b)| (a - b).abs() > 0.1));
        assert!(lined.iter().all(|e| (0.0..=1.0).contains(e)));
    }

    #[test]
    fn what_is_left_out_is_not_there() {
        let e = |x: f64| vec![x; 97];
        let spectra = Spectra {
            names: ["brick-1", "brick-2", "soil", "copy"].map(str::to_owned).to_vec(),
            emissivity: vec![e(0.9), e(0.91), e(0.95), e(0.9)],
            metals: 0,
            uncovered: 0,
        };
        assert_eq!(spectra.others(0), vec![e(0.95).as_slice()]);
        assert_eq!(spectra.others(2).len(), 3);
    }
}
