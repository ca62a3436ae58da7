//! Scenario files: the example, every key, the way there and back, and no text that breaks the reader.

use std::collections::BTreeMap;
use std::path::Path;

use hadar::instrument::Price;
use hadar::instrument::figures::NoiseFigures;
use hadar::instrument::presets::Cooling;
use hadar::units::Spectral;
use hadar_scenario::find::{FilterSupply, FiltersToChoose, LensSpec, Merit};
use hadar_scenario::{
    Alternatives, AtmosphereSource, AtmosphereSpec, Background, BandSource, BandsSpec, CameraSpec, ClassSpec,
    DistanceKind, Efficiency, Envelope, EnvironmentObject, Extrapolation, FilterList, FilterPlace, Filters,
    FindSpec, MaterialRef, Nuisance, PixelsFilled, Readout, Reliability, Requirement, Scenario, Scope,
    Source, Spread, Target, Unknown,
};
use hadar_testing::seeded;
use proptest::prelude::*;

const MINIMUM: &str = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n";

fn name(text: &str) -> MaterialRef {
    MaterialRef::Name(text.to_owned())
}

fn file(path: &str) -> MaterialRef {
    MaterialRef::File(std::path::absolute(path).unwrap())
}

fn read(text: &str) -> Scenario {
    Scenario::from_toml(text, None).unwrap()
}

#[test]
fn plain_numbers_may_be_written_to_any_base_of_toml() {
    let number = |text: &str| {
        read(&format!("{MINIMUM}[camera]\nnoise_electrons = {text}\n"))
            .camera
            .unwrap()
            .noise
            .electrons
            .unwrap()
    };
    let texts = ["0x10", "0x1E5", "0b1010", "0o17", "1_000", "1e2", "16"];
    assert_eq!(texts.map(number), [16.0, 485.0, 10.0, 15.0, 1000.0, 100.0, 16.0]);
}

#[test]
fn paths_that_begin_or_end_in_a_blank_are_not_confused_with_others() {
    let path = std::env::temp_dir().join("a.toml");
    let with = |file: &str| Scenario::from_toml(&MINIMUM.replace("skin", file), Some(&path));
    let scenario = with("./ x.csv").unwrap();
    let text = scenario.to_toml();
    assert_eq!(Scenario::from_toml(&text, Some(&path)).unwrap(), scenario, "{text}");
    assert!(with("./x //").is_err());
    let error = with("./x /.").unwrap_err().to_string();
    assert!(
        error.ends_with("target.material: `./x /.` is a path that ends in a blank; rename the file"),
        "{error}"
    );
}

#[test]
fn the_example_is_the_case_of_the_paper() {
    let path = hadar_testing::repository().join("examples/human_vs_robot.toml");
    let scenario = Scenario::from_file(&path).unwrap();
    let expected = Scenario {
        title: Some("Can a camera tell a person from a robot?".to_owned()),
        classes: BTreeMap::new(),
        target: Target {
            material: name("skin"),
            temperature_k: 310.15,
            distance_m: Some(30.0),
            size_m: None,
            pixels: None,
            extrapolate: None,
        },
        background: None,
        environment: vec![EnvironmentObject {
            temperature_k: 293.15,
            lighting: 0.5,
            material: None,
            extrapolate: None,
        }],
        alternatives: Alternatives { materials: Some(vec![name("aluminium")]), ..Alternatives::default() },
        atmosphere: None,
        bands: BandsSpec {
            source: BandSource::Grid {
                start: Spectral::Wavenumber(715.0),
                stop: Spectral::Wavenumber(1250.0),
                step: Spectral::Wavenumber(1.0),
            },
            integrate: None,
            tolerance: 1e-9,
        },
        unknown: Unknown {
            nuisances: vec![Nuisance::Temperature, Nuisance::Lighting],
            priors: BTreeMap::new(),
            lighting_total: None,
        },
        camera: Some(CameraSpec { preset: Some("flir-a325sc".to_owned()), ..CameraSpec::default() }),
        requirement: Requirement {
            reliability: Reliability::Distance(1.0),
            by: DistanceKind::Nearest,
            of: None,
            speed_m_s: Some(13.4112),
            time_s: None,
        },
        envelope: None,
        find: None,
        sensitivity: None,
        categories: Vec::new(),
        source: Source::default(),
    };
    assert_eq!(scenario, expected);
    let line = std::fs::read_to_string(&path).unwrap();
    let line = 1 + line.lines().position(|line| line.starts_with("materials =")).unwrap();
    assert_eq!(
        scenario.place("alternatives.materials[0]").to_string(),
        format!("{}:{line}: alternatives.materials[0]", path.display())
    );
}

#[test]
fn what_is_silent_has_its_default() {
    let scenario = read(MINIMUM);
    let commented = read(&format!("\u{feff}# a comment\r\n{}", MINIMUM.replace('\n', "\r\n")));
    assert_eq!(scenario, commented);
    assert_eq!(scenario.bands, BandsSpec::default());
    assert_eq!(scenario.unknown.nuisances, [Nuisance::Temperature, Nuisance::Lighting]);
    assert_eq!(scenario.requirement.reliability, Reliability::Distance(1.0));
    assert_eq!(scenario.requirement.by, DistanceKind::Nearest);
    assert!(scenario.environment.is_empty() && scenario.camera.is_none() && scenario.atmosphere.is_none());
    assert_eq!(scenario.alternatives.materials, None);
    assert!(read(&format!("{MINIMUM}[unknown]\nnuisances = []")).unknown.nuisances.is_empty());
}

#[test]
fn every_key_is_read_into_the_unit_of_its_name() {
    let scenario = Scenario::from_toml(
        r#"
        [target]
        material = "paint.CSV"
        temperature = "310.15 K"
        extrapolate = "hold"
        [[environment]]
        temperature = "68 degF"
        lighting = 0
        material = "data/sky.txt"
        [[environment]]
        temperature = "250 K"
        extrapolate = "linear"
        [alternatives]
        temperature = ["0 degC", "120 degC"]
        lighting = [0, 0.9]
        [atmosphere]
        table = "air.csv"
        temperature = "15 degC"
        [bands]
        ranges = [["715 cm^-1", "800 cm^-1"], ["8000 nm", "9 um"]]
        integrate = true
        tolerance = 1e-6
        [unknown]
        nuisances = ["gain", "environment-temperature", "lighting"]
        priors = { gain = 0.05, environment-temperature = "500 mK" }
        lighting_total = 0.75
        [camera]
        exposure = "12 ms"
        pixel = "25 um"
        f_number = 1
        focal_length = "18 mm"
        optics_efficiency = 0.95
        detectivity = "4e10 Jones"
        flicker_fraction = 0.5
        full_well = 1e7
        readout = "sequential"
        frames = 0x10
        field_of_view = "180 mrad"
        pixels = 320
        netd_temperature = "30 degC"
        netd_f_number = 1.0
        [requirement]
        detection_probability = 0.99
        by = "local-unknown-gain"
        speed = "36 km/h"
        "#,
        Some(Path::new("/data/study/a.toml")),
    )
    .unwrap();
    assert_eq!(scenario.target.material, file("/data/study/paint.CSV"));
    assert_eq!(scenario.target.extrapolate, Some(Extrapolation::Hold));
    let [first, second] = scenario.environment.as_slice() else { panic!("two objects") };
    assert!((first.temperature_k - 293.15).abs() < 1e-12, "68 degF is 20 degC");
    assert_eq!(first.material, Some(file("/data/study/data/sky.txt")));
    assert_eq!((second.lighting, second.extrapolate), (0.75, Some(Extrapolation::Linear)));
    assert_eq!(scenario.alternatives.temperature_range_k, Some([273.15, 393.15]));
    assert_eq!(scenario.alternatives.lighting_range, Some([0.0, 0.9]));
    let air = AtmosphereSource::Table(std::path::absolute("/data/study/air.csv").unwrap());
    assert_eq!(scenario.atmosphere, Some(AtmosphereSpec { source: air, temperature_k: Some(288.15) }));
    let ranges = [
        [Spectral::Wavenumber(715.0), Spectral::Wavenumber(800.0)],
        [Spectral::Wavelength(8.0), Spectral::Wavelength(9.0)],
    ];
    assert_eq!(scenario.bands.source, BandSource::Ranges(ranges.to_vec()));
    assert_eq!((scenario.bands.integrate, scenario.bands.tolerance), (Some(true), 1e-6));
    let priors = BTreeMap::from([(Nuisance::Gain, 0.05), (Nuisance::EnvironmentTemperature, 0.5)]);
    assert_eq!(scenario.unknown.priors, priors);
    let camera = scenario.camera.clone().unwrap();
    assert!((camera.exposure_s.unwrap() / 0.012 - 1.0).abs() < 1e-15);
    assert!((camera.pixel_m.unwrap() / 25e-6 - 1.0).abs() < 1e-15);
    assert!((camera.focal_length_m.unwrap() / 0.018 - 1.0).abs() < 1e-15);
    assert!((camera.field_of_view_rad.unwrap() / 0.18 - 1.0).abs() < 1e-15);
    assert_eq!(
        (camera.f_number, camera.optics_efficiency.clone()),
        (Some(1.0), Some(Efficiency::Number(0.95)))
    );
    assert_eq!((camera.noise.detectivity_cm_hz05_w, camera.flicker_fraction), (Some(4e10), Some(0.5)));
    assert_eq!((camera.full_well, camera.readout), (Some(1e7), Some(Readout::Sequential)));
    assert_eq!((camera.frames, camera.pixels), (Some(16), Some(320)));
    assert_eq!((camera.noise.netd_temperature_k, camera.noise.netd_f_number), (Some(303.15), Some(1.0)));
    assert_eq!(scenario.requirement.reliability, Reliability::DetectionProbability(0.99));
    assert_eq!(scenario.requirement.by, DistanceKind::LocalUnknownGain);
    assert!((scenario.requirement.speed_m_s.unwrap() - 10.0).abs() < 1e-14);
    let again = Scenario::from_toml(&scenario.to_toml(), Some(Path::new("/data/study/a.toml")));
    assert_eq!(again.unwrap(), scenario);
}

fn material() -> impl Strategy<Value = MaterialRef> {
    let absolute = |file: String| std::path::absolute(Path::new("spectra").join(file)).unwrap();
    prop_oneof![
        "[a-z][a-z0-9-]{0,12}".prop_map(MaterialRef::Name),
        "[a-zA-Zé \"'#][a-z0-9 ]{0,6}[a-z](\\.csv)?".prop_map(move |file| MaterialRef::File(absolute(file))),
    ]
}

fn filled() -> impl Strategy<Value = Option<PixelsFilled>> {
    proptest::option::of(prop_oneof![
        (1u32..1_000_000).prop_map(PixelsFilled::All),
        [1u32..1000, 1u32..1000].prop_map(PixelsFilled::Sides),
    ])
}

fn extrapolate() -> impl Strategy<Value = Option<Extrapolation>> {
    proptest::option::of(proptest::sample::select(Extrapolation::ALL.to_vec()))
}

fn ordered(low: f64, high: f64) -> impl Strategy<Value = [f64; 2]> {
    (low..high, low..high).prop_filter("two ends", |(a, b)| a != b).prop_map(|(a, b)| [a.min(b), a.max(b)])
}

fn above_zero() -> impl Strategy<Value = f64> {
    (-300.0..300.0f64).prop_map(|exponent| 10f64.powf(exponent))
}

fn filter_list() -> impl Strategy<Value = FilterList> {
    prop_oneof![Just(FilterList::Catalogue), Just(FilterList::File(std::path::absolute("f.csv").unwrap()))]
}

fn filter_place() -> impl Strategy<Value = Option<FilterPlace>> {
    let sensor = (1.0..10.0f64).prop_map(|index| Some(FilterPlace::Sensor { index }));
    prop_oneof![Just(None), Just(Some(FilterPlace::Lens)), sensor]
}

fn price() -> impl Strategy<Value = Option<Price>> {
    let text = prop_oneof![
        (1u32..1_000_000).prop_map(|sum| format!("{sum} USD")),
        (1u32..1000, 1u32..1000).prop_map(|(low, more)| format!("{low} to {} EUR", low + more)),
        (1u32..1000).prop_map(|most| format!("under {most} USD")),
    ];
    proptest::option::of(text.prop_map(|text| Price::parse(&text).unwrap()))
}

fn find() -> impl Strategy<Value = FindSpec> {
    let lens = (proptest::option::of("[a-z]{2,6}"), 0.5..10.0f64, above_zero(), price());
    let lens = lens.prop_map(|(name, f_number, focal_length_m, price)| LensSpec {
        name,
        f_number,
        focal_length_m,
        price,
    });
    let supply = (filter_list(), filter_place()).prop_map(|(list, place)| (FilterSupply::List(list), place));
    let any = (1u32..100)
        .prop_map(|twentieths| (FilterSupply::Any { step_um: 0.05 * f64::from(twentieths) }, None));
    let filters = (prop_oneof![supply, any], 1u32..9, price())
        .prop_map(|((from, place), at_most, price)| FiltersToChoose { from, at_most, place, price });
    (
        proptest::collection::btree_set("[a-z*][a-z0-9*-]{0,8}", 1..4),
        proptest::option::of(proptest::sample::select(Cooling::ALL.to_vec())),
        proptest::option::of(proptest::collection::vec(lens, 1..2)),
        filters,
        proptest::collection::btree_set(1u32..1000, 1..5),
        proptest::option::of(above_zero()),
        proptest::sample::subsequence(Merit::ALL.to_vec(), 1..=4).prop_shuffle(),
    )
        .prop_map(|(cameras, kind, lenses, filters, frames, time_s, least)| FindSpec {
            cameras: cameras.into_iter().collect(),
            kind,
            lenses,
            filters,
            frames: frames.into_iter().collect(),
            time_s,
            least,
        })
}

fn bands() -> impl Strategy<Value = BandsSpec> {
    let path = |name: &str| std::path::absolute(name).unwrap();
    let axis = proptest::sample::select(vec![
        Spectral::Wavenumber as fn(f64) -> Spectral,
        Spectral::Wavelength as fn(f64) -> Spectral,
    ]);
    let source = prop_oneof![
        (axis.clone(), ordered(0.1, 5e3), 1e-3..1.0).prop_map(|(of, [start, stop], share)| {
            let (start, stop, step) = (of(start), of(stop), of((stop - start) * share));
            BandSource::Grid { start, stop, step }
        }),
        (
            filter_list(),
            proptest::option::of(proptest::collection::btree_set("[a-z0-9.-]{1,8}", 1..4)),
            filter_place()
        )
            .prop_map(|(list, names, place)| {
                BandSource::Filters(Filters {
                    list,
                    names: names.map(|set| set.into_iter().collect()),
                    place,
                })
            }),
        Just(BandSource::Rows(path("rows"))),
        proptest::collection::vec((axis, ordered(0.1, 5e3)), 1..4).prop_map(|ranges| {
            BandSource::Ranges(ranges.into_iter().map(|(of, range)| range.map(of)).collect())
        }),
    ];
    (source, any::<Option<bool>>(), 1e-14..0.1).prop_map(|(source, integrate, tolerance)| BandsSpec {
        source,
        integrate,
        tolerance,
    })
}

fn atmosphere() -> impl Strategy<Value = AtmosphereSpec> {
    prop_oneof![
        ("[a-z][a-z0-9-]{0,12}", proptest::option::of(above_zero())).prop_map(|(name, temperature_k)| {
            AtmosphereSpec { source: AtmosphereSource::Model(name), temperature_k }
        }),
        ("[a-z #]{0,6}[a-z](\\.csv)?", above_zero()).prop_map(|(name, temperature_k)| AtmosphereSpec {
            source: AtmosphereSource::Table(std::path::absolute(Path::new("air").join(name)).unwrap()),
            temperature_k: Some(temperature_k),
        }),
    ]
}

fn unknown() -> impl Strategy<Value = Unknown> {
    let subset = proptest::sample::subsequence(Nuisance::ALL.to_vec(), 0..=4).prop_shuffle();
    (subset, proptest::collection::vec(proptest::option::of(above_zero()), 4)).prop_map(
        |(nuisances, sigmas)| {
            let priors =
                nuisances.iter().zip(sigmas).filter_map(|(nuisance, sigma)| Some((*nuisance, sigma?)));
            Unknown { priors: priors.collect(), nuisances: nuisances.clone(), lighting_total: None }
        },
    )
}

/// A class with or without weights, mixtures, a spread.
fn class() -> impl Strategy<Value = ClassSpec> {
    let spread = prop_oneof![
        Just(None),
        Just(Some(Spread::Sample)),
        (0.0..0.1, above_zero()).prop_map(|(emissivity_error, correlation_cm1)| {
            Some(Spread::Stated { emissivity_error, correlation_cm1 })
        }),
    ];
    let members = proptest::collection::btree_set(material(), 1..4);
    (members, any::<bool>(), any::<bool>(), spread).prop_map(|(materials, weighed, mixtures, spread)| {
        let materials: Vec<MaterialRef> = materials.into_iter().collect();
        let weights = weighed.then(|| (0..materials.len()).map(|i| 0.1 + i as f64).collect());
        ClassSpec { materials, weights, mixtures, spread }
    })
}

prop_compose! {
    fn camera()(
        preset in proptest::option::of("[a-z][a-z0-9-]{0,12}"),
        quantities in proptest::collection::vec(proptest::option::of(above_zero()), 18),
        shares in proptest::collection::vec(proptest::option::of(1e-9..=1.0), 4),
        f_numbers in proptest::collection::vec(proptest::option::of(0.5..1e3), 2),
        which_noise in 0..6usize,
        readout in proptest::option::of(proptest::sample::select(Readout::ALL.to_vec())),
        counts in proptest::collection::vec(proptest::option::of(1..=u32::MAX), 3),
        flags in proptest::collection::vec(any::<bool>(), 2),
        field_of_view_rad in proptest::option::of(1e-6..3.1),
    ) -> CameraSpec {
        let noise = |which: usize| quantities[which].filter(|_| which_noise == which);
        CameraSpec {
            preset,
            noise: NoiseFigures {
                netd_k: noise(0),
                // Blackbodies are from 50 K to 5000 K.
                netd_temperature_k: quantities[6].map(|value| 50.0 + 4950.0 * (value / (1.0 + value))),
                netd_f_number: f_numbers[1],
                netd_optics_efficiency: shares[3],
                netd_pixel_m: quantities[8],
                detectivity_cm_hz05_w: noise(1),
                nep_w_hz05: quantities[10].filter(|_| which_noise == 3),
                nesr_microflick: quantities[11].filter(|_| which_noise == 4),
                electrons: noise(2),
                table: (which_noise == 5).then(|| std::path::absolute("noise.csv").unwrap()),
                bandwidth_hz: quantities[12],
                ..NoiseFigures::default()
            },
            exposure_s: quantities[3],
            pixel_m: quantities[4],
            focal_length_m: quantities[5],
            full_well: quantities[7],
            noise_exposure_s: quantities[9],
            f_number: f_numbers[0],
            optics_efficiency: shares[0].map(Efficiency::Number),
            quantum_efficiency: if flags[0] {
                Some(Efficiency::File(std::path::absolute("qe.csv").unwrap()))
            } else {
                shares[2].map(Efficiency::Number)
            },
            dark_rate_per_s: quantities[13],
            read_noise_counts: quantities[14],
            quantisation_bits: counts[2],
            photon_bunching: Some(flags[1]),
            frame_rate_hz: quantities[15],
            sensor_temperature_k: quantities[16],
            filter_temperature_k: quantities[17],
            flicker_fraction: shares[1],
            readout,
            frames: counts[0],
            pixels: counts[1],
            field_of_view_rad,
            ..CameraSpec::default()
        }
    }
}

prop_compose! {
    fn environment()(
        objects in proptest::collection::vec(
            (above_zero(), 0.0..=1.0, proptest::option::of(material()), extrapolate()), 0..4),
    ) -> Vec<EnvironmentObject> {
        let count = objects.len().max(1) as f64;
        let object = |(temperature_k, share, material, extrapolate): (f64, f64, _, _)| EnvironmentObject {
            temperature_k, lighting: share / count, material, extrapolate,
        };
        objects.into_iter().map(object).collect()
    }
}

prop_compose! {
    fn scenario()(
        title in proptest::option::of("[^\\p{Cc}]{0,20}[a-z]"),
        target in (material(), above_zero(), proptest::option::of(above_zero()), extrapolate()),
        behind in proptest::option::of((above_zero(), proptest::option::of(material()), extrapolate())),
        size_m in proptest::option::of(above_zero()),
        environment in environment(),
        materials in proptest::option::of(proptest::collection::btree_set(material(), 1..4)),
        temperature_range_k in proptest::option::of(ordered(1.0, 1e4)),
        lighting_range in proptest::option::of(ordered(0.0, 1.0)),
        extrapolate in extrapolate(),
        atmosphere in proptest::option::of(atmosphere()),
        bands in bands(),
        mut unknown in unknown(),
        tied in any::<bool>(),
        camera in proptest::option::of(camera()),
        reliability in prop_oneof![
            (0.5001..0.9999).prop_map(Reliability::DetectionProbability),
            above_zero().prop_map(Reliability::Distance),
        ],
        by in proptest::sample::select(DistanceKind::ALL.to_vec()),
        skip_uncovered in any::<bool>(),
        speed_m_s in proptest::option::of(above_zero()),
        find in proptest::option::of(find()),
        (of, filled) in (proptest::option::of(proptest::sample::select(Scope::ALL.to_vec())), filled()),
        (ranged, width, envelope_materials, near, classes) in (
            any::<bool>(), 0.0..1.0, proptest::option::of(proptest::collection::btree_set(material(), 1..3)),
            proptest::option::of(above_zero()), proptest::collection::btree_map("[a-z]{1,6}", class(), 0..3),
        ),
    ) -> Scenario {
        // Ranges that begin at the scene's own values; the lighting is never widened downwards, so that it fits.
        let envelope = ranged.then(|| Envelope {
            temperature_k: Some([target.1, target.1 * (1.0 + width)]),
            lighting: (!environment.is_empty() && width < 0.7)
                .then(|| environment.iter().map(|o| [o.lighting * width, o.lighting]).collect()),
            surroundings_k: (!environment.is_empty())
                .then(|| environment.iter().map(|o| [o.temperature_k, o.temperature_k * (1.0 + width)]).collect()),
            distance_m: near.map(|near| [near, near * (1.0 + width)]),
            materials: envelope_materials.map(|set| set.into_iter().collect()),
        });
        let (material, temperature_k, distance_m, target_extrapolate) = target;
        if tied && !environment.is_empty() {
            unknown.lighting_total = Some(environment.iter().map(|object| object.lighting).sum::<f64>().min(1.0));
        }
        let materials = materials.map(|set| set.into_iter().collect());
        let background = behind.map(|(temperature_k, material, extrapolate)| Background { temperature_k, material, extrapolate });
        Scenario {
            title,
            classes,
            target: Target {
                material,
                temperature_k,
                distance_m,
                size_m,
                // A size says how many there are.
                pixels: filled.filter(|_| size_m.is_none()),
                extrapolate: target_extrapolate,
            },
            background,
            environment,
            alternatives: Alternatives {
                materials,
                temperature_range_k,
                lighting_range,
                extrapolate,
                skip_uncovered,
                own_too: false,
            },
            atmosphere,
            bands,
            unknown,
            camera,
            requirement: Requirement { reliability, by, of, speed_m_s, time_s: speed_m_s.map(f64::recip) },
            envelope,
            sensitivity: None,
            find,
            categories: Vec::new(),
            source: Source::default(),
        }
    }
}

proptest! {
    #![proptest_config(seeded(2, 400))]

    #[test]
    fn what_is_written_is_read_back_to_the_last_bit(scenario in scenario()) {
        let text = scenario.to_toml();
        let mut back = Scenario::from_toml(&text, None).unwrap();
        if let (Some(_), Some(last)) = (scenario.unknown.lighting_total, back.environment.last_mut()) {
            // The last factor is formed anew as what the others leave of the total.
            let written = scenario.environment.last().unwrap().lighting;
            prop_assert!((last.lighting - written).abs() < 1e-12);
            last.lighting = written;
        }
        prop_assert_eq!(&back, &scenario, "{}", text);

        let mut from_text: serde_json::Value = toml::from_str(&text).unwrap();
        if scenario.environment.is_empty() {
            from_text["environment"] = serde_json::json!([]);
        }
        prop_assert_eq!(serde_json::to_value(&scenario).unwrap(), from_text);
    }

    #[test]
    fn any_text_gives_a_scenario_or_one_line(text in any::<String>()) {
        one_line(&text);
    }

    #[test]
    fn any_damage_gives_a_scenario_or_one_line(
        at in 0.0..1.0f64, length in 0..30usize, patch in prop_oneof![
            any::<String>(),
            "[\\[\\]{}=\"'\n.,0-9a-zK#-]{0,8}",
        ],
    ) {
        let example = include_str!("../../../../examples/human_vs_robot.toml");
        let bytes: Vec<char> = example.chars().filter(|char| *char != '#').collect();
        let start = (at * bytes.len() as f64) as usize;
        let end = (start + length).min(bytes.len());
        one_line(&(bytes[..start].iter().collect::<String>() + &patch + &bytes[end..].iter().collect::<String>()));
    }

    #[test]
    fn any_value_at_any_key_gives_a_scenario_or_one_line(
        table in proptest::sample::select(vec![
            "target", "[environment]", "environment", "alternatives", "bands", "unknown", "unknown.priors",
            "camera", "requirement", "atmosphere",
        ]),
        key in proptest::sample::select(vec![
            "material", "temperature", "distance", "lighting", "extrapolate", "materials", "start", "stop", "step",
            "filters", "rows", "ranges", "integrate", "tolerance", "nuisances", "priors", "lighting_total", "gain",
            "exposure", "f_number", "netd", "readout", "frames", "pixels", "by", "speed", "preset", "model", "table",
        ]),
        value in prop_oneof![
            "-?[0-9]{1,25}", "-?[0-9]{1,4}\\.[0-9]{1,4}(e[0-9]{1,4})?", "\"-?[0-9.e]{0,9} ?(K|m|um|s|cm\\^-1|deg)?\"",
            "(true|false|nan|inf|-inf|0x[0-9a-f]{1,20}|1979-05-27)", "\\[(1, ?){0,3}\\]", "\\{ ?(gain = 1)? ?\\}",
            "'[^']{0,9}'", "\\[\\['1 um', '2 um'\\]\\]",
        ],
    ) {
        one_line(&format!("{MINIMUM}[{table}]\n{key} = {value}\n"));
        one_line(&format!("target.material = 'skin'\ntarget.temperature = '1 K'\n{key} = {value}\n"));
    }
}

/// Reads the text; a refusal is one line that names the file.
#[track_caller]
fn one_line(text: &str) {
    if let Err(error) = Scenario::from_toml(text, Some(Path::new("a.toml"))) {
        let message = error.to_string();
        assert!(message.starts_with("a.toml:") && !message.contains(char::is_control), "{message}");
    }
}

#[test]
fn a_scenario_written_beside_its_files_names_them_from_there() {
    let directory = std::path::absolute("study").unwrap();
    let file = directory.join("a.toml");
    let text = "[target]\nmaterial = './paint'\ntemperature = '1 K'\n[bands]\nrows = '../rows.csv'\n";
    let scenario = Scenario::from_toml(text, Some(&file)).unwrap();
    assert_eq!(scenario.target.material, MaterialRef::File(directory.join("paint")));
    let written = scenario.to_toml();
    assert!(written.contains("material = \"./paint\""), "{written}");
    assert_eq!(Scenario::from_toml(&written, Some(&file)).unwrap(), scenario);
}
