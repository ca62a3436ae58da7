//! J of one photon that is counted in square pixels, for every place of the source in its pixel.
//!
//! Lengths are in units of σ (Gaussian) or λF (Airy). Phases are multiples of 1/M of the pitch, so that their mean is
//! the trapezoidal rule of a periodic function.

use super::{PointSpread, Shape, total_photons};
use crate::error::{Error, Result, check};
use crate::parallel;
use libm::erfc;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Widest pixels before an Airy disk, λF.
const WIDEST: f64 = 8.0;
/// How far the lattice reaches, λF: before coarse and fine pixels.
const REACH: [f64; 2] = [16.0, 6.0];
/// Below this pitch (λF) the loss is interpolated to 0 in proportion to the pitch.
const FINEST: f64 = 0.05;
/// Largest part of a pixel over which h is integrated at once, λF; its fringes repeat at 1.
const PART: f64 = 0.125;

/// 1/J of one photon counted in pixels, m², over the place of the source in its pixel (evenly distributed).
///
/// Infinite where pixels are so much wider than the point spread that no photon falls outside the first one.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct PixelBound {
    /// Mean of 1/J: the variance of position averaged over sources that are anywhere.
    pub var_mean_m2: f64,
    /// 1/J where it is least.
    pub var_best_m2: f64,
    /// 1/J where it is largest.
    pub var_worst_m2: f64,
}

impl PointSpread {
    /// What square pixels of pitch `pitch_m` (m) leave.
    ///
    /// Relative error of 1/J at any one place: 1e-12 for a Gaussian, 2e-3 for an Airy disk (some 10 ms; for a pitch below
    /// 0.1 λF or above 2 λF some 100 ms). The mean over the places is as good up to 1.5 λF; beyond, where the centre of the
    /// pixel all but decides it, it is that of 32 × 32 places, and the mean of all differs by 1 % at 3 λF, 5 % at 8 λF.
    ///
    /// # Errors
    /// A pitch that is not positive, or is more than 8 λF before an Airy disk.
    pub fn in_pixels(&self, pitch_m: f64) -> Result<PixelBound> {
        bands_in_pixels(&[(*self, 1.0)], pitch_m)
    }
}

/// 1/J of bands that are counted apart behind square pixels of pitch `pitch_m` (m): at every phase J is the weighted mean over the bands.
///
/// # Errors
/// As [`bands_var_m2`](super::bands_var_m2) and [`PointSpread::in_pixels`].
pub fn bands_in_pixels(bands: &[(PointSpread, f64)], pitch_m: f64) -> Result<PixelBound> {
    check::positive("pixel", pitch_m, "m")?;
    let total = total_photons(bands)?;
    bound(bands, total, pitch_m)
}

/// Mean, best and worst of 1/J over the phases, J the mean over the bands.
fn bound(bands: &[(PointSpread, f64)], total: f64, pitch_m: f64) -> Result<PixelBound> {
    let widths: Vec<f64> = bands.iter().map(|(spread, _)| pitch_m / spread.scale_m).collect();
    let airy = bands.iter().any(|(spread, _)| spread.shape == Shape::Airy);
    let widest = widths.iter().fold(0.0_f64, |widest, w| widest.max(*w));
    let phases = match airy {
        true if widest <= 1.0 => 8,
        true if widest <= 1.5 => 16,
        true => 32,
        // The worst place is a cusp of relative width (σ/p)².
        false => 2 * (4.0 * widest * widest).clamp(4.0, 2048.0) as usize,
    };
    let of_bands: Vec<Vec<f64>> = parallel::try_map(bands.len().min(widths.len()), |i| {
        let ((spread, photons), width) = (&bands[i], &widths[i]);
        let mut information = match spread.shape {
            Shape::Gaussian => gaussian(*width, phases, if airy { phases } else { 1 }),
            Shape::Airy => airy_information(*width, phases)?,
        };
        // Per square metre, times the share of the band.
        let scale = photons / total / spread.scale_m / spread.scale_m;
        information.iter_mut().for_each(|j| *j *= scale);
        Ok(information)
    })?;
    let mut variances = vec![0.0; of_bands.first().map_or(0, Vec::len)];
    for information in &of_bands {
        variances.iter_mut().zip(information).for_each(|(sum, j)| *sum += j);
    }
    variances.iter_mut().for_each(|j| *j = 1.0 / *j);
    Ok(PixelBound {
        var_mean_m2: variances.iter().sum::<f64>() / variances.len() as f64,
        var_best_m2: variances.iter().fold(f64::INFINITY, |best, var| best.min(*var)),
        var_worst_m2: variances.iter().fold(0.0, |worst, var| worst.max(*var)),
    })
}

/// J (σ⁻²) of a Gaussian at `phases` places along x, each repeated for `rows` along y, which do not matter.
pub(super) fn gaussian(pitch: f64, phases: usize, rows: usize) -> Vec<f64> {
    // Pixels finer than this lose p²/12 to better than 1e-12, and would be many.
    let fine = pitch < 1e-3;
    let place = |phase: usize| {
        if fine {
            return 1.0 / (1.0 + pitch * pitch / 12.0);
        }
        // Source at 0, an edge at −phase: that of the pixel it stands in.
        let edge = -pitch * phase as f64 / phases as f64;
        // 38 σ away not even a subnormal number of photons is left.
        let reach = (38.0 / pitch).ceil() as i64;
        (-reach..=reach).map(|i| gaussian_pixel(edge + i as f64 * pitch, pitch)).sum()
    };
    let places: Vec<f64> = (0..phases).map(place).collect();
    (0..rows).flat_map(|_| places.iter().copied()).collect()
}

/// (∂P)²/P of the pixel from `low` to `low + pitch`.
fn gaussian_pixel(low: f64, pitch: f64) -> f64 {
    // On the side where both are small, so that neither difference cancels.
    let [near, far] = if low + 0.5 * pitch >= 0.0 { [low, low + pitch] } else { [-low - pitch, -low] };
    let tail = |x: f64| 0.5 * erfc(FRAC_1_SQRT_2 * x);
    let density = |x: f64| libm::exp(-0.5 * x * x) / (2.0 * PI).sqrt();
    // φ(near) − φ(far) = φ(near)(1 − exp(−(far − near)(far + near)/2)).
    let change = -density(near) * libm::expm1(-0.5 * pitch * (near + far));
    let share = tail(near) - tail(far);
    if share > 0.0 { change * (change / share) } else { 0.0 }
}

/// J ((λF)⁻²) of an Airy disk at `phases` × `phases` places.
fn airy_information(pitch: f64, phases: usize) -> Result<Vec<f64>> {
    if pitch > WIDEST {
        let expected = "at most 8 times the width λF of the Airy disk: finer pixels, or a longer wavelength";
        return Err(Error::out_of_range("pixel over λF", pitch, "", expected));
    }
    let used = pitch.max(FINEST);
    let [coarse, fine] = REACH;
    let reach = if used < 0.25 { fine } else { coarse }.max(6.0 * used);
    let mut information = airy_out_to(used, phases, reach)?;
    if pitch < used {
        information.iter_mut().for_each(|j| *j = PI * PI - (PI * PI - *j) * pitch / used);
    }
    Ok(information)
}

/// From a lattice that reaches to `radius`, and what pixels leave of the rest.
pub(super) fn airy_out_to(pitch: f64, phases: usize, radius: f64) -> Result<Vec<f64>> {
    let [half, whole] = [0.5 * radius, radius].map(beyond);
    let places = lattice(pitch, phases, radius, &airy)?;
    Ok(places
        .iter()
        .map(|[inner, outer]| {
            let left = outer / (PI * PI * (half - whole));
            (inner + outer + left * PI * PI * whole).min(PI * PI)
        })
        .collect())
}

/// h at the squared distance `r2`, (λF)⁻²: (π/4)[2J₁(v)/v]², v = πr.
pub(super) fn airy(r2: f64) -> f64 {
    let v = PI * r2.sqrt();
    let amplitude = if v < 1e-4 { 1.0 - 0.125 * v * v } else { 2.0 * libm::j1(v) / v };
    0.25 * PI * amplitude * amplitude
}

/// Share of J that comes from beyond the distance `r` (λF).
pub(super) fn beyond(r: f64) -> f64 {
    let v = PI * r;
    libm::j0(v).powi(2) + 2.0 * libm::j1(v).powi(2) + libm::jn(2, v).powi(2)
}

/// Σ(∂ₓP)²/P over the pixels whose centre is within half the radius of the source, and over those beyond that up to the
/// radius, for a source of density h(r²) at `phases` × `phases` places in a pixel.
///
/// The source stands at the corner of four parts of pixels; a quadrant of them is integrated once, and every place
/// of the source is another way to join the same parts to pixels.
pub(super) fn lattice(
    pitch: f64,
    phases: usize,
    radius: f64,
    h: &(dyn Fn(f64) -> f64 + Sync),
) -> Result<Vec<[f64; 2]>> {
    let step = (pitch / PART / phases as f64).ceil().max(1.0) as usize;
    let parts = phases * step;
    let size = pitch / parts as f64;
    let n = ((radius + pitch) / size).ceil() as usize;
    let quadrant = Quadrant::new(n, size, h)?;
    // Mirrored places are equal.
    let half = phases / 2;
    let places: Vec<Vec<[f64; 2]>> = parallel::map(half + 1, |ky| {
        let mut found = vec![[0.0; 2]; half + 1];
        let (mut column, mut edge) = (vec![0.0; n], vec![0.0; n + 1]);
        for j0 in starts(n, parts, ky * step) {
            quadrant.join_rows(j0, parts, &mut column, &mut edge);
            let y = (j0 as f64 + 0.5 * parts as f64) * size;
            for (kx, sums) in found.iter_mut().enumerate() {
                for i0 in starts(n, parts, kx * step) {
                    let x = (i0 as f64 + 0.5 * parts as f64) * size;
                    let distance = x.hypot(y);
                    if distance > radius {
                        continue;
                    }
                    let share: f64 = (i0..i0 + parts as isize).map(|i| column[folded(i)]).sum();
                    let ends = [i0, i0 + parts as isize].map(isize::unsigned_abs);
                    let change = edge[ends[0]] - edge[ends[1]];
                    let information = if share > 0.0 { change * (change / share) } else { 0.0 };
                    sums[usize::from(distance > 0.5 * radius)] += information;
                }
            }
        }
        found
    });
    let mirrored = |k: usize| k.min(phases - k);
    Ok((0..phases)
        .flat_map(|ky| (0..phases).map(move |kx| (mirrored(ky), mirrored(kx))))
        .map(|(ky, kx)| places[ky][kx])
        .collect())
}

/// First parts of the pixels of `parts` parts that lie within −n … n, one of them beginning at `offset`.
fn starts(n: usize, parts: usize, offset: usize) -> impl Iterator<Item = isize> {
    let (n, parts, offset) = (n as isize, parts as isize, offset as isize);
    let first = offset - (offset + n) / parts * parts;
    (first..=n - parts).step_by(parts as usize)
}

/// The part that i is the mirror image of.
fn folded(i: isize) -> usize {
    if i < 0 { (-1 - i) as usize } else { i as usize }
}

/// ∬h over the parts of a quadrant, and ∫h dy along their edges of constant x.
struct Quadrant {
    n: usize,
    /// `[row][column]`.
    areas: Vec<f64>,
    /// [row][edge], n + 1 edges.
    edges: Vec<f64>,
}

impl Quadrant {
    fn new(n: usize, size: f64, h: &(dyn Fn(f64) -> f64 + Sync)) -> Result<Self> {
        let order = if size <= 0.25 * PART { 2 } else { 3 };
        let rule = bilby::GaussLegendre::new(order)
            .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))?;
        let rule: Vec<(f64, f64)> = (rule.nodes().iter().zip(rule.weights()))
            .map(|(node, weight)| (0.5 * size * (1.0 + node), 0.5 * size * weight))
            .collect();
        let row = |j: usize| {
            let line = |x: f64| -> f64 {
                let part = |(dy, weight): &(f64, f64)| {
                    let y = j as f64 * size + dy;
                    weight * h(x * x + y * y)
                };
                rule.iter().map(part).sum()
            };
            let area = |i: usize| rule.iter().map(|(dx, weight)| weight * line(i as f64 * size + dx)).sum();
            let areas: Vec<f64> = (0..n).map(area).collect();
            let edges: Vec<f64> = (0..=n).map(|i| line(i as f64 * size)).collect();
            (areas, edges)
        };
        let rows: Vec<(Vec<f64>, Vec<f64>)> = parallel::map(n, row);
        let (areas, edges): (Vec<_>, Vec<_>) = rows.into_iter().unzip();
        Ok(Self { n, areas: areas.concat(), edges: edges.concat() })
    }

    /// Sums over `parts` rows from row `start`.
    fn join_rows(&self, start: isize, parts: usize, column: &mut [f64], edge: &mut [f64]) {
        column.fill(0.0);
        edge.fill(0.0);
        for row in (start..start + parts as isize).map(folded) {
            let (areas, edges) = (&self.areas[row * self.n..], &self.edges[row * (self.n + 1)..]);
            column.iter_mut().zip(areas).for_each(|(sum, area)| *sum += area);
            edge.iter_mut().zip(edges).for_each(|(sum, edge)| *sum += edge);
        }
    }
}
