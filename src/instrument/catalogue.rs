//! Lenses and filters to choose from, embedded with their sources.
//!
//! A lens is one that a public document names for a camera. Filters are shapes: a trapezoid over wavelength of a centre, a width at half
//! of its peak and a slope, the width of an edge as a share of its wavelength. No seller's catalogue of them was found, so that they are
//! choices, or bands that an instrument of public record has; each says which.

use super::Price;
use crate::error::{Error, Result, check};
use crate::spectrum::FilterCurve;
use std::sync::OnceLock;

/// A lens.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lens {
    /// Name of the lens in the catalogue.
    pub name: String,
    /// Names of cameras that it is sold for, where `*` matches any letters.
    pub cameras: Vec<String>,
    /// f-number: focal length over the diameter of the aperture.
    pub f_number: f64,
    /// Focal length of the lens, m.
    pub focal_length_m: f64,
    /// Price of the lens, in the currency of the list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub price: Option<Price>,
    /// The document that was read.
    pub document: String,
}

/// A filter by its shape.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FilterShape {
    /// Name of the filter in the catalogue.
    pub name: String,
    /// Middle of its edges at half of the peak, µm.
    pub center_um: f64,
    /// From edge to edge, µm.
    pub width_um: f64,
    /// Width of an edge from nothing to the peak, as a share of its wavelength.
    pub slope: f64,
    /// The most that it transmits.
    pub peak: f64,
    /// Price of the filter, in the currency of the list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub price: Option<Price>,
    /// What it is taken from.
    pub document: String,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Lenses {
    lens: Vec<Lens>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Filters {
    filter: Vec<FilterShape>,
}

fn read<T: serde::de::DeserializeOwned>(text: &str, path: &str) -> Result<T> {
    let bad = |error: toml::de::Error| {
        Error::malformed(error.to_string().replace('\n', " "), format!("mend {path}"))
    };
    toml::from_str(text).map_err(bad)
}

/// All lenses.
///
/// # Errors
/// A file that is not valid; a test keeps that from happening.
pub fn lenses() -> Result<&'static [Lens]> {
    static READ: OnceLock<Vec<Lens>> = OnceLock::new();
    if let Some(all) = READ.get() {
        return Ok(all);
    }
    let all: Lenses = read(include_str!("../../cameras/lenses.toml"), "cameras/lenses.toml")?;
    Ok(READ.get_or_init(|| all.lens))
}

/// All shapes of filters.
///
/// # Errors
/// As [`lenses`].
pub fn filters() -> Result<&'static [FilterShape]> {
    static READ: OnceLock<Vec<FilterShape>> = OnceLock::new();
    if let Some(all) = READ.get() {
        return Ok(all);
    }
    let all: Filters = read(include_str!("../../cameras/filters.toml"), "cameras/filters.toml")?;
    Ok(READ.get_or_init(|| all.filter))
}

/// The shape of that name.
///
/// # Errors
/// [`Error::UnknownName`] with the nearest names.
pub fn filter(name: &str) -> Result<&'static FilterShape> {
    let all = filters()?;
    let found = all.iter().find(|filter| filter.name == name);
    found.ok_or_else(|| Error::unknown_name("filter", name, all.iter().map(|filter| filter.name.as_str())))
}

impl FilterShape {
    /// Edges at half of the peak, µm.
    #[must_use]
    pub fn edges_um(&self) -> [f64; 2] {
        [-0.5, 0.5].map(|half| self.center_um + half * self.width_um)
    }

    /// Its transmittance.
    ///
    /// ```
    /// use hadar::instrument::catalogue;
    /// for filter in catalogue::filters()? {
    ///     let curve = filter.curve()?;
    ///     assert!((curve.transmittance(1e4 / filter.center_um) / filter.peak - 1.0).abs() < 1e-9);
    /// }
    /// # Ok::<(), hadar::Error>(())
    /// ```
    ///
    /// # Errors
    /// Figures that make no filter.
    pub fn curve(&self) -> Result<FilterCurve> {
        let [short, long] = self.edges_um();
        let quantity = |what: &str| format!("{what} of filter `{}`", self.name);
        check::positive(&quantity("short edge"), short, "um")?;
        check::positive(&quantity("width"), self.width_um, "um")?;
        check::unit_interval(&quantity("peak"), self.peak)?;
        check::positive(&quantity("slope"), self.slope, "")?;
        if 0.5 * self.slope * (short + long) >= self.width_um {
            let most = format!("below {}, where its edges meet", 2.0 * self.width_um / (short + long));
            return Err(Error::out_of_range(quantity("slope"), self.slope, "", most));
        }
        let half = 0.5 * self.slope;
        let rows = [
            (short * (1.0 - half), 0.0),
            (short * (1.0 + half), self.peak),
            (long * (1.0 - half), self.peak),
            (long * (1.0 + half), 0.0),
        ];
        FilterCurve::new(self.name.clone(), rows.map(|(um, share)| (1e4 / um, share)).to_vec())
    }
}

/// Whether a name is of a pattern, in which `*` stands for any letters.
///
/// ```
/// use hadar::instrument::catalogue::is_like;
/// assert!(is_like("flir-boson-640-14mm", "flir-*640*") && is_like("a", "*") && !is_like("ab", "a"));
/// ```
#[must_use]
pub fn is_like(name: &str, pattern: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else { return name == pattern };
    let Some(left) = name.strip_prefix(start) else { return false };
    (0..=left.len()).filter(|at| left.is_char_boundary(*at)).any(|at| is_like(&left[at..], rest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::presets;

    #[test]
    fn every_entry_has_a_source_a_name_of_its_own_and_makes_a_part() {
        let names = |all: Vec<&String>| {
            let mut once = all.clone();
            once.sort();
            once.dedup();
            assert_eq!(once.len(), all.len());
        };
        names(lenses().unwrap().iter().map(|lens| &lens.name).collect());
        names(filters().unwrap().iter().map(|filter| &filter.name).collect());
        for lens in lenses().unwrap() {
            assert!(
                lens.document.len() > 10 && lens.f_number > 0.3 && lens.focal_length_m > 1e-4,
                "{lens:?}"
            );
            for pattern in &lens.cameras {
                let is_known = presets::all().unwrap().iter().any(|camera| is_like(&camera.name, pattern));
                assert!(is_known, "{pattern} of {}", lens.name);
            }
        }
        for filter in filters().unwrap() {
            assert!(filter.document.len() > 10);
            // ∫T dλ of a trapezoid is its peak times its width, and of its curve over ν the same within the bend of 1/ν.
            let curve = filter.curve().unwrap();
            let [short, long] = filter.edges_um();
            let steps = 20_000;
            let (from, to) = (0.9 * short, 1.1 * long);
            let step = (to - from) / f64::from(steps);
            let sum: f64 =
                (0..steps).map(|i| curve.transmittance(1e4 / (from + (f64::from(i) + 0.5) * step))).sum();
            assert!((sum * step / (filter.peak * filter.width_um) - 1.0).abs() < 3e-3, "{}", filter.name);
        }
    }

    #[test]
    fn shapes_that_are_none_are_refused() {
        let shape = filters().unwrap()[0].clone();
        for bad in [
            FilterShape { width_um: 0.0, ..shape.clone() },
            FilterShape { slope: 0.0, ..shape.clone() },
            FilterShape { slope: 1.0, ..shape.clone() },
            FilterShape { peak: 1.1, ..shape.clone() },
            FilterShape { center_um: f64::NAN, ..shape },
        ] {
            assert!(bad.curve().is_err(), "{bad:?}");
        }
    }
}
