//! What the texts of a rule share: columns, and codes in words.

use hadar_study::Shortfall;

/// Rows with their columns below each other, those of numbers to the right; the last one as it is.
pub(super) fn columns<const N: usize>(rows: &[[String; N]], numbers: &[usize]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..N).map(width).collect();
    let mut out = String::new();
    for row in rows {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            if numbers.contains(&column) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
        });
        out.push_str(cells.collect::<Vec<_>>().join("  ").trim_end());
        out.push('\n');
    }
    out
}

/// What is wrong with an image.
pub(super) fn in_words(spoiled: &[Shortfall]) -> String {
    let words = spoiled.iter().map(|reason| match reason {
        Shortfall::MotionBlur => "motion blur of a pixel or more",
        Shortfall::MotionUnknown => "motion that is not known without a distance",
        Shortfall::FullWell => "the brightest scene fills the well",
        Shortfall::FrameRate => "longer than a frame",
        Shortfall::Impractical => "not a practical camera",
        Shortfall::Diffraction => "diffraction blurs over more than a pixel",
        Shortfall::LowestNoise => "below what read noise and converter leave",
        Shortfall::Pixels => "too few pixels",
        Shortfall::TemperatureError => "the temperature is not known well enough",
        Shortfall::DepthError => "the distance is not known well enough",
        Shortfall::DecisionTime => "its frames are read after the decision must stand",
        other => other.code(),
    });
    words.collect::<Vec<_>>().join(", ")
}

/// Codes, one after the other.
pub(super) fn codes(shortfalls: &[Shortfall], between: &str) -> String {
    shortfalls.iter().map(|by| by.code()).collect::<Vec<_>>().join(between)
}

/// What a kind of clause demands, in words.
pub(super) fn in_words_of_kind(kind: &str) -> &str {
    match kind {
        "tell-apart" => "tells materials apart",
        "false-alarm" => "no false alarm",
        "resolution" => "pixels on the target",
        "temperature-error" => "knows a temperature",
        "depth-error" => "knows a distance",
        other => other,
    }
}
