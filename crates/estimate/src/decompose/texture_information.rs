//! What the pixels of a heat cube, and what is made of them, tell of the place of what they show.
//!
//! Of one pixel, with whitened derivatives u_w = ∂_x N_w/√(N_w + σ_w²) of the expected counts along x (pixel⁻¹), J in pixel⁻²:
//!
//! * heat cube, all bands: J = u·u (S37, S38);
//! * a reading y that follows the counts by the row g of whitened counts: J = (g·u)²/(g·g): S37 with the noise that the reading has;
//! * temperature and lighting together: J = |Qᵀu|², Q the orthonormal columns of the fit ([`super::tangent`]).
//!
//! All are below the cube's (Cauchy–Schwarz): what is computed from counts tells nothing that they do not. Readings are the thermal
//! image ΣN/κ, the temperature, the texture X = Σₖ Vₖ Sₖ, and the distilled texture of [`super::distil`]. J of a window is the sum over its
//! pixels.
//!
//! Assumptions: the material is known; the rows are those of the linear model at the state in `maps`, also where a limit holds it.
//!
//! Source: paper S37–S40; Kay, 'Fundamentals of Statistical Signal Processing' (1993), chapter 3.

use super::distil::{Distilled, each_pixel, fits, fused, over_rows};
use super::maps::Maps;
use super::setting::Setting;
use super::tangent::{Tangent, Tangents, dot};
use hadar::cube::Cube;
use hadar::error::{Error, Result};

/// J of every pixel, `[row][column]`, pixel⁻². A first and a last column have none, nor has a reading where it is unknown: 0.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct TextureInformation {
    /// All bands.
    pub cube: Vec<f64>,
    /// Their sum.
    pub thermal: Vec<f64>,
    /// Temperature and lighting together.
    pub together: Vec<f64>,
    /// Temperature.
    pub temperature: Vec<f64>,
    /// X.
    pub texture: Vec<f64>,
    /// X̄ with its share of the residue.
    pub distilled: Vec<f64>,
}

/// Information of a cube of expected counts, in the state of `maps`, and of its distilled texture.
///
/// # Errors
/// As [`super::distil()`]; a cube of fewer than three columns.
pub fn texture_information(
    setting: &Setting<'_>,
    maps: &Maps,
    expected: &Cube,
    distilled: &Distilled,
) -> Result<TextureInformation> {
    let tangents = Tangents::new(setting)?;
    let shape = expected.shape();
    fits(setting, maps, expected)?;
    if shape.columns() < 3 {
        let found = format!("a cube of {} columns", shape.columns());
        return Err(Error::malformed(found, "give at least 3: differences along x take two neighbours"));
    }
    for (what, found, wanted) in [
        ("pixels of the distilled texture", distilled.texture.len(), maps.material.len()),
        ("materials of the distilled texture", distilled.var_light.len(), setting.library.len()),
        ("surroundings of the distilled texture", distilled.of_sky.len(), setting.surroundings.len()),
    ] {
        if found != wanted {
            return Err(Error::Length { what: what.into(), found, expected: wanted });
        }
    }
    let rows = over_rows(expected, &|row, counts| {
        let (bands, columns) = (setting.bands.len(), shape.columns());
        let mut found = Vec::with_capacity(columns);
        each_pixel(&tangents, maps, (row, counts, setting), &mut |i, pixel| {
            let column = i % columns;
            if column == 0 || column + 1 == columns {
                found.push([0.0; 6]);
                return;
            }
            let at = |column: usize, band: usize| counts[column * bands + band] / setting.units_per_count;
            let slope: Vec<f64> =
                tangents.used.iter().map(|w| 0.5 * (at(column + 1, *w) - at(column - 1, *w))).collect();
            let var = |band: &usize| {
                at(column, *band).max(0.0) + setting.var_added.get(*band).copied().unwrap_or(0.0)
            };
            let sigma: Vec<f64> = tangents.used.iter().map(|w| var(w).sqrt()).collect();
            let u: Vec<f64> =
                slope.iter().zip(&sigma).map(|(d, s)| if *s > 0.0 { d / s } else { 0.0 }).collect();
            let sum: Vec<f64> = sigma.iter().zip(&tangents.counts_per_radiance).map(|(s, k)| s / k).collect();
            let [cube, thermal] = [dot(&u, &u), of_row(&sum, &u)];
            let rest =
                pixel.map_or([0.0; 4], |(m, _, tangent, _)| of_fit(&tangents, (m, tangent), distilled, &u));
            found.push([cube, thermal, rest[0], rest[1], rest[2], rest[3]]);
        });
        found
    })?;
    let all = rows.concat();
    let part = |i: usize| all.iter().map(|pixel| pixel[i]).collect();
    Ok(TextureInformation {
        cube: part(0),
        thermal: part(1),
        together: part(2),
        temperature: part(3),
        texture: part(4),
        distilled: part(5),
    })
}

/// Information of a reading.
fn of_row(g: &[f64], u: &[f64]) -> f64 {
    let (along, square) = (dot(g, u), dot(g, g));
    if square > 0.0 { along * along / square } else { 0.0 }
}

/// Together, temperature, texture, distilled texture.
fn of_fit(
    tangents: &Tangents,
    (m, tangent): (usize, &Tangent),
    distilled: &Distilled,
    u: &[f64],
) -> [f64; 4] {
    let together = tangent.q.iter().map(|q| dot(q, u)).map(|along| along * along).sum();
    let sums = |of: &[Vec<f64>]| of.iter().map(|s| s.iter().sum()).collect::<Vec<f64>>();
    let of = |l: Vec<f64>| tangent.row(&l);
    let temperature = of(tangents.of_temperature()).map_or(0.0, |g| of_row(&g, u));
    let texture = of(tangents.of_lighting(&sums(&tangents.lights))).map_or(0.0, |g| of_row(&g, u));
    let distilled = of(tangents.of_lighting(&sums(&distilled.of_sky))).map_or(0.0, |mut g| {
        let added = fused(tangents, (m, tangent), &distilled.var_light[m]);
        g.iter_mut().zip(added).for_each(|(g, more)| *g += more);
        of_row(&g, u)
    });
    [together, temperature, texture, distilled]
}
