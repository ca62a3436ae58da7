//! A destriped cube as files: the cube, what was taken out with its errors, pictures before and after.

pub use crate::words::calibrate::stripes::text;

use crate::bundle::Bundle;
use crate::cube_format::CubeFormat;
use crate::figures::Plot;
use crate::plot::{Axis, Picture, Pictures};
use crate::table::{Table, number};
use crate::words::calibrate::stripes::of_band;
use hadar::error::Result;
use hadar_estimate::calibrate::Why;
use hadar_formats::cube::npy_map;
use hadar_study::calibrate::{Samples, StripesFound};

/// Largest picture, pixels.
const WIDEST: usize = 420;
const HIGHEST: usize = 300;
/// Share of the samples beyond each end of the colours.
const CUT: f64 = 0.005;

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(result: &StripesFound, format: CubeFormat) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    // In the order of its file.
    let centres = result.read.centres_cm1.as_deref().unwrap_or_default();
    match &result.corrected {
        Samples::F32(samples) => format.add(&mut bundle, "destriped", result.shape, samples, centres)?,
        Samples::F64(samples) => format.add(&mut bundle, "destriped", result.shape, samples, centres)?,
    }
    bundle.add_table("stripes.csv", stripes(result))?;
    let found = &result.destriped;
    let size = [found.lines, found.bands];
    bundle.add("gain.npy", npy_map(&size, &found.map(1.0, |stripe| stripe.gain))?);
    bundle.add("gain_sigma.npy", npy_map(&size, &found.map(0.0, |stripe| stripe.sigma_gain))?);
    bundle.add("offset.npy", npy_map(&size, &found.map(0.0, |stripe| stripe.offset))?);
    bundle.add("offset_sigma.npy", npy_map(&size, &found.map(0.0, |stripe| stripe.sigma_offset))?);
    bundle.add(
        "sigma_common.npy",
        npy_map(&size, &found.map(0.0, |stripe| stripe.sigma_common(stripe.level)))?,
    );
    bundle.add_table("left.csv", left(result))?;
    bundle.add_table("limits.csv", limits(result))?;
    bundle.add_warnings(&result.warnings)?;
    bundle.add_plots(&[before_and_after(result)])?;
    Ok(bundle)
}

/// What is no clean line and was left.
fn left(result: &StripesFound) -> Table {
    let mut table = Table::new(["line", "band", "why", "off_at_level"]);
    for kept in &result.destriped.kept {
        let why = match kept.why {
            Why::InPart => "off in a part",
            Why::NeighbouringBands => "off in neighbouring bands",
            Why::BesideStep => "beside a step",
            Why::Dead => "one value",
            Why::WithoutReference => "no clean line near",
            Why::Missing => "no samples",
        };
        table.push(vec![kept.line.to_string(), kept.band.to_string(), why.to_owned(), number(kept.off)]);
    }
    table
}

/// What would have been seen of a line alone, and how all lines differ, of every band.
fn limits(result: &StripesFound) -> Table {
    let (found, mut table) = (
        &result.destriped,
        Table::new(["band", "offset_seen", "gain_seen", "lines_differ", "noise_explains"]),
    );
    for (band, (offset, gain)) in found.detectable.iter().zip(&found.detectable_gain).enumerate() {
        let apart = found.apart.get(band).copied().flatten();
        let apart = apart.map_or([f64::NAN; 2], |one| [one.lines, one.noise]);
        let numbers = [*offset, *gain, apart[0], apart[1]].map(number);
        table.push(std::iter::once(band.to_string()).chain(numbers).collect());
    }
    table
}

fn stripes(result: &StripesFound) -> Table {
    Table::of(
        &result.destriped.stripes,
        &[
            ("line", &|stripe| stripe.line.to_string()),
            ("band", &|stripe| stripe.band.to_string()),
            ("gain", &|stripe| number(stripe.gain)),
            ("gain_sigma", &|stripe| number(stripe.sigma_gain)),
            ("offset", &|stripe| number(stripe.offset)),
            ("offset_sigma", &|stripe| number(stripe.sigma_offset)),
            ("level", &|stripe| number(stripe.level)),
            ("off_at_level", &|stripe| number(stripe.off)),
            ("off_sigma", &|stripe| number(stripe.sigma)),
        ],
    )
}

/// The band of the most stripes, before, after, and what was taken out.
fn before_and_after(result: &StripesFound) -> Plot {
    let (rows, columns) = (result.shape.rows(), result.shape.columns());
    // A part of it, every line as it is: what is left out would hide stripes.
    let (high, wide) = (rows.min(HIGHEST), columns.min(WIDEST));
    let (top, left) = ((rows - high) / 2, (columns - wide) / 2);
    let (before, after) = (&result.before, result.after());
    let shown: Vec<(usize, usize)> =
        (top..top + high).flat_map(|row| (left..left + wide).map(move |column| (row, column))).collect();
    let take = |values: &[f64]| -> Vec<f64> {
        shown
            .iter()
            .map(|(row, column)| values.get(row * columns + column).copied().unwrap_or(f64::NAN))
            .collect()
    };
    let (before, after) = (take(before), take(&after));
    let taken: Vec<f64> = before.iter().zip(&after).map(|(a, b)| a - b).collect();
    let mut sorted: Vec<f64> = after.iter().copied().filter(|x| x.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let end = |share: f64| sorted.get((share * sorted.len().saturating_sub(1) as f64) as usize).copied();
    let ends = [end(CUT).unwrap_or(0.0), end(1.0 - CUT).unwrap_or(1.0)];
    let axis = || {
        let axis = Axis::linear("sample");
        if ends[0] < ends[1] { axis.range(ends[0], ends[1]) } else { axis }
    };
    let mut table = Table::new(["row", "column", "before", "after"]);
    for ((row, column), (before, after)) in shown.iter().zip(before.iter().zip(&after)) {
        table.push(vec![row.to_string(), column.to_string(), number(*before), number(*after)]);
    }
    let figure = Pictures::new(
        "A cube and its stripes",
        vec![
            Picture::new("before", axis(), wide, before),
            Picture::new("after", axis(), wide, after),
            Picture::new("taken out", Axis::linear("sample"), wide, taken),
        ],
    )
    .subtitle(of_band(result.shown_band, [high, wide], [rows, columns]))
    .no_value("no sample");
    Plot { name: "before_and_after".into(), figure: figure.into(), table }
}
