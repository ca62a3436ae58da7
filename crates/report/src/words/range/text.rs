//! A ranging study in words: the answer, the bounds, what would have to change, what it rests on.

use crate::text::columns::{Columns, left, right};
use crate::text::footing::{read_as, warnings};
use crate::words::{Say, conditions};
use hadar::ranging::depth::DepthSolution as Solution;
use hadar::ranging::derivative::Derivative;
use hadar::words::{self, quantity, share as percent, significant};
use hadar_scenario::range::{Diffraction, Subject};
use hadar_study::range::{DepthVerdict, ObjectBounds, Ranging, Signal, SignalBounds};
use std::fmt::Write as _;

/// The whole answer.
#[must_use]
pub fn text(result: &Ranging) -> String {
    let mut out = verdict(&result.verdict);
    out.extend(result.read.as_ref().map(read_as));
    out.push_str(&bounds(result));
    out.push_str(&cells(result));
    out.push_str(&changes(result));
    out.push_str(&witnesses(result));
    out.push_str(&assumptions(result));
    out.push_str(&warnings(&result.warnings));
    out
}

/// The verdict with what it rests on.
#[must_use]
pub fn verdict(verdict: &DepthVerdict) -> String {
    format!("{}\n\n", verdict.sentence.say())
        + &conditions::paragraph(&verdict.conditions, verdict.met == Some(true))
}

/// A disparity error beyond any image, pixels.
const BEYOND: f64 = 1e20;

/// Medians by object and signal.
fn bounds(result: &Ranging) -> String {
    if result.objects.is_empty() {
        return String::new();
    }
    let window = result.scenario.stereo.window;
    let depth = result.objects.iter().any(|object| object.depth_m.is_some());
    let what = if depth { "Least depth error" } else { "Least disparity error" };
    let mut out = format!(
        "{what}, median over windows of {} x {} pixels (share of them that meet the requirement; none: error above the depth itself)\n",
        window.rows(),
        window.columns()
    );
    let signals: Vec<Signal> = result
        .objects
        .first()
        .map_or_else(Vec::new, |all| all.signals.iter().map(|found| found.signal).collect());
    let name = |object: &ObjectBounds| match object.depth_m {
        Some([low, _, high]) if significant(low, 3) == significant(high, 3) => {
            format!("{}, {} m", object.name, significant(low, 3))
        }
        Some([low, _, high]) => {
            format!("{}, {} to {} m", object.name, significant(low, 2), significant(high, 2))
        }
        None => object.name.clone(),
    };
    let names: Vec<String> = result.objects.iter().map(name).collect();
    let first = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(6);
    let widths: Vec<usize> = signals.iter().map(|signal| signal.name().len().max(18)).collect();
    let heads = || signals.iter().zip(&widths).map(|(signal, width)| right(signal.name(), *width));
    let mut table = Columns::new([left("", first), right("windows", 8)].into_iter().chain(heads()));
    for (object, name) in result.objects.iter().zip(names) {
        let start = [name, object.windows.to_string()];
        table.row(start.into_iter().chain(object.signals.iter().map(cell)));
    }
    out.push_str(&table.text());
    let Some(all) = result.objects.first() else { return out + "\n" };
    let mut table = Columns::headless(std::iter::once(left("", first + 10)).chain(heads()));
    let mut line = |label: String, value: &dyn Fn(&SignalBounds) -> String| {
        table.row(std::iter::once(label).chain(all.signals.iter().map(value)));
    };
    line("information of a window, pixel^-2".into(), &|found| finite(found.information_per_px2));
    line("photons of a window".into(), &|found| finite(found.photons));
    line("noise over shot noise (gamma)".into(), &|found| finite(found.gamma));
    line("sigma_c of one photon, pixels".into(), &|found| finite(found.sigma_correspondence_px));
    line("least disparity error, pixels".into(), &|found| finite(found.disparity_error_px));
    if all.signals.iter().any(|found| found.largest_depth_m.is_some()) && depth {
        let share = 100.0 * result.scenario.requirement.share;
        let label = format!("depth up to which {share} % meet it");
        line(label, &|found| found.largest_depth_m.map_or("-".into(), length));
    }
    out.push_str(&table.text());
    out.push('\n');
    out
}

fn cell(found: &SignalBounds) -> String {
    match (found.depth_error_m, found.share) {
        (Some([_, median, _]), Some(share)) => {
            // Beyond the depth itself the linear law of errors means nothing.
            let beyond = found.relative_depth_error.is_some_and(|relative| relative > 1.0);
            let shown = if beyond { "none".to_owned() } else { length(median) };
            format!("{shown} ({})", percent(share))
        }
        _ => format!("{} px", finite(found.disparity_error_px)),
    }
}

fn finite(value: f64) -> String {
    if value.is_infinite() || value > BEYOND {
        "no texture".into()
    } else if value.is_nan() {
        "-".into()
    } else {
        significant(value, 2)
    }
}

fn length(metres: f64) -> String {
    if metres.is_infinite() { "no texture".into() } else { words::length(metres) }
}

fn cells(result: &Ranging) -> String {
    let Some(cells) = result.cells else { return String::new() };
    let mut out =
        String::from("Information of a window with and without resolution, median, pixel^-2 (Table S4)\n");
    let rows = [("bands summed", cells.total, cells.spatial), ("bands resolved", cells.spectral, cells.full)];
    let mut table = Columns::new([left("", 14), right("pixels summed", 17), right("pixels resolved", 12)]);
    for (label, joined, apart) in rows {
        table.row([label.to_owned(), finite(joined), finite(apart)]);
    }
    out.push_str(&table.text());
    if let Some(other) = cells.other_derivative {
        let _ = writeln!(
            out,
            "  {} give {} times as much of the last (in use: {}): what lies between is uncertain",
            if result.scenario.stereo.derivative == Derivative::Central {
                "cubic splines"
            } else {
                "central differences, blind to the finest texture,"
            },
            significant(other, 2),
            result.scenario.stereo.derivative.name()
        );
    }
    out.push('\n');
    out
}

/// What would have to change.
fn changes(result: &Ranging) -> String {
    let Some(solve) = &result.solve_for else { return String::new() };
    let share = 100.0 * result.scenario.requirement.share;
    let mut out = format!(
        "Values that just meet the requirement, by the {}: {share} % of the windows within the demand\n",
        solve.signal.name()
    );
    let mut line = |label: &str, solution: &Solution, shown: &dyn Fn(f64) -> String| {
        let camera = shown(solution.camera);
        let value = match (&solution.value, &solution.reason) {
            (Some(value), _) => format!("{} (now {camera})", shown(*value)),
            (None, Some(reason)) => format!("none: {reason} (now {camera})"),
            (None, None) => format!("none (now {camera})"),
        };
        let _ = writeln!(out, "  {label:18} {value}");
    };
    line("baseline", &solve.baseline_m, &|value| {
        let wider = value > solve.baseline_m.camera;
        format!(
            "{}{}",
            quantity(value, "m"),
            if wider { ", fewer windows are seen by both then" } else { "" }
        )
    });
    if let Some(solution) = &solve.exposure_s {
        line("exposure", solution, &|value| quantity(value, "s"));
    }
    if let Some(solution) = &solve.aperture_m {
        line("aperture", solution, &|value| quantity(value, "m"));
    }
    if let Some(solution) = &solve.noise_counts {
        line("noise, all frames", solution, &|value| format!("{} counts", significant(value, 3)));
    }
    let _ = writeln!(
        out,
        "  each with the other figures unchanged, for all windows together; the deciding window is at row {}, column {}, {} away; \
         another exposure needs noise_exposure as well, else its noise is taken to be stated there\n",
        solve.pixel[0],
        solve.pixel[1],
        length(solve.depth_m)
    );
    out
}

/// Matching against the bound.
fn witnesses(result: &Ranging) -> String {
    let mut out = String::new();
    let witnessed: Vec<_> = result.lines.iter().filter(|line| line.method.is_some()).collect();
    if !witnessed.is_empty() {
        out.push_str("Matching against the bound without diffraction, median over the windows of a line\n");
        let mut table = Columns::narrow([
            right("row", 4),
            left("", 0),
            left("signal", 26),
            left("method", 18),
            right("bound", 10),
            right("rmse", 10),
            right("|bias|", 10),
            right("scatter/bound", 14),
            right("outliers", 9),
        ]);
        for line in witnessed {
            let middle = |values: &[f64]| length(hadar_study::range::median(values));
            let sizes: Vec<f64> = line.bias_m.iter().map(|bias| bias.abs()).collect();
            table.row([
                line.row.to_string(),
                String::new(),
                line.signal.name().to_owned(),
                line.method.unwrap_or_default().to_owned(),
                middle(&line.bound_without_diffraction_m),
                middle(&line.rmse_m),
                middle(&sizes),
                line.scatter_over_bound.map_or("-".into(), |ratio| significant(ratio, 2)),
                percent(line.outliers.iter().sum::<f64>() / line.outliers.len().max(1) as f64),
            ]);
        }
        out.push_str(&table.text());
        out.push_str(
            "  bias: pixel locking, and disparity that changes within a window (a road does from row to row: try window = [1, 25]); it does not \
             shrink with more light. Where most matches are outliers the bound is out of reach: noise has more texture than the image\n\n",
        );
    }
    if !result.matched.is_empty() {
        out.push_str("Whole view matched once, block matching (standard depth metrics)\n");
        let heads = ["Abs_Rel", "Sq_Rel m", "RMSE m", "RMSE_log"].map(|head| right(head, 9));
        let shares = ["d1", "d2", "d3"].map(|head| right(head, 8));
        let all = std::iter::once(left("signal", 26)).chain(heads).chain(shares);
        let mut table = Columns::narrow(all.chain([right("pixels", 9)]));
        for matched in &result.matched {
            let metrics = &matched.metrics;
            let errors = [metrics.abs_rel, metrics.sq_rel_m, metrics.rmse_m, metrics.rmse_log];
            let cells = std::iter::once(matched.signal.name().to_owned());
            let cells = cells.chain(errors.map(|error| significant(error, 3)));
            table.row(cells.chain(metrics.delta.map(percent)).chain([metrics.used.to_string()]));
        }
        out.push_str(&table.text());
        out.push('\n');
    }
    out
}

fn assumptions(result: &Ranging) -> String {
    let geometry = &result.geometry;
    let stereo = &result.scenario.stereo;
    let mut out = String::from("Assumptions\n");
    let _ = writeln!(
        out,
        "  parallel, calibrated cameras {} apart, focal length {}, pixels of {} (1 pixel of disparity is {} at 10 m); \
         cameras that turn towards each other are not treated",
        quantity(geometry.baseline_m, "m"),
        quantity(geometry.focal_length_m, "m"),
        quantity(geometry.pixel_m, "m"),
        length(geometry.depth_error_per_px_at_10_m)
    );
    let _ = writeln!(
        out,
        "  bounds of unbiased estimates: a matcher with a bias (smoothing, a prior) can have a smaller error; derivative along x: {}",
        stereo.derivative.name()
    );
    if let Some(error) = result.quantile_error {
        let _ = writeln!(
            out,
            "  too many windows to keep: medians and quantiles are counted in steps, to within {} of their value; shares and maps are exact",
            significant(error, 2)
        );
    }
    if let Some([row, column]) = result.maps_begin_at {
        let _ = writeln!(
            out,
            "  maps have a value for every centre of a whole window: their first is at row {row}, column {column} of the view, counted from 0"
        );
    }
    match stereo.diffraction {
        Diffraction::None => out.push_str("  diffraction is in the image already, none is added\n"),
        Diffraction::Airy | Diffraction::Gaussian(_) => {
            let _ = writeln!(
                out,
                "  the image is an ideal one; diffraction and pixel leave the position of a photon uncertain by {} pixels more",
                significant(geometry.sigma_diffraction_px, 2)
            );
        }
    }
    if matches!(result.scenario.subject, Subject::Scene(_)) {
        out.push_str(
            "  heat cube: no algorithm does better with these readings\n  cube, T estimated: temperature unknown in every pixel and \
             estimated from the bands; T and e: strength of the emission too, which leaves the scattered light as it can be \
             reconstructed\n  scattered, as if measured: the paper's reading, with the noise of the scattered photons alone; no camera \
             measures it, and where it promises more than the heat cube nobody reaches it\n",
        );
    } else {
        out.push_str(
            "  the counts are taken for expectations: their own noise adds texture that is not there, and the bound comes out too small\n",
        );
    }
    out
}
