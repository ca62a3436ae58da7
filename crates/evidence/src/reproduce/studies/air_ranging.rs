//! How well a distance can be read from the air on the path, in a scene like the published ones.
//!
//! A wall under a clear sky, 256 bands of 8 to 13 µm, 15 to 150 m: the bound over distance with more and less unknown, maximum likelihood
//! beside it, what a model without sky finds, what each band tells, the best four bands, the bound over the contrast of target and air and
//! over what is known of the emissivity, and stereo beside it all.

mod files;
mod found;
mod scenes;
mod text;

use crate::reproduce::order::{Effort, Order, Progress};
use found::{BANDS, Found, TRIALS};
use hadar::error::Result;
use hadar::material::Library;
use hadar_report::air_ranging;
use hadar_report::bundle::Bundle;
use hadar_study::air_ranging::{AirPlan, AirPoint};
use scenes::Scene;

/// Seed of the committed report.
const SEED: u64 = 20;
/// Distances, m; the quick form has the first.
const DISTANCES_M: [f64; 10] = [15.0, 20.0, 25.0, 32.0, 42.0, 54.0, 70.0, 90.0, 120.0, 150.0];
const QUICK: usize = 2;
/// Temperatures of the target less that of the air, K.
const CONTRASTS_K: [f64; 15] =
    [-10.0, -7.0, -5.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0];
/// Deviations of the emissivity.
const ERRORS: [f64; 5] = [0.001, 0.003, 0.01, 0.03, 0.1];
/// Noises of a band, µflick.
const NOISES: [f64; 6] = [0.3, 1.0, 3.0, 10.0, 30.0, 100.0];
/// Textures of a wall that stereo matches, and how far.
const TEXTURES: [f64; 3] = [1e-2, 1e-3, 1e-4];
const FAR_M: [f64; 2] = [15.0, 5000.0];

/// The quick form has the tables of the first distances.
pub(super) fn make(order: Order, library: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let seed = order.seed_from(SEED);
    let distances = order.some_of(&DISTANCES_M, QUICK);
    let plan = AirPlan { trials: TRIALS, seed, bands: Some(BANDS) };
    let scene = Scene::default().over(distances);
    let main = scene.study(library)?.range(&plan, progress)?;
    let mut bundle = Bundle::default();
    let tables = [
        ("distances.csv", air_ranging::distances(&main.curve)),
        ("estimates.csv", air_ranging::estimates(&main)),
    ];
    for (name, table) in tables {
        bundle.add_table(name, files::rounded(&table))?;
    }
    if order.effort == Effort::Quick {
        let finding = text::quick(&main);
        return Ok((bundle, finding));
    }
    let at = |scene: Scene| -> Result<AirPoint> {
        Ok(scene.over(&DISTANCES_M[..1]).study(library)?.range(&AirPlan::default(), &|_, _| {})?.at)
    };
    let contrast = |&by_k: &f64| Ok((by_k, at(Scene { contrast_k: by_k, ..Scene::default() })?));
    let error = |&sigma: &f64| Ok((sigma, at(Scene { emissivity_error: sigma, ..Scene::default() })?));
    let far = |&texture: &f64| {
        let scene = Scene { texture, ..Scene::default() }.between(FAR_M);
        Ok((texture, scene.study(library)?.range(&AirPlan::default(), &|_, _| {})?))
    };
    let noise = |&noise_microflick: &f64| {
        let scene = Scene { noise_microflick, ..Scene::default() }.over(&[100.0]);
        let found =
            scene.study(library)?.range(&AirPlan { trials: TRIALS, seed, bands: None }, &|_, _| {})?;
        Ok(found.witness.into_iter().next().map(|one| (noise_microflick, one)))
    };
    let noises: Vec<Option<_>> = NOISES.iter().map(noise).collect::<Result<_>>()?;
    let found = Found {
        noises: noises.into_iter().flatten().collect(),
        contrasts: CONTRASTS_K.iter().map(contrast).collect::<Result<_>>()?,
        errors: ERRORS.iter().map(error).collect::<Result<_>>()?,
        stereo: TEXTURES.iter().map(far).collect::<Result<_>>()?,
        main,
        seed,
    };
    let plots = [air_ranging::error_over_distance(&found.main), air_ranging::information(&found.main)];
    let plots = plots.into_iter().chain(air_ranging::bias(&found.main));
    let plots: Vec<_> = plots.chain([files::contrast(&found), files::stereo(&found)]).collect();
    bundle.add("README.md", text::readme(&found));
    bundle.add_asked("scenario.toml", scene.text());
    bundle.add_plots(&plots)?;
    let finding = text::finding(&found);
    Ok((bundle, finding))
}
