//! By which method a cube is decomposed: maximum likelihood, or one that it is compared with.
//!
//! | method | what is taken for true | what it has no notion of |
//! |---|---|---|
//! | ml | S = e(m)·B(T) + (1 − e)·Σₖ Vₖ Sₖ | |
//! | te | S = e(m)·B(T), nothing is scattered | lighting |
//! | analytic-inverse | the lighting has no slope along wavenumber ([`super::inverse`]) | posterior, residual, deviation |
//! | grey-body | S = B(T), all bands together ([`super::grey_body`]) | all but the temperature |
//!
//! `te` is the likelihood of `ml` in a scene without surroundings: its deviations, p-values and candidates are those of that model,
//! and wrong where light is scattered. What a method has no notion of is NaN, no material, no candidate; flags that follow from it
//! are not raised.
//!
//! Source: paper S46, S47, Fig. S20.

use super::grey_body::GreyBody;
use super::inverse::Inverse;
use super::maps::{Blocks, ByRows, Layers, Maps, Options, check_bands, is_signed, likeliest};
use super::model::Model;
use super::pixel::Pixel;
use super::setting::Setting;
use hadar::cube::{CubeRef, Rows, Sample};
use hadar::error::{Error, Result};

hadar::named! {
    /// How material, temperature and lighting are found.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Method {
        /// Maximum likelihood of material, temperature and lighting.
        #[default]
        Ml = "ml",
        /// The paper's inverse functions: the slope along wavenumber takes the lighting away (S46, S47).
        AnalyticInverse = "analytic-inverse",
        /// Maximum likelihood of material and temperature, as if nothing were scattered.
        Te = "te",
        /// The temperature of the blackbody that sends as much in all bands together.
        GreyBody = "grey-body",
    }
    /// Its name in files and on the command line.
    name
}

impl Method {
    /// Whether it names materials.
    #[must_use]
    pub const fn names_materials(self) -> bool {
        !matches!(self, Self::GreyBody)
    }

    /// Whether it has a likelihood: deviations, residuals, candidates.
    #[must_use]
    pub const fn has_likelihood(self) -> bool {
        matches!(self, Self::Ml | Self::Te)
    }
}

/// Decomposes a cube of counts; `done` is told how many rows are finished.
///
/// # Errors
/// A setting that is impossible or of another number of bands than the cube; a cube that cannot be read.
pub fn decompose<'c>(
    setting: &Setting<'_>,
    options: &Options,
    cube: impl Into<CubeRef<'c>>,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Maps> {
    decompose_by(Method::Ml, setting, options, cube, done)
}

/// Decomposes a cube by a method, as [`decompose`] does by maximum likelihood. Priors and errors of the library are those of the
/// methods with a likelihood.
///
/// # Errors
/// As [`decompose`]; an unknown gain, which the analytic inverse and the grey body do not know.
pub fn decompose_by<'c>(
    method: Method,
    setting: &Setting<'_>,
    options: &Options,
    cube: impl Into<CubeRef<'c>>,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Maps> {
    let mut all = Maps::default();
    let take = &mut |_: usize, maps: Maps| {
        all = maps;
        Ok(())
    };
    decompose_by_rows(method, setting, options, cube, (usize::MAX, take), done)?;
    Ok(all)
}

/// [`decompose_by`] for maps that are too large to be kept: so many rows at once, whose maps `take` is given with the first of the rows,
/// one block after the other. With a prior over the image all rows are one block.
///
/// # Errors
/// As [`decompose_by`], and what `take` refuses.
pub fn decompose_by_rows<'c>(
    method: Method,
    setting: &Setting<'_>,
    options: &Options,
    cube: impl Into<CubeRef<'c>>,
    (height, take): (usize, &mut dyn FnMut(usize, Maps) -> Result<()>),
    done: &(dyn Fn(usize) + Sync),
) -> Result<()> {
    if !method.has_likelihood() && setting.gain {
        let found = format!("an unknown gain and the method {}", method.name());
        return Err(Error::malformed(found, "calibrate the camera, or take the method ml or te"));
    }
    match (method, cube.into()) {
        (Method::Ml, cube) => likeliest(setting, options, cube, (height, take), done),
        (Method::Te, cube) => {
            let dark = Setting { surroundings: &[], lighting_total: None, ..*setting };
            let mut unlit = |first: usize, mut maps: Maps| {
                maps.lighting = vec![f32::NAN; maps.material.len() * setting.surroundings.len()];
                maps.lighting_sigma.clone_from(&maps.lighting);
                take(first, maps)
            };
            likeliest(&dark, options, cube, (height, &mut unlit), done)
        }
        (_, cube @ CubeRef::F32(rows)) => {
            compared(method, (setting, options), (rows, cube), (height, take), done)
        }
        (_, cube @ CubeRef::F64(rows)) => {
            compared(method, (setting, options), (rows, cube), (height, take), done)
        }
    }
}

fn compared<S: Sample>(
    method: Method,
    (setting, options): (&Setting<'_>, &Options),
    (rows, cube): (&dyn Rows<S>, CubeRef<'_>),
    (height, take): Blocks<'_>,
    done: &(dyn Fn(usize) + Sync),
) -> Result<()> {
    check_bands(setting, cube)?;
    let signed = is_signed(&Model::new(setting)?);
    let by_rows = ByRows { cube: rows, signed, done };
    let per_unit = 1.0 / setting.units_per_count;
    let used: Vec<usize> = (0..setting.bands.len()).filter(|w| !setting.bad_bands.contains(w)).collect();
    let counts = |room: &mut Vec<f64>, sample: &[S]| {
        room.clear();
        room.extend(used.iter().map(|&band| {
            let value: f64 = sample[band].into();
            per_unit * value
        }));
        room.iter().all(|n| n.is_finite())
    };
    let layers = Layers {
        surroundings: setting.surroundings.len(),
        categories: false,
        ranked: options.ranked,
        other: false,
        mixed: false,
    };
    let mut all = |pixel: &(dyn Fn(&[f64]) -> Pixel + Sync)| {
        let own = |room: &mut Vec<f64>, sample: &[S], _, _: &mut _, _: &mut _| match counts(room, sample) {
            true => pixel(room),
            false => Pixel::SKIPPED,
        };
        by_rows.in_blocks((height, &mut *take), Vec::new, own, layers)
    };
    match method {
        Method::GreyBody => {
            let grey = GreyBody::new(setting, &used)?;
            all(&|counts| grey.pixel(counts))
        }
        _ => {
            let inverse = Inverse::new(setting)?;
            all(&|counts| inverse.pixel(counts))
        }
    }
}
