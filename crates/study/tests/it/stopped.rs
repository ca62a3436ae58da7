//! Questions that are stopped at any of their checks: they end as stopped, and asked again they are answered as ever.
//!
//! On one thread the number of checks is that of the work, so that nothing here depends on a clock.

use hadar::demand::Skipping;
use hadar::material::Library;
use hadar::random::generator;
use hadar::stop::{self, Stop};
use hadar_scenario::{Scenario, Written};
use hadar_simulate::classifier::Method;
use hadar_simulate::experiment::Design;
use hadar_study::sweep::{Asking, Question};
use hadar_study::{PhotonLaw, Remembered, SimulationPlan, Study};
use rand::RngExt as _;

const SCENE: &str = "[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\n\
    [[environment]]\ntemperature = \"10 degC\"\nlighting = 0.5\n\
    [alternatives]\nmaterials = [\"aluminium\", \"pmma\"]\n[bands]\nstep = \"100 cm^-1\"\n\
    [unknown]\nnuisances = [\"temperature\", \"lighting\"]\n";
const CAMERA: &str = "[camera]\npreset = \"flir-a325sc\"\n";
const RULE: &str =
    "cameras = [\"flir-a325sc\"]\n[rule]\nname = \"r\"\ntext = \"t\"\nauthority = \"a\"\nversion = \"1\"\n";
const ENVELOPE: &str = "[requirement]\ndetection_probability = 0.9\n[envelope]\ntemperature = [\"30 degC\", \"36 degC\"]\n\
    lighting = [0.4, 0.6]\nsurroundings = [\"5 degC\", \"15 degC\"]\ndistance = [\"5 m\", \"20 m\"]\n";
const RANGE: &str = "[scene]\nperson_temperature = \"33 degC\"\nperson_distance = \"10 m\"\nground_temperature = \"12 degC\"\n\
    sky_temperature = \"-15 degC\"\nsize = [24, 32]\n[bands]\nstart = \"720 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"200 cm^-1\"\n\
    [camera]\nexposure = \"5 ms\"\npixel = \"180 um\"\nf_number = 1.0\nfocal_length = \"14 mm\"\nnoise_electrons = 3000\n\
    noise_exposure = \"5 ms\"\n[stereo]\nbaseline = \"0.2 m\"\nwindow = [5, 5]\n";

/// Fewer spectra than a row of a sweep has, and no network.
fn few() -> SimulationPlan {
    let methods = vec![Method::LikelihoodRatio, Method::BestFits, Method::Discriminant, Method::Logistic];
    SimulationPlan {
        photons: vec![100.0],
        law: PhotonLaw::Poisson,
        camera_noise: false,
        against: Vec::new(),
        design: Design { per_class: 200, methods, seed: 1, level: 0.95, skip_spectra: false },
        models: Vec::new(),
        save_spectra: false,
    }
}

#[test]
fn whoever_is_stopped_leaves_nothing_half_done() {
    let library = Library::embedded().unwrap();
    let simulated = SCENE.to_owned() + "[requirement]\ndistance = 1.0\n";
    let asked = [
        ("size", format!("{SCENE}{CAMERA}")),
        ("identify", format!("{SCENE}{CAMERA}")),
        ("simulate", simulated),
        ("rule", format!("{RULE}{SCENE}{ENVELOPE}")),
        ("range", RANGE.to_owned()),
    ];
    let remembered = Remembered::default();
    for (stream, (name, text)) in (0..).zip(asked) {
        let question = Question::named(name).unwrap();
        let written = Written::of(&text, None);
        let answered = |stop: &Stop| {
            let asking = Asking {
                library: &library,
                remembered: &remembered,
                by: None,
                skip_uncovered: false,
                skipping: Skipping::On,
                seed: 1,
                method: hadar_estimate::decompose::Method::Ml,
                columns: &[],
                voice: |_| String::new(),
            };
            let threads = stop.own_threads(1).unwrap();
            let answer = || match question {
                Question::Simulate => {
                    let study =
                        Scenario::from_written(&written).and_then(|scenario| Study::new(&scenario, &library));
                    format!(
                        "{:?}",
                        study
                            .and_then(|study| study.simulate(&few(), &|_, _| ()))
                            .map(|found| found.0.points)
                    )
                }
                _ => format!("{:?}", question.answer(&written, &asking).map(|answer| answer.record)),
            };
            stop::within(stop, || threads.install(answer))
        };
        let counting = Stop::at_check(0);
        let expected = answered(&counting).unwrap();
        assert!(expected.starts_with("Ok"), "{name}: {expected}");
        // What is remembered is not computed again.
        let counting = Stop::at_check(0);
        assert_eq!(answered(&counting).as_ref(), Ok(&expected), "{name}");
        let all = counting.checks();
        assert!(all > 10, "{name}: {all} checks");
        let mut random = generator(41, stream);
        // As often early as late, on a scale of ratios; and the very last one.
        let early = (0..3).map(|_| (all as f64).powf(random.random_range(0.0..1.0)) as usize);
        for number in early.chain([all]) {
            let stop = Stop::at_check(number.clamp(1, all));
            assert!(answered(&stop).is_err(), "{name}, check {number} of {all}");
        }
        assert_eq!(answered(&Stop::new()), Ok(expected), "{name}");
    }
}
