//! The approach to a decision as pictures over time: what can be told apart, pixels, blur, and what braking still does.

use crate::figures::Plot;
use crate::plot::{Axis, Figure, LineFigure, Panel, Rule, Series, Style, number as number_in_picture};
use crate::table::{Table, number, optional, yes_no};
use crate::words::rule::course as words;
use hadar_scenario::Units;
use hadar_study::{Course, Moment};

/// Steps on the second reading of the axis of time, at most.
const DISTANCES: f64 = 6.0;

/// The last colour of the palette, whichever cameras there are.
const LAST: usize = 6;

/// A picture of every course.
pub(super) fn plots(courses: &[Course], units: Units) -> Vec<Plot> {
    let name = |index: usize| match courses.len() {
        1 => "approach".to_owned(),
        _ => format!("approach_{}", index + 1),
    };
    courses.iter().enumerate().map(|(index, course)| plot(name(index), course, units)).collect()
}

fn plot(name: String, course: &Course, units: Units) -> Plot {
    let all = || course.cameras.iter().flat_map(|camera| &camera.moments);
    let mut panels = Vec::new();
    let told = all().any(|moment| moment.margin.is_some());
    if told {
        let told = panel(course, Axis::log(words::MARGIN), |moment| moment.margin);
        panels.push(told.rule(Rule::horizontal(1.0, words::DEMANDED)));
    }
    let pixels = panel(course, Axis::log(words::pixels(course.size_m)), |moment| Some(moment.pixels));
    panels.push(match course.demanded_pixels {
        Some(demanded) => pixels.rule(Rule::horizontal(demanded, words::DEMANDED)),
        None => pixels,
    });
    let blur = panel(course, Axis::log(words::BLUR), |moment| Some(moment.blur_pixels));
    panels.push(blur.rule(Rule::horizontal(1.0, words::AT_MOST)));
    let mut impact = Panel::new(Axis::linear(words::impact(units.speed_unit())));
    if let Some(camera) = course.cameras.first() {
        let speeds = camera.moments.iter().map(|moment| units.speed_number(moment.impact_m_s)).collect();
        let series = Series::line(words::EVERY_CAMERA, times(&camera.moments), speeds);
        impact = impact.series(series.colour(LAST));
    }
    panels.push(impact);
    let decided_s = course.decision.distance_m / course.decision.closing_m_s;
    let panels = panels.into_iter().enumerate().map(|(index, panel)| {
        let label = if index == 0 { words::DECISION } else { "" };
        panel.rule(Rule::vertical(decided_s, label))
    });
    let first_m = all().map(|moment| moment.distance_m).fold(0.0, f64::max);
    let time = time(first_m, course.decision.closing_m_s);
    let figure = LineFigure::over(words::title(course, units), time, panels.collect());
    let figure = figure.subtitle(words::below(course, told));
    Plot { name: name.into(), figure: Figure::from(figure), table: table(course) }
}

/// A quantity of every camera.
fn panel(course: &Course, y: Axis, of: impl Fn(&Moment) -> Option<f64>) -> Panel {
    course.cameras.iter().enumerate().fold(Panel::new(y), |panel, (index, camera)| {
        let values = camera.moments.iter().map(|moment| of(moment).unwrap_or(f64::NAN)).collect();
        let line = Series::line(camera.name.clone(), times(&camera.moments), values).colour(index);
        // Cameras behind the same lens have the same pixels: the one is seen through the other.
        panel.series(if index % 2 == 1 { line.style(Style::Dashed) } else { line })
    })
}

fn times(moments: &[Moment]) -> Vec<f64> {
    moments.iter().map(|moment| moment.to_contact_s).collect()
}

/// Time to contact, from early to late, with round distances above it.
fn time(first_m: f64, closing_m_s: f64) -> Axis {
    let decade = 10f64.powf((first_m / DISTANCES).log10().floor());
    let step_m = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
    let step_m = step_m.into_iter().find(|step_m| step_m * DISTANCES >= first_m).unwrap_or(first_m);
    let tick = |step: usize| (step as f64 * step_m / closing_m_s, number_in_picture(step as f64 * step_m));
    let ticks = (0..=(first_m / step_m) as usize).map(tick).collect();
    Axis::linear(words::TIME).range(first_m / closing_m_s, 0.0).secondary(words::DISTANCE, ticks)
}

fn table(course: &Course) -> Table {
    let mut table = Table::new([
        "camera",
        "to_contact_s",
        "distance_m",
        "bearing_rad",
        "in_view",
        "pixels",
        "blur_pixels",
        "margin",
        "impact_m_s",
    ]);
    for camera in &course.cameras {
        for moment in &camera.moments {
            table.push(vec![
                camera.name.clone(),
                number(moment.to_contact_s),
                number(moment.distance_m),
                optional(moment.bearing_rad),
                moment.in_view.map(yes_no).unwrap_or_default(),
                number(moment.pixels),
                number(moment.blur_pixels),
                optional(moment.margin),
                number(moment.impact_m_s),
            ]);
        }
    }
    table
}
