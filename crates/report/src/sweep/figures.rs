//! Pictures of a sweep: a curve over one key, a heat map over two.

use super::over::{Over, over};
use super::swept::Swept;
use crate::figures::Plot;
use crate::plot::{Axis, HeatMap, LineFigure, Series, Style};
use crate::table::Table;
use crate::words::sweep::interpolated;
use hadar::order;
use hadar_study::sweep::{Cell, Input};

/// Most pictures.
const MOST_PICTURES: usize = 12;
/// Values that spread over more than this are shown on a logarithmic scale.
const WIDE: f64 = 100.0;
/// Units as results have them in their names, the longer ones first.
const UNITS: [(&str, &str); 14] = [
    ("_m2_sr", "m² sr"),
    ("_m2_s", "m² s"),
    ("_m_s", "m s⁻¹"),
    ("_cm1", "cm⁻¹"),
    ("_bits", "bit"),
    ("_px2", "px²"),
    ("_px", "px"),
    ("_hz", "Hz"),
    ("_rad", "rad"),
    ("_um", "µm"),
    ("_mm", "mm"),
    ("_k", "K"),
    ("_m", "m"),
    ("_s", "s"),
];

/// The pictures of a sweep over one or two keys, one for each column of numbers that is drawn.
pub(super) fn plots(swept: &Swept) -> Vec<Plot> {
    let gathered = &swept.gathered;
    let Ok(over) = over(swept) else { return Vec::new() };
    let drawn = swept.drawn();
    let values = drawn.iter().filter_map(|name| {
        let cells = gathered.values(name)?;
        let numbers: Vec<f64> = cells.iter().map(|cell| cell.number().unwrap_or(f64::NAN)).collect();
        // What is the same in all rows is no picture.
        let mut finite = numbers.iter().filter(|number| number.is_finite());
        let first = finite.next()?;
        let changes = finite.any(|number| number != first);
        changes.then_some((*name, numbers))
    });
    let plot = |(name, values): (&str, Vec<f64>)| match over {
        Over::One(x) => curves(name, &values, x, None),
        Over::OneForEach(x, other) => curves(name, &values, x, Some(other)),
        Over::Two(x, y) => map(name, &values, x, y),
    };
    values.take(MOST_PICTURES).filter_map(plot).collect()
}

/// Positions along an axis and the index of each, rising.
fn positions(input: &Input) -> Vec<(usize, f64)> {
    let mut found: Vec<(usize, f64)> =
        input.cells.iter().enumerate().filter_map(|(i, cell)| Some((i, cell.number()?))).collect();
    order::ascending(&mut found, |a| a.1);
    found
}

fn axis(input: &Input) -> Axis {
    let title = match input.unit.as_str() {
        "" => input.key.clone(),
        "degC" => format!("{} (°C)", input.key),
        unit => format!("{} ({unit})", input.key),
    };
    let axis = if input.logarithmic { Axis::log(title) } else { Axis::linear(title) };
    // Nothing is known beyond the first and the last value.
    match positions(input).as_slice() {
        [(_, first), .., (_, last)] => axis.range(*first, *last),
        _ => axis,
    }
}

/// The scale of a result, logarithmic where it spreads over orders of magnitude.
fn scale(name: &str, values: &[f64]) -> Axis {
    let found = UNITS.iter().find_map(|(ending, unit)| Some((name.strip_suffix(ending)?, unit)));
    let title = found.map_or_else(|| name.to_owned(), |(name, unit)| format!("{name} ({unit})"));
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    if low > 0.0 && high > WIDE * low { Axis::log(title) } else { Axis::linear(title) }
}

fn file_name(kind: &str, name: &str) -> String {
    let plain: String =
        name.chars().map(|char| if char.is_ascii_alphanumeric() { char } else { '_' }).collect();
    format!("{kind}_{}", plain.trim_matches('_'))
}

/// A result over two keys.
fn map(name: &str, values: &[f64], x: &Input, y: &Input) -> Option<Plot> {
    let (columns, rows) = (positions(x), positions(y));
    let mut table = Table::new([x.name.as_str(), y.name.as_str(), name]);
    let mut cells = vec![f64::NAN; columns.len() * rows.len()];
    for (row, value) in values.iter().enumerate() {
        let at = |found: &[(usize, f64)], index: usize| found.iter().position(|(own, _)| *own == index);
        let (column, line) = (at(&columns, x.index(row))?, at(&rows, y.index(row))?);
        *cells.get_mut(line * columns.len() + column)? = *value;
    }
    for (line, (_, y)) in rows.iter().enumerate() {
        for (column, (_, x)) in columns.iter().enumerate() {
            table.push_numbers(&[*x, *y, cells.get(line * columns.len() + column).copied()?]);
        }
    }
    let of = |found: &[(usize, f64)]| found.iter().map(|(_, at)| *at).collect::<Vec<_>>();
    let figure = HeatMap::new(
        format!("{name} over {} and {}", x.key, y.key),
        (axis(x), of(&columns)),
        (axis(y), of(&rows)),
        (scale(name, &cells), cells.clone()),
    );
    // A margin of 1 is what is demanded.
    let contours = if name.ends_with("margin") { vec![1.0] } else { Vec::new() };
    let figure = figure
        .subtitle(interpolated(columns.len(), rows.len()))
        .no_value("no value, or the row failed")
        .contours(contours);
    Some(Plot { name: file_name("map", name).into(), figure: figure.into(), table })
}

/// A result over one key, a curve for each value of another one.
fn curves(name: &str, values: &[f64], x: &Input, other: Option<&Input>) -> Option<Plot> {
    let count = other.map_or(1, |input| input.cells.len());
    let along = positions(x);
    let heads = [Some(x.name.as_str()), other.map(|input| input.name.as_str()), Some(name)];
    let mut table = Table::new(heads.into_iter().flatten());
    let mut figure = LineFigure::new(
        match other {
            Some(other) => format!("{name} over {}, for each {}", x.key, other.key),
            None => format!("{name} over {}", x.key),
        },
        axis(x),
        scale(name, values),
    );
    for curve in 0..count {
        let mut found = vec![f64::NAN; x.cells.len()];
        for (row, value) in values.iter().enumerate() {
            if other.is_none_or(|other| other.index(row) == curve) {
                *found.get_mut(x.index(row))? = *value;
            }
        }
        let label = match other {
            Some(other) => said(other, curve),
            None => String::new(),
        };
        let points: Vec<(f64, f64)> =
            along.iter().filter_map(|(i, at)| Some((*at, *found.get(*i)?))).collect();
        for (at, value) in &points {
            let numbers = [*at, *value].map(crate::table::number);
            let [at, value] = numbers;
            table.push(if other.is_some() { vec![at, label.clone(), value] } else { vec![at, value] });
        }
        let (at, value) = points.into_iter().unzip();
        figure = figure.series(Series::line(label, at, value).style(Style::Marked));
    }
    Some(Plot { name: file_name("curve", name).into(), figure: figure.into(), table })
}

/// A value of a key as a legend says it.
fn said(input: &Input, index: usize) -> String {
    let cell = input.cells.get(index).cloned().unwrap_or_default();
    match (&cell, input.unit.as_str()) {
        (Cell::Empty, _) => "as in the file".to_owned(),
        (_, "") => crate::parquet::text(&cell),
        (_, unit) => format!("{} {unit}", crate::parquet::text(&cell)),
    }
}
