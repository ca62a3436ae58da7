//! Which axis of an array is which, by the names of its dimensions.
//!
//! An array of NetCDF-4 has a dimension for each of its axes, whose scale is an array of one dimension in the same group or one above it,
//! of the length of the axis. The library of NetCDF numbers scales (`_Netcdf4Dimid`) and lists the numbers of an array's
//! (`_Netcdf4Coordinates`); others label the axes (`DIMENSION_LABELS`). The references of other files (`DIMENSION_LIST`) are not followed: there each
//! axis may be any scale of its length, and where these say different things the axes have to be written.
//!
//! Source: NetCDF-4 File Format, 'Dimensions'; HDF5 Dimension Scale Specification.

use super::array::{Array, MOST_ARRAYS};
use super::source::step;
use crate::cube::axes::Axes;
use hadar::error::{Error, Result};
use hdf5_pure::{AttrValue, Dataset, File};
use std::collections::HashMap;

/// Scales of one length that are looked at: as many as any file has that somebody understands.
const MOST_OF_A_LENGTH: usize = 6;

/// The scale of a dimension.
struct Scale {
    name: String,
    len: u64,
    number: Option<i64>,
}

/// The axes, where one of them is named as that of the bands.
///
/// # Errors
/// Scales of the same length that leave it open.
pub(super) fn axes(source: &File, name: &str, array: &Array) -> Result<Option<Axes>> {
    let &[a, b, c] = array.sides.as_slice() else { return Ok(None) };
    let attributes = said(&array.dataset);
    if let Some([a, b, c]) = attributes.get("DIMENSION_LABELS").and_then(AttrValue::as_strings)
        && let Some(axes) = Axes::of_dimensions([a, b, c])
    {
        return Ok(Some(axes));
    }
    let types = array.dataset.attr_datatypes().unwrap_or_default();
    if array.matlab || !types.contains_key("DIMENSION_LIST") {
        return Ok(None);
    }
    let scales = scales(source, name);
    let numbered = |number: i64| scales.iter().find(|scale| scale.number == Some(number));
    if let Some(&[a, b, c]) = attributes.get("_Netcdf4Coordinates").and_then(AttrValue::to_i64s).as_deref()
        && let (Some(a), Some(b), Some(c)) = (numbered(a), numbered(b), numbered(c))
        && [a, b, c].iter().zip(&array.sides).all(|(scale, side)| scale.len == *side as u64)
    {
        return Ok(Axes::of_dimensions([&a.name, &b.name, &c.name]));
    }
    let of_length = |side: usize| -> Vec<&Scale> {
        scales.iter().filter(|scale| scale.len == side as u64).take(MOST_OF_A_LENGTH).collect()
    };
    let may_be = [a, b, c].map(of_length);
    // An axis without a scale has no name.
    let nameless = Scale { name: String::new(), len: 0, number: None };
    let names =
        may_be.each_ref().map(|scales| if scales.is_empty() { vec![&nameless] } else { scales.clone() });
    let mut found: Vec<Option<Axes>> = Vec::new();
    for first in &names[0] {
        for second in &names[1] {
            for third in &names[2] {
                let all = [*first, *second, *third];
                let is_twice = |i: usize, j: usize| std::ptr::eq(all[i], all[j]) && !all[i].name.is_empty();
                if !(is_twice(0, 1) || is_twice(0, 2) || is_twice(1, 2)) {
                    found.push(Axes::of_dimensions(all.map(|scale| scale.name.as_str())));
                }
            }
        }
    }
    match found.as_slice() {
        [] => Ok(None),
        [first, others @ ..] if others.iter().all(|other| other == first) => Ok(*first),
        _ => {
            let said: Vec<String> = may_be
                .iter()
                .zip(&array.sides)
                .map(|(scales, side)| {
                    let names: Vec<&str> = scales.iter().map(|scale| scale.name.as_str()).collect();
                    format!(
                        "{side} may be {}",
                        if names.is_empty() { "any".to_owned() } else { names.join(" or ") }
                    )
                })
                .collect();
            Err(Error::malformed(
                format!(
                    "several dimensions have the same length, and the file does not tell which is whose: {}",
                    said.join(", ")
                ),
                "write axes = \"rows,columns,bands\" or the order that the array has",
            ))
        }
    }
}

fn said(dataset: &Dataset) -> HashMap<String, AttrValue> {
    dataset.attrs().unwrap_or_default()
}

/// The dimensions of the groups that an array is in.
fn scales(source: &File, array: &str) -> Vec<Scale> {
    let mut scales = Vec::new();
    let mut groups = vec![source.root()];
    let mut folders: Vec<&str> = array.split('/').collect();
    folders.pop();
    for folder in folders {
        match groups.last().map(|group| group.group(folder)) {
            Some(Ok(inner)) => groups.push(inner),
            _ => break,
        }
    }
    for group in &groups {
        for name in group.datasets().unwrap_or_default().into_iter().take(MOST_ARRAYS) {
            step();
            let Ok(dataset) = group.dataset(&name) else { continue };
            let attributes = said(&dataset);
            let class = attributes.get("CLASS").and_then(AttrValue::as_str);
            if let (Some("DIMENSION_SCALE"), Ok([len])) = (class, dataset.shape().as_deref()) {
                let number = attributes.get("_Netcdf4Dimid").and_then(AttrValue::to_i64s);
                let number = number.and_then(|all| all.first().copied());
                scales.push(Scale { name, len: *len, number });
            }
        }
    }
    scales
}
