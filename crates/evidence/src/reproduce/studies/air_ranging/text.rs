//! What came out, and the page.

use super::super::page::markdown;
use super::found::{BANDS, Found, TRIALS};
use hadar::words::{length, significant};
use hadar_report::words::Say;
use hadar_study::air_ranging::{AirPoint, AirRanging};

/// Pixels of the window that is compared with published figures.
const WINDOW: f64 = 25.0;

fn metres(value: Option<f64>) -> String {
    value.map_or_else(|| "none".into(), length)
}

fn bias(point: &AirPoint) -> String {
    match point.bias_without_sky_m {
        Some(off) if point.without_sky_at_edge && off < 0.0 => "to the shortest".into(),
        Some(_) if point.without_sky_at_edge => "to the longest".into(),
        Some(off) => format!("{}{}", if off < 0.0 { "−" } else { "+" }, length(off.abs())),
        None => "no fit".into(),
    }
}

/// Least and largest rms over the bound, and how many of the intervals hold 1.
fn ratios(main: &AirRanging) -> (f64, f64, usize) {
    let all = main.witness.iter().map(|one| one.rmse_over_bound);
    let (low, high) =
        all.fold((f64::INFINITY, 0.0_f64), |(low, high), ratio| (low.min(ratio), high.max(ratio)));
    let holds = main.witness.iter().filter(|one| {
        let interval = one.rmse_over_bound_interval;
        interval.low <= 1.0 && 1.0 <= interval.high
    });
    (low, high, holds.count())
}

/// The quick form's.
pub(super) fn quick(main: &AirRanging) -> String {
    let (low, high, holds) = ratios(main);
    format!(
        "{} Maximum likelihood over the bound at the first {} distances: {low:.2} to {high:.2} (1 within the 95 % interval of {holds}).",
        main.verdict.sentence.say(),
        main.witness.len()
    )
}

/// What came out, in a few sentences.
pub(super) fn finding(found: &Found) -> String {
    let main = &found.main;
    let (low, high, holds) = ratios(main);
    let best = main.best_bands.as_ref();
    format!(
        "{} The best {BANDS} bands: +- {}{}. Without sky the model is off by {} at 100 m. Maximum likelihood over the bound from 15 to 150 m: {low:.2} \
         to {high:.2} (1 within the 95 % interval at {holds} of {} distances).",
        main.verdict.sentence.say(),
        metres(best.and_then(|best| best.sigma_m)),
        if best.is_some_and(|best| best.exact) { ", proved to be the best choice" } else { "" },
        bias(&main.at),
        main.witness.len()
    )
}

fn distances(main: &AirRanging) -> String {
    let rows: Vec<Vec<String>> = main
        .curve
        .iter()
        .map(|point| {
            let one = main.witness.iter().find(|one| one.distance_m == point.distance_m);
            vec![
                significant(point.distance_m, 3),
                metres(point.sigma_m),
                metres(point.sigma_emissivity_known_m),
                metres(point.sigma_lighting_known_m),
                metres(point.sigma_others_known_m),
                one.map_or_else(String::new, |one| {
                    let interval = one.rmse_over_bound_interval;
                    format!("{:.3} ({:.3} to {:.3})", one.rmse_over_bound, interval.low, interval.high)
                }),
                one.map_or_else(String::new, |one| {
                    let off = one.errors.bias;
                    format!("{}{}", if off < 0.0 { "−" } else { "+" }, length(off.abs()))
                }),
                bias(point),
            ]
        })
        .collect();
    let header = [
        "distance (m)",
        "least error",
        "emissivity known",
        "lighting known",
        "all else known",
        "rms over bound",
        "its bias",
        "off without sky",
    ];
    markdown(&header, &rows)
}

/// Published errors, and those found here.
fn published(main: &AirRanging) -> String {
    let four = main.best_bands.as_ref().and_then(|best| best.sigma_m);
    let in_window = |sigma: Option<f64>| metres(sigma.map(|sigma| sigma / WINDOW.sqrt()));
    markdown(
        &["", "published", "here, a pixel", "here, 5 × 5 pixels"],
        &[
            vec!["model without reflected light".into(), "over 100 m".into(), bias(&main.at), bias(&main.at)],
            vec!["four bands".into(), "6.8 m".into(), metres(four), in_window(four)],
            vec!["all bands".into(), "1.2 m".into(), metres(main.at.sigma_m), in_window(main.at.sigma_m)],
        ],
    )
}

/// The page.
pub(super) fn readme(found: &Found) -> String {
    let main = &found.main;
    let best = main.best_bands.as_ref();
    let centres = best.map_or_else(String::new, |best| {
        let at = |nu: &f64| format!("{nu:.0}");
        best.centers_cm1.iter().map(at).collect::<Vec<_>>().join(", ")
    });
    let errors: Vec<Vec<String>> = found
        .errors
        .iter()
        .map(|(sigma, point)| {
            vec![sigma.to_string(), metres(point.sigma_m), metres(point.sigma_lighting_known_m)]
        })
        .collect();
    let crossings: Vec<String> = found
        .stereo
        .iter()
        .map(|(texture, result)| {
            let at = result.stereo_crossing_m.map_or_else(
                || "at none of these distances".into(),
                |crossing| format!("beyond {} m", significant(crossing, 2)),
            );
            format!("{at} where the light changes by {} % from pixel to pixel", 100.0 * texture)
        })
        .collect();
    let noises: Vec<Vec<String>> = found
        .noises
        .iter()
        .map(|(noise, one)| {
            let (interval, off) = (one.rmse_over_bound_interval, one.errors.bias);
            vec![
                noise.to_string(),
                length(one.bound_m),
                format!("{:.3} ({:.3} to {:.3})", one.rmse_over_bound, interval.low, interval.high),
                format!("{}{}", if off < 0.0 { "−" } else { "+" }, length(off.abs())),
                hadar::words::share(one.at_edge),
            ]
        })
        .collect();
    let (low, high, holds) = ratios(main);
    format!(
        "# How well a distance can be read from the air on the path\n\n\
         Made by `hadar reproduce air-ranging` (seed {seed}). A concrete wall, 10 K warmer than the air, half of what it mirrors a clear summer \
         sky and half ground at 24 °C; 256 bands from 8 to 13 µm, noise of 1 µflick in each; one pixel, one reading. Unknown besides the \
         distance: the temperature, both lighting factors, and the emissivity but for smooth errors of 0.01 with a correlation over 100 cm⁻¹. \
         `hadar range reports/air_ranging/scenario.toml` asks it again.\n\n\
         ![Least error over distance, and maximum likelihood](error_over_distance.png)\n\n\
         {distances}\n\
         Maximum likelihood, {TRIALS} spectra at each distance: rms over bound from {low:.2} to {high:.2}, 1 within the 95 % interval at {holds} of \
         {count}. Its search knows nothing of the true distance. *Off without sky*: what a model finds too much that takes all light of the \
         wall for its own, fitted to counts without noise; *to the shortest* where it ends at the shortest distance it may have.\n\n\
         ![What a model loses that leaves out the sky](bias_without_sky.png)\n\n\
         ## Beside what is published\n\n\
         Passive ranging by absorption: Dorken Gallastegi, Rueda-Chacon, Stevens and Goyal, Opt. Express 32, 151 (2024), \
         doi:10.1364/OE.507927 (bounds, reflected light left out), arXiv:2308.05818 (256 bands of 8 to 13 µm, 15 to 150 m, reflected light \
         left out) and arXiv:2603.00273 (with it). The figures are those of the abstract of the last: one surface, its error without and with \
         the light of the sky.\n\n\
         {published}\n\
         Alike: the range of bands and their number, the distances, temperature and smooth emissivity unknown, the light of the sky unknown and \
         told by its ozone. Not alike: their surface, its contrast, the weather and the noise of their camera are not those above, and their \
         errors are single ones of real measurements, ours the least root mean square error of an unbiased estimate in air that is exactly that \
         of the table. Their bands resolve lines, our air is known as means over 20 cm⁻¹: lines would tell more. That the orders agree is \
         certain, that the same causes make them is likely, and no more. Our best four bands, {exact}, stand at {centres} cm⁻¹: the \
         published four are two at a line of water vapour and two at one of ozone.\n\n\
         ![What each band tells of 100 m](information_by_band.png)\n\n\
         ## What it hangs on\n\n\
         ![Least error over the contrast](error_over_contrast.png)\n\n\
         At 100 m, over the deviation of the emissivity:\n\n\
         {errors}\n\
         Over the noise of a band, at 100 m, {TRIALS} spectra each: where the bound comes near the distance itself the estimate is biased, since \
         no distance is below 0, and the bound, one of unbiased estimates, no longer says how much it errs.\n\n\
         {noises}\n\
         ## Stereo\n\n\
         ![Air and stereo](stereo_against_air.png)\n\n\
         The same camera twice, 0.2 m apart, the same window; each of its pixels has temperature, lighting and emissivity of its own. The air \
         tells more than stereo {crossings}.\n\n\
         All numbers are in the CSV files beside the plots, `distances.csv` and `estimates.csv`; two digits are given.\n",
        seed = found.seed,
        distances = distances(main),
        published = published(main),
        count = main.witness.len(),
        exact = if best.is_some_and(|best| best.exact) {
            "proved to be the best choice"
        } else {
            "the best that were found"
        },
        errors = markdown(&["deviation of the emissivity", "least error", "lighting known"], &errors),
        noises = markdown(
            &["noise (µflick)", "bound", "rms over bound", "bias", "at an end of the table"],
            &noises
        ),
        crossings = crossings.join(", "),
    )
}
