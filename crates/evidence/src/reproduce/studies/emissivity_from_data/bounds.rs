//! What can be told apart with nothing known but smoothness: over the resolution of the bands, the lines of the sky, and the contrast.

use super::methods::{NEDT_K, sigma};
use super::spectra::{STEP_CM1, Sky, Spectra, smoothness, wavenumbers_cm1};
use hadar::error::Result;
use hadar::fisher::emissivity::{EmissivityPrior, Seen, Separation, Smoothness};
use hadar::planck::photon_radiance_and_slope_into;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Series, Style};
use hadar_report::table::Table;

/// Narrow bands that one wide band takes in.
const JOINED: [usize; 6] = [1, 2, 4, 8, 16, 32];
/// Temperature of the surface where the resolution changes, K.
const SURFACE_K: f64 = 305.0;
/// Surface against air, K.
const CONTRAST_K: [f64; 17] =
    [-30.0, -20.0, -15.0, -10.0, -7.0, -5.0, -3.0, -1.0, 0.0, 1.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0];

/// Deviations of temperature and emissivity.
type Bound = [f64; 2];

pub(super) struct Bounds {
    pub(super) known: Smoothness,
    /// Width of the bands (cm⁻¹), and a bound for each sky and noise.
    pub(super) resolution: Vec<(f64, Vec<Bound>)>,
    pub(super) contrast: Vec<(f64, Vec<Bound>)>,
    labels: Vec<String>,
}

/// The bound with bands of so many narrow ones each, whose readings have the same noise as a temperature.
fn bound(known: Smoothness, sky: &Sky, nedt_k: f64, temperature_k: f64, joined: usize) -> Result<Bound> {
    let mean = |values: &[f64]| -> Vec<f64> {
        let whole = values.chunks(joined).filter(|chunk| chunk.len() == joined);
        whole.map(|chunk| chunk.iter().sum::<f64>() / joined as f64).collect()
    };
    let nu = wavenumbers_cm1();
    let (mut black, mut slope) = (vec![0.0; nu.len()], vec![0.0; nu.len()]);
    photon_radiance_and_slope_into(&nu, temperature_k, &mut black, &mut slope);
    let [nu, black, slope, light, sigma] =
        [&nu, &black, &slope, &sky.radiance, &sigma(nedt_k)].map(|values| mean(values));
    let prior = EmissivityPrior::smooth(&nu, known)?;
    let seen = Seen { blackbody: &black, slope: &slope, light: &light, sigma: &sigma };
    let found = Separation::at(&prior, prior.mean(), &seen)?;
    Ok([found.sigma_temperature_k, found.emissivity_rms()])
}

impl Bounds {
    pub(super) fn of(spectra: &Spectra, skies: &[Sky]) -> Result<Self> {
        let all: Vec<&[f64]> = spectra.emissivity.iter().map(Vec::as_slice).collect();
        let known = smoothness(&all);
        let each = |temperature_k: &dyn Fn(&Sky) -> f64, joined: usize| -> Result<Vec<Bound>> {
            let of = skies.iter().flat_map(|sky| NEDT_K.map(|nedt_k| (sky, nedt_k)));
            of.map(|(sky, nedt_k)| bound(known, sky, nedt_k, temperature_k(sky), joined)).collect()
        };
        Ok(Self {
            known,
            resolution: JOINED
                .iter()
                .map(|joined| Ok((STEP_CM1 * *joined as f64, each(&|_| SURFACE_K, *joined)?)))
                .collect::<Result<_>>()?,
            contrast: CONTRAST_K
                .iter()
                .map(|apart| Ok((*apart, each(&|sky| sky.air_k + apart, 1)?)))
                .collect::<Result<_>>()?,
            labels: skies
                .iter()
                .flat_map(|sky| NEDT_K.map(|nedt_k| format!("sky {}, NEDT {nedt_k} K", sky.name)))
                .collect(),
        })
    }

    fn table(&self, first: &str, rows: &[(f64, Vec<Bound>)]) -> Table {
        let columns = (0..self.labels.len()).flat_map(|i| {
            let (sky, nedt) = (["means", "lines"][i / NEDT_K.len()], NEDT_K[i % NEDT_K.len()]);
            ["temperature_k", "emissivity"].map(|what| format!("sigma_{what}_{sky}_{nedt}k"))
        });
        let mut table = Table::new(std::iter::once(first.to_owned()).chain(columns));
        for (x, bounds) in rows {
            table.push_numbers(&[[*x].as_slice(), &bounds.concat()].concat());
        }
        table
    }

    /// Over the resolution, and over the contrast.
    pub(super) fn plots(&self) -> [Plot; 2] {
        let series = |rows: &[(f64, Vec<Bound>)], i: usize| {
            let x: Vec<f64> = rows.iter().map(|row| row.0).collect();
            let y = rows.iter().map(|row| row.1[i][0]).collect();
            // A colour for each sky, dashes for the larger noise.
            let style = if i.is_multiple_of(2) { Style::Line } else { Style::Dashed };
            Series::line(self.labels[i].clone(), x, y).style(style).colour(i / 2)
        };
        let known = self.known;
        let said = format!(
            "For emissivities of mean {:.2} ± {:.2} and shape ± {:.3}, to a quarter over {} cm⁻¹, as the measured ones are.",
            known.mean, known.magnitude, known.shape, known.correlation_cm1
        );
        let mut resolution = LineFigure::new(
            "How well does smoothness alone determine the temperature, over the width of the bands?",
            Axis::log("width of a band (cm⁻¹)"),
            Axis::log("least error of the temperature (K)"),
        )
        .subtitle(format!("{said} Surface at {SURFACE_K} K, 8 to 13 µm, the same NEDT in every band."));
        let mut contrast = LineFigure::new(
            "How well does smoothness alone determine the temperature, over the contrast?",
            Axis::linear("surface warmer than the air (K)"),
            Axis::log("least error of the temperature (K)"),
        )
        .subtitle(format!("{said} Bands of {STEP_CM1} cm⁻¹ from 8 to 13 µm."));
        for i in 0..self.labels.len() {
            resolution = resolution.series(series(&self.resolution, i));
            contrast = contrast.series(series(&self.contrast, i));
        }
        [
            Plot {
                name: "bound_resolution".into(),
                figure: resolution.into(),
                table: self.table("band_width_cm1", &self.resolution),
            },
            Plot {
                name: "bound_contrast".into(),
                figure: contrast.into(),
                table: self.table("surface_above_air_k", &self.contrast),
            },
        ]
    }
}
