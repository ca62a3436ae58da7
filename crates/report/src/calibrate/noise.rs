//! The noise of a camera, as files: variances of the bands, the camera's figures, variance over mean as a picture.

pub use crate::words::calibrate::noise::text;

use crate::bundle::Bundle;
use crate::figures::Plot;
use crate::plot::{Axis, LineFigure, Series};
use crate::table::{Table, number, optional};
use crate::text::numbers::some;
use crate::words::calibrate::noise::{camera, each_point};
use hadar::error::Result;
use hadar_estimate::calibrate::{Line, OfBand};
use hadar_study::calibrate::{NoiseFound, PhotonNoise};

/// Curves of a figure.
const MOST: usize = 6;

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(result: &NoiseFound) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    if let Some(found) = &result.photons {
        bundle.add_table("noise.csv", bands(found))?;
        // What other commands read is not written where nothing of it follows.
        if found.usable {
            bundle.add_table("variance.csv", variances(found))?;
        }
        if result.is_independent() {
            bundle.add_table("sigma.csv", sigmas(found))?;
        }
    }
    if let Some(camera) = camera(result) {
        bundle.add("camera.toml", camera);
    }
    bundle.add_warnings(&result.warnings)?;
    bundle.add_plots(&result.photons.iter().map(transfer).collect::<Vec<_>>())?;
    Ok(bundle)
}

/// What was found of each band.
fn bands(result: &PhotonNoise) -> Table {
    let of = |band: &OfBand, value: fn(&Line) -> f64| optional(band.line.as_ref().map(value));
    let bands: Vec<(usize, &OfBand)> = result.transfer.bands.iter().enumerate().collect();
    Table::of(
        &bands,
        &[
            ("band", &|(i, _)| i.to_string()),
            ("mean_of_all", &|(_, band)| number(band.mean_of_all)),
            ("mean", &|(_, band)| number(band.mean)),
            ("variance", &|(_, band)| number(band.variance)),
            ("variance_sigma", &|(_, band)| number(band.sigma_variance)),
            ("texture_share", &|(_, band)| number(band.texture)),
            ("electronic_variance", &|(_, band)| of(band, |line| line.electronic)),
            ("electronic_variance_sigma", &|(_, band)| of(band, |line| line.sigma_electronic)),
            ("per_photon", &|(_, band)| of(band, |line| line.per_photon)),
            ("per_photon_sigma", &|(_, band)| of(band, |line| line.sigma_per_photon)),
            ("gain_variance", &|(_, band)| of(band, |line| line.spread)),
            ("gain_variance_sigma", &|(_, band)| of(band, |line| line.sigma_spread)),
        ],
    )
}

/// Variance of the electronic noise in photons squared, as the `[cube]` of a ranging scenario reads it.
fn variances(result: &PhotonNoise) -> Table {
    let common = &result.transfer.common;
    let variance = common.noise_electrons().powi(2);
    let variance = number(if variance.is_finite() { variance } else { 0.0 });
    let mut table = Table::new(["band", "variance_counts2"]);
    (0..result.transfer.bands.len()).for_each(|band| table.push(vec![band.to_string(), variance.clone()]));
    table
}

/// Deviations in the unit of the cube, as the `[cube]` of a decomposition reads them: of a sample at the mean of its band, and of the
/// electronic noise in it; the common line's where it holds, else the band's own, wider by its standard error.
fn sigmas(result: &PhotonNoise) -> Table {
    let mut table = Table::new(["band", "sigma", "electronic_sigma"]);
    let common = result.usable.then_some(&result.transfer.common);
    let variances: Vec<f64> =
        result.transfer.bands.iter().map(|band| band.variance_at_mean(common)).collect();
    // A band that was left out has a row too, of the largest: the file has one for every band of the cube.
    let most = variances.iter().copied().fold(0.0, f64::max);
    for (i, variance) in variances.iter().enumerate() {
        let variance = if variance.is_nan() { most } else { variance.max(0.0) };
        // Of what is not told apart, all is taken for electronic noise: too much rather than too little.
        let electronic = common.map_or(variance, |line| line.electronic).max(0.0);
        table.push(vec![i.to_string(), number(variance.sqrt()), number(electronic.sqrt())]);
    }
    table
}

/// Variance over mean, some bands.
fn transfer(result: &PhotonNoise) -> Plot {
    let bands = &result.transfer.bands;
    let looked_at: Vec<usize> = (0..bands.len()).filter(|band| !bands[*band].bins.is_empty()).collect();
    let shown: Vec<usize> = some(looked_at.len(), MOST).iter().map(|place| looked_at[*place]).collect();
    let mut table = Table::new(["band", "mean", "variance", "variance_sigma", "common_line"]);
    let common = &result.transfer.common;
    let mut figure = LineFigure::new(
        "Photon transfer: variance of the samples against their mean",
        Axis::linear("mean (unit of the cube)"),
        Axis::linear("variance (unit of the cube squared)"),
    )
    .subtitle(each_point(common));
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for band in &shown {
        let bins = &bands[*band].bins;
        for [mean, variance, sigma] in bins {
            ends = [ends[0].min(*mean), ends[1].max(*mean)];
            table.push(vec![
                band.to_string(),
                number(*mean),
                number(*variance),
                number(*sigma),
                number(common.variance(*mean)),
            ]);
        }
        let column = |of: usize| bins.iter().map(|bin| bin[of]).collect::<Vec<f64>>();
        figure = figure.series(Series::points(format!("band {band}"), column(0), column(1)));
    }
    let at: Vec<f64> = (0..=40).map(|i| ends[0] + (ends[1] - ends[0]) * f64::from(i) / 40.0).collect();
    let values = at.iter().map(|mean| common.variance(*mean)).collect();
    let figure = figure.series(Series::line("all bands", at, values));
    Plot { name: "photon_transfer".into(), figure: figure.into(), table }
}
