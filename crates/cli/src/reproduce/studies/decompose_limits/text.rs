//! The page.

use super::super::page::markdown;
use super::files::Row;
use super::temperatures::Read;
use hadar_report::text::significant;

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

pub(super) fn finding(materials: &[Row], temperatures: &[Read]) -> String {
    let beyond = materials
        .iter()
        .flat_map(|(_, two, many)| [two, many])
        .filter(|d| d.right > d.limit + 3.0 * d.right_error)
        .count();
    let (Some((photons, two, many)), Some(read)) = (materials.last(), temperatures.last()) else {
        return String::new();
    };
    let short = |pick: fn(&Row) -> f64| materials.iter().map(pick).fold(f64::NEG_INFINITY, f64::max);
    let two_short = short(|row| row.1.limit - row.1.right);
    let many_short = short(|row| row.2.limit - row.2.right);
    format!(
        "Of {} shares of right materials {beyond} are above their limit by more than three standard errors. Of two materials at most {} points are \
         missing, of 20 at most {} (a method that must choose among 20 has more to confuse than the nearest one). At {photons:.0e} photons {} of two \
         ({} allowed) and {} of 20 ({} allowed) are right; temperatures err by {} of their Cramér–Rao bound, and {} of the 95 % intervals \
         hold the truth.",
        2 * materials.len(),
        significant(100.0 * two_short, 2),
        significant(100.0 * many_short, 2),
        percent(two.right),
        percent(two.limit),
        percent(many.right),
        percent(many.limit),
        significant(read.over_bound, 3),
        percent(read.covered),
    )
}

pub(super) fn readme(materials: &[Row], temperatures: &[Read], seed: u64) -> String {
    let rows: Vec<Vec<String>> = materials
        .iter()
        .map(|(photons, two, many)| {
            let error = |d: &super::pairs::Decided| {
                format!("{} ± {}", percent(d.right), significant(100.0 * d.right_error, 1))
            };
            vec![
                format!("{photons:.1e}"),
                error(two),
                percent(two.limit),
                percent(two.phi),
                error(many),
                percent(many.limit),
                percent(many.phi),
                percent(many.right_random),
            ]
        })
        .collect();
    let header = [
        "photons",
        "two: right",
        "limit",
        "Φ(d)",
        "20: right",
        "limit",
        "Φ(d)",
        "20: right, random pixels alone",
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
         A pixel is in a random state, or in the state of another material that is the nearest to it, half each. Between these two no decision is \
         right more often than 1 - sum(min(p, q))/2, p and q the laws of their counts; the limit is the mean of that over 300 pairs, computed \
         without draws. It holds for any method and any library with both materials. Φ(d) of the nearest distance d is its value for many photons; \
         for few it is no bound. For random pixels alone there is no such limit: a method that favours their materials may exceed it.\n\n{}\n\
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
