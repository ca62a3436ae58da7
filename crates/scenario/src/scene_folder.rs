//! A scene of the HADAR database as a folder: which of its files a key means.
//!
//! | file | what |
//! |---|---|
//! | `HeatCubes/{id}_heatcube.mat` | a heat cube; ids begin with `L_` for the left view, `R_` for the right one |
//! | `GroundTruth/tMap/tMap_{id}.mat` | temperatures, °C |
//! | `GroundTruth/eMap/eMap_{id}.mat`, `eList.mat` | materials by number, and what the numbers stand for |
//! | `GroundTruth/vMap/vMap_{id}.mat` | lighting factors, one after the other |

use super::decompose::TruthSpec;
use super::paths::file;
use super::section::Entry;
use hadar::error::{Error, Result};
use hadar_formats::cube::is_zarr;
use std::path::{Path, PathBuf};

const CUBES: &str = "HeatCubes";
const ENDING: &str = "_heatcube.mat";
/// Files of a message at most.
const NAMED: usize = 4;

/// A path to a cube; of a folder the cube in it whose name begins so, or the only one.
pub(super) fn cube_file(entry: &Entry<'_>, side: &str) -> Result<PathBuf> {
    let path = file(entry)?;
    if !path.is_dir() || is_zarr(&path) {
        return Ok(path);
    }
    of_folder(&path, side).map_err(|error| entry.fail(error))
}

fn of_folder(folder: &Path, side: &str) -> Result<PathBuf> {
    let cubes = folder.join(CUBES);
    let entries = std::fs::read_dir(&cubes).map_err(|_| {
        let found = format!("the folder {} has no {CUBES}", folder.display());
        Error::malformed(found, "name the file of a cube, or a scene of the HADAR database; all cubes of a folder are rows of a table: hadar sweep FILE --vary cube.data=FOLDER --out DIR")
    })?;
    let mut names: Vec<String> =
        entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| name.to_ascii_lowercase().ends_with(".mat"));
    names.sort_unstable();
    let own: Vec<&String> = names.iter().filter(|name| name.starts_with(side)).collect();
    match (own.as_slice(), names.as_slice()) {
        ([only], _) => Ok(cubes.join(only)),
        ([], [only]) if side == LEFT => Ok(cubes.join(only)),
        ([], []) => Err(Error::malformed(
            format!("{} holds no .mat file", cubes.display()),
            "name the file of a cube",
        )),
        _ => {
            let shown: Vec<&str> = names.iter().take(NAMED).map(String::as_str).collect();
            let more = if names.len() > NAMED { ", …" } else { "" };
            let found = format!("{} holds {}{more}", cubes.display(), shown.join(", "));
            Err(Error::malformed(found, "name the file of the one that is meant"))
        }
    }
}

/// The left view, which is looked at where nothing else is said, and the right one.
pub(super) const LEFT: &str = "L_";
pub(super) const RIGHT: &str = "R_";

/// The truth of a cube by the folder of its scene.
pub(super) fn truth(entry: &Entry<'_>, cube: &Path) -> Result<TruthSpec> {
    let folder = file(entry)?;
    let name = cube.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let Some(id) = name.strip_suffix(ENDING) else {
        let found = format!("the cube `{name}` has no name of the database, {{id}}{ENDING}");
        return Err(entry.fail(Error::malformed(found, "name the maps: material, temperature, lighting")));
    };
    let path = |kind: &str, name: &str| folder.join("GroundTruth").join(kind).join(name);
    let map = |kind: &str| Some(path(kind, &format!("{kind}_{id}.mat"))).filter(|map| map.is_file());
    let (material, temperature, lighting) = (map("eMap"), map("tMap"), map("vMap"));
    if material.is_none() && temperature.is_none() && lighting.is_none() {
        let found = format!("{} has no map of {id}", folder.join("GroundTruth").display());
        let instead = "name the folder of the scene that the cube is of, with tMap, eMap or vMap in it";
        return Err(entry.fail(Error::malformed(found, instead)));
    }
    Ok(TruthSpec {
        material_list: Some(path("eMap", "eList.mat")).filter(|list| material.is_some() && list.is_file()),
        material,
        temperature,
        celsius: true,
        lighting: lighting.into_iter().collect(),
        category: None,
    })
}
