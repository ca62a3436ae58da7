//! Solutions for distance and speed, limits, trade-off curves, elasticities and warnings of whole scenarios.

use hadar::material::Library;
use hadar::policy::elasticity::Lever;
use hadar::policy::trade_off::Resolution;
use hadar::policy::{CapCode, Quantity, Solution};
use hadar_scenario::Scenario;
use hadar_study::{Answer, Condition, Shortfall, Sizing, Study, Warning};
use std::sync::OnceLock;

const SCENE: &str = r#"
[target]
material = "skin"
temperature = "37 degC"
distance = "30 m"
size = "0.3 m"
[background]
temperature = "15 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["soda-lime-glass"]
[bands]
step = "5 cm^-1"
[camera]
preset = "flir-a325sc"
field_of_view = "12.2 deg"
netd = "10 mK"
flicker_fraction = 0.1
[requirement]
distance = 1.0
speed = "30 mph"
"#;

fn study(text: &str) -> Study {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    let library = LIBRARY.get_or_init(|| Library::embedded().unwrap());
    let scenario = Scenario::from_toml(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    Study::new(&scenario, library).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn size(text: &str) -> Sizing {
    study(text).size().unwrap()
}

fn solution(sizing: &Sizing, quantity: Quantity) -> Solution {
    let solutions = &sizing.solve_for.as_ref().unwrap().0;
    solutions.iter().find(|(of, _)| *of == quantity).unwrap().1.clone()
}

fn codes(sizing: &Sizing) -> Vec<&str> {
    sizing.warnings.iter().map(|warning| warning.code().name()).collect()
}

fn reached(sizing: &Sizing) -> f64 {
    sizing.verdict.statistical_distance.unwrap()
}

/// 3e-9: a thousand-millionth more is asked for than is required, and the solution goes through the text of a scenario.
#[test]
fn distance_and_speed_can_be_fed_back() {
    let sizing = size(SCENE);
    let distance = solution(&sizing, Quantity::Distance).value.unwrap();
    let there = size(&SCENE.replace("30 m\"\nsize", &format!("{distance:e} m\"\nsize")));
    assert!((reached(&there) - 1.0).abs() < 3e-9, "{distance}: {}", reached(&there));
    // From there the target is smaller than its pixel, whose footprint is 0.3 m at 450 m.
    assert!(distance > 450.0 && codes(&there).contains(&"target-smaller-than-pixel"));
    assert!(!codes(&sizing).contains(&"target-smaller-than-pixel"));

    let speed = solution(&sizing, Quantity::Speed).value.unwrap();
    let exposure = solution(&sizing, Quantity::Exposure).value.unwrap();
    let text = SCENE
        .replace("\"30 mph\"", &format!("\"{speed:e} m/s\""))
        .replace("netd =", &format!("exposure = \"{exposure:e} s\"\nnoise_exposure = \"12 ms\"\nnetd_temperature = \"30 degC\"\nnetd_f_number = 1.3\nnetd ="));
    let then = size(&text);
    assert!((reached(&then) - 1.0).abs() < 3e-9, "{}", reached(&then));
    let blur = then.camera.unwrap().motion_blur_pixels.unwrap();
    assert!((blur - 1.0).abs() < 3e-9, "{blur}");
}

#[test]
fn a_solution_names_the_limits_it_breaks() {
    // A demand that takes longer than motion, frame and well allow.
    let text = SCENE
        .replace("distance = 1.0", "distance = 9.0")
        .replace("netd =", "frame_rate = \"60 Hz\"\nfull_well = 5.2e6\nnetd =")
        .replace("flicker_fraction = 0.1", "flicker_fraction = 0.0");
    let sizing = size(&text);
    let exposure = solution(&sizing, Quantity::Exposure);
    let of: Vec<_> = exposure.caps.iter().map(|cap| (cap.code.name(), cap.blocks)).collect();
    assert_eq!(of, [("motion", true), ("frame-rate", true), ("full-well", true)], "{exposure:?}");
    // It would tell the spectra apart, and blurs.
    assert!(exposure.value.is_none() && exposure.reason.is_some(), "{exposure:?}");
    let needed = exposure.necessary.unwrap();
    assert!(needed > 1.0 / 60.0);
    let speed = solution(&sizing, Quantity::Speed);
    let of: Vec<_> = speed.caps.iter().map(|cap| cap.code.name()).collect();
    assert_eq!(of, ["motion", "frame-rate", "full-well"]);
    // In units of speed: a frame leads to the speed that moves a pixel in it.
    let frame = speed.caps[1].limit / speed.necessary.unwrap();
    assert!((frame / (60.0 * needed) - 1.0).abs() < 3e-9, "{frame}");
    // Least demanding: no limit in the way.
    let easy = size(&SCENE.replace("distance = 1.0", "distance = 0.1"));
    assert!(solution(&easy, Quantity::Exposure).caps.is_empty());
    assert_eq!(solution(&easy, Quantity::FNumber).caps[0].code, CapCode::Diffraction);
}

/// Points of every curve put back into the scenario meet the demand as the solutions do.
#[test]
fn points_of_the_curves_meet_the_demand() {
    let study = study(SCENE);
    let sizing = study.size().unwrap();
    let curves = study.trade_offs(&sizing).unwrap();
    let pairs: Vec<_> = curves.iter().map(|curve| (curve.x.key(), curve.y.key())).collect();
    let expected = [
        ("f_number", "exposure_s"),
        ("pixel_m", "noise_counts"),
        ("distance_m", "frames"),
        ("exposure_s", "speed_m_s"),
    ];
    assert_eq!(pairs, expected);
    assert!(curves.iter().all(|curve| curve.points.len() >= Resolution::FINE.points));
    for i in [3, 14, 20] {
        let point = &curves[0].points[i];
        let (f_number, exposure) = (point.x, point.y.unwrap());
        let keys = format!(
            "f_number = {f_number:e}\nexposure = \"{exposure:e} s\"\nnoise_exposure = \"12 ms\"\nnetd_temperature = \"30 degC\"\nnetd_f_number = 1.3\nnetd ="
        );
        let there = reached(&size(&SCENE.replace("netd =", &keys)));
        assert!((there - 1.0).abs() < 3e-9, "f/{f_number}, {exposure} s: {there}");
    }
    // The camera lies on the curve of what is as good as it is.
    for curve in &curves {
        let own = curve.points.iter().find(|point| (point.x / curve.camera.0 - 1.0).abs() < 1e-9);
        let Some(own) = own else { continue };
        let as_now = own.y_as_now.unwrap_or(f64::NAN);
        assert!((as_now / curve.camera.1 - 1.0).abs() < 1e-5, "{:?}: {as_now} {:?}", curve.y, curve.camera);
    }
}

/// Both numbers of a curve at which the solver arrives alone are on it, and told as forbidden where they are.
#[test]
fn what_the_solver_finds_is_on_the_curves_and_classified() {
    // More than the camera reaches takes longer than a frame of 80 Hz.
    let scene = SCENE.replace("netd =", "frame_rate = \"80 Hz\"\nfull_well = 1e12\nnetd =");
    for (text, allowed) in
        [(scene.replace("80 Hz", "1 Hz").replace("30 mph", "0.1 m/s"), true), (scene, false)]
    {
        let demand = 1.3 * reached(&size(&text));
        let text = text.replace("distance = 1.0", &format!("distance = {demand:?}"));
        let study = study(&text);
        let sizing = study.size().unwrap();
        let curves = study.trade_offs(&sizing).unwrap();
        let of = |y: Quantity| curves.iter().find(|curve| curve.y == y).unwrap();
        let [exposure, speed] =
            [Quantity::Exposure, Quantity::Speed].map(|q| solution(&sizing, q).necessary.unwrap());
        let alone = of(Quantity::Exposure).points.iter().find(|point| point.x == 1.3).unwrap();
        let start = of(Quantity::Speed).points.iter().find(|point| point.y.is_some()).unwrap();
        assert!((alone.y.unwrap() / exposure - 1.0).abs() < 3e-9);
        let both = [start.x / exposure, start.y.unwrap() / speed];
        assert!(both.iter().all(|ratio| (ratio - 1.0).abs() < 3e-9), "{both:?}");
        for point in [alone, start] {
            assert_eq!(point.within_limits.is_some(), allowed, "{point:?}");
            let breaks = point.capped.iter().any(|code| *code != CapCode::Diffraction);
            assert_eq!(breaks, !allowed, "{point:?}");
        }
    }
}

/// A camera whose wells overflow has no distance and no number of frames with which it would do.
#[test]
fn what_spoils_every_image_is_within_no_limits() {
    let scene = SCENE.replace("netd =", "full_well = 1e3\nnetd =");
    let study = study(&scene);
    let sizing = study.size().unwrap();
    let curves = study.trade_offs(&sizing).unwrap();
    let frames = curves.iter().find(|curve| curve.y == Quantity::Frames).unwrap();
    let met: Vec<_> = frames.points.iter().filter(|point| point.y.is_some()).collect();
    assert!(!met.is_empty());
    for point in met {
        assert!(point.within_limits.is_none() && point.capped.contains(&CapCode::FullWell), "{point:?}");
    }
    // No demand is met where nothing differs, and no curve drawn.
    let nothing = size(&SCENE.replace("37 degC", "20 degC").replace("lighting = 0.5", "lighting = 1.0"));
    assert_eq!(nothing.verdict.met, Some(false));
    let scene = SCENE.replace("37 degC", "20 degC").replace("lighting = 0.5", "lighting = 1.0");
    let study = self::study(&scene);
    assert!(study.trade_offs(&study.size().unwrap()).unwrap().is_empty());
}

/// The more distant, the more frames; one less is not enough.
#[test]
fn distance_is_traded_for_frames() {
    let scene = SCENE
        .replace("distance = 1.0", "distance = 2.0")
        .replace("flicker_fraction = 0.1", "flicker_fraction = 0.0");
    let study = study(&scene);
    let sizing = study.size().unwrap();
    let curves = study.trade_offs(&sizing).unwrap();
    let curve = curves.iter().find(|curve| curve.y == Quantity::Frames).unwrap();
    let frames: Vec<f64> = curve.points.iter().filter_map(|point| point.y).collect();
    assert!(frames.windows(2).all(|pair| pair[0] <= pair[1]) && frames.last() > Some(&1.0), "{frames:?}");
    let point = curve.points.iter().find(|point| point.y > Some(1.0)).unwrap();
    for (less, enough) in [(0.0, true), (1.0, false)] {
        let count = point.y.unwrap() - less;
        let text = scene
            .replace("30 m\"\nsize", &format!("{:e} m\"\nsize", point.x))
            .replace("netd =", &format!("frames = {count}\nnetd ="));
        assert_eq!(reached(&size(&text)) >= 2.0 * (1.0 - 1e-9), enough, "{count} frames at {} m", point.x);
    }
}

/// 1e-6: differences of two answers that are good to 1e-11 over a step of 1e-4, and their second order.
#[test]
fn elasticities_are_those_of_whole_answers() {
    let sizing = size(SCENE);
    let found = sizing.sensitivity.unwrap();
    let of = |lever: Lever| {
        let elasticities = &found.elasticities.0;
        elasticities.iter().find(|(of, _)| *of == lever).unwrap().1.unwrap().value
    };
    let step = 1e-4f64;
    let slope = |text: &dyn Fn(f64) -> String| {
        let [more, less] = [step, -step].map(|step| reached(&size(&text(step.exp()))));
        (more / less).ln() / (2.0 * step)
    };
    let with = |keys: String| {
        SCENE.replace(
            "netd =",
            &format!(
                "{keys}\nnoise_exposure = \"12 ms\"\nnetd_pixel = \"12 um\"\nnetd_temperature = \"30 degC\"\nnetd_f_number = 1.3\nnetd ="
            ),
        )
    };
    let cases: [(Lever, &dyn Fn(f64) -> String); 3] = [
        (Lever::Exposure, &|by| with(format!("exposure = \"{:e} s\"", 12e-3 * by))),
        (Lever::Pixel, &|by| with(format!("pixel = \"{:e} m\"", 12e-6 * by))),
        (Lever::FNumber, &|by| with(format!("f_number = {:e}", 1.3 * by))),
    ];
    for (lever, text) in cases {
        let exact = slope(text);
        assert!((of(lever) - exact).abs() < 1e-6, "{lever:?}: {} {exact}", of(lever));
    }
    // The electronic part alone, not the shot noise that an NETD contains.
    let counts = sizing.camera.unwrap().noise_counts;
    let noise =
        slope(&|by| SCENE.replace("netd = \"10 mK\"", &format!("noise_electrons = {:e}", counts * by)));
    assert!((of(Lever::Noise) - noise).abs() < 1e-6);
}

#[test]
fn errors_of_the_emissivities_are_told() {
    let with = |error: &str| {
        format!("{SCENE}[sensitivity]\nemissivity_error = {error}\ncorrelation = \"10 cm^-1\"\n")
    };
    let none = size(&with("0.0")).sensitivity.unwrap().emissivity;
    assert_eq!((none.distance_5, none.distance_95, none.share_met), (none.distance, none.distance, 1.0));
    // Small errors act to first order: 5 and 95 % of a Gaussian lie 1.645 deviations out, which 64 draws tell to 20 %.
    let small = size(&with("1e-6")).sensitivity.unwrap().emissivity;
    let spread = (small.distance_95 - small.distance_5) / (2.0 * 1.645);
    let ratio = spread / small.sigma_linear.unwrap();
    assert!((0.6..1.5).contains(&ratio), "{ratio}: {small:?}");
    // The same whatever the number of threads.
    let pool = rayon_pool(1);
    let one = pool(&with("0.005"));
    assert_eq!(one, size(&with("0.005")).sensitivity.unwrap().emissivity.distance_50);
    // The paper's pair is nearly featureless: errors only ever make the spectra differ more.
    let fragile = SCENE
        .replace("soda-lime-glass", "aluminium")
        .replace("size = \"0.3 m\"\n[background]\ntemperature = \"15 degC\"\n", "");
    let found = size(&fragile).sensitivity.unwrap().emissivity;
    assert!(found.distance_5 > 2.0 * found.distance, "{found:?}");
}

fn rayon_pool(threads: usize) -> impl Fn(&str) -> f64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    move |text: &str| pool.install(|| size(text).sensitivity.unwrap().emissivity.distance_50)
}

#[test]
fn assumptions_that_fail_are_warned_of() {
    let cases: [(&str, &str, &str); 7] = [
        ("diffraction", "", ""),
        ("full-well", "netd =", "full_well = 1e3\nnetd ="),
        ("motion-blur", "30 mph", "60 mph"),
        ("frame-rate", "netd =", "frames = 4\nframe_rate = \"60 Hz\"\nnetd ="),
        (
            "outside-detector-range",
            "step = \"5 cm^-1\"",
            "start = \"712 cm^-1\"\nstop = \"1232 cm^-1\"\nstep = \"20 cm^-1\"",
        ),
        ("bunching", "37 degC", "400 degC"),
        (
            "motion-blur-unknown",
            "distance = \"30 m\"\nsize = \"0.3 m\"\n[background]\ntemperature = \"15 degC\"\n",
            "",
        ),
    ];
    let usual = size(SCENE);
    for (code, from, to) in cases {
        let text = SCENE.replace(from, to);
        if code != "diffraction" {
            assert!(!codes(&usual).contains(&code), "{code}");
        }
        let sizing = size(&text);
        assert!(codes(&sizing).contains(&code), "{code}: {:?}", sizing.warnings);
    }
    let boson =
        SCENE.replace("\"flir-a325sc\"", "\"flir-boson-640-14mm\"\nf_number = 1.0\nreadout = \"sequential\"");
    assert!(codes(&size(&boson)).contains(&"camera-figure-assumed"));
    let stated = size(&SCENE.replace(
        "netd =",
        "full_well = 1e12\nquantisation_bits = 16\n\
         fixed_pattern = \"0 mK\"\nrow_noise = \"0 mK\"\ncolumn_noise = \"0 mK\"\noffset_drift = \"0 mK\"\n\
         quantum_efficiency = 1\ndark_rate = \"0 1/s\"\nread_noise = 0\nnetd =",
    ));
    assert!(!codes(&stated).contains(&"camera-figure-assumed"));
    // A pixel as large as the blur, and bunching that is in the noise.
    let sharp = size(&SCENE.replace("netd =", "pixel = \"20 um\"\nnetd ="));
    assert!(!codes(&sharp).contains(&"diffraction"));
    let hot = size(&SCENE.replace("37 degC", "400 degC").replace("netd =", "photon_bunching = true\nnetd ="));
    let included = |warning: &Warning| matches!(warning, Warning::Bunching { included: true, .. });
    assert!(hot.warnings.iter().any(included), "{:?}", hot.warnings);
}

/// A state that was found shows a 'no' without any proof, whatever is unknown; the whole answer is the same.
#[test]
fn a_no_alone_is_that_of_the_whole_answer() {
    for unknown in
        ["\"temperature\"", "\"temperature\", \"environment-temperature\"", "\"lighting\", \"gain\""]
    {
        for (distance, met) in [("0.001", true), ("30.0", false)] {
            let text = SCENE.replace("distance = 1.0", &format!("distance = {distance}"));
            let text = format!("{text}\n[unknown]\nnuisances = [{unknown}]\n");
            let whole = study(&text).size().unwrap().verdict.met;
            assert_eq!(whole, Some(met), "{unknown} {distance}");
            let alone = study(&text).no_alone().unwrap().map(|result| result.verdict.met);
            assert_eq!(alone, (!met).then_some(Some(false)), "{unknown} {distance}");
        }
    }
}

/// An object has no more pixels than the camera: of the 32 x 16 at least that 32 across have, or of those that are stated.
#[test]
fn an_object_has_no_more_pixels_than_the_camera() {
    let scene = SCENE.replace("speed = \"30 mph\"\n", "of = \"object\"\n");
    let scene = scene.replace("field_of_view = \"12.2 deg\"\n", "pixels = 32\n");
    let seen = |text: &str| -> f64 {
        let found = study(text).size().unwrap().verdict.sentence.pixels;
        found.unwrap_or(1.0)
    };
    let mut before = 0.0;
    for (size_m, most) in [("0.5 m", 512.0), ("5 m", 512.0), ("200 m", 512.0)] {
        let pixels = seen(&scene.replace("0.3 m", size_m));
        assert!(pixels <= most && pixels >= before, "{size_m}: {pixels}");
        before = pixels;
    }
    assert_eq!(before, 512.0);
    let behind = "size = \"0.3 m\"\n[background]\ntemperature = \"15 degC\"\n";
    for (stated, pixels) in [("1000000", 1024.0), ("[8, 40]", 256.0), ("[30, 10]", 300.0)] {
        assert_eq!(seen(&scene.replace(behind, &format!("pixels = {stated}\n"))), pixels, "{stated}");
    }
}

/// A figure that is deleted is a condition: patterns of a camera of read noise alone, pixels of an array before an object, rows of a filter.
#[test]
fn what_is_deleted_of_a_camera_of_ones_own_is_a_condition() {
    let camera = "flicker_fraction = 0.1\n";
    let own = "exposure = \"1 ms\"\npixel = \"25 um\"\nf_number = 1.0\nfocal_length = \"50 mm\"\noptics_efficiency = 0.9\n\
               noise_electrons = 0\nread_noise = 360\nfixed_pattern = \"1 mK\"\nrow_noise = \"1 mK\"\ncolumn_noise = \"1 mK\"\noffset_drift = \"1 mK\"\n\
               flicker_fraction = 0.1\n";
    let text = SCENE.replace(camera, "").replace("preset = \"flir-a325sc\"\n", own);
    let text = text.replace("field_of_view = \"12.2 deg\"\n", "").replace("netd = \"10 mK\"\n", "");
    let text = text.replace("distance = 1.0", "distance = 0.01").replace("speed = \"30 mph\"\n", "");
    let holds = |text: &str, code: &str| -> bool {
        let verdict = study(text).size().unwrap().verdict;
        assert_eq!(verdict.met, Some(true));
        verdict.conditions.iter().any(|one| one.code() == code)
    };
    assert!(!holds(&text, "fixed-pattern"));
    for line in [
        "fixed_pattern = \"1 mK\"\n",
        "row_noise = \"1 mK\"\n",
        "column_noise = \"1 mK\"\n",
        "offset_drift = \"1 mK\"\n",
    ] {
        assert!(holds(&text.replace(line, ""), "fixed-pattern"), "{line}");
    }
    let object = format!("{text}of = \"object\"\n");
    assert!(holds(&object, "pixels") && !holds(&text, "pixels"));
    assert!(!holds(&object.replace("read_noise", "pixels = 640\nread_noise"), "pixels"));
    let folder = tempfile::tempdir().unwrap();
    let filters = |rows: &str| {
        let path = folder.path().join("f.csv");
        std::fs::write(&path, format!("wavelength_um,a,b\n{rows}")).unwrap();
        text.replace("step = \"5 cm^-1\"", &format!("filters = \"{}\"", path.display()))
    };
    assert!(!holds(&filters("8,0,0\n8.2,0.9,0\n9,0.9,0.9\n13,0,0.9\n13.2,0,0\n"), "filter-cut"));
    assert!(holds(&filters("8.2,0.9,0\n9,0.9,0.9\n13,0,0.9\n13.2,0,0\n"), "filter-cut"));
    assert!(holds(&filters("8,0,0\n8.2,0.9,0\n9,0.9,0.9\n13,0,0.9\n"), "filter-cut"));
}

/// At 60 Hz four frames of 12 ms take 12 ms + 3/60 s, in which 30 mph (13.4112 m/s) go 0.83 m; motion that is not known is not met.
#[test]
fn a_yes_says_what_it_hangs_on_at_a_speed() {
    let easy = SCENE.replace("distance = 1.0", "distance = 0.01");
    let of = |text: &str| study(text).size().unwrap().verdict;
    // The answer that ends at the first proof is a 'no' alone.
    let alone = |text: &str| study(text).no_alone().unwrap().map(|result| result.verdict);
    let frames = easy.replace("netd =", "frames = 4\nframe_rate = \"60 Hz\"\nnetd =");
    let verdict = of(&frames);
    assert!(verdict.met == Some(true) && verdict.sentence.conditions == verdict.conditions);
    let frames_of = |one: &Condition| match one {
        Condition::RegisteredFrames(proviso) => Some(*proviso),
        _ => None,
    };
    let proviso = verdict.conditions.iter().find_map(frames_of).unwrap();
    assert_eq!(proviso.frames, 4);
    assert!((proviso.time_s / 0.062 - 1.0).abs() < 1e-12, "{proviso:?}");
    assert!((proviso.way_m / 0.831_494_4 - 1.0).abs() < 1e-9, "{proviso:?}");
    assert_eq!(alone(&frames), None);
    let at_rest = easy.replace("speed = \"30 mph\"\n", "").replace("netd =", "frames = 4\nnetd =");
    for (text, still) in [(&easy, false), (&at_rest, true)] {
        let verdict = of(text);
        assert_eq!(verdict.met, Some(true));
        let is_still = |one: &Condition| matches!(one, Condition::StillScene { .. });
        assert_eq!(verdict.conditions.iter().any(is_still), still, "{:?}", verdict.conditions);
        assert!(!verdict.conditions.iter().any(|one| matches!(one, Condition::RegisteredFrames(_))));
    }
    let nowhere =
        easy.replace("distance = \"30 m\"\nsize = \"0.3 m\"\n[background]\ntemperature = \"15 degC\"\n", "");
    for verdict in [of(&nowhere), alone(&nowhere).unwrap()] {
        let spoiled = vec![Shortfall::MotionUnknown];
        assert!(matches!(&verdict.sentence.answer, Answer::Judged { spoiled: own, .. } if *own == spoiled));
        assert_eq!((verdict.met, verdict.fails_by), (Some(false), vec![Shortfall::MotionUnknown]));
        assert!(verdict.conditions.iter().all(|one| !one.favourable()));
    }
}
