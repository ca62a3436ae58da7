//! What counts that are off together in all bands and pixels add to the deviations of temperatures.
//!
//! A temperature follows whitened counts by a row g ([`super::tangent`]): with counts off by z·s_w, one number z of deviation 1 for all
//! bands, it is off by z Σ_w g_w s_w/σ_w, whose square is added to its variance. Bands do not average it down, as they do noise: blackbodies
//! that are warmer than they are said to be make everything as much too cold.
//!
//! A cause whose amount θ̂ was found ([`super::judge`]) moves it by θ̂ Σ_w g_w d_w, d its slope in deviations of the noise; that is put in as
//! if it were a deviation, as what is found is but one of what may be.
//!
//! Units: counts for s and σ; K. Assumption: to first order. Source: [`hadar::calibration::blackbody`], where such errors are from.

use super::cause::{Cause, Effect};
use super::maps::Maps;
use super::model::Setting;
use super::pixel::NO_MATERIAL;
use super::shared::Shared;
use super::tangent::{Tangent, Tangents, dot};
use hadar::error::{Error, Result, check};
use rayon::prelude::*;

/// A cause that deviations have to hold.
#[derive(Debug, Clone, PartialEq)]
pub struct ToHold {
    /// What may be otherwise.
    pub cause: Cause,
    /// How much of it.
    pub amount: f64,
    /// By how much shared unknowns are off for a unit of it ([`super::Together::follow`]).
    pub follow: Vec<f64>,
}

/// Widens the deviations of the temperatures by an error of deviation `together` in each band (counts; none if empty), the same number of
/// deviations in all bands and pixels, by the largest of what the amounts of some causes do to each, and by what is not known of unknowns
/// that the whole cube shares.
///
/// # Errors
/// Maps of another setting, another number of bands, a deviation below 0, an unknown gain.
pub fn widen(
    setting: &Setting<'_>,
    maps: &mut Maps,
    together: &[f64],
    causes: &[ToHold],
    shared: Option<&Shared>,
) -> Result<()> {
    let (bands, lights) = (setting.bands.len(), setting.surroundings.len());
    let pixels = maps.material.len();
    for (what, found, expected) in [
        ("bands that are off together", together.len(), if together.is_empty() { 0 } else { bands }),
        ("temperatures of the maps", maps.temperature_k.len(), pixels),
        ("deviations of the maps", maps.temperature_sigma_k.len(), pixels),
        ("lighting factors", maps.lighting.len(), pixels * lights),
    ] {
        if found != expected {
            return Err(Error::Length { what: what.into(), found, expected });
        }
    }
    check::each(together, |s| s >= 0.0, |s| check::non_negative("deviation of a band", s, "counts"))?;
    let tangents = Tangents::new(setting)?;
    let row = tangents.of_temperature();
    let effect = |cause: &Cause| Effect::new(cause, setting, &tangents);
    let effects = causes.iter().map(|one| effect(&one.cause)).collect::<Result<Vec<_>>>()?;
    let together_estimated = shared.map_or_else(Vec::new, Shared::causes);
    let estimated = together_estimated.iter().map(effect).collect::<Result<Vec<_>>>()?;
    let Maps { material, temperature_k, temperature_sigma_k, lighting, .. } = maps;
    let one = |(tangent, lit, slope): &mut (Tangent, Vec<f64>, Vec<f64>), (i, sigma_k): (usize, &mut f32)| {
        hadar::stop::check();
        if material[i] == NO_MATERIAL || !sigma_k.is_finite() {
            return;
        }
        lit.clear();
        lit.extend(lighting[i * lights..(i + 1) * lights].iter().map(|v| f64::from(*v)));
        // Where nothing is scattered the lighting is no number, and tells nothing of the temperature.
        lit.iter_mut().filter(|v| v.is_nan()).for_each(|v| *v = 0.0);
        let (m, at_k) = (usize::from(material[i]), f64::from(temperature_k[i]));
        if !tangents.at(m, at_k, lit, tangent) {
            return;
        }
        let Some(g) = tangent.row(&row) else { return };
        let shares = g.iter().zip(&tangents.used).zip(&tangent.sigma);
        let off: f64 =
            shares.map(|((g, band), sigma)| g * together.get(*band).copied().unwrap_or(0.0) / sigma).sum();
        let mut moved_by = |effect: &Effect| {
            effect.slope(&tangents, (m, at_k, lit), tangent, slope);
            dot(&g, slope)
        };
        let by_shared: Vec<f64> = estimated.iter().map(&mut moved_by).collect();
        let moved = effects.iter().zip(causes).map(|(effect, one)| {
            let followed = dot(&by_shared, &one.follow);
            ((moved_by(effect) - followed) * one.amount).abs()
        });
        let moved = moved.fold(0.0, f64::max);
        let by_shared = shared.map_or(0.0, |shared| shared.sigma_of(&by_shared));
        *sigma_k = f64::from(*sigma_k).hypot(off).hypot(moved).hypot(by_shared) as f32;
    };
    temperature_sigma_k
        .par_iter_mut()
        .enumerate()
        .for_each_init(<(Tangent, Vec<f64>, Vec<f64>)>::default, one);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decompose::{Options, decompose};
    use hadar::cube::{Cube, MemoryCube, Shape};
    use hadar::planck::{photon_radiance, photon_radiance_slope};
    use hadar::spectrum::Bands;

    /// A blackbody whose counts are those of 70 mK more in all bands: the temperature is off by as much, whatever the noise. Errors of other
    /// shapes move it by the weighted mean of what each band says.
    #[test]
    fn counts_of_a_warmer_blackbody_are_a_warmer_blackbody() {
        let bands = Bands::uniform(800.0, 1200.0, 20.0).unwrap();
        let nodes = bands.nodes_cm1();
        let kappa = vec![1e-13; bands.len()];
        let counts = |t: f64| -> Vec<f64> {
            let all: Vec<f64> = nodes.iter().map(|nu| 1e-13 * photon_radiance(*nu, t)).collect();
            bands.weigh(&all)
        };
        let slope = |t: f64| -> Vec<f64> {
            let all: Vec<f64> = nodes.iter().map(|nu| 1e-13 * photon_radiance_slope(*nu, t)).collect();
            bands.weigh(&all)
        };
        let setting = Setting {
            bands: &bands,
            library: &[vec![1.0; nodes.len()]],
            surroundings: &[],
            counts_per_radiance: &kappa,
            var_added: &[],
            units_per_count: 1.0,
            temperature_k: [250.0, 350.0],
            lighting_total: None,
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        };
        let samples: Vec<f64> = [290.0, 310.0].into_iter().flat_map(counts).collect();
        let cube =
            Cube::F64(Box::new(MemoryCube::new(Shape::new(1, 2, bands.len()).unwrap(), samples).unwrap()));
        let maps = decompose(&setting, &Options::default(), &cube, &|_| ()).unwrap();
        let mut wider = maps.clone();
        let off: Vec<f64> = slope(310.0).iter().map(|d| 0.07 * d).collect();
        widen(&setting, &mut wider, &off, &[], None).unwrap();
        let added = |i: usize| {
            let [before, after] = [&maps, &wider].map(|maps| f64::from(maps.temperature_sigma_k[i]));
            (after * after - before * before).sqrt()
        };
        assert!((added(1) / 0.07 - 1.0).abs() < 1e-3, "{}", added(1));
        // At 290 K by hand: Σ N'·s/N over Σ N'²/N.
        let (n, d) = (counts(290.0), slope(290.0));
        let sums =
            n.iter().zip(&d).zip(&off).fold([0.0, 0.0], |[a, b], ((n, d), s)| [a + d * s / n, b + d * d / n]);
        assert!((added(0) / (sums[0] / sums[1]) - 1.0).abs() < 1e-3);
        assert!(widen(&setting, &mut wider, &[0.0], &[], None).is_err());
    }
}
