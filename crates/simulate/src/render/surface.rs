//! What a surface is made of, and the pattern on it.
//!
//! e(ν) = (1 − τ) e₀(ν) + τ e₁(ν) with a texture τ in [0, 1] that is a function of the place on the surface. A
//! texture knows how far apart the rays are that look at it (the same for both cameras, since it depends on the
//! depth alone), and leaves out what is finer than they can show.

use super::noise::{self, GradientLine};
use super::uneven::{NODES, Uneven};
use super::vector::{Vector, along, dot, unit};
use hadar::error::{Error, Result, check};
use hadar::scene::check_emissivity;

/// More octaves than this are finer than any wavelength.
const MAX_OCTAVES: usize = 24;
/// All of the emission at the first temperature.
const ONE: [f64; NODES] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
/// Width of the road over which its mean is taken, m.
const MEAN_WIDTH_M: f64 = 60.0;
/// An edge of a lane mark is never sharper than this, m.
const WORN_EDGE_M: f64 = 0.01;

/// A spectral emissivity.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum Emissivity {
    /// The same at every wavenumber.
    Constant(f64),
    /// One value at each node of the bands.
    Spectrum(Vec<f64>),
}

impl Emissivity {
    /// Its values at `nodes` nodes.
    ///
    /// # Errors
    /// A value outside [0, 1], or not one per node.
    pub(super) fn at_nodes(&self, nodes: usize) -> Result<Vec<f64>> {
        let values = match self {
            Self::Constant(value) => vec![*value; nodes],
            Self::Spectrum(values) => values.clone(),
        };
        check_emissivity(&values, nodes)?;
        Ok(values)
    }
}

/// A surface.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Surface {
    /// Name by which the surface is reported.
    pub name: String,
    /// Mean temperature of the surface, K.
    pub temperature_k: f64,
    /// How the temperature varies over it; the same everywhere where `None`.
    pub uneven: Option<Uneven>,
    /// Emissivities e₀ and e₁ that the texture mixes.
    pub emissivity: [Emissivity; 2],
    /// The mixing τ of the two.
    pub texture: Texture,
    /// Roughness of its normals; smooth where `None`.
    pub bump: Option<Bump>,
}

impl Surface {
    /// A smooth surface of one temperature and emissivity.
    #[must_use]
    pub fn plain(name: &str, temperature_k: f64, emissivity: &Emissivity) -> Self {
        Self {
            name: name.to_owned(),
            temperature_k,
            uneven: None,
            emissivity: [emissivity.clone(), emissivity.clone()],
            texture: Texture::Plain,
            bump: None,
        }
    }

    /// Checks temperature, constant emissivities, texture and roughness.
    ///
    /// # Errors
    /// The first figure that is out of range, with the surface's name as the key.
    pub(super) fn check(&self) -> Result<()> {
        let checked = || {
            check::positive("temperature", self.temperature_k, "K")?;
            if let Some(uneven) = &self.uneven {
                uneven.check(self.temperature_k)?;
            }
            for emissivity in &self.emissivity {
                match emissivity {
                    Emissivity::Constant(value) => drop(check::unit_interval("emissivity", *value)?),
                    Emissivity::Spectrum(values) => check_emissivity(values, values.len())?,
                }
            }
            if let Some(bump) = &self.bump {
                check::positive("size of the bumps", bump.size_m, "m")?;
                check::non_negative("slope of the bumps", bump.slope, "")?;
            }
            self.texture.check()
        };
        checked().map_err(|error: Error| error.for_key(&self.name))
    }

    fn varies(&self) -> Option<Uneven> {
        self.uneven.filter(|uneven| uneven.sigma_k > 0.0)
    }

    /// Its temperature at a point, K.
    #[inline]
    pub(super) fn temperature_at(&self, point: Vector) -> f64 {
        self.varies().map_or(self.temperature_k, |uneven| uneven.temperature_at(self.temperature_k, point))
    }

    /// Temperatures whose emission is mixed, K.
    pub(super) fn nodes_k(&self) -> Vec<f64> {
        self.varies()
            .map_or_else(|| vec![self.temperature_k], |uneven| uneven.nodes_k(self.temperature_k).to_vec())
    }

    /// Shares of their emission at a temperature.
    #[inline]
    pub(super) fn weights(&self, temperature_k: f64) -> [f64; NODES] {
        self.varies().map_or(ONE, |uneven| uneven.weights(self.temperature_k, temperature_k))
    }

    /// The shares in what all of it emits.
    pub(super) fn mean_weights(&self) -> [f64; NODES] {
        self.varies().map_or(ONE, |uneven| uneven.mean_weights(self.temperature_k))
    }

    /// Whether it has two emissivities.
    pub(super) fn is_mixed(&self) -> bool {
        self.emissivity[0] != self.emissivity[1]
    }

    /// Its normal at a point where it would be `smooth` without bumps.
    #[inline]
    pub(super) fn normal(&self, point: Vector, smooth: Vector) -> Vector {
        let Some(bump) = self.bump.filter(|bump| bump.slope > 0.0) else { return smooth };
        let slope = noise::value_slope(point.map(|x| x / bump.size_m), bump.seed);
        let slope = along(slope, -dot(slope, smooth), smooth);
        unit(along(smooth, -bump.slope / noise::VALUE_SLOPE_RMS, slope))
    }
}

/// Roughness of a surface: slopes of smooth noise.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bump {
    /// Size of the bumps, m.
    pub size_m: f64,
    /// Root mean square slope against the smooth surface.
    pub slope: f64,
    /// Seed that determines the pattern of bumps.
    pub seed: u32,
}

/// One sinusoid of a texture.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Wave {
    /// Cycles per metre in x and y.
    pub cycles_per_m: [f64; 2],
    /// Amplitude of the variation of τ by this sinusoid.
    pub amplitude: f64,
    /// Phase at x = y = 0, rad.
    pub phase_rad: f64,
}

/// The mixing τ of a surface's two emissivities.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Texture {
    /// τ = 0.
    Plain,
    /// A road along z, as a function of x and z.
    Road(Road),
    /// τ = mean + Σ amplitude·cos(2π(f_x x + f_y y) + phase).
    Waves {
        /// Mean of the mixing τ over the surface, 0 to 1.
        mean: f64,
        /// The sinusoids that add up to the texture.
        waves: Vec<Wave>,
    },
}

/// Asphalt with lane marks: octaves of noise, each half as large as the one before.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Road {
    /// Seed that determines the pattern of noise.
    pub seed: u32,
    /// Size of the coarsest grains, m.
    pub coarsest_m: f64,
    /// Number of octaves of noise that are added.
    pub octaves: usize,
    /// Amplitude of an octave over that of the one before.
    pub persistence: f64,
    /// Mean τ of the asphalt.
    pub asphalt: f64,
    /// Root mean square of τ about its mean on the asphalt, before it is cut off at 0 and 1.
    pub contrast: f64,
    /// Mixing τ of the lane marks, 0 to 1.
    pub mark: f64,
    /// Distance between the marks on both sides of the lane, m; the lane's middle is x = 0.
    pub lane_m: f64,
    /// Width of a mark, m; 0 for none.
    pub mark_width_m: f64,
    /// Length of a dash of the mark at x < 0, and of the gap after it, m.
    pub dash_m: [f64; 2],
}

impl Default for Road {
    fn default() -> Self {
        Self {
            seed: 1,
            coarsest_m: 1.28,
            octaves: 8,
            persistence: 0.85,
            asphalt: 0.6,
            contrast: 0.18,
            mark: 0.05,
            lane_m: 3.5,
            mark_width_m: 0.15,
            dash_m: [3.0, 6.0],
        }
    }
}

/// How finely a surface is looked at around a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Footprint {
    /// Between rays of a row, m.
    pub(super) across_m: f64,
    /// Between rays of neighbouring rows, along the ground, m.
    pub(super) ahead_m: f64,
    /// Size of the finest grains that are shown, m.
    pub(super) finest_m: f64,
}

impl Texture {
    fn check(&self) -> Result<()> {
        match self {
            Self::Plain => Ok(()),
            Self::Road(road) => {
                check::positive("size of the coarsest grains", road.coarsest_m, "m")?;
                check::non_negative("persistence", road.persistence, "")?;
                check::unit_interval("mean of the asphalt's texture", road.asphalt)?;
                check::non_negative("contrast of the asphalt", road.contrast, "")?;
                check::unit_interval("texture of the marks", road.mark)?;
                check::positive("width of the lane", road.lane_m, "m")?;
                check::non_negative("width of a mark", road.mark_width_m, "m")?;
                check::positive("length of a dash", road.dash_m[0], "m")?;
                check::non_negative("gap between dashes", road.dash_m[1], "m")?;
                if road.octaves > MAX_OCTAVES {
                    let found = format!("a texture of {} octaves", road.octaves);
                    return Err(Error::malformed(found, format!("give at most {MAX_OCTAVES}")));
                }
                Ok(())
            }
            Self::Waves { mean, waves } => {
                check::unit_interval("mean of the texture", *mean)?;
                let mut reach = 0.0;
                for wave in waves {
                    let [x, y] = wave.cycles_per_m;
                    for (what, value, unit) in [
                        ("spatial frequency", x, "m^-1"),
                        ("spatial frequency", y, "m^-1"),
                        ("amplitude", wave.amplitude, ""),
                        ("phase", wave.phase_rad, "rad"),
                    ] {
                        check::finite(what, value, unit)?;
                    }
                    reach += wave.amplitude.abs();
                }
                check::unit_interval("lowest value of the texture", mean - reach)?;
                check::unit_interval("highest value of the texture", mean + reach).map(drop)
            }
        }
    }

    /// τ at a point.
    #[inline]
    pub(super) fn at(&self, point: Vector, footprint: &Footprint) -> f64 {
        match self {
            Self::Plain => 0.0,
            Self::Road(road) => road.line(point[2], footprint).at(point[0]),
            Self::Waves { mean, waves } => waves.iter().fold(*mean, |sum, wave| {
                let cycles = wave.cycles_per_m[0] * point[0] + wave.cycles_per_m[1] * point[1];
                sum + wave.amplitude * libm::cos(std::f64::consts::TAU * cycles + wave.phase_rad)
            }),
        }
    }

    /// τ averaged over the surface; over a road 60 m wide.
    pub(super) fn mean(&self) -> f64 {
        match self {
            Self::Plain => 0.0,
            Self::Waves { mean, .. } => *mean,
            Self::Road(road) => {
                let fine = Footprint { across_m: 0.0, ahead_m: 0.0, finest_m: 0.0 };
                let side = 160;
                let place = |i: usize| (i as f64 + 0.5) * 0.377 - 30.0;
                let places: Vec<f64> = (0..side).map(place).collect();
                let row = |z: &f64| {
                    let mut line = road.line(*z, &fine);
                    line.asphalt(&places);
                    line.sums.iter().sum::<f64>()
                };
                let asphalt = places.iter().map(row).sum::<f64>() / (side * side) as f64;
                // Marks are narrower than the steps of any lattice: their share is known.
                let [dash, gap] = road.dash_m;
                let marked = road.mark_width_m / MEAN_WIDTH_M * (1.0 + dash / (dash + gap));
                asphalt + marked.min(1.0) * (road.mark - asphalt)
            }
        }
    }
}

/// The share of [x − w/2, x + w/2] that is in [low, high].
#[inline]
fn overlap(x: f64, width: f64, low: f64, high: f64) -> f64 {
    (((x + 0.5 * width).min(high) - (x - 0.5 * width).max(low)) / width).clamp(0.0, 1.0)
}

impl Road {
    /// The road across z.
    pub(super) fn line(&self, z: f64, footprint: &Footprint) -> RoadLine<'_> {
        let (mut cells_per_m, mut amplitude, mut square) = (self.coarsest_m.recip(), 1.0, 0.0);
        let mut octaves = Vec::with_capacity(self.octaves);
        for octave in 0..self.octaves {
            let size = cells_per_m.recip();
            // From nothing at the finest size to all at twice that.
            let shown = if footprint.finest_m > 0.0 {
                (size / footprint.finest_m - 1.0).clamp(0.0, 1.0)
            } else {
                1.0
            };
            if shown > 0.0 {
                // Between rows that are further apart than a grain, several are averaged.
                let averaged = 1.0 / (1.0 + footprint.ahead_m / size).sqrt();
                let weight = amplitude * shown * shown * (3.0 - 2.0 * shown) * averaged;
                let noise = GradientLine::new(z * cells_per_m, self.seed.wrapping_add(octave as u32));
                octaves.push(Octave { weight, cells_per_m, noise });
            }
            square += amplitude * amplitude;
            amplitude *= self.persistence;
            cells_per_m *= 2.0;
        }
        let scale = if square > 0.0 { self.contrast / (noise::GRADIENT_RMS * square.sqrt()) } else { 0.0 };
        octaves.iter_mut().for_each(|octave| octave.weight *= scale);
        let ([dash, gap], length) = (self.dash_m, footprint.ahead_m.max(WORN_EDGE_M));
        let painted_until = |z: f64| {
            let periods = z / (dash + gap);
            periods.floor() * dash + ((periods - periods.floor()) * (dash + gap)).min(dash)
        };
        let painted = (painted_until(z + 0.5 * length) - painted_until(z - 0.5 * length)) / length;
        let width_m = footprint.across_m.max(WORN_EDGE_M);
        RoadLine { road: self, octaves, sums: Vec::new(), width_m, painted: painted.clamp(0.0, 1.0) }
    }
}

/// A line across a road, for place after place.
#[derive(Debug)]
pub(super) struct RoadLine<'a> {
    road: &'a Road,
    /// Those that are shown.
    octaves: Vec<Octave>,
    /// Their sums at the places in work.
    sums: Vec<f64>,
    /// Width over which the edges of marks are averaged, m.
    width_m: f64,
    /// Share of the mark at x < 0 that is painted.
    painted: f64,
}

#[derive(Debug)]
struct Octave {
    weight: f64,
    cells_per_m: f64,
    noise: GradientLine,
}

impl RoadLine<'_> {
    /// τ at x.
    #[inline]
    pub(super) fn at(&mut self, x: f64) -> f64 {
        self.sum(&[x])
    }

    /// Σ τ over places.
    pub(super) fn sum(&mut self, places: &[f64]) -> f64 {
        self.asphalt(places);
        let tau = |(x, asphalt): (&f64, &f64)| asphalt + self.marked(*x) * (self.road.mark - asphalt);
        places.iter().zip(&self.sums).map(tau).sum()
    }

    /// τ of the road without marks at every place, in `sums`.
    fn asphalt(&mut self, places: &[f64]) {
        self.sums.clear();
        self.sums.resize(places.len(), self.road.asphalt);
        for Octave { weight, cells_per_m, noise } in &mut self.octaves {
            for (sum, x) in self.sums.iter_mut().zip(places) {
                *sum += *weight * noise.at(x * *cells_per_m);
            }
        }
        self.sums.iter_mut().for_each(|tau| *tau = tau.clamp(0.0, 1.0));
    }

    /// Share of the place that is painted.
    #[inline]
    fn marked(&self, x: f64) -> f64 {
        let (side, half) = (0.5 * self.road.lane_m, 0.5 * self.road.mark_width_m);
        let line = overlap(x.abs(), self.width_m, side - half, side + half);
        if x > 0.0 { line } else { line * self.painted }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINE: Footprint = Footprint { across_m: 1e-3, ahead_m: 1e-3, finest_m: 0.0 };

    #[test]
    fn asphalt_has_the_mean_and_the_contrast_it_is_asked_for() {
        let road = Road { mark_width_m: 0.0, contrast: 0.1, asphalt: 0.5, ..Road::default() };
        let n = 300;
        let (mut sum, mut square) = (0.0, 0.0);
        for i in 0..n * n {
            let tau = road.line(f64::from(i % n) * 0.773, &FINE).at(f64::from(i / n) * 0.731 - 90.0) - 0.5;
            sum += tau;
            square += tau * tau;
        }
        let count = f64::from(n * n);
        assert!((sum / count).abs() < 0.002, "{}", sum / count);
        assert!(((square / count).sqrt() / 0.1 - 1.0).abs() < 0.02, "{}", (square / count).sqrt());
    }

    #[test]
    fn marks_cover_what_they_should() {
        let road = Road { contrast: 0.0, ..Road::default() };
        let at = |x, z| Texture::Road(road.clone()).at([x, 0.0, z], &FINE);
        assert_eq!(at(0.0, 10.0), 0.6);
        // A share of a few centimetres about 2 m: 1e-14.
        assert!((at(1.75, 10.0) - 0.05).abs() < 1e-12 && at(1.6, 10.0) == 0.6);
        // Dashes on the left: painted for 3 m, then nothing for 6 m.
        assert!((at(-1.75, 10.0) - 0.05).abs() < 1e-12 && (at(-1.75, 13.0) - 0.6).abs() < 1e-12);
        // Seen from far away, what is seen is the share that is painted.
        let far = Footprint { across_m: 1.5, ahead_m: 90.0, finest_m: 0.0 };
        assert!((road.line(500.0, &far).marked(1.75) / 0.1 - 1.0).abs() < 1e-9);
        assert!((road.line(500.0, &far).marked(-1.75) / (0.1 / 3.0) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn bumps_have_the_slope_they_are_asked_for() {
        let bump = Some(Bump { size_m: 0.05, slope: 0.1, seed: 3 });
        let surface = Surface { bump, ..Surface::plain("s", 300.0, &Emissivity::Constant(0.9)) };
        let smooth = [0.6, 0.0, 0.8];
        let n = 40_000;
        let square: f64 = (0..n)
            .map(|i| {
                let normal = surface.normal(
                    [f64::from(i) * 0.0737, f64::from(i % 200) * 0.0611, f64::from(i) * 0.0437],
                    smooth,
                );
                dot(normal, smooth).powi(-2) - 1.0
            })
            .sum();
        let slope = (square / f64::from(n)).sqrt();
        assert!((slope / 0.1 - 1.0).abs() < 0.02, "{slope}");
    }

    #[test]
    fn impossible_surfaces_are_errors() {
        let plain = Surface::plain("wall", 300.0, &Emissivity::Constant(0.9));
        assert!(plain.check().is_ok());
        let wave = Wave { cycles_per_m: [1.0, 0.0], amplitude: 0.6, phase_rad: 0.0 };
        for bad in [
            Surface { temperature_k: 0.0, ..plain.clone() },
            Surface { emissivity: [Emissivity::Constant(1.1), Emissivity::Constant(0.9)], ..plain.clone() },
            Surface {
                emissivity: [Emissivity::Spectrum(vec![0.9, f64::NAN]), Emissivity::Constant(0.9)],
                ..plain.clone()
            },
            Surface { bump: Some(Bump { size_m: 0.0, slope: 0.1, seed: 0 }), ..plain.clone() },
            Surface { texture: Texture::Waves { mean: 0.5, waves: vec![wave] }, ..plain.clone() },
            Surface { texture: Texture::Road(Road { octaves: 99, ..Road::default() }), ..plain.clone() },
            Surface { texture: Texture::Road(Road { contrast: f64::NAN, ..Road::default() }), ..plain },
        ] {
            assert!(bad.check().is_err(), "{bad:?}");
        }
    }
}
