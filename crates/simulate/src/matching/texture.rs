//! Views of a plane at one depth whose counts are a sum of waves, so that their shift is exact.
//!
//! N_b(x, y) = M_b [1 + Σ_k a cos(2π(u_k x + v_k y) + φ_k)], u and v uniform in ± cutoff (cycles per pixel), φ
//! uniform, a = c√(2/K): the root mean square contrast is c. As sampled values: what the pixel's size does to
//! a wave is in its amplitude. A view at disparity d is N(x + d, y), d = 0 the left one.

use crate::draws::generator;
use hadar::cube::Shape;
use hadar::error::{Error, Result, check};
use rand::RngExt;
use std::f64::consts::TAU;

/// A texture.
///
/// ```
/// use hadar::cube::Shape;
/// use hadar_simulate::matching::texture::Texture;
/// let texture = Texture::random(1, &[1e6], 0.1, 0.25, 40)?;
/// let (left, right) = (texture.view(Shape::new(5, 9, 1)?, 0.0)?, texture.view(Shape::new(5, 9, 1)?, 2.0)?);
/// assert!((left[4] - right[2]).abs() < 1e-6);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    means: Vec<f64>,
    amplitude: f64,
    /// u, v, φ.
    waves: Vec<[f64; 3]>,
}

impl Texture {
    /// `waves` random waves of up to `cutoff` cycles per pixel, root mean square `contrast`, about the mean
    /// counts of each band.
    ///
    /// # Errors
    /// Means that are negative or not finite; no waves; a cutoff outside (0, 0.5]; a contrast that is not
    /// positive, or so high that counts could be negative.
    pub fn random(seed: u64, means: &[f64], contrast: f64, cutoff: f64, waves: usize) -> Result<Self> {
        means.iter().try_for_each(|&mean| check::non_negative("mean counts", mean, "counts").map(drop))?;
        if !(cutoff > 0.0 && cutoff <= 0.5) {
            return Err(Error::out_of_range(
                "cutoff of a texture",
                cutoff,
                "cycles/pixel",
                "above 0, at most 0.5",
            ));
        }
        let most = (0.5 / waves.max(1) as f64).sqrt();
        if waves == 0 || !(contrast > 0.0 && contrast <= most) {
            let expected = format!("above 0 and at most 1/sqrt(2 waves), {most:.3}");
            return Err(Error::out_of_range("contrast of a texture", contrast, "", expected));
        }
        let mut rng = generator(seed, 0);
        let mut uniform = |reach: f64| reach * (2.0 * rng.random::<f64>() - 1.0);
        let waves: Vec<[f64; 3]> = (0..waves).map(|_| [cutoff, cutoff, 0.5].map(&mut uniform)).collect();
        let amplitude = contrast * (2.0 / waves.len() as f64).sqrt();
        Ok(Self { means: means.to_vec(), amplitude, waves })
    }

    /// Expected counts `[row][column][band]` of the view at `disparity` pixels.
    ///
    /// # Errors
    /// A shape of another number of bands; a disparity that is not finite.
    pub fn view(&self, shape: Shape, disparity: f64) -> Result<Vec<f64>> {
        self.sample(shape, disparity, |phase, _| libm::cos(phase), 1.0)
    }

    /// ∂N/∂x of it, counts per pixel.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn derivative(&self, shape: Shape, disparity: f64) -> Result<Vec<f64>> {
        self.sample(shape, disparity, |phase, u| -TAU * u * libm::sin(phase), 0.0)
    }

    fn sample(
        &self,
        shape: Shape,
        disparity: f64,
        of: impl Fn(f64, f64) -> f64,
        constant: f64,
    ) -> Result<Vec<f64>> {
        check::finite("disparity", disparity, "pixels")?;
        if shape.bands() != self.means.len() {
            let (found, expected) = (self.means.len(), shape.bands());
            return Err(Error::Length {
                what: "mean counts of a texture, one per band".into(),
                found,
                expected,
            });
        }
        let mut view = Vec::with_capacity(shape.len());
        for row in 0..shape.rows() {
            for column in 0..shape.columns() {
                let (x, y) = (column as f64 + disparity, row as f64);
                let waves = self.waves.iter();
                let sum: f64 = waves.map(|[u, v, phase]| of(TAU * (u * x + v * y + phase), *u)).sum::<f64>();
                view.extend(self.means.iter().map(|mean| mean * (constant + self.amplitude * sum)));
            }
        }
        Ok(view)
    }
}
