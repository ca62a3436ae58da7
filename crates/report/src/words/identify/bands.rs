//! Bands: which of them matter, and how their number and that of the materials change the distances.

use crate::text::numbers::{listed, significant};
use hadar_study::{BandsThatMatter, Scaling, Study};
use std::fmt::Write as _;

/// How distances scale with materials and bands.
pub(super) fn scaling(scaling: &Scaling, target: &str) -> String {
    let mut out = format!("Scaling of the distance of {target} ({})\n", scaling.by);
    let library = &scaling.library;
    if let (Some(first), Some(last), Some(size)) =
        (library.target.first(), library.target.last(), library.materials.last())
    {
        let _ = writeln!(
            out,
            "  least     {} per sqrt(photon) against 1 alternative on average, {} against {}",
            significant(*first, 3),
            significant(*last, 3),
            size - 1
        );
    }
    let bands = &scaling.bands;
    let span = |values: &[f64], what: &str| {
        let best = values.iter().copied().fold(0.0, f64::max);
        let at = values.iter().position(|v| *v == best).and_then(|i| bands.bands.get(i));
        match (values.first(), values.last(), at, bands.bands.first(), bands.bands.last()) {
            (Some(first), Some(last), Some(at), Some(few), Some(many)) if best > 0.0 => format!(
                "  {what}  {} in {few} band{}, {} in {many}; most in {at}: {}\n",
                significant(*first, 3),
                if *few == 1 { "" } else { "s" },
                significant(*last, 3),
                significant(best, 3)
            ),
            _ => format!("  {what}  0 in any number of bands\n"),
        }
    };
    if !bands.left_out.is_empty() {
        let _ = writeln!(out, "  bands: {}", beyond_reach(&bands.left_out));
    }
    out.push_str(&span(&bands.shot_noise, "least, shot noise alone (per sqrt(photon)) "));
    out.push_str(&span(&bands.shot_noise_median, "median, shot noise alone (per sqrt(photon))"));
    if !bands.camera.is_empty() {
        out.push_str(&span(&bands.camera, "least, the camera's noise per reading (d)  "));
        out.push_str(&span(&bands.camera_median, "median, the camera's noise per reading (d) "));
    }
    out.push('\n');
    out
}

/// Why alternatives do not count in a choice of bands.
fn beyond_reach(names: &[String]) -> String {
    format!(
        "without {}, which cannot be distinguished even with all bands and shot noise alone",
        listed(names)
    )
}

/// Which bands matter, and what the best few keep.
pub(super) fn bands(found: &BandsThatMatter, study: &Study) -> String {
    let target = &study.target().name;
    let against = match found.alternatives.as_slice() {
        [one] => one.clone(),
        all => format!("{} alternatives", all.len()),
    };
    let mut out =
        format!("Bands that matter for distinguishing {target} from {against}, by the local distance\n");
    if !found.left_out.is_empty() {
        let _ = writeln!(
            out,
            "  omitted, since all bands together do not distinguish them: {}",
            listed(&found.left_out)
        );
    }
    if !found.out_of_reach.is_empty() {
        let _ = writeln!(out, "  {}", beyond_reach(&found.out_of_reach));
    }
    for (choice, what) in [(&found.bands, "band"), (&found.filters, "contiguous filter")] {
        let Some(choice) = choice else { continue };
        let count = choice.passbands.len();
        let plural = if count == 1 { "" } else { "s" };
        if choice.distance == 0.0 {
            let _ = writeln!(
                out,
                "  so few {what}s carry no information: {} or more are required, one more than there are unknowns",
                choice.fewest
            );
            continue;
        }
        let share = |distance: f64| {
            let ratio = distance / choice.distance_all_bands;
            if ratio < 1.5 {
                format!("{} %", significant(100.0 * ratio, 3))
            } else {
                format!("{} times", significant(ratio, 3))
            }
        };
        let proof = if choice.exact {
            "no other choice gives more".to_owned()
        } else {
            format!("no other choice gives more than {}", share(choice.bound))
        };
        let limiting = choice.limiting.as_deref().unwrap_or(&found.alternative);
        let unit = if study.camera().is_some() { "camera d" } else { "per sqrt(photon)" };
        let _ = writeln!(
            out,
            "  best {count} {what}{plural}: {}{} the distance of all {} bands read one by one ({unit} {}, all bands {}; worst against {limiting}); {proof}",
            share(choice.distance),
            if choice.kept < 1.5 { " of" } else { "" },
            found.center_cm1.len(),
            significant(choice.distance, 3),
            significant(choice.distance_all_bands, 3)
        );
        let places: Vec<String> = choice
            .passbands
            .iter()
            .map(|band| match what {
                // As many digits as tell neighbours apart.
                "band" if band.high_cm1 - band.low_cm1 < 1.0 => format!("{:.2}", band.center_cm1),
                "band" => format!("{:.0}", band.center_cm1),
                _ => format!("{:.1}-{:.1}", band.low_cm1, band.high_cm1),
            })
            .collect();
        let _ = writeln!(out, "    at {} cm^-1", listed(&places));
        if count < choice.asked {
            let _ =
                writeln!(out, "    {} were asked for, which would give less than 0.1 % more", choice.asked);
        }
        if let Some(reached) = &choice.reached {
            let d = reached.statistical_distance;
            let _ = writeln!(
                out,
                "    with these alone the camera reaches d = {} against {} by the nearest distance, {} than the required {}",
                significant(d, 3),
                reached.limiting,
                if d >= reached.required { "no less" } else { "less" },
                significant(reached.required, 4)
            );
        }
    }
    out.push('\n');
    out
}
