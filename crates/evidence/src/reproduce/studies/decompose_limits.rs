//! How near a decomposed heat cube comes to what the photons allow, over the photons of a pixel.
//!
//! * Materials. A pixel is in a random state, or in the nearest state of one of the other materials, each as often as the others. No
//!   decision between these states, which the best one knows and a decomposition does not, is right more often than the most probable
//!   of them: its share, on the same spectra, is a limit of any method. Between two it is 1 − ½Σ min(p, q), for many photons Φ(d), d = d₁√N.
//! * Random pixels alone have no such limit: a method may favour their materials. Their mean Φ(d) stands beside it, as in `hadar decompose`.
//! * Temperature: error over the Cramér–Rao bound at the true state, share of 95 % intervals that hold it.

mod files;
mod sets;
mod temperatures;
mod text;

use crate::reproduce::order::{Effort, Order, Progress};
use crate::reproduce::pixels::Street;
use hadar::error::Result;
use hadar::material::Library;
use hadar_report::bundle::Bundle;

/// Photons of a pixel; the quick form has the first.
const PHOTONS: [f64; 11] = [1e2, 316.0, 1e3, 3160.0, 1e4, 31_600.0, 1e5, 316_000.0, 1e6, 3_160_000.0, 1e7];
const QUICK: usize = 3;
/// Random pixels whose neighbours are looked for.
const SETS_OF_TWO: usize = 300;
const SETS_OF_ALL: usize = 80;

/// The quick form has the tables alone, of the first numbers of photons.
pub(super) fn make(order: Order, library: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let street = Street::new(library)?;
    let two = Street::of(library, &sets::TWO)?;
    let of_two = sets::Sets::new(&two, SETS_OF_TWO, order.seed)?;
    let of_many = sets::Sets::new(&street, SETS_OF_ALL, order.seed)?;
    let photons = order.some_of(&PHOTONS, QUICK);
    let (mut materials, mut temperatures) = (Vec::new(), Vec::new());
    for (i, &photons_each) in photons.iter().enumerate() {
        let stream = (i as u64 + 1) << 24;
        materials.push((
            photons_each,
            of_two.decided(&two, photons_each, order.seed, stream)?,
            of_many.decided(&street, photons_each, order.seed, stream)?,
        ));
        temperatures.push(temperatures::read(&street, photons_each, order.seed, stream | 1 << 20)?);
        progress(i + 1, photons.len());
    }
    let mut bundle = Bundle::default();
    let plots = [files::materials(&materials), files::temperatures(&temperatures)];
    let finding = text::finding(&materials, &temperatures);
    if order.effort == Effort::Quick {
        for plot in plots {
            bundle.add_table(&format!("{}.csv", plot.name), plot.table)?;
        }
        return Ok((bundle, finding));
    }
    bundle.add("README.md", text::readme(&materials, &temperatures, order.seed));
    bundle.add_plots(&plots)?;
    Ok((bundle, finding))
}
