//! Unknowns that the whole cube shares (`[unknown]`), estimated with its pixels.
//!
//! First from few pixels, then from [`LOOKED`]; what is asked for is in [`crate::shared_unknown`].

use super::DecomposeStudy;
use crate::cube_sample::{LOOKED, some};
use crate::shared_unknown::{Of, Stated};
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar_estimate::decompose::{Method, Options, Shared, Told, Unknown, estimate};
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
    /// The estimate of each unknown that all pixels share.
    pub unknowns: Vec<SharedRow>,
    /// By how much all noise is larger than told; 1 where that is not asked.
    pub noise_factor: f64,
    /// Pixels that tell of them; none where the prior is all that is known.
    pub pixels: usize,
    /// Whether the last round moved nothing.
    pub settled: bool,
    /// By how much χ² of a pixel is off on average as they are not known; nothing where the prior is all that is known.
    pub off_chi_square_mean: Option<f64>,
    /// Whether materials can be decided with what is known of them.
    pub told: bool,
}

/// One of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SharedRow {
    /// Which one.
    #[serde(flatten)]
    pub stated: Stated,
    /// By how much it is otherwise than told.
    pub estimate: f64,
    /// Deviation of that, together with all others.
    pub sigma: f64,
    /// Others, by their places in this list, from which the pixels do not distinguish it.
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
        if stated == SharedUnknown::default() && study.found.is_empty() {
            return Ok(None);
        }
        let refused = |key: &str, found: String, instead: &str| {
            Err(Error::malformed(found, instead).at(study.scenario.place(key)))
        };
        if method != Method::Ml {
            if let Some(one) = study.found.first() {
                let found = format!("surroundings found in the cube and the method {}", method.name());
                let key = format!("environment[{}].found", one.light);
                return refused(&key, found, "give their spectra or temperatures, or take --method ml");
            }
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
            found: &study.found,
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
        let options =
            Options { spatial: None, other: None, mixed: None, categories: Vec::new(), ..options.clone() };
        let found = estimate(&study.told, &unknowns, stated.noise_scale, &options, &samples)
            .and_then(|shared| Ok(Self { told: shared.put_into(&study.told)?, shared }));
        found.map(Some).map_err(|error| study.at_cube(error))
    }

    /// Whether materials can be decided.
    pub(super) fn is_told(&self) -> bool {
        self.shared.settled
            && self.shared.pixels > 0
            && self.shared.off_chi_square_mean.is_some_and(|off| off < HARMLESS)
    }

    pub(super) fn found(&self) -> SharedFound {
        let shared = &self.shared;
        let row = |(i, one): (usize, &Unknown)| SharedRow {
            stated: Stated::of(one),
            estimate: shared.amounts[i],
            sigma: shared.sigma(i),
            same_as: shared.same.iter().filter(|pair| pair.contains(&i)).map(|[a, b]| a + b - i).collect(),
        };
        SharedFound {
            unknowns: shared.unknowns.iter().enumerate().map(row).collect(),
            noise_factor: shared.noise,
            pixels: shared.pixels,
            settled: shared.settled,
            off_chi_square_mean: shared.off_chi_square_mean,
            told: self.is_told(),
        }
    }
}
