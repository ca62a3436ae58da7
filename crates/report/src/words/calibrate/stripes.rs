//! A destriped cube, in words.

use crate::text::footing::{ASSUMPTIONS, read_as, warnings};
use hadar::words::{significant, whole};
use hadar_estimate::calibrate::Why;
use hadar_study::calibrate::StripesFound;
use std::fmt::Write as _;

/// The whole answer.
#[must_use]
pub fn text(result: &StripesFound) -> String {
    let found = &result.destriped;
    let name = found.axis.name();
    let all = found.lines * found.bands;
    let places = |lines: &[usize]| -> String {
        let shown: Vec<String> = lines.iter().take(10).map(usize::to_string).collect();
        shown.join(", ") + if lines.len() > 10 { ", …" } else { "" }
    };
    let alike = match found.left.as_slice() {
        [] => String::new(),
        left => format!(
            "{} {name} ({}, counted from 0) are off in all bands alike and left as they are: in_all_bands = true takes them as stripes",
            whole(left.len() as u64),
            places(left)
        ),
    };
    let untold = found.kept.iter().filter(|kept| !matches!(kept.why, Why::Dead | Why::Missing)).count();
    let single = match untold {
        0 => String::new(),
        untold => format!(
            "{} {name} of single bands look off and are left, as they may be the scene's (warnings below)",
            whole(untold as u64)
        ),
    };
    let also: Vec<String> = [alike, single].into_iter().filter(|text| !text.is_empty()).collect();
    let also = also.join("; ");
    let differing = found.apart.iter().flatten().map(|one| one.lines).fold(0.0, f64::max);
    let [[least, most], [least_gain, most_gain]] = [&found.detectable, &found.detectable_gain]
        .map(|of| [of.iter().copied().fold(f64::INFINITY, f64::min), of.iter().copied().fold(0.0, f64::max)]);
    let mut out = match result.striped {
        0 if !also.is_empty() => format!("Nothing was corrected: {also}.\n\n"),
        0 if differing > 0.0 => format!(
            "None of the {name} alone is conspicuous, but all {} of them differ from their neighbours by up to {} % (rms), which the scene's own \
             structure or stripes of every one of them explain alike.\n\n",
            found.lines,
            significant(100.0 * differing, 2)
        ),
        0 => format!(
            "No stripes: none of {} {name} is off in any of {} bands by what would be seen, {} % of the level ({} % in the worst band).\n\n",
            found.lines,
            found.bands,
            significant(100.0 * least_gain, 2),
            significant(100.0 * most_gain, 2)
        ),
        striped => format!(
            "{} of {} {name} (of {} bands) are striped, off by {} % of their level (rms); corrected, an error of {} % is left, common to \
             the pixels of a line{}.\n\n",
            whole(striped as u64),
            whole(all as u64),
            found.bands,
            significant(100.0 * result.off_relative, 2),
            significant(100.0 * result.left_relative, 2),
            if also.is_empty() { String::new() } else { format!("; {also}") }
        ),
    };
    out += &read_as(&result.read);
    let _ = writeln!(
        out,
        "  lines, each alone among clean ones, that are off by less than {} (unit of the cube, or a gain off by {} %; {} and {} % in the worst band) are not seen and stay as they are\n  \
         nor are lines side by side, or at the ends of the image, that are off in all bands: nothing distinguishes them from the scene",
        significant(least, 2),
        significant(100.0 * least_gain, 2),
        significant(most, 2),
        significant(100.0 * most_gain, 2)
    );
    let _ = writeln!(
        out,
        "  all lines that are not striped are bit by bit those of the cube\n\n{ASSUMPTIONS}\n  A striped line reads g x + o along its whole \
         length, gains are 1 +- {}; the clean lines next to it say what it should read.\n",
        significant(result.scenario.stripes.gain_deviation, 2)
    );
    out + &warnings(&result.warnings)
}

/// Below the pictures of a band, of which the middle is shown.
pub(crate) fn of_band(band: usize, [high, wide]: [usize; 2], [rows, columns]: [usize; 2]) -> String {
    let part = match [high, wide] == [rows, columns] {
        true => String::new(),
        false => format!(" The middle {high} × {wide} pixels of {rows} × {columns}."),
    };
    format!("Band {band} (counted from 0), that of the most stripes, in the unit of the cube.{part}")
}
