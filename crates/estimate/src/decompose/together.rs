//! What counts that are off together in all bands and pixels add to the deviations of temperatures, lighting factors and textures.
//!
//! A temperature follows whitened counts by a row g ([`super::tangent`]): with counts off by z·s_w, one number z of deviation 1 for all
//! bands, it is off by z Σ_w g_w s_w/σ_w, whose square is added to its variance. Bands do not average it down, as they do noise: blackbodies
//! that are warmer than they are said to be make everything as much too cold.
//!
//! A cause whose amount θ̂ was found ([`super::judge`]) moves it by θ̂ Σ_w g_w d_w, d its slope in deviations of the noise; that is put in as
//! if it were a deviation, as what is found is but one of what may be.
//!
//! A lighting factor and a texture follow rows of their own. Where a cause is in a light itself, the texture X = Σ Vₖ Lₖ has what it does to
//! Lₖ besides: of a light that is brighter by a share V is found lower by it, and X is right.
//!
//! Units: counts for s and σ; K. Assumption: to first order. Source: [`hadar::calibration::blackbody`], where such errors are from.

use super::cause::Cause;
use super::effect::Effect;
use super::maps::Maps;
use super::pixel::{NO_MATERIAL, flag};
use super::possible::ANYTHING;
use super::setting::Setting;
use super::shared::Shared;
use super::tangent::{Tangent, Tangents, dot};
use hadar::error::{Error, Result, check};
use rayon::prelude::*;

/// χ² of a pixel that what is not known of the shared unknowns may move before its material is undecided: noise along them is then larger by an
/// eighth.
const HARMLESS: f64 = 0.25;

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

/// Widens the deviations of temperatures, lighting factors and textures by an error of deviation `together` in each band (counts; none if
/// empty), the same number of deviations in all bands and pixels, by the largest of what the amounts of some causes do to each, and by what
/// is not known of unknowns that the whole cube shares. Pixels whose χ² that may move have any material left.
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
        ("deviations of lighting factors", maps.lighting_sigma.len(), pixels * lights),
        ("deviations of textures", maps.texture_sigma.len(), pixels),
    ] {
        if found != expected {
            return Err(Error::Length { what: what.into(), found, expected });
        }
    }
    check::each(together, |s| s >= 0.0, |s| check::non_negative("deviation of a band", s, "counts"))?;
    let tangents = Tangents::new(setting)?;
    let effect = |cause: &Cause| Effect::new(cause, setting, &tangents);
    let effects = causes.iter().map(|one| Ok((effect(&one.cause)?, one))).collect::<Result<Vec<_>>>()?;
    let together_estimated = shared.map_or_else(Vec::new, Shared::causes);
    let estimated = together_estimated.iter().map(effect).collect::<Result<Vec<_>>>()?;
    let followed = Followed::all(setting);
    let wider = Wider { together, effects, estimated, shared, followed, tangents };
    let Maps {
        material,
        temperature_k,
        temperature_sigma_k,
        lighting,
        lighting_sigma,
        texture_sigma,
        candidates,
        flags,
        possible_95,
        common_95,
        possible_99,
        category_shares,
        ..
    } = maps;
    let mut rest = lighting_sigma.as_mut_slice();
    let of_lights: Vec<&mut [f32]> = (0..pixels)
        .filter_map(|_| {
            let (own, others) = std::mem::take(&mut rest).split_at_mut_checked(lights)?;
            rest = others;
            Some(own)
        })
        .collect();
    let each = temperature_sigma_k.par_iter_mut().zip(texture_sigma.par_iter_mut()).zip(of_lights);
    let one = |room: &mut Room, (i, ((sigma_k, of_texture), of_lights)): (usize, Sigmas<'_>)| {
        hadar::stop::check();
        if material[i] == NO_MATERIAL {
            return 0.0;
        }
        room.lit.clear();
        room.lit.extend(lighting[i * lights..(i + 1) * lights].iter().map(|v| f64::from(*v)));
        // Where nothing is scattered the lighting is no number, and tells nothing of the temperature.
        room.lit.iter_mut().filter(|v| v.is_nan()).for_each(|v| *v = 0.0);
        // What emits nothing sends the same at any temperature.
        let at_k = Some(f64::from(temperature_k[i])).filter(|t| t.is_finite());
        let at_k = at_k.unwrap_or(setting.temperature_k[0]);
        let sigmas = std::iter::once(sigma_k).chain(of_lights).chain([of_texture]);
        wider.widen(usize::from(material[i]), at_k, room, sigmas)
    };
    let off: Vec<f64> = each.enumerate().map_init(Room::default, one).collect();
    let categories = category_shares.len() / pixels.max(1);
    // Where what is not known of the cube may move χ², materials were compared at one of its values only.
    for i in (0..pixels).filter(|i| off[*i] > HARMLESS) {
        if let (Some(candidates), Some(flags)) = (candidates.get_mut(i), flags.get_mut(i)) {
            *candidates = setting.library.len().max(2) as u16;
            *flags |= flag::UNDECIDED;
        }
        [&mut *possible_95, &mut *common_95, &mut *possible_99]
            .into_iter()
            .filter_map(|sets| sets.get_mut(i))
            .for_each(|set| *set = ANYTHING);
        category_shares.iter_mut().skip(i * categories).take(categories).for_each(|share| *share = f32::NAN);
    }
    Ok(())
}

/// Deviations of the temperature, the texture and the lighting factors of a pixel.
type Sigmas<'a> = ((&'a mut f32, &'a mut f32), &'a mut [f32]);

/// Something of a pixel that its counts tell.
#[derive(Debug)]
enum Followed {
    Temperature,
    /// A lighting factor.
    Lighting(Vec<f64>),
    /// The texture, by those of the lights.
    Texture(Vec<f64>),
}

impl Followed {
    /// The temperature, the lighting factors, the texture.
    fn all(setting: &Setting<'_>) -> Vec<Self> {
        let lights = setting.surroundings.len();
        let one = |k: usize| Self::Lighting((0..lights).map(|j| f64::from(u8::from(j == k))).collect());
        let lighting = (0..lights).map(one);
        std::iter::once(Self::Temperature)
            .chain(lighting)
            .chain([Self::Texture(setting.textures())])
            .collect()
    }

    fn form(&self, tangents: &Tangents) -> Vec<f64> {
        match self {
            Self::Temperature => tangents.of_temperature(),
            Self::Lighting(a) | Self::Texture(a) => tangents.of_lighting(a),
        }
    }

    /// What a unit of a cause changes of it itself, whatever the counts say.
    fn itself(&self, tangents: &Tangents, effect: &Effect, lit: &[f64]) -> f64 {
        match self {
            Self::Temperature => 0.0,
            Self::Lighting(a) => effect.of_lighting(a, lit),
            Self::Texture(a) => effect.of_lighting(a, lit) + effect.of_lights(tangents, lit),
        }
    }
}

/// Room for one pixel.
#[derive(Debug, Default)]
struct Room {
    tangent: Tangent,
    lit: Vec<f64>,
    /// Of each effect.
    slopes: Vec<Vec<f64>>,
}

/// By what deviations are widened.
#[derive(Debug)]
struct Wider<'a> {
    together: &'a [f64],
    /// Causes, each with its effect.
    effects: Vec<(Effect, &'a ToHold)>,
    estimated: Vec<Effect>,
    shared: Option<&'a Shared>,
    followed: Vec<Followed>,
    tangents: Tangents,
}

impl Wider<'_> {
    /// Widens the deviations of what is followed of a pixel of material `m`; by how much its χ² is off on average as the shared unknowns are
    /// not known.
    fn widen<'s>(
        &self,
        m: usize,
        at_k: f64,
        room: &mut Room,
        sigmas: impl Iterator<Item = &'s mut f32>,
    ) -> f64 {
        let Self { tangents, effects, estimated, .. } = self;
        let Room { tangent, lit, slopes } = room;
        if !tangents.at(m, at_k, lit, tangent) {
            return 0.0;
        }
        let effects = || effects.iter().map(|(effect, _)| effect).chain(estimated);
        slopes.resize_with(effects().count(), Vec::new);
        for (effect, slope) in effects().zip(slopes.iter_mut()) {
            effect.slope(tangents, (m, at_k, lit), tangent, slope);
        }
        for (followed, sigma) in self.followed.iter().zip(sigmas).filter(|(_, sigma)| sigma.is_finite()) {
            let Some(g) = tangent.row(&followed.form(tangents)) else { continue };
            let shares = g.iter().zip(&tangents.used).zip(&tangent.sigma);
            let off = |((g, band), sigma): ((&f64, &usize), &f64)| {
                g * self.together.get(*band).copied().unwrap_or(0.0) / sigma
            };
            let off: f64 = shares.map(off).sum();
            let moved_by: Vec<f64> = effects()
                .zip(slopes.iter())
                .map(|(effect, slope)| dot(&g, slope) - followed.itself(tangents, effect, lit))
                .collect();
            let (moved, by_shared) = moved_by.split_at(self.effects.len());
            let moved = moved.iter().zip(&self.effects);
            let moved = moved.map(|(by, (_, one))| ((by - dot(by_shared, &one.follow)) * one.amount).abs());
            let moved = moved.fold(0.0, f64::max);
            let by_shared = self.shared.map_or(0.0, |shared| shared.sigma_of(by_shared));
            *sigma = f64::from(*sigma).hypot(off).hypot(moved).hypot(by_shared) as f32;
        }
        let Some(shared) = self.shared else { return 0.0 };
        let own = &mut slopes[self.effects.len()..];
        own.iter_mut().for_each(|slope| tangent.take_out(slope));
        shared.off_chi_square(&|a, b| dot(&own[a], &own[b]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decompose::judge::tests::{EXACT, Otherwise, causes, counted, state, told};
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

    /// A cube that is decomposed with a little of each cause: temperatures, lighting factors and textures move by what they are widened.
    #[test]
    fn what_causes_move_is_what_another_fit_finds() {
        let told = told();
        let setting = told.setting();
        let cube = counted(|n| n, Otherwise::default(), &EXACT);
        let plain = decompose(&setting, &Options::default(), &cube, &|_| ()).unwrap();
        let texture = |of: &Maps, i: usize, lights: &[f64]| -> f64 {
            lights.iter().zip(&of.lighting[2 * i..]).map(|(light, v)| light * f64::from(*v)).sum()
        };
        let lights = setting.textures();
        for cause in causes(&setting) {
            let h = match cause {
                Cause::WavelengthShift(_) => 0.2,
                Cause::LightTemperature { .. } => 0.1,
                Cause::Air { .. } => 1.0,
                Cause::LightingTotal => -1e-3,
                _ => 1e-3,
            };
            let other = told.with(&cause, h).unwrap();
            let found = decompose(&other.setting(), &Options::default(), &cube, &|_| ()).unwrap();
            let mut wider = plain.clone();
            wider.temperature_sigma_k.fill(1e-9);
            wider.lighting_sigma.fill(1e-9);
            wider.texture_sigma.fill(1e-9);
            let to_hold = ToHold { cause: cause.clone(), amount: h, follow: Vec::new() };
            widen(&setting, &mut wider, &[], &[to_hold], None).unwrap();
            for i in (0..60).filter(|i| (0.2..0.8).contains(&state(*i).2) && found.flags[*i] == 0) {
                let close = |what: &str, moved: f64, said: f32, whole: f64| {
                    let off = (moved.abs() - f64::from(said)).abs();
                    assert!(off < 0.05 * moved.abs() + 2e-5 * whole, "{cause:?} {i} {what}: {moved} {said}");
                };
                let t = f64::from(found.temperature_k[i]) - f64::from(plain.temperature_k[i]);
                close("T", t, wider.temperature_sigma_k[i], 10.0);
                for k in [2 * i, 2 * i + 1] {
                    let v = f64::from(found.lighting[k]) - f64::from(plain.lighting[k]);
                    close("V", v, wider.lighting_sigma[k], 1.0);
                }
                let x = texture(&found, i, &other.setting().textures()) - texture(&plain, i, &lights);
                close("X", x, wider.texture_sigma[i], lights[1]);
            }
        }
    }
}
