//! The page.

use super::super::page::markdown;
use super::files::Row;
use super::sets::{Decided, TWO};
use super::temperatures::Read;
use hadar_report::text::significant;

/// Materials of the street.
const STREET: usize = 20;

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

pub(super) fn finding(materials: &[Row], temperatures: &[Read]) -> String {
    let counts = [TWO.len(), STREET];
    let beyond = materials
        .iter()
        .map(|(_, two, many)| usize::from(two.is_beyond(counts[0])) + usize::from(many.is_beyond(counts[1])))
        .sum::<usize>();
    let (Some((photons, two, many)), Some(read)) = (materials.last(), temperatures.last()) else {
        return String::new();
    };
    let short = |pick: fn(&Row) -> Decided, i: usize| {
        let each = materials.iter().map(|row| pick(row).best - pick(row).with_guesses(counts[i]));
        significant(100.0 * each.fold(f64::NEG_INFINITY, f64::max), 2)
    };
    format!(
        "Of {} shares of right materials {beyond} are above that of the best decision by more than three standard errors. With guesses where none is \
         named, at most {} points are missing between two materials and {} among {STREET}, whose states the best decision knows. At {photons:.0e} \
         photons {} of two (best {}) and {} of {STREET} (best {}) are right; temperatures err by {} of their Cramér–Rao bound, and {} of \
         the 95 % intervals hold the truth.",
        2 * materials.len(),
        short(|row| row.1, 0),
        short(|row| row.2, 1),
        percent(two.right),
        percent(two.best),
        percent(many.right),
        percent(many.best),
        significant(read.over_bound, 3),
        percent(read.covered),
    )
}

pub(super) fn readme(materials: &[Row], temperatures: &[Read], seed: u64) -> String {
    let cells = |d: &Decided| {
        let with_error =
            |share: f64, error: f64| format!("{} ± {}", percent(share), significant(100.0 * error, 1));
        [with_error(d.right, d.right_error), percent(d.unnamed), with_error(d.best, d.best_error)]
    };
    let rows: Vec<Vec<String>> = materials
        .iter()
        .map(|(photons, two, many)| {
            let first = [format!("{photons:.1e}")];
            let random = [percent(many.right_random), percent(many.phi)];
            first
                .into_iter()
                .chain(cells(two))
                .chain(two.exact.map(percent))
                .chain(cells(many))
                .chain(random)
                .collect()
        })
        .collect();
    let header = [
        "photons",
        "two: right",
        "none named",
        "best decision",
        "the same, exact",
        "20: right",
        "none named",
        "best decision",
        "random pixels: right",
        "Φ(d)",
    ];
    let read: Vec<Vec<String>> = temperatures
        .iter()
        .map(|r| {
            vec![
                format!("{:.1e}", r.photons),
                percent(r.open),
                significant(r.over_bound, 3),
                percent(r.covered),
                percent(r.held),
                percent(r.covered_held),
                significant(r.rmse_k, 3),
                significant(r.bound_k, 3),
            ]
        })
        .collect();
    let of_temperatures = [
        "photons",
        "right, within limits",
        "error over bound, rms",
        "intervals that hold the truth",
        "right, held by a limit",
        "their intervals that hold the truth",
        "error of all pixels, K rms",
        "bounds, K rms",
    ];
    format!(
        "# How near a decomposed heat cube comes to what the photons allow\n\n\
         Made by `hadar reproduce decompose-limits` (seed {seed}). {}\n\n\
         Pixels are drawn: 20 materials under a clear winter sky and above a ground of 5 degC, 270 to 310 K, any share of the sky, 54 bands, shot \
         noise; photons are those that a blackbody of 290 K sends in all bands. The decomposition knows the library and the surroundings.\n\n\
         ## Materials\n\n\
         A pixel is in a random state, or in the nearest state of one of the other materials, each as often as the others. Right: the material that \
         `hadar decompose` names; it names none where a pixel sends what its surroundings send. Best decision: the most probable of these states, \
         which are known to it, on the same spectra; no method is right more often, whatever it knows. Between two it is also \
         computed without draws (`hadar::identifiability::ratio`). A method that does not know the states has more to confuse: what is missing is the price of \
         unknown temperature and lighting. For the random pixels alone there is no such limit, since a method may favour their materials; Φ(d) of \
         their nearest distances is what `hadar decompose` prints beside the share of right materials.\n\n{}\n\
         ![Right materials](right_material.png)\n\n\
         ## Temperatures\n\n\
         Of random pixels of the 20 materials, error over the Cramér–Rao bound at their true state. With few photons the range of the lighting (0 to 1) \
         and of the temperature (250 to 340 K) holds most states, and errors of those that it does not hold are chosen: the bound is one for \
         unbiased estimates without limits, so that figures on either side of 1 are possible there. Pixels of a wrong material have errors that no \
         interval claims.\n\n{}\n\
         ![Temperatures](temperature.png)\n\n\
         The paper's network TeX-Net is not built: its training data and weights are not to be had. What stands here is what any network \
         could reach on such pixels, and what maximum likelihood does.\n",
        finding(materials, temperatures),
        markdown(&header, &rows),
        markdown(&of_temperatures, &read)
    )
}
