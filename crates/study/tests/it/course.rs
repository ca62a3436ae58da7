//! The approach to a decision, moment by moment, against the verdict that it leads to and against plane geometry.

use hadar::material::Library;
use hadar_scenario::Rule;
use hadar_study::{Course, Found, Moment, RuleAnswer, RuleAsked, RuleStudy};

const NIGHT: &str = r#"cameras = ["ideal-pnrd"]
[target]
material = "skin"
temperature = "33 degC"
[[environment]]
temperature = "10 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium"]
[bands]
ranges = [["8 um", "9 um"], ["9 um", "10 um"], ["11 um", "12 um"]]
[envelope]
temperature = ["25 degC", "37 degC"]
[stop]
speed = ["20 km/h", "60 km/h"]
latency = "0.5 s"
deceleration = "5 m/s^2"
start = "4.0 s"
[[camera]]
name = "ours"
preset = "flir-a325sc"
focal_length = "10 mm"
field_of_view = "42 deg"
frames = 4
"#;

fn answered(text: &str) -> (RuleAnswer, Vec<Course>) {
    let study = RuleStudy::new(&Rule::from_toml(text, None).unwrap(), &Library::embedded().unwrap()).unwrap();
    let answer = study.answer(&RuleAsked::default(), &|_, _| ()).unwrap();
    let courses = study.courses(&answer).unwrap();
    (answer, courses)
}

fn moment_at(moments: &[Moment], distance_m: f64) -> Moment {
    *moments.iter().find(|moment| (moment.distance_m / distance_m - 1.0).abs() < 1e-12).unwrap()
}

/// Where the decision must stand the course says what the verdict says.
#[test]
fn at_the_decision_a_course_is_the_verdict() {
    let air = "[atmosphere]\nmodel = \"tropical\"\ntemperature = \"300 K\"\n";
    let small = "33 degC\"\nsize = \"0.05 m\"\n[background]\ntemperature = \"15 degC\"\n";
    let texts = [
        NIGHT.to_owned(),
        NIGHT.replace("[stop]", &format!("{air}[stop]")),
        NIGHT.replacen("33 degC\"\n", small, 1),
    ];
    for text in texts {
        let (answer, courses) = answered(&text);
        let Found::Apart(apart) = &answer.clauses[0].found else { panic!() };
        for course in &courses {
            for (camera, verdict) in course.cameras.iter().zip(&apart.cameras) {
                let near_m = (20.0 / 3.6) * 0.5 + (20.0f64 / 3.6).powi(2) / 10.0;
                let judged = near_m..=verdict.approach.unwrap().seen_from_m;
                let within = camera.moments.iter().filter(|moment| judged.contains(&moment.distance_m));
                let least = within.filter_map(|moment| moment.margin).fold(f64::INFINITY, f64::min);
                assert!(least >= verdict.margin * (1.0 - 1e-3), "{} {least} {}", camera.name, verdict.margin);
            }
        }
        let fastest = &courses[0];
        let decided_m = fastest.decision.distance_m;
        assert!((decided_m - (60.0 / 3.6 * 0.5 + (60.0f64 / 3.6).powi(2) / 10.0)).abs() < 1e-9);
        for (camera, verdict) in fastest.cameras.iter().zip(&apart.cameras) {
            let here = moment_at(&camera.moments, decided_m);
            let limit_m = verdict.limiting.distance_m.unwrap();
            if (limit_m / decided_m - 1.0).abs() < 1e-12 {
                assert!(
                    (here.margin.unwrap() / verdict.margin - 1.0).abs() < 1e-6,
                    "{here:?} {}",
                    verdict.margin
                );
            }
            assert_eq!(here.impact_m_s, 0.0);
            let blur = verdict.motion_blur_pixels.unwrap();
            assert!(here.blur_pixels <= blur * (1.0 + 1e-9), "{} {blur}", here.blur_pixels);
        }
    }
}

/// A target comes into the course of a camera as its frames are read, and leaves it with the picture; pixels are those of a pinhole.
#[test]
fn a_course_begins_with_the_frames_and_ends_with_the_picture() {
    let crossing = NIGHT
        .replace("start = \"4.0 s\"", "start = \"4.0 s\"\ncrossing_speed = \"5 km/h\"\noffset = \"2 m\"");
    let (answer, courses) = answered(&crossing);
    let approach = |camera: usize| match &answer.clauses[0].found {
        Found::Apart(apart) => apart.cameras[camera].approach.unwrap(),
        Found::Measured(_) => panic!(),
    };
    assert_eq!(courses.len(), 2, "the slow one too, at which a camera does not see in time");
    for course in &courses {
        let (w, start_m) = (course.decision.closing_m_s, course.decision.start_m.unwrap());
        for (index, camera) in course.cameras.iter().enumerate() {
            let read_m = start_m - w * approach(index).needed_s;
            for moment in &camera.moments {
                let z = moment.distance_m;
                assert!((moment.to_contact_s - z / w).abs() < 1e-12);
                let sideways = ((5.0 / 3.6) * (z / w) + 2.0) / z;
                assert!((moment.bearing_rad.unwrap().tan() - sideways).abs() < 1e-12);
                let told = moment.in_view.unwrap_or(true) && z <= read_m;
                assert_eq!(moment.margin.is_some(), told, "{moment:?}");
                if camera.name == "ours" {
                    // Its 320 pixels of 12 um behind 10 mm are narrower than its 42 degrees: seen is what both contain.
                    let half = (0.5f64 * 320.0 * 12e-6 / 10e-3).atan();
                    assert_eq!(moment.in_view, Some(sideways.atan() <= half));
                    assert!(
                        (moment.pixels * z * 42f64.to_radians() / 320.0 - 1.0).abs() < 1e-12,
                        "{moment:?}"
                    );
                }
            }
        }
    }
    assert!(courses[1].decision.speed_m_s < courses[0].decision.speed_m_s);
}

/// Without a start and without a place in the picture nothing bounds what is seen, and a rule without a vehicle has no course.
#[test]
fn what_is_not_said_bounds_nothing() {
    let (_, courses) = answered(&NIGHT.replace("start = \"4.0 s\"\n", ""));
    assert!(
        courses[0].cameras.iter().flat_map(|camera| &camera.moments).all(|moment| moment.margin.is_some())
    );
    let (stop, rest) = (NIGHT.find("[stop]").unwrap(), NIGHT.find("[[camera]]").unwrap());
    let (_, courses) = answered(&format!("{}{}", &NIGHT[..stop], &NIGHT[rest..]));
    assert!(courses.is_empty());
}
