//! Maps of what is there, as files have them, read by rows.

use crate::pixel_map::{Map, read};
use hadar::cube::Shape;
use hadar::error::{Error, Result};
use hadar_estimate::decompose::NO_MATERIAL;
use hadar_scenario::decompose::TruthSpec;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// 0 degC, K.
const FREEZING_K: f64 = 273.15;

/// Files of what is there.
#[derive(Debug)]
pub(crate) struct Truth {
    rows: usize,
    material: Option<Map>,
    /// Places in the library of the numbers in the map of materials, where it has a list.
    places: Option<Vec<f64>>,
    temperature: Option<Map>,
    /// Kelvin at its zero.
    zero_k: f64,
    lighting: Vec<Map>,
    category: Option<Map>,
    /// Pixels whose material is one of the library.
    pub(super) known: usize,
}

/// What is there in some rows, `[row][column]`.
#[derive(Debug)]
pub(crate) struct There {
    pub(crate) material: Option<Vec<usize>>,
    pub(crate) temperature_k: Option<Vec<f64>>,
    /// `[row][column][surroundings]`.
    pub(crate) lighting: Option<Vec<f64>>,
    /// A number for each pixel's category.
    pub(crate) category: Option<Vec<usize>>,
}

impl Truth {
    /// Opens the maps, and makes sure that those of materials and categories hold such numbers; an error with its key.
    pub(crate) fn open(
        spec: &TruthSpec,
        shape: Shape,
        surroundings: usize,
        materials: usize,
    ) -> std::result::Result<Self, (String, Error)> {
        let map = |key: &str, path: &Path, layers: &[usize]| {
            Map::open(path, shape, layers).map_err(|error| (key.to_owned(), error))
        };
        let one =
            |key: &str, path: &Option<PathBuf>| path.as_deref().map(|path| map(key, path, &[1])).transpose();
        let list = |path: &PathBuf| {
            all(path).map_err(|error| ("truth.material_list".to_owned(), error.in_file(path)))
        };
        let key = "truth.lighting";
        let layers: &[usize] = if spec.lighting.len() == 1 { &[surroundings, 1] } else { &[1] };
        let lighting = spec
            .lighting
            .iter()
            .map(|path| map(key, path, layers))
            .collect::<std::result::Result<Vec<_>, _>>()?;
        let found: usize = lighting.iter().map(|map| map.cube.shape().bands()).sum();
        if !lighting.is_empty() && found != surroundings {
            let found = format!("{found} maps of lighting for {surroundings} surroundings");
            return Err((key.into(), Error::malformed(found, "give one for each [[environment]]")));
        }
        let mut truth = Self {
            rows: shape.rows(),
            material: one("truth.material", &spec.material)?,
            places: match &spec.material {
                Some(_) => spec.material_list.as_ref().map(list).transpose()?,
                None => None,
            },
            temperature: one("truth.temperature", &spec.temperature)?,
            zero_k: if spec.celsius { FREEZING_K } else { 0.0 },
            lighting,
            category: one("truth.category", &spec.category)?,
            known: 0,
        };
        truth.known = truth.checked(spec, materials)?;
        Ok(truth)
    }

    /// Pixels whose material is one of so many.
    fn checked(&self, spec: &TruthSpec, materials: usize) -> std::result::Result<usize, (String, Error)> {
        let mut known = 0;
        for row in 0..self.rows {
            if let Some(map) = &self.material {
                let key = || "truth.material".to_owned();
                let places = map.read(row..row + 1).map_err(|error| (key(), error))?;
                let places = self.listed(places).map_err(|error| match &spec.material_list {
                    Some(list) => ("truth.material_list".to_owned(), error.in_file(list)),
                    None => (key(), error),
                })?;
                let is_known = |place: f64| place >= 0.0 && place < materials as f64;
                let wrong = |place: &&f64| {
                    !(place.fract() == 0.0 && (is_known(**place) || **place == f64::from(NO_MATERIAL)))
                };
                if let Some(wrong) = places.iter().find(wrong) {
                    let found = format!("material {wrong} of {materials}");
                    let instead = "count from 0 in the order of the library, 65535 for none";
                    return Err((key(), Error::malformed(found, instead).in_file(&map.path)));
                }
                known += places.iter().filter(|place| is_known(**place)).count();
            }
            if let Some(map) = &self.category {
                let key = || "truth.category".to_owned();
                let labels = map.read(row..row + 1).map_err(|error| (key(), error))?;
                if let Some(wrong) = labels.iter().find(|value| !(**value >= 0.0 && value.fract() == 0.0)) {
                    let found = format!("a pixel of category {wrong}");
                    let instead = "give each a whole number, 255 where the truth is not known";
                    return Err((key(), Error::malformed(found, instead).in_file(&map.path)));
                }
            }
        }
        Ok(known)
    }

    /// What is there in some rows.
    pub(crate) fn rows(&self, rows: Range<usize>) -> Result<There> {
        let whole = |values: Vec<f64>| values.into_iter().map(|value| value as usize).collect();
        let read = |map: &Map| map.read(rows.clone());
        let material = self.material.as_ref().map(|map| self.listed(read(map)?)).transpose()?;
        let kelvin = |map: &Map| Ok(read(map)?.into_iter().map(|value| value + self.zero_k).collect());
        let lighting = self.lighting.iter().map(read).collect::<Result<Vec<_>>>()?;
        Ok(There {
            material: material.map(whole),
            temperature_k: self.temperature.as_ref().map(kelvin).transpose()?,
            lighting: match <[Vec<f64>; 1]>::try_from(lighting) {
                Ok([one]) => Some(one),
                Err(several) => several.first().map(|first| interleaved(first.len(), &several)),
            },
            category: self.category.as_ref().map(|map| Ok(whole(read(map)?))).transpose()?,
        })
    }

    /// What is there in all rows.
    pub(crate) fn all(&self) -> Result<There> {
        self.rows(0..self.rows)
    }

    pub(super) fn has_materials(&self) -> bool {
        self.material.is_some()
    }

    /// Whether material, temperature and lighting are known.
    pub(super) fn has_states(&self) -> bool {
        self.has_materials() && self.temperature.is_some() && !self.lighting.is_empty()
    }

    /// Places in the library, from 0, of places in a list of them, both from 1; 0 stands for none. Without a list what is there.
    fn listed(&self, places: Vec<f64>) -> Result<Vec<f64>> {
        let Some(list) = &self.places else { return Ok(places) };
        let place = |place: &f64| {
            let own = match *place {
                0.0 => return Ok(f64::from(NO_MATERIAL)),
                place if place >= 1.0 && place.fract() == 0.0 => list.get(place as usize - 1),
                _ => None,
            };
            own.map(|own| own - 1.0).ok_or_else(|| {
                let found = format!("place {place} of a list of {}", list.len());
                Error::malformed(found, "give the list that belongs to truth.material")
            })
        };
        places.iter().map(place).collect()
    }
}

/// All samples of a file.
fn all(path: &Path) -> Result<Vec<f64>> {
    let cube = hadar_formats::cube::open(path, None)?;
    read(&cube, 0..cube.shape().rows())
}

/// Maps one pixel after the other.
fn interleaved(pixels: usize, maps: &[Vec<f64>]) -> Vec<f64> {
    (0..pixels).flat_map(|i| maps.iter().filter_map(move |map| map.get(i).copied())).collect()
}
