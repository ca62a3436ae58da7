//! A decomposed cube as files: maps, a table per material, pictures.

mod equalise;
mod figures;
mod segmented;
mod vision;

pub use crate::words::decompose::text;
pub use equalise::{Clahe, Curves, Tiles};
use vision::Brush;
pub use vision::{DARKEST, Vision, brightness, saturation};

use crate::bundle::Bundle;
use crate::shown::Shown;
use crate::table::{Table, number, optional};
use hadar::error::{Error, Result};
use hadar_formats::cube::npy_map;
use hadar_study::decompose::{
    Block, Decomposed, Kept, MIXED, MIXED_MATERIALS, MaterialRow, TruthFound, mixed_layers,
};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// The picture, a pixel each.
const IMAGE: &str = "tex_vision_image.png";

/// All files; paths in the scenario are written relative to `out` where they lie below it. What is too large to be kept is made in `room`.
///
/// # Errors
/// A figure that cannot be drawn; maps that cannot be read.
pub fn bundle(result: &Decomposed, room: Option<&Path>) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    bundle.add_table("materials.csv", materials(result))?;
    if let Some(truth) = &result.truth
        && !truth.confusion.is_empty()
    {
        bundle.add_table("confusion.csv", confusion(result, truth))?;
    }
    bundle.add_warnings(&result.warnings)?;
    let size = [result.shape.rows(), result.shape.columns()];
    match &result.kept {
        Kept::InMemory(block) => add_maps(&mut bundle, block, size)?,
        Kept::InFiles(files) => {
            for path in files.paths() {
                let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
                bundle.add_file(name.unwrap_or_default(), path);
            }
        }
    }
    if !result.bad.map.is_empty() {
        bundle.add("bad_pixels.npy", npy_map(&size, &result.bad.map)?);
    }
    let shown = Shown::of(result.shape);
    let pixels = result.kept.every(shown.stride, result.shape)?;
    if let Some(found) = &result.segmentation {
        bundle.add("segmentation.npy", npy_map(&size, &found.map)?);
        bundle.add("likeliest_category.npy", npy_map(&size, &found.likeliest)?);
        bundle.add_table("categories.csv", segmented::categories(found))?;
        bundle.add_table("objects.csv", segmented::objects(found))?;
        bundle.add_plots(&[segmented::plot(found, &pixels, shown)])?;
        for (row, name) in found.safety.iter().zip(segmented::files(found)) {
            bundle.add(format!("{name}.npy"), npy_map(&size, &row.map)?);
            bundle.add_plots(&[segmented::not_excluded(found, row, name, &pixels, shown)])?;
        }
    }
    if let Some(of_sky) = &result.vision.distilled {
        bundle.add("distilled_texture.npy", npy_map(&size, &of_sky.texture)?);
        bundle.add("distilled_texture_sigma.npy", npy_map(&size, &of_sky.sigma)?);
    }
    let brush = Brush::of(result)?;
    match room {
        None => {
            let mut image = Vec::new();
            brush.image(&mut image)?;
            bundle.add(IMAGE, image);
        }
        Some(room) => {
            let path = room.join(IMAGE);
            let file = File::create(&path).map_err(|error| Error::file("write the picture", &path, error))?;
            brush.image(BufWriter::new(file))?;
            bundle.add_file(IMAGE, path);
        }
    }
    if !result.model.causes.is_empty() {
        bundle.add_table("model_causes.csv", figures::causes(&result.model))?;
    }
    bundle.add_plots(&[
        vision::plot(&brush, &pixels, shown),
        figures::maps(result, &pixels, shown),
        figures::flags(result, &pixels, shown),
    ])?;
    if result.method.has_likelihood() {
        bundle.add_plots(&[figures::p_values(result, &pixels, shown)])?;
    }
    if let Some(residual) = figures::residual(&result.model) {
        bundle.add_plots(&[residual])?;
    }
    Ok(bundle)
}

/// The maps of all pixels.
fn add_maps(bundle: &mut Bundle, block: &Block, size: [usize; 2]) -> Result<()> {
    let Block { maps, texture, thermal, .. } = block;
    let lights = maps.lighting.len() / maps.material.len().max(1);
    bundle.add("material.npy", npy_map(&size, &maps.material)?);
    bundle.add("temperature_k.npy", npy_map(&size, &maps.temperature_k)?);
    bundle.add("temperature_sigma_k.npy", npy_map(&size, &maps.temperature_sigma_k)?);
    let deep = |layers: usize| [size[0], size[1], layers];
    bundle.add("lighting.npy", npy_map(&deep(lights), &maps.lighting)?);
    bundle.add("lighting_sigma.npy", npy_map(&deep(lights), &maps.lighting_sigma)?);
    bundle.add("p_value.npy", npy_map(&size, &maps.p_value)?);
    bundle.add("posterior.npy", npy_map(&size, &maps.posterior)?);
    if !maps.other.is_empty() {
        bundle.add("none_of_these.npy", npy_map(&size, &maps.other)?);
    }
    if !maps.mixed.is_empty() {
        bundle.add(MIXED_MATERIALS, npy_map(&deep(2), &maps.mixed_material)?);
        for (name, values) in MIXED.into_iter().zip(mixed_layers(maps)) {
            let layers = values.len() / maps.mixed.len();
            let shape = if layers == 1 { size.to_vec() } else { deep(layers).to_vec() };
            bundle.add(name, npy_map(&shape, values)?);
        }
    }
    bundle.add("candidates.npy", npy_map(&size, &maps.candidates)?);
    let ranks = maps.ranked.len() / maps.material.len().max(1);
    bundle.add("candidates_k.npy", npy_map(&deep(ranks), &maps.ranked)?);
    bundle.add("candidates_k_posterior.npy", npy_map(&deep(ranks), &maps.ranked_posterior)?);
    bundle.add("flags.npy", npy_map(&size, &maps.flags)?);
    bundle.add("texture.npy", npy_map(&size, texture)?);
    bundle.add("texture_sigma.npy", npy_map(&size, &maps.texture_sigma)?);
    bundle.add("thermal.npy", npy_map(&size, thermal)?);
    Ok(())
}

/// What was found, a row for every material.
#[must_use]
pub fn materials(result: &Decomposed) -> Table {
    let index = |row: &MaterialRow| result.materials.iter().position(|name| *name == row.material);
    let hue = |row: &MaterialRow| result.vision.hues_deg.get(index(row)?).copied();
    Table::of(
        &result.found,
        &[
            ("material", &|row| row.material.clone()),
            ("index", &|row| index(row).map_or_else(String::new, |index| index.to_string())),
            ("hue_deg", &|row| optional(hue(row))),
            ("pixels", &|row| row.pixels.to_string()),
            ("decided", &|row| row.decided.to_string()),
            ("temperature_median_k", &|row| number(row.temperature_median_k)),
            ("temperature_tenth_k", &|row| number(row.temperature_tenths_k[0])),
            ("temperature_nine_tenths_k", &|row| number(row.temperature_tenths_k[1])),
            ("temperature_sigma_median_k", &|row| number(row.temperature_sigma_median_k)),
        ],
    )
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
