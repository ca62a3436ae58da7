//! A scenario as the files that `hadar` reads: TOML and the CSV of its materials, every number with all its digits.

use crate::vectors::scene::{Material, Scene, coat, glass, metal, sand, sky};
use hadar::instrument::{Camera, NoiseSpec};

/// Bands of the scenarios, cm⁻¹: start, stop, step.
pub(super) const BANDS_CM1: [f64; 3] = [720.0, 1240.0, 20.0];

/// A material and its name.
pub(super) type Named = (&'static str, Material);

pub(super) const COAT: Named = ("coat", coat);
pub(super) const METAL: Named = ("metal", metal);
pub(super) const GLASS: Named = ("glass", glass);
pub(super) const SAND: Named = ("sand", sand);
/// Of the surroundings.
pub(super) const SKY: Named = ("sky", sky);

/// What is demanded.
#[derive(Debug, Clone, Copy)]
pub(super) enum Demand {
    Distance(f64),
    Probability(f64),
}

/// A scenario.
#[derive(Debug)]
pub(super) struct Asked {
    pub(super) id: &'static str,
    pub(super) about: &'static str,
    pub(super) target: Named,
    pub(super) alternatives: Vec<Named>,
    /// The scene, whose materials do not count.
    pub(super) scene: Scene,
    /// Whether temperatures are written in °C, to a hundredth.
    pub(super) celsius: bool,
    pub(super) distance_m: Option<f64>,
    pub(super) camera: Option<Camera>,
    pub(super) demand: Demand,
}

pub(super) fn file_of(material: &str) -> String {
    format!("identify_{material}.csv")
}

pub(super) fn spectrum(material: Material) -> String {
    let [start, stop, step] = BANDS_CM1;
    let count = ((stop - start) / step) as u32;
    let rows = (0..=count).map(|i| {
        let nu = start + step * f64::from(i);
        format!("{nu},{}\n", material(nu))
    });
    format!("wavenumber_cm1,emissivity\n{}", rows.collect::<String>())
}

impl Asked {
    pub(super) fn file(&self) -> String {
        format!("identify_{}.toml", self.id.replace('-', "_"))
    }

    fn temperature(&self, kelvin: f64) -> String {
        match self.celsius {
            true => format!("{} degC", ((kelvin - 273.15) * 100.0).round() / 100.0),
            false => format!("{kelvin:?} K"),
        }
    }

    /// The scenario, every number with all its digits.
    pub(super) fn toml(&self) -> String {
        let scene = &self.scene;
        let alternatives: Vec<String> =
            self.alternatives.iter().map(|(name, _)| format!("\"{}\"", file_of(name))).collect();
        let unknown: Vec<String> =
            scene.unknown.iter().map(|nuisance| format!("\"{}\"", nuisance.name())).collect();
        let [start, stop, step] = BANDS_CM1;
        let mut text = format!(
            "title = \"{}\"\n\n[target]\nmaterial = \"{}\"\ntemperature = \"{}\"\n",
            self.about,
            file_of(self.target.0),
            self.temperature(scene.temperature_k)
        );
        if let Some(distance_m) = self.distance_m {
            text.push_str(&format!("distance = \"{distance_m:?} m\"\n"));
        }
        for object in &scene.objects {
            text.push_str(&format!(
                "\n[[environment]]\ntemperature = \"{}\"\nlighting = {:?}\n",
                self.temperature(object.temperature_k),
                object.lighting
            ));
            if object.material.is_some() {
                text.push_str(&format!("material = \"{}\"\n", file_of(SKY.0)));
            }
        }
        text.push_str(&format!(
            "\n[alternatives]\nmaterials = [{}]\n\n[bands]\nstart = \"{start:?} cm^-1\"\nstop = \"{stop:?} cm^-1\"\nstep = \"{step:?} cm^-1\"\n\n\
             [unknown]\nnuisances = [{}]\n",
            alternatives.join(", "),
            unknown.join(", ")
        ));
        if let Some(total) = scene.lighting_total {
            text.push_str(&format!("lighting_total = {total:?}\n"));
        }
        if let Some(camera) = &self.camera {
            text.push_str(&camera_toml(camera));
        }
        text.push_str(&match self.demand {
            Demand::Distance(distance) => format!("\n[requirement]\ndistance = {distance:?}\n"),
            Demand::Probability(probability) => {
                format!("\n[requirement]\ndetection_probability = {probability:?}\n")
            }
        });
        text
    }
}

fn camera_toml(camera: &Camera) -> String {
    // To a thousandth of the unit, without what a factor of ten leaves of a double.
    let thousandths = |value: f64| (value * 1e3).round() / 1e3;
    let [exposure_ms, noise_ms] = [camera.exposure_s, camera.noise_exposure_s].map(|s| thousandths(s * 1e3));
    let noise = match camera.noise {
        NoiseSpec::Netd { netd_k, temperature_k, f_number, .. } => {
            let netd_mk = thousandths(netd_k * 1e3);
            format!(
                "netd = \"{netd_mk} mK\"\nnetd_temperature = \"{temperature_k:?} K\"\nnetd_f_number = {f_number:?}\n"
            )
        }
        NoiseSpec::Counts { sigma_counts } => format!("noise_electrons = {sigma_counts:?}\n"),
        _ => String::new(),
    };
    format!(
        "\n[camera]\nexposure = \"{exposure_ms} ms\"\npixel = \"{} um\"\nf_number = {:?}\nfocal_length = \"{} mm\"\n\
         optics_efficiency = {:?}\nquantum_efficiency = {:?}\nframes = {}\n{noise}noise_exposure = \"{noise_ms} ms\"\n\
         flicker_fraction = {:?}\n",
        thousandths(camera.pixel_m * 1e6),
        camera.f_number,
        thousandths(camera.focal_length_m * 1e3),
        camera.optics_efficiency,
        camera.quantum_efficiency,
        camera.frames,
        camera.flicker_fraction
    )
}
