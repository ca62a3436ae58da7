//! Maps of what is there, as files have them.

use crate::scenario::decompose::TruthSpec;
use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::decompose::NO_MATERIAL;
use hadar::error::{Error, Result};
use std::path::Path;

/// 0 degC, K.
const FREEZING_K: f64 = 273.15;

/// Maps of what is there, `[row][column]`.
#[derive(Debug)]
pub(in crate::study) struct Truth {
    pub(in crate::study) material: Option<Vec<usize>>,
    pub(in crate::study) temperature_k: Option<Vec<f64>>,
    /// `[row][column][surroundings]`.
    pub(in crate::study) lighting: Option<Vec<f64>>,
    /// A number for each pixel's category.
    pub(in crate::study) category: Option<Vec<usize>>,
}

impl Truth {
    /// Opens the maps; an error with its key.
    pub(in crate::study) fn open(
        spec: &TruthSpec,
        shape: Shape,
        surroundings: usize,
        materials: usize,
    ) -> std::result::Result<Self, (String, Error)> {
        let map = |key: &str, path: &Path, layers: &[usize]| {
            values(path, shape, layers).map_err(|error| (key.to_owned(), error))
        };
        let material = match &spec.material {
            None => None,
            Some(path) => {
                let key = "truth.material";
                let places = map(key, path, &[1])?;
                let places = match &spec.material_list {
                    None => places,
                    Some(list) => listed(&places, list)
                        .map_err(|error| ("truth.material_list".to_owned(), error.in_file(list)))?,
                };
                let wrong = |place: &&f64| {
                    !(place.fract() == 0.0
                        && (**place >= 0.0 && **place < materials as f64
                            || **place == f64::from(NO_MATERIAL)))
                };
                if let Some(wrong) = places.iter().find(wrong) {
                    let found = format!("material {wrong} of {materials}");
                    let instead = "count from 0 in the order of the library, 65535 for none";
                    return Err((key.into(), Error::malformed(found, instead).in_file(path)));
                }
                Some(places.iter().map(|place| *place as usize).collect())
            }
        };
        let zero_k = if spec.celsius { FREEZING_K } else { 0.0 };
        let kelvin = |path| {
            let values = map("truth.temperature", path, &[1])?;
            Ok(values.into_iter().map(|value| value + zero_k).collect())
        };
        let temperature_k = spec.temperature.as_deref().map(kelvin).transpose()?;
        let key = "truth.lighting";
        let lighting = match spec.lighting.as_slice() {
            [] => None,
            [path] => Some(map(key, path, &[surroundings, 1])?),
            several => Some(interleaved(
                &several
                    .iter()
                    .map(|path| map(key, path, &[1]))
                    .collect::<std::result::Result<Vec<_>, _>>()?,
            )),
        };
        let pixels = shape.rows() * shape.columns();
        if let Some(lighting) = &lighting
            && lighting.len() != pixels * surroundings
        {
            let found =
                format!("{} maps of lighting for {surroundings} surroundings", lighting.len() / pixels);
            return Err((key.into(), Error::malformed(found, "give one for each [[environment]]")));
        }
        let category = match &spec.category {
            None => None,
            Some(path) => {
                let key = "truth.category";
                let labels = map(key, path, &[1])?;
                if let Some(wrong) = labels.iter().find(|value| !(**value >= 0.0 && value.fract() == 0.0)) {
                    let found = format!("a pixel of category {wrong}");
                    let instead = "give each a whole number, 255 where the truth is not known";
                    return Err((key.into(), Error::malformed(found, instead).in_file(path)));
                }
                Some(labels.into_iter().map(|label| label as usize).collect())
            }
        };
        Ok(Self { material, temperature_k, lighting, category })
    }
}

/// Places in the library, from 0, of places in a list of them, both from 1; 0 stands for none.
fn listed(places: &[f64], list: &Path) -> Result<Vec<f64>> {
    let list = all(&Cube::open(list, None)?)?;
    let place = |place: &f64| match *place {
        0.0 => Ok(f64::from(NO_MATERIAL)),
        place if place >= 1.0 && place.fract() == 0.0 && place <= list.len() as f64 => {
            Ok(list[place as usize - 1] - 1.0)
        }
        place => {
            let found = format!("place {place} of a list of {}", list.len());
            Err(Error::malformed(found, "give the list that belongs to truth.material"))
        }
    };
    places.iter().map(place).collect()
}

/// A map of so many layers as one of `layers`.
fn values(path: &Path, shape: Shape, layers: &[usize]) -> Result<Vec<f64>> {
    let cube = Cube::open(path, None)?;
    let found = cube.shape();
    if (found.rows(), found.columns()) != (shape.rows(), shape.columns()) || !layers.contains(&found.bands())
    {
        let found = format!(
            "the map is {} x {} x {}, the cube {} x {} pixels",
            found.rows(),
            found.columns(),
            found.bands(),
            shape.rows(),
            shape.columns()
        );
        return Err(Error::malformed(found, "give one value for each pixel").in_file(path));
    }
    all(&cube)
}

/// All samples of a cube.
fn all(cube: &Cube) -> Result<Vec<f64>> {
    fn read<S: Sample>(rows: &dyn Rows<S>) -> Result<Vec<f64>> {
        let mut buffer = Vec::new();
        Ok(rows.read(0..rows.shape().rows(), &mut buffer)?.iter().map(|x| (*x).into()).collect())
    }
    match cube {
        Cube::F32(rows) => read(rows.as_ref()),
        Cube::F64(rows) => read(rows.as_ref()),
    }
}

/// Maps one pixel after the other.
fn interleaved(maps: &[Vec<f64>]) -> Vec<f64> {
    (0..maps[0].len()).flat_map(|i| maps.iter().map(move |map| map[i])).collect()
}
