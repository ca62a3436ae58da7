//! All that is known of a cube before its counts are looked at.

use hadar::error::{Error, Result, check};
use hadar::spectrum::Bands;

/// Most surroundings of a scene.
pub const MOST_SURROUNDINGS: usize = 7;

/// Spectrum of one of the surroundings.
#[derive(Debug, Clone, PartialEq)]
pub enum Light {
    /// Photon radiance at the nodes of the bands, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    Radiance(Vec<f64>),
    /// Counts that a pixel which sees nothing else has in each band.
    Counts(Vec<f64>),
}

impl Setting<'_> {
    /// Radiance of each of the surroundings over all bands that count, photons s⁻¹ m⁻² sr⁻¹: the texture of a surface that sees
    /// nothing else.
    #[must_use]
    pub fn textures(&self) -> Vec<f64> {
        let used: Vec<usize> = (0..self.bands.len()).filter(|band| !self.bad_bands.contains(band)).collect();
        self.radiances(&used).iter().map(|light| light.iter().sum()).collect()
    }

    /// Radiance of each of the surroundings in some bands, photons s⁻¹ m⁻² sr⁻¹.
    pub(super) fn radiances(&self, used: &[usize]) -> Vec<Vec<f64>> {
        let of = |light: &Light| -> Vec<f64> {
            let all = match light {
                Light::Radiance(radiance) => self.bands.weigh(radiance),
                Light::Counts(counts) => {
                    counts.iter().zip(self.counts_per_radiance).map(|(n, k)| n / k).collect()
                }
            };
            used.iter().filter_map(|band| all.get(*band).copied()).collect()
        };
        self.surroundings.iter().map(of).collect()
    }
}

/// What is between surface and camera, at the nodes of the bands.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Share τ of the light that comes through.
    pub transmittance: Vec<f64>,
    /// What it sends itself, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    pub radiance: Vec<f64>,
}

/// All that is known of a cube before its counts are looked at.
#[derive(Debug, Clone, Copy)]
pub struct Setting<'a> {
    /// The bands of the cube.
    pub bands: &'a Bands,
    /// Emissivities of the library at the nodes of the bands.
    pub library: &'a [Vec<f64>],
    /// Spectra of the surroundings, at most [`MOST_SURROUNDINGS`]; none is deep space.
    pub surroundings: &'a [Light],
    /// Counts for each unit of band signal ∫S dν, of each band, m² sr s.
    pub counts_per_radiance: &'a [f64],
    /// Variance of electronic noise of each band, counts²; empty for none.
    pub var_added: &'a [f64],
    /// What one count is in the unit of the cube's samples: 1 where they are counts.
    pub units_per_count: f64,
    /// Temperatures that a target may have, K.
    pub temperature_k: [f64; 2],
    /// ΣVₖ where it is known; else it is at most 1.
    pub lighting_total: Option<f64>,
    /// Whether the overall scale of the counts is unknown.
    pub gain: bool,
    /// Bands that are left out, for instance dead or saturated ones.
    pub bad_bands: &'a [usize],
    /// The air before the camera, the same for all pixels; none if silent.
    pub path: Option<&'a Path>,
    /// Light that all surfaces scatter besides, photon radiance at the nodes; empty for none.
    pub light_besides: &'a [f64],
}

/// Refuses air and light besides that are impossible, or that cannot be told apart from rows of the cube.
pub(super) fn check_between(setting: &Setting<'_>, nodes: usize) -> Result<()> {
    let length = |what: &str, values: &[f64]| match values.len() {
        found if found == nodes => Ok(()),
        found => Err(Error::Length { what: what.into(), found, expected: nodes }),
    };
    if !setting.light_besides.is_empty() {
        length("light besides", setting.light_besides)?;
        // What is estimated about none may come out below it.
        check::each(setting.light_besides, f64::is_finite, |x| check::finite("light besides", x, ""))?;
    }
    let Some(path) = setting.path else { return Ok(()) };
    length("transmittance of the air", &path.transmittance)?;
    length("radiance of the air", &path.radiance)?;
    path.transmittance
        .iter()
        .try_for_each(|t| check::unit_interval("transmittance of the air", *t).map(|_| ()))?;
    check::each(
        &path.radiance,
        |x| (0.0..f64::INFINITY).contains(&x),
        |x| check::non_negative("radiance of the air", x, ""),
    )?;
    if setting.surroundings.iter().any(|light| matches!(light, Light::Counts(_))) {
        let found = "rows of the cube as a light, and air on the path";
        return Err(Error::malformed(found, "give the light as a spectrum, or leave the air out"));
    }
    Ok(())
}
