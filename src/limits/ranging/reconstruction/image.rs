//! Whole pictures: what every pixel tells of position once its own emission has been estimated and taken off.
//!
//! In a pixel of counts N_b, of which E_b were emitted, with the derivative ∂N_b along x (pixel⁻¹) and variance N_b + σ_b²:
//!
//! * temperature estimated: ‖P⊥ ∂N‖², P⊥ removing the span of ∂E/∂T; emissivity known in every pixel;
//! * temperature and strength estimated: P⊥ removes E itself as well, which is what a texture of emissivity changes;
//!
//! in the inner product of weights 1/(N + σ²), pixel⁻². Neither exceeds Σ(∂N)²/(N + σ²), the heat cube's. Where N changes by
//! lighting alone the first is [`LightingSolver::information`](super::LightingSolver::information). Where emitted
//! and scattered light have one spectrum (a grey surface as warm as what lights it) the second is 0: no processing
//! separates them.
//!
//! Assumptions: pixels are taken one by one; ∂E/∂T of a mixed pixel is that of the temperature at its centre.
//!
//! Source: as the module's.

use crate::cube::Shape;
use crate::error::{Error, Result};
use crate::fisher::Projector;
use crate::parallel;
use crate::planck;
use crate::ranging::derivative::{Derivative, Differentiator};
use crate::ranging::information::InformationMap;
use crate::scene::Columns;
use rayon::prelude::*;

/// Rows that share the room of one thread at the least.
const ROWS: usize = 4;

/// A picture with its emission known apart, as a renderer has it.
#[derive(Debug, Clone, Copy)]
pub struct EmissionImage<'a> {
    /// Rows, columns and bands.
    pub shape: Shape,
    /// Expected counts N, `[row][column][band]`.
    pub counts: &'a [f64],
    /// What of them was emitted, E.
    pub emission: &'a [f64],
    /// What of them was scattered, R = N − E, with its own digits.
    pub scattered: &'a [f64],
    /// Temperature at the pixels' centres, K, `[row][column]`.
    pub temperature_k: &'a [f64],
    /// Centres of the bands, cm⁻¹.
    pub wavenumbers_cm1: &'a [f64],
    /// Electronic noise σ² of each band, counts².
    pub var_added: &'a [f64],
}

/// Information of every pixel, pixel⁻², `[row][column]` without the derivative's margins.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BesideEmission {
    columns: usize,
    margin: usize,
    /// Temperature estimated.
    pub temperature: Vec<f64>,
    /// Temperature and strength of the emission estimated.
    pub strength_too: Vec<f64>,
    /// The scattered signal as if it were measured, Σ(∂R)²/(R + σ²); NaN where a sample is 0 and has no noise, since its quotient
    /// has no value: such samples of a cube are refused by [`information`](crate::ranging::information::information).
    pub scattered_alone: Vec<f64>,
    /// Scattered counts ΣR.
    pub scattered_counts: Vec<f64>,
}

impl EmissionImage<'_> {
    /// What every pixel tells beside its emission.
    ///
    /// # Errors
    /// Lists that do not fit the shape.
    ///
    /// ```
    /// use hadar::planck::photon_radiance;
    /// use hadar::cube::Shape;
    /// use hadar::ranging::{derivative::Derivative, reconstruction::EmissionImage};
    /// // A grey road at 290 K under a sky of 250 K, its emissivity rising along x.
    /// let bands = [800.0, 900.0, 1000.0, 1100.0];
    /// let pixel = |x: usize| (0.8 + 0.01 * x as f64, bands.map(|nu| [photon_radiance(nu, 290.0), photon_radiance(nu, 250.0)]));
    /// let emission: Vec<f64> = (0..5).flat_map(|x| pixel(x).1.map(|[own, _]| pixel(x).0 * own)).collect();
    /// let counts: Vec<f64> =
    ///     (0..5).flat_map(|x| pixel(x).1.map(|[own, sky]| pixel(x).0 * own + (1.0 - pixel(x).0) * sky)).collect();
    /// let scattered: Vec<f64> = counts.iter().zip(&emission).map(|(n, e)| n - e).collect();
    /// let image = EmissionImage {
    ///     shape: Shape::new(1, 5, 4)?,
    ///     counts: &counts,
    ///     emission: &emission,
    ///     scattered: &scattered,
    ///     temperature_k: &[290.0; 5],
    ///     wavenumbers_cm1: &bands,
    ///     var_added: &[0.0; 4],
    /// };
    /// let found = image.beside_emission(Derivative::Central)?;
    /// assert!(found.strength_too[0] < found.temperature[0]);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn beside_emission(&self, derivative: Derivative) -> Result<BesideEmission> {
        let Self { shape, counts, emission, .. } = *self;
        let (bands, row_len, width) = (shape.bands(), shape.row_len(), shape.columns());
        let fits = |what: &str, found: usize, expected: usize| match found == expected {
            true => Ok(()),
            false => Err(Error::Length { what: what.to_owned(), found, expected }),
        };
        fits("counts", counts.len(), shape.len())?;
        fits("emitted counts", emission.len(), shape.len())?;
        fits("scattered counts", self.scattered.len(), shape.len())?;
        fits("temperatures", self.temperature_k.len(), shape.rows() * width)?;
        fits("bands", self.wavenumbers_cm1.len(), bands)?;
        fits("noise variances", self.var_added.len(), bands)?;
        let margin = derivative.margin();
        let differentiator = Differentiator::new(derivative, width)?;
        let columns = width - 2 * margin;
        let rows: Result<Vec<Vec<[f64; 4]>>> = counts
            .par_chunks(row_len)
            .zip(emission.par_chunks(row_len).zip(self.scattered.par_chunks(row_len)))
            .zip(self.temperature_k.par_chunks(width))
            .with_min_len(ROWS)
            .map_init(
                || Work::new(differentiator.clone(), columns * bands),
                |work, ((counts, (emission, scattered)), temperature_k)| {
                    crate::stop::check();
                    work.differentiator.apply(counts, bands, &mut work.slopes)?;
                    work.differentiator.apply(scattered, bands, &mut work.scattered)?;
                    let pixel = |x: usize| {
                        let own = (x + margin) * bands..(x + margin + 1) * bands;
                        let temperature_k = temperature_k.get(x + margin).copied().unwrap_or(f64::NAN);
                        let [temperature, strength_too] =
                            work.pixel(self, x, &counts[own.clone()], &emission[own.clone()], temperature_k);
                        let slope = &work.scattered[x * bands..(x + 1) * bands];
                        let scattered = &scattered[own];
                        let terms = scattered.iter().zip(self.var_added).zip(slope);
                        let alone =
                            terms.map(
                                |((r, var), slope)| {
                                    if r + var > 0.0 { slope * slope / (r + var) } else { f64::NAN }
                                },
                            );
                        [temperature, strength_too, alone.sum(), scattered.iter().sum()]
                    };
                    Ok((0..columns).map(pixel).collect())
                },
            )
            .collect();
        let all = rows?.concat();
        let [temperature, strength_too, scattered_alone, scattered_counts] =
            [0, 1, 2, 3].map(|i| all.iter().map(|found| found[i]).collect());
        Ok(BesideEmission { columns, margin, temperature, strength_too, scattered_alone, scattered_counts })
    }
}

/// A thread's.
struct Work {
    differentiator: Differentiator,
    projector: Projector,
    slopes: Vec<f64>,
    /// Slopes of the scattered counts.
    scattered: Vec<f64>,
    columns: Vec<f64>,
    weights: Vec<f64>,
    warmth: Vec<f64>,
    /// ∂ln B/∂T of the bands at the temperature of the last pixel.
    per_kelvin: Vec<f64>,
    temperature_k: Option<f64>,
}

impl Work {
    fn pixel(
        &mut self,
        image: &EmissionImage<'_>,
        x: usize,
        counts: &[f64],
        emission: &[f64],
        temperature_k: f64,
    ) -> [f64; 2] {
        let bands = counts.len();
        let noisy = counts.iter().zip(image.var_added);
        self.weights.clear();
        // Where nothing is counted, nothing is told.
        self.weights.extend(noisy.map(|(n, var)| if n + var > 0.0 { 1.0 / (n + var) } else { 0.0 }));
        // Neighbours mostly belong to one surface.
        if self.temperature_k != Some(temperature_k) {
            self.temperature_k = Some(temperature_k);
            let per_kelvin = |nu: &f64| planck::log_derivative(*nu, temperature_k);
            self.per_kelvin = image.wavenumbers_cm1.iter().map(per_kelvin).collect();
        }
        self.warmth.clear();
        self.warmth.extend(emission.iter().zip(&self.per_kelvin).map(|(e, per_kelvin)| e * per_kelvin));
        let slope = &self.slopes[x * bands..(x + 1) * bands];
        self.columns.clear();
        for part in [&self.warmth, emission, slope] {
            self.columns.extend_from_slice(part);
        }
        let columns = Columns { values: &mut self.columns, stride: bands };
        let found = self.projector.reduce(columns, &self.weights, 1.0);
        // What is no more than rounding is imitated by the emission.
        let told =
            |length: f64| if length > found.relative_error * found.residual { length * length } else { 0.0 };
        // By Pythagoras: what is left beside both, and what lies along what the warmth leaves of the emission.
        [told(found.residual.hypot(self.projector.along(1))), told(found.residual)]
    }

    fn new(differentiator: Differentiator, slopes: usize) -> Self {
        Self {
            differentiator,
            projector: Projector::default(),
            slopes: vec![0.0; slopes],
            scattered: vec![0.0; slopes],
            columns: Vec::new(),
            weights: Vec::new(),
            warmth: Vec::new(),
            per_kelvin: Vec::new(),
            temperature_k: None,
        }
    }
}

impl BesideEmission {
    /// Takes in what the rows below tell, of the same picture.
    pub fn append(&mut self, below: &Self) {
        self.temperature.extend_from_slice(&below.temperature);
        self.strength_too.extend_from_slice(&below.strength_too);
        self.scattered_alone.extend_from_slice(&below.scattered_alone);
        self.scattered_counts.extend_from_slice(&below.scattered_counts);
    }

    /// Sums of `values` (one of this picture's) over the windows of a map of the same picture.
    #[must_use]
    pub fn windows(&self, values: &[f64], map: &InformationMap, half: [usize; 2]) -> Vec<f64> {
        let [half_rows, half_columns] = half;
        let row = |row: usize| values.get(row * self.columns..(row + 1) * self.columns).unwrap_or_default();
        let sums: Vec<Vec<f64>> = parallel::map(map.rows.len(), |i| {
            let centre = map.rows.start + i;
            let mut columns = vec![0.0; self.columns];
            for y in centre.saturating_sub(half_rows)..=centre + half_rows {
                columns.iter_mut().zip(row(y)).for_each(|(sum, value)| *sum += value);
            }
            let from = |x: usize| (x - self.margin).saturating_sub(half_columns);
            let window = |x: usize| columns.get(from(x)..=x - self.margin + half_columns);
            map.columns.clone().map(|x| window(x).unwrap_or_default().iter().sum()).collect()
        });
        sums.concat()
    }
}
