//! Emissivities as they were read, held against [0, 1]: noise beyond it is cut off where that is asked for, the rest is said.
//!
//! Measured reflectances go below 0 and above 1 where an instrument has little light. With a clip c, e becomes 0 in [−c, 0) and 1 in
//! (1, 1 + c], and rows without a number are left out, so that the straight line between their neighbours takes their place. What
//! lies farther out stays as it is: an error once a band needs it.

use super::content::is_elsewhere;
use hadar::error::{Error, Result};
use hadar::material::Table;
use hadar::words::significant;

/// The part of the long-wave infrared that most cameras see, cm⁻¹ (13 to 8 µm).
const LONG_WAVE_CM1: (f64, f64) = (770.0, 1250.0);
/// The most that is noise: a twentieth of what a black surface has is no small error.
pub(super) const MOST_CLIP: f64 = 0.05;

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

/// By how much an emissivity is outside [0, 1]; not above 0 inside.
fn beyond(emissivity: f64) -> f64 {
    (emissivity - 1.0).max(-emissivity)
}

/// The rows with noise cut off, and what was done.
fn clipped(table: Table<1>, by: f64) -> Result<(Table<1>, String)> {
    let (mut rows, mut cut, mut dropped) = (Vec::new(), 0_usize, 0_usize);
    // How far out the worst was and where; from where to where the widest gap is.
    let (mut worst, mut gap) = ((0.0, 0.0), (0.0, 0.0));
    let (mut before, mut is_open) = (None, false);
    for (wavenumber, [emissivity]) in table.rows() {
        if emissivity.is_nan() {
            (dropped, is_open) = (dropped + 1, true);
            continue;
        }
        if let (Some(low), true) = (before, is_open)
            && wavenumber - low > gap.1 - gap.0
        {
            gap = (low, wavenumber);
        }
        (before, is_open) = (Some(wavenumber), false);
        let out = beyond(emissivity);
        let is_noise = out > 0.0 && out <= by;
        if is_noise {
            cut += 1;
            if out > worst.0 {
                worst = (out, wavenumber);
            }
        }
        rows.push((wavenumber, [if is_noise { emissivity.clamp(0.0, 1.0) } else { emissivity }]));
    }
    let mut said = Vec::new();
    if cut > 0 {
        let (out, at) = worst;
        said.push(format!(
            "{cut} rows outside 0 to 1 were clipped, the worst by {} at {at:.1} cm^-1 (clip {by})",
            significant(out, 2)
        ));
    }
    if dropped > 0 {
        let where_to = match gap.1 > 0.0 {
            true => format!(", the widest gap from {:.1} to {:.1} cm^-1 is bridged", gap.0, gap.1),
            false => String::new(),
        };
        said.push(format!("{dropped} rows without a number were left out{where_to}"));
    }
    if said.is_empty() {
        return Ok((table, String::new()));
    }
    if rows.len() < 2 {
        let found = format!("{} rows are numbers", rows.len());
        return Err(Error::malformed(found, "a spectrum needs at least 2"));
    }
    Ok((Table::new(&rows)?, said.join("; ")))
}

/// What is to be said of rows outside 0 to 1.
fn outside(table: &Table<1>) -> Option<String> {
    let outside: Vec<(f64, f64)> =
        table.rows().map(|(wavenumber, [e])| (wavenumber, e)).filter(|&(_, e)| beyond(e) > 0.0).collect();
    let &(worst_cm1, worst) = outside.iter().max_by(|a, b| beyond(a.1).total_cmp(&beyond(b.1)))?;
    let (low, high) =
        outside.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &(x, _)| (low.min(x), high.max(x)));
    let clip = match beyond(worst) <= MOST_CLIP {
        // Rounded up, so that what is written is enough.
        true => {
            format!(
                "; `hadar materials import --clip {}` cuts such noise",
                (1e3 * beyond(worst)).ceil() / 1e3
            )
        }
        false => String::new(),
    };
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
            [(800.0, -0.013), (850.0, 0.5), (900.0, f64::NAN), (1000.0, 1.004), (1100.0, 1.2), (1300.0, 0.9)];
        let found = checked(table(&noisy), Some(0.02)).unwrap();
        let rows: Vec<(f64, f64)> = found.table.rows().map(|(x, [e])| (x, e)).collect();
        assert_eq!(rows, [(800.0, 0.0), (850.0, 0.5), (1000.0, 1.0), (1100.0, 1.2), (1300.0, 0.9)]);
        assert_eq!(
            found.note,
            "2 rows outside 0 to 1 were clipped, the worst by 0.013 at 800.0 cm^-1 (clip 0.02); 1 rows without a number were left \
             out, the widest gap from 850.0 to 1000.0 cm^-1 is bridged"
        );
        assert!(found.warnings[1].contains("1 rows from 1100.0 to 1100.0"), "{:?}", found.warnings);
        // Nothing to do, nothing said.
        let plain = checked(table(&[(700.0, 0.5), (1300.0, 0.6)]), Some(0.02)).unwrap();
        assert_eq!((plain.note.as_str(), plain.warnings.len()), ("", 0));
        assert!(checked(table(&[(700.0, f64::NAN), (1300.0, 0.6)]), Some(0.0)).is_err());
    }
}
