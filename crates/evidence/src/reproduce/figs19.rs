//! Fig. S19 and Table I: ranging on decomposed texture against ranging on the thermal image, with our own block matcher.
//!
//! Both views of the yard are taken apart, each for itself; windows of the left image of each kind are looked for in the right one of
//! the same kind. Metrics of S19: mean and root mean square error of the disparity, share of pixels within τ, density; those of Table I
//! of the depth. Beside them the bound √(1/J_left + 1/J_right) ≈ √(2/J) of a window's disparity by what each kind of image tells.
//!
//! Judged are pixels that the other camera sees too. A texture that is unknown in a pixel has the value of the pixel before it.
//! The optimal case is the true texture without noise.

use super::ledger::{Line, Verdict};
use super::order::{Figures, Made, Order};
use super::textured::{EXPOSURE, Textured, median, window_sums};
use hadar::cube::Shape;
use hadar::error::Result;
use hadar::ranging::information::Window;
use hadar::ranging::metrics::DepthMetrics;
use hadar::words::significant;
use hadar_estimate::decompose::{Maps, texture_information};
use hadar_report::bundle::Bundle;
use hadar_report::decompose::{Clahe, brightness};
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Picture, Series};
use hadar_report::range::picture_plot;
use hadar_report::table::{Table, markdown, number};
use hadar_simulate::matching::block::Block;
use hadar_simulate::matching::dense::disparity_map;
use hadar_simulate::matching::{Search, StereoPair};
use hadar_study::range;
use hadar_study::render::Picture as Rendered;

/// Windows of the matcher: the paper's.
const SIDE: usize = 5;
const HALF: usize = 2;
/// Disparities that are tried, pixels.
const SEARCH: [i32; 2] = [2, 30];
/// A match is accurate within so many pixels.
const WITHIN_PX: [f64; 2] = [0.5, 1.0];
/// Depths in both views differ by less where they see the same point.
const SAME_DEPTH: f64 = 0.03;

/// Ranging on one kind of image over some pixels.
struct Row {
    image: &'static str,
    exposure: &'static str,
    region: &'static str,
    mean_px: f64,
    rmse_px: f64,
    median_px: f64,
    within: [f64; 2],
    density: f64,
    depth: Option<DepthMetrics>,
    /// Median of the bound, pixels; none where the image has no noise or its bound is not known.
    bound_px: Option<f64>,
}

/// An image of both views, with its information.
struct Kind {
    name: &'static str,
    bands: usize,
    left: Vec<f64>,
    right: Vec<f64>,
    information: Option<Vec<f64>>,
}

/// Exposures: that of the yard, a hundred times it, a tenth.
const EXPOSURES: [&str; 3] = [EXPOSURE, LONG, "20 us"];
const LONG: &str = "20 ms";

pub(super) fn make(order: Order) -> Result<Made> {
    let mut rows = Vec::new();
    let mut bundle = Bundle::default();
    let mut noise = Vec::new();
    for exposure in order.some_of(&EXPOSURES, 1).iter().copied() {
        let yard = Textured::new(exposure, order.seed)?;
        let (own, pictures) = ranged(&yard, exposure)?;
        rows.extend(own);
        noise.push(format!("{} mK at {exposure}", significant(1e3 * yard.netd_k(), 2)));
        if exposure == EXPOSURE {
            bundle.add_asked("scenario.toml", yard.scenario.to_toml());
            let subtitle = format!(
                "{exposure}. Windows of {SIDE} × {SIDE}, correlation with a parabola. No value: sky, what one camera alone sees, no match."
            );
            let plot = picture_plot(
                "errors",
                "Where does block matching fail? Error of the disparity",
                subtitle,
                pictures,
            );
            bundle.add_plots(&plot.into_iter().collect::<Vec<_>>())?;
        }
    }
    bundle.add_table("ranging.csv", table(&rows))?;
    bundle.add_plots(&[against_noise(&rows)])?;
    let pictures = vec![
        ("errors.png", "Error of the disparity on each kind of image"),
        ("exposures.png", "Share of pixels within one pixel of disparity over the exposure"),
    ];
    Ok((bundle, lines(&rows), Figures { pictures, text: text(&rows, &noise.join(", ")) }))
}

type Pictures = Vec<(String, Picture)>;

/// Ranging at one exposure.
fn ranged(yard: &Textured, exposure: &'static str) -> Result<(Vec<Row>, Pictures)> {
    let seen = seen_by_both(yard)?;
    let columns = yard.shape.columns();
    let ground: Vec<bool> =
        (0..seen.len()).map(|i| seen[i] && i / columns >= yard.shape.rows() / 2).collect();
    let (mut rows, mut pictures) = (Vec::new(), Vec::new());
    let left = &yard.expected.views[0];
    let truth: Vec<f64> = left.depth_m.iter().map(|z| yard.disparity_px(f64::from(*z))).collect();
    for kind in kinds(yard)? {
        let found = matched(yard, &kind)?;
        for (region, own) in [("all", &seen), ("ground", &ground)] {
            rows.push(judged(yard, &kind, (region, exposure), (own, &found, &truth)));
        }
        let off = |i: usize| if seen[i] { (found[i] - truth[i]).clamp(-2.0, 2.0) } else { f64::NAN };
        let values = (0..seen.len()).map(off).collect();
        let axis = Axis::linear("error (pixels)").range(-2.0, 2.0);
        pictures
            .push((format!("error_px_{}", key(kind.name)), Picture::new(kind.name, axis, columns, values)));
    }
    Ok((rows, pictures))
}

/// Accuracy of each kind of image over the exposure.
fn against_noise(rows: &[Row]) -> Plot {
    let all: Vec<&Row> = rows.iter().filter(|row| row.region == "all").collect();
    let mut images: Vec<&str> = Vec::new();
    all.iter().for_each(|row| {
        if !images.contains(&row.image) {
            images.push(row.image);
        }
    });
    let mut figure = LineFigure::new(
        "On which image does ranging work best, and from which exposure on?",
        Axis::log("exposure (s)"),
        Axis::linear("pixels within one pixel of disparity (%)").range(0.0, 100.0),
    )
    .subtitle(format!("Block matching, windows of {SIDE} × {SIDE}; pixels that both cameras see. The true texture has no noise."));
    let mut table = Table::new(["image", "exposure_s", "within_1_px"]);
    for row in &all {
        table.push(vec![row.image.to_owned(), number(seconds(row.exposure)), number(row.within[1])]);
    }
    for (colour, image) in images.iter().enumerate() {
        let own = all.iter().filter(|row| row.image == *image);
        let mut points: Vec<(f64, f64)> =
            own.map(|row| (seconds(row.exposure), 100.0 * row.within[1])).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        figure = figure
            .series(Series::line(*image, x.clone(), y.clone()).colour(colour))
            .series(Series::points("", x, y).colour(colour));
    }
    Plot { name: "exposures".into(), figure: figure.into(), table }
}

fn seconds(exposure: &str) -> f64 {
    let (value, unit) = exposure.split_once(' ').unwrap_or((exposure, "s"));
    let value: f64 = value.parse().unwrap_or(f64::NAN);
    value
        * match unit {
            "us" => 1e-6,
            "ms" => 1e-3,
            _ => 1.0,
        }
}

fn key(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect()
}

/// Values that are no numbers replaced by those before them in their row, the mean of all at its beginning.
fn filled(values: &[f64], columns: usize) -> Vec<f64> {
    let finite = values.iter().filter(|x| x.is_finite());
    let (sum, count) = finite.fold((0.0, 0.0), |(s, n), x| (s + x, n + 1.0));
    let mean = sum / f64::max(count, 1.0);
    let mut before = mean;
    let mut out = Vec::with_capacity(values.len());
    for (i, x) in values.iter().enumerate() {
        if i % columns == 0 {
            before = mean;
        }
        if x.is_finite() {
            before = *x;
        }
        out.push(before);
    }
    out
}

/// Logarithm of the texture, equalised, in levels: what is bright in TeX vision.
fn bright(yard: &Textured, maps: &Maps) -> Vec<f64> {
    let texture: Vec<f32> = yard.texture(maps).iter().map(|x| *x as f32).collect();
    brightness(&texture, yard.shape.columns()).iter().map(|x| (255.0 * x).round()).collect()
}

fn kinds(yard: &Textured) -> Result<Vec<Kind>> {
    let (shape, columns, all) = (yard.shape, yard.shape.columns(), yard.all());
    let [left, right] = [&yard.drawn.views[0], yard.right(&yard.drawn)?];
    let [(maps, found), (maps_right, found_right)] = [yard.apart(left, all)?, yard.apart(right, all)?];
    let expected = &yard.expected.views[0];
    let (true_fit, _) = yard.apart(expected, all)?;
    let information = texture_information(&yard.setting(all), &true_fit, &yard.cube(expected)?, &found)?;
    let f64s = |of: &[f32]| of.iter().map(|x| f64::from(*x)).collect::<Vec<f64>>();
    let equalised = |thermal: &[f64]| -> Vec<f64> {
        Clahe::of(shape.rows(), columns)
            .equalised(thermal, columns)
            .iter()
            .map(|x| (255.0 * x).round())
            .collect()
    };
    // Of counts the root has the same noise everywhere, which weighs bands and pixels as they deserve.
    let root = |picture: &Rendered| picture.counts.iter().map(|n| f64::from(*n).max(0.0).sqrt()).collect();
    let single = |name, [left, right]: [Vec<f64>; 2], information| Kind {
        name,
        bands: 1,
        left: filled(&left, columns),
        right: filled(&right, columns),
        information,
    };
    let thermal = [left, right].map(|view| yard.thermal(view));
    let agc = [equalised(&thermal[0]), equalised(&thermal[1])];
    Ok(vec![
        single("thermal image", thermal, Some(information.thermal)),
        single("thermal image, equalised, 256 levels", agc, None),
        single(
            "texture X, decomposed",
            [yard.texture(&maps), yard.texture(&maps_right)],
            Some(information.texture),
        ),
        single(
            "distilled texture",
            [f64s(&found.texture), f64s(&found_right.texture)],
            Some(information.distilled),
        ),
        single(
            "TeX vision's brightness, 256 levels",
            [&maps, &maps_right].map(|maps| bright(yard, maps)),
            None,
        ),
        Kind {
            name: "heat cube, all bands",
            bands: shape.bands(),
            left: root(left),
            right: root(right),
            information: Some(information.cube),
        },
        single(
            "texture X, true (optimal)",
            [yard.light(expected), yard.light(yard.right(&yard.expected)?)],
            None,
        ),
    ])
}

/// Pixels of the left view whose point the right one sees, and whose window lies in the image.
fn seen_by_both(yard: &Textured) -> Result<Vec<bool>> {
    let [left, right] = [&yard.expected.views[0], yard.right(&yard.expected)?];
    let (rows, columns) = (yard.shape.rows(), yard.shape.columns());
    let one = |i: usize| {
        let (row, column) = (i / columns, i % columns);
        let depth = f64::from(left.depth_m[i]);
        let place = (column as f64 - yard.disparity_px(depth)).round();
        let within = |at: usize, all: usize| at >= HALF && at + HALF < all;
        if !depth.is_finite() || !within(row, rows) || !within(column, columns) || place < HALF as f64 {
            return false;
        }
        let there = row * columns + place as usize;
        right.surface[there] == left.surface[i]
            && (f64::from(right.depth_m[there]) / depth - 1.0).abs() < SAME_DEPTH
    };
    Ok((0..rows * columns).map(one).collect())
}

/// Disparity of every pixel; NaN without a match.
fn matched(yard: &Textured, kind: &Kind) -> Result<Vec<f64>> {
    let shape = Shape::new(yard.shape.rows(), yard.shape.columns(), kind.bands)?;
    let pair = StereoPair::new(shape, &kind.left, &kind.right)?;
    let [least, most] = SEARCH;
    let map = disparity_map(&pair, &Block::new(Window::new(SIDE, SIDE)?), Search::new(least, most)?)?;
    let at = |i: usize| map.at(i / shape.columns(), i % shape.columns()).and_then(std::result::Result::ok);
    Ok((0..shape.rows() * shape.columns()).map(|i| at(i).unwrap_or(f64::NAN)).collect())
}

fn judged(
    yard: &Textured,
    kind: &Kind,
    (region, exposure): (&'static str, &'static str),
    (own, found, truth): (&[bool], &[f64], &[f64]),
) -> Row {
    let pixels: Vec<usize> = (0..own.len()).filter(|i| own[*i]).collect();
    let errors: Vec<f64> =
        pixels.iter().map(|i| (found[*i] - truth[*i]).abs()).filter(|x| x.is_finite()).collect();
    let n = errors.len().max(1) as f64;
    let depths = |of: &[f64]| of.iter().map(|d| yard.disparity_px(*d)).collect::<Vec<f64>>();
    let bound = kind.information.as_ref().map(|j| {
        let sums = window_sums(j, yard.shape, HALF);
        let of = |i: &usize| if sums[*i] > 0.0 { (2.0 / sums[*i]).sqrt() } else { f64::INFINITY };
        range::median(&pixels.iter().map(of).collect::<Vec<_>>())
    });
    Row {
        image: kind.name,
        exposure,
        region,
        mean_px: errors.iter().sum::<f64>() / n,
        rmse_px: (errors.iter().map(|x| x * x).sum::<f64>() / n).sqrt(),
        median_px: median(errors.iter().copied()),
        within: WITHIN_PX
            .map(|most| errors.iter().filter(|x| **x <= most).count() as f64 / pixels.len() as f64),
        density: errors.len() as f64 / own.len() as f64,
        // z = bF/d: the same function either way.
        depth: DepthMetrics::of(&depths(found), &depths(truth), Some(own)).ok(),
        bound_px: bound,
    }
}

fn table(rows: &[Row]) -> Table {
    let mut table = Table::new([
        "exposure",
        "image",
        "region",
        "mean_error_px",
        "rmse_px",
        "median_error_px",
        "accuracy_within_0.5_px",
        "accuracy_within_1_px",
        "density",
        "abs_rel",
        "sq_rel_m",
        "rmse_m",
        "rmse_log",
        "delta_1",
        "delta_2",
        "delta_3",
        "bound_median_px",
    ]);
    for row in rows {
        let depth = row.depth.map_or([f64::NAN; 7], |d| {
            [d.abs_rel, d.sq_rel_m, d.rmse_m, d.rmse_log, d.delta[0], d.delta[1], d.delta[2]]
        });
        let pixels = [row.mean_px, row.rmse_px, row.median_px, row.within[0], row.within[1], row.density];
        let mut cells = [row.exposure, row.image, row.region].map(str::to_owned).to_vec();
        cells.extend(pixels.into_iter().chain(depth).map(number));
        cells.push(row.bound_px.filter(|x| x.is_finite()).map_or_else(String::new, number));
        table.push(cells);
    }
    table
}

fn text(rows: &[Row], noise: &str) -> String {
    let mut text = format!(
        "Error of the disparity, and of the depth, over pixels that both cameras see (`all`), and over those in the lower half of the image (`ground`). \
         Accuracy: share of them within half a pixel, and within one; density: share of the image with a match. Bound: median over the windows, by what \
         the image tells. Noise of a pixel in all bands: {noise}.\n\n"
    );
    let s = |x: f64| significant(x, 3);
    let cells = |row: &Row| {
        let depth = row.depth.map_or([f64::NAN; 4], |d| [d.abs_rel, d.rmse_m, d.rmse_log, d.delta[0]]);
        let bound = row.bound_px.map_or_else(
            || "-".to_owned(),
            |x| if x.is_finite() { significant(x, 2) } else { "none".to_owned() },
        );
        let mut cells = [row.exposure, row.image, row.region].map(str::to_owned).to_vec();
        cells.extend([row.mean_px, row.rmse_px, row.median_px].map(s));
        cells.extend([row.within.map(s).join(", "), s(row.density)]);
        cells.extend(depth.map(s));
        cells.push(bound);
        cells
    };
    let head = [
        "exposure",
        "image",
        "region",
        "mean (px)",
        "RMSE (px)",
        "median (px)",
        "within 0.5, 1 px",
        "density",
        "Abs_Rel",
        "RMSE (m)",
        "RMSE_log",
        "δ1",
        "bound (px)",
    ];
    text.push_str(&markdown(&head, rows.iter().map(cells)));
    text.push_str(
        "\nThe heat cube tells the most, but this matcher does not make that of it: correlation of all bands lets the noise of 54 in with slopes that \
         nearly all go together, which their sum, the thermal image, has without. Decomposition spreads what the cube tells of a place over temperature and \
         lighting, and each of them alone is the noisier the more alike the two are.\n",
    );
    text
}

fn lines(rows: &[Row]) -> Vec<Line> {
    let of = |image: &str, exposure: &str| {
        rows.iter().find(|row| row.image == image && row.exposure == exposure && row.region == "all")
    };
    let at =
        |image: &str, exposure: &str, what: &dyn Fn(&Row) -> f64| of(image, exposure).map_or(f64::NAN, what);
    let value = |image: &str, what: &dyn Fn(&Row) -> f64| at(image, EXPOSURE, what);
    let three = |what: &dyn Fn(&Row) -> f64| {
        ["texture X, decomposed", "thermal image", "heat cube, all bands"]
            .map(|image| significant(value(image, what), 3))
            .join(", ")
    };
    let depth = |what: fn(&DepthMetrics) -> f64| move |row: &Row| row.depth.as_ref().map_or(f64::NAN, what);
    let within = |row: &Row| row.within[1];
    let better = |image: &str, than: &str| at(image, LONG, &within) > at(than, LONG, &within);
    let choice = |holds: bool| if holds { Verdict::UnderAChoice } else { Verdict::NotReproduced };
    let bounds = |row: &Row| row.bound_px.unwrap_or(f64::NAN);
    let shares = |images: &[&str]| {
        EXPOSURES
            .map(|exposure| {
                let each: Vec<String> =
                    images.iter().map(|image| significant(at(image, exposure, &within), 3)).collect();
                each.join(", ")
            })
            .join("; ")
    };
    vec![
        Line::new(
            "Table I, Fig. S19",
            "ranging on texture beats ranging on the thermal image, both as pictures of 256 levels (share of pixels within one pixel of disparity: TeX vision's brightness, \
             equalised thermal image; at 200 us; 20 ms; 20 us)",
            "TeX_night ~ RGB_day > IR_night",
            shares(&["TeX vision's brightness, 256 levels", "thermal image, equalised, 256 levels"]),
            choice(better("TeX vision's brightness, 256 levels", "thermal image, equalised, 256 levels")),
            "hangs on the local equalisation of the thermal image, which takes matches from it (the line below: without it the thermal image is the better one at every exposure); \
             verdict at 20 ms, hardly any noise, as in a rendered data set: with more of it the texture loses first; a scene and a block matcher of our own: rough surfaces, 54 bands, shot noise; the paper's is a trained network on its own data",
        ),
        Line::new(
            "Table I, Fig. S19",
            "the same, of the textures and of the thermal image as measured: optimal, decomposed, distilled, thermal (at 200 us; 20 ms; 20 us)",
            "TeX_night ~ RGB_day > IR_night",
            shares(&[
                "texture X, true (optimal)",
                "texture X, decomposed",
                "distilled texture",
                "thermal image",
            ]),
            choice(better("texture X, decomposed", "thermal image")),
            "the thermal image has the scattered light too, with less noise than a decomposition leaves it; what levels of a picture take from it was never lost in the counts",
        ),
        Line::new(
            "Fig. S19",
            "practical ranging (decomposed texture) near the optimal (true texture): RMSE of the disparity, pixels",
            "near-optimal",
            ["texture X, decomposed", "texture X, true (optimal)"]
                .map(|image| significant(value(image, &|row| row.rmse_px), 3))
                .join(" against "),
            choice(
                value("texture X, decomposed", &|row| row.rmse_px)
                    < 1.5 * value("texture X, true (optimal)", &|row| row.rmse_px),
            ),
            "within a half of it counts as near; the true texture has no noise",
        ),
        Line::new(
            "Table I",
            "Abs_Rel; RMSE (m); RMSE_log; delta_1 of texture X, thermal image, heat cube",
            "0.27, 0.61, -; 9.90, 22.96, -; 0.32, 1.24, -; 45 %, 7.7 %, - (TeX, IR)",
            [
                three(&depth(|d| d.abs_rel)),
                three(&depth(|d| d.rmse_m)),
                three(&depth(|d| d.rmse_log)),
                three(&depth(|d| d.delta[0])),
            ]
            .join("; "),
            Verdict::NotReproduced,
            "measured data and a trained network that are not to be had; natural logarithms",
        ),
        Line::new(
            "not in the paper",
            "median error of the disparity and its median bound, pixels: texture X, thermal image, heat cube",
            "-",
            format!("{}; {}", three(&|row| row.median_px), three(&bounds)),
            Verdict::NotInThePaper,
            "the median of a Gaussian error is 0.67 of its deviation; the cube holds the most information and no texture more",
        ),
        Line::new(
            "not in the paper",
            "equalising the thermal image before matching: share within one pixel, before and after",
            "-",
            ["thermal image", "thermal image, equalised, 256 levels"]
                .map(|image| significant(value(image, &within), 3))
                .join(", "),
            Verdict::NotInThePaper,
            "correlation takes gain and offset of a window away by itself",
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::filled;

    #[test]
    fn gaps_take_the_value_before_them() {
        let gap = f64::NAN;
        assert_eq!(filled(&[gap, 1.0, gap, gap, gap, 3.0], 3), [2.0, 1.0, 1.0, 2.0, 2.0, 3.0]);
        assert_eq!(filled(&[gap, gap], 2), [0.0, 0.0]);
    }
}
