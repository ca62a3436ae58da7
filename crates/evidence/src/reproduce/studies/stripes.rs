//! What stripes of a push-broom cube cost, and what destriping gives back.
//!
//! A twin whose truth is known: a scene of 0.95 B(T) in 24 bands with a horizon, a warm block and texture, photons and electronic noise;
//! a share of the lines (rows, each band for itself) reads g·x + o. Beside each other:
//!
//! * bounds (S37, S27): information of the position of a window along and across the lines, and of the temperature of a pixel, where gain
//!   and offset of the striped lines are unknown, and where they are known as well as destriping says;
//! * what estimates do on the clean, the striped and the destriped cube.

mod files;
mod information;
mod measure;
mod text;
mod twin;

use crate::reproduce::order::{Effort, Order, Progress};
use hadar::error::Result;
use hadar::material::Library;
use hadar_report::bundle::Bundle;
use measure::measured;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Shares of striped lines; the quick form has the first.
const SHARES: [f64; 5] = [0.05, 0.02, 0.1, 0.15, 0.2];
const QUICK: usize = 1;
/// Cubes drawn for each share.
const CUBES: u64 = 6;
/// The share whose pictures are shown.
const SHOWN: f64 = 0.1;

/// The quick form has the table of the first share alone.
pub(super) fn make(order: Order, _library: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let scene = twin::Twin::new()?;
    let shares = order.some_of(&SHARES, QUICK);
    let done = AtomicUsize::new(0);
    let one = |(i, &share): (usize, &f64)| {
        measured(&scene, share, CUBES, order.seed, (i as u64) << 16)
            .inspect(|_| progress(done.fetch_add(1, Ordering::Relaxed) + 1, shares.len()))
    };
    let mut rows = shares.par_iter().enumerate().map(one).collect::<Result<Vec<_>>>()?;
    rows.sort_by(|a, b| a.share.total_cmp(&b.share));
    let mut bundle = Bundle::default();
    let finding = text::finding(&rows);
    bundle.add_table("stripes.csv", files::table(&rows))?;
    if order.effort == Effort::Quick {
        return Ok((bundle, finding));
    }
    bundle.add("README.md", text::readme(&rows, CUBES, order.seed));
    bundle.add_plots(&[files::information(&rows), files::pictures(&scene, SHOWN, order.seed)?])?;
    Ok((bundle, finding))
}
