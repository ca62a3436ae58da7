//! A companion table in words: what sizing practice says of a camera, beside what is proved.
//!
//! Ranges have two digits, for Johnson's cycles are known to a quarter; MRTDs are rounded to what ASTM E1213 calls significant. The
//! table has every digit.

use crate::text::numbers::{fixed, significant};
use crate::words::Say;
use crate::words::probability::probability;
use hadar::policy::practice::resolution::{PERCEPTION, SIGNIFICANT_K};
use hadar::words::share;
use hadar_scenario::Units;
use hadar_study::Companion;
use hadar_study::companion::{CompanionRow, Condition, Measure};
use std::fmt::Write as _;

/// The measures in their order, with what a line of them is called.
const LINES: [(Measure, &str); 9] = [
    (Measure::PixelsOnTarget, "pixels across it"),
    (Measure::PixelsByFieldOfView, "  by the field of view"),
    (Measure::JohnsonRange, "range by Johnson's cycles"),
    (Measure::IndustryRange, "range by makers' pixels"),
    (Measure::Netd, "NETD of a frame"),
    (Measure::Ttpf, "observers who are right (TTPF)"),
    (Measure::Mrtd, "bars that they resolve (MRTD)"),
    (Measure::Material, "d of a pixel, at most"),
    (Measure::MaterialOfAllPixels, "d of all pixels on it, at most"),
];

/// The table as text: a line a measure, the label of its kind before the first of each, then what must be known of them.
pub(crate) fn text(companion: &Companion, units: Units) -> String {
    let mut out = String::from("Rules of thumb of sizing practice, for comparison with the bound");
    match (companion.size_m, companion.distance_m) {
        (Some(size), Some(distance)) => {
            let _ = write!(out, ", of {} at {}", units.length(size), units.length(distance));
        }
        (Some(size), None) => {
            let _ = write!(out, ", of {}", units.length(size));
        }
        _ => {}
    }
    out.push('\n');
    let mut last = None;
    for (measure, name) in LINES {
        let rows: Vec<&CompanionRow> = companion.of_measure(measure).collect();
        if rows.is_empty() {
            continue;
        }
        let kind = Some(measure.kind()).filter(|kind| last != Some(*kind));
        last = Some(measure.kind());
        let label = kind.map_or_else(String::new, |kind| kind.say());
        let _ = writeln!(out, "  {label:<15} {name:<31} {}", line(&rows, units));
    }
    for note in NOTES {
        let _ = writeln!(out, "  {note}");
    }
    out.push('\n');
    out
}

/// What must be known of the lines, in the fewest words; the caveats of the data say more.
const NOTES: [&str; 4] = [
    "Shape and material are different questions: rules and observers know sizes, not what a thing is made of, and have the same",
    "ranges where nothing differs and d is 0; d knows materials, not shape. Ranges are geometry alone: no noise, contrast, air, blur.",
    "NETD: 'Intercomparisons based solely on NETD figures may be misleading' (ASTM E1543); computed, not measured by that practice.",
    "MRTD: what is behind the target must differ by as much; below 0.2 K differences mean nothing (ASTM E1213), and the factor is a choice.",
];

/// What a line says of all its tasks; a reason that is that of all is said once.
fn line(rows: &[&CompanionRow], units: Units) -> String {
    let reason = |row: &&CompanionRow| row.unknown();
    if let Some(unknown) = rows.first().and_then(reason)
        && rows.iter().all(|row| row.unknown() == Some(unknown))
    {
        return format!("unknown: {}", unknown.say());
    }
    let cells = rows.iter().map(|row| {
        let cell =
            row.unknown().map_or_else(|| value(row, units), |unknown| format!("none ({})", unknown.say()));
        row.task.map_or_else(|| cell.clone(), |task| format!("{} {cell}", task.name()))
    });
    let cells = cells.collect::<Vec<_>>().join(", ");
    match rows.first().map(|row| row.measure) {
        Some(Measure::Mrtd) => format!("{cells}; factor {}", significant(PERCEPTION, 3)),
        _ => cells,
    }
}

fn value(row: &CompanionRow, units: Units) -> String {
    let of = |quantity: &str| row.value(quantity).unwrap_or(f64::NAN);
    let under = |name: &str| row.condition(name).unwrap_or(f64::NAN);
    match row.measure {
        Measure::PixelsOnTarget => {
            format!("{} ({} cycles)", significant(of("pixels"), 3), significant(of("cycles"), 3))
        }
        Measure::PixelsByFieldOfView => format!(
            "{} ({} cycles): field of view and focal length contradict each other",
            significant(of("pixels"), 3),
            significant(of("cycles"), 3)
        ),
        Measure::JohnsonRange | Measure::IndustryRange => units.rough_length(of("range_m")),
        Measure::Netd => format!(
            "{} mK at {} K, black body, {} to {} um, f/{}",
            significant(1e3 * of("netd_k"), 2),
            under("blackbody_k"),
            significant(1e4 / under("high_cm1"), 3),
            significant(1e4 / under("low_cm1"), 3),
            significant(under("f_number"), 3)
        ),
        Measure::Ttpf => share(of("probability")),
        Measure::Mrtd => resolvable(of("mrtd_k")),
        Measure::Material | Measure::MaterialOfAllPixels => {
            let distance = of("statistical_distance");
            let other = row.conditions.iter().find_map(|(name, condition)| match condition {
                Condition::Text(text) if *name == "alternative" => Some(text.as_str()),
                _ => None,
            });
            let pixels = match row.measure {
                Measure::MaterialOfAllPixels if !row.conditions.iter().any(|(name, _)| *name == "frames") => {
                    format!(" ({} of them, with what they share)", significant(under("pixels"), 3))
                }
                Measure::MaterialOfAllPixels => {
                    format!(" ({} of them, all alike; verdicts are of one)", significant(under("pixels"), 3))
                }
                _ => String::new(),
            };
            format!(
                "{}: distinguished from {} with probability {}{pixels}",
                significant(distance, 3),
                other.unwrap_or("the alternative"),
                probability(distance, 4)
            )
        }
    }
}

/// A difference that observers resolve, in steps that mean something.
fn resolvable(kelvin: f64) -> String {
    match kelvin {
        _ if kelvin < SIGNIFICANT_K => format!("below {SIGNIFICANT_K} K"),
        _ if kelvin < 100.0 => format!("{} K", fixed((kelvin / SIGNIFICANT_K).round() * SIGNIFICANT_K, 1)),
        _ => format!("{} K", significant(kelvin, 2)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::companions;
    use hadar::instrument::{Camera, presets};
    use hadar::spectrum::Bands;
    use hadar_study::companion::{Given, Told};

    fn camera() -> Camera {
        let mut camera = presets::get("flir-a325sc").unwrap();
        (camera.pixels, camera.field_of_view_rad) = (None, None);
        camera
    }

    fn companion(camera: Option<&Camera>, distance_m: f64) -> Companion {
        let bands = Bands::uniform(715.0, 1250.0, 5.0).unwrap();
        let told = Told { target: "skin", alternative: "aluminium", statistical_distance: 0.5, pixels: None };
        let (size_m, distance_m) = (Some(0.6), Some(distance_m));
        Companion::of(&Given { camera, bands: &bands, size_m, distance_m, told: Some(told) }).unwrap()
    }

    /// 0.6 m × 18 mm/12 um: at 900 m it is a pixel; d = 0.5 is 0.6915, 15 more than is printed.
    #[test]
    fn the_text_has_three_labels_and_no_more_digits_than_are_known() {
        let camera = camera();
        let text = text(&companion(Some(&camera), 30.0), Units::default());
        let expected = [
            "Rules of thumb of sizing practice, for comparison with the bound, of 600 mm at 30.0 m",
            "  rule of thumb   pixels across it                30.0 (15.0 cycles)",
            "                  range by Johnson's cycles       detect 450 m, orient 320 m, recognise 110 m, identify 70 m",
            "                  range by makers' pixels         detect 600 m, recognise 150 m, identify 75 m",
            "                  NETD of a frame                 52 mK at 295 K, black body, 8.00 to 14.0 um, f/1.30",
            "  observer model  observers who are right (TTPF)  detect > 99 %, orient > 99 %, recognise > 99 %, identify 98 %",
            "                  bars that they resolve (MRTD)   detect below 0.2 K, orient below 0.2 K, recognise below 0.2 K, \
             identify below 0.2 K; factor 2.25",
            "  bound           d of a pixel, at most           0.500: distinguished from aluminium with probability 0.6915",
            "                  d of all pixels on it, at most  15.0: distinguished from aluminium with probability more than 0.999999 \
             (900 of them, all alike; verdicts are of one)",
        ];
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..expected.len()], expected);
        assert_eq!(lines.len(), expected.len() + NOTES.len() + 1);
        assert!(text.contains("may be misleading' (ASTM E1543)") && text.ends_with("\n\n"));
    }

    #[test]
    fn what_is_unknown_is_said_once() {
        let text = text(&companion(None, 30.0), Units::default());
        assert!(text.contains("range by Johnson's cycles       unknown: there is no camera\n"), "{text}");
        assert!(!text.contains("NaN"), "{text}");
        let camera = camera();
        let far = super::text(&companion(Some(&camera), 120.0), Units::default());
        assert!(far.contains("identify none (such bars are finer than the pixels sample)"), "{far}");
    }

    #[test]
    fn steps_of_a_difference_that_mean_something() {
        let shown = [0.07, 0.199, 0.24, 0.31, 1.55, 12.26, 1.32e3].map(resolvable);
        assert_eq!(shown, ["below 0.2 K", "below 0.2 K", "0.2 K", "0.4 K", "1.6 K", "12.2 K", "1300 K"]);
    }

    #[test]
    fn the_table_has_a_row_a_value_and_every_camera() {
        let camera = camera();
        let both = [companion(Some(&camera), 30.0), companion(None, 30.0)];
        let table = companions(&both);
        let rows = table.rows();
        // 2 of pixels, 4 + 3 of ranges, NETD, 4 + 4 of observers, 2 + 2 of bounds.
        assert_eq!(rows.len(), 2 * 22);
        assert!(rows.iter().all(|row| row.len() == table.header().len()));
        let row = |code: &str, task: &str| rows.iter().find(|row| row[2] == code && row[3] == task).unwrap();
        let range = row("johnson-range", "detect");
        assert_eq!(range[..2], ["flir-a325sc", "rule-of-thumb"]);
        assert_eq!(range[4], "range_m");
        assert!((range[5].parse::<f64>().unwrap() / 450.0 - 1.0).abs() < 1e-12);
        assert_eq!(range[6..8], ["cycles=1; cycles_spread=0.25; probability=0.5", "geometry"]);
        assert!(row("netd", "")[6].starts_with("blackbody_k=295; low_cm1=715; high_cm1=1250; f_number=1.3;"));
        let (known, unknown) = rows.split_at(22);
        assert!(known.iter().all(|row| !row[5].is_empty() && row[8].is_empty()));
        assert!(unknown.iter().all(|row| row[5].is_empty() && row[8] == "there is no camera"));
    }
}
