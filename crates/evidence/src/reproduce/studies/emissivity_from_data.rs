//! Temperature and emissivity without a library: methods that are in use, beside what can be told apart at all.
//!
//! Measured spectra of surfaces, each in a scene of its own under a clear sky, are taken apart by
//!
//! * NEM alone; TES (NEM, ratios, the relation of MMD); the smoothest emissivity (ISSTES, ARTEMISS); a Gaussian prior of principal
//!   components; a Gaussian prior of smoothness alone.
//!
//! What a method learns from spectra it learns from the others: a spectrum, and every one of the same name, is left out. Beside them
//! stand published figures and the bound with nothing known but smoothness, which is one for emissivities drawn from that prior: these
//! are drawn too. Then pixels of a street are grouped, a library is made of them, and they are decomposed by it and by the true one.

mod bounds;
mod files;
mod gaussian;
mod methods;
mod mmd;
mod smoothest;
mod spectra;
mod street;
mod text;

use crate::reproduce::order::{Effort, Order, Progress};
use hadar::error::Result;
use hadar::material::Library;
use hadar_report::bundle::Bundle;

/// Scenes of each spectrum, and in the quick form.
const SCENES: usize = 6;
const QUICK: usize = 1;

/// `library`: the measured spectra. The quick form has the tables alone, with a scene for each spectrum.
pub(super) fn make(order: Order, library: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let quick = order.effort == Effort::Quick;
    let built_in = Library::embedded()?;
    let skies = spectra::skies(&built_in)?;
    let spectra = spectra::Spectra::of(library)?;
    let scenes = if quick { QUICK } else { SCENES };
    let mut compared = Vec::new();
    for sky in &skies {
        for nedt_k in methods::NEDT_K {
            compared.push(methods::compare(&spectra, sky, nedt_k, scenes, order.seed)?);
            progress(compared.len(), 2 * skies.len() + 2);
        }
    }
    let bounds = bounds::Bounds::of(&spectra, &skies)?;
    progress(2 * skies.len() + 1, 2 * skies.len() + 2);
    let street = street::taken_apart(&built_in, if quick { 4000 } else { 40_000 }, order.seed)?;
    let mut bundle = Bundle::default();
    bundle.add_table("methods.csv", files::methods(&compared))?;
    bundle.add_table("street.csv", files::street(&street))?;
    let [resolution, contrast] = bounds.plots();
    let plots = [files::errors(&compared), resolution, contrast, street.plot()];
    let ledger = text::ledger(&compared);
    bundle.add_table("ledger.csv", crate::reproduce::ledger::table(&ledger))?;
    if quick {
        for plot in plots {
            bundle.add_table(&format!("{}.csv", plot.name), plot.table)?;
        }
    } else {
        bundle.add("README.md", text::readme(&spectra, &compared, &bounds, &street, &ledger, order.seed));
        bundle.add_plots(&plots)?;
    }
    Ok((bundle, text::finding(&spectra, &compared, &street)))
}
