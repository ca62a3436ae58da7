//! Figures like those of the reports are drawn, and drawing survives any numbers.
//!
//! The samples are written to `target/tmp/figures`, to be looked at.

use crate::support::figures::{axis, check_png, check_svg, number, sample, words};
use hadar_report::plot::{
    Axis, Band, Figure, HeatMap, LineFigure, Marker, Matrix, Panel, Rule, Series, Style, render_png,
    render_svg,
};
use hadar_testing::seeded;
use proptest::prelude::*;

fn wavenumbers() -> Axis {
    let microns = (80..=140).step_by(5).map(|tenth| {
        let um = f64::from(tenth) / 10.0;
        (1e4 / um, if tenth % 10 == 0 { format!("{um:.0}") } else { format!("{um:.1}") })
    });
    Axis::linear("wavenumber (cm⁻¹)").secondary("wavelength (µm)", microns.collect())
}

fn bands() -> Vec<f64> {
    (715..=1250).map(f64::from).collect()
}

fn emissivities() -> Figure {
    let x = bands();
    let skin = x.iter().map(|nu| 0.95 + 0.01 * (nu / 60.0).sin()).collect();
    let metal = x.iter().map(|nu| 0.58 - 0.16 * (nu - 715.0) / 535.0).collect();
    LineFigure::new("Emissivity of the target and of its alternative", wavenumbers(), Axis::linear("emissivity").range(0.0, 1.0))
        .subtitle("small print that is long enough to need a second line: where the two curves come from, over which range they are known, and what was assumed beyond it")
        .series(Series::line("skin", x.clone(), skin))
        .series(Series::line("aluminium (the paper's robot)", x, metal))
        .into()
}

fn planck(nu: f64, kelvin: f64) -> f64 {
    2.0 * 2.997_924_58e8 * (100.0 * nu).powi(2) * 100.0 / (1.438_777 * nu / kelvin).exp_m1()
}

fn incident() -> Figure {
    let x = bands();
    let human: Vec<f64> = x.iter().map(|nu| 0.95 * planck(*nu, 310.0)).collect();
    let ripple = |nu: f64| 2e-3 * (nu / 90.0).cos() * (-(nu - 900.0).powi(2) / 5e4).exp();
    let robot: Vec<f64> = x.iter().zip(&human).map(|(nu, s)| s * (1.0 + ripple(*nu))).collect();
    let noise: Vec<f64> = x.iter().map(|nu| 1.2e-3 * planck(900.0, 310.0) / planck(*nu, 310.0)).collect();
    let difference = x.iter().map(|nu| ripple(*nu)).collect();
    let lower = Panel::new(Axis::linear("relative difference"))
        .band(Band::new(
            "± noise of the camera in one band",
            x.clone(),
            noise.iter().map(|s| -s).collect(),
            noise,
        ))
        .series(Series::line("difference (robot − human) / human", x.clone(), difference).colour(2))
        .rule(Rule::horizontal(0.0, ""));
    LineFigure::new(
        "A human at 37 °C and the nearest robot look nearly alike",
        wavenumbers(),
        Axis::linear("photon radiance (photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹)"),
    )
    .subtitle("what the camera receives, and the difference of the two against its noise")
    .series(Series::line("human, 37 °C, lighting 0.50", x.clone(), human))
    .series(Series::line("robot, 82.8 °C, lighting 0.19", x, robot).style(Style::Dashed))
    .lower(lower)
    .into()
}

fn identifiability() -> Figure {
    let x: Vec<f64> = (0..=360).map(|i| 10f64.powf(3.0 + f64::from(i) / 40.0)).collect();
    let curve = |d0: f64| -> Vec<f64> {
        x.iter()
            .map(|n| {
                let d = n.sqrt() * d0;
                d / (d + 0.34)
            })
            .collect()
    };
    LineFigure::new(
        "Information about the material against collected photons",
        Axis::log("photons in all bands").range(1e3, 1e12),
        Axis::linear("information log₂ 2P (bit)").range(0.0, 1.0),
    )
    .subtitle("three readings of the distance between human and robot")
    .series(Series::line("nearest state of the robot (the limit)", x.clone(), curve(8.85e-4)))
    .series(Series::line("local, camera calibrated", x.clone(), curve(7.3e-4)).style(Style::Dashed))
    .series(Series::line("local, gain unknown (the paper's)", x.clone(), curve(5.1e-6)))
    .rule(Rule::horizontal(0.75, "identifiable: d = 1, 0.75 bit"))
    .marker(Marker::new("FLIR A325sc, one exposure", 2.5e9, 0.05))
    .into()
}

fn required_photons() -> Figure {
    let columns: Vec<f64> = (0..120).map(f64::from).collect();
    let rows: Vec<f64> = (0..120).map(|i| (f64::from(i) + 1.0) / 120.0).collect();
    let mut values = Vec::new();
    for v in &rows {
        for t in &columns {
            let contrast = ((t - 20.0) / 100.0).powi(2) + 2.0 * (1.0 - v).powi(2);
            values.push(if contrast < 1e-7 { f64::INFINITY } else { 2e5 / contrast.powf(1.7) });
        }
    }
    HeatMap::new(
        "Photons needed to distinguish a human from a robot",
        (Axis::linear("temperature of the target (°C)"), columns),
        (Axis::linear("thermal lighting factor V"), rows),
        (Axis::log("required photons").range(1e4, 1e14), values),
    )
    .subtitle("environment at 20 °C, 715–1250 cm⁻¹, detection probability 84 %")
    .no_value("no number of photons suffices: target and surroundings are in equilibrium")
    .contours(vec![1e5, 1e6, 1e7, 1e8, 1e9])
    .marker(Marker::new("V = 1, T = T₀: nothing to see", 20.0, 1.0))
    .marker(Marker::new("this scene", 37.0, 0.5))
    .into()
}

fn library() -> Figure {
    let x = bands();
    let mut figure =
        LineFigure::new("Emissivity of thirty materials", wavenumbers(), Axis::linear("emissivity"));
    for i in 0..30 {
        let k = f64::from(i);
        let y = x.iter().map(|nu| 0.97 - 0.025 * k + 0.05 * (nu / (40.0 + 7.0 * k)).sin()).collect();
        let name = if i % 7 == 3 {
            "a rather long material name, weathered and oxidised"
        } else {
            "aluminium-polished"
        };
        figure = figure.series(Series::line(format!("{name} {i}"), x.clone(), y));
    }
    figure.into()
}

/// Points, gaps, rules of both kinds, values beyond the colour range, a field of missing cells.
fn odds_and_ends() -> [Figure; 2] {
    let x: Vec<f64> = (0..60).map(|i| 0.5 + f64::from(i) * 2e5).collect();
    let y: Vec<f64> =
        x.iter().enumerate().map(|(i, x)| if i % 17 == 5 { f64::NAN } else { 1e-7 * x.sqrt() }).collect();
    let scatter = y.iter().map(|y| y * 1.2 - 2e-5).collect();
    let lines = LineFigure::new(
        "Points, gaps and rules <&>",
        Axis::linear("photons in one exposure"),
        Axis::linear("error of the depth (m)"),
    )
    .series(Series::line("bound", x.clone(), y))
    .series(Series::points("simulated, 200 draws each", x, scatter))
    .rule(Rule::vertical(4e6, "full well of the detector"))
    .rule(Rule::horizontal(3e-4, "required"))
    .marker(Marker::new("here", 11.6e6, 3.6e-4))
    .marker(Marker::new("and another one with a long label that has to be wrapped", 11.7e6, 3.5e-4));
    let grid: Vec<f64> = (0..30).map(f64::from).collect();
    let values = grid
        .iter()
        .flat_map(|y| grid.iter().map(move |x| if x + y < 14.0 { f64::NAN } else { x * y - 200.0 }))
        .collect();
    let map = HeatMap::new(
        "Part of the map is unknown",
        (Axis::linear("x (m)"), grid.clone()),
        (Axis::log("y (m)"), grid.iter().map(|y| 10f64.powf(y / 7.0)).collect()),
        (Axis::linear("signed quantity (W m⁻²)").range(-100.0, 300.0), values),
    )
    .contours(vec![0.0, 100.0])
    .no_value("not measured");
    [lines.into(), map.into()]
}

/// Distances among the first materials of the embedded library (made up, with a few that are alike).
fn confusability(count: usize) -> Matrix {
    let library = hadar::material::Library::embedded().expect("the embedded library");
    let names: Vec<String> = library.names().take(count).map(str::to_owned).collect();
    let mut values = Vec::new();
    for i in 0..names.len() {
        for j in 0..names.len() {
            let apart = (i as f64 - j as f64).abs();
            let value =
                3e-5 * apart.powf(1.2) * (1.5 + (0.9 * i as f64).sin() * (1.7 * j as f64).cos()).powi(3);
            values.push(match (i, j) {
                (3, 2) | (2, 3) => 0.0,
                (1, 4) => f64::NAN,
                _ => value,
            });
        }
    }
    let axis = Axis::log("distance d₀ (per √photon)");
    Matrix::new(
        "Which materials can be distinguished",
        ("target", names.clone()),
        ("alternative", names),
        (axis, values),
    )
    .subtitle("nearest distance, target at 37 °C, environment at 20 °C, lighting 0.50, 715–1250 cm⁻¹")
    .threshold(6.3e-4, "too alike for the camera: distance below the required 6.3×10⁻⁴")
    .no_value("not computed")
    .groups((1..count).filter(|i| i % 9 == 4).collect())
}

/// More columns than rows, other names, long ones, no titles, numbers below and above the range.
fn ragged() -> Matrix {
    let rows: Vec<String> =
        ["skin", "a rather long material name, weathered, oxidised and wetted by rain", ""]
            .map(str::to_owned)
            .into();
    let columns: Vec<String> = (0..40).map(|i| format!("filter {i} of the wheel")).collect();
    let values = (0..120).map(|i| f64::from(i) - 30.0).collect();
    Matrix::new(
        "Signed numbers",
        ("", rows),
        ("", columns),
        (Axis::linear("excess (%)").range(0.0, 50.0), values),
    )
    .threshold(10.0, "below 10 %")
}

#[test]
fn sample_figures_are_drawn() {
    let [points, unknown] = odds_and_ends();
    for (name, figure) in [
        ("points", points),
        ("unknown", unknown),
        ("emissivities", emissivities()),
        ("incident", incident()),
        ("identifiability", identifiability()),
        ("required_photons", required_photons()),
        ("library", library()),
        ("matrix_2", confusability(2).into()),
        ("matrix_5", confusability(5).into()),
        ("matrix_12", confusability(12).into()),
        ("matrix_28", confusability(28).into()),
        ("matrix_68", confusability(68).into()),
        ("matrix_ragged", ragged().into()),
    ] {
        sample(name, &figure);
    }
}

fn numbers(most: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(number(), 0..=most)
}

fn panel() -> impl Strategy<Value = Panel> {
    let style =
        prop::sample::select(vec![Style::Line, Style::Dashed, Style::Dotted, Style::Points, Style::Marked]);
    let series = (words(), numbers(30), numbers(30), style, prop::option::of(0..40usize)).prop_map(
        |(label, mut x, mut y, style, colour)| {
            let count = x.len().min(y.len());
            x.truncate(count);
            y.truncate(count);
            Series { style, colour, ..Series::line(label, x, y) }
        },
    );
    let band =
        (words(), prop::collection::vec((number(), number(), number()), 0..20)).prop_map(|(label, rows)| {
            let column = |pick: fn(&(f64, f64, f64)) -> f64| rows.iter().map(pick).collect();
            Band::new(label, column(|row| row.0), column(|row| row.1), column(|row| row.2))
        });
    let marker = (words(), number(), number()).prop_map(|(label, x, y)| Marker::new(label, x, y));
    let rule = (any::<bool>(), number(), words()).prop_map(|(flat, at, label)| {
        if flat { Rule::horizontal(at, label) } else { Rule::vertical(at, label) }
    });
    (
        axis(),
        prop::collection::vec(series, 0..9),
        prop::collection::vec(band, 0..3),
        prop::collection::vec(marker, 0..4),
        prop::collection::vec(rule, 0..4),
    )
        .prop_map(|(y, series, bands, markers, rules)| Panel { y, series, bands, markers, rules })
}

fn line_figure() -> impl Strategy<Value = Figure> {
    (words(), words(), axis(), panel(), prop::option::of(panel())).prop_map(
        |(title, subtitle, x, panel, lower)| {
            let lower = lower.into_iter().collect();
            LineFigure { title, subtitle, x, panel, lower }.into()
        },
    )
}

/// Panels of little height over each other, as a vehicle's approach has them.
#[test]
fn four_panels_stand_over_each_other() {
    let panel = |title: &str, top: f64| {
        let y = (0..20).map(|i| top * f64::from(i + 1) / 20.0).collect();
        Panel::new(Axis::log(title))
            .series(Series::line("a camera", (0..20).map(f64::from).collect(), y).colour(0))
            .rule(Rule::horizontal(top / 2.0, "demanded"))
            .rule(Rule::vertical(7.0, ""))
    };
    let panels = ["d over required d", "pixels across 50 cm", "blur (pixels)", "speed at contact (km/h)"];
    let panels = panels.iter().zip([1.0, 1e3, 60.0, 1e-3]).map(|(title, top)| panel(title, top)).collect();
    let x = Axis::linear("time (s)").range(19.0, 0.0).secondary("distance (m)", vec![(10.0, "40".into())]);
    let figure = Figure::from(LineFigure::over("The approach", x, panels));
    let svg = render_svg(&figure).unwrap();
    check_svg(&svg);
    check_png(&render_png(&figure).unwrap());
    // The first panel is at the top, and one legend tells of all.
    let at = |title: &str| svg.find(title).unwrap_or_else(|| panic!("{title}"));
    assert!(at("d over required d") < at("blur (pixels)") && at("blur (pixels)") < at("speed at contact"));
    assert_eq!(svg.matches(">a camera<").count(), 1);
}

fn heat_map() -> impl Strategy<Value = Figure> {
    let centres = || {
        numbers(12).prop_map(|mut centres| {
            centres.retain(|centre| (1e-300..1e300).contains(centre));
            centres.sort_by(f64::total_cmp);
            centres.dedup();
            // Neighbours that differ by rounding only have one logarithm.
            centres.dedup_by(|a, b| a.log10() == b.log10());
            centres
        })
    };
    (words(), (axis(), centres()), (axis(), centres()), axis(), numbers(144), numbers(4), words()).prop_map(
        |(title, (x, columns), (y, rows), colour, mut values, contours, label)| {
            values.resize(columns.len() * rows.len(), 1.5);
            HeatMap::new(title, (x, columns), (y, rows), (colour, values))
                .contours(contours)
                .no_value(label.clone())
                .marker(Marker::new(label, 0.5, 0.5))
                .into()
        },
    )
}

fn matrix() -> impl Strategy<Value = Figure> {
    let names = || prop::collection::vec(words(), 0..12);
    let threshold = prop::option::of((number(), words()));
    (words(), (words(), names()), (words(), names()), axis(), numbers(144), threshold).prop_map(
        |(title, rows, columns, colour, mut values, threshold)| {
            values.resize(rows.1.len() * columns.1.len(), 1.5);
            let groups = |count: usize| (0..count).step_by(3).collect();
            let (row_groups, column_groups) = (groups(rows.1.len()), groups(columns.1.len()));
            let matrix = Matrix::new(title, rows, columns, (colour, values));
            let matrix = match threshold {
                Some((value, meaning)) => matrix.threshold(value, meaning),
                None => matrix,
            };
            Matrix { row_groups, column_groups, ..matrix }.into()
        },
    )
}

proptest! {
    #![proptest_config(seeded(7, 200))]

    #[test]
    fn any_numbers_give_a_valid_svg(figure in prop_oneof![line_figure(), heat_map(), matrix()]) {
        check_svg(&render_svg(&figure).expect("an SVG"));
    }
}

proptest! {
    #![proptest_config(seeded(7, 8))]

    #[test]
    fn any_numbers_give_a_png_with_nothing_cut_off(figure in prop_oneof![line_figure(), heat_map(), matrix()]) {
        check_png(&render_png(&figure).expect("a PNG"));
    }
}

#[test]
fn a_map_of_noise_stays_below_a_megabyte() {
    // A fixed linear congruential sequence (Knuth's MMIX constants): no two neighbours alike.
    let mut state = 1u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let values = (0..120 * 120).map(|_| draw()).map(|v| if v < 0.3 { f64::NAN } else { v }).collect();
    let centres = || (0..120).map(f64::from).collect();
    let axis = || Axis::linear("position (m)");
    let map =
        HeatMap::new("noise", (axis(), centres()), (axis(), centres()), (Axis::linear("value"), values));
    let svg = render_svg(&map.into()).expect("an SVG");
    check_svg(&svg);
    assert!(svg.len() < 1_000_000, "{} bytes", svg.len());
}

#[test]
fn lists_of_different_length_are_errors() {
    let figure = LineFigure::new("", Axis::linear(""), Axis::linear("")).series(Series::line(
        "skin",
        vec![1.0, 2.0],
        vec![1.0],
    ));
    let error = render_svg(&figure.into()).expect_err("one value is missing").to_string();
    assert_eq!(error, "vertical positions of the series `skin`: 1 values where 2 are needed");
}

/// Discs are lines of no length.
fn discs(svg: &str) -> usize {
    svg.lines().filter(|line| line.starts_with("<path stroke=")).map(|path| path.matches("h0").count()).sum()
}

#[test]
fn a_matrix_shows_every_name_and_marks_what_is_below_the_threshold() {
    let matrix = confusability(28);
    let svg = render_svg(&matrix.clone().into()).expect("an SVG");
    for name in &matrix.rows {
        // Once beside its row and once, turned, above its column.
        assert_eq!(svg.matches(&format!(">{name}</text>")).count(), 2, "{name}");
    }
    // The mark of each cell below the threshold (none for NaN or the diagonal), and that of the legend.
    let places = (0..28).flat_map(|row| (0..28).map(move |column| (row, column)));
    let below = places.filter(|(row, column)| row != column && matrix.values[row * 28 + column] < 6.3e-4);
    assert_eq!(discs(&svg), below.count() + 1);
    assert!(svg.contains("too alike for the camera") && svg.contains("not computed"));
    // Without threshold no mark and no legend entry.
    let plain = render_svg(&Matrix { threshold: None, ..matrix }.into()).expect("an SVG");
    assert!(discs(&plain) == 0 && !plain.contains("too alike"));
}

#[test]
fn no_text_of_a_matrix_leaves_the_figure() {
    for count in [0, 1, 2, 5, 12, 28, 68, 130, 300] {
        let names: Vec<String> =
            (0..count).map(|i| format!("a long name of a material, number {i}")).collect();
        let values = vec![1.0; count * count];
        let matrix =
            Matrix::new("many", ("target", names.clone()), ("alternative", names), (Axis::log("d"), values));
        check_png(&render_png(&matrix.into()).expect("a PNG"));
    }
}

#[test]
fn a_matrix_of_wrong_size_is_an_error() {
    let matrix = Matrix { values: vec![1.0; 3], ..confusability(2) };
    let error = render_svg(&matrix.into()).expect_err("one value is missing").to_string();
    assert_eq!(
        error,
        "cells of the matrix `Which materials can be distinguished`: 3 values where 4 are needed"
    );
    assert!(render_png(&confusability(3).groups(vec![3]).into()).is_err());
}
