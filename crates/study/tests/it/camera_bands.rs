//! The bands that a camera can have, what it does with one of them, and what the first lines of an answer must say.

use hadar::fisher::Nuisance;
use hadar::instrument::Readout;
use hadar::material::Library;
use hadar::policy::Quantity;
use hadar_scenario::{BandSource, Rule, Scenario};
use hadar_study::{Answer, RuleAsked, RuleStudy, Sizing, Study, Verdict, Warning};
use std::sync::OnceLock;

/// A core of one band whose noise a data sheet states, with a lens.
const CORE: &str = "preset = \"flir-boson-plus-640\"\nf_number = 1.0\nfocal_length = \"14 mm\"\n";
const FOUR: &str =
    "ranges = [[\"8 um\", \"9 um\"], [\"9 um\", \"11 um\"], [\"11 um\", \"12 um\"], [\"12 um\", \"14 um\"]]";

fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| Library::embedded().unwrap())
}

fn scenario(camera: &str, bands: &str) -> String {
    format!(
        "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n\
         [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
         [alternatives]\nmaterials = [\"silicon-carbide\"]\n[bands]\n{bands}\n[camera]\n{camera}\n"
    )
}

fn study(text: &str) -> hadar::error::Result<Study> {
    Study::new(&Scenario::from_toml(text, None)?, library())
}

fn size(text: &str) -> Sizing {
    study(text).and_then(|study| study.size()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn message(camera: &str, bands: &str) -> String {
    study(&scenario(camera, bands)).unwrap_err().to_string()
}

/// Of one band: nothing said, its own; filters, one after the other; all else is refused, and the message says what to write.
#[test]
fn a_camera_of_one_band_takes_filters() {
    let own = size(&scenario(CORE, ""));
    assert_eq!(own.verdict.met, Some(false));
    assert!(matches!(&own.scenario.bands.source, BandSource::Ranges(ranges) if ranges.len() == 1));
    let unknowns = vec![Nuisance::Temperature, Nuisance::Lighting];
    assert_eq!(own.verdict.sentence.answer, Answer::TooFewBands { bands: 1, unknowns });
    let alone = study(&scenario(CORE, "")).unwrap().no_alone().unwrap().unwrap();
    assert_eq!(alone.verdict.sentence, own.verdict.sentence);

    let filters = size(&scenario(CORE, FOUR));
    let camera = filters.camera.unwrap();
    assert_eq!(camera.camera.readout, Readout::Sequential);
    // Three frames of 1/60 s, and the exposure of the fourth.
    assert!((camera.acquisition_s / (3.0 / 60.0 + 8e-3) - 1.0).abs() < 1e-12);
    // As it is written out it is the same scenario.
    let again = size(&filters.scenario.to_toml());
    assert_eq!(
        (again.verdict.margin, again.camera.unwrap().camera.readout),
        (filters.verdict.margin, Readout::Sequential)
    );
    // And rests on the same: what nobody stated is not stated by the program.
    let open = |verdict: &Verdict| verdict.open().cloned().collect::<Vec<_>>();
    assert_eq!(open(&again.verdict), open(&filters.verdict));

    for grid in [
        "step = \"1 cm^-1\"",
        "start = \"715 cm^-1\"",
        "start = \"8 um\"\nstop = \"14 um\"\nstep = \"0.1 um\"",
    ] {
        let said = message(CORE, grid);
        assert!(
            said.contains("bands: flir-boson-plus-640 has one band") && said.contains("ranges = "),
            "{said}"
        );
        // A filter for each, since somebody says so.
        let wheel = size(&scenario(&format!("{CORE}readout = \"sequential\""), grid));
        assert_eq!(wheel.camera.unwrap().camera.readout, Readout::Sequential);
    }
    for readout in ["simultaneous", "dispersive", "fourier-transform"] {
        let said = message(&format!("{CORE}readout = {readout:?}"), FOUR);
        assert!(said.contains("camera.readout: flir-boson-plus-640 has one band"), "{said}");
        assert!(
            said.contains("write readout = \"sequential\"") && said.contains("spectral_bands = 4"),
            "{said}"
        );
        // Optics that make so many of it are stated as such; one band is read in any way.
        size(&scenario(&format!("{CORE}readout = {readout:?}\nspectral_bands = 4"), FOUR));
        size(&scenario(&format!("{CORE}readout = {readout:?}"), ""));
    }
    // The same of a camera of one's own.
    let own = "pixel = \"12 um\"\nf_number = 1.0\nfocal_length = \"14 mm\"\nexposure = \"8 ms\"\nnetd = \"50 mK\"\n";
    assert!(message(&format!("{own}spectral_bands = 1"), "step = \"1 cm^-1\"").contains("has one band"));
    assert_eq!(
        size(&scenario(own, "step = \"1 cm^-1\"")).camera.unwrap().camera.readout,
        Readout::Sequential
    );
}

/// Ranges of temperature and lighting leave a distance where two bands stand against two unknowns: what falls short of it by a little is
/// judged by that distance and not called blind, in the quick answer too.
#[test]
fn as_many_bands_as_unknowns_are_judged_by_their_distance() {
    let two = "ranges = [[\"8 um\", \"9.5 um\"], [\"11 um\", \"13 um\"]]";
    let of = |distance: f64| format!("{}[requirement]\ndistance = {distance}\n", scenario(CORE, two));
    let d = size(&of(1.0)).verdict.upper.unwrap();
    assert!(d > 0.0, "{d}");
    let short = size(&of(1.01 * d)).verdict;
    assert_eq!(short.met, Some(false));
    assert!(
        matches!(short.sentence.answer, Answer::Judged { enough: false, .. }),
        "{:?}",
        short.sentence.answer
    );
    let alone = study(&of(1.01 * d)).unwrap().no_alone().unwrap().unwrap();
    assert!(matches!(alone.verdict.sentence.answer, Answer::Judged { enough: false, .. }));
    assert_eq!(size(&of(0.9 * d)).verdict.met, Some(true));
}

/// No more bands than an instrument has, and none finer than it resolves; the grid that a message offers is one it has.
#[test]
fn a_spectrometer_has_its_own_bands() {
    let owl = "preset = \"specim-aisaowl\"\nexposure = \"5 ms\"\npixel = \"30 um\"\nf_number = 2.0\n\
               focal_length = \"43 mm\"\nnesr = \"20 uflick\"\n";
    for bands in ["", "start = \"850 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"2 cm^-1\""] {
        let said = message(owl, bands);
        assert!(said.contains("specim-aisaowl has 103 bands"), "{said}");
        let offered: Vec<&str> = said.split("e.g. ").nth(1).unwrap().split(", ").collect();
        size(&scenario(owl, &offered.join("\n")));
    }
    let said = message(owl, "start = \"900 cm^-1\"\nstop = \"950 cm^-1\"\nstep = \"1 cm^-1\"");
    assert!(said.contains("is finer than specim-aisaowl resolves with 103 bands"), "{said}");
}

/// The camera as the paper models it reads a spectrum at once, which no such camera can; behind a wheel it does not.
#[test]
fn a_model_of_more_than_the_camera_is_said_to_be_one() {
    let modelled = |result: &Sizing| {
        result.warnings.iter().any(|warning| matches!(warning, Warning::BandsModelled { .. }))
    };
    let paper = size(&scenario("preset = \"flir-a325sc\"", ""));
    assert_eq!(
        (paper.camera.as_ref().unwrap().camera.readout, modelled(&paper)),
        (Readout::Simultaneous, true)
    );
    let wheel = size(&scenario("preset = \"flir-a325sc\"\nreadout = \"sequential\"", FOUR));
    assert!(!modelled(&wheel));
    assert!(
        size(&scenario("preset = \"flir-a325sc\"\nreadout = \"sequential\"", "")).verdict.met == Some(false)
    );
}

/// With as many unknowns as bands the local distances are exactly 0; the nearest one is what physical ranges leave of it.
#[test]
fn few_bands_are_a_verdict() {
    let few = |count: usize, unknown: &str| {
        let ranges = ["[\"8 um\", \"10 um\"]", "[\"10 um\", \"12 um\"]", "[\"12 um\", \"14 um\"]"];
        let text = scenario("preset = \"ideal-pnrd\"", &format!("ranges = [{}]", ranges[..count].join(", ")));
        size(&format!("{text}[unknown]\nnuisances = [{unknown}]\n"))
    };
    for (count, unknown, local) in [
        (1, "\"temperature\"", false),
        (1, "", true),
        (2, "\"temperature\", \"lighting\"", false),
        (3, "\"temperature\", \"lighting\"", true),
        (2, "\"temperature\"", true),
    ] {
        let pair = &few(count, unknown).pairs[0];
        assert_eq!(pair.distance_local > 0.0, local, "{count} bands, {unknown} unknown: {pair:?}");
    }
    // The lighting cannot be negative nor above 1, and a temperature that is known cannot explain anything.
    assert_eq!(few(1, "\"temperature\", \"lighting\"").verdict.met, Some(false));
    assert_eq!(few(1, "").verdict.met, Some(true));
}

/// Two materials that are entered as one number each: the first line says so, and a rule tells such pairs from others.
#[test]
fn placeholders_are_told_from_real_pairs() {
    let text = scenario("preset = \"ideal-pnrd\"", "").replace("silicon-carbide", "paint-matt-black");
    let result = size(&text);
    assert_eq!(result.verdict.sentence.placeholders, Some([0.95, 0.95]));
    assert!(result.pairs[0].placeholders);
    assert!(!size(&scenario("preset = \"ideal-pnrd\"", "")).pairs[0].placeholders);

    let rule = "cameras = [\"ideal-pnrd\"]\n[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\n\
                [[environment]]\ntemperature = \"10 degC\"\nlighting = 0.5\n\
                [alternatives]\nmaterials = [\"paint-matt-black\", \"aluminium\"]\n\
                [bands]\nstart = \"750 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"50 cm^-1\"\n\
                [envelope]\ntemperature = [\"30 degC\", \"37 degC\"]\n";
    let answered = |rule: &str| {
        let study = RuleStudy::new(&Rule::from_toml(rule, None).unwrap(), library()).unwrap();
        study.answer(&RuleAsked::default(), &|_, _| ()).unwrap()
    };
    let answer = answered(rule);
    let camera = &answer.only().unwrap().cameras[0];
    assert!(!camera.passes && camera.limiting.placeholders == Some([0.95, 0.95]));
    let said = &answer.sentence.placeholders;
    assert!(matches!(said.as_slice(), [(_, other, [0.95, 0.95])] if other == "paint-matt-black"), "{said:?}");
    let real = answered(&rule.replace("\"paint-matt-black\", ", ""));
    let without = camera.without_placeholders.as_ref().unwrap();
    assert_eq!(without.alternative, "aluminium");
    // Both are searched to a hundredth.
    assert!((without.margin / real.only().unwrap().cameras[0].margin - 1.0).abs() < 0.02, "{without:?}");
    assert!(
        real.only().unwrap().cameras[0].passes
            && real.only().unwrap().cameras[0].without_placeholders.is_none()
    );
}

/// The farthest distance is looked for up to the end of the air's table: where it is found, the demand is just met.
#[test]
fn the_farthest_distance_is_found_up_to_the_end_of_the_air() {
    let at = |distance_m: f64, exposure_ms: f64| {
        let camera = format!("preset = \"ideal-pnrd\"\nexposure = \"{exposure_ms} ms\"");
        let text = scenario(&camera, "").replace("silicon-carbide", "aluminium");
        let text = text.replace("37 degC\"", &format!("37 degC\"\ndistance = \"{distance_m} m\""));
        size(&format!("{text}[atmosphere]\nmodel = \"us-standard\"\n[requirement]\ndistance = 7.0\n"))
    };
    for (exposure_ms, nearest_m) in [(2.5, 6104.0), (3.5, 8000.0)] {
        let result = at(30.0, exposure_ms);
        let (_, found) =
            result.solve_for.unwrap().0.into_iter().find(|(of, _)| *of == Quantity::Distance).unwrap();
        let value = found.value.unwrap_or_else(|| panic!("{found:?}"));
        assert!(value > nearest_m && value < 1e4, "{value}");
        let there = at(value, exposure_ms).verdict.statistical_distance.unwrap();
        assert!((there / 7.0 - 1.0).abs() < 1e-6, "{value} m: {there}");
    }
    let result = at(30.0, 12.0);
    let (_, found) =
        result.solve_for.unwrap().0.into_iter().find(|(of, _)| *of == Quantity::Distance).unwrap();
    assert!(found.value.is_none() && found.reason.unwrap().contains("up to where the data of the air end"));
}

/// Nothing around the target, and a pixel that sees more than a person.
#[test]
fn empty_space_and_wide_pixels_are_warned_of() {
    let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\ndistance = \"30 km\"\n\
                [alternatives]\nmaterials = [\"aluminium\"]\n[camera]\npreset = \"ideal-pnrd\"\n";
    let codes =
        |text: &str| size(text).warnings.iter().map(|warning| warning.code().name()).collect::<Vec<_>>();
    let found = codes(text);
    assert!(found.contains(&"no-surroundings") && found.contains(&"target-size-unknown"), "{found:?}");
    // 12 um behind 18 mm see 0.49 m at 740 m.
    let near = codes(&text.replace("30 km", "740 m"));
    assert!(!near.contains(&"target-size-unknown"), "{near:?}");
    assert!(codes(&text.replace("30 km", "760 m")).contains(&"target-size-unknown"));
}

/// What nobody says of a camera of one's own is assumed aloud, as it is of a known one.
#[test]
fn what_is_assumed_of_a_camera_of_ones_own_is_said() {
    let own = "pixel = \"12 um\"\nf_number = 1.0\nfocal_length = \"14 mm\"\nexposure = \"8 ms\"\nnetd = \"50 mK\"\n";
    let assumed = |camera: &str| -> Vec<(&'static str, bool)> {
        let camera = size(&scenario(camera, FOUR)).camera.unwrap().camera;
        camera.assumed.iter().map(|one| (one.figure, one.favourable)).collect()
    };
    let found = assumed(own);
    for favourable in
        ["flicker_fraction", "fixed_pattern", "frame_rate", "full_well", "spectral_range", "readout"]
    {
        assert!(found.contains(&(favourable, true)), "{found:?}");
    }
    // Whether the noise was measured through the same optics nobody says.
    assert!(found.contains(&("optics_efficiency", true)), "{found:?}");
    assert!(!assumed(&format!("{own}readout = \"simultaneous\"")).iter().any(|one| one.0 == "frame_rate"));
    let stated = "optics_efficiency = 0.9\nflicker_fraction = 0.1\nfixed_pattern = \"20 mK\"\nrow_noise = \"0 mK\"\ncolumn_noise = \"0 mK\"\noffset_drift = \"0 mK\"\nframe_rate = \"60 Hz\"\nreadout = \"sequential\"\n\
                  full_well = 1e9\nquantisation_bits = 14\nspectral_range = [\"8 um\", \"14 um\"]\nnetd_temperature = \"30 degC\"\n\
                  netd_f_number = 1.0\nnetd_optics_efficiency = 0.9\nquantum_efficiency = 0.8\ndark_rate = \"0 1/s\"\nread_noise = 0\nnetd_pixel = \"12 um\"\nnoise_exposure = \"8 ms\"\n";
    assert_eq!(assumed(&format!("{own}{stated}")), []);
}
