//! A ranging study in words: the answer, the bounds, what would have to change, what it rests on.

use crate::text::footing::{read_as, warnings};
use crate::words::Say;
use hadar::ranging::depth::DepthSolution as Solution;
use hadar::ranging::derivative::Derivative;
use hadar::words::{self, quantity, share as percent, significant};
use hadar_scenario::range::{Diffraction, Subject};
use hadar_study::range::{ObjectBounds, Ranging, Signal, SignalBounds};
use std::fmt::Write as _;

/// The whole answer.
#[must_use]
pub fn text(result: &Ranging) -> String {
    let mut out = format!("{}\n\n", result.verdict.sentence.say());
    out.extend(result.read.as_ref().map(read_as));
    out.push_str(&bounds(result));
    out.push_str(&cells(result));
    out.push_str(&changes(result));
    out.push_str(&witnesses(result));
    out.push_str(&assumptions(result));
    out.push_str(&warnings(&result.warnings));
    out
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
        "{what}, median over windows of {} x {} pixels (share of them that reach the demand; none: error above the depth itself)\n",
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
    let _ = write!(out, "  {:first$}  {:>8}", "", "windows");
    for (signal, width) in signals.iter().zip(&widths) {
        let _ = write!(out, "  {:>width$}", signal.name());
    }
    out.push('\n');
    for (object, name) in result.objects.iter().zip(&names) {
        let _ = write!(out, "  {name:first$}  {:>8}", object.windows);
        for (found, width) in object.signals.iter().zip(&widths) {
            let _ = write!(out, "  {:>width$}", cell(found));
        }
        out.push('\n');
    }
    if let Some(all) = result.objects.first() {
        for (label, value) in [
            (
                "information of a window, pixel^-2",
                &(|found: &SignalBounds| found.information_per_px2) as &dyn Fn(&SignalBounds) -> f64,
            ),
            ("photons of a window", &|found: &SignalBounds| found.photons),
            ("noise over shot noise (gamma)", &|found: &SignalBounds| found.gamma),
            ("sigma_c of one photon, pixels", &|found: &SignalBounds| found.sigma_correspondence_px),
            ("least disparity error, pixels", &|found: &SignalBounds| found.disparity_error_px),
        ] {
            let _ = write!(out, "  {label:width$}", width = first + 10);
            for (found, width) in all.signals.iter().zip(&widths) {
                let _ = write!(out, "  {:>width$}", finite(value(found)));
            }
            out.push('\n');
        }
        if all.signals.iter().any(|found| found.largest_depth_m.is_some()) && depth {
            let share = 100.0 * result.scenario.requirement.share;
            let _ = write!(
                out,
                "  {:width$}",
                format!("depth to which {share} % do, as seen"),
                width = first + 10
            );
            for (found, width) in all.signals.iter().zip(&widths) {
                let shown = found.largest_depth_m.map_or("-".into(), length);
                let _ = write!(out, "  {shown:>width$}");
            }
            out.push('\n');
        }
    }
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
    let rows = [("bands together", cells.total, cells.spatial), ("bands apart", cells.spectral, cells.full)];
    let _ = writeln!(out, "  {:14}  {:>17}  {:>12}", "", "pixels together", "pixels apart");
    for (label, joined, apart) in rows {
        let _ = writeln!(out, "  {label:14}  {:>17}  {:>12}", finite(joined), finite(apart));
    }
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
        "What would just meet it, by the {}: {share} % of the windows that are seen now within the demand\n",
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
        "  {}\n",
        format_args!(
            "exposure, aperture and noise for the window that decides, at row {}, column {}, {} away; another exposure needs \
             noise_exposure beside it, else its noise is taken to be stated there",
            solve.pixel[0],
            solve.pixel[1],
            length(solve.depth_m)
        )
    );
    out
}

/// Matching against the bound.
fn witnesses(result: &Ranging) -> String {
    let mut out = String::new();
    let witnessed: Vec<_> = result.lines.iter().filter(|line| line.method.is_some()).collect();
    if !witnessed.is_empty() {
        out.push_str("Matching against the bound without diffraction, median over the windows of a line\n");
        let _ = writeln!(
            out,
            "  {:>4}  {:26} {:18} {:>10} {:>10} {:>10} {:>14} {:>9}",
            "row", "signal", "method", "bound", "rmse", "|bias|", "scatter/bound", "outliers"
        );
        for line in witnessed {
            let middle = |values: &[f64]| hadar_study::range::median(values);
            let sizes: Vec<f64> = line.bias_m.iter().map(|bias| bias.abs()).collect();
            let _ = writeln!(
                out,
                "  {:>4}  {:26} {:18} {:>10} {:>10} {:>10} {:>14} {:>9}",
                line.row,
                line.signal.name(),
                line.method.unwrap_or_default(),
                length(middle(&line.bound_without_diffraction_m)),
                length(middle(&line.rmse_m)),
                length(middle(&sizes)),
                line.scatter_over_bound.map_or("-".into(), |ratio| significant(ratio, 2)),
                percent(line.outliers.iter().sum::<f64>() / line.outliers.len().max(1) as f64)
            );
        }
        out.push_str(
            "  bias: pixel locking, and disparity that changes within a window (a road does from row to row: try window = [1, 25]); it does not \
             shrink with more light. Where most matches are outliers the bound is out of reach: noise has more texture than the image\n\n",
        );
    }
    if !result.matched.is_empty() {
        out.push_str("Whole view matched once, block matching (standard depth metrics)\n");
        let _ = writeln!(
            out,
            "  {:26} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>9}",
            "signal", "Abs_Rel", "Sq_Rel m", "RMSE m", "RMSE_log", "d1", "d2", "d3", "pixels"
        );
        for matched in &result.matched {
            let metrics = &matched.metrics;
            let _ = writeln!(
                out,
                "  {:26} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>9}",
                matched.signal.name(),
                significant(metrics.abs_rel, 3),
                significant(metrics.sq_rel_m, 3),
                significant(metrics.rmse_m, 3),
                significant(metrics.rmse_log, 3),
                percent(metrics.delta[0]),
                percent(metrics.delta[1]),
                percent(metrics.delta[2]),
                metrics.used
            );
        }
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
