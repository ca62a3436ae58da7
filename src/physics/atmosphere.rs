//! The air between target and camera: what it absorbs of the target's radiance and what it adds of its own.
//!
//! * radiance at the camera: τ L + (1 − τ) B(T_air), L that of the target, B photon radiance of a blackbody;
//! * τ(ν, z) = e⁻ᴰ from a table of transmittances at a few lengths z (m) of the path; D optical depth;
//! * along z, ln D is a monotone cubic of ln z (`growth.rs`); along ν (cm⁻¹), D is linear between rows.
//!
//! The embedded tables are LOWTRAN 7's: 700 to 1350 cm⁻¹ in steps of 5, z = 10, 30, 100 … 10⁴ m, five decimals.
//! How well the steps in length are bridged was measured by leaving out one column at a time, which makes the gap
//! twice as wide in ln z as it is: τ is then off by at most 0.0040 (rms 0.0001 to 0.0008, by column); with ln D linear
//! in ln z by at most 0.0124 (rms 0.001 to 0.006), with Beer's law by 0.054 (0.01 to 0.02). Below 10 m the slope at
//! 10 m continues (0.54 to 0.75; Beer's would be 1), an extrapolation: leaving out the 10 m column it errs by up to
//! 0.0027. With every second row left out τ is off by up to 0.021 (rms 0.004).
//!
//! Assumptions: a horizontal path at sea level through homogeneous air of one temperature; no aerosol, fog or
//! rain; the air scatters nothing and is in local equilibrium, so that it emits what it absorbs (Kirchhoff). The
//! tables are means over bands 20 cm⁻¹ wide. Within such a band there are lines and windows: Beer's law does not
//! hold (two paths of z do not make one of 2z), and the product of τ with another spectrum as fine as the lines
//! (what the same gases emit: a sky that is mirrored in the target) is not the mean of the product.
//!
//! Source: LOWTRAN 7 (Kneizys et al., AFGL-TR-88-0177 (1988)), `spectra/README.md`.

mod embedded;
mod growth;
mod read;

use self::growth::Position;
use self::read::Table;
use crate::error::{Error, Result, check};
use crate::inputs;
use crate::planck;
use crate::spectrum::same;
use std::path::Path;

/// How far ln z may be off by its rounding and by columns that are hit.
const SNAP: f64 = 3e-12;
/// Share by which a bound of a derivative is raised for its rounding.
const ROUNDING: f64 = 1e-9;

/// Transmittances of the air by wavenumber and length of the path.
///
/// ```
/// use hadar::atmosphere::Atmosphere;
/// let air = Atmosphere::embedded("us-standard")?;
/// let near = air.transmittance(&[1000.0], 30.0)?[0];
/// let far = air.transmittance(&[1000.0], 3000.0)?[0];
/// assert!(1.0 > near && near > far && far > 0.0);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Atmosphere {
    name: String,
    temperature_k: Option<f64>,
    table: Table,
}

impl Atmosphere {
    /// A model atmosphere of LOWTRAN 7, one of [`Atmosphere::names`].
    ///
    /// # Errors
    /// An unknown name, with the nearest known ones.
    pub fn embedded(name: &str) -> Result<Self> {
        let table = embedded::TABLES
            .iter()
            .find(|table| table.name == name)
            .ok_or_else(|| Error::unknown_name("model atmosphere", name, embedded::NAMES.iter().copied()))?;
        inputs::built_in("air", table.name, || table.text.as_bytes().into());
        Ok(Self {
            name: table.name.to_owned(),
            temperature_k: Some(table.temperature_k),
            table: read::table(table.text)?,
        })
    }

    /// The names of the embedded model atmospheres.
    #[must_use]
    pub const fn names() -> &'static [&'static str] {
        embedded::NAMES
    }

    /// A table from CSV text: a column `wavenumber_cm1`, then transmittances in columns `tau_<length>km` or
    /// `tau_<length>m`, at least two lengths, rows and columns in any order. `path` names it, and is named in messages.
    ///
    /// ```
    /// use hadar::atmosphere::Atmosphere;
    /// let text = "wavenumber_cm1,tau_10m,tau_1km\n700,0.9,0.2\n1300,0.95,0.4\n";
    /// let air = Atmosphere::from_csv(text, "my path.csv".as_ref())?;
    /// assert_eq!((air.name(), air.range_cm1()), ("my path", (700.0, 1300.0)));
    /// assert_eq!(air.temperature_k(), None);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    ///
    /// # Errors
    /// Columns of other names, fewer than two lengths or rows, the same one twice, a transmittance outside [0, 1] or
    /// one that rises with length; with file, line and column.
    pub fn from_csv(text: &str, path: &Path) -> Result<Self> {
        let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        let table = read::table(text).map_err(|error| error.in_file(path))?;
        Ok(Self { name, temperature_k: None, table })
    }

    /// The name of the model, or of the file without folder and ending.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Temperature of the air, K, where the table is for one.
    #[must_use]
    pub const fn temperature_k(&self) -> Option<f64> {
        self.temperature_k
    }

    /// First and last wavenumber of the table, cm⁻¹.
    #[must_use]
    pub fn range_cm1(&self) -> (f64, f64) {
        let end = |wavenumber: Option<&f64>| wavenumber.copied().unwrap_or(f64::NAN);
        (end(self.table.wavenumbers_cm1.first()), end(self.table.wavenumbers_cm1.last()))
    }

    /// The longest path of the table, m.
    #[must_use]
    pub fn longest_m(&self) -> f64 {
        self.table.lengths.longest_m()
    }

    /// The lengths of the table's columns, m, ascending: between two of them ln D is one cubic of ln z.
    #[must_use]
    pub fn lengths_m(&self) -> &[f64] {
        self.table.lengths.metres()
    }

    /// How far τ may be, at each wavenumber (cm⁻¹, in any order), from the parabola of ln z through its values at the two ends of
    /// a stretch of the path (m) and at their geometric mean.
    ///
    /// With x = ln z that is at most Δx³/(72√3) max|τ‴|, τ‴ = τ(3D′D″ − D′³ − D‴), and, since τ does not rise, 3/2 of what it
    /// falls by. Where a column of the table lies within the stretch no more is said than that.
    ///
    /// # Errors
    /// As [`Atmosphere::optical_depth`].
    ///
    /// ```
    /// use hadar::atmosphere::Atmosphere;
    /// let air = Atmosphere::embedded("us-standard")?;
    /// let at = |share: f64| air.transmittance(&[1000.0], 40.0 * 1.1_f64.powf(share)).map(|tau| tau[0]);
    /// // A quarter of the way the parabola is at 3/8, 3/4 and -1/8 of the three.
    /// let parabola = 0.375 * at(0.0)? + 0.75 * at(0.5)? - 0.125 * at(1.0)?;
    /// let sag = air.sag(&[1000.0], [40.0, 44.0])?[0];
    /// assert!((at(0.25)? - parabola).abs() <= sag && sag < 1e-7);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn sag(&self, nodes_cm1: &[f64], [near_m, far_m]: [f64; 2]) -> Result<Vec<f64>> {
        let [near, far] = [self.transmittance(nodes_cm1, near_m)?, self.transmittance(nodes_cm1, far_m)?];
        let lengths = &self.table.lengths;
        let places = lengths.locate(near_m).zip(lengths.locate(far_m));
        let piece = places.and_then(|(near, far)| lengths.piece(near, far));
        let fall = |j: usize| 1.5 * (near[j] - far[j]).max(0.0) + 4.0 * f64::EPSILON;
        let Some(piece) = piece else { return Ok((0..near.len()).map(fall).collect()) };
        let bends: Vec<[f64; 3]> = self.table.rows.iter().map(|row| row.bend(piece)).collect();
        let along = |order: usize| -> Result<Vec<f64>> {
            let values: Vec<f64> = bends.iter().map(|bend| bend[order]).collect();
            nodes_cm1.iter().map(|&node| self.between(node, &values)).collect()
        };
        let (first, second, third) = (along(0)?, along(1)?, along(2)?);
        let cube = (far_m / near_m).ln().powi(3) / (72.0 * 3f64.sqrt());
        let sag = |j: usize| {
            let slope = first[j];
            let bend = near[j] * (slope.powi(3) + 3.0 * slope * second[j] + third[j]);
            (cube * bend * (1.0 + ROUNDING)).min(fall(j)) + near[j] * slope * SNAP + 4.0 * f64::EPSILON
        };
        Ok((0..near.len()).map(sag).collect())
    }

    /// Transmittance τ at each wavenumber (cm⁻¹, in any order) of a path of `distance_m`; 1 where that is 0. It never
    /// rises with distance.
    ///
    /// # Errors
    /// As [`Atmosphere::optical_depth`].
    pub fn transmittance(&self, nodes_cm1: &[f64], distance_m: f64) -> Result<Vec<f64>> {
        let mut tau = self.optical_depth(nodes_cm1, distance_m)?;
        tau.iter_mut().for_each(|depth| *depth = (-*depth).exp());
        Ok(tau)
    }

    /// Photon radiance (1 − τ)B(T_air) that the path itself sends into the camera, in
    /// photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹. Formed as −expm1(−D)·B, so that a short path keeps its digits.
    ///
    /// # Errors
    /// As [`Atmosphere::optical_depth`]; a temperature that is not above 0.
    pub fn path_radiance(&self, nodes_cm1: &[f64], distance_m: f64, air_k: f64) -> Result<Vec<f64>> {
        check::positive("temperature of the air", air_k, "K")?;
        let depths = self.optical_depth(nodes_cm1, distance_m)?;
        let mut radiance = vec![0.0; nodes_cm1.len()];
        planck::photon_radiance_into(nodes_cm1, air_k, &mut radiance);
        radiance.iter_mut().zip(depths).for_each(|(radiance, depth)| *radiance *= -(-depth).exp_m1());
        Ok(radiance)
    }

    /// Optical depth D = −ln τ at each wavenumber (cm⁻¹, in any order) of a path of `distance_m`.
    ///
    /// # Errors
    /// A distance that is negative, not finite or beyond the longest column; a wavenumber outside the table or in a gap of its rows.
    pub fn optical_depth(&self, nodes_cm1: &[f64], distance_m: f64) -> Result<Vec<f64>> {
        let position = self.position(distance_m)?;
        let depths: Vec<f64> = self.table.rows.iter().map(|row| row.depth(position)).collect();
        nodes_cm1.iter().map(|&node| self.between(node, &depths)).collect()
    }

    /// Optical depth D and its growth ∂D/∂z with the length of the path, m⁻¹, at each wavenumber (cm⁻¹, in any order): that of the cubic
    /// of ln D in ln z, D/z · d ln D/d ln z. At the shortest column it is the growth of longer paths.
    ///
    /// ```
    /// use hadar::atmosphere::Atmosphere;
    /// let air = Atmosphere::embedded("us-standard")?;
    /// let at = |z: f64| air.optical_depth(&[1000.0], z).map(|depth| depth[0]);
    /// let (_, growth) = air.optical_depth_and_growth(&[1000.0], 50.0)?;
    /// assert!(((at(50.01)? - at(49.99)?) / 0.02 / growth[0] - 1.0).abs() < 1e-6);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Atmosphere::optical_depth`]; a distance of 0, where the growth has no value.
    pub fn optical_depth_and_growth(
        &self,
        nodes_cm1: &[f64],
        distance_m: f64,
    ) -> Result<(Vec<f64>, Vec<f64>)> {
        check::positive("distance", distance_m, "m")?;
        let position = self.position(distance_m)?;
        let (mut depths, mut growths) = (Vec::new(), Vec::new());
        for row in &self.table.rows {
            let depth = row.depth(position);
            depths.push(depth);
            growths.push(depth * row.slope(position) / distance_m);
        }
        let between = |values: &[f64]| -> Result<Vec<f64>> {
            nodes_cm1.iter().map(|&node| self.between(node, values)).collect()
        };
        Ok((between(&depths)?, between(&growths)?))
    }

    /// Wavenumbers of the rows, ascending, cm⁻¹.
    #[must_use]
    pub fn wavenumbers_cm1(&self) -> &[f64] {
        &self.table.wavenumbers_cm1
    }

    /// The shortest path of the table, m: below it the growth is extrapolated.
    #[must_use]
    pub fn shortest_m(&self) -> f64 {
        self.lengths_m().first().copied().unwrap_or(0.0)
    }

    fn position(&self, distance_m: f64) -> Result<Position> {
        check::non_negative("distance", distance_m, "m")?;
        self.table.lengths.locate(distance_m).ok_or_else(|| {
            let longest =
                format!("at most {} m, the longest path in the air of `{}`", self.longest_m(), self.name);
            Error::out_of_range("distance", distance_m, "m", longest)
        })
    }

    /// The value at a wavenumber of what has `values` at the rows.
    fn between(&self, node_cm1: f64, values: &[f64]) -> Result<f64> {
        let rows = &self.table.wavenumbers_cm1;
        let next = rows.partition_point(|&row| row < node_cm1);
        let row = |index: usize| Some((*rows.get(index)?, *values.get(index)?));
        let (before, after) = (next.checked_sub(1).and_then(row), row(next));
        let at = [before, after].into_iter().flatten().find(|(row, _)| same(*row, node_cm1));
        self.table.gaps.check(node_cm1)?;
        match (at, before, after) {
            (Some((_, value)), ..) => Ok(value),
            (None, Some((low, from)), Some((high, to))) => {
                let share = (node_cm1 - low) / (high - low);
                Ok(from * (1.0 - share) + to * share)
            }
            _ => {
                let (low, high) = self.range_cm1();
                let expected = format!(
                    "from {low} to {high} cm^-1, where the air of `{}` is known; narrow the bands",
                    self.name
                );
                Err(Error::out_of_range("wavenumber", node_cm1, "cm^-1", expected))
            }
        }
    }
}

#[cfg(test)]
mod tests;
