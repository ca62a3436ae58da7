//! What a file was read as: said with every answer, since a cube whose axes are mistaken looks like any other.

use super::Axes;
use hadar::cube::{Cube, Shape};
use hadar::order;
use serde::Serialize;
use std::fmt;

/// A short first axis before two of this many times its length may be the bands.
const SHORT: usize = 2;

#[expect(clippy::trivially_copy_pass_by_ref, reason = "a field is lent to be asked")]
const fn none(count: &usize) -> bool {
    *count == 0
}

/// A cube, and what its file was read as.
#[derive(Debug)]
pub struct Opened {
    /// The cube.
    pub cube: Cube,
    /// What the file was read as.
    pub found: Found,
}

/// What a file was read as.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Found {
    /// Name of the file, without its folder.
    pub file: String,
    /// What kind of file it is.
    pub format: &'static str,
    /// Which array of the file.
    pub variable: Option<String>,
    /// Rows, columns and bands.
    #[serde(flatten)]
    pub shape: Shape,
    /// How a sample is stored, `u16` or `f32`.
    pub stored: &'static str,
    /// In which order the array was said to have its axes.
    pub axes: Option<Axes>,
    /// Memory that the cube takes where it could not be left in the file, bytes.
    pub memory_bytes: Option<u64>,
    /// Stored numbers that were read as nothing measured.
    pub missing: Vec<f64>,
    /// Least and largest stored number that means something, where the file says them; others are missing too.
    pub valid: Option<[f64; 2]>,
    /// What stored numbers were multiplied by, one number for all bands or one for each in the order of the file; empty where by nothing.
    pub gain: Vec<f64>,
    /// What was added to them then, likewise.
    pub offset: Vec<f64>,
    /// The unit of the samples, or what they are, as the file says it.
    pub unit: Option<String>,
    /// Bands that the file says are bad, counted from 0 in its order.
    pub bad_bands: Vec<usize>,
    /// Centres of the bands in the order of the file, cm⁻¹, where it says them.
    #[serde(skip)]
    pub centres_cm1: Option<Vec<f64>>,
    /// Widths of the bands, cm⁻¹, where it says them.
    #[serde(skip)]
    pub widths_cm1: Option<Vec<f64>>,
    /// Whether the file lists wavelengths or wavenumbers without their unit, so that they are not used.
    pub axis_without_unit: bool,
    /// Chunks of a file that were never written; their samples are missing.
    #[serde(skip_serializing_if = "none")]
    pub absent_chunks: usize,
    /// Sides of the array as the file has them.
    #[serde(skip)]
    pub(super) sides: Vec<usize>,
}

impl Found {
    /// What is known of any array.
    pub(super) fn array(format: &'static str, shape: Shape, stored: &'static str, sides: &[usize]) -> Self {
        Self {
            file: String::new(),
            format,
            variable: None,
            shape,
            stored,
            axes: None,
            memory_bytes: None,
            missing: Vec::new(),
            valid: None,
            gain: Vec::new(),
            offset: Vec::new(),
            unit: None,
            bad_bands: Vec::new(),
            centres_cm1: None,
            widths_cm1: None,
            axis_without_unit: false,
            absent_chunks: 0,
            sides: sides.to_vec(),
        }
    }

    /// The sample that the largest number of the stored type stands for, of whole numbers that were not changed by bands.
    #[must_use]
    pub fn largest_stored(&self) -> Option<f64> {
        let bits = match self.stored {
            "u8" | "uint8" => 8,
            "u16" | "uint16" => 16,
            "u32" | "uint32" => 32,
            "i8" | "int8" => 7,
            "i16" | "int16" => 15,
            "i32" | "int32" => 31,
            _ => return None,
        };
        let largest = 2.0_f64.powi(bits) - 1.0;
        match (self.gain.as_slice(), self.offset.as_slice()) {
            ([], []) => Some(largest),
            _ => None,
        }
    }

    /// Bands of the file in rising wavenumber: by the centres that it states, else as `listed` has them, else as they are.
    #[must_use]
    pub fn rising_bands(&self, listed: Option<&[usize]>) -> Vec<usize> {
        let bands = self.shape.bands();
        let mut order: Vec<usize> = (0..bands).collect();
        match (&self.centres_cm1, listed) {
            (Some(centres), _) => {
                order::ascending(&mut order, |band| centres.get(*band).copied().unwrap_or(f64::NAN));
            }
            // Of another length it is refused where the bands are counted.
            (None, Some(listed)) if listed.len() == bands => order = listed.to_vec(),
            (None, _) => {}
        }
        order
    }

    /// The axes by which the array has so many bands, where one of its sides alone is so long.
    #[must_use]
    pub fn axes_of_bands(&self, bands: usize) -> Option<Axes> {
        let mut places = self.sides.iter().enumerate().filter(|(_, side)| **side == bands);
        match (self.sides.len(), places.next(), places.next()) {
            (3, Some((dimension, _)), None) => Some(Axes::with_bands_on(dimension)),
            _ => None,
        }
    }

    /// Whether nobody has said what the axes are and the first is so short that it may be the bands.
    #[must_use]
    pub fn may_begin_with_bands(&self) -> bool {
        match *self.sides.as_slice() {
            [a, b, c] => self.axes.is_none() && a > 1 && a.saturating_mul(SHORT) <= b.min(c),
            _ => false,
        }
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (rows, columns, bands) = (self.shape.rows(), self.shape.columns(), self.shape.bands());
        let file = self.file.escape_debug();
        write!(f, "{rows} rows x {columns} columns x {bands} bands, {}, {file}", self.stored)?;
        let mut more = vec![self.format.to_owned()];
        if let Some(variable) = &self.variable {
            more.push(format!("variable {}", variable.escape_debug()));
        }
        if let Some(axes) = &self.axes {
            more.push(format!("axes {axes}"));
        }
        if !self.missing.is_empty() {
            let number =
                |value: &f64| if value.abs() < 1e15 { value.to_string() } else { format!("{value:e}") };
            let numbers: Vec<String> = self.missing.iter().map(number).collect();
            more.push(format!("{} taken as missing", numbers.join(" and ")));
        }
        if let Some([least, most]) = self.valid {
            more.push(match (least.is_finite(), most.is_finite()) {
                (true, true) => format!("below {least} and above {most} taken as missing"),
                (true, false) => format!("below {least} taken as missing"),
                _ => format!("above {most} taken as missing"),
            });
        }
        for (what, list) in [("gain", &self.gain), ("offset", &self.offset)] {
            more.extend(match list.as_slice() {
                [] => None,
                [one] => Some(format!("{what} {one} applied")),
                many => {
                    let least = many.iter().copied().fold(f64::INFINITY, f64::min);
                    let most = many.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    Some(format!("{what}s {least} to {most} by band applied"))
                }
            });
        }
        if let Some(unit) = &self.unit {
            more.push(format!("in {}", unit.escape_debug()));
        }
        if !self.bad_bands.is_empty() {
            let bands: Vec<String> = self.bad_bands.iter().map(usize::to_string).collect();
            more.push(format!("bands {} bad by its list", bands.join(", ")));
        }
        if self.absent_chunks > 0 {
            more.push(format!("{} chunks never written, their samples missing", self.absent_chunks));
        }
        if let Some(bytes) = self.memory_bytes {
            more.push(format!("whole in memory, {:.1} MB", bytes as f64 / 1e6));
        }
        write!(f, " ({})", more.join("; "))
    }
}
