//! What an emissivity is computed from: one tree for every kind of surface.
//!
//! - constant; polynomial e = Σ cᵢ tⁱ with t = (ν − ν₀)/Δ; table of e, linear in ν;
//! - smooth surfaces of a dielectric (see `fresnel`);
//! - rough surface as isothermal cavities of area ratio A ≥ 1 (inner area over opening):
//!   e′ = e/(e + (1 − e)/A);
//! - weighted mean of surfaces: axes of a crystal, area mixtures.
//!
//! A tree is valid by construction; it knows the range in which all its tables have rows.
//! Source of the cavity form: Gouffé's isothermal cavity without its view-factor correction
//! (Bedford, in DeWitt and Nutter, Theory and Practice of Radiation Thermometry, 1988, ch. 12).

use super::dielectric::Dielectric;
use super::fresnel;
use super::table::Table;
use crate::error::{Error, Result, check};
use crate::spectrum::same;
use serde::Deserialize;
use std::sync::Arc;

/// Most surfaces in a tree. One that stands there several times is computed as often, so that a few lines, each made
/// twice of the one before, would take forever.
const MOST_PARTS: usize = 1000;

/// A range of wavenumbers in cm⁻¹; `None` is everywhere.
pub(super) type Range = Option<(f64, f64)>;

/// A surface. Built with the functions of `impl Model`, which check the numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Model {
    Constant(f64),
    Polynomial(Polynomial),
    Table(Table<1>),
    HalfSpace(Dielectric),
    Film { film: Dielectric, thickness_um: f64, substrate: Dielectric },
    Slab { medium: Dielectric, thickness_um: f64 },
    Cavity { area_ratio: f64, surface: Arc<Model> },
    Mean(Vec<(f64, Arc<Model>)>),
    Within { low_cm1: f64, high_cm1: f64, surface: Arc<Model> },
}

/// e = Σ cᵢ tⁱ, t = (ν − centre)/scale.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Polynomial {
    centre_cm1: f64,
    scale_cm1: f64,
    coefficients: Vec<f64>,
}

impl Polynomial {
    fn at(&self, wavenumber_cm1: f64) -> f64 {
        let t = (wavenumber_cm1 - self.centre_cm1) / self.scale_cm1;
        self.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * t + coefficient)
    }
}

impl Model {
    /// The same emissivity everywhere.
    pub(super) fn constant(emissivity: f64) -> Result<Self> {
        check::unit_interval("emissivity", emissivity).map(Self::Constant)
    }

    /// A polynomial with finite coefficients and a scale above 0.
    pub(super) fn polynomial(polynomial: Polynomial) -> Result<Self> {
        check::finite("centre_cm1", polynomial.centre_cm1, "cm^-1")?;
        check::positive("scale_cm1", polynomial.scale_cm1, "cm^-1")?;
        for &coefficient in &polynomial.coefficients {
            check::finite("coefficients", coefficient, "")?;
        }
        Ok(Self::Polynomial(polynomial))
    }

    /// A film on an opaque substrate.
    pub(super) fn film(film: Dielectric, thickness_um: f64, substrate: Dielectric) -> Result<Self> {
        check::non_negative("thickness_um", thickness_um, "um")?;
        Self::Film { film, thickness_um, substrate }.somewhere()
    }

    /// A free-standing slab.
    pub(super) fn slab(medium: Dielectric, thickness_um: f64) -> Result<Self> {
        check::non_negative("thickness_um", thickness_um, "um")?;
        Ok(Self::Slab { medium, thickness_um })
    }

    /// A surface roughened into cavities of the given ratio of inner area to opening.
    pub(super) fn cavity(area_ratio: f64, surface: Arc<Model>) -> Result<Self> {
        if !(area_ratio.is_finite() && area_ratio >= 1.0) {
            return Err(Error::out_of_range("area_ratio", area_ratio, "", "a finite number, 1 or above"));
        }
        Self::Cavity { area_ratio, surface }.of_few_parts()
    }

    /// The mean of surfaces, each with the number of parts it makes up.
    pub(super) fn mean(parts: Vec<(f64, Arc<Model>)>) -> Result<Self> {
        let mut total = 0.0;
        for (weight, _) in &parts {
            total += check::positive("parts", *weight, "")?;
        }
        if parts.is_empty() {
            return Err(Error::malformed("a mixture of nothing", "name at least one part"));
        }
        check::finite("sum of the parts", total, "")?;
        let parts = parts.into_iter().map(|(weight, part)| (weight / total, part));
        Self::Mean(parts.collect()).of_few_parts()?.somewhere()
    }

    /// A surface that is vouched for only between two wavenumbers.
    pub(super) fn within(low_cm1: f64, high_cm1: f64, surface: Arc<Model>) -> Result<Self> {
        check::positive("range_cm1", low_cm1, "cm^-1")?;
        check::positive("range_cm1", high_cm1, "cm^-1")?;
        Self::Within { low_cm1, high_cm1, surface }.of_few_parts()?.somewhere()
    }

    /// Surfaces in the tree, itself among them.
    fn parts(&self) -> usize {
        1 + match self {
            Self::Cavity { surface, .. } | Self::Within { surface, .. } => surface.parts(),
            Self::Mean(parts) => parts.iter().map(|(_, part)| part.parts()).sum(),
            _ => 0,
        }
    }

    /// The model, if it is no larger than any surface needs.
    fn of_few_parts(self) -> Result<Self> {
        match self.parts() {
            parts if parts > MOST_PARTS => Err(Error::malformed(
                format!("the surface is made of {parts} surfaces"),
                format!("make it of at most {MOST_PARTS}"),
            )),
            _ => Ok(self),
        }
    }

    /// The model, if its parts have a range in common.
    fn somewhere(self) -> Result<Self> {
        match self.range() {
            Some((low, high)) if low >= high => Err(Error::malformed(
                "the parts of the surface have no wavenumber in common",
                "use spectra whose ranges overlap",
            )),
            _ => Ok(self),
        }
    }

    /// Where the emissivity is known.
    pub(super) fn range(&self) -> Range {
        match self {
            Self::Constant(_) | Self::Polynomial(_) => None,
            Self::Table(table) => table.range_cm1(),
            Self::HalfSpace(medium) | Self::Slab { medium, .. } => medium_range(medium),
            Self::Film { film, substrate, .. } => common(medium_range(film), medium_range(substrate)),
            Self::Cavity { surface, .. } => surface.range(),
            Self::Mean(parts) => parts.iter().fold(None, |range, (_, part)| common(range, part.range())),
            Self::Within { low_cm1, high_cm1, surface } => {
                common(Some((*low_cm1, *high_cm1)), surface.range())
            }
        }
    }

    /// Number of rows of all tables.
    pub(super) fn rows(&self) -> usize {
        let mut rows = 0;
        self.each_table(&mut |wavenumbers| rows += wavenumbers.len());
        rows
    }

    /// Calls `f` with the row wavenumbers of every table of the tree.
    pub(super) fn each_table(&self, f: &mut impl FnMut(&[f64])) {
        let mut medium = |medium: &Dielectric| {
            if let Some(table) = medium.table() {
                f(table.wavenumbers_cm1());
            }
        };
        match self {
            Self::Constant(_) | Self::Polynomial(_) => {}
            Self::Table(table) => f(table.wavenumbers_cm1()),
            Self::HalfSpace(dielectric) | Self::Slab { medium: dielectric, .. } => medium(dielectric),
            Self::Film { film, substrate, .. } => {
                medium(film);
                medium(substrate);
            }
            Self::Cavity { surface, .. } | Self::Within { surface, .. } => surface.each_table(f),
            Self::Mean(parts) => parts.iter().for_each(|(_, part)| part.each_table(f)),
        }
    }

    /// Emissivity at one wavenumber in cm⁻¹, not yet checked to lie in [0, 1].
    ///
    /// # Errors
    /// Outside a table, next to a row whose emissivity is not between 0 and 1, or where a polynomial leaves [0, 1].
    pub(super) fn emissivity(&self, wavenumber_cm1: f64) -> Result<f64> {
        match self {
            Self::Constant(emissivity) => Ok(*emissivity),
            Self::Polynomial(polynomial) => in_unit_interval(polynomial.at(wavenumber_cm1), || {
                format!("polynomial at {wavenumber_cm1} cm^-1")
            }),
            Self::Table(table) => tabulated(table, wavenumber_cm1),
            Self::HalfSpace(medium) => Ok(fresnel::half_space(medium.index(wavenumber_cm1)?)),
            Self::Film { film, thickness_um, substrate } => {
                let (film, substrate) = (film.index(wavenumber_cm1)?, substrate.index(wavenumber_cm1)?);
                Ok(fresnel::film(film, substrate, *thickness_um, wavenumber_cm1))
            }
            Self::Slab { medium, thickness_um } => {
                Ok(fresnel::slab(medium.index(wavenumber_cm1)?, *thickness_um, wavenumber_cm1))
            }
            Self::Cavity { area_ratio, surface } => {
                let e = surface.emissivity(wavenumber_cm1)?;
                Ok(e / (e + (1.0 - e) / area_ratio))
            }
            Self::Mean(parts) => parts
                .iter()
                .try_fold(0.0, |sum, (weight, part)| Ok(sum + weight * part.emissivity(wavenumber_cm1)?)),
            Self::Within { surface, .. } => surface.emissivity(wavenumber_cm1),
        }
    }
}

fn tabulated(table: &Table<1>, wavenumber_cm1: f64) -> Result<f64> {
    table.check_gap(wavenumber_cm1)?;
    let outside = || Error::out_of_range("wavenumber", wavenumber_cm1, "cm^-1", "within the rows");
    for (row_cm1, [emissivity]) in table.used_rows(wavenumber_cm1).ok_or_else(outside)? {
        in_unit_interval(emissivity, || format!("emissivity of the row at {row_cm1} cm^-1"))
            .map_err(noisy)?;
    }
    table.at(wavenumber_cm1).map(|[emissivity]| emissivity).ok_or_else(outside)
}

/// What measured rows go beyond [0, 1] by at most where that is noise.
const NOISE: f64 = 0.05;

/// The error of a row, with what cuts noise off where it may be that.
fn noisy(error: Error) -> Error {
    match error {
        Error::OutOfRange { quantity, value, unit, expected } if (-NOISE..=1.0 + NOISE).contains(&value) => {
            let expected = format!("{expected}; `hadar materials import FILE --clip {NOISE}` cuts noise off");
            Error::OutOfRange { quantity, value, unit, expected }
        }
        other => other,
    }
}

/// The emissivity, if it lies in [0, 1]; the name is only made for the error.
fn in_unit_interval(emissivity: f64, name: impl Fn() -> String) -> Result<f64> {
    if (0.0..=1.0).contains(&emissivity) {
        return Ok(emissivity);
    }
    if emissivity.is_nan() {
        let found = format!("{} is bad or missing in its file", name());
        let instead = "narrow the bands to where it is known, or leave the row out if a straight line may stand for it, as `hadar materials import FILE --clip 0` does in gaps of at most 20 cm^-1";
        return Err(Error::malformed(found, instead));
    }
    check::unit_interval(&name(), emissivity)
}

fn medium_range(medium: &Dielectric) -> Range {
    medium.table().and_then(Table::range_cm1)
}

/// Where both ranges are known. Ends that are the same but for rounding count as one.
fn common(a: Range, b: Range) -> Range {
    match (a, b) {
        (Some((low_a, high_a)), Some((low_b, high_b))) => Some((low_a.max(low_b), high_a.min(high_b))),
        (range, None) | (None, range) => range,
    }
}

/// Whether a wavenumber lies in a range, ends included.
pub(super) fn inside(range: Range, wavenumber_cm1: f64) -> bool {
    range.is_none_or(|(low, high)| {
        (low..=high).contains(&wavenumber_cm1) || same(low, wavenumber_cm1) || same(high, wavenumber_cm1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: &[(f64, f64)]) -> Arc<Model> {
        let rows: Vec<(f64, [f64; 1])> = rows.iter().map(|&(x, e)| (x, [e])).collect();
        Arc::new(Model::Table(Table::new(&rows).unwrap()))
    }

    #[test]
    fn a_cavity_of_area_ratio_one_is_the_surface_itself_and_a_deep_one_is_black() {
        let surface = table(&[(700.0, 0.2), (1300.0, 0.8)]);
        let flat = Model::cavity(1.0, surface.clone()).unwrap();
        let deep = Model::cavity(1e9, surface.clone()).unwrap();
        let two = Model::cavity(2.0, surface.clone()).unwrap();
        for wavenumber in [700.0, 913.0, 1300.0] {
            let e = surface.emissivity(wavenumber).unwrap();
            assert!((flat.emissivity(wavenumber).unwrap() - e).abs() < 1e-15);
            assert!((deep.emissivity(wavenumber).unwrap() - 1.0).abs() < 1e-8);
            assert!((two.emissivity(wavenumber).unwrap() - 2.0 * e / (1.0 + e)).abs() < 1e-15);
        }
        assert!(Model::cavity(0.99, surface).is_err());
    }

    #[test]
    fn a_mean_is_known_where_all_its_parts_are() {
        let mean = Model::mean(vec![
            (2.0, table(&[(700.0, 0.9), (1300.0, 0.9)])),
            (1.0, table(&[(800.0, 0.3), (1400.0, 0.3)])),
        ])
        .unwrap();
        assert_eq!(mean.range(), Some((800.0, 1300.0)));
        assert!((mean.emissivity(1000.0).unwrap() - 0.7).abs() < 1e-15);
        assert_eq!(mean.rows(), 4);
        let apart = Model::mean(vec![
            (1.0, table(&[(700.0, 0.9), (800.0, 0.9)])),
            (1.0, table(&[(900.0, 0.3), (1400.0, 0.3)])),
        ]);
        assert!(apart.unwrap_err().to_string().contains("no wavenumber in common"));
        assert!(Model::mean(vec![]).is_err());
    }

    #[test]
    fn a_row_outside_the_unit_interval_is_an_error_only_where_it_is_used() {
        let surface = table(&[(700.0, 1.2), (800.0, 0.5), (900.0, 0.6)]);
        assert!(surface.emissivity(750.0).unwrap_err().to_string().contains("row at 700 cm^-1"));
        assert_eq!(surface.emissivity(800.0).unwrap(), 0.5);
        assert!(surface.emissivity(850.0).is_ok());
    }
}
