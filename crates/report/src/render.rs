//! A rendered scene as files: the cube, its truth, what lights it, the scenario that takes it apart, pictures.

mod figures;

pub use crate::words::render::text;
pub use figures::scene;

use crate::bundle::Bundle;
use crate::cube_format::CubeFormat;
use crate::table::{Column, Table, optional};
use hadar::error::Result;
use hadar::order;
use hadar::spectrum::{Band, Bands};
use hadar::units::Spectral;
use hadar_formats::cube::{mat_file, npy_map};
use hadar_scenario::decompose::{
    Bad, CategorySpec, CubeUnit, HeatCube, LibrarySpec, LightSource, PixelUnknown, TruthSpec,
};
use hadar_scenario::{BandSource, BandsSpec, DecomposeScenario, Filters};
use hadar_study::render::{Picture, Rendered};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// 0 degC, K.
const FREEZING_K: f64 = 273.15;
/// Beyond the temperatures of a scene, those that are searched, K.
const ROOM_K: f64 = 40.0;
/// Lighting that is left out below which the factors still add up to 1.
const NEARLY_ALL: f64 = 0.01;

/// How the cubes lie in the folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// NPY files.
    Npy,
    /// The folders of the HADAR database, .mat files: `HeatCubes`, `GroundTruth`, `Radiance_EnvObj`.
    Hadar,
}

/// All files; paths in the scenarios are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn, a cube that is too large for its format.
pub fn bundle(result: &Rendered, layout: Layout, format: CubeFormat) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    let spectra = |names: &[String], columns: &[Vec<f64>]| {
        let header = std::iter::once("wavenumber_cm1").chain(names.iter().map(String::as_str));
        let mut table = Table::new(header);
        // Filters that overlap are sampled at some wavenumbers together.
        let mut written = BTreeSet::new();
        for (i, nu) in
            result.wavenumbers_cm1.iter().enumerate().filter(|(_, nu)| written.insert(nu.to_bits()))
        {
            let values =
                std::iter::once(*nu).chain(columns.iter().filter_map(|column| column.get(i).copied()));
            // Every digit: what is taken apart with it must be what was put together.
            table.push(values.map(|value| format!("{value:e}")).collect());
        }
        table
    };
    bundle.add_table("library.csv", spectra(&result.materials, &result.emissivities))?;
    bundle.add_table("surroundings.csv", spectra(&result.surroundings, &result.radiances))?;
    bundle.add_table("surfaces.csv", surfaces(result))?;
    bundle.add_warnings(&result.warnings)?;
    let names: &[[&str; 2]] = match layout {
        Layout::Npy => &[["", "L"], ["right_", "R"]],
        Layout::Hadar => &[["", "L"], ["", "R"]],
    };
    for (view, [prefix, side]) in result.views.iter().zip(names) {
        match layout {
            Layout::Npy => npy(&mut bundle, result, view, (prefix, format))?,
            Layout::Hadar => database(&mut bundle, result, view, side)?,
        }
    }
    if matches!(result.scenario.bands.source, BandSource::Rows(_)) {
        let rows = result.bands.bands();
        let columns: [Column<'_, Band>; 2] = [
            ("wavenumber_cm1", &|band| band.center_cm1.to_string()),
            ("width_cm1", &|band| (band.high_cm1 - band.low_cm1).to_string()),
        ];
        bundle.add_table(BANDS, Table::of(rows, &columns))?;
    }
    bundle.add("decompose.toml", decomposition(result, layout, format).to_toml());
    bundle.add_plots(&[figures::scene(result)])?;
    Ok(bundle)
}

fn npy(
    bundle: &mut Bundle,
    result: &Rendered,
    view: &Picture,
    (prefix, format): (&str, CubeFormat),
) -> Result<()> {
    let size = [result.shape.rows(), result.shape.columns()];
    let deep = |layers: usize| [size[0], size[1], layers];
    format.add(bundle, &format!("{prefix}counts"), result.shape, &view.counts, &result.wavenumbers_cm1)?;
    let mut add = |name: &str, file: Vec<u8>| bundle.add(format!("{prefix}{name}.npy"), file);
    add("material", npy_map(&size, &view.material)?);
    add("temperature_k", npy_map(&size, &view.temperature_k)?);
    add("lighting", npy_map(&deep(result.surroundings.len()), &view.lighting)?);
    add("incident", npy_map(&size, &view.incident)?);
    add("depth_m", npy_map(&size, &view.depth_m)?);
    add("surface", npy_map(&size, &view.surface)?);
    Ok(())
}

/// The folders of the database: temperatures in degC, materials counted from 1 in a list of their own.
fn database(bundle: &mut Bundle, result: &Rendered, view: &Picture, side: &str) -> Result<()> {
    let (rows, columns, bands) = (result.shape.rows(), result.shape.columns(), result.shape.bands());
    let id = format!("{side}_0001");
    bundle.add(format!("HeatCubes/{id}_heatcube.mat"), mat_file("S", [rows, columns, bands], &view.counts)?);
    let celsius: Vec<f32> = view.temperature_k.iter().map(|k| (f64::from(*k) - FREEZING_K) as f32).collect();
    bundle.add(format!("GroundTruth/tMap/tMap_{id}.mat"), mat_file("tMap", [rows, columns, 1], &celsius)?);
    let places: Vec<u16> = view.material.iter().map(|place| place.wrapping_add(1)).collect();
    bundle.add(format!("GroundTruth/eMap/eMap_{id}.mat"), mat_file("eMap", [rows, columns, 1], &places)?);
    let list: Vec<u16> = (1..=result.materials.len()).filter_map(|place| u16::try_from(place).ok()).collect();
    let lights = result.surroundings.len();
    bundle.add(
        format!("GroundTruth/vMap/vMap_{id}.mat"),
        mat_file("vMap", [rows, columns, lights], &view.lighting)?,
    );
    if side == "L" {
        bundle.add("GroundTruth/eMap/eList.mat", mat_file("eList", [1, list.len(), 1], &list)?);
        let spectra: Vec<f32> = result.radiances.iter().flatten().map(|s| *s as f32).collect();
        let file = mat_file("S_EnvObj", [lights, result.wavenumbers_cm1.len(), 1], &spectra)?;
        bundle.add("Radiance_EnvObj/S_EnvObj_0001.mat", file);
    }
    Ok(())
}

/// The scenario that takes the left view apart.
fn decomposition(result: &Rendered, layout: Layout, format: CubeFormat) -> DecomposeScenario {
    let file = |name: &str| PathBuf::from(name);
    let kelvin = result.surfaces.iter().filter(|row| row.pure > 0 && row.depth_m.is_some());
    let ends = kelvin.fold([f64::INFINITY, 0.0_f64], |[low, high], row| {
        [low.min(row.temperature_k), high.max(row.temperature_k)]
    });
    let temperature_k = match ends {
        [low, high] if low <= high => [(low - ROOM_K).max(1.0).round(), (high + ROOM_K).round()],
        _ => PixelUnknown::default().temperature_k,
    };
    // What is a surface there is a number of its map.
    let places = |spec: &CategorySpec| {
        let named = result.surfaces.iter().enumerate().filter(|(_, row)| spec.surfaces.contains(&row.name));
        named.map(|(place, _)| place).collect()
    };
    let category =
        |spec: &CategorySpec| CategorySpec { labels: places(spec), surfaces: Vec::new(), ..spec.clone() };
    let categories: Vec<CategorySpec> = result.scenario.categories.iter().map(category).collect();
    let labelled = categories.iter().any(|spec| !spec.labels.is_empty());
    DecomposeScenario {
        classes: std::collections::BTreeMap::new(),
        title: result.scenario.title.clone(),
        cube: HeatCube {
            data: match layout {
                Layout::Npy => file(&format.file("counts")),
                Layout::Hadar => file("HeatCubes/L_0001_heatcube.mat"),
            },
            variable: (layout == Layout::Hadar).then(|| "S".to_owned()),
            axes: None,
            unit: CubeUnit::Camera,
            noise: None,
            bad_bands: Vec::new(),
            bad_pixels: None,
            bad: Bad::default(),
        },
        bands: Some(BandsSpec {
            source: rising(&result.scenario.bands.source, &result.bands),
            ..result.scenario.bands.clone()
        }),
        camera: Some(result.scenario.camera.clone()),
        atmosphere: None,
        environment: result
            .surroundings
            .iter()
            .map(|name| LightSource::Spectrum { path: file("surroundings.csv"), column: name.clone() })
            .collect(),
        library: LibrarySpec { path: Some(file("library.csv")), ..LibrarySpec::default() },
        unknown: PixelUnknown {
            temperature_k,
            lighting_total: (result.lighting_left_out < NEARLY_ALL).then_some(1.0),
            gain: false,
            shared: Default::default(),
        },
        truth: Some(match layout {
            Layout::Npy => TruthSpec {
                material: Some(file("material.npy")),
                temperature: Some(file("temperature_k.npy")),
                lighting: vec![file("lighting.npy")],
                category: labelled.then(|| file("surface.npy")),
                ..TruthSpec::default()
            },
            Layout::Hadar => TruthSpec {
                material: Some(file("GroundTruth/eMap/eMap_L_0001.mat")),
                material_list: Some(file("GroundTruth/eMap/eList.mat")),
                temperature: Some(file("GroundTruth/tMap/tMap_L_0001.mat")),
                celsius: true,
                lighting: vec![file("GroundTruth/vMap/vMap_L_0001.mat")],
                category: None,
            },
        }),
        spatial: None,
        vision: Default::default(),
        categories,
        segmentation: Default::default(),
        // Files of its camera and bands are those of this scenario.
        source: result.scenario.source.clone(),
    }
}

/// The table of bands that a scenario of bands in a file has in its place.
const BANDS: &str = "bands.csv";

/// The same bands in rising wavenumber, as the cube has them, which a list says.
fn rising(asked: &BandSource, bands: &Bands) -> BandSource {
    match asked {
        BandSource::Unsaid | BandSource::Grid { .. } => asked.clone(),
        BandSource::Rows(_) => BandSource::Rows(PathBuf::from(BANDS)),
        BandSource::Filters(filters) => {
            let names = bands.bands().iter().filter_map(|band| band.name.clone()).collect();
            BandSource::Filters(Filters { names: Some(names), ..filters.clone() })
        }
        BandSource::Ranges(ranges) => {
            let mut ranges = ranges.clone();
            let ends = |[a, b]: &[Spectral; 2]| (a.wavenumber_cm1(), b.wavenumber_cm1());
            order::ascending(&mut ranges, |range| ends(range).0.max(ends(range).1));
            order::ascending(&mut ranges, |range| ends(range).0.min(ends(range).1));
            BandSource::Ranges(ranges)
        }
    }
}

fn surfaces(result: &Rendered) -> Table {
    let rows: Vec<_> = result.surfaces.iter().enumerate().collect();
    Table::of(
        &rows,
        &[
            ("surface", &|(_, row)| row.name.clone()),
            ("index", &|(index, _)| index.to_string()),
            ("materials", &|(_, row)| row.materials.join(", ")),
            ("pixels", &|(_, row)| row.pixels.to_string()),
            ("pure_pixels", &|(_, row)| row.pure.to_string()),
            ("temperature_k", &|(_, row)| optional((row.pure > 0).then_some(row.temperature_k))),
            ("nearest_m", &|(_, row)| optional(row.depth_m.map(|[near, _]| near))),
            ("farthest_m", &|(_, row)| optional(row.depth_m.map(|[_, far]| far))),
        ],
    )
}
