//! A rendered scene in words: what is seen, what it was drawn with, what was assumed.

use crate::shown::Shown;
use crate::text::columns::{Columns, left, right};
use crate::text::footing::warnings;
use crate::text::numbers::degrees;
use crate::words::pictures::thinned_alone;
use hadar::words::{share, significant, whole};
use hadar_study::render::Rendered;
use std::fmt::Write as _;

/// The whole answer.
#[must_use]
pub fn text(result: &Rendered) -> String {
    let (rows, columns, bands) = (result.shape.rows(), result.shape.columns(), result.shape.bands());
    let pixels = rows * columns;
    let views = if result.views.len() == 2 { "two views" } else { "one view" };
    let mut out = format!(
        "Rendered {views} of {rows} x {columns} pixels in {bands} bands; {} of {} pixels are one surface of one material.\n\n",
        whole(result.pure as u64),
        whole(pixels as u64)
    );
    let width = result.surfaces.iter().map(|row| row.name.chars().count()).max().unwrap_or(0).max(8);
    let mut table = Columns::new([
        left("", width),
        right("pixels", 8),
        right("pure", 8),
        right("mean (degC)", 12),
        right("depth (m)", 16),
        left("material", 0),
    ]);
    for row in &result.surfaces {
        let depth = row.depth_m.map_or_else(
            || "-".to_owned(),
            |[near, far]| format!("{} to {}", significant(near, 3), significant(far, 3)),
        );
        let mean = match row.depth_m {
            Some(_) if row.pure > 0 => degrees(row.temperature_k),
            _ => "-".to_owned(),
        };
        let materials = if row.materials.is_empty() { "-".to_owned() } else { row.materials.join(", ") };
        let [pixels, pure] = [row.pixels, row.pure].map(|count| whole(count as u64));
        table.row([row.name.clone(), pixels, pure, mean, depth, materials]);
    }
    let _ = write!(out, "Surfaces\n{}", table.text());
    let _ = writeln!(
        out,
        "\nCounts of a sample: {} in the median, electronic noise {}",
        significant(result.counts_median, 3),
        significant(result.noise_variance.sqrt(), 3),
    );
    match result.seed {
        Some(seed) => drop(writeln!(out, "Noise: Poisson and electronic, seed {seed}")),
        None => drop(writeln!(out, "Noise: none, expected counts")),
    }
    let _ = writeln!(out, "Surroundings of a decomposition: {}", result.surroundings.join(", "));
    if result.lighting_left_out > 0.0 {
        let _ = writeln!(
            out,
            "  other surfaces give up to {} of what lights a pixel: there a decomposition by these says that nothing fits, or errs",
            share(result.lighting_left_out)
        );
    }
    out.push_str(
        "\nAssumptions\n  opaque, Lambertian surfaces; no air between them and the camera; no blur of a lens\n  \
         what lights a surface is the mean radiance of each other surface, after the scatterings before\n",
    );
    out.push_str(&warnings(&result.warnings));
    out
}

/// Below the pictures.
pub(crate) fn rendered(bands: usize, shown: Shown) -> String {
    format!("Rendered, {bands} bands.{}", thinned_alone(shown))
}
