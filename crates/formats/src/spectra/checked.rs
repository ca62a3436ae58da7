//! Emissivities as they were read, held against [0, 1]: noise beyond it is cut off where that is asked for, the rest is said.
//!
//! Measured reflectances go below 0 and above 1 where an instrument has little light. With a clip c, e becomes 0 in [−c, 0) and 1 in
//! (1, 1 + c], and rows without a number are left out where the gap is narrow, so that the straight line between their neighbours
//! takes their place. What lies farther out and wide gaps stay as they are: an error once a band needs them.

use super::content::is_elsewhere;
use hadar::error::{Error, Result};
use hadar::material::Table;
use hadar::words::significant;

/// The part of the long-wave infrared that most cameras see, cm⁻¹ (13 to 8 µm).
const LONG_WAVE_CM1: (f64, f64) = (770.0, 1250.0);
/// The most that is noise: a twentieth of what a black surface has is no small error.
pub(super) const MOST_CLIP: f64 = 0.05;

/// The widest gap between known rows that a straight line may bridge, cm⁻¹: features of solids are wider.
const WIDEST_GAP_CM1: f64 = 20.0;

/// A table of emissivities with what a user should know of it.
pub(super) struct Checked {
    pub(super) table: Table<1>,
    pub(super) warnings: Vec<String>,
    /// What was changed; empty where nothing was.
    pub(super) note: String,
}

/// The table, clipped where that is asked for.
///
/// # Errors
/// Less than two rows that are numbers.
pub(super) fn checked(table: Table<1>, clip: Option<f64>) -> Result<Checked> {
    let (table, note) = match clip {
        Some(by) => clipped(table, by)?,
        None => (table, String::new()),
    };
    let mut warnings: Vec<String> = Some(note.clone()).into_iter().filter(|note| !note.is_empty()).collect();
    warnings.extend(outside(&table));
    if let Some((low, high)) = table.range_cm1()
        && !is_elsewhere((low, high))
        && (low > LONG_WAVE_CM1.0 || high < LONG_WAVE_CM1.1)
    {
        warnings.push(format!(
            "the rows go from {low:.1} to {high:.1} cm^-1 and so do not cover the long-wave infrared of 8 to 13 um ({} to {} cm^-1)",
            LONG_WAVE_CM1.0, LONG_WAVE_CM1.1
        ));
    }
    Ok(Checked { table, warnings, note })
}

/// The clip that cuts off what is outside by this, rounded up, if that may be noise.
pub(super) fn clip_for(out: f64) -> Option<f64> {
    (out <= MOST_CLIP).then(|| (1e3 * out).ceil() / 1e3)
}

/// By how much an emissivity is outside [0, 1]; not above 0 inside.
pub(super) fn beyond(emissivity: f64) -> f64 {
    (emissivity - 1.0).max(-emissivity)
}

/// The rows with noise cut off, and what was done.
fn clipped(table: Table<1>, by: f64) -> Result<(Table<1>, String)> {
    let all: Vec<(f64, f64)> = table.rows().map(|(wavenumber, [e])| (wavenumber, e)).collect();
    let mut said = Vec::new();
    // 1.02 is outside by 0.02, whatever it is rounded to.
    let is_noise = |e: f64| beyond(e) > 0.0 && beyond(e) <= by + 1e-12;
    let noise = all.iter().filter(|row| is_noise(row.1));
    if let Some((at, worst)) = noise.clone().max_by(|a, b| beyond(a.1).total_cmp(&beyond(b.1))) {
        said.push(format!(
            "{} outside 0 to 1 clipped, the worst by {} at {at:.1} cm^-1 (clip {by})",
            rows_of(noise.count()),
            significant(beyond(*worst), 2)
        ));
    }
    let Bridged { rows: known, left_out, widest } = bridged(&all);
    if left_out > 0 {
        let gap = widest.map_or_else(String::new, |(low, high)| {
            format!(", the widest gap from {low:.1} to {high:.1} cm^-1 is bridged")
        });
        said.push(format!("{} without a number left out{gap}", rows_of(left_out)));
    }
    if said.is_empty() {
        return Ok((table, String::new()));
    }
    if known.len() < 2 {
        let found = format!("{} with a number", rows_of(known.len()));
        return Err(Error::malformed(found, "a spectrum needs at least 2"));
    }
    let cut = |(wavenumber, e): (f64, f64)| (wavenumber, [if is_noise(e) { e.clamp(0.0, 1.0) } else { e }]);
    let rows: Vec<(f64, [f64; 1])> = known.into_iter().map(cut).collect();
    Ok((Table::new(&rows)?, said.join("; ")))
}

/// Rows that are numbers, or that stay since nothing may take their place.
#[derive(Default)]
struct Bridged {
    rows: Vec<(f64, f64)>,
    /// Rows that were left out.
    left_out: usize,
    /// The widest gap that is bridged, cm⁻¹.
    widest: Option<(f64, f64)>,
}

/// Rows without a number are left out in a narrow gap or at an end; in a wide gap they stay, so that nothing is known there.
fn bridged(all: &[(f64, f64)]) -> Bridged {
    let mut bridged = Bridged::default();
    let width = |gap: Option<(f64, f64)>| gap.map_or(0.0, |(low, high)| high - low);
    let mut behind = all;
    for run in all.chunk_by(|a, b| a.1.is_nan() == b.1.is_nan()) {
        behind = behind.get(run.len()..).unwrap_or_default();
        let is_hole = run.first().is_some_and(|row| row.1.is_nan());
        let gap = bridged.rows.last().zip(behind.first()).map(|(low, high)| (low.0, high.0));
        if !is_hole || width(gap) > WIDEST_GAP_CM1 {
            bridged.rows.extend(run);
            continue;
        }
        bridged.left_out += run.len();
        if width(gap) > width(bridged.widest) {
            bridged.widest = gap;
        }
    }
    bridged
}

/// Rows, in words.
fn rows_of(count: usize) -> String {
    if count == 1 { "1 row".to_owned() } else { format!("{count} rows") }
}

/// What is to be said of rows outside 0 to 1.
fn outside(table: &Table<1>) -> Option<String> {
    let outside: Vec<(f64, f64)> =
        table.rows().map(|(wavenumber, [e])| (wavenumber, e)).filter(|&(_, e)| beyond(e) > 0.0).collect();
    let &(worst_cm1, worst) = outside.iter().max_by(|a, b| beyond(a.1).total_cmp(&beyond(b.1)))?;
    let (low, high) =
        outside.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &(x, _)| (low.min(x), high.max(x)));
    let clip = clip_for(beyond(worst))
        .map_or_else(String::new, |by| format!("; `hadar materials import --clip {by}` cuts such noise off"));
    Some(format!(
        "{} rows from {low:.1} to {high:.1} cm^-1 have a reflectance outside 0 to 100 percent (at worst {:.3} percent \
         at {worst_cm1:.1} cm^-1); bands that use them are an error{clip}",
        outside.len(),
        100.0 * (1.0 - worst),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: &[(f64, f64)]) -> Table<1> {
        let rows: Vec<(f64, [f64; 1])> = rows.iter().map(|&(x, e)| (x, [e])).collect();
        Table::new(&rows).unwrap()
    }

    #[test]
    fn noise_is_cut_and_holes_are_left_out_and_both_are_said() {
        let noisy =
            [(800.0, -0.013), (850.0, 0.5), (860.0, f64::NAN), (868.0, 1.02), (1100.0, 1.2), (1300.0, 0.9)];
        let found = checked(table(&noisy), Some(0.02)).unwrap();
        let rows: Vec<(f64, f64)> = found.table.rows().map(|(x, [e])| (x, e)).collect();
        assert_eq!(rows, [(800.0, 0.0), (850.0, 0.5), (868.0, 1.0), (1100.0, 1.2), (1300.0, 0.9)]);
        assert_eq!(
            found.note,
            "2 rows outside 0 to 1 clipped, the worst by 0.020 at 868.0 cm^-1 (clip 0.02); 1 row without a number left out, the \
             widest gap from 850.0 to 868.0 cm^-1 is bridged"
        );
        assert!(found.warnings[1].contains("1 rows from 1100.0 to 1100.0"), "{:?}", found.warnings);
        // Nothing to do, nothing said.
        let plain = checked(table(&[(700.0, 0.5), (1300.0, 0.6)]), Some(0.02)).unwrap();
        assert_eq!((plain.note.as_str(), plain.warnings.len()), ("", 0));
        // One row alone is no narrower gap than its neighbours make it.
        let alone = [(800.0, 0.9), (1000.0, f64::NAN), (1200.0, 0.9)];
        assert_eq!(checked(table(&alone), Some(0.0)).unwrap().table.rows().count(), 3);
        // A narrow gap is bridged, a wide one is not, what is at an end is left off.
        let hole = |to: f64| {
            let rows = [
                (700.0, 0.5),
                (800.0, 0.5),
                (801.0, f64::NAN),
                (802.0, f64::NAN),
                (to, 0.5),
                (1300.0, f64::NAN),
            ];
            checked(table(&rows), Some(0.0)).unwrap()
        };
        assert_eq!((hole(815.0).table.rows().count(), hole(825.0).table.rows().count()), (3, 5));
        assert!(hole(825.0).table.rows().any(|(_, [e])| e.is_nan()));
        assert!(
            hole(815.0)
                .note
                .starts_with("3 rows without a number left out, the widest gap from 800.0 to 815.0")
        );
        assert!(checked(table(&[(700.0, f64::NAN), (1300.0, 0.6)]), Some(0.0)).is_err());
    }
}
