//! Extended Data Fig. 7: a person before a car, and a robot, by a thermal image and by their materials.
//!
//! The paper detects people by networks that were trained on thermal images; here is none. Detection is a region of the material, as its
//! own figure does first: an object is a connected region of a category. What the thermal image could say at the most is laid out with
//! the truth ([`hadar_estimate::segmentation::by_brightness`]).

use super::ledger::{Line, Verdict};
use super::night::Night;
use super::order::{Figures, Made, Order};
use hadar::error::Result;
use hadar::words::{share, significant};
use hadar_estimate::segmentation::{NO_CATEGORY, Objects, Rule, objects};
use hadar_report::bundle::Bundle;
use hadar_report::figures::Plot;
use hadar_report::plot::Pictures;
use hadar_report::table::{Table, number};

const SCENE: &str = include_str!("scenes/edfig7.toml");
/// The paper's camera in the place of the scene's: its lens shortened so that it sees as much, some frames.
const THERMAL_CAMERA: &str = "[camera]\npreset = \"flir-a325sc\"\nfocal_length = \"7 mm\"\nframes = 20\n\n";
/// Pairs of materials that are told apart, pixel by pixel.
const PAIRS: [[&str; 2]; 2] = [["skin", "aluminium"], ["skin", "pmma"]];
/// Pixels of the smallest object.
const SMALLEST: usize = 200;

/// How well an object of the scene was found.
struct Detected {
    name: &'static str,
    by: &'static str,
    /// Objects of that category.
    count: usize,
    /// Of the one that agrees best: intersection over union of the pixels.
    iou: f64,
}

/// How well two materials are told apart.
struct Pair {
    camera: &'static str,
    names: [&'static str; 2],
    /// The share that is right between a state and the nearest one of the other, and its limit.
    shares: [f64; 2],
}

pub(super) fn make(order: Order) -> Result<Made> {
    let night = Night::of(SCENE, order.seed)?;
    let columns = night.columns();
    let found = night.by_found(Rule::Regions)?;
    let thermal = night.by_thermal()?;
    let (of_found, of_thermal) = (objects(&found, columns, SMALLEST)?, objects(&thermal, columns, SMALLEST)?);
    let mut detected = Vec::new();
    for name in ["person", "robot"] {
        for (by, objects) in [("materials", &of_found), ("thermal image", &of_thermal)] {
            let Some(category) = night.category(name) else { continue };
            let (count, iou) = best(&night, objects, category);
            detected.push(Detected { name, by, count, iou });
        }
    }
    let warm = warm(&night)?;
    let weak = Night::of(&with_thermal_camera(), order.seed)?;
    let mut pairs = Vec::new();
    for (camera, night) in [("scene.toml", &night), ("flir-a325sc, 20 frames", &weak)] {
        for names in PAIRS {
            pairs.push(Pair { camera, names, shares: night.pair(names, order.seed)? });
        }
    }
    let mut bundle = Bundle::default();
    bundle.add("scene.toml", SCENE);
    let mut table = Table::new(["object", "by", "objects_of_that_kind", "best_iou"]);
    for one in &detected {
        table.push(vec![one.name.into(), one.by.into(), one.count.to_string(), number(one.iou)]);
    }
    bundle.add_table("detections.csv", table)?;
    let mut table = Table::new(["camera", "material", "other", "right", "limit"]);
    for pair in &pairs {
        let shares = pair.shares.map(number);
        table.push(
            [pair.camera, pair.names[0], pair.names[1]]
                .map(str::to_owned)
                .into_iter()
                .chain(shares)
                .collect(),
        );
    }
    bundle.add_table("pairs.csv", table)?;
    let pictures = Pictures::new(
        "A person before a car, and a robot",
        vec![
            night.thermal_picture(),
            night.painted("What is there", &night.truth),
            night.painted("By materials", &found),
            night.painted("The most that brightness could say", &thermal),
        ],
    )
    .subtitle(
        "11 bands, light scattered once. The thermal image was laid out with the truth: each of 256 brightnesses is what it most often is. The table beside holds one in 4 rows and columns.",
    )
    .no_value("nothing is told")
    .keys(night.keys());
    let maps = night.table(&[("there", &night.truth), ("by_materials", &found), ("by_brightness", &thermal)]);
    bundle.add_plots(&[Plot { name: "detection".into(), figure: pictures.into(), table: maps }])?;
    let text = format!(
        "{} x {columns} pixels. The material of {} of the pixels that are one surface is right. Scene, library and camera: scene.toml.\n",
        night.rendered.shape.rows(),
        share(night.right_material()),
    );
    let pictures =
        vec![("detection.png", "Thermal image, truth, categories by materials and by brightness alone")];
    Ok((bundle, lines(&detected, warm, &pairs), Figures { pictures, text }))
}

/// Objects of a category, and how well the best of them agrees with what is there.
fn best(night: &Night, objects: &Objects, category: u8) -> (usize, f64) {
    let there = night.truth.iter().filter(|one| **one == category).count();
    let own: Vec<usize> = (0..objects.all.len()).filter(|i| objects.all[*i].category == category).collect();
    let iou = |place: &usize| {
        let within = objects.of_pixel.iter().zip(&night.truth);
        let within =
            within.filter(|(of, truth)| of.is_some_and(|of| of as usize == *place) && **truth == category);
        let both = within.count();
        both as f64 / (there + objects.all[*place].pixels - both) as f64
    };
    (own.len(), own.iter().map(iou).fold(0.0, f64::max))
}

/// The warm object of the thermal image that has most of the person: how much of it is the person's, and the car's.
fn warm(night: &Night) -> Result<[f64; 2]> {
    let [Some(person), Some(car), Some(road)] = ["person", "car", "road"].map(|name| night.category(name))
    else {
        return Ok([f64::NAN; 2]);
    };
    let mean = |category: u8| {
        let own = || night.thermal.iter().zip(&night.truth).filter(|(_, one)| **one == category);
        own().map(|(n, _)| f64::from(*n)).sum::<f64>() / own().count().max(1) as f64
    };
    let half = 0.5 * (mean(person) + mean(road));
    let is_warm = |n: &f32| if f64::from(*n) > half { 0 } else { NO_CATEGORY };
    let mask: Vec<u8> = night.thermal.iter().map(is_warm).collect();
    let found = objects(&mask, night.columns(), SMALLEST)?;
    let counts = |category: u8| {
        let mut counts = vec![0_usize; found.all.len()];
        for (of, _) in found.of_pixel.iter().zip(&night.truth).filter(|(_, one)| **one == category) {
            if let Some(count) = of.and_then(|of| counts.get_mut(of as usize)) {
                *count += 1;
            }
        }
        counts
    };
    let (people, cars) = (counts(person), counts(car));
    let most = (0..found.all.len()).max_by_key(|place| people[*place]);
    Ok(most.map_or([f64::NAN; 2], |place| {
        [people[place], cars[place]].map(|count| count as f64 / found.all[place].pixels as f64)
    }))
}

/// The scene before the paper's camera.
fn with_thermal_camera() -> String {
    let at = |header: &str| SCENE.find(header).unwrap_or(SCENE.len());
    format!("{}{THERMAL_CAMERA}{}", &SCENE[..at("[camera]")], &SCENE[at("[[category]]")..])
}

fn lines(detected: &[Detected], [person, car]: [f64; 2], pairs: &[Pair]) -> Vec<Line> {
    let mut lines = Vec::new();
    let by = |by: &str| {
        let of = |one: &&Detected| one.by == by;
        let words = detected.iter().filter(of).map(|one| {
            let objects = if one.count == 1 { "object" } else { "objects" };
            format!("{}: {} {objects}, IoU {}", one.name, one.count, significant(one.iou, 2))
        });
        let all = detected.iter().filter(of).all(|one| one.count == 1 && one.iou > 0.5);
        (words.collect::<Vec<_>>().join("; "), all)
    };
    let (ours, all) = by("materials");
    lines.push(Line::new(
        "Ext. Data Fig. 7b",
        "person and robot found by regions of their materials",
        "both, distinguished",
        ours,
        if all { Verdict::UnderAChoice } else { Verdict::NotReproduced },
        "without a network: connected regions of a category; the scene is like the paper's as far as that is stated",
    ));
    let (ours, _) = by("thermal image");
    let merged = car > person;
    lines.push(Line::new(
        "Ext. Data Fig. 7a",
        "the person in the thermal image",
        "merges into the car; the robot is taken for a person",
        format!(
            "of the warm object that has the person, {} is the person and {} the car; laid out with the truth, {ours}",
            share(person),
            share(car)
        ),
        if merged { Verdict::UnderAChoice } else { Verdict::NotReproduced },
        "warm: brighter than halfway between road and person; brightness alone, with the truth to lay it out",
    ));
    for Pair { camera, names: [a, b], shares: [right, limit] } in pairs {
        lines.push(Line::new(
            "Ext. Data Fig. 7",
            format!("{a} and {b} distinguished by a pixel alone ({camera})"),
            "-",
            share(*right),
            Verdict::NotInThePaper,
            format!(
                "limit {}, mean of P(d): counts drawn of pixels' states and of the nearest states of the other material, half of each; by \
                 maximum likelihood of the two",
                share(*limit)
            ),
        ));
    }
    lines
}
