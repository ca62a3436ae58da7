//! A person against a robot with classes on both sides: what the verdict on two curves hides.
//!
//! In the scene of the paper (37 °C, V = 0.5, surroundings of 20 °C) the built-in skin (0.95 in all bands) stands against the robot of the paper,
//! and then spectra that were measured: skin, moist tissue and cloth against every paint and every metal of the library that is given. The
//! committed report takes the ECOSTRESS spectral library and the one that the paper's authors publish; neither is part of this program.

mod row;
mod text;

use self::row::{CAMERAS, Row};
use crate::reproduce::order::{Effort, Order, Progress};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_report::bundle::Bundle;
use hadar_report::classes;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, NamedSeries, NamedValues};
use hadar_report::table::{Table, number, optional};
use hadar_scenario::Scenario;
use hadar_study::{ClassAnswer, Study};

/// The classes: patterns of names in the library.
const CLASSES: &str = r#"
[class.person]
materials = ["human", "cloths", "tissue-blood-proxy"]

[class.painted-robot]
materials = ["*paint@*", "black-paint", "black-nextel-paint", "gloss-black-paint", "lamp-ebony-black-paint", "metallic-silver-paint", "ultra-flat-black-paint"]

[class.metal-robot]
materials = ["al", "oxidized-steel", "*-metal", "*-metal@*", "*-plate@*"]
"#;

/// The scene of the paper in bands that all spectra cover.
const SCENE: &str = r#"
[[environment]]
temperature = "20 degC"
lighting = 0.5

[bands]
start = "810 cm^-1"
stop = "1240 cm^-1"
step = "10 cm^-1"
"#;

/// What is asked: target, alternative, whether mixtures count.
const ASKED: [(&str, &str, bool); 6] = [
    ("skin", "aluminium", false),
    ("human", "al", false),
    ("person", "al", false),
    ("person", "painted-robot", false),
    ("person", "metal-robot", false),
    ("person", "painted-robot", true),
];
/// The quick form has the first.
const QUICK: usize = 3;
fn scenario(target: &str, alternative: &str, mixtures: bool, camera: Option<&str>) -> String {
    let classes = match mixtures {
        true => CLASSES.replace("[class.painted-robot]", "[class.painted-robot]\nmixtures = true"),
        false => CLASSES.to_owned(),
    };
    let camera = camera.map_or_else(String::new, |name| format!("\n[camera]\npreset = \"{name}\"\n"));
    format!(
        "title = \"A person against a robot\"\n{classes}\n[target]\nmaterial = \"{target}\"\ntemperature = \"37 degC\"\n{SCENE}\n\
         [alternatives]\nmaterials = [\"{alternative}\"]\n{camera}"
    )
}

fn row(library: &Library, (target, alternative, mixtures): (&str, &str, bool)) -> Result<Row> {
    let answer = |camera: Option<&str>| {
        let text = scenario(target, alternative, mixtures, camera);
        Study::new(&Scenario::from_toml(&text, None)?, library)?.identify()
    };
    let none = || Error::malformed("there is no alternative", "name one");
    let found = answer(None)?;
    let pair = found.pairs.first().ok_or_else(none)?;
    let mut classes = found.classes.clone();
    let mut reached = Vec::new();
    for camera in CAMERAS {
        let found = answer(Some(camera))?;
        let own = found.classes.first().map(ClassAnswer::decisive);
        let pair = found.pairs.first().and_then(|pair| pair.statistical_distance);
        reached.push(own.or(pair).ok_or_else(none)?);
        classes.extend(found.classes);
    }
    let decisive = classes.first().map(ClassAnswer::decisive);
    Ok(Row {
        what: format!("{target} against {alternative}{}", if mixtures { ", mixed" } else { "" }),
        distance: pair.distance_nearest,
        lower: decisive.unwrap_or(pair.distance_nearest_lower),
        photons: pair.photons_required,
        reached,
        classes,
    })
}

/// The quick form has the table alone, of the first questions.
pub(super) fn make(order: Order, library: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let asked = order.some_of(&ASKED, QUICK);
    let mut rows = Vec::with_capacity(asked.len());
    for (i, question) in asked.iter().enumerate() {
        rows.push(row(library, *question)?);
        progress(i + 1, asked.len());
    }
    let mut bundle = Bundle::default();
    let finding = text::finding(&rows);
    let distances = distances(&rows);
    if order.effort == Effort::Quick {
        bundle.add_table("distances.csv", distances.table)?;
        return Ok((bundle, finding));
    }
    let of_painted = rows.iter().find(|row| row.what == "person against painted-robot");
    let of_metal = rows.iter().find(|row| row.what == "person against metal-robot");
    let mut plots = vec![distances];
    for (name, row) in [("painted_robot", of_painted), ("metal_robot", of_metal)] {
        // The first is by photons alone.
        let first = row.and_then(|row| row.classes.first());
        let pictures =
            first.map(|answer| classes::pictures(std::slice::from_ref(answer))).unwrap_or_default();
        plots.extend(pictures.into_iter().map(|plot| Plot { name: name.into(), ..plot }));
    }
    bundle.add("README.md", text::readme(&rows));
    bundle.add_asked("scenario.toml", scenario("person", "painted-robot", false, Some(CAMERAS[1])));
    bundle.add_plots(&plots)?;
    Ok((bundle, finding))
}

/// The photons that every question takes.
fn distances(rows: &[Row]) -> Plot {
    let mut table = Table::new([
        "question",
        "spectra_target",
        "spectra_alternative",
        "distance_per_sqrt_photon",
        "distance_per_sqrt_photon_lower",
        "photons_required",
        "statistical_distance_flir-a325sc",
        "statistical_distance_ideal-pnrd",
        "share_of_pairs_told_ideal-pnrd",
    ]);
    for row in rows {
        let spectra = |side: fn(&ClassAnswer) -> usize| row.classes.first().map_or(1, side).to_string();
        table.push(vec![
            row.what.clone(),
            spectra(|answer| answer.target.spectra),
            spectra(|answer| answer.alternative.spectra),
            number(row.distance),
            number(row.lower),
            optional(row.photons),
            number(row.reached[0]),
            number(row.reached[1]),
            optional(row.classes.last().and_then(|answer| answer.share_of_pairs_told)),
        ]);
    }
    let names = rows.iter().map(Row::in_words).collect();
    let photons = rows.iter().map(|row| row.photons.unwrap_or(f64::NAN)).collect();
    let figure = NamedValues::new(
        "How many photons does it take to distinguish a person from a robot?",
        names,
        Axis::log("photons required for d = 1, by shot noise alone"),
    )
    .subtitle(
        "The hardest pair of members by the nearest distance; 37 degC, V = 0.5, surroundings of 20 degC."
            .to_owned(),
    )
    .series(NamedSeries::new("", photons));
    Plot { name: "distances".into(), figure: figure.into(), table }
}
