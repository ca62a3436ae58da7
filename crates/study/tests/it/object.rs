//! Verdicts of an object beside those of a pixel.

use hadar::identifiability::detection;
use hadar::material::Library;
use hadar_scenario::Scenario;
use hadar_study::{Condition, Grade, Sizing, Study, YesNo};
use std::sync::OnceLock;

fn try_size(text: &str) -> Result<Sizing, String> {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    let library = LIBRARY.get_or_init(|| Library::embedded().unwrap());
    let study = Scenario::from_toml(text, None).and_then(|scenario| Study::new(&scenario, library));
    study.and_then(|study| study.size()).map_err(|error| error.to_string())
}

fn size(text: &str) -> Sizing {
    try_size(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Filters before a microbolometer; `of` stands in `[target]`, `camera` and `requirement` in theirs, `more` behind all.
fn scene(of: &str, camera: &str, requirement: &str, more: &str) -> String {
    format!(
        "[target]\nmaterial = \"skin\"\ntemperature = \"34 degC\"\ndistance = \"30 m\"\n{of}\n\
         [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
         [alternatives]\nmaterials = [\"pmma\", \"aluminium\"]\n\
         [bands]\nranges = [[\"8 um\", \"9 um\"], [\"9 um\", \"10 um\"], [\"10 um\", \"11 um\"], [\"11 um\", \"13 um\"]]\n\
         [unknown]\nnuisances = [\"temperature\", \"lighting\"]\n\
         [camera]\npreset = \"flir-boson-640-14mm\"\nf_number = 1.0\n{camera}\n\
         [requirement]\ndetection_probability = 0.8413\n{requirement}\n{more}\n"
    )
}

const WHITE: &str = "fixed_pattern = \"0 mK\"\nrow_noise = \"0 mK\"\ncolumn_noise = \"0 mK\"\noffset_drift = \"0 mK\"\nflicker_fraction = 0.0";
const ERRORS: &str = "[sensitivity]\nemissivity_error = \"0.005 absolute\"";

/// The sheet states row and column noise of 14 mK each beside 40 mK a pixel: with them no number of frames is enough; without them
/// sixty of them said yes.
#[test]
fn frames_do_not_average_away_what_a_sheet_says_they_do_not() {
    let found = size(&scene("", "frames = 60", "", ""));
    assert_eq!((found.verdict.answer, found.verdict.scope), (Some(YesNo::No), "pixel"));
    let d = found.verdict.upper.unwrap();
    let white = size(&scene("", &format!("frames = 60\n{WHITE}"), "", ""));
    assert_eq!(white.verdict.answer, Some(YesNo::Yes));
    // By hand: √(40²/60) mK beside √(40²/60 + 2·14²) mK; a NETD holds the shot noise of its own photons, some 0.3 % of it here.
    let ratio = (40f64 * 40.0 / 60.0).sqrt() / (40f64 * 40.0 / 60.0 + 2.0 * 14.0 * 14.0).sqrt();
    assert!((d / white.verdict.upper.unwrap() / ratio - 1.0).abs() < 5e-3, "{d}");
    let endless = size(&scene("", "frames = 100000000", "", ""));
    assert!(endless.verdict.upper.unwrap() < 1.05 * d && endless.verdict.answer == Some(YesNo::No));
    let frames = &found.solve_for.unwrap().0.into_iter().find(|(q, _)| q.key() == "frames").unwrap().1;
    assert!(frames.value.is_none() && frames.reason.as_ref().unwrap().contains("row and column noise"));
}

/// An object of one pixel is that pixel, bit for bit.
#[test]
fn an_object_of_one_pixel_is_a_pixel() {
    for camera in ["frames = 60", "", WHITE] {
        let pixel = size(&scene("", camera, "", ""));
        let object = size(&scene("pixels = 1", camera, "", ""));
        assert_eq!(object.verdict.scope, "object");
        assert_eq!(pixel.pairs, object.pairs);
        assert_eq!([pixel.verdict.lower, pixel.verdict.upper], [object.verdict.lower, object.verdict.upper]);
        let small = "size = \"20 mm\"\n[background]\ntemperature = \"15 degC\"";
        let [pixel, object] = ["", "of = \"object\""].map(|of| size(&scene(small, camera, of, "")));
        assert_eq!(pixel.pairs, object.pairs, "an object within a pixel");
    }
}

/// Without anything in common d grows as the root of the readings; what pixels of an object share is said to be open.
#[test]
fn without_anything_in_common_it_is_the_root_of_the_readings() {
    let one = size(&scene("pixels = 1", WHITE, "", ""));
    for (pixels, frames) in [(5, 1), (400, 1), (400, 60), (400_000, 7)] {
        let all = size(&scene(&format!("pixels = {pixels}"), &format!("frames = {frames}\n{WHITE}"), "", ""));
        let n = f64::from(pixels) * f64::from(frames);
        for (one, all) in one.pairs.iter().zip(&all.pairs) {
            let ratio = all.statistical_distance.unwrap() / one.statistical_distance.unwrap() / n.sqrt();
            // To what a minimum is known.
            assert!((ratio - 1.0).abs() < 1e-9, "{pixels} {frames}: {ratio}");
        }
        let object = all.object.unwrap();
        assert!((object.effective_readings / n - 1.0).abs() < 1e-6 && object.ceiling_bounds.is_none());
        let codes: Vec<String> = all.verdict.conditions.iter().map(Condition::code).collect();
        for code in ["alike-pixels", "frame-noise", "shared-emissivity-errors"] {
            let is_yes = all.verdict.answer == Some(YesNo::Yes);
            assert_eq!(codes.iter().any(|one| one == code), is_yes, "{codes:?}");
        }
    }
}

/// n_eff of the formula of three-dimensional noise: 30 × 10 pixels and 60 frames are worth (40² / 5.12²) mK.
#[test]
fn thirty_by_ten_pixels_of_sixty_frames_are_worth_sixty() {
    let found = size(&scene("pixels = [30, 10]", "frames = 60", "", ""));
    let object = found.object.unwrap();
    let mean_var: f64 = 14.0 * 14.0 / 30.0 + 14.0 * 14.0 / 10.0 + 40.0 * 40.0 / (60.0 * 300.0);
    // One reading has its rows and columns too.
    let one_var = 40.0 * 40.0 + 2.0 * 14.0 * 14.0;
    assert!((object.effective_readings / (one_var / mean_var) - 1.0).abs() < 2e-3, "{object:?}");
    let [lower, upper] = object.ceiling_bounds.unwrap();
    let ratio = upper / object.distance_bounds[1];
    assert!((ratio / (mean_var / (mean_var - 40.0 * 40.0 / 18000.0)).sqrt() - 1.0).abs() < 1e-3);
    assert!(lower <= upper && object.frames_worth == Some(1.0), "{object:?}");
    let shares: Vec<f64> = object.ceiling_made_of.iter().map(|one| one.share).collect();
    assert!((shares[0] - 0.75).abs() < 0.01 && (shares[1] - 0.25).abs() < 0.01, "{object:?}");
}

/// Errors of the emissivities that are stated are in the verdict, which no number of frames mends; those that nobody states are a condition.
#[test]
fn errors_of_the_emissivities_end_what_frames_and_pixels_do() {
    let of = |frames: u32, more: &str| {
        size(&scene("pixels = 400", &format!("frames = {frames}\n{WHITE}"), "", more))
    };
    let silent = of(60, "");
    assert_eq!(silent.verdict.answer, Some(YesNo::Yes));
    assert!(silent.verdict.conditions.iter().any(|one| one.code() == "shared-emissivity-errors"));
    assert_eq!(silent.verdict.grade, Some(Grade::Assumed));
    let mut last = 0.0;
    for frames in [1, 60, 6000, 4_000_000_000] {
        let with = of(frames, ERRORS);
        let [lower, upper] = [with.verdict.lower.unwrap(), with.verdict.upper.unwrap()];
        assert!(lower <= upper && upper <= of(frames, "").verdict.upper.unwrap() * (1.0 + 1e-9));
        assert!(upper >= last * (1.0 - 1e-6), "{frames}: {upper} {last}");
        assert_ne!(with.verdict.answer, Some(YesNo::Yes), "{frames}");
        assert_ne!(with.verdict.grade, Some(Grade::Proved), "{frames}");
        last = upper;
    }
    // The ceiling is there, and it is of the emissivities.
    let object = of(60, ERRORS).object.unwrap();
    let [_, ceiling] = object.ceiling_bounds.unwrap();
    assert!((ceiling / last - 1.0).abs() < 1e-3, "{ceiling} {last}");
    assert_eq!(object.ceiling_made_of[0].label, "errors of the emissivities");
    // Smaller errors, a higher ceiling: without end as the inverse.
    let finer = of(60, "[sensitivity]\nemissivity_error = \"0.0005 absolute\"").object.unwrap();
    assert!((finer.ceiling_bounds.unwrap()[1] / ceiling / 10.0 - 1.0).abs() < 0.05, "{finer:?}");
    // Of one pixel they are what they were: a condition alone.
    let pixel = size(&scene("", WHITE, "", ERRORS));
    assert_eq!(pixel.pairs, size(&scene("", WHITE, "", "")).pairs);
}

/// The pixels that a size fills are those within the blur of the lens, and fall with the distance.
#[test]
fn a_size_fills_the_pixels_within_the_blur() {
    let of = |distance: &str| {
        let text =
            scene("size = \"0.5 m\"\n[background]\ntemperature = \"15 degC\"", WHITE, "of = \"object\"", "");
        size(&text.replace("\"30 m\"", distance)).object.unwrap()
    };
    // 0.5 m of 12 um z/14 mm; two rings of 1.22 · 13 um · 1.0, and two pixels at the edges.
    let side = |z: f64| 0.5 / (12e-6 * z / 14e-3) - 2.0 * 1.22 * 13.0 / 12.0 - 2.0;
    for (said, z) in [("\"10 m\"", 10.0), ("\"30 m\"", 30.0), ("\"60 m\"", 60.0)] {
        let found = of(said);
        assert!(
            (found.rows / side(z) - 1.0).abs() < 1e-2 && found.rows == found.columns,
            "{found:?} {}",
            side(z)
        );
    }
    let far = of("\"600 m\"");
    assert_eq!(far.pixels, 1.0);
    assert!(
        detection::probability(far.distance_bounds[1])
            < detection::probability(of("\"10 m\"").distance_bounds[0])
    );
}

#[test]
fn what_is_no_object_is_refused() {
    let says = |of: &str, requirement: &str, what: &str| {
        let error = try_size(&scene(of, "", requirement, "")).unwrap_err();
        assert!(error.contains(what), "{error}");
    };
    says("", "of = \"object\"", "the size of the object is not stated");
    says("pixels = 0", "", "whole number from 1");
    says("pixels = [0, 3]", "", "whole number from 1");
    says("pixels = 3.5", "", "whole number");
    says("pixels = [3]", "", "pixels");
    says("pixels = 200000000", "", "100000000");
    says("pixels = 4\nsize = \"1 m\"", "", "size");
    says("pixels = 4", "of = \"car\"", "pixel");
}

/// Of fewer states the nearest is no nearer: what is proved of all of them is no more than what is found of some. Dark surroundings give an
/// alternative of high emissivity more contrast, and so larger errors, than the state that is nearest without any: of that state alone the
/// answer was 'yes'.
#[test]
fn what_is_proved_with_errors_holds_for_every_lighting() {
    let of = |target: &str, error: &str, lighting: &str| {
        let more =
            format!("[sensitivity]\nemissivity_error = \"{error} absolute\"\ncorrelation = \"10 cm^-1\"");
        let text = scene("pixels = 400", WHITE, "", &more)
            .replace("material = \"skin\"", &format!("material = \"{target}\""))
            .replace("[\"pmma\", \"aluminium\"]", "[\"skin\"]\nlighting = LIGHTING")
            .replace("lighting = LIGHTING", &format!("lighting = {lighting}"))
            .replace("lighting = 0.5", "lighting = 0.95")
            .replace("\"34 degC\"", "\"297 K\"");
        size(&text).verdict
    };
    for target in ["soda-lime-glass", "pmma"] {
        for error in ["0.005", "0.02"] {
            let all = of(target, error, "[0.0, 1.0]");
            assert!(all.lower <= all.upper, "{target} {error}");
            for some in ["[0.0, 0.1]", "[0.0, 0.01]", "[0.3, 0.6]", "[0.9, 1.0]"] {
                let found = of(target, error, some);
                assert!(
                    all.lower <= found.upper,
                    "{target} {error} {some}: {:?} {:?}",
                    all.lower,
                    found.upper
                );
                assert!(found.lower <= found.upper, "{target} {error} {some}");
            }
        }
    }
}
