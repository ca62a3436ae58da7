//! The files of `hadar find`: the question, the scenario of every choice that is listed, tables, and a picture of them.

pub use crate::words::find::rows::{Row, rows};
pub use crate::words::find::{sentence, text, why};

use crate::bundle::Bundle;
use crate::figures::Plot;
use crate::plot::{Axis, LineFigure, Series};
use crate::table::{Table, number, optional};
use hadar::error::Result;
use hadar_scenario::Rule;
use hadar_study::find::{Choice, FindAnswer};
use std::borrow::Cow;

/// All files of an answer.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(found: &FindAnswer) -> Result<Bundle> {
    let mut bundle = Bundle::about(found.scenario.title.as_deref());
    bundle.add_asked(
        "question.toml",
        found.rule.as_ref().map_or_else(|| found.scenario.to_toml(), Rule::to_toml),
    );
    let groups = [("listed", &found.listed), ("also", &found.also), ("undecided", &found.undecided)];
    let nearest: Vec<Choice> = found.near.iter().map(|near| near.choice.clone()).collect();
    let groups: Vec<(&str, &Vec<Choice>)> = groups.into_iter().chain([("nearest", &nearest)]).collect();
    let mut choices = Table::new([
        "group",
        "scenario",
        "camera",
        "lens",
        "f_number",
        "focal_length_m",
        "filters",
        "bands",
        "frames",
        "time_s",
        "aperture_m",
        "price",
        "price_without",
        "distance_proved",
        "distance_found",
        "limiting",
        "conditions",
    ]);
    let mut count = 0;
    for (group, all) in &groups {
        for choice in *all {
            count += 1;
            let name = format!("choice_{count}.toml");
            bundle.add(
                name.clone(),
                choice.rule.as_ref().map_or_else(|| choice.scenario.to_toml(), Rule::to_toml),
            );
            choices.push(row(group, &name, choice));
        }
    }
    bundle.add_table("choices.csv", choices)?;
    let mut failed =
        Table::new(["camera", "f_number", "focal_length_m", "distance_proved", "distance_at_most", "why"]);
    for one in &found.failed {
        failed.push(vec![
            one.camera.clone(),
            optional(one.lens.as_ref().map(|lens| lens.f_number)),
            optional(one.lens.as_ref().map(|lens| lens.focal_length_m)),
            optional(one.lower),
            optional(one.upper),
            why(one, found.required_distance),
        ]);
    }
    bundle.add_table("failed.csv", failed)?;
    let listed = found.listed.iter().chain(&found.also);
    let conditions: Vec<_> = listed
        .flat_map(|choice| choice.conditions().iter().map(|one| (choice.camera.as_str(), one)))
        .collect();
    bundle.add_conditions(&conditions)?;
    bundle.add_warnings(found.best.as_ref().map_or(&[][..], |best| &best.warnings))?;
    bundle.add_plots(&drawn(found).into_iter().collect::<Vec<_>>())?;
    Ok(bundle)
}

fn row(group: &str, name: &str, choice: &Choice) -> Vec<String> {
    let filters: Vec<String> = choice
        .filters
        .iter()
        .map(|filter| {
            let [from, to] = filter.range_um;
            filter.name.clone().unwrap_or_else(|| format!("{from:.4}-{to:.4} um"))
        })
        .collect();
    let open = hadar_study::Condition::open(choice.conditions());
    vec![
        group.into(),
        name.into(),
        choice.camera.clone(),
        choice.lens.name.clone().unwrap_or_default(),
        number(choice.lens.f_number),
        number(choice.lens.focal_length_m),
        filters.join(" "),
        choice.bands.to_string(),
        choice.frames.to_string(),
        number(choice.time_s),
        number(choice.aperture_m),
        choice.price.as_ref().map_or_else(String::new, ToString::to_string),
        choice.price_without.join(" "),
        number(choice.lower),
        number(choice.upper),
        choice.limiting.clone(),
        open.map(hadar_study::Condition::code).collect::<Vec<_>>().join(" "),
    ]
}

/// What every choice tells against the time that it takes; nothing where there is none.
fn drawn(found: &FindAnswer) -> Option<Plot> {
    let near = found.near.iter().map(|near| &near.choice);
    let all: Vec<&Choice> = found
        .listed
        .iter()
        .chain(&found.also)
        .chain(&found.undecided)
        .chain(near)
        .filter(|one| one.lower > 0.0)
        .collect();
    if all.is_empty() {
        return None;
    }
    let ends = |values: Vec<f64>| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(0.0, f64::max);
        (low / 2.0, high * 2.0)
    };
    let required = found.required_distance;
    let times = ends(all.iter().map(|choice| choice.time_s).collect());
    let distances = ends(all.iter().map(|choice| choice.lower).chain([required]).collect());
    let mut figure = LineFigure::new(
        "What does each choice determine, and how long does it take?",
        Axis::log("time until all is read [s]").range(times.0, times.1),
        Axis::log("statistical distance that is proved").range(distances.0, distances.1),
    );
    figure = figure.series(Series::line(
        format!("required, d = {}", hadar::words::significant(required, 4)),
        vec![times.0, times.1],
        vec![required; 2],
    ));
    let mut table = Table::new(["camera", "time_s", "distance_proved"]);
    let mut cameras: Vec<&str> = all.iter().map(|choice| choice.camera.as_str()).collect();
    cameras.dedup();
    for camera in cameras {
        let own = || all.iter().filter(|choice| choice.camera == camera);
        let (x, y) = own().map(|choice| (choice.time_s, choice.lower)).unzip();
        figure = figure.series(Series::points(camera, x, y));
        for choice in own() {
            table.push(vec![camera.to_owned(), number(choice.time_s), number(choice.lower)]);
        }
    }
    Some(Plot { name: Cow::Borrowed("choices_by_time"), figure: figure.into(), table })
}
