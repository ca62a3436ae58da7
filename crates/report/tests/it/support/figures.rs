//! Checks of drawn figures, and numbers, words and axes of any kind.

use std::fs;
use std::path::Path;

use hadar_report::plot::{Axis, Figure, render_png, render_svg};
use proptest::prelude::*;

/// Draws and checks a figure, and leaves it in `target/tmp/figures`, to be looked at.
pub(crate) fn sample(name: &str, figure: &Figure) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("figures");
    fs::create_dir_all(&folder).expect("a folder for the samples");
    let svg = render_svg(figure).expect("an SVG");
    let png = render_png(figure).expect("a PNG");
    check_svg(&svg);
    check_png(&png);
    assert!(svg.len() < 1_000_000);
    fs::write(folder.join(format!("{name}.svg")), svg).expect("writing the SVG");
    fs::write(folder.join(format!("{name}.png")), png).expect("writing the PNG");
}

/// Well-formed, without numbers that are none; what can be read off it is JSON.
pub(crate) fn check_svg(svg: &str) {
    let parts =
        svg.split_once("<metadata>").and_then(|(head, rest)| Some((head, rest.split_once("</metadata>\n")?)));
    let svg = match parts {
        None => svg.to_owned(),
        Some((head, (readings, tail))) => {
            assert!(!readings.contains('<'), "{readings}");
            let panels: serde_json::Value = serde_json::from_str(readings).expect("JSON");
            assert!(
                panels.as_array().is_some_and(|panels| panels.iter().all(|panel| panel["at"].is_array()))
            );
            head.to_owned() + tail
        }
    };
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"), "{}", &svg[svg.len() - 40..]);
    assert!(!svg.contains("\"NaN\"") && !svg.contains("\"inf\""));
    // Every mark is a self-closing element; only texts, the title and the root have an end.
    let opened = svg.matches("<text ").count() + 2;
    assert_eq!(svg.matches("</").count(), opened);
    assert_eq!(svg.matches('<').count(), svg.matches("/>").count() + 2 * opened);
}

/// Readable, 1200 pixels wide, with margins that are white.
pub(crate) fn check_png(bytes: &[u8]) {
    let mut decoder = png::Decoder::new(bytes);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().expect("a PNG header");
    let mut pixels = vec![0; reader.output_buffer_size()];
    let info = reader.next_frame(&mut pixels).expect("PNG data");
    assert_eq!(info.width, 1200);
    // The margin stays white: nothing is clipped at the edges.
    let row = 3 * info.width as usize;
    let edge = |y: usize| pixels[y * row..(y + 1) * row].iter().all(|byte| *byte == 0xFF);
    assert!(edge(0) && edge(info.height as usize - 1));
    assert!(
        pixels.chunks(row).all(|line| line[..6].iter().chain(&line[row - 6..]).all(|byte| *byte == 0xFF))
    );
}

/// Any number at all, ordinary ones more often.
pub(crate) fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -100.0..100.0f64,
        2 => Just(0.5),
        1 => (-320.0..308.0f64).prop_map(|e| 10f64.powf(e)),
        1 => any::<f64>(),
        1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, f64::MAX, f64::MIN]),
    ]
}

/// A label, sometimes of odd letters.
pub(crate) fn words() -> impl Strategy<Value = String> {
    prop_oneof![3 => Just("a quantity (unit)".to_owned()), 1 => any::<String>(), 1 => "[ -~]{0,300}"]
}

/// Any axis.
pub(crate) fn axis() -> impl Strategy<Value = Axis> {
    let range = prop::option::of((number(), number()));
    let ticks = prop::option::of(prop::collection::vec((number(), words()), 0..5));
    (words(), any::<bool>(), range, ticks).prop_map(|(title, log, range, ticks)| {
        let axis = if log { Axis::log(&title) } else { Axis::linear(&title) };
        let axis = Axis { range, ..axis };
        match ticks {
            Some(ticks) => axis.secondary(title, ticks),
            None => axis,
        }
    })
}
