//! The relative transmittance of a filter wheel over the image, and what is left when a reference is taken off.
//!
//! A uniform blackbody is read in pixel x through filter q as C_kq(x) = η(x) M_kq + O_q(x), M the reading of the centre without its offset,
//! O_q = K_q + (1 − η) D + ξ whatever pattern (S49). With an offset for each pixel and filter, by least squares on the mean m_kq of the
//! pixels about the centre,
//!
//! η(x) = Σ_kq (C_kq(x) − C̄_q(x)) (m_kq − m̄_q)/Q,   Q = Σ_kq (m_kq − m̄_q)²,
//!
//! bars the means over the blackbodies: K, D and ξ drop out exactly, and need no reference of their own. Its noise is σ/√Q in each pixel,
//! and η σ/√(n Q) common to all of them, of the n pixels about the centre. Noise in m makes η too small by a share of
//! (1 − 1/blackbodies) σ² (readings)/(n Q), far below these.
//!
//! The paper has one η for all filters. Whether that holds the readings tell: χ² of what it leaves, C − C̄ − η (m − m̄), over σ². A share by
//! which a filter's own η differs is an error of that filter's radiances that no deviation here holds.
//!
//! [`subtracted`]: (C − C⁰)/η (S51). Units: counts; η 1. Assumptions: noise of one deviation σ for all samples; blackbodies that are
//! uniform; patterns that stay the same.

use hadar::error::{Error, Result, check};
use rayon::prelude::*;

/// η of every pixel, with its errors.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Vignette {
    /// η, row after row.
    pub values: Vec<f64>,
    /// Deviation of each pixel by its own noise.
    pub sigma: f64,
    /// Relative deviation common to all pixels, by that of the centre.
    pub sigma_centre: f64,
    /// χ² of what one η for all filters leaves of the readings, over its degrees of freedom; NaN without any.
    pub chi_square_reduced: f64,
    /// These degrees of freedom.
    pub freedom: usize,
}

/// Pixels of an image about its centre: all within `half` rows and columns.
#[must_use]
pub fn centre([rows, columns]: [usize; 2], half: usize) -> Vec<usize> {
    let about = |count: usize| (count / 2).saturating_sub(half)..(count / 2 + half + 1).min(count);
    about(rows).flat_map(|row| about(columns).map(move |column| row * columns + column)).collect()
}

impl Vignette {
    /// From cubes of uniform blackbodies, `[pixel][filter]` each.
    ///
    /// # Errors
    /// Fewer than two cubes, cubes of different sizes, no pixel about the centre, blackbodies that are all read the same.
    pub fn found(cubes: &[Vec<f64>], filters: usize, centre: &[usize], sigma: f64) -> Result<Self> {
        check::positive("deviation of a sample", sigma, "counts")?;
        let count = cubes.len();
        let (Some(first), true) = (cubes.first(), count > 1 && filters > 0 && !centre.is_empty()) else {
            let found = format!("{count} cubes of blackbodies and {} pixels about the centre", centre.len());
            return Err(Error::malformed(found, "give two cubes or more, and a centre"));
        };
        if let Some(other) = cubes.iter().find(|cube| cube.len() != first.len()) {
            let what = "samples of a blackbody's cube".into();
            return Err(Error::Length { what, found: other.len(), expected: first.len() });
        }
        let pixels = first.len() / filters;
        if let Some(beyond) = centre.iter().find(|pixel| **pixel >= pixels) {
            let found = format!("pixel {beyond} about the centre, of {pixels}");
            return Err(Error::malformed(found, "name pixels of the image"));
        }
        let mut within = vec![false; pixels];
        centre.iter().for_each(|pixel| within[*pixel] = true);
        let inverse = 1.0 / count as f64;
        let mut apart = vec![vec![0.0; filters]; count];
        for (cube, apart) in cubes.iter().zip(&mut apart) {
            for pixel in centre {
                for (q, apart) in apart.iter_mut().enumerate() {
                    *apart += cube[pixel * filters + q] / centre.len() as f64;
                }
            }
        }
        for q in 0..filters {
            let mean = apart.iter().map(|m| m[q]).sum::<f64>() * inverse;
            apart.iter_mut().for_each(|m| m[q] -= mean);
        }
        let square: f64 = apart.iter().flatten().map(|m| m * m).sum();
        check::positive("spread of the blackbodies' readings", square, "counts^2")?;
        // Deviations from a mean add up to 0, so that the pixel's own mean need not be taken off but for rounding.
        let value = |pixel: usize| {
            let start = pixel * filters;
            let mut sum = 0.0;
            for (cube, apart) in cubes.iter().zip(&apart) {
                for q in 0..filters {
                    sum += (cube[start + q] - first[start + q]) * apart[q];
                }
            }
            let eta = sum / square;
            // What is left, each filter about its own mean.
            let left = |q: usize| {
                let off = |(cube, apart): (&Vec<f64>, &Vec<f64>)| {
                    cube[start + q] - first[start + q] - eta * apart[q]
                };
                let offs: Vec<f64> = cubes.iter().zip(&apart).map(off).collect();
                let mean = offs.iter().sum::<f64>() * inverse;
                offs.iter().map(|off| (off - mean).powi(2)).sum::<f64>()
            };
            // Noise of the centre is in what is left too; a pixel of the centre has a part of it in common with its own.
            let common = if within[pixel] { 2.0 * eta } else { 0.0 };
            let var = sigma * sigma * (1.0 + (eta * eta - common) / centre.len() as f64);
            (eta, (0..filters).map(left).sum::<f64>() / var)
        };
        let each: Vec<(f64, f64)> = (0..pixels).into_par_iter().map(value).collect();
        let freedom = pixels * (filters * (count - 1)).saturating_sub(1);
        Ok(Self {
            chi_square_reduced: each.iter().map(|(_, chi)| chi).sum::<f64>() / freedom as f64,
            freedom,
            values: each.into_iter().map(|(eta, _)| eta).collect(),
            sigma: sigma / square.sqrt(),
            sigma_centre: sigma / (square * centre.len() as f64).sqrt(),
        })
    }
}

/// (C − C⁰)/η of every sample, `[pixel][filter]` as the cubes.
///
/// # Errors
/// A reference or an η of another size, an η that is not above 0.
pub fn subtracted(cube: &[f64], reference: &[f64], eta: &[f64], filters: usize) -> Result<Vec<f64>> {
    if reference.len() != cube.len() || filters == 0 || eta.len() * filters != cube.len() {
        let what = "samples of the reference".into();
        return Err(Error::Length { what, found: reference.len(), expected: cube.len() });
    }
    check::each(eta, |eta| eta > 0.0, |eta| check::positive("relative transmittance", eta, ""))?;
    let mut out = vec![0.0; cube.len()];
    out.par_chunks_mut(filters)
        .zip(cube.par_chunks(filters).zip(reference.par_chunks(filters)))
        .zip(eta)
        .for_each(|((out, (scene, reference)), eta)| {
            hadar::stop::check();
            for ((out, scene), reference) in out.iter_mut().zip(scene).zip(reference) {
                *out = (scene - reference) / eta;
            }
        });
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::twin::FilterWheelTwin;
    use hadar::random::generator;

    /// K, D and ξ of any size: the same η, the same differences.
    #[test]
    fn patterns_of_the_camera_drop_out() {
        let mut twin = FilterWheelTwin::prototype().unwrap();
        let size = [9, 11];
        let temperatures = [308.15, 330.0, 360.0];
        let mut rng = generator(5, 0);
        let cubes = |twin: &FilterWheelTwin, rng: &mut _| -> Vec<Vec<f64>> {
            temperatures.iter().map(|t| twin.blackbody_cube(*t, size, 0.0, rng)).collect()
        };
        let with = cubes(&twin, &mut rng);
        (twin.dark, twin.diaphragm) = (0.0, 0.0);
        twin.offsets.iter_mut().for_each(|k| *k = 0.0);
        let without = cubes(&twin, &mut rng);
        let middle = centre(size, 0);
        let eta = Vignette::found(&with, 10, &middle, 1.0).unwrap().values;
        let clean = Vignette::found(&without, 10, &middle, 1.0).unwrap().values;
        for (pixel, (a, b)) in eta.iter().zip(&clean).enumerate() {
            assert!((a - b).abs() < 1e-11 && (a - twin.eta(size, pixel)).abs() < 1e-11, "{pixel} {a} {b}");
        }
        let off = subtracted(&with[2], &with[0], &eta, 10).unwrap();
        let clean = subtracted(&without[2], &without[0], &clean, 10).unwrap();
        assert!(off.iter().zip(&clean).all(|(a, b)| (a - b).abs() < 1e-9 * b.abs().max(1.0)));
        // Every pixel shows the same blackbody.
        assert!(off.chunks(10).all(|pixel| (pixel[4] / off[4] - 1.0).abs() < 1e-9));
        assert!(subtracted(&with[2], &with[0][10..], &eta, 10).is_err());
    }

    /// 99 pixels off the centre, 40 draws: the share within 1.96 σ has a deviation below 0.006 where a draw's pixels share a hundredth
    /// of their error; four of them.
    #[test]
    fn errors_of_the_transmittance_are_as_stated() {
        let twin = FilterWheelTwin::prototype().unwrap();
        let size = [9, 11];
        let (mut held, mut all, mut chi) = (0.0, 0.0, 0.0);
        for draw in 0..40 {
            let mut rng = generator(6, draw);
            let cubes: Vec<Vec<f64>> =
                [308.15, 340.0, 380.0].iter().map(|t| twin.blackbody_cube(*t, size, 0.5, &mut rng)).collect();
            let found = Vignette::found(&cubes, 10, &centre(size, 1), 0.5).unwrap();
            chi += found.chi_square_reduced / 40.0;
            // A filter that transmits half a percent less at each step down.
            let mut other = cubes.clone();
            for cube in &mut other {
                (0..99).for_each(|pixel| cube[pixel * 10 + 4] *= 1.0 - 0.005 * (pixel / 11) as f64);
            }
            let other = Vignette::found(&other, 10, &centre(size, 1), 0.5).unwrap();
            assert!(other.chi_square_reduced > 1.5, "{}", other.chi_square_reduced);
            let about = centre(size, 1);
            let truth = about.iter().map(|p| twin.eta(size, *p)).sum::<f64>() / about.len() as f64;
            for (pixel, eta) in found.values.iter().enumerate().filter(|(p, _)| !about.contains(p)) {
                let sigma = found.sigma.hypot(eta * found.sigma_centre);
                held += f64::from(u8::from((eta - twin.eta(size, pixel) / truth).abs() < 1.96 * sigma));
                all += 1.0;
            }
        }
        assert!((held / all - 0.95_f64).abs() < 0.024, "{}", held / all);
        // 40 draws of 1881 degrees of freedom, and the centre's share of a tenth that 20 readings have in common.
        assert!((chi - 1.0_f64).abs() < 0.02, "{chi}");
    }
}
