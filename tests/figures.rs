//! Figures like those of the reports are drawn, and drawing survives any numbers.
//!
//! The samples are written to `target/tmp/figures`, to be looked at.

use std::fs;
use std::path::Path;

use hadar::report::plot::{
    Axis, Band, Figure, HeatMap, LineFigure, Marker, Panel, Rule, Scale, Series, Style, render_png,
    render_svg,
};
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
        .subtitle("skin: measured optical constants (water, 70 %); aluminium: the quadratic fit of the paper, extrapolated below 760 cm⁻¹ as far as the bands need it, which is a guess")
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
        "Photons needed to tell a human from a robot",
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

fn check_svg(svg: &str) {
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"), "{}", &svg[svg.len() - 40..]);
    assert!(!svg.contains("NaN") && !svg.contains("inf\""));
    // Every mark is a self-closing element; only texts, the title and the root have an end.
    let opened = svg.matches("<text ").count() + 2;
    assert_eq!(svg.matches("</").count(), opened);
    assert_eq!(svg.matches('<').count(), svg.matches("/>").count() + 2 * opened);
}

fn check_png(bytes: &[u8]) {
    let mut reader = png::Decoder::new(bytes).read_info().expect("a PNG header");
    let mut pixels = vec![0; reader.output_buffer_size()];
    let info = reader.next_frame(&mut pixels).expect("PNG data");
    assert_eq!(info.width, 2400);
    // The margin stays white: nothing is clipped at the edges.
    let row = 3 * info.width as usize;
    let edge = |y: usize| pixels[y * row..(y + 1) * row].iter().all(|byte| *byte == 0xFF);
    assert!(edge(0) && edge(info.height as usize - 1));
    assert!(
        pixels.chunks(row).all(|line| line[..6].iter().chain(&line[row - 6..]).all(|byte| *byte == 0xFF))
    );
}

#[test]
fn sample_figures_are_drawn() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("figures");
    fs::create_dir_all(&folder).expect("a folder for the samples");
    for (name, figure) in [
        ("emissivities", emissivities()),
        ("incident", incident()),
        ("identifiability", identifiability()),
        ("required_photons", required_photons()),
        ("library", library()),
    ] {
        let start = std::time::Instant::now();
        let svg = render_svg(&figure).expect("an SVG");
        let middle = start.elapsed();
        let png = render_png(&figure).expect("a PNG");
        let all = start.elapsed();
        println!(
            "{name}: SVG {} kB in {middle:?}, PNG {} kB in {:?}",
            svg.len() / 1000,
            png.len() / 1000,
            all - middle
        );
        check_svg(&svg);
        check_png(&png);
        assert!(svg.len() < 1_000_000);
        fs::write(folder.join(format!("{name}.svg")), svg).expect("writing the SVG");
        fs::write(folder.join(format!("{name}.png")), png).expect("writing the PNG");
    }
}
