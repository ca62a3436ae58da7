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
use super::maps::{ByRows, Maps, Options, Row, check_bands, decompose, is_signed};
use super::model::{Model, Setting};
use super::pixel::Pixel;
use crate::cube::{CubeRef, Rows, Sample};
use crate::error::{Error, Result};

/// How material, temperature and lighting are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Maximum likelihood of material, temperature and lighting.
    #[default]
    Ml,
    /// The paper's inverse functions: the slope along wavenumber takes the lighting away (S46, S47).
    AnalyticInverse,
    /// Maximum likelihood of material and temperature, as if nothing were scattered.
    Te,
    /// The temperature of the blackbody that sends as much in all bands together.
    GreyBody,
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Ml, Self::AnalyticInverse, Self::Te, Self::GreyBody];

    /// Its name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ml => "ml",
            Self::AnalyticInverse => "analytic-inverse",
            Self::Te => "te",
            Self::GreyBody => "grey-body",
        }
    }

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
    if !method.has_likelihood() && setting.gain {
        let found = format!("an unknown gain and the method {}", method.name());
        return Err(Error::malformed(found, "calibrate the camera, or take the method ml or te"));
    }
    match (method, cube.into()) {
        (Method::Ml, cube) => decompose(setting, options, cube, done),
        (Method::Te, cube) => {
            let dark = Setting { surroundings: &[], lighting_total: None, ..*setting };
            let mut maps = decompose(&dark, options, cube, done)?;
            maps.lighting = vec![f32::NAN; maps.material.len() * setting.surroundings.len()];
            Ok(maps)
        }
        (_, cube @ CubeRef::F32(rows)) => compared(method, setting, rows, cube, done),
        (_, cube @ CubeRef::F64(rows)) => compared(method, setting, rows, cube, done),
    }
}

fn compared<S: Sample>(
    method: Method,
    setting: &Setting<'_>,
    rows: &dyn Rows<S>,
    cube: CubeRef<'_>,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Maps> {
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
    let all = |pixel: &(dyn Fn(&[f64]) -> Pixel + Sync)| -> Result<Vec<Row<Maps, ()>>> {
        let own = |room: &mut Vec<f64>, sample: &[S], _, _: &mut _, (): &mut ()| match counts(room, sample) {
            true => pixel(room),
            false => Pixel::SKIPPED,
        };
        by_rows.all(Vec::new, own, |pixels| Maps::of(&pixels, setting.surroundings.len()))
    };
    let rows = match method {
        Method::GreyBody => {
            let grey = GreyBody::new(setting, &used);
            all(&|counts| grey.pixel(counts))
        }
        _ => {
            let inverse = Inverse::new(setting)?;
            all(&|counts| inverse.pixel(counts))
        }
    }?;
    Ok(Maps::joined(rows))
}
