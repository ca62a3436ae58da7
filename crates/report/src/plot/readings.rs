//! What can be read off a figure in a browser: where its panels are, their axes, and the numbers in them.
//!
//! An SVG file carries this as JSON in its `<metadata>`, which no viewer shows; `html/readings.js` reads it in a page. Numbers have four
//! digits, one more than is printed. Sides of a panel (left, top, right, bottom) are in logical pixels; an axis is its title, whether it is
//! logarithmic, and its first and last value on that scale; a series has its name, its positions, its values, and whether it may be read
//! between them. A curve of more points than [`MOST_POINTS`] is thinned, a map of more cells than [`MOST_CELLS`]
//! has none.

use super::axis::{Ruler, Scale};
use super::text;
use serde_json::{Value, json};

const MOST_POINTS: usize = 600;
const MOST_CELLS: usize = 5000;

/// A panel whose numbers can be read off.
#[derive(Debug, Clone)]
pub(super) struct Readable(Value);

impl Readable {
    /// Series by name over a horizontal axis, and whether a line joins their points.
    pub(super) fn curves<'a>(
        sides: [f64; 4],
        [x, y]: [(&str, &Ruler); 2],
        curves: impl Iterator<Item = (&'a str, [&'a [f64]; 2], bool)>,
    ) -> Self {
        let curves = curves.map(|(name, [x, y], is_line)| {
            let step = x.len().div_ceil(MOST_POINTS).max(1);
            let thinned =
                |values: &[f64]| -> Vec<Value> { values.iter().step_by(step).map(rounded).collect() };
            // Between points that were left out a line may go anywhere.
            json!([text::clean(name), thinned(x), thinned(y), is_line && step == 1])
        });
        Self(
            json!({ "at": sides.map(|side| digits(side, 5)), "x": axis(x), "y": axis(y), "curves": curves.collect::<Vec<_>>() }),
        )
    }

    /// A quantity over a plane, row after row; `None` where there are too many cells.
    pub(super) fn cells(
        sides: [f64; 4],
        [x, y]: [(&str, &Ruler, &[f64]); 2],
        (name, values): (&str, &[f64]),
    ) -> Option<Self> {
        let all = |values: &[f64]| values.iter().map(rounded).collect::<Vec<_>>();
        (values.len() <= MOST_CELLS).then(|| {
            Self(json!({
                "at": sides.map(|side| digits(side, 5)), "x": axis((x.0, x.1)), "y": axis((y.0, y.1)),
                "columns": all(x.2), "rows": all(y.2), "name": text::clean(name), "values": all(values),
            }))
        })
    }

    /// Values of named rows, the first at the top, by series.
    pub(super) fn rows<'a>(
        sides: [f64; 4],
        x: (&str, &Ruler),
        names: &[String],
        series: impl Iterator<Item = (&'a str, &'a [f64])>,
    ) -> Self {
        let series = series.map(|(label, values)| {
            json!([text::clean(label), values.iter().map(rounded).collect::<Vec<_>>()])
        });
        let names: Vec<String> = names.iter().map(|name| text::clean(name)).collect();
        Self(
            json!({ "at": sides.map(|side| digits(side, 5)), "x": axis(x), "names": names, "series": series.collect::<Vec<_>>() }),
        )
    }
}

/// All panels as an element of an SVG document; nothing of none.
pub(super) fn element(panels: &[Readable]) -> String {
    if panels.is_empty() {
        return String::new();
    }
    let text = Value::from_iter(panels.iter().map(|panel| panel.0.clone())).to_string();
    // Signs of markup stand only within the strings of JSON.
    let text = text.replace('&', "\\u0026").replace('<', "\\u003c").replace('>', "\\u003e");
    format!("<metadata>{text}</metadata>\n")
}

fn axis((title, ruler): (&str, &Ruler)) -> Value {
    let ends = [ruler.first, ruler.last].map(|end| digits(end, 6));
    json!([text::clean(title), ruler.scale == Scale::Log, ends[0], ends[1]])
}

/// With four digits; what has no number is `null`.
fn rounded(value: &f64) -> Value {
    digits(*value, 4)
}

fn digits(value: f64, digits: usize) -> Value {
    let rounded = format!("{value:.*e}", digits - 1).parse::<f64>().ok().filter(|value| value.is_finite());
    match rounded {
        // Whole numbers without a point are shorter.
        Some(value) if value.fract() == 0.0 && value.abs() < 1e9 => json!(value as i64),
        Some(value) => json!(value),
        None => Value::Null,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_says_where_it_is_and_what_is_in_it() {
        let area = [10.0, 20.0, 110.0, 70.5];
        let x = Ruler::fit(Scale::Log, Some((1.0, 1000.0)), std::iter::empty(), 0.0);
        let y = Ruler::fit(Scale::Linear, Some((0.0, 0.5)), std::iter::empty(), 0.0);
        let curve = ("a <b>", [&[1.0, 12_345.678][..], &[f64::INFINITY, 0.123_456]], true);
        let panel = Readable::curves(area, [("photons", &x), ("bits", &y)], std::iter::once(curve));
        assert_eq!(
            element(&[panel]),
            "<metadata>[{\"at\":[10,20,110,70.5],\"curves\":[[\"a \\u003cb\\u003e\",[1,12350],[null,0.1235],true]],\
             \"x\":[\"photons\",true,0,3],\"y\":[\"bits\",false,0,0.5]}]</metadata>\n"
        );
    }

    #[test]
    fn long_curves_are_thinned_and_large_maps_have_none() {
        let area = [0.0, 0.0, 1.0, 1.0];
        let ruler = Ruler::fit(Scale::Linear, Some((0.0, 1.0)), std::iter::empty(), 0.0);
        let long: Vec<f64> = (0..10_000).map(f64::from).collect();
        let axes = [("x", &ruler), ("y", &ruler)];
        let made = Readable::curves(area, axes, std::iter::once(("a", [&long[..], &long], true)));
        assert!(
            made.0["curves"][0][1].as_array().is_some_and(|kept| (300..=MOST_POINTS).contains(&kept.len()))
        );
        assert_eq!(made.0["curves"][0][3], false);
        let places = [("x", &ruler, long.as_slice()), ("y", &ruler, &[1.0][..])];
        assert!(Readable::cells(area, places, ("z", &long)).is_none());
    }
}
