//! `--check`: a line a camera, what is known of it and how.

use super::text::{fails_by, without_placeholders};
use crate::text::significant;
use hadar_study::study::{CameraVerdict, RuleAnswer, Shortfall};

/// A line for every camera.
#[must_use]
pub fn check(answer: &RuleAnswer) -> String {
    let required = answer.requirement.distance;
    answer.cameras.iter().map(|camera| format!("{}: {}\n", camera.name, line(camera, required))).collect()
}

fn line(camera: &CameraVerdict, required: f64) -> String {
    let times = |distance: f64| format!("{} times the demand", at_least(distance / required));
    let said = if camera.passes {
        let known = match camera.lower_bound {
            Some(bound) if bound >= required => format!("proved: at least {} everywhere", times(bound)),
            _ => {
                let least = times(camera.statistical_distance);
                format!("met, but searched and not proved: {least} where it is least")
            }
        };
        let proviso = camera.provided.as_ref().map_or_else(String::new, |proviso| format!(", if {proviso}"));
        known + &proviso
    } else {
        let short = camera.fails_by.contains(&Shortfall::Distance) && camera.margin > 0.0;
        let margin = format!("{} times the demand: ", significant(camera.margin, 3));
        format!("not met: {}{}", if short { margin.as_str() } else { "" }, fails_by(camera))
    };
    said + &without_placeholders(camera)
}

/// Three digits, none of them rounded up: what is promised is kept.
fn at_least(ratio: f64) -> String {
    let digits = significant(ratio, 3);
    match digits.parse::<f64>() {
        Ok(shown) if shown > ratio => {
            significant(ratio - 0.5 * 10f64.powf(ratio.abs().log10().floor() - 2.0), 3)
        }
        _ => digits,
    }
}

#[cfg(test)]
mod tests {
    use super::at_least;

    #[test]
    fn what_is_promised_is_not_rounded_up() {
        let cases = [
            (1.6289, "1.62"),
            (1.0009, "1.00"),
            (2.0, "2.00"),
            (9.999, "9.99"),
            (123.9, "123"),
            (0.99999, "0.999"),
        ];
        for (ratio, shown) in cases {
            assert_eq!(at_least(ratio), shown);
        }
    }
}
