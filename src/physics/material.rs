//! Materials: how strongly a surface emits, at which wavenumber, and how that is known.
//!
//! A [`Material`] is a spectral emissivity e(ν) in [0, 1] with its [`Provenance`]. It is evaluated on
//! whatever wavenumbers are asked for (cm⁻¹), from a constant, a table, or a model of optics; see
//! [`Library`] for the embedded ones.
//!
//! Assumptions: normal incidence unless the note says otherwise, unpolarised, opaque unless it is a slab.
//! Between rows of a table the tabulated quantity (emissivity, or n and k) is linear in wavenumber, and a
//! wavenumber that is a row's (to 1e-12 relative) gets that row's value. Outside its range a material is an error
//! unless an [`Extrapolation`] is asked for. An emissivity outside [0, 1] is an error, never clamped; only rounding
//! (1e-9) is forgiven to a model.

mod class;
// What only manifests ask for is idle without them.
#[cfg_attr(not(feature = "library"), allow(dead_code, unused_imports))]
mod dielectric;
#[cfg(feature = "library")]
mod embedded;
mod fresnel;
mod gaussian;
mod library;
#[cfg(feature = "library")]
mod manifest;
#[cfg_attr(not(feature = "library"), allow(dead_code, unused_imports))]
mod model;
mod oscillator;
mod provenance;
mod table;
mod write;

pub use class::{ClassSpec, ENDINGS, LibraryClass, MaterialRef, Spread, is_spectra};
pub use dielectric::OpticalConstants;
pub use library::Library;
#[cfg(feature = "library")]
pub use manifest::ManifestFiles;
pub use provenance::{Basis, Provenance};
pub use table::{Fault, Table, ascending};
pub use write::{Summary, WARNING};

use crate::error::{Error, Result, check};
use crate::spectrum::same;
use dielectric::Dielectric;
use model::{Model, inside};
use std::sync::Arc;

/// By how much rounding may take a computed emissivity out of [0, 1].
const ROUNDING: f64 = 1e-9;

crate::base::named::named! {
    /// What to assume outside the range in which a material is known.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Extrapolation {
        /// The emissivity at the end of the range.
        Hold = "hold",
        /// The straight line through the spectrum at the end and at its last row before the end (1 cm⁻¹
        /// before, if it has no rows).
        Linear = "linear",
    }
    /// The name in scenario files and manifests.
    name
}

/// A surface with a spectral emissivity and where that is known from.
///
/// ```
/// use hadar::material::Library;
/// let library = Library::embedded()?;
/// let gold = library.get("gold")?;
/// let emissivity = gold.emissivity(&[800.0, 1000.0])?;
/// assert!(emissivity.iter().all(|e| (0.009..0.010).contains(e)));
/// println!("{}: {}", gold.name(), gold.provenance().source);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    name: String,
    provenance: Provenance,
    model: Arc<Model>,
    extrapolation: Option<Extrapolation>,
    warnings: Vec<String>,
    /// As what the columns of its file were read; empty for what was not read from one.
    read_as: String,
    /// The number of the measured sample, in kebab-case; empty where none is known.
    sample: String,
}

impl Material {
    /// A grey body: the same emissivity at every wavenumber.
    ///
    /// # Errors
    /// An emissivity outside [0, 1].
    pub fn constant(name: impl Into<String>, emissivity: f64) -> Result<Self> {
        let provenance = Provenance::given(Basis::Constant, "one emissivity for all wavenumbers");
        Ok(Self::of(name.into(), provenance, Model::constant(emissivity)?))
    }

    /// A spectrum given by rows of (wavenumber in cm⁻¹, emissivity), in any order.
    ///
    /// # Errors
    /// Fewer than two rows, a wavenumber that is not above 0 or is there twice, an emissivity outside [0, 1].
    ///
    /// ```
    /// use hadar::material::Material;
    /// let paint = Material::from_table("my-paint", &[(700.0, 0.9), (1300.0, 0.8)])?;
    /// assert!((paint.emissivity(&[1000.0])?[0] - 0.85).abs() < 1e-15);
    /// assert!(paint.emissivity(&[1400.0]).is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn from_table(name: impl Into<String>, rows: &[(f64, f64)]) -> Result<Self> {
        for &(_, emissivity) in rows {
            check::unit_interval("emissivity", emissivity)?;
        }
        let rows: Vec<(f64, [f64; 1])> = rows.iter().map(|&(x, e)| (x, [e])).collect();
        let provenance = Provenance::given(Basis::UserFile, "rows given by the user");
        Ok(Self::of(name.into(), provenance, Model::Table(Table::new(&rows)?)))
    }

    pub(in crate::physics::material) fn of(name: String, provenance: Provenance, model: Model) -> Self {
        let (read_as, sample) = (String::new(), String::new());
        Self {
            name,
            provenance,
            model: Arc::new(model),
            extrapolation: None,
            warnings: Vec::new(),
            read_as,
            sample,
        }
    }

    /// The surface of a table of emissivities. One outside [0, 1] is an error where it is used.
    #[must_use]
    pub fn of_table(name: String, provenance: Provenance, table: Table<1>) -> Self {
        Self::of(name, provenance, Model::Table(table))
    }

    /// The smooth opaque half-space of these optical constants.
    #[must_use]
    pub fn of_constants(name: String, provenance: Provenance, constants: OpticalConstants) -> Self {
        Self::of(name, provenance, Model::HalfSpace(Dielectric::Constants(constants)))
    }

    /// Says as what its file was read.
    #[must_use]
    pub fn reading(mut self, read_as: impl Into<String>) -> Self {
        self.read_as = read_as.into();
        self
    }

    /// As what the columns of its file were read; empty for what was not read from one.
    #[must_use]
    pub fn read_as(&self) -> &str {
        &self.read_as
    }

    /// The number of the measured sample, in kebab-case; empty where none is known.
    #[must_use]
    pub fn sample(&self) -> &str {
        &self.sample
    }

    /// Says of which sample it is.
    #[must_use]
    pub fn of_sample(mut self, sample: String) -> Self {
        self.sample = sample;
        self
    }

    /// Adds what a user should know.
    #[must_use]
    pub fn warn(mut self, warnings: impl IntoIterator<Item = String>) -> Self {
        for warning in warnings {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
        self
    }

    /// The same material, known outside its range by the rule given.
    #[must_use]
    pub fn with_extrapolation(mut self, extrapolation: Extrapolation) -> Self {
        self.extrapolation = Some(extrapolation);
        self
    }

    /// The same material under another name.
    #[must_use]
    pub fn with_name(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Name, in kebab-case.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it is and how it is known.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// Wavenumbers in cm⁻¹ between which the emissivity is known without extrapolation; `None` is everywhere.
    #[must_use]
    pub fn range_cm1(&self) -> Option<(f64, f64)> {
        self.model.range()
    }

    /// What a reader noticed and a user should know.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Number of rows of the tables it is computed from; 0 for a formula.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.model.rows()
    }

    /// Emissivities at wavenumbers in cm⁻¹, in any order.
    ///
    /// # Errors
    /// A wavenumber that is not above 0 or lies outside the range ([`Error::OutsideSpectrum`]); an
    /// emissivity, row or extrapolation outside [0, 1].
    pub fn emissivity(&self, wavenumbers_cm1: &[f64]) -> Result<Vec<f64>> {
        let range = self.model.range();
        wavenumbers_cm1.iter().map(|&wavenumber| self.at(range, wavenumber)).collect()
    }

    fn at(&self, range: model::Range, wavenumber_cm1: f64) -> Result<f64> {
        check::positive("wavenumber", wavenumber_cm1, "cm^-1")?;
        let (Some((low, high)), false) = (range, inside(range, wavenumber_cm1)) else {
            return self.computed(wavenumber_cm1);
        };
        let end = if wavenumber_cm1 < low { low } else { high };
        match self.extrapolation {
            None => Err(Error::OutsideSpectrum {
                name: self.name.clone(),
                known_min: low,
                known_max: high,
                needed: wavenumber_cm1,
            }),
            Some(Extrapolation::Hold) => self.computed(end),
            Some(Extrapolation::Linear) => {
                let before = self.last_row_before(end, (low, high));
                let (at_end, at_before) = (self.computed(end)?, self.computed(before)?);
                let slope = (at_end - at_before) / (end - before);
                self.checked(wavenumber_cm1, at_end + slope * (wavenumber_cm1 - end))
            }
        }
    }

    /// The row next to an end of the range, or 1 cm⁻¹ (at most the whole range) inside.
    fn last_row_before(&self, end_cm1: f64, (low, high): (f64, f64)) -> f64 {
        let rows = self.breakpoints_cm1(low, high);
        let step = (high - low).min(1.0);
        if end_cm1 == low {
            rows.first().copied().unwrap_or(low + step)
        } else {
            rows.last().copied().unwrap_or(high - step)
        }
    }

    fn computed(&self, wavenumber_cm1: f64) -> Result<f64> {
        let emissivity = self
            .model
            .emissivity(wavenumber_cm1)
            .map_err(|error| error.for_key(format!("material `{}`", self.name)))?;
        self.checked(wavenumber_cm1, emissivity)
    }

    fn checked(&self, wavenumber_cm1: f64, emissivity: f64) -> Result<f64> {
        if (-ROUNDING..=1.0 + ROUNDING).contains(&emissivity) {
            return Ok(emissivity.clamp(0.0, 1.0));
        }
        let quantity = format!("emissivity of `{}` at {wavenumber_cm1} cm^-1", self.name);
        Err(Error::out_of_range(quantity, emissivity, "", "between 0 and 1"))
    }

    /// Wavenumbers strictly between `low_cm1` and `high_cm1` at which the spectrum may have a kink, ascending:
    /// the rows of its tables, and the ends of its range. Between them it is smooth.
    #[must_use]
    pub fn breakpoints_cm1(&self, low_cm1: f64, high_cm1: f64) -> Vec<f64> {
        let mut kinks = Vec::new();
        let mut keep = |wavenumber: f64| {
            if low_cm1 < wavenumber && wavenumber < high_cm1 {
                kinks.push(wavenumber);
            }
        };
        self.model.each_table(&mut |rows| rows.iter().copied().for_each(&mut keep));
        if let Some((low, high)) = self.range_cm1() {
            keep(low);
            keep(high);
        }
        kinks.sort_by(f64::total_cmp);
        kinks.dedup_by(|a, b| same(*a, *b));
        kinks
    }
}

#[cfg(test)]
mod tests;
