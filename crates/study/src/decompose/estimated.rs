//! Unknowns that the whole cube shares (`[unknown]`), estimated with its pixels.
//!
//! First from few pixels, then from [`LOOKED`]; what is asked for is in [`crate::shared_unknown`].

use super::DecomposeStudy;
use crate::cube_sample::{LOOKED, some};
use crate::model_judged::said;
use crate::shared_unknown::Of;
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar_estimate::decompose::{Cause, Method, Options, Shared, Told, Unknown, estimate};
use hadar_scenario::decompose::SharedUnknown;
use serde::Serialize;

/// Pixels of the first rounds.
const FIRST: usize = 1 << 11;
/// χ² of a pixel that what is not known of the unknowns may move before nothing is decided.
const HARMLESS: f64 = 0.1;
/// Prior deviations from which on an estimate speaks against its prior.
pub(super) const AGAINST: f64 = 4.5;

/// What was estimated for the whole cube.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SharedFound {
    /// Each of the unknowns.
    pub unknowns: Vec<SharedRow>,
    /// By how much all noise is larger than told; 1 where that is not asked.
    pub noise_factor: f64,
    /// Pixels that tell of them; none where the prior is all that is known.
    pub pixels: usize,
    /// Whether the last round moved nothing.
    pub settled: bool,
    /// By how much χ² of a pixel is off on average as they are not known.
    pub off_chi_square: f64,
    /// Whether materials can be decided with what is known of them.
    pub told: bool,
}

/// One of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SharedRow {
    /// `gain`, `wavelength-shift`, `light-scale`, `light-shape`, `light-temperature`, `light-missing` or `air`.
    pub unknown: &'static str,
    /// Which of the surroundings, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<usize>,
    /// Order of the polynomial of a shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<usize>,
    /// Deviation that was stated.
    pub sigma_stated: f64,
    /// By how much it is otherwise than told.
    pub estimate: f64,
    /// Deviation of that, together with all others.
    pub sigma: f64,
    /// `cm^-1`, `K`, `m`, or nothing for a share.
    pub unit: &'static str,
    /// Others, by their places in this list, from which the pixels do not tell it apart.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub same_as: Vec<usize>,
}

/// Estimates, and the setting with them.
#[derive(Debug)]
pub(super) struct Estimated {
    pub(super) shared: Shared,
    pub(super) told: Told,
}

impl Estimated {
    /// Nothing where nothing is asked for.
    pub(super) fn of(study: &DecomposeStudy, method: Method, options: &Options) -> Result<Option<Self>> {
        let stated = study.scenario.unknown.shared;
        if stated == SharedUnknown::default() {
            return Ok(None);
        }
        let refused = |key: &str, found: String, instead: &str| {
            Err(Error::malformed(found, instead).at(study.scenario.place(key)))
        };
        if method != Method::Ml {
            let found = format!("unknowns of the whole cube and the method {}", method.name());
            return refused("unknown", found, "leave them out, or take --method ml");
        }
        if study.told.gain {
            let found = "an unknown gain of every pixel beside unknowns of the whole cube".to_owned();
            return refused(
                "unknown.gain",
                found,
                "write gain = 0.02, the deviation of one for the whole cube",
            );
        }
        let unknowns = Of {
            told: &study.told,
            environment: &study.scenario.environment,
            sky: study.scenario.vision.sky,
            spectra: &study.spectra,
            air: study.air.as_ref(),
            source: &study.scenario.source,
        }
        .unknowns(&stated)?;
        let of = |most: usize| -> Result<Cube> {
            Ok(match &study.cube {
                Cube::F32(rows) => Cube::F32(Box::new(some(rows.as_ref(), most)?)),
                Cube::F64(rows) => Cube::F64(Box::new(some(rows.as_ref(), most)?)),
            })
        };
        let shape = study.cube.shape();
        let few = shape.rows() * shape.columns() <= FIRST;
        let samples = if few { vec![of(LOOKED)?] } else { vec![of(FIRST)?, of(LOOKED)?] };
        let options = Options { spatial: None, categories: Vec::new(), ..options.clone() };
        let found = estimate(&study.told, &unknowns, stated.noise_scale, &options, &samples)
            .and_then(|shared| Ok(Self { told: shared.put_into(&study.told)?, shared }));
        found.map(Some).map_err(|error| study.at_cube(error))
    }

    /// Whether materials can be decided.
    pub(super) fn is_told(&self) -> bool {
        self.shared.settled && self.shared.pixels > 0 && self.shared.off_chi_square < HARMLESS
    }

    pub(super) fn found(&self) -> SharedFound {
        let shared = &self.shared;
        let row = |(i, one): (usize, &Unknown)| {
            let (unknown, light, _, unit) = said(&one.cause);
            let order = match one.cause {
                Cause::LightShape { order, .. } => Some(order),
                _ => None,
            };
            SharedRow {
                unknown: if order.is_some() { "light-shape" } else { unknown },
                light,
                order,
                sigma_stated: one.sigma,
                estimate: shared.amounts[i],
                sigma: shared.sigma(i),
                unit,
                same_as: shared
                    .same
                    .iter()
                    .filter(|pair| pair.contains(&i))
                    .map(|[a, b]| a + b - i)
                    .collect(),
            }
        };
        SharedFound {
            unknowns: shared.unknowns.iter().enumerate().map(row).collect(),
            noise_factor: shared.noise,
            pixels: shared.pixels,
            settled: shared.settled,
            off_chi_square: if shared.off_chi_square.is_finite() { shared.off_chi_square } else { 0.0 },
            told: self.is_told(),
        }
    }
}
