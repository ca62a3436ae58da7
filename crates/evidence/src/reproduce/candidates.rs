//! Costs of every candidate material for some pixels, with scattered light (TeX) and without (TE), as in Fig. S20.

use super::pixels::{Pixel, Street, loss};
use hadar::error::Result;
use hadar_estimate::decompose::Method;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, NamedSeries, NamedValues};
use hadar_report::table::{Table, number};

/// Typical pixels: material, temperature (K), lighting by the sky; the first is drawn.
const TYPICAL: [(&str, f64, f64); 3] =
    [("aluminium-rough", 278.0, 0.7), ("sand-quartz", 276.0, 0.9), ("brick-red", 283.0, 0.4)];

/// A pixel and what every candidate costs, with scattered light and without.
pub(super) struct Costs {
    pixel: Pixel,
    pub(super) tex: Vec<f64>,
    pub(super) te: Vec<f64>,
}

impl Costs {
    /// Whether the least of some costs is that of the pixel's own material.
    pub(super) fn is_right(&self, costs: &[f64]) -> bool {
        let least = costs.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
        least.is_some_and(|(m, _)| m == self.pixel.material)
    }
}

/// The typical pixels drawn, with their costs.
pub(super) fn typical(street: &Street, photons: f64, seed: u64) -> Result<Vec<Costs>> {
    let mut out = Vec::new();
    for (i, (name, temperature_k, v)) in TYPICAL.iter().enumerate() {
        let material = street.names.iter().position(|one| one == name).unwrap_or(0);
        let state = street.surroundings.state(*temperature_k, &[*v, 1.0 - v])?;
        let pixel = Pixel { material, state };
        let counts = street.drawn(std::slice::from_ref(&pixel), photons, seed, 1 << 20 | i as u64)?;
        let mut costs = Costs { pixel, tex: Vec::new(), te: Vec::new() };
        for emissivity in &street.library {
            let temperature = |method| -> Result<f64> {
                let library = std::slice::from_ref(emissivity);
                let maps = street.decomposed(method, library, counts.clone(), photons)?;
                Ok(f64::from(maps.temperature_k[0]))
            };
            let tex = street.lit_best(emissivity, temperature(Method::Ml)?, &counts, photons);
            let te = street.counts_of(emissivity, temperature(Method::Te)?, &[0.0, 0.0], photons);
            costs.tex.push(loss(&counts, &tex));
            costs.te.push(loss(&counts, &te));
        }
        out.push(costs);
    }
    Ok(out)
}

/// Costs of all of them.
pub(super) fn table(street: &Street, typical: &[Costs]) -> Table {
    let mut table =
        Table::new(["pixel", "temperature_k", "lighting_by_sky", "candidate", "cost_tex", "cost_te"]);
    for costs in typical {
        let state = &costs.pixel.state;
        for (m, name) in street.names.iter().enumerate() {
            let sky = state.lighting.first().copied().unwrap_or(f64::NAN);
            table.push(vec![
                street.names[costs.pixel.material].to_owned(),
                number(state.temperature_k),
                number(sky),
                (*name).to_owned(),
                number(costs.tex[m]),
                number(costs.te[m]),
            ]);
        }
    }
    table
}

/// Costs of the first.
pub(super) fn plot(street: &Street, typical: &[Costs]) -> Plot {
    let mut table = Table::new(["candidate", "cost_tex", "cost_te"]);
    let names: Vec<String> = street.names.iter().map(|name| (*name).to_owned()).collect();
    let mut figure = NamedValues::new(
        format!("A pixel of {}: what every candidate costs", TYPICAL[0].0),
        names.clone(),
        Axis::log("cost: χ² of each band, 1 is noise"),
    )
    .subtitle("With scattered light (TeX) the least cost is that of noise, and the pixel's own; without (TE) it is not.");
    if let Some(costs) = typical.first() {
        for (m, name) in names.iter().enumerate() {
            table.push(vec![name.clone(), number(costs.tex[m]), number(costs.te[m])]);
        }
        figure = figure
            .series(NamedSeries::new("TeX", costs.tex.clone()).colour(0))
            .series(NamedSeries::new("TE", costs.te.clone()).colour(1))
            .line(1.0, "noise");
    }
    Plot { name: "candidates".into(), figure: figure.into(), table }
}
