//! The page.

use super::super::page::markdown;
use super::bounds::Bounds;
use super::files::PUBLISHED;
use super::methods::{Compared, METHODS};
use super::spectra::{LINES, Spectra};
use super::street::{MATERIALS, PHOTONS, TakenApart};
use crate::reproduce::ledger::{Line, Verdict, markdown as ledger_markdown};
use hadar_report::text::significant;

const PLACE: &str = "Sensors 20, 2109 (2020)";
/// Method that the published figures are of.
const SMOOTHEST: usize = 2;

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// Published figures beside ours.
pub(super) fn ledger(compared: &[Compared]) -> Vec<Line> {
    let mut lines = Vec::new();
    for one in compared {
        let Some([_, temperature, emissivity]) = PUBLISHED.iter().find(|p| p[0] == one.nedt_k) else {
            continue;
        };
        let own = &one.errors[SMOOTHEST];
        let why = format!(
            "not their spectra and not their sky ({}): {} scenes of measured spectra; bound with nothing known but smoothness {} K and {}",
            one.sky,
            one.scenes,
            significant(one.bound_temperature_k, 2),
            significant(one.bound_emissivity, 2)
        );
        for (quantity, theirs, ours, unit) in [
            ("temperature", *temperature, own.temperature_rms_k, " K"),
            ("emissivity", *emissivity, own.emissivity_rms, ""),
        ] {
            let verdict = if ours <= theirs { Verdict::UnderAChoice } else { Verdict::NotReproduced };
            lines.push(Line::new(
                PLACE,
                format!(
                    "rms error of the {quantity}, smoothest emissivity, NEDT {} K, sky {}",
                    one.nedt_k, one.sky
                ),
                format!("< {theirs}{unit}"),
                format!("{}{unit}", significant(ours, 2)),
                verdict,
                why.clone(),
            ));
        }
    }
    lines
}

pub(super) fn finding(spectra: &Spectra, compared: &[Compared], street: &TakenApart) -> String {
    let lined: Vec<&Compared> = compared.iter().rev().take(2).collect();
    let of = |m: usize| {
        let mut each: Vec<String> =
            lined.iter().map(|one| significant(one.errors[m].temperature_rms_k, 2)).collect();
        each.reverse();
        each.join(" and ")
    };
    let of_means: Vec<String> = compared
        .iter()
        .take(2)
        .map(|one| {
            let [t, e] = [one.bound_temperature_k, one.bound_emissivity].map(|x| significant(x, 2));
            format!("{t} K and {e}")
        })
        .collect();
    let mut bounds: Vec<String> = lined.iter().map(|one| significant(one.bound_temperature_k, 2)).collect();
    bounds.reverse();
    format!(
        "{} measured spectra under a sky with lines, NEDT 0.03 and 0.1 K: temperatures err by {} K (NEM), {} K (TES), {} K (smoothest), {} K \
         (principal components of the others), {} K (smooth prior); the bound with nothing known but smoothness is {} K, reached to {} K by \
         emissivities that are drawn from its prior. Under a sky of means over 20 cm⁻¹ it is {} at 0.03 K, {} at 0.1 K, beside the published \
         0.5 K and 0.01, 1 K and 0.015 of smoothness. Of {} pixels of {} materials {} groups are made; with the library found {} of the pixels have \
         the right material (by the true one {}), with temperatures off by {} K (by the true one {} K), and {} of the emissivities lie \
         within 1.96 of their deviations.",
        spectra.names.len(),
        of(0),
        of(1),
        of(2),
        of(3),
        of(4),
        bounds.join(" and "),
        of(5),
        of_means.first().map_or("", String::as_str),
        of_means.last().map_or("", String::as_str),
        street.pixels,
        MATERIALS.len(),
        street.found.clusters.len(),
        percent(street.by_found.right),
        percent(street.by_truth.right),
        significant(street.by_found.right_temperature_rms_k, 3),
        significant(street.by_truth.right_temperature_rms_k, 3),
        percent(street.covered),
    )
}

/// Rows of every method, and of the bounds and published figures below them.
fn rows(compared: &[Compared]) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for one in compared {
        for (method, e) in METHODS.iter().zip(&one.errors) {
            rows.push(vec![
                one.sky.to_owned(),
                one.nedt_k.to_string(),
                (*method).to_owned(),
                significant(e.temperature_rms_k, 2),
                significant(e.temperature_median_k, 2),
                significant(e.emissivity_rms, 2),
                significant(e.emissivity_median, 2),
                percent(e.answered),
            ]);
        }
        rows.push(vec![
            one.sky.to_owned(),
            one.nedt_k.to_string(),
            "**bound, smooth prior**".to_owned(),
            significant(one.bound_temperature_k, 2),
            String::new(),
            significant(one.bound_emissivity, 2),
            String::new(),
            String::new(),
        ]);
        rows.push(vec![
            one.sky.to_owned(),
            one.nedt_k.to_string(),
            "van Trees' bound, smooth prior".to_owned(),
            significant(one.rigorous_temperature_k, 2),
            String::new(),
            String::new(),
            String::new(),
            String::new(),
        ]);
        if let Some([_, t, e]) = PUBLISHED.iter().find(|p| p[0] == one.nedt_k) {
            rows.push(vec![
                "theirs".to_owned(),
                one.nedt_k.to_string(),
                "published, smoothness".to_owned(),
                format!("< {t}"),
                String::new(),
                format!("< {e}"),
                String::new(),
                String::new(),
            ]);
        }
    }
    rows
}

pub(super) fn readme(
    spectra: &Spectra,
    compared: &[Compared],
    bounds: &Bounds,
    street: &TakenApart,
    ledger: &[Line],
    seed: u64,
) -> String {
    let header = [
        "sky",
        "NEDT (K)",
        "method",
        "temperature rms (K)",
        "median (K)",
        "emissivity rms",
        "median",
        "answered",
    ];
    let decomposed = [("true library", &street.by_truth), ("library found", &street.by_found)];
    let decomposed = decomposed.map(|(name, of)| {
        let kelvin = [of.temperature_rms_k, of.right_temperature_rms_k].map(|k| significant(k, 3));
        [name.to_owned(), percent(of.right)].into_iter().chain(kelvin)
    });
    let by_library =
        ["decomposed by", "right material", "temperature error, all (K rms)", "of right ones (K rms)"];
    let known = bounds.known;
    let clusters: Vec<Vec<String>> = street
        .found
        .clusters
        .iter()
        .zip(&street.material)
        .map(|(one, m)| {
            vec![
                MATERIALS[*m].to_owned(),
                one.fitted.to_string(),
                significant(one.sigma_mean, 2),
                significant(one.sigma_temperature_k, 2),
                significant(one.chi_square_reduced, 3),
            ]
        })
        .collect();
    let tried: Vec<Vec<String>> = street
        .found
        .tried
        .iter()
        .map(|one| {
            vec![
                one.count.to_string(),
                one.left.to_string(),
                format!("{:.2} ± {}", one.loss, significant(one.error, 1)),
                significant(one.chi_square_reduced, 3),
            ]
        })
        .collect();
    format!(
        "# Temperature and emissivity without a library\n\n\
         Made by `hadar reproduce emissivity-from-data --library FOLDER` (seed {seed}); FOLDER holds spectra of the ECOSTRESS library. {}\n\n\
         {} spectra cover 8 to 13 µm (97 bands of 5 cm⁻¹) with a mean emissivity above 0.7; {} of bare metals and {} that do not cover the bands are left \
         out. Each is seen in scenes of its own: 295 to 320 K, flat under a clear sky (US standard atmosphere, air of 288.2 K), V = 1, the light known, \
         noise of the stated NEDT at 300 K in every band. What a method learns of spectra (relation of MMD, principal components, how smooth they are) \
         it learns from the others; spectra of the same name are left out with each.\n\n\
         LOWTRAN 7 gives the sky as means over 20 cm⁻¹, without the lines that these methods live on. The sky *with lines* is the same with optical depths that \
         vary from band to band by e^±{LINES} within these means: a choice, not a measurement.\n\n\
         ## Errors\n\n{}\n\
         ![Temperature errors](temperature_errors.png)\n\n\
         ## What can be told apart\n\n\
         The bound knows that emissivities have a mean of {:.3} ± {:.3} and a shape of ± {:.3} whose correlation has fallen to a quarter over {} cm⁻¹ (what the \
         spectra show), and nothing of the temperature. It is a Bayesian one: the deviation of the posterior to first order, its square averaged over emissivities that \
         are drawn from this prior, and estimates of those are in the table too. Van Trees' bound, which needs no first order, lies below it, as it \
         counts what large emissivities tell for all. Single spectra, and methods that know more (principal components), may do better; a method that does \
         better on measured spectra knows something of them that is not in the prior. Measured spectra that the prior does not foresee (deep bands of quartz and \
         carbonates) are why its estimate, and that of principal components, has an rms error far above the median.\n\n\
         ![Bound over resolution](bound_resolution.png)\n\n\
         ![Bound over contrast](bound_contrast.png)\n\n\
         ## A library out of a cube\n\n\
         {} pixels of {} materials of a street, {PHOTONS:.1e} photons each in 54 bands, random temperatures (270 to 310 K) and shares of sky and ground. Counts of groups \
         from 2 to 10 are tried; {} are made.\n\n{}\n{}\n\
         {}\n\
         Emissivities are off by {} rms, {} of their stated deviations; {} lie within 1.96 of them.\n\n\
         ![Emissivities found](street_emissivities.png)\n\n\
         ## Ledger\n\n{}",
        finding(spectra, compared, street),
        spectra.names.len(),
        spectra.metals,
        spectra.uncovered,
        markdown(&header, &rows(compared)),
        known.mean,
        known.magnitude,
        known.shape,
        known.correlation_cm1,
        street.pixels,
        MATERIALS.len(),
        street.found.clusters.len(),
        markdown(&["groups asked for", "with pixels", "loss", "χ²/ν"], &tried),
        markdown(
            &["material", "pixels fitted", "mean emissivity ±", "temperatures in common ± (K)", "χ²/ν"],
            &clusters
        ),
        hadar_report::table::markdown(&by_library, decomposed),
        significant(street.emissivity_rms, 2),
        significant(street.over_sigma, 3),
        percent(street.covered),
        ledger_markdown(ledger),
    )
}
