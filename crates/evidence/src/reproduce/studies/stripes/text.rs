//! The report's text.

use super::measure::Row;
use super::twin::{BANDS, COLUMNS, GAIN, OFFSET, ROWS, TEXTURE_K};
use crate::reproduce::studies::page::markdown;
use hadar::words::significant;

pub(super) fn finding(rows: &[Row]) -> String {
    let line = |row: &Row| {
        format!(
            "{} % of the lines striped: {} of {} found ({} wrongly), off by {} % before and {} % after; temperature of a pixel +- {} K clean, {} K \
             striped, {} K destriped (bound {} K)",
            significant(100.0 * row.share, 2),
            row.found - row.wrong,
            row.put,
            row.wrong,
            significant(100.0 * row.off[0], 2),
            significant(100.0 * row.off[1], 2),
            significant(row.temperature_k[0], 3),
            significant(row.temperature_k[1], 3),
            significant(row.temperature_k[2], 3),
            significant(row.temperature_bound_k[2], 3)
        )
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// README.md.
pub(super) fn readme(rows: &[Row], cubes: u64, seed: u64) -> String {
    let percent = |x: f64| format!("{} %", significant(100.0 * x, 3));
    let found: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            vec![
                percent(row.share),
                row.put.to_string(),
                format!("{} ({})", row.found - row.wrong, row.wrong),
                percent(row.held),
                percent(row.off[0]),
                percent(row.off[1]),
            ]
        })
        .collect();
    let information: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            let both = |x: [f64; 2]| format!("{} / {}", percent(x[0]), percent(x[1]));
            vec![percent(row.share), both(row.unknown), both(row.destriped), both(row.all_unknown)]
        })
        .collect();
    let errors: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            let [along, across] = row.position.map(|x| x.map(|x| significant(x, 3)).join(" / "));
            let kelvin = |x: [f64; 3]| x.map(|x| significant(x, 3)).join(" / ");
            vec![
                percent(row.share),
                along,
                across,
                kelvin(row.temperature_k),
                kelvin(row.temperature_bound_k),
            ]
        })
        .collect();
    format!(
        "# What stripes cost, and what destriping gives back\n\n\
         A twin whose truth is known: {ROWS} × {COLUMNS} pixels, {BANDS} bands, 0.95 B(T) of a cold upper part, a warmer lower one and a block, \
         texture of {TEXTURE_K} K (rms), some 10⁵ photons and 100 electrons of noise a sample. In a share of the rows, in every band for itself, \
         samples read g x + o with gains off by {} % and offsets by {} % of the level (rms). {cubes} cubes for each share, seed {seed}. Clean \
         lines stay bit by bit as they are.\n\n\
         ## Stripes found\n\n{}\n\
         Intervals: how often the 95 % interval of a found line's remaining error holds it.\n\n\
         ## Information that is left (bounds)\n\n\
         Of the position of a window of 15 × 15 pixels (S37, gain and offset of each line of the window projected out), along / across the \
         lines, over that of a clean cube.\n\n{}\n\
         Unknown offsets take from a shift along the lines the mean slope of each line, from a shift across them more: what differs from line to \
         line is what an offset does. A stereo pair whose baseline lies along the lines loses least.\n\n\
         ## What estimates do\n\n\
         Errors of position over the bound of a clean cube, and errors of a pixel's temperature (K), each in the clean / striped / destriped \
         cube; the bound of the temperature: clean / striped lines left out / destriped.\n\n{}\n\
         ![Errors over the clean bound](errors.png)\n\n![Before and after](before_and_after.png)\n\n\
         The bounds of a destriped cube take lines that were not found for clean; the errors have them as they are. Where a line is off by less than \
         six of the deviations by which clean lines differ from their neighbours (here texture as large as the stripes), it stays striped, and above \
         some 5 % of striped lines it is these that are left: leaving striped lines out, if they were known, would do better. The temperature is that \
         of emissivity 0.95, all bands weighed by noise and by the remaining error of their line.\n",
        100.0 * GAIN,
        100.0 * OFFSET,
        markdown(
            &[
                "striped lines",
                "stripes",
                "found (wrongly)",
                "intervals hold",
                "off before (rms)",
                "off after (rms)"
            ],
            &found
        ),
        markdown(&["striped lines", "striped lines unknown", "destriped", "all lines unknown"], &information),
        markdown(
            &["striped lines", "position along", "position across", "temperature error (K)", "bound (K)"],
            &errors
        ),
    )
}
