//! Cubes whose maps are kept in files: the same answer and the same bytes as of those kept in memory, however many rows at once.

use crate::decompose::{BANDS, SCENARIO, emissivity, sky, wavenumber, with};
use crate::support::folder::Folder;
use hadar::cube::Shape;
use hadar::demand::Skipping;
use hadar::material::Library;
use hadar::planck::photon_radiance;
use hadar_estimate::decompose::Method;
use hadar_formats::cube::{npy_map, write_npy};
use hadar_report::bundle::About;
use hadar_report::decompose::bundle;
use hadar_report::folder::{self as reports, Strangers};
use hadar_report::manifest::Provenance;
use hadar_scenario::DecomposeScenario;
use hadar_study::decompose::{DecomposeStudy, Keep, Kept};
use std::collections::BTreeMap;
use std::fs;

const ROWS: usize = 19;
const COLUMNS: usize = 13;

/// Noisy pixels of two materials, dead and dark ones, and such as fit neither.
fn scene(scenario: &str) -> Folder {
    let folder = with(scenario);
    let mut state = 7_u64;
    let mut noise = move || {
        let next = |state: &mut u64| {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(|_| next(&mut state)).sum::<f64>() - 6.0
    };
    let pixels = ROWS * COLUMNS;
    let material = |i: usize| i / COLUMNS / 4 % 2;
    let temperature_k = |i: usize| 285.0 + 1.5 * (i % COLUMNS) as f64 + 0.2 * (i / COLUMNS) as f64;
    let v = |i: usize| 0.1 + 0.8 * (i * i % 101) as f64 / 101.0;
    let mut counts = Vec::with_capacity(pixels * BANDS);
    for i in 0..pixels {
        for w in 0..BANDS {
            let (e, nu) = (emissivity(material(i), w), wavenumber(w));
            let light = v(i) * sky(w) + (1.0 - v(i)) * photon_radiance(nu, 293.15);
            let mean = 1e-15 * (e * photon_radiance(nu, temperature_k(i)) + (1.0 - e) * light);
            counts.push(match i {
                30 => f64::NAN,
                60..75 => 0.0,
                150..160 => mean * (1.0 + 0.3 * (w % 2) as f64),
                _ => (mean + mean.sqrt() * noise()).max(0.0).round(),
            });
        }
    }
    let shape = |layers| Shape::new(ROWS, COLUMNS, layers).unwrap();
    write_npy(&folder.path().join("counts.npy"), shape(BANDS), &counts).unwrap();
    let material: Vec<u16> =
        (0..pixels).map(|i| if i % 50 == 0 { 65535 } else { material(i) as u16 }).collect();
    fs::write(folder.path().join("material.npy"), npy_map(&[ROWS, COLUMNS], &material).unwrap()).unwrap();
    let map = |name: &str, values: Vec<f64>, layers| {
        write_npy(&folder.path().join(name), shape(layers), &values).unwrap();
    };
    map("temperature.npy", (0..pixels).map(temperature_k).collect(), 1);
    map("lighting.npy", (0..pixels).flat_map(|i| [v(i), 1.0 - v(i)]).collect(), 2);
    folder
}

/// The answer without its time, and every file of the report.
fn answer(
    folder: &Folder,
    method: Method,
    rows: Option<usize>,
) -> (serde_json::Value, BTreeMap<String, Vec<u8>>) {
    let scenario = DecomposeScenario::from_file(&folder.path().join("a.toml")).unwrap();
    let study = DecomposeStudy::new(&scenario, &Library::embedded().unwrap()).unwrap();
    let room = tempfile::tempdir().unwrap();
    let keep = rows.map_or(Keep::InMemory, |rows| Keep::InFiles { folder: room.path(), rows });
    let found = study.decompose(method, Skipping::On, keep, &|_, _| ()).unwrap();
    assert_eq!(matches!(found.kept, Kept::InFiles(_)), rows.is_some());
    let out = folder.path().join("report");
    let _ = fs::remove_dir_all(&out);
    let bundle = bundle(&found, rows.map(|_| room.path())).unwrap();
    let about = About { answer: "", provenance: &Provenance::default(), inputs: &[] };
    bundle.write_report(&reports::Folder::new(&out, Strangers::Refuse), &about).unwrap();
    let json = serde_json::to_value(&found).unwrap();
    let files = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path());
    let files = files
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap()));
    (json, files.collect())
}

#[test]
fn files_and_memory_give_the_same_bytes() {
    let no_limit = |scenario: &str| scenario.replace("lighting = \"lighting.npy\"\n", "");
    for (scenario, method) in [
        (SCENARIO.to_owned(), Method::Ml),
        (
            no_limit(&SCENARIO.replace("spectrum = \"light.csv\"\ncolumn = \"sky\"", "rows = [0, 4]")),
            Method::Ml,
        ),
        (no_limit(&SCENARIO.replace("lighting_total = 1.0\n", "gain = true\n")), Method::Te),
        (SCENARIO.to_owned(), Method::GreyBody),
        (SCENARIO.split("[truth]").next().unwrap().to_owned(), Method::AnalyticInverse),
    ] {
        let folder = scene(&scenario.replace("1e-13", "1e-15"));
        let (json, files) = answer(&folder, method, None);
        assert!(files.len() > 20 && files.contains_key("tex_vision_image.png"));
        if scenario == SCENARIO && method == Method::Ml {
            let truth = &json["truth"];
            assert!(truth["right_material_limit_pixels"].as_u64() > Some(100), "{truth}");
            assert!(truth["coverage_pixels"].as_u64() > Some(100), "{truth}");
            assert!(json["flags"].as_array().unwrap().len() >= 3, "{}", json["flags"]);
        }
        for rows in [1, 6, 1000] {
            let (own, of_files) = answer(&folder, method, Some(rows));
            assert_eq!(own, json, "{method:?}, {rows} rows");
            assert_eq!(of_files.keys().collect::<Vec<_>>(), files.keys().collect::<Vec<_>>());
            for (name, bytes) in &files {
                assert!(of_files.get(name) == Some(bytes), "{method:?}, {rows} rows: {name}");
            }
        }
    }
}

/// Medians and tenths of a table are those of the map, sorted.
#[test]
fn medians_are_those_of_the_maps() {
    let folder = scene(&SCENARIO.replace("1e-13", "1e-15"));
    let scenario = DecomposeScenario::from_file(&folder.path().join("a.toml")).unwrap();
    let study = DecomposeStudy::new(&scenario, &Library::embedded().unwrap()).unwrap();
    let found = study.decompose(Method::Ml, Skipping::On, Keep::InMemory, &|_, _| ()).unwrap();
    let Kept::InMemory(block) = &found.kept else { panic!("in files") };
    for row in &found.found {
        let place = found.materials.iter().position(|name| *name == row.material).unwrap();
        let own = (0..ROWS * COLUMNS).filter(|i| usize::from(block.maps.material[*i]) == place);
        let mut values: Vec<f32> =
            own.map(|i| block.maps.temperature_k[i]).filter(|t| t.is_finite()).collect();
        values.sort_by(f32::total_cmp);
        let at = |tenths: usize| f64::from(values[tenths * values.len() / 10]);
        assert_eq!(row.temperature_median_k, at(5));
        assert_eq!(row.temperature_tenths_k, [at(1), at(9)]);
    }
}
