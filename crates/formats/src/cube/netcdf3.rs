//! NetCDF files of the classic kinds (CDF-1, CDF-2 and CDF-5), which are no HDF5 files.
//!
//! A header lists dimensions, attributes and variables with their places; all numbers have their greatest byte first. Variables along the
//! unlimited dimension are cut into records that stand in turns with those of the others; such a one is read whole, all others by rows.
//!
//! Source: Unidata, NetCDF Classic Format Specification; CDF-5 of PnetCDF.

mod header;

pub(super) use self::header::MAGIC;
use self::header::{Header, Variable, damaged};
use super::arrange;
use super::axes::Axes;
use super::band_list;
use super::choice::{Listed, choose};
use super::found::{Found, Opened};
use super::raw::{Raw, read_at};
use super::stored::{Stored, decode};
use super::values::Values;
use hadar::cube::{Cube, MemoryCube, Sample, Shape};
use hadar::error::{Error, Result};
use std::fs::File;
use std::path::Path;

/// Opens a file whose first bytes have been seen.
pub(super) fn open(file: File, path: &Path, name: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    let len = file.metadata().map_err(damaged)?.len();
    let header = Header::read(&file, path, len)?;
    let numeric: Vec<(&Variable, Stored)> =
        header.variables.iter().filter_map(|variable| Some((variable, variable.stored()?))).collect();
    let listed: Vec<Listed> = numeric
        .iter()
        .map(|(variable, stored)| Listed {
            name: variable.name.clone(),
            sides: header.sides(variable),
            stored: stored.name(),
            unread: None,
        })
        .collect();
    let (variable, stored) = match numeric.get(choose(&listed, name)?) {
        Some((variable, stored)) => (*variable, *stored),
        None => return Err(damaged("a variable is lost")),
    };
    let of_variable = |error: Error| error.for_key(variable.name.clone());
    let sides = header.sides(variable);
    let names = [0, 1, 2].map(|place| header.dimension(variable, place));
    let by_name = || Axes::of_dimensions(names).filter(|_| sides.len() == 3);
    let axes = axes.or_else(by_name);
    let order = axes.unwrap_or_default();
    let shape = order.shape(&sides).map_err(of_variable)?;
    let of_file = [header.attributes.clone()];
    variable.attributes.check_scaling(&variable.name, of_file).map_err(of_variable)?;
    let values = variable.attributes.values_with(stored, variable.filled()).map_err(of_variable)?;
    let found = Found::array("NetCDF-3", shape, stored.name(), &sides);
    let mut found =
        Found { variable: Some(variable.name.clone()), axes, unit: variable.attributes.unit(), ..found };
    values.iter().for_each(|values| values.tell(&mut found));
    let records =
        Records { start: variable.begin, step: header.record_bytes, of_all: header.is_record(variable) };
    let slice = records.slice(&sides, stored);
    let end = match records.of_all {
        true => (sides.first().copied().unwrap_or(0) as u64).saturating_sub(1).checked_mul(records.step),
        false => Some((sides.first().copied().unwrap_or(0) as u64).saturating_sub(1).saturating_mul(slice)),
    };
    if end.and_then(|end| end.checked_add(slice)?.checked_add(records.start)).is_none_or(|end| end > len) {
        return Err(of_variable(damaged("it ends within the variable")));
    }
    (found.centres_cm1, found.axis_without_unit) = header.band_axis(&file, path, variable, shape.bands());
    let cube = if !records.of_all || records.step == slice {
        let start = records.start;
        Raw { file, path: path.to_owned(), shape, start, order, stored, little_endian: false, values }.cube()
    } else {
        found.memory_bytes = Some(shape.len() as u64 * if stored.is_double() { 8 } else { 4 });
        let from = (&file, path);
        match stored.is_double() {
            true => records.whole::<f64>(from, (shape, order), stored, values).map(Cube::from),
            false => records.whole::<f32>(from, (shape, order), stored, values).map(Cube::from),
        }
        .map_err(of_variable)?
    };
    Ok(Opened { cube, found })
}

/// Where the slices of a variable stand.
#[derive(Debug, Clone, Copy)]
struct Records {
    start: u64,
    /// From one record to the next, bytes.
    step: u64,
    /// Whether the slices are records.
    of_all: bool,
}

impl Records {
    /// Bytes of a slice of the first dimension.
    fn slice(self, sides: &[usize], stored: Stored) -> u64 {
        sides.iter().skip(1).fold(stored.size() as u64, |bytes, side| bytes.saturating_mul(*side as u64))
    }

    fn whole<S: Sample>(
        self,
        (file, path): (&File, &Path),
        (shape, order): (Shape, Axes),
        stored: Stored,
        values: Option<Values>,
    ) -> Result<MemoryCube<S>> {
        let [_, middle, inner] = order.sides(shape);
        let slice = middle * inner;
        let mut bytes = vec![0; slice * stored.size()];
        let mut place = self.start;
        let mut samples = arrange::whole(shape, order, |out: &mut [S]| {
            for out in out.chunks_mut(slice) {
                read_at(file, path, &mut bytes, place).map_err(damaged)?;
                decode(&bytes, stored, false, out);
                place += self.step;
            }
            Ok(())
        })?;
        if let Some(values) = &values {
            values.of_stored(&mut samples, shape.bands());
        }
        MemoryCube::new(shape, samples)
    }
}

impl Header {
    /// Centres of the bands by a variable along their dimension alone, cm⁻¹; and whether there is only one that does not say its unit.
    fn band_axis(&self, file: &File, path: &Path, cube: &Variable, bands: usize) -> (Option<Vec<f64>>, bool) {
        let is_axis = |variable: &&Variable| {
            variable.dimensions.len() == 1
                && cube.dimensions.contains(&variable.dimensions[0])
                && self.sides(variable) == [bands]
        };
        let mut unused = false;
        for variable in self.variables.iter().filter(is_axis) {
            let Some(stored) = variable.stored() else { continue };
            let read = || {
                let (mut word, mut numbers) = (vec![0; stored.size()], vec![0.0; bands]);
                let step = if self.is_record(variable) { self.record_bytes } else { stored.size() as u64 };
                for (place, number) in numbers.iter_mut().enumerate() {
                    let at = variable.begin.saturating_add(step.saturating_mul(place as u64));
                    read_at(file, path, &mut word, at).ok()?;
                    decode(&word, stored, false, std::slice::from_mut(number));
                }
                Some(numbers)
            };
            match band_list::of_array(&variable.name, &variable.attributes, stored, read) {
                Some(Some(centres)) => return (Some(centres), false),
                list => unused |= list.is_some(),
            }
        }
        let (centres, unknown) = band_list::of_attributes(&cube.attributes, bands);
        let unused = centres.is_none() && (unused || unknown);
        (centres, unused)
    }
}
