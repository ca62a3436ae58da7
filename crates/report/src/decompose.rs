//! A decomposed cube as files: maps, a table per material, pictures.

mod equalise;
mod figures;
mod segmented;
mod text;
mod vision;

pub use equalise::{Clahe, Curves};
pub use figures::maps;
pub use text::text;
pub use vision::{DARKEST, Vision, brightness, saturation};

use crate::bundle::Bundle;
use crate::plot::image_png;
use crate::table::{Table, number};
use hadar::cube::npy_map;
use hadar::error::Result;
use hadar_study::study::decompose::{Decomposed, TruthFound};
use std::path::Path;

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(result: &Decomposed, out: &Path) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml_beside(out));
    bundle.add_table("materials.csv", materials(result))?;
    if let Some(truth) = &result.truth
        && !truth.confusion.is_empty()
    {
        bundle.add_table("confusion.csv", confusion(result, truth))?;
    }
    bundle.add_warnings(&result.warnings)?;
    let (maps, size) = (&result.maps, [result.shape.rows(), result.shape.columns()]);
    let lights = maps.lighting.len() / maps.material.len().max(1);
    bundle.add("material.npy", npy_map(&size, &maps.material)?);
    bundle.add("temperature_k.npy", npy_map(&size, &maps.temperature_k)?);
    bundle.add("temperature_sigma_k.npy", npy_map(&size, &maps.temperature_sigma_k)?);
    bundle.add("lighting.npy", npy_map(&[size[0], size[1], lights], &maps.lighting)?);
    bundle.add("p_value.npy", npy_map(&size, &maps.p_value)?);
    bundle.add("posterior.npy", npy_map(&size, &maps.posterior)?);
    bundle.add("candidates.npy", npy_map(&size, &maps.candidates)?);
    bundle.add("flags.npy", npy_map(&size, &maps.flags)?);
    bundle.add("texture.npy", npy_map(&size, &result.vision.texture)?);
    bundle.add("thermal.npy", npy_map(&size, &result.vision.thermal)?);
    if let Some(found) = &result.segmentation {
        bundle.add("segmentation.npy", npy_map(&size, &found.map)?);
        bundle.add_table("categories.csv", segmented::categories(found))?;
        bundle.add_table("objects.csv", segmented::objects(found))?;
        bundle.add_plots(&[segmented::plot(result, found, figures::stride(result.shape))])?;
    }
    if let Some(of_sky) = &result.vision.distilled {
        bundle.add("distilled_texture.npy", npy_map(&size, &of_sky.texture)?);
        bundle.add("distilled_texture_sigma.npy", npy_map(&size, &of_sky.sigma)?);
    }
    let vision = Vision::of(result);
    bundle.add("tex_vision_image.png", image_png(&vision.pixels(), size[1])?);
    let stride = figures::stride(result.shape);
    bundle.add_plots(&[vision::plot(result, &vision, stride), figures::maps(result)])?;
    Ok(bundle)
}

/// What was found, a row for every material.
#[must_use]
pub fn materials(result: &Decomposed) -> Table {
    let mut table = Table::new([
        "material",
        "index",
        "hue_deg",
        "pixels",
        "decided",
        "temperature_median_k",
        "temperature_tenth_k",
        "temperature_nine_tenths_k",
        "temperature_sigma_median_k",
    ]);
    for row in &result.found {
        let index = result.materials.iter().position(|name| *name == row.material);
        table.push(vec![
            row.material.clone(),
            index.map_or_else(String::new, |index| index.to_string()),
            index
                .and_then(|index| result.vision.hues_deg.get(index))
                .map_or_else(String::new, |h| number(*h)),
            row.pixels.to_string(),
            row.decided.to_string(),
            number(row.temperature_median_k),
            number(row.temperature_tenths_k[0]),
            number(row.temperature_tenths_k[1]),
            number(row.temperature_sigma_median_k),
        ]);
    }
    table
}

/// Pixels of what is there (rows) by what was found (columns).
fn confusion(result: &Decomposed, truth: &TruthFound) -> Table {
    let names = result.materials.iter().map(String::as_str);
    let mut table = Table::new(std::iter::once("there").chain(names).chain(["none"]));
    for (name, row) in result.materials.iter().zip(&truth.confusion) {
        table.push(std::iter::once(name.clone()).chain(row.iter().map(usize::to_string)).collect());
    }
    table
}
