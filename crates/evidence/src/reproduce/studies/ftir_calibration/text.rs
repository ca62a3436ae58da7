//! The report's text.

use super::super::page::markdown;
use super::shown::{EMISSIVITY, READINGS, SLOPE_PER_K, SURROUNDINGS_K, Shown, TEMPERATURE_ERROR_K, WANTED_K};
use hadar_report::text::significant;

fn list(values: &[f64]) -> String {
    values.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
}

/// The least and the largest coverage.
fn coverages(shown: &Shown) -> [f64; 2] {
    let all = shown.held.iter().flat_map(|held| {
        let c = held.coverage;
        [c.response, c.offset, c.radiance, c.emissivity, c.surroundings].map(|one| one.share)
    });
    all.fold([1.0, 0.0], |[low, high], share| [share.min(low), share.max(high)])
}

pub(super) fn finding(shown: &Shown) -> String {
    let [low, high] = coverages(shown);
    let pair = shown.pairs.least(0.0, |e| e.total_k());
    let surface = shown.surface.least(0.0, |e| e.total());
    let warm = shown.surface.least(300.0, |e| e.total());
    let pair = pair.map_or_else(String::new, |(a, b, e)| {
        format!(
            "The best two blackbodies for scenes of 270 to 320 K are at {a} and {b} K, the ends of what is allowed ({} mK); ",
            significant(1e3 * e.total_k(), 3)
        )
    });
    let emissivity = surface.zip(warm).map_or_else(String::new, |((a, b, e), (c, d, f))| {
        format!(
            "an emissivity is best told from {a} and {b} K (error {}), on both sides of the surroundings, and from {c} and {d} K where the surface \
             can only be heated ({}).",
            significant(e.total(), 2),
            significant(f.total(), 2)
        )
    });
    format!(
        "95 % intervals of response, offset, radiance, emissivity and surroundings hold {low:.3} to {high:.3} of the truth in {} experiments. \
         {pair}{emissivity}",
        shown.experiments
    )
}

pub(super) fn readme(shown: &Shown, seed: u64) -> String {
    let held: Vec<Vec<String>> = shown
        .held
        .iter()
        .map(|held| {
            let c = held.coverage;
            let shares = [c.response, c.offset, c.radiance, c.emissivity, c.surroundings];
            let shares = shares.map(|one| format!("{:.3} ± {:.3}", one.share, one.sigma));
            [list(held.blackbodies_k), list(held.errors_k)].into_iter().chain(shares).collect()
        })
        .collect();
    let best: Vec<Vec<String>> = shown
        .best
        .iter()
        .map(|best| {
            vec![
                format!("{} to {}", best.within_k[0], best.within_k[1]),
                list(&best.temperatures_k),
                significant(1e3 * best.error.total_k(), 3),
                significant(1e3 * best.error.noise_k, 3),
                significant(1e3 * best.error.temperature_k, 3),
            ]
        })
        .collect();
    let closest = shown.spacing.first().map_or(f64::NAN, |one| one.1.bias);
    format!(
        "# Calibration of a spectrometer by blackbodies\n\n\
         {}\n\n\
         A twin of a Fourier spectrometer (71 channels from 700 to 1400 cm⁻¹, 30 mK at 300 K and 1000 cm⁻¹ in one reading, an offset that is its own \
         light) is calibrated as in SVI of the paper (S52 to S58), by weighted least squares and with the blackbodies' temperatures uncertain.\n\n\
         ## Do the stated errors hold?\n\n\
         {} experiments each, blackbodies drawn about their stated temperatures; a surface of emissivity 0.7 at 300 and 330 K (to 20 and 40 mK) under \
         surroundings at 275 K; a scene at 310 K. Share of the 95 % intervals that hold the truth:\n\n{}\n\
         With more than two blackbodies the channels together tell something of the errors of the temperatures; that is used, and is part of \
         the intervals.\n\n\
         ## The best temperatures of blackbodies\n\n\
         Error of a radiance that is common to all pixels, as temperature, for scenes of 270 to 320 K; each blackbody to {:.0} mK, {READINGS} readings \
         in all, whatever the number of settings.\n\n{}\n\
         ![Error over the temperatures of two blackbodies](blackbodies.png)\n\n\
         The ends of what is allowed: noise wants them apart, and what an error of a temperature does goes with B′(T), which is small before a \
         cold blackbody, times a leverage that falls with their distance. A setting that stands there more than once is one that errs for itself \
         each time, another blackbody or the same one set anew; where its error stays the same, nothing is gained by it.\n\n\
         ## Emissivity from two temperatures of a surface\n\n\
         Emissivity {EMISSIVITY}, changing by {SLOPE_PER_K} per K and wanted at {WANTED_K} K, surroundings at {SURROUNDINGS_K} K; the surface to {:.0} mK; \
         calibrated by blackbodies at 283.15 and 353.15 K.\n\n\
         ![Error over the two temperatures](surface.png)\n\n\
         The paper wants the two temperatures close to each other, so that the emissivity does not change between them (after S57). That does not \
         take the error away: for T₁ → T₂ it tends to e′ (B − X)/B′, here {}, while noise grows without end. It is the slope of e (B − X) that is \
         measured, and the change of e is in it at any distance. It vanishes where (B₁ + B₂)/2 = X, the wanted temperature in the middle: \
         temperatures on both sides of the surroundings'.\n\n\
         ![Errors over the distance of the two temperatures](spacing.png)\n\n\
         ## How it was made\n\n\
         `hadar reproduce ftir-calibration --out reports`, seed {seed}. Numbers are in `coverage.csv`, `best.csv`, and those of each picture beside \
         it.\n",
        finding(shown),
        shown.experiments,
        markdown(
            &["blackbodies (K)", "to (K)", "response", "offset", "radiance", "emissivity", "surroundings"],
            &held
        ),
        1e3 * TEMPERATURE_ERROR_K,
        markdown(&["allowed (K)", "best (K)", "error (mK)", "by noise (mK)", "by temperatures (mK)"], &best),
        1e3 * TEMPERATURE_ERROR_K,
        significant(closest, 2),
    )
}
