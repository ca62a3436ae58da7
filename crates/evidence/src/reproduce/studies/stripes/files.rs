//! The table and the figures.

use super::measure::{Row, SOUGHT};
use super::twin::{BANDS, COLUMNS, ROWS, Twin};
use hadar::error::Result;
use hadar_estimate::calibrate::find_stripes;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Picture, Pictures, Series, Style};
use hadar_report::table::{Table, number};

pub(super) fn table(rows: &[Row]) -> Table {
    let mut table = Table::new([
        "share_striped",
        "stripes",
        "found",
        "found_wrongly",
        "intervals_hold",
        "off_relative_before",
        "off_relative_after",
        "information_along_unknown",
        "information_along_destriped",
        "information_along_all_lines_unknown",
        "information_across_unknown",
        "information_across_destriped",
        "information_across_all_lines_unknown",
        "position_along_error_clean",
        "position_along_error_striped",
        "position_along_error_destriped",
        "position_across_error_clean",
        "position_across_error_striped",
        "position_across_error_destriped",
        "temperature_bound_clean_k",
        "temperature_bound_unknown_k",
        "temperature_bound_destriped_k",
        "temperature_error_clean_k",
        "temperature_error_striped_k",
        "temperature_error_destriped_k",
    ]);
    for row in rows {
        let mut cells = vec![
            number(row.share),
            row.put.to_string(),
            row.found.to_string(),
            row.wrong.to_string(),
            number(row.held),
        ];
        let mut add = |values: &[f64]| cells.extend(values.iter().map(|value| number(*value)));
        add(&row.off);
        for axis in 0..2 {
            add(&[row.unknown[axis], row.destriped[axis], row.all_unknown[axis]]);
        }
        row.position.iter().for_each(|errors| add(errors));
        add(&row.temperature_bound_k);
        add(&row.temperature_k);
        table.push(cells);
    }
    table
}

/// Errors over the clean bound, over the share of striped lines.
pub(super) fn information(rows: &[Row]) -> Plot {
    let x: Vec<f64> = rows.iter().map(|row| 100.0 * row.share).collect();
    let of = |value: &dyn Fn(&Row) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    let clean = |row: &Row| row.temperature_bound_k[0];
    let curves = [
        ("position along lines, striped", of(&|row| row.position[0][1]), 0, Style::Marked),
        ("position across lines, striped", of(&|row| row.position[1][1]), 1, Style::Marked),
        ("temperature, striped", of(&|row| row.temperature_k[1] / clean(row)), 2, Style::Marked),
        ("position along, destriped", of(&|row| row.position[0][2]), 3, Style::Marked),
        ("position across, destriped", of(&|row| row.position[1][2]), 4, Style::Marked),
        ("temperature, destriped", of(&|row| row.temperature_k[2] / clean(row)), 5, Style::Marked),
        (
            "bound of temperature, unknown lines",
            of(&|row| row.temperature_bound_k[1] / clean(row)),
            2,
            Style::Dashed,
        ),
        (
            "bound of temperature, destriped",
            of(&|row| row.temperature_bound_k[2] / clean(row)),
            5,
            Style::Dashed,
        ),
    ];
    let mut table = Table::new(std::iter::once("share_percent").chain(curves.iter().map(|curve| curve.0)));
    for (i, share) in x.iter().enumerate() {
        table
            .push(std::iter::once(*share).chain(curves.iter().map(|curve| curve.1[i])).map(number).collect());
    }
    let mut figure = LineFigure::new(
        "Errors in a striped cube and in a destriped one, over the bound of a clean one",
        Axis::linear("striped lines (% of the lines of each band)"),
        Axis::log("error / bound of a clean cube"),
    )
    .subtitle(
        "Gains off by 2 %, offsets by 1 % of the level (rms). Windows of 15 × 15 pixels; a pixel's temperature from all bands. Dashed: bounds.",
    );
    for (label, y, colour, style) in curves {
        figure = figure.series(Series::line(label, x.clone(), y).colour(colour).style(style));
    }
    Plot { name: "errors".into(), figure: figure.into(), table }
}

/// A band before and after, and what a pixel's temperature is off by in both.
pub(super) fn pictures(twin: &Twin, share: f64, seed: u64) -> Result<Plot> {
    let clean = twin.drawn(seed, 1 << 32)?;
    let (samples, _) = twin.striped(&clean, share, seed, (1 << 32) + 1);
    let cube = twin.cube(samples.clone())?;
    let corrected = find_stripes(&cube, &SOUGHT)?.corrected(&cube)?;
    let band = BANDS / 2;
    let of_band =
        |samples: &[f64]| -> Vec<f64> { samples.iter().skip(band).step_by(BANDS).copied().collect() };
    let off_k = |samples: &[f64]| -> Vec<f64> {
        let pixel = |pixel: usize| {
            let (mut score, mut whole) = (0.0, 0.0);
            let own = samples.iter().enumerate().skip(pixel * BANDS).take(BANDS);
            for (i, sample) in own {
                let weight = twin.per_kelvin[i] / twin.var(i);
                score += weight * (sample - twin.mean[i]);
                whole += weight * twin.per_kelvin[i];
            }
            score / whole
        };
        (0..ROWS * COLUMNS).map(pixel).collect()
    };
    let layers = [of_band(&samples), of_band(&corrected), off_k(&samples), off_k(&corrected)];
    let mut table = Table::new(["row", "column", "before", "after", "off_before_k", "off_after_k"]);
    for i in
        (0..ROWS * COLUMNS).filter(|i| (i % COLUMNS).is_multiple_of(8) && (i / COLUMNS).is_multiple_of(2))
    {
        let values = layers.iter().map(|layer| number(layer[i]));
        table
            .push([(i / COLUMNS).to_string(), (i % COLUMNS).to_string()].into_iter().chain(values).collect());
    }
    let [before, after, off_before, off_after] = layers;
    let counts = || Axis::linear("counts").range(0.6e5, 1.35e5);
    // All but one in a hundred of the errors are within the scale.
    let mut sizes: Vec<f64> = off_before.iter().map(|off: &f64| off.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let most = sizes.get(sizes.len() * 99 / 100).copied().unwrap_or(1.0);
    let kelvin = || Axis::linear("error (K)").range(-most, most);
    // What stripes add to the scene, of which the mean is known here.
    let mean: Vec<f64> = twin.mean.iter().skip(band).step_by(BANDS).copied().collect();
    let beside = |counts: &[f64]| -> Vec<f64> {
        counts.iter().zip(&mean).map(|(n, mean)| 100.0 * (n / mean - 1.0)).collect()
    };
    let percent = || Axis::linear("excess (%)").range(-5.0, 5.0);
    let figure = Pictures::new(
        "Does destriping take the stripes away?",
        vec![
            Picture::new("One band as it is read", counts(), COLUMNS, before.clone()),
            Picture::new("The same, destriped", counts(), COLUMNS, after.clone()),
            Picture::new(
                "Excess of the counts over the scene: stripes and noise",
                percent(),
                COLUMNS,
                beside(&before),
            ),
            Picture::new("The same, destriped", percent(), COLUMNS, beside(&after)),
            Picture::new("Temperature error, striped", kelvin(), COLUMNS, off_before),
            Picture::new("Temperature error, destriped", kelvin(), COLUMNS, off_after),
        ],
    )
    .subtitle(format!("{} % of the lines of every band are striped, each band for itself.", 100.0 * share));
    Ok(Plot { name: "before_and_after".into(), figure: figure.into(), table })
}
