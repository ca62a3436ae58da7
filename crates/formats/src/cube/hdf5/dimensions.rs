//! Which axis of an array is which, by the names of its dimensions.
//!
//! An array of NetCDF-4 has a dimension for each of its axes, whose scale is an array of one dimension in the same group or one above it,
//! of the length of the axis. The references to it (`DIMENSION_LIST`) are not followed: where several dimensions are as long as an axis,
//! it may be any of them, and has a name only if all of them mean the same.
//!
//! Source: NetCDF-4 File Format, 'Dimensions'; HDF5 Dimension Scale Specification.

use super::array::{Array, MOST_ARRAYS};
use super::source::step;
use crate::cube::axes::Axes;
use hdf5_pure::{AttrValue, File};

/// The axes, where one of them is named as that of the bands.
pub(super) fn axes(source: &File, name: &str, array: &Array) -> Option<Axes> {
    let &[a, b, c] = array.sides.as_slice() else { return None };
    if array.matlab || !array.dataset.attr_datatypes().ok()?.contains_key("DIMENSION_LIST") {
        return None;
    }
    let scales = scales(source, name);
    let of_length = |side: usize| -> Vec<String> {
        scales.iter().filter(|(_, len)| *len == side as u64).map(|(name, _)| name.clone()).collect()
    };
    let names = [a, b, c].map(of_length);
    Axes::of_dimensions(names.each_ref().map(Vec::as_slice))
}

/// Names, in lower case, and lengths of the dimensions of the groups that an array is in.
fn scales(source: &File, array: &str) -> Vec<(String, u64)> {
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
            let class = dataset
                .attrs()
                .ok()
                .and_then(|all| all.get("CLASS").and_then(AttrValue::as_str).map(str::to_owned));
            if let (Some("DIMENSION_SCALE"), Ok([len])) = (class.as_deref(), dataset.shape().as_deref()) {
                scales.push((name.to_lowercase(), *len));
            }
        }
    }
    scales
}
