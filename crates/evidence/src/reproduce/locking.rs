//! Pixel locking: by how much matchers err that have all the light they could wish for.

mod curve;

use curve::Locking;
use hadar::error::Result;
use hadar::ranging::information::Window;
use hadar::ranging::noise::NoiseVariance;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Series};
use hadar_report::table::{Table, number};
use hadar_simulate::matching::Matcher;
use hadar_simulate::matching::block::Block;
use hadar_simulate::matching::likelihood::Likelihood;
use hadar_simulate::matching::texture::Texture;
use hadar_simulate::matching::trials::{Noisy, Run};

const STEPS: usize = 20;
const WINDOWS: usize = 60;
/// Photons per pixel, contrast and finest texture (cycles per pixel).
const PHOTONS: f64 = 1e6;
const CONTRAST: f64 = 0.1;
const CUTOFF: f64 = 0.25;

/// The plot, and the largest root-mean-square error over the windows of each matcher, pixels.
pub(super) fn locking(seed: u64) -> Result<(Plot, Vec<(&'static str, f64)>)> {
    let texture = Texture::random(seed, &[PHOTONS], CONTRAST, CUTOFF, 40)?;
    let window = Window::new(5, 5)?;
    let disparities: Vec<f64> = (0..=STEPS).map(|i| i as f64 / STEPS as f64).collect();
    let mut figure = LineFigure::new(
        "Pixel locking: error of matches without noise",
        Axis::linear("sub-pixel part of the true disparity (pixels)"),
        Axis::log("root-mean-square error over windows (pixels)"),
    )
    .subtitle(
        "Windows of 5 × 5 pixels of a texture up to a quarter of a cycle per pixel, one disparity in each.",
    );
    let mut table = Table::new(["disparity_px", "matcher", "mean_error_px", "rms_error_px"]);
    let mut largest = Vec::new();
    let matchers = [
        ("block matching", Matcher::Block(Block::new(window))),
        ("maximum likelihood", Matcher::Likelihood(Likelihood::new(window))),
    ];
    for (name, matcher) in matchers {
        let setup = Locking {
            texture: &texture,
            bands: 1,
            noise: &NoiseVariance::None,
            noisy: Noisy::Both,
            matcher,
            windows: WINDOWS,
            run: Run { index: 0, trials: 2, seed },
            level: 0.95,
        };
        let curve = setup.curve(&disparities)?;
        let rms: Vec<f64> = curve.iter().map(|point| point.systematic_rms).collect();
        for (disparity, point) in disparities.iter().zip(&curve) {
            let numbers = [point.systematic, point.systematic_rms].map(number);
            let [mean, rms] = numbers;
            table.push(vec![number(*disparity), name.to_owned(), mean, rms]);
        }
        largest.push((name, rms.iter().copied().fold(0.0, f64::max)));
        figure = figure.series(Series::line(name, disparities.clone(), rms));
    }
    Ok((Plot { name: "pixel_locking".into(), figure: figure.into(), table }, largest))
}
