//! Extended Data Fig. 8: semantic segmentation by materials, against the thermal image.
//!
//! The paper's scenes and the network that it compares with are not to be had; the streets are made here, several materials to an object.
//! Against the materials stands the most that the brightness of a pixel can say, laid out with the truth.

use super::ledger::{Line, Verdict};
use super::night::Night;
use super::order::{Figures, Made, Order, Progress};
use hadar::error::Result;
use hadar::words::{share, significant};
use hadar_estimate::segmentation::{Agreement, Rule};
use hadar_report::bundle::Bundle;
use hadar_report::figures::Plot;
use hadar_report::plot::Pictures;
use hadar_report::table::{Table, markdown, number};

const SCENES: [(&str, &str); 4] = [
    ("street", include_str!("scenes/edfig8_street.toml")),
    ("parking", include_str!("scenes/edfig8_parking.toml")),
    ("yard", include_str!("scenes/edfig8_yard.toml")),
    (GREY, include_str!("scenes/edfig8_meadow.toml")),
];
/// The scene of materials that the library knows as one number each.
const GREY: &str = "meadow";
/// How a map was made.
const WAYS: [&str; 6] = [
    "found_regions",
    "found_raster",
    "true_regions",
    "true_raster",
    "brightness_learned",
    "brightness_of_its_own",
];

/// What came of a scene, by each of [`WAYS`].
struct Scene {
    name: &'static str,
    right_material: f64,
    agreements: [Agreement; 6],
}

/// What must not be taken for something else.
const SAFETY: &str = "person";

pub(super) fn make(order: Order, progress: Progress<'_>) -> Result<Made> {
    let mut bundle = Bundle::default();
    let (mut scenes, mut plots) = (Vec::new(), Vec::new());
    let mut table = Table::new(["scene", "category"].into_iter().chain(WAYS));
    // What brightness means is learned from another street.
    let [street, parking] = [Night::of(SCENES[0].1, order.seed)?, Night::of(SCENES[1].1, order.seed)?];
    for (i, (name, toml)) in SCENES.iter().enumerate() {
        let own = if i > 1 { Some(Night::of(toml, order.seed)?) } else { None };
        let (night, teacher) = match (&own, i) {
            (Some(night), _) => (night, &street),
            (None, 0) => (&street, &parking),
            (None, _) => (&parking, &street),
        };
        let found = night.by_found(Rule::Regions)?;
        let thermal = night.by_thermal_of(teacher)?;
        let claimed = night.claimed(SAFETY)?;
        let maps = [
            &found,
            &night.by_found(Rule::Raster)?,
            &night.by_true(Rule::Regions)?,
            &night.by_true(Rule::Raster)?,
            &thermal,
            &night.by_thermal()?,
        ];
        let agreements = maps.map(|map| night.agreement(map));
        for (place, category) in night.names().into_iter().enumerate() {
            let iou = agreements.each_ref().map(|one| one.iou[place].map_or_else(String::new, number));
            table.push([(*name).to_owned(), category.to_owned()].into_iter().chain(iou).collect());
        }
        let mean = agreements.each_ref().map(|one| one.mean_iou.map_or_else(String::new, number));
        table.push([(*name).to_owned(), "mean".to_owned()].into_iter().chain(mean).collect());
        bundle.add(format!("{name}.toml"), *toml);
        let figure = Pictures::new(
            night.rendered.scenario.title.clone().unwrap_or_default(),
            vec![
                night.thermal_picture(),
                night.painted("What is there", &night.truth),
                night.painted(format!("By materials, the likeliest: mIoU {}", iou(&agreements[0])), &found),
                night.painted("By materials, what 95 % leave", &claimed),
                night.painted(format!("By brightness, mIoU {}", iou(&agreements[4])), &thermal),
            ],
        )
        .subtitle("Brightness: each of 256 is what it most often is in another street, of all that is here. The table beside holds one in 4 rows and columns.")
        .no_value("nothing is told")
        .keys(night.keys_of_claimed(SAFETY));
        let pixels = night.table(&[
            ("there", &night.truth),
            ("by_materials", &found),
            ("told_by_materials", &claimed),
            ("by_brightness", &thermal),
        ]);
        plots.push(Plot { name: (*name).into(), figure: figure.into(), table: pixels });
        scenes.push(Scene { name, right_material: night.right_material(), agreements });
        progress(i + 1, SCENES.len());
    }
    bundle.add_table("iou.csv", table)?;
    bundle.add_plots(&plots)?;
    let text = format!(
        "mIoU over the categories of each scene: by the materials that were found (as regions, and pixel by pixel as Algorithm 4 has it), \
         by those that are there, and by brightness: as another street teaches it (the street for all but itself, the car park for that), and as the \
         scene's own truth does, which is the most that brightness could say.\n\n{}\n",
        overview(&scenes)
    );
    let captions = [
        (
            "street.png",
            "Street: thermal image, truth, by materials (the likeliest, and what is told), by brightness",
        ),
        (
            "parking.png",
            "Car park: thermal image, truth, by materials (the likeliest, and what is told), by brightness",
        ),
        (
            "yard.png",
            "Yard: thermal image, truth, by materials (the likeliest, and what is told), by brightness",
        ),
        (
            "meadow.png",
            "Meadow: thermal image, truth, by materials (the likeliest, and what is told), by brightness",
        ),
    ];
    let pictures = captions.to_vec();
    Ok((bundle, lines(&scenes), Figures { pictures, text }))
}

fn iou(agreement: &Agreement) -> String {
    agreement.mean_iou.map_or_else(|| "none".to_owned(), |iou| significant(iou, 3))
}

fn overview(scenes: &[Scene]) -> String {
    let head = [
        "scene",
        "right material",
        "found, regions",
        "found, Algorithm 4",
        "there, regions",
        "there, Algorithm 4",
        "brightness",
        "brightness, of its own",
    ];
    let row = |scene: &Scene| {
        let start = [scene.name.to_string(), share(scene.right_material)];
        start.into_iter().chain(scene.agreements.each_ref().map(iou))
    };
    markdown(&head, scenes.iter().map(row))
}

fn lines(scenes: &[Scene]) -> Vec<Line> {
    let (grey, others): (Vec<&Scene>, Vec<&Scene>) = scenes.iter().partition(|scene| scene.name == GREY);
    let all =
        |of: &dyn Fn(&Scene) -> String| others.iter().map(|scene| of(scene)).collect::<Vec<_>>().join(", ");
    let of = |way: usize| all(&|scene| iou(&scene.agreements[way]));
    let mean = |scene: &Scene, way: usize| scene.agreements[way].mean_iou.unwrap_or(f64::NAN);
    let holds = |holds: bool| if holds { Verdict::UnderAChoice } else { Verdict::NotReproduced };
    let names = all(&|scene| scene.name.to_owned());
    let mut lines = vec![
        Line::new(
            "Ext. Data Fig. 8",
            format!("mIoU by materials against that by the thermal image: {names}"),
            "higher by materials (table only drawn)",
            format!("{} against {}", of(0), of(4)),
            holds(others.iter().all(|scene| mean(scene, 0) > mean(scene, 4))),
            format!(
                "thermal: a table from brightness to category that another street teaches, instead of a network; one that knows the truth of the \
                 scene itself, the most that brightness could say, has {}; scenes are our own",
                of(5)
            ),
        ),
        Line::new(
            "Algorithm 4",
            format!(
                "mIoU pixel by pixel, from materials that are found, and from those that are there: {names}"
            ),
            "-",
            format!("{}; {}", of(1), of(3)),
            Verdict::NotInThePaper,
            "what it leaves open: ties to the neighbour of the same material, then to the left; no neighbour and enclosed everywhere: a pass back",
        ),
        Line::new(
            "Algorithm 4",
            format!("the same by regions, what encloses a region or the outside: {names}"),
            "-",
            format!("{}; {}", of(0), of(2)),
            Verdict::NotInThePaper,
            "a robot that touches a car on its left is a car pixel by pixel, and a robot as a region",
        ),
    ];
    lines.extend(grey.into_iter().map(|scene| {
        Line::new(
            "Ext. Data Fig. 8",
            "the same where ground, trees and people are known as one number each: mIoU by materials, and by brightness",
            "-",
            format!("{} against {}", iou(&scene.agreements[0]), iou(&scene.agreements[5])),
            Verdict::NotInThePaper,
            "brightness laid out with the truth; grey materials of unknown temperature and lighting look alike: materials carry no more information than their spectra",
        )
    }));
    lines
}
