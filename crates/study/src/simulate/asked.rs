//! What a simulation is asked for, from a command line or by a program, checked and brought to a plan.

use super::{PhotonLaw, SimulationPlan};
use crate::Study;
use hadar::error::{Error, Result, check};
use hadar::units::Dimension;
use hadar_formats::file::text_of_file;
use hadar_simulate::classifier::{Method, SavedModel};
use hadar_simulate::experiment::Design;
use hadar_simulate::spectra::Parts;
use std::path::{Path, PathBuf};

/// Most true temperatures.
const MOST_TEMPERATURES: usize = 10_000;
/// Normalised photon numbers N d₀² that a sweep covers.
const SWEEP: [f64; 2] = [0.01, 10.0];

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationAsked {
    /// Who takes part; all where empty, unless there are models.
    pub classifiers: Vec<String>,
    /// Spectra of each class.
    pub spectra: usize,
    /// Photons of the target, one experiment each; the camera's where empty, or those required.
    pub photons: Vec<f64>,
    /// So many experiments over normalised photon numbers instead.
    pub sweep: Option<usize>,
    /// How photons are counted.
    pub law: PhotonLaw,
    /// Whether the camera's electronic noise is added.
    pub camera_noise: bool,
    /// Alternatives that are classes beside the target: the nearest one where empty, or `all`.
    pub against: Vec<String>,
    /// Files of classifiers that take part as they are.
    pub models: Vec<PathBuf>,
    /// Whether the likelihood ratio itself is drawn instead of spectra.
    pub skip_spectra: bool,
    /// Whether the spectra of the test come with the result.
    pub save_spectra: bool,
    /// Seed of the draws.
    pub seed: u64,
}

impl Study {
    /// What is asked for as a plan. Messages name the flags of the command line.
    ///
    /// # Errors
    /// A classifier that nobody knows, a model that cannot be read or is of another scene, too few spectra, photons that are not
    /// positive.
    pub fn plan(&self, asked: &SimulationAsked) -> Result<SimulationPlan> {
        let methods = if asked.classifiers.is_empty() && asked.skip_spectra {
            vec![Method::LikelihoodRatio]
        } else if asked.classifiers.is_empty() && asked.models.is_empty() {
            Method::ALL.to_vec()
        } else {
            let mut methods = Vec::new();
            for name in &asked.classifiers {
                let method = Method::from_name(name.trim())?;
                if !methods.contains(&method) {
                    methods.push(method);
                }
            }
            methods
        };
        let against = if asked.against == ["all"] {
            self.alternatives().iter().map(|surface| surface.name.clone()).collect()
        } else {
            asked.against.clone()
        };
        let models: Vec<SavedModel> = asked.models.iter().map(|path| saved(path)).collect::<Result<_>>()?;
        for (saved, path) in models.iter().zip(&asked.models) {
            self.check_model(saved, &against).map_err(|error| error.in_file(path))?;
        }
        Parts::of(asked.spectra).map_err(|error| error.for_key("--spectra"))?;
        for &photons in &asked.photons {
            check::positive("number of photons", photons, "").map_err(|error| error.for_key("--photons"))?;
        }
        let photons = match asked.sweep {
            Some(experiments) => self
                .sweep(SWEEP, experiments, &against, asked.camera_noise)
                .map_err(|error| error.for_key("--sweep"))?,
            None => asked.photons.clone(),
        };
        let (per_class, seed, skip_spectra) = (asked.spectra, asked.seed, asked.skip_spectra);
        Ok(SimulationPlan {
            photons,
            law: asked.law,
            camera_noise: asked.camera_noise,
            against,
            design: Design { per_class, methods, seed, level: 0.95, skip_spectra },
            models,
            save_spectra: asked.save_spectra,
        })
    }
}

fn saved(path: &Path) -> Result<SavedModel> {
    let text = text_of_file(path, "read the model")?;
    SavedModel::from_json(&text).map_err(|error| error.in_file(path))
}

/// True temperatures (K) of thermometry: so many over a range such as `30 degC..105 degC`, or a single one.
///
/// # Errors
/// What is no temperature, a range whose upper end comes first, one temperature for a range or more than 10 000.
pub fn true_temperatures(range: &str, count: usize) -> Result<Vec<f64>> {
    let at_flag = |error: Error| error.for_key("--thermometry");
    let temperature = |text: &str| Dimension::Temperature.parse(text).map_err(at_flag);
    let Some((low, high)) = range.split_once("..") else { return Ok(vec![temperature(range)?]) };
    if count < 2 {
        return Err(Error::out_of_range("--temperatures", count as f64, "", "at least 2 for a range"));
    }
    let ends = [low, high].map(str::trim);
    let (low, high) = (temperature(low)?, temperature(high)?);
    if low > high {
        let found = format!("the range goes from {} to {}", ends[0], ends[1]);
        let instead = format!("write the lower end first: \"{}..{}\"", ends[1], ends[0]);
        return Err(at_flag(Error::malformed(found, instead)));
    }
    if count > MOST_TEMPERATURES {
        let expected = format!("at most {MOST_TEMPERATURES}");
        return Err(Error::out_of_range("--temperatures", count as f64, "", expected));
    }
    let step = (high - low) / (count - 1) as f64;
    Ok((0..count).map(|i| (i as f64).mul_add(step, low)).collect())
}
