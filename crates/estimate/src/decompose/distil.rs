//! Texture distilled from a decomposed cube: the light that a surface sees of the sky alone, as by day.
//!
//! With the sky on and all other radiation off, the signal equation is evaluated forward, without emission, until it no longer changes:
//!
//! X̄ᵢ = Σₖ Vᵢₖ S̄ₖ,   S̄_sky = S_sky,   S̄ₖ = mean over the pixels i that show k of (1 − eᵢ) X̄ᵢ
//!
//! (photons s⁻¹ m⁻² sr⁻¹ in each band). Surroundings of which no pixel is known scatter nothing here. The mean makes it one small linear
//! system in each band, S̄ = s + M S̄; each step is one more scattering.
//!
//! What the fit leaves, δ_w = (N_w − N̂_w)/[κ_w (1 − e_w)], is light that the model has no place for, and noise. It is added band by band
//! as far as it is not noise,
//!
//! X̄ = Σ_w [X̄_w + ω_w δ_w],   ω_w = τ_w²/(τ_w² + σ_w²),
//!
//! the mean of the two estimates X̄_w (off by τ_w) and X̄_w + δ_w (off by σ_w, the noise of δ_w) by their inverse variances. τ_w² is the
//! variance that the residues of all pixels of a material have beyond their noise, Σ(δ²/σ² − 1)/Σσ⁻², 0 at least. Without noise
//! the residue is all texture, with much of it none. The paper fuses both by a rule that it does not state; this one is chosen here.
//!
//! All of it follows the counts by one row h (the model is linear there): the deviation has the noise of the counts through h, and τ
//! through h less what should come through. It holds where residues of a band are as often above 0 as below: light of other objects that the model lacks (a car beside the
//! road) is residue too, counts as the sky's, and is not in the deviation.
//!
//! Source: paper, Extended Data Fig. 1b, S44, S45, SIII C.

use super::maps::Maps;
use super::pixel::NO_MATERIAL;
use super::setting::Setting;
use super::tangent::{Tangent, Tangents, dot};
use hadar::cube::{Cube, Rows, Sample};
use hadar::error::{Error, Result};
use hadar::parallel;

/// Most scatterings; what comes later changes nothing unless everything is a mirror.
const SCATTERINGS: usize = 64;
/// Change of the light of one scattering at which they end.
const SETTLED: f64 = 1e-9;

/// Where the light of the surroundings is from.
#[derive(Debug, Clone, Copy)]
pub struct Sky<'a> {
    /// Which of the surroundings is the sky.
    pub place: usize,
    /// Pixels that show each of the surroundings, counted row after row; empty where none is known, and for the sky.
    pub shown_by: &'a [Vec<usize>],
}

/// A distilled texture, `[row][column]`, photons s⁻¹ m⁻² sr⁻¹ over the bands that count; NaN where material or lighting is unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct Distilled {
    /// X̄ with its share of the residue.
    pub texture: Vec<f32>,
    /// Its deviation; NaN where several materials are left ([`Maps::candidates`]).
    pub sigma: Vec<f32>,
    /// X̄ of the model alone.
    pub of_model: Vec<f32>,
    /// X̄ with all of the residue.
    pub with_all_residue: Vec<f32>,
    /// How much of the residue is light, for each material that was found.
    pub residues: Vec<Residue>,
    /// Scatterings until nothing changed.
    pub scatterings: usize,
    /// ω is made of τ², `[material][band]`.
    pub(super) var_light: Vec<Vec<f64>>,
    /// S̄ₖ, `[surroundings][band]`.
    pub(super) of_sky: Vec<Vec<f64>>,
}

/// Residues of one material.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Residue {
    /// Its place in the library.
    pub material: usize,
    /// Number of pixels of the material.
    pub pixels: usize,
    /// Root mean square of what is light in them, τ, over all bands, photons s⁻¹ m⁻² sr⁻¹ in a band.
    pub light: f64,
    /// The same of their noise, σ.
    pub noise: f64,
}

/// Sums over pixels: of δ²/σ², of 1/σ², of pixels; of (1 − e)·V of those that show each of the surroundings.
#[derive(Debug, Clone, Default)]
struct Sums {
    /// `[material]`: pixels, then `[band]` of δ²/σ² and of 1/σ².
    residues: Vec<(usize, Vec<[f64; 2]>)>,
    /// `[surroundings]`: pixels, then `[lighting][band]`.
    scattering: Vec<(usize, Vec<Vec<f64>>)>,
}

impl Sums {
    fn new(tangents: &Tangents) -> Self {
        let (bands, lights) = (tangents.used.len(), tangents.lights.len());
        Self {
            residues: vec![(0, vec![[0.0; 2]; bands]); tangents.materials()],
            scattering: vec![(0, vec![vec![0.0; bands]; lights]); lights],
        }
    }

    fn add(mut self, other: &Self) -> Self {
        for ((n, sums), (more, others)) in self.residues.iter_mut().zip(&other.residues) {
            *n += more;
            let each = sums.iter_mut().flatten().zip(others.iter().flatten());
            each.for_each(|(a, b)| *a += b);
        }
        for ((n, sums), (more, others)) in self.scattering.iter_mut().zip(&other.scattering) {
            *n += more;
            let each = sums.iter_mut().flatten().zip(others.iter().flatten());
            each.for_each(|(a, b)| *a += b);
        }
        self
    }
}

/// Distils the texture of a cube that `maps` were found of under `setting`.
///
/// # Errors
/// A sky that is none of the surroundings, pixels beyond the cube, an unknown gain, maps of another cube; a cube that cannot be read.
pub fn distil(setting: &Setting<'_>, maps: &Maps, cube: &Cube, sky: Sky<'_>) -> Result<Distilled> {
    let tangents = Tangents::new(setting)?;
    checked(setting, maps, cube, sky)?;
    let mut shows = vec![0_u64; maps.material.len()];
    for (k, pixels) in sky.shown_by.iter().enumerate().filter(|(k, _)| *k != sky.place) {
        pixels.iter().for_each(|i| shows[*i] |= 1 << k);
    }
    let sums = over_rows(cube, &|row, counts| first(&tangents, maps, (row, counts, setting), &shows))?;
    let sums = sums.iter().fold(Sums::new(&tangents), Sums::add);
    let (of_sky, scatterings) = light_of_the_sky(&tangents.lights, sky.place, &sums);
    let var_light: Vec<Vec<f64>> = sums.residues.iter().map(|(n, of)| var_light(*n, of)).collect();
    let rows = over_rows(cube, &|row, counts| {
        second(&tangents, maps, (row, counts, setting), (&of_sky, &var_light))
    })?;
    let all = rows.concat();
    let part = |i: usize| all.iter().map(|pixel| pixel[i] as f32).collect();
    let residues = sums.residues.iter().zip(&var_light).enumerate().filter(|(_, ((n, _), _))| *n > 0);
    let residues = residues.map(|(material, ((pixels, of), light))| Residue {
        material,
        pixels: *pixels,
        light: mean(light.iter().copied()).sqrt(),
        noise: mean(of.iter().map(|[_, weights]| *pixels as f64 / weights)).sqrt(),
    });
    Ok(Distilled {
        texture: part(0),
        sigma: part(1),
        of_model: part(2),
        with_all_residue: part(3),
        residues: residues.collect(),
        scatterings,
        var_light,
        of_sky,
    })
}

/// Maps and cube are of one size, and as the setting says.
pub(super) fn fits(setting: &Setting<'_>, maps: &Maps, cube: &Cube) -> Result<()> {
    let shape = cube.shape();
    let pixels = shape.rows() * shape.columns();
    for (what, found, expected) in [
        ("bands of the cube", shape.bands(), setting.bands.len()),
        ("pixels of the maps", maps.material.len(), pixels),
        ("temperatures of the maps", maps.temperature_k.len(), pixels),
        ("lighting factors", maps.lighting.len(), pixels * setting.surroundings.len()),
    ] {
        if found != expected {
            return Err(Error::Length { what: what.into(), found, expected });
        }
    }
    Ok(())
}

fn checked(setting: &Setting<'_>, maps: &Maps, cube: &Cube, sky: Sky<'_>) -> Result<()> {
    fits(setting, maps, cube)?;
    let pixels = maps.material.len();
    let (found, expected) = (sky.shown_by.len(), setting.surroundings.len());
    if found != expected {
        let what = "lists of pixels that show the surroundings".into();
        return Err(Error::Length { what, found, expected });
    }
    if sky.place >= setting.surroundings.len() {
        let found = format!("surroundings {} as the sky", sky.place);
        let instead = format!("there are {}, counted from 0", setting.surroundings.len());
        return Err(Error::malformed(found, instead));
    }
    let beyond = |i: &&usize| **i >= pixels;
    sky.shown_by.iter().flatten().find(beyond).map_or(Ok(()), |wrong| {
        let found = format!("pixel {wrong} of {pixels}, which shows surroundings");
        Err(Error::malformed(found, "count pixels row after row, from 0"))
    })
}

/// What `of_row` makes of each row and its samples.
pub(super) fn over_rows<T: Send>(
    cube: &Cube,
    of_row: &(dyn Fn(usize, &[f64]) -> T + Sync),
) -> Result<Vec<T>> {
    fn all<S: Sample, T: Send>(
        cube: &dyn Rows<S>,
        of_row: &(dyn Fn(usize, &[f64]) -> T + Sync),
    ) -> Result<Vec<T>> {
        let one = |buffer: &mut Vec<S>, row: usize| {
            let samples: Vec<f64> = cube.read(row..row + 1, buffer)?.iter().map(|s| (*s).into()).collect();
            Ok(of_row(row, &samples))
        };
        parallel::try_map_with(cube.shape().rows(), Vec::new, one)
    }
    match cube {
        Cube::F32(rows) => all(rows.as_ref(), of_row),
        Cube::F64(rows) => all(rows.as_ref(), of_row),
    }
}

/// A row of samples, its place, and what they are of.
pub(super) type Row<'a, 'b> = (usize, &'a [f64], &'a Setting<'b>);

/// Material, whitened residue, columns and lighting of a pixel.
pub(super) type Fitted<'a> = (usize, &'a [f64], &'a Tangent, &'a [f64]);

/// Does `with` for each pixel that has a material, a temperature and a lighting, and without anything for the others.
pub(super) fn each_pixel(
    tangents: &Tangents,
    maps: &Maps,
    (row, counts, setting): Row<'_, '_>,
    with: &mut dyn FnMut(usize, Option<Fitted<'_>>),
) {
    let (bands, lights) = (setting.bands.len(), setting.surroundings.len());
    let columns = counts.len() / bands;
    let (mut tangent, mut rho, mut lighting) = (Tangent::default(), Vec::new(), Vec::new());
    for (column, sample) in counts.chunks(bands).enumerate() {
        let i = row * columns + column;
        let m = maps.material[i];
        lighting.clear();
        lighting.extend(maps.lighting[i * lights..(i + 1) * lights].iter().map(|v| f64::from(*v)));
        let known = m != NO_MATERIAL
            && tangents.at(usize::from(m), f64::from(maps.temperature_k[i]), &lighting, &mut tangent);
        if !known {
            with(i, None);
            continue;
        }
        rho.clear();
        rho.extend(
            tangents
                .used
                .iter()
                .zip(tangent.mean.iter().zip(&tangent.sigma))
                .map(|(band, (mean, sigma))| (sample[*band] / setting.units_per_count - mean) / sigma),
        );
        tangent.take_out(&mut rho);
        with(i, Some((usize::from(m), &rho, &tangent, &lighting)));
    }
}

/// δ of a band for one unit of its whitened residue; nothing where nothing is scattered.
fn per_unit(tangents: &Tangents, m: usize, tangent: &Tangent, w: usize) -> Option<f64> {
    let reflected = tangents.reflected.get(m)?.get(w).filter(|counts| **counts > 0.0)?;
    Some(tangent.sigma.get(w)? / reflected).filter(|per| per.is_finite())
}

fn first(tangents: &Tangents, maps: &Maps, row: Row<'_, '_>, shows: &[u64]) -> Sums {
    let mut sums = Sums::new(tangents);
    each_pixel(tangents, maps, row, &mut |i, found| {
        let Some((m, rho, tangent, lighting)) = found else { return };
        if rho.iter().all(|rho| rho.is_finite())
            && let Some((pixels, of)) = sums.residues.get_mut(m)
        {
            *pixels += 1;
            for (w, sum) in of.iter_mut().enumerate() {
                let Some(per) = per_unit(tangents, m, tangent, w) else { continue };
                let kept = tangent.kept(w);
                if kept > 1e-9 {
                    sum[0] += rho[w] * rho[w] / kept;
                    sum[1] += 1.0 / (kept * per * per);
                }
            }
        }
        for (k, (pixels, of)) in sums.scattering.iter_mut().enumerate() {
            if shows.get(i).is_none_or(|shows| shows >> k & 1 == 0) {
                continue;
            }
            *pixels += 1;
            for (v, of) in lighting.iter().zip(of) {
                for (w, sum) in of.iter_mut().enumerate() {
                    *sum += v * tangents.reflected[m][w] / tangents.counts_per_radiance[w];
                }
            }
        }
    });
    sums
}

/// τ² of each band.
fn var_light(pixels: usize, of: &[[f64; 2]]) -> Vec<f64> {
    let one = |[square, weights]: &[f64; 2]| {
        let var = (square - pixels as f64).max(0.0) / weights;
        if var.is_finite() { var } else { 0.0 }
    };
    of.iter().map(one).collect()
}

/// S̄ of all surroundings, and after how many scatterings.
fn light_of_the_sky(lights: &[Vec<f64>], sky: usize, sums: &Sums) -> (Vec<Vec<f64>>, usize) {
    let mut sent: Vec<Vec<f64>> = lights.iter().map(|s| vec![0.0; s.len()]).collect();
    sent[sky].clone_from(&lights[sky]);
    for scattering in 1..=SCATTERINGS {
        let mut next = sent.clone();
        let mut change = 0.0_f64;
        for (k, (pixels, of)) in sums.scattering.iter().enumerate().filter(|(k, _)| *k != sky) {
            if *pixels == 0 {
                continue;
            }
            for w in 0..next[k].len() {
                let sum: f64 = of.iter().zip(&sent).map(|(of, sent)| of[w] * sent[w]).sum();
                let light = sum / *pixels as f64;
                change = change.max((light - sent[k][w]).abs() / lights[sky][w].max(f64::MIN_POSITIVE));
                next[k][w] = light;
            }
        }
        sent = next;
        if change <= SETTLED {
            return (sent, scattering);
        }
    }
    (sent, SCATTERINGS)
}

/// Texture, deviation, texture of the model and with all of the residue, of each pixel of a row.
fn second(
    tangents: &Tangents,
    maps: &Maps,
    row: Row<'_, '_>,
    (of_sky, var_light): (&[Vec<f64>], &[Vec<f64>]),
) -> Vec<[f64; 4]> {
    let all: Vec<f64> = of_sky.iter().map(|s| s.iter().sum()).collect();
    let l = tangents.of_lighting(&all);
    let mut pixels = Vec::new();
    each_pixel(tangents, maps, row, &mut |i, found| {
        let Some((m, rho, tangent, lighting)) = found else {
            pixels.push([f64::NAN; 4]);
            return;
        };
        let of_model = dot(lighting, &all);
        let mut var = f64::INFINITY;
        let (mut texture, mut whole) = (of_model, of_model);
        if let Some(g) = tangent.row(&l) {
            let added = fused(tangents, (m, tangent), &var_light[m]);
            texture += dot(&added, rho);
            let row: Vec<f64> = g.iter().zip(&added).map(|(g, added)| g + added).collect();
            var = dot(&row, &row);
            for (w, (row, rho)) in row.iter().zip(rho).enumerate() {
                let Some(per) = per_unit(tangents, m, tangent, w) else { continue };
                whole += per * rho;
                // Light that the model lacks comes through the row as counts do, and should come whole.
                var += (row / per - 1.0).powi(2) * var_light[m][w];
            }
        }
        let sigma = var.sqrt();
        // Were another material right, the texture would be another one altogether.
        let claimed = if maps.candidates.get(i) == Some(&1) { sigma } else { f64::NAN };
        pixels
            .push([texture, claimed, of_model, whole].map(|x| if sigma.is_finite() { x } else { f64::NAN }));
    });
    pixels
}

/// The row of whitened counts that the share of the residue Σω δ follows.
pub(super) fn fused(tangents: &Tangents, (m, tangent): (usize, &Tangent), var_light: &[f64]) -> Vec<f64> {
    let one = |(w, light): (usize, &f64)| {
        let per = per_unit(tangents, m, tangent, w).filter(|_| *light > 0.0);
        per.map_or(0.0, |per| per * light / (light + tangent.kept(w) * per * per))
    };
    let mut row: Vec<f64> = var_light.iter().enumerate().map(one).collect();
    tangent.take_out(&mut row);
    row
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.filter(|x| x.is_finite()).fold((0.0, 0.0), |(s, n), x| (s + x, n + 1.0));
    sum / f64::max(count, 1.0)
}
