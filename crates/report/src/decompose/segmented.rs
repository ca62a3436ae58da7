//! A segmented cube: categories and objects in tables and a picture.

use crate::figures::Plot;
use crate::plot::{Axis, Painted, Picture, Pictures, Rgb, categorical};
use crate::shown::Shown;
use crate::table::{Table, number};
use crate::words::decompose::{NOT_EXCLUDED_SAID, SEGMENTED};
use crate::words::pictures::NOTHING_TOLD;
use hadar_estimate::segmentation::Agreement;
use hadar_study::decompose::{Block, ObjectRow, PossibleRow, SafetyRow, Segmented};

/// The colour of no category.
const NONE: Rgb = (190, 190, 190);
/// What is undecided: lines on paper, one in so many pixels.
const HATCH: Rgb = (70, 70, 70);
const PAPER: Rgb = (250, 250, 250);
const HATCH_PX: usize = 4;
/// Where a category is, where it cannot be excluded, and where it can.
const OWN: Rgb = (150, 20, 30);
const NOT_EXCLUDED: Rgb = (250, 170, 60);
const EXCLUDED: Rgb = (225, 230, 235);

/// What was found of every category.
pub(super) fn categories(found: &Segmented) -> Table {
    let mut table =
        Table::new(["category", "index", "pixels", "decided", "objects", "iou", "iou_by_brightness"]);
    let iou = |agreement: &Option<Agreement>, i: usize| {
        agreement.as_ref().and_then(|one| one.iou.get(i).copied().flatten()).map_or_else(String::new, number)
    };
    for (i, row) in found.categories.iter().enumerate() {
        table.push(vec![
            row.category.clone(),
            i.to_string(),
            row.pixels.to_string(),
            row.decided.to_string(),
            row.objects.to_string(),
            iou(&found.agreement, i),
            iou(&found.agreement_by_brightness, i),
        ]);
    }
    table
}

/// Objects, a row for each; rows and columns from the first to the one after the last.
pub(super) fn objects(found: &Segmented) -> Table {
    let possible = |row: &ObjectRow| {
        let one = |one: &PossibleRow| format!("{} {}", one.category, number(one.probability));
        row.possible.iter().map(one).collect::<Vec<_>>().join("; ")
    };
    Table::of(
        &found.objects,
        &[
            ("category", &|row| row.category.clone()),
            ("pixels", &|row| row.pixels.to_string()),
            ("decided", &|row| row.decided.to_string()),
            ("first_row", &|row| row.rows[0].to_string()),
            ("after_last_row", &|row| row.rows[1].to_string()),
            ("first_column", &|row| row.columns[0].to_string()),
            ("after_last_column", &|row| row.columns[1].to_string()),
            ("temperature_median_k", &|row| number(row.temperature_median_k)),
            ("temperature_sigma_median_k", &|row| number(row.temperature_sigma_median_k)),
            ("possible", &possible),
        ],
    )
}

/// The map of categories beside the thermal image, of the pixels that are shown.
pub(super) fn plot(found: &Segmented, pixels: &Block, shown: Shown) -> Plot {
    let colour = |category: u8| match usize::from(category) {
        place if place < found.categories.len() => categorical(place),
        _ => NONE,
    };
    let category = |map: &[u8], at: usize| map.get(at).copied().unwrap_or(u8::MAX);
    let is_undecided = |at: usize| found.is_undecided.get(at).copied().unwrap_or(true);
    let painted = |[row, column, at]: [usize; 3]| match is_undecided(at) {
        true => hatched(shown, row, column),
        false => colour(category(&found.map, at)),
    };
    let painted = shown.places().map(painted).collect();
    let thermal: Vec<f64> = pixels.thermal.iter().map(|x| f64::from(*x)).collect();
    let mut table = Table::new([
        "row",
        "column",
        "category",
        "undecided",
        "likeliest_category",
        "thermal_photons_s1_m2_sr1",
    ]);
    let name = |map: &[u8], at: usize| {
        let row = found.categories.get(usize::from(category(map, at)));
        row.map_or_else(String::new, |row| row.category.clone())
    };
    for ([row, column, at], thermal) in shown.places().zip(&thermal) {
        table.push(vec![
            row.to_string(),
            column.to_string(),
            name(&found.map, at),
            u8::from(is_undecided(at)).to_string(),
            name(&found.likeliest, at),
            number(*thermal),
        ]);
    }
    let mut keys: Vec<(Rgb, String)> = found
        .categories
        .iter()
        .enumerate()
        .filter(|(_, row)| row.pixels > 0)
        .map(|(place, row)| (categorical(place), row.category.clone()))
        .collect();
    if found.none > 0 {
        keys.push((NONE, "none".to_owned()));
    }
    if found.undecided > 0 {
        keys.push((HATCH, "undecided (hatched)".to_owned()));
    }
    let figure = Pictures::new(
        "What is there, by its materials",
        beside_thermal("Categories", painted, thermal, shown),
    )
    .subtitle(SEGMENTED)
    .no_value(NOTHING_TOLD)
    .keys(keys);
    Plot { name: "segmentation".into(), figure: figure.into(), table }
}

/// Where a category cannot be excluded beside the thermal image.
pub(super) fn not_excluded(
    found: &Segmented,
    row: &SafetyRow,
    name: String,
    pixels: &Block,
    shown: Shown,
) -> Plot {
    let place = found.categories.iter().position(|one| one.category == row.category);
    let is_own = |at: usize| found.map.get(at).map(|one| usize::from(*one)) == place;
    let is_left = |at: usize| row.map.get(at) != Some(&0);
    let colour = |at: usize| match (is_own(at), is_left(at)) {
        (true, _) => OWN,
        (false, true) => NOT_EXCLUDED,
        (false, false) => EXCLUDED,
    };
    let painted = shown.places().map(|[_, _, at]| colour(at)).collect();
    let thermal = pixels.thermal.iter().map(|x| f64::from(*x)).collect();
    let mut table = Table::new(["row", "column", "cannot_be_excluded"]);
    for [row, column, at] in shown.places() {
        table.push(vec![row.to_string(), column.to_string(), u8::from(is_left(at)).to_string()]);
    }
    let category = &row.category;
    let keys = vec![
        (OWN, category.clone()),
        (NOT_EXCLUDED, format!("{category} not excluded")),
        (EXCLUDED, format!("{category} excluded")),
    ];
    let title = format!("Where {category} cannot be excluded");
    let figure = Pictures::new(title.clone(), beside_thermal(&title, painted, thermal, shown))
        .subtitle(NOT_EXCLUDED_SAID)
        .no_value(NOTHING_TOLD)
        .keys(keys);
    Plot { name: name.into(), figure: figure.into(), table }
}

/// The names of the files of the categories that matter for safety: letters and digits of their names, and their places where those are the same.
pub(super) fn files(found: &Segmented) -> Vec<String> {
    let plain = |row: &SafetyRow| {
        let letter = |c: char| if c.is_alphanumeric() || c == '-' { c } else { '_' };
        format!("cannot_exclude_{}", row.category.chars().map(letter).collect::<String>())
    };
    let names: Vec<String> = found.safety.iter().map(plain).collect();
    let is_twice = |name: &String| {
        let same = |other: &&String| other.to_lowercase() == name.to_lowercase();
        names.iter().filter(same).count() > 1
    };
    let named = |(place, name): (usize, &String)| {
        if is_twice(name) { format!("{name}_{place}") } else { name.clone() }
    };
    names.iter().enumerate().map(named).collect()
}

/// Lines across what is undecided, from corner to corner of the pixels that are shown.
fn hatched(shown: Shown, row: usize, column: usize) -> Rgb {
    match ((row + column) / shown.stride.max(1)).is_multiple_of(HATCH_PX) {
        true => HATCH,
        false => PAPER,
    }
}

fn beside_thermal(title: &str, painted: Vec<Rgb>, thermal: Vec<f64>, shown: Shown) -> Vec<Picture> {
    vec![
        Picture::painted(title, Axis::linear(""), shown.wide(), Painted { pixels: painted, ramp: None }),
        Picture::new(
            "Thermal image, all bands together",
            Axis::linear("radiance (photons s⁻¹ m⁻² sr⁻¹)"),
            shown.wide(),
            thermal,
        ),
    ]
}
