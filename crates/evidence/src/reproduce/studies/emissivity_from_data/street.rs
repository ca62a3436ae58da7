//! Pixels of a street without a library: grouped, a library made of them, and decomposed by it and by the true one.

use crate::reproduce::pixels::{Pixel, Street, rms};
use hadar::error::Result;
use hadar::fisher::emissivity::Smoothness;
use hadar::material::Library;
use hadar_estimate::decompose::{Maps, Method, NO_MATERIAL};
use hadar_estimate::separation::{Asked, Found};
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, Band, LineFigure, Panel, Series, Style};
use hadar_report::table::Table;

/// What the street is made of.
pub(super) const MATERIALS: [&str; 6] =
    ["asphalt", "brick-red", "soda-lime-glass", "marble", "steel-rough", "vegetation-leaf"];
/// Photons of a pixel: some 10⁵ a band.
pub(super) const PHOTONS: f64 = 5.4e6;
/// Emissivity below which a surface is a bare metal.
const METAL: f64 = 0.5;
/// Counts of groups that are tried.
const COUNTS: [usize; 2] = [2, 10];
const KNOWN: Smoothness = Smoothness { mean: 0.9, magnitude: 0.3, shape: 0.1, correlation_cm1: 50.0 };

/// Share of right materials and error of the temperature.
#[derive(Debug, Clone, Copy)]
pub(super) struct Decomposed {
    pub(super) right: f64,
    pub(super) temperature_rms_k: f64,
    /// Of pixels whose material is right.
    pub(super) right_temperature_rms_k: f64,
}

pub(super) struct TakenApart {
    pub(super) pixels: usize,
    pub(super) found: Found,
    /// The material that most pixels of a group are of.
    pub(super) material: Vec<usize>,
    wavenumbers_cm1: Vec<f64>,
    truth: Vec<Vec<f64>>,
    pub(super) by_truth: Decomposed,
    pub(super) by_found: Decomposed,
    /// Share of the emissivities within 1.96 of their deviations, and rms error in units of them.
    pub(super) covered: f64,
    pub(super) over_sigma: f64,
    pub(super) emissivity_rms: f64,
}

fn judged(maps: &Maps, pixels: &[Pixel], material: &dyn Fn(usize) -> Option<usize>) -> Decomposed {
    let own = |i: usize| {
        let named = maps.material[i];
        (named != NO_MATERIAL).then(|| material(usize::from(named))).flatten()
    };
    let right: Vec<bool> = (0..pixels.len()).map(|i| own(i) == Some(pixels[i].material)).collect();
    let off = |i: usize| f64::from(maps.temperature_k[i]) - pixels[i].state.temperature_k;
    Decomposed {
        right: right.iter().filter(|right| **right).count() as f64 / pixels.len() as f64,
        temperature_rms_k: rms((0..pixels.len()).map(off)),
        right_temperature_rms_k: rms((0..pixels.len()).filter(|i| right[*i]).map(off)),
    }
}

pub(super) fn taken_apart(library: &Library, pixels: usize, seed: u64) -> Result<TakenApart> {
    let street = Street::of(library, &MATERIALS)?;
    let drawn = street.pixels(pixels, seed)?;
    let counts = street.drawn(&drawn, PHOTONS, seed, 1 << 24)?;
    let asked = Asked { count: COUNTS, max_emissivity: 0.99, prior: KNOWN, seed };
    let found = street.library_of(&asked, counts.clone(), PHOTONS)?;
    let mut votes = vec![vec![0usize; MATERIALS.len()]; found.clusters.len()];
    for (own, pixel) in found.maps.material.iter().zip(&drawn) {
        if let Some(row) = votes.get_mut(usize::from(*own)) {
            row[pixel.material] += 1;
        }
    }
    let material: Vec<usize> =
        votes.iter().map(|row| (0..row.len()).max_by_key(|m| row[*m]).unwrap_or(0)).collect();
    let by_truth = street.decomposed(Method::Ml, &street.library, counts, PHOTONS)?;
    let ratios: Vec<f64> = found
        .clusters
        .iter()
        .zip(&material)
        .flat_map(|(one, m)| {
            let truth = &street.library[*m];
            (0..truth.len()).map(move |w| (one.emissivity[w] - truth[w]) / one.sigma[w])
        })
        .collect();
    let errors = found.clusters.iter().zip(&material).flat_map(|(one, m)| {
        let truth = &street.library[*m];
        one.emissivity.iter().zip(truth).map(|(a, b)| a - b)
    });
    Ok(TakenApart {
        pixels,
        by_truth: judged(&by_truth, &drawn, &Some),
        by_found: judged(&found.maps, &drawn, &|group| material.get(group).copied()),
        covered: ratios.iter().filter(|x| x.abs() <= 1.96).count() as f64 / ratios.len().max(1) as f64,
        over_sigma: rms(ratios.iter().copied()),
        emissivity_rms: rms(errors),
        wavenumbers_cm1: street.bands.nodes_cm1().to_vec(),
        truth: street.library.clone(),
        material,
        found,
    })
}

impl TakenApart {
    pub(super) fn plot(&self) -> Plot {
        let nu = &self.wavenumbers_cm1;
        let mut columns = vec!["wavenumber_cm1".to_owned()];
        for m in &self.material {
            columns.extend(["true", "found", "sigma"].map(|what| format!("{}_{what}", MATERIALS[*m])));
        }
        let mut table = Table::new(columns);
        for (w, nu) in nu.iter().enumerate() {
            let own = self.found.clusters.iter().zip(&self.material);
            let cells = own.flat_map(|(one, m)| [self.truth[*m][w], one.emissivity[w], one.sigma[w]]);
            table.push_numbers(&std::iter::once(*nu).chain(cells).collect::<Vec<_>>());
        }
        let mut figure = LineFigure::new(
            "Are the emissivities found without a library the true ones?",
            Axis::linear("wavenumber (cm⁻¹)"),
            Axis::linear("emissivity"),
        )
        .subtitle(format!(
            "{} pixels of {} materials, {PHOTONS:.1e} photons each; no library known. Shaded: two standard deviations. Dotted: true.",
            self.pixels,
            MATERIALS.len()
        ));
        let mut metals = Panel::new(Axis::linear("emissivity"));
        for (i, (one, m)) in self.found.clusters.iter().zip(&self.material).enumerate() {
            let edge = |sign: f64| -> Vec<f64> {
                one.emissivity
                    .iter()
                    .zip(&one.sigma)
                    .map(|(e, s)| (e + 2.0 * sign * s).clamp(0.0, 1.02))
                    .collect()
            };
            // Metals are far below all else: in a panel of their own both are seen.
            let panel =
                if self.truth[*m].iter().all(|e| *e < METAL) { &mut metals } else { &mut figure.panel };
            panel.bands.push(Band::new("", nu.clone(), edge(-1.0), edge(1.0)).colour(i));
            panel.series.push(Series::line(MATERIALS[*m], nu.clone(), one.emissivity.clone()).colour(i));
            let truth = self.truth[*m].clone();
            panel.series.push(Series::line("", nu.clone(), truth).style(Style::Dotted).colour(6));
        }
        if !metals.series.is_empty() {
            figure = figure.lower(metals);
        }
        Plot { name: "street_emissivities".into(), figure: figure.into(), table }
    }
}
