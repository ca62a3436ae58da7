//! Fig. S20: the heat signal with scattered light (TeX) against temperature and emissivity alone (TE), and other methods beside both.
//!
//! Pixels of [`super::pixels`]. Costs of every candidate for some pixels, as in the figure; then for many pixels how often the material is
//! right, what is left of the signal, and how far the temperature is off, beside the Cramér–Rao bound. Beside it what the paper says of its
//! inverse functions in words: [`super::inverse_trade_off`].

use super::candidates::{self, Costs};
use super::inverse_trade_off;
use super::ledger::{Line, Verdict};
use super::order::{Figures, Made, Order};
use super::pixels::{Pixel, Street, loss, rms};
use hadar::error::Result;
use hadar::material::Library;
use hadar_estimate::decompose::{Maps, Method, NO_MATERIAL};
use hadar_report::bundle::Bundle;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Series};
use hadar_report::table::{Table, number};
use hadar_report::text::significant;

const PIXELS: usize = 1500;
const PHOTONS: f64 = 1e7;

/// What a method makes of all pixels.
struct Worth {
    method: Method,
    right: Option<f64>,
    loss: f64,
    rmse_k: f64,
    /// With the material known.
    known_rmse_k: f64,
    known_over_bound: f64,
    /// Mean of the error with the material known.
    known_bias_k: f64,
}

pub(super) fn make(order: Order) -> Result<Made> {
    let street = Street::new(&Library::embedded()?)?;
    let typical = candidates::typical(&street, PHOTONS, order.seed)?;
    let pixels = street.pixels(PIXELS, order.seed)?;
    let counts = street.drawn(&pixels, PHOTONS, order.seed, 1)?;
    let bounds = street.bounds_k(&pixels, PHOTONS)?;
    let mut worth = Vec::new();
    let mut by_material = Vec::new();
    for method in Method::ALL {
        let maps = street.decomposed(method, &street.library, counts.clone(), PHOTONS)?;
        let known = street.temperatures_of_known(method, &pixels, &counts, PHOTONS)?;
        let off = |i: usize, k: f64| k - pixels[i].state.temperature_k;
        let right = pixels.iter().zip(&maps.material).filter(|(p, m)| usize::from(**m) == p.material).count();
        let known_off: Vec<f64> = known.iter().enumerate().map(|(i, k)| off(i, *k)).collect();
        worth.push(Worth {
            method,
            right: method.names_materials().then_some(right as f64 / PIXELS as f64),
            loss: losses(&street, method, &maps, &counts),
            rmse_k: rms(maps.temperature_k.iter().enumerate().map(|(i, k)| off(i, f64::from(*k)))),
            known_rmse_k: rms(known_off.iter().copied()),
            known_over_bound: rms(known_off.iter().zip(&bounds).map(|(off, bound)| off / bound)),
            known_bias_k: known_off.iter().filter(|k| k.is_finite()).sum::<f64>()
                / known_off.iter().filter(|k| k.is_finite()).count() as f64,
        });
        by_material.push(known_off);
    }
    let mut bundle = Bundle::default();
    let trade_off = inverse_trade_off::make(order)?;
    bundle.add_table("costs.csv", candidates::table(&street, &typical))?;
    bundle.add_table("methods.csv", methods_table(&worth, &bounds))?;
    bundle.add_plots(&[
        candidates::plot(&street, &typical),
        temperatures(&street, &pixels, &by_material, &bounds),
        trade_off.plot,
    ])?;
    let mut lines = lines(&typical, &worth, &bounds);
    lines.extend(trade_off.lines);
    let text = format!(
        "{PIXELS} pixels of {} materials, {PHOTONS:.0e} photons each, 54 bands, shot noise. Loss: Pearson's χ² of each band, 1 is noise. `te` and \
         `ml` by the same likelihood, without and with scattered light; `analytic-inverse`: S46 and S47; `grey-body`: the blackbody that sends \
         as much in all bands together. Each of them is `hadar decompose --method`. The paper's pixels and its costs have no numbers in the text.\n\n\
         {}",
        street.names.len(),
        trade_off.text
    );
    let pictures = vec![
        (
            "candidates.png",
            "Cost of every candidate for a pixel of rough aluminium, with and without scattered light",
        ),
        ("temperatures.png", "Temperature error of each method over the reflectivity, the material known"),
        ("inverse_trade_off.png", "Errors of the inverse functions over the width of the bands"),
    ];
    Ok((bundle, lines, Figures { pictures, text }))
}

/// Mean loss of the pixels that have a temperature.
fn losses(street: &Street, method: Method, maps: &Maps, counts: &[f64]) -> f64 {
    let black = vec![1.0; street.bands.len()];
    let (mut sum, mut count) = (0.0, 0.0);
    for (i, n) in counts.chunks(street.bands.len()).enumerate() {
        let temperature_k = f64::from(maps.temperature_k[i]);
        if !temperature_k.is_finite() || (maps.material[i] == NO_MATERIAL && method.names_materials()) {
            continue;
        }
        let emissivity = street.library.get(usize::from(maps.material[i])).unwrap_or(&black);
        let lighting = [0, 1].map(|k| f64::from(maps.lighting[2 * i + k]));
        let means = match method {
            Method::Ml => street.lit_best(emissivity, temperature_k, n, PHOTONS),
            Method::AnalyticInverse => street.counts_of(emissivity, temperature_k, &lighting, PHOTONS),
            Method::Te | Method::GreyBody => {
                street.counts_of(emissivity, temperature_k, &[0.0, 0.0], PHOTONS)
            }
        };
        // An inverse function may leave less than nothing.
        let means: Vec<f64> = means.iter().map(|mean| mean.max(1.0)).collect();
        sum += loss(n, &means);
        count += 1.0;
    }
    sum / count
}

fn methods_table(worth: &[Worth], bounds: &[f64]) -> Table {
    let mut table = Table::new([
        "method",
        "right_material",
        "loss",
        "temperature_rmse_k",
        "temperature_rmse_material_known_k",
        "temperature_bias_material_known_k",
        "temperature_error_over_bound_material_known",
        "cramer_rao_rms_k",
    ]);
    for one in worth {
        let right = one.right.map_or_else(String::new, number);
        let numbers = [
            one.loss,
            one.rmse_k,
            one.known_rmse_k,
            one.known_bias_k,
            one.known_over_bound,
            rms(bounds.iter().copied()),
        ];
        let first = [one.method.name().to_owned(), right];
        table.push(first.into_iter().chain(numbers.map(number)).collect());
    }
    table
}

fn temperatures(street: &Street, pixels: &[Pixel], off: &[Vec<f64>], bounds: &[f64]) -> Plot {
    let mut order: Vec<(usize, f64)> =
        street.library.iter().map(|e| e.iter().sum::<f64>() / e.len() as f64).enumerate().collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    let of = |m: usize, values: &[f64]| {
        rms(pixels.iter().zip(values).filter(|(pixel, _)| pixel.material == m).map(|(_, value)| *value))
    };
    let names = Method::ALL.map(|method| format!("temperature_rmse_{}_k", method.name().replace('-', "_")));
    let header = ["material", "mean_emissivity"].into_iter().chain(names.iter().map(String::as_str));
    let mut table = Table::new(header.chain(["cramer_rao_rms_k"]));
    for (m, mean) in &order {
        let errors = off.iter().map(|off| number(of(*m, off)));
        let first = [street.names[*m].to_owned(), number(*mean)];
        table.push(first.into_iter().chain(errors).chain([number(of(*m, bounds))]).collect());
    }
    // Most materials are nearly black: what they reflect sets them apart.
    let x: Vec<f64> = order.iter().map(|(_, mean)| 1.0 - *mean).collect();
    let y = |values: &[f64]| order.iter().map(|(m, _)| of(*m, values)).collect::<Vec<f64>>();
    let mut figure = LineFigure::new(
        "Which method reads the temperature, the material known?",
        Axis::log("mean reflectivity of the material, 1 − emissivity"),
        Axis::log("temperature error, rms (K)"),
    )
    .subtitle(format!(
        "{PIXELS} pixels under sky and ground of any share, 270 to 310 K, {PHOTONS:.0e} photons each."
    ));
    for (i, (method, off)) in Method::ALL.iter().zip(off).enumerate() {
        figure = figure.series(Series::points(in_words(*method), x.clone(), y(off)).colour(i));
    }
    figure = figure.series(Series::points("Cramér–Rao bound", x.clone(), y(bounds)).open().colour(6));
    Plot { name: "temperatures".into(), figure: figure.into(), table }
}

/// What a method is.
fn in_words(method: Method) -> &'static str {
    match method {
        Method::Ml => "maximum likelihood, with scattered light (TeX)",
        Method::AnalyticInverse => "inverse functions (S46, S47)",
        Method::Te => "maximum likelihood, without scattered light (TE)",
        Method::GreyBody => "grey body",
    }
}

fn lines(typical: &[Costs], worth: &[Worth], bounds: &[f64]) -> Vec<Line> {
    let of = |method: Method| worth.iter().find(|one| one.method == method);
    let (Some(ml), Some(te), Some(grey), Some(inverse)) =
        (of(Method::Ml), of(Method::Te), of(Method::GreyBody), of(Method::AnalyticInverse))
    else {
        return Vec::new();
    };
    let choice = |holds: bool| if holds { Verdict::UnderAChoice } else { Verdict::NotReproduced };
    let right =
        |tex: bool| typical.iter().filter(|one| one.is_right(if tex { &one.tex } else { &one.te })).count();
    let percent = |share: Option<f64>| format!("{:.1} %", 100.0 * share.unwrap_or(f64::NAN));
    let bound = rms(bounds.iter().copied());
    let least = |costs: &[f64]| costs.iter().copied().fold(f64::INFINITY, f64::min);
    let te_least = typical.iter().map(|one| least(&one.te)).fold(f64::INFINITY, f64::min);
    let tex_least = typical.iter().map(|one| least(&one.tex)).fold(0.0, f64::max);
    let all = typical.len();
    vec![
        Line::new(
            "Fig. S20",
            "typical pixels: TeX names the material, TE another one",
            "yes",
            format!("TeX {} of {all}, TE {} of {all} right", right(true), right(false)),
            choice(right(true) == all && right(false) == 0),
            "the paper's pixels are those of its camera and have no numbers; ours are rough aluminium, sand and brick at 3 to 10 degC under a clear sky: where little is \
             scattered TE may be right",
        ),
        Line::new(
            "Fig. S20",
            "least cost of these pixels (1 is noise)",
            "TeX the more accurate model",
            format!("TeX at most {tex_least:.2}, TE at least {}", significant(te_least, 3)),
            choice(tex_least < te_least),
            "chi^2 of each band in the place of the paper's least squares",
        ),
        Line::new(
            "Fig. S20",
            "right material, random pixels of 20 materials",
            "TeX right, TE wrong",
            format!("TeX {}, TE {}", percent(ml.right), percent(te.right)),
            choice(ml.right > Some(0.5) && te.right < Some(0.5)),
            "most of them; what TeX lacks is grey materials of nearly one emissivity, and pixels near equilibrium",
        ),
        Line::new(
            "not in the paper",
            "temperature error of random pixels, K rms: maximum likelihood, TE, grey body, inverse functions",
            "-",
            format!("{:.3}, {:.2}, {:.2}, {:.2}", ml.rmse_k, te.rmse_k, grey.rmse_k, inverse.rmse_k),
            Verdict::NotInThePaper,
            format!(
                "with the material known {:.3}, {:.2}, {:.2}, {:.2}; Cramér–Rao bound then {bound:.3}",
                ml.known_rmse_k, te.known_rmse_k, grey.known_rmse_k, inverse.known_rmse_k
            ),
        ),
        Line::new(
            "not in the paper",
            "temperature error over the Cramér–Rao bound, material known, maximum likelihood",
            "-",
            format!("{:.3}", ml.known_over_bound),
            Verdict::NotInThePaper,
            "rms over all pixels, also those whose lighting is held by its range, which is why it may be below 1",
        ),
    ]
}
