//! `hadar decompose` as its user runs it: files, numbers, mistakes.

use crate::support::folder::Folder;
use hadar::cube::Shape;
use hadar::planck::photon_radiance;
use hadar_formats::cube::{npy_map, write_npy};
use std::fs;

pub(crate) const SCENARIO: &str = r#"title = "Wall and pane"
[cube]
data = "counts.npy"
counts_per_photon_radiance = 1e-13
[bands]
start = "800 cm^-1"
stop = "1200 cm^-1"
step = "20 cm^-1"
[[environment]]
spectrum = "light.csv"
column = "sky"
[[environment]]
temperature = "20 degC"
[library]
path = "library.csv"
[unknown]
temperature = ["250 K", "340 K"]
lighting_total = 1.0
[truth]
material = "material.npy"
temperature = "temperature.npy"
lighting = "lighting.npy"
"#;

const ROWS: usize = 2;
const COLUMNS: usize = 3;
pub(crate) const BANDS: usize = 21;

pub(crate) fn wavenumber(band: usize) -> f64 {
    800.0 + 20.0 * band as f64
}

pub(crate) fn emissivity(material: usize, band: usize) -> f64 {
    let nu = wavenumber(band);
    [0.9 + 0.05 * (nu / 30.0).sin(), 0.5 + 0.3 * (-((nu - 1000.0) / 50.0).powi(2)).exp()][material]
}

pub(crate) fn sky(band: usize) -> f64 {
    photon_radiance(wavenumber(band), 260.0) * (0.7 + 0.2 * (wavenumber(band) / 45.0).cos())
}

/// Photon radiance of pixel i, and its truth.
fn pixel(i: usize) -> (Vec<f64>, usize, f64, f64) {
    let (material, temperature_k, v) = (i % 2, 285.0 + 5.0 * i as f64, 0.2 + 0.1 * i as f64);
    let radiance = (0..BANDS).map(|w| {
        let (e, nu) = (emissivity(material, w), wavenumber(w));
        let light = v * sky(w) + (1.0 - v) * photon_radiance(nu, 293.15);
        e * photon_radiance(nu, temperature_k) + (1.0 - e) * light
    });
    (radiance.collect(), material, temperature_k, v)
}

pub(crate) fn with(scenario: &str) -> Folder {
    let folder = Folder::with(scenario);
    let tables: Vec<[String; 2]> = (0..BANDS)
        .map(|w| {
            let nu = wavenumber(w);
            [format!("{nu},{},{}", emissivity(0, w), emissivity(1, w)), format!("{nu},{}", sky(w))]
        })
        .collect();
    let table =
        |head: &str, i: usize| tables.iter().fold(head.to_owned(), |text, rows| text + "\n" + &rows[i]);
    folder.file("library.csv", &table("wavenumber_cm1,Wall Paint,pane", 0));
    folder.file("light.csv", &table("wavenumber_cm1,sky", 1));
    let pixels: Vec<_> = (0..ROWS * COLUMNS).map(pixel).collect();
    let counts: Vec<f64> = pixels.iter().flat_map(|p| p.0.iter().map(|s| 1e-13 * s)).collect();
    let shape = |bands| Shape::new(ROWS, COLUMNS, bands).unwrap();
    write_npy(&folder.path().join("counts.npy"), shape(BANDS), &counts).unwrap();
    let map = |name: &str, values: Vec<f64>, layers| {
        write_npy(&folder.path().join(name), shape(layers), &values).unwrap();
    };
    let material: Vec<u16> = pixels.iter().map(|p| p.1 as u16).collect();
    fs::write(folder.path().join("material.npy"), npy_map(&[ROWS, COLUMNS], &material).unwrap()).unwrap();
    map("temperature.npy", pixels.iter().map(|p| p.2).collect(), 1);
    map("lighting.npy", pixels.iter().flat_map(|p| [p.3, 1.0 - p.3]).collect(), 2);
    folder
}

/// A material that the library lacks is none of its materials where that may be; where it is silent the answer says so.
#[test]
fn none_of_these_is_told_where_it_is_asked() {
    let asked = |library: &str| with(&SCENARIO.replace("[library]\n", &format!("[library]\n{library}")));
    let whole = asked("none_of_these = 0.1\n");
    let found = whole.json(&["decompose", "a.toml", "--out", "out"]);
    // A pixel nearly as warm as the ground tells little.
    let likeliest = &found["none_of_these"]["likeliest"];
    assert_eq!((found["decided"].as_u64(), likeliest), (Some(5), &serde_json::json!(0)));
    let map = fs::read(whole.path().join("out/none_of_these.npy")).unwrap();
    assert_eq!(map.len(), 128 + ROWS * COLUMNS * 4);
    let short = |more: &str| {
        let folder = asked(more);
        let table = fs::read_to_string(folder.path().join("library.csv")).unwrap();
        let one = table.lines().map(|line| line.rsplit_once(',').unwrap().0).collect::<Vec<_>>().join("\n");
        folder.file("library.csv", &one);
        let scenario = fs::read_to_string(folder.path().join("a.toml")).unwrap();
        folder.file("a.toml", scenario.split("[truth]").next().unwrap());
        folder
    };
    let folder = short("none_of_these = 0.1\n");
    let found = folder.json(&["decompose", "a.toml"]);
    assert_eq!(
        (found["decided"].as_u64(), &found["none_of_these"]["alone"]),
        (Some(2), &serde_json::json!(3))
    );
    let text = folder.run(&["decompose", "a.toml"]).stdout;
    assert!(text.contains("likeliest in 3 pixels, the only candidate in 3"), "{text}");
    let text = short("").run(&["decompose", "a.toml"]).stdout;
    assert!(text.contains("every pixel is taken for one surface of these materials"), "{text}");
    let refused = whole.run(&["decompose", "a.toml", "--method", "grey-body"]);
    assert!(refused.code == 1 && refused.stderr.contains("library.none_of_these"), "{}", refused.stderr);
    for (library, more, what) in [
        ("none_of_these = 0\n", "", "a probability above 0 and below 1"),
        ("none_of_these = 1.0\n", "", "a probability above 0 and below 1"),
        ("none_of_these = 0.1\n", "[spatial]\nprior = \"potts\"\n", "library.none_of_these out"),
    ] {
        let folder = asked(library);
        let scenario = fs::read_to_string(folder.path().join("a.toml")).unwrap();
        folder.file("a.toml", &scenario.replace("[truth]", &format!("{more}[truth]")));
        let ran = folder.run(&["decompose", "a.toml"]);
        assert!(ran.code == 1 && ran.stderr.contains(what), "{}", ran.stderr);
    }
}

/// A material of one number is named before anything is decided for or against it, also where it is a person that is excluded.
#[test]
fn what_is_entered_as_one_number_is_said() {
    let category = "[[category]]\nname = \"person\"\nmaterials = [\"flat\"]\nsafety = true\n[[category]]\nname = \"rest\"\nmaterials = [\"Wall Paint\", \"pane\"]\n";
    let folder = with(&format!("{}{category}", SCENARIO.split("[truth]").next().unwrap()));
    let silent = folder.run(&["decompose", "a.toml"]);
    assert!(silent.code == 1 && silent.stderr.contains("flat"), "{}", silent.stderr);
    let table = fs::read_to_string(folder.path().join("library.csv")).unwrap();
    let column = |i: usize| if i == 0 { ",flat".to_owned() } else { ",0.6".to_owned() };
    let with_flat: Vec<String> =
        table.lines().enumerate().map(|(i, line)| line.to_owned() + &column(i)).collect();
    folder.file("library.csv", &with_flat.join("\n"));
    let ran = folder.run(&["decompose", "a.toml"]);
    let first = ran.stdout.lines().next().unwrap_or_default();
    assert!(first.contains("flat is entered as one number, which was not measured"), "{}", ran.stdout);
    assert!(ran.stdout.contains("real surfaces are as the one number of flat"), "{}", ran.stdout);
    let found = folder.json(&["decompose", "a.toml"]);
    assert_eq!(found["constants"], serde_json::json!(["flat"]));
    assert_eq!(found["segmentation"]["safety"][0]["constants"], serde_json::json!(["flat"]));
    let rounded: Vec<String> = table
        .lines()
        .enumerate()
        .map(|(i, line)| {
            line.to_owned() + [",0.600000", ",0.600001", ",flat"][if i == 0 { 2 } else { i % 2 }]
        })
        .collect();
    folder.file("library.csv", &rounded.join("\n"));
    assert_eq!(folder.json(&["decompose", "a.toml"])["constants"], serde_json::json!(["flat"]));
    let measured = with(SCENARIO).json(&["decompose", "a.toml"]);
    assert!(measured.get("constants").is_none());
}

#[test]
fn two_surfaces_are_told_where_they_are_asked() {
    let asked = |library: &str| with(&SCENARIO.replace("[library]\n", &format!("[library]\n{library}")));
    let whole = asked("mixed = 0.05\n");
    let found = whole.json(&["decompose", "a.toml", "--out", "out"]);
    assert_eq!(
        (found["mixed"]["prior"].as_f64(), &found["mixed"]["likeliest"]),
        (Some(0.05), &serde_json::json!(0))
    );
    let pixels = ROWS * COLUMNS;
    let files = [
        ("mixed.npy", 4),
        ("mixed_materials.npy", 4),
        ("mixed_share.npy", 8),
        ("mixed_temperature_k.npy", 8),
        ("mixed_temperature_sigma_k.npy", 8),
    ];
    for (name, bytes) in files {
        assert_eq!(
            fs::read(whole.path().join("out").join(name)).unwrap().len(),
            128 + pixels * bytes,
            "{name}"
        );
    }
    // Half of each of two pixels in the place of one of them.
    let cube = whole.path().join("counts.npy");
    let mut bytes = fs::read(&cube).unwrap();
    let values: Vec<f32> =
        bytes[128..].as_chunks::<4>().0.iter().map(|value| f32::from_le_bytes(*value)).collect();
    let bands = values.len() / pixels;
    let last = pixels - 1;
    for band in 0..bands {
        let both = 0.5 * (values[band] + values[last * bands + band]);
        bytes[128 + 4 * band..][..4].copy_from_slice(&both.round().to_le_bytes());
    }
    fs::write(&cube, bytes).unwrap();
    let scenario = fs::read_to_string(whole.path().join("a.toml")).unwrap();
    whole.file("a.toml", scenario.split("[truth]").next().unwrap());
    let found = whole.json(&["decompose", "a.toml"]);
    assert_eq!(found["mixed"]["likeliest"], serde_json::json!(1), "{}", found["mixed"]);
    let pair = &found["mixed"]["pairs"][0];
    assert!((pair["share_mean"].as_f64().unwrap() - 0.5).abs() < 0.2, "{pair}");
    let text = whole.run(&["decompose", "a.toml"]).stdout;
    assert!(text.contains("likeliest in 1 pixels"), "{text}");
    let refused = whole.run(&["decompose", "a.toml", "--method", "grey-body"]);
    assert!(refused.code == 1 && refused.stderr.contains("library.mixed"), "{}", refused.stderr);
    for (library, more, what) in [
        ("mixed = 0\n", "", "a probability above 0 and below 1"),
        ("mixed = 0.5\nnone_of_these = 0.5\n", "", "below 1"),
        ("mixed = 0.1\nemissivity_error = 0.01\n", "", "library.mixed out"),
        ("mixed = 0.1\n", "[spatial]\nprior = \"potts\"\n", "library.mixed out"),
    ] {
        let folder = asked(library);
        let scenario = fs::read_to_string(folder.path().join("a.toml")).unwrap();
        folder.file("a.toml", &scenario.replace("[truth]", &format!("{more}[truth]")));
        let ran = folder.run(&["decompose", "a.toml"]);
        assert!(ran.code == 1 && ran.stderr.contains(what), "{library}: {}", ran.stderr);
    }
}

#[test]
fn maps_and_numbers_are_those_of_the_scene() {
    let folder = with(SCENARIO);
    let found = folder.json(&["decompose", "a.toml", "--out", "out"]);
    assert_eq!(found["materials"], serde_json::json!(["Wall Paint", "pane"]));
    assert_eq!(
        (found["pixels"].as_u64(), found["decided"].as_u64(), found["undecided"].as_u64()),
        (Some(6), Some(6), Some(0))
    );
    let truth = &found["truth"];
    assert_eq!((truth["right_material"].as_f64(), truth["coverage_95"].as_f64()), (Some(1.0), Some(1.0)));
    assert_eq!(truth["confusion"], serde_json::json!([[3, 0, 0], [0, 3, 0]]));
    assert!(truth["temperature_rmse_k"].as_f64().unwrap() < 1e-4);
    assert!(truth["right_material_limit"].as_f64().unwrap() > 0.999);
    assert!(found["stats"]["material_fits"].is_object(), "{}", found["stats"]);
    for (name, bytes) in [
        ("material.npy", 2),
        ("temperature_k.npy", 4),
        ("temperature_sigma_k.npy", 4),
        ("lighting.npy", 8),
        ("lighting_sigma.npy", 8),
        ("texture_sigma.npy", 4),
        ("candidates_k.npy", 6),
        ("candidates_k_posterior.npy", 12),
        ("p_value.npy", 4),
        ("posterior.npy", 4),
        ("candidates.npy", 2),
        ("flags.npy", 1),
    ] {
        let file = fs::read(folder.path().join("out").join(name)).unwrap();
        assert_eq!(file.len(), 128 + ROWS * COLUMNS * bytes, "{name}");
        let head = String::from_utf8_lossy(&file[10..127]).into_owned();
        let size = match name {
            "lighting.npy" | "lighting_sigma.npy" => "(2, 3, 2)",
            "candidates_k.npy" | "candidates_k_posterior.npy" => "(2, 3, 3)",
            _ => "(2, 3)",
        };
        assert!(head.contains(size), "{head}");
    }
    let written = |at: &str, name: &str| fs::read(folder.path().join(at).join(name)).unwrap();
    folder.json(&["decompose", "a.toml", "--candidates", "1", "--no-skip", "--out", "one"]);
    assert_eq!(written("one", "candidates_k.npy")[128..], written("out", "material.npy")[128..]);
    assert_eq!(written("one", "candidates_k_posterior.npy")[128..], written("out", "posterior.npy")[128..]);
    for name in
        ["lighting_sigma.npy", "texture_sigma.npy", "flags.png", "flags.csv", "p_value.png", "p_value.csv"]
    {
        assert_eq!(written("one", name), written("out", name), "{name}");
    }
    // The scenario that was written asks the same again.
    let again = folder.json(&["decompose", "out/scenario.toml"]);
    assert_eq!(again["found"], found["found"]);
    let text = folder.run(&["decompose", "a.toml", "--stats"]);
    assert!(
        text.stdout.starts_with("6 of 6 pixels (100 %) have one remaining material of 2."),
        "{}",
        text.stdout
    );
    assert!(text.stderr.contains("fits of a material to a pixel"), "{}", text.stderr);
}

/// W m⁻² sr⁻¹ per cm⁻¹ in other units by textbook factors, λ in µm: the same temperatures, whether the scenario or the file says the unit; of a
/// file the noise stays in that of the scenario, and so do the deviations.
#[test]
fn a_radiance_is_the_same_in_every_unit() {
    const W: &str = "W m^-2 sr^-1 per cm^-1";
    let joules = |nu: f64| 6.626_070_15e-34 * 299_792_458.0 * 100.0 * nu;
    let per_um = |nu: f64| nu * nu / 1e4;
    let units: [(&str, &dyn Fn(f64) -> f64); 12] = [
        (W, &|_| 1.0),
        ("W/(m2 sr cm-1)", &|_| 1.0),
        ("mW m-2 sr-1 (cm-1)-1", &|_| 1e3),
        ("W cm-2 sr-1 (cm-1)-1", &|_| 1e-4),
        ("W m-2 sr-1 um-1", &per_um),
        ("W m⁻² sr⁻¹ µm⁻¹", &per_um),
        ("W m-2 sr-1 nm-1", &|nu| per_um(nu) / 1e3),
        ("microflick", &|nu| per_um(nu) * 1e2),
        ("W m-2 sr-1 Hz-1", &|_| 1.0 / 29_979_245_800.0),
        ("photons s-1 m-2 sr-1 (cm-1)-1", &|nu| 1.0 / joules(nu)),
        ("photons s-1 m-2 sr-1 um-1", &|nu| per_um(nu) / joules(nu)),
        ("ph s-1 cm-2 sr-1 um-1", &|nu| per_um(nu) / joules(nu) / 1e4),
    ];
    let folder = with(SCENARIO);
    let cube = |factor: &dyn Fn(f64) -> f64| -> Vec<f64> {
        let of = |i: usize| {
            pixel(i)
                .0
                .iter()
                .enumerate()
                .map(|(w, s)| joules(wavenumber(w)) * s * factor(wavenumber(w)))
                .collect::<Vec<_>>()
        };
        (0..ROWS * COLUMNS).flat_map(of).collect()
    };
    let scenario = |file: &str, unit: &str, noise: f64| {
        let said = format!("unit = \"{unit}\"\nnoise = {noise:e}");
        SCENARIO.replace("counts.npy", file).replace("counts_per_photon_radiance = 1e-13", &said)
    };
    let shape = Shape::new(ROWS, COLUMNS, BANDS).unwrap();
    let own = |found: &serde_json::Value| found["found"][0]["temperature_sigma_median_k"].as_f64().unwrap();
    let mut sigma_k = None;
    for (unit, factor) in units {
        let samples = cube(factor);
        write_npy(&folder.path().join("u.npy"), shape, &samples).unwrap();
        let least = samples.iter().copied().fold(f64::INFINITY, f64::min);
        folder.file("b.toml", &scenario("u.npy", unit, 1e-4 * least));
        let found = folder.json(&["decompose", "b.toml"]);
        assert!(found["truth"]["temperature_rmse_k"].as_f64().unwrap() < 1e-3, "{unit}: {}", found["truth"]);
        // The file says the unit, and the scenario another one.
        let raw: Vec<u8> = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
        fs::write(folder.path().join("u.img"), raw).unwrap();
        let header = |unit: &str| {
            format!(
                "ENVI\nsamples = {COLUMNS}\nlines = {ROWS}\nbands = {BANDS}\nheader offset = 0\ndata type = 5\ninterleave = bip\nbyte order = 0\ndata units = {unit}\n"
            )
        };
        folder.file("u.hdr", &header(unit));
        folder.file("c.toml", &scenario("u.img", W, 1e-5));
        let found = folder.json(&["decompose", "c.toml"]);
        assert!(found["truth"]["temperature_rmse_k"].as_f64().unwrap() < 1e-3, "{unit}: {}", found["truth"]);
        let sigma_k = *sigma_k.get_or_insert(own(&found));
        assert!((own(&found) / sigma_k - 1.0).abs() < 1e-6, "{unit}: {} {sigma_k}", own(&found));
        let codes: Vec<&str> =
            found["warnings"].as_array().unwrap().iter().filter_map(|one| one["code"].as_str()).collect();
        assert_eq!(codes.contains(&"unit-converted"), factor(1000.0) != 1.0, "{unit}: {codes:?}");
        // Counts are no radiance, whatever factor is said.
        folder.file("d.toml", &SCENARIO.replace("counts.npy", "u.img"));
        assert!(folder.refusal(&["decompose", "d.toml"]).contains("radiances by their file"), "{unit}");
    }
    // A name before a unit, or in its place, is none.
    let rename = |unit: &str| {
        let text = fs::read_to_string(folder.path().join("u.hdr")).unwrap();
        let kept =
            text.lines().filter(|line| !line.starts_with("data units")).map(|line| format!("{line}\n"));
        folder.file("u.hdr", &kept.chain([format!("data units = {unit}\n")]).collect::<String>());
    };
    rename("Radiance [ph s-1 cm-2 sr-1 um-1]");
    assert!(folder.json(&["decompose", "c.toml"])["truth"]["temperature_rmse_k"].as_f64().unwrap() < 1e-3);
    rename("Spectral Radiance");
    folder.file("e.toml", &scenario("u.img", "ph s-1 cm-2 sr-1 um-1", 1e10));
    assert!(folder.json(&["decompose", "e.toml"])["truth"]["temperature_rmse_k"].as_f64().unwrap() < 1e-3);
    for (unit, what) in [
        ("DN", "`DN` is no unit of spectral radiance"),
        ("K", "no factor makes photons"),
        ("counts", "in `counts` by their file"),
    ] {
        rename(unit);
        let refused = folder.refusal(&["decompose", "c.toml"]);
        assert!(refused.contains(what), "{unit}: {refused}");
    }
    // What a camera counts are photons, whose variance is their number; that of digital numbers is another.
    let by_camera =
        SCENARIO.replace("counts.npy", "u.img").replace("counts_per_photon_radiance = 1e-13\n", "");
    folder.file("f.toml", &format!("{by_camera}[camera]\nexposure = \"2 ms\"\npixel = \"24 um\"\nf_number = 1.4\nfocal_length = \"14 mm\"\nnoise_electrons = 3000\nnoise_exposure = \"2 ms\"\n"));
    for (unit, is_taken) in [("DN", false), ("ADU", false), ("photoelectrons", true), ("none", true)] {
        rename(unit);
        let refused = folder.run(&["decompose", "f.toml"]).stderr.contains("photons that the camera counts");
        assert_eq!(!refused, is_taken, "{unit}");
    }
    for (unit, what) in [
        ("K", "the samples are at least "),
        ("m", "neither one power"),
        ("W m-2 sr-1 cm-1", "per cm^-1 is"),
        ("W m-2 um-1", "not per sr"),
        ("W m-2 sr-1 um-2", "not per area"),
    ] {
        folder.file("b.toml", &scenario("u.npy", unit, 1.0));
        let refused = folder.refusal(&["decompose", "b.toml"]);
        assert!(refused.contains(what) && refused.contains("cube.unit"), "{unit}: {refused}");
    }
}

/// Brightness temperatures, T of B(ν, T) = L, in several units, of the scenario or the file: the same temperatures as radiances, and the deviations of
/// a noise of σ_L = σ_T hcν dB/dT(300 K), which the scenario of radiances has by band.
#[test]
fn a_brightness_temperature_is_a_radiance() {
    let (h, c, k) = (6.626_070_15e-34, 299_792_458.0, 1.380_649e-23);
    let joules = |nu: f64| h * c * 100.0 * nu;
    let kelvin = |nu: f64, s: f64| joules(nu) / k / (200.0 * c * (100.0 * nu).powi(2) * 1.0 / s).ln_1p();
    let slope = |nu: f64| {
        let x = joules(nu) / (k * 300.0);
        joules(nu) * 200.0 * c * (100.0 * nu).powi(2) * x / 300.0 * x.exp() / x.exp_m1().powi(2)
    };
    let folder = with(SCENARIO);
    let shape = Shape::new(ROWS, COLUMNS, BANDS).unwrap();
    let cube = |of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        (0..ROWS * COLUMNS)
            .flat_map(|i| {
                pixel(i).0.iter().enumerate().map(|(w, s)| of(wavenumber(w), *s)).collect::<Vec<_>>()
            })
            .collect()
    };
    let rows: String = (0..BANDS).map(|w| format!("{w},{:e}\n", 0.05 * slope(wavenumber(w)))).collect();
    folder.file("sigma.csv", &format!("band,sigma\n{rows}"));
    write_npy(&folder.path().join("r.npy"), shape, &cube(&|nu, s| joules(nu) * s)).unwrap();
    let said = |file: &str, lines: &str| {
        SCENARIO.replace("counts.npy", file).replace("counts_per_photon_radiance = 1e-13", lines)
    };
    folder.file("r.toml", &said("r.npy", "unit = \"W m^-2 sr^-1 per cm^-1\"\nnoise = \"sigma.csv\""));
    let radiances = folder.json(&["decompose", "r.toml"]);
    let sigma = |found: &serde_json::Value| found["found"][0]["temperature_sigma_median_k"].as_f64().unwrap();
    for (unit, number, noise) in [
        ("K", &(|t| t) as &dyn Fn(f64) -> f64, 0.05),
        ("0.01 K", &|t| 100.0 * t, 5.0),
        ("mK", &|t| 1000.0 * t, 50.0),
        ("degC", &|t| t - 273.15, 0.05),
        ("degF", &|t| (t - 273.15) * 1.8 + 32.0, 0.09),
    ] {
        write_npy(&folder.path().join("t.npy"), shape, &cube(&|nu, s| number(kelvin(nu, s)))).unwrap();
        folder.file("t.toml", &said("t.npy", &format!("unit = \"{unit}\"\nnoise = {noise}")));
        let found = folder.json(&["decompose", "t.toml", "--out", "out", "--force"]);
        assert!(found["truth"]["temperature_rmse_k"].as_f64().unwrap() < 1e-6, "{unit}: {}", found["truth"]);
        assert!((sigma(&found) / sigma(&radiances) - 1.0).abs() < 1e-6, "{unit}");
        let again = folder.json(&["decompose", "out/scenario.toml"]);
        assert_eq!(again["found"], found["found"], "{unit}");
    }
    // A file's unit is that of its samples, the noise keeps the scenario's.
    let raw: Vec<u8> =
        cube(&|nu, s| kelvin(nu, s) - 273.15).iter().flat_map(|sample| sample.to_le_bytes()).collect();
    fs::write(folder.path().join("t.img"), raw).unwrap();
    let header = |unit: &str| {
        format!(
            "ENVI\nsamples = {COLUMNS}\nlines = {ROWS}\nbands = {BANDS}\ndata type = 5\ninterleave = bip\nbyte order = 0\ndata units = {unit}\n"
        )
    };
    folder.file("t.hdr", &header("degC"));
    folder.file("t.toml", &said("t.img", "unit = \"K\"\nnoise = 0.05"));
    let found = folder.json(&["decompose", "t.toml"]);
    assert!((sigma(&found) / sigma(&radiances) - 1.0).abs() < 1e-6);
    folder.file("t.hdr", &header("W m-2 sr-1 um-1"));
    let refused = folder.refusal(&["decompose", "t.toml"]);
    assert!(refused.contains("in `W m-2 sr-1 um-1` by their file, and in `K` by the scenario"), "{refused}");
    // Celsius that are called kelvin are none.
    folder.file("t.hdr", &header("none"));
    let refused = folder.refusal(&["decompose", "t.toml"]);
    assert!(refused.contains("cube.unit: the samples are at most 21.1 K in the first row"), "{refused}");
}

/// Radiances in watts with a noise, a camera's counts, light from rows of the cube, some of the materials: the same temperatures.
#[test]
fn units_and_lights_are_what_is_said() {
    let folder = with(SCENARIO);
    let watts: Vec<f64> = (0..ROWS * COLUMNS)
        .flat_map(|i| {
            let joules = |w: usize| 6.626_070_15e-34 * 299_792_458.0 * 100.0 * wavenumber(w);
            pixel(i).0.iter().enumerate().map(|(w, s)| joules(w) * s).collect::<Vec<_>>()
        })
        .collect();
    write_npy(&folder.path().join("watts.npy"), Shape::new(ROWS, COLUMNS, BANDS).unwrap(), &watts).unwrap();
    let unit = "unit = \"W m^-2 sr^-1 per cm^-1\"\nnoise = 1e-5";
    folder.file(
        "b.toml",
        &SCENARIO.replace("counts.npy", "watts.npy").replace("counts_per_photon_radiance = 1e-13", unit),
    );
    let found = folder.json(&["decompose", "b.toml"]);
    assert_eq!(found["truth"]["right_material"].as_f64(), Some(1.0));
    assert!(found["truth"]["temperature_rmse_k"].as_f64().unwrap() < 1e-3, "{}", found["truth"]);
    // Twice the noise, twice the deviation.
    folder.file(
        "c.toml",
        &SCENARIO
            .replace("counts.npy", "watts.npy")
            .replace("counts_per_photon_radiance = 1e-13", &unit.replace("1e-5", "2e-5")),
    );
    let noisier = folder.json(&["decompose", "c.toml"]);
    let sigma = |found: &serde_json::Value| found["found"][0]["temperature_sigma_median_k"].as_f64().unwrap();
    assert!((sigma(&noisier) / sigma(&found) - 2.0).abs() < 1e-3);
    let rows = SCENARIO.replace("spectrum = \"light.csv\"\ncolumn = \"sky\"", "rows = [0, 1]");
    folder.file(
        "d.toml",
        &rows.replace(
            "path = \"library.csv\"",
            "path = \"library.csv\"\nmaterials = [\"pane\", \"Wall Paint\"]",
        ),
    );
    assert_eq!(folder.json(&["decompose", "d.toml"])["materials"], serde_json::json!(["pane", "Wall Paint"]));
}

#[test]
fn mistakes_are_one_line_with_what_to_write() {
    let folder = with(SCENARIO);
    let turned = Shape::new(BANDS, ROWS, COLUMNS).unwrap();
    write_npy(&folder.path().join("turned.npy"), turned, &[1.0; BANDS * ROWS * COLUMNS]).unwrap();
    let negative = Shape::new(1, 1, BANDS).unwrap();
    write_npy(&folder.path().join("negative.npy"), negative, &[-3.0; BANDS]).unwrap();
    let bare = SCENARIO.split("[truth]").next().unwrap();
    let cases = [
        (
            SCENARIO.replace("counts.npy", "turned.npy"),
            "if these are the bands of its file, write axes = \"bands,rows,columns\"",
        ),
        (
            SCENARIO.replace("1200 cm^-1", "1180 cm^-1"),
            "the cube is 2 x 3 x 21 (rows, columns, bands), but [bands] are 20",
        ),
        (bare.replace("counts.npy", "negative.npy"), "row 0, column 0, band 0 holds -3"),
        (bare.replace("counts.npy", "none.npy"), "none.npy"),
        (SCENARIO.replace("[\"250 K\", \"340 K\"]", "[\"250 K\", \"250 K\"]"), "a range of one temperature"),
        (
            SCENARIO.replace("column = \"sky\"", "column = \"skye\""),
            "there is no column `skye`; did you mean `sky`?",
        ),
        (
            SCENARIO.replace("counts_per_photon_radiance = 1e-13\n", ""),
            "the scale of the samples is not stated",
        ),
        (SCENARIO.replace("= 1e-13", "= 1e-13\nbad_bands = [21]"), "band 21 of 21; count from 0 up to 20"),
        (
            SCENARIO.replace("\"library.csv\"", "\"library.csv\"\nprior = [1.0]"),
            "1 probabilities for 2 materials",
        ),
        (SCENARIO.replace("temperature = \"20 degC\"", "rows = [1, 5]"), "rows 1 to 5 of a cube of 2"),
        (SCENARIO.replace("\"material.npy\"", "\"counts.npy\""), "the map is 2 x 3 x 21"),
        (
            SCENARIO.replace("\"library.csv\"", "\"library.csv\"\nemissivity_correlation = \"50 cm^-1\""),
            "a correlation of no error",
        ),
        (SCENARIO.replace("[library]\npath = \"library.csv\"", "[library]"), "no materials"),
        (
            SCENARIO.replace("\"lighting.npy\"", "[\"temperature.npy\"]"),
            "1 maps of lighting for 2 surroundings",
        ),
        (SCENARIO.replace("1e-13", "-1e-13"), "cube.counts_per_photon_radiance"),
        (SCENARIO.replace("title =", "titel ="), "there is no key `titel`"),
    ];
    for (scenario, message) in cases {
        folder.file("a.toml", &scenario);
        let outcome = folder.run(&["decompose", "a.toml"]);
        assert_eq!(outcome.code, 1, "{message}: {}", outcome.stdout);
        assert!(
            outcome.stderr.contains(message) && outcome.stderr.trim().lines().count() == 1,
            "{message}: {}",
            outcome.stderr
        );
    }
    // Light that does not reach over the bands.
    folder.file("light.csv", "wavenumber_cm1,sky\n800,1e18\n1000,1e18\n");
    folder.file("a.toml", SCENARIO);
    assert!(
        folder.run(&["decompose", "a.toml"]).stderr.contains("the spectrum reaches from 800 to 1000 cm^-1")
    );
    // The file of another command is sent there.
    assert!(folder.run(&["size", "a.toml"]).stderr.contains("hadar decompose a.toml"));
}

/// Every method says which it is and writes the same maps; what it has no notion of is none.
#[test]
fn methods_say_what_they_are() {
    let folder = with(SCENARIO);
    for (method, names, candidates) in
        [("ml", true, 6), ("te", true, 6), ("analytic-inverse", true, 0), ("grey-body", false, 0)]
    {
        let found = folder.json(&["decompose", "a.toml", "--method", method, "--out", method]);
        assert_eq!(found["method"], method);
        let truth = &found["truth"];
        assert_eq!(truth["right_material"].is_number(), names, "{truth}");
        let error_k = truth["temperature_rmse_k"].as_f64().unwrap();
        assert!(if method == "ml" { error_k < 1e-4 } else { error_k > 0.5 }, "{method}: {error_k}");
        assert_eq!(truth["coverage_95"].is_number(), ["ml", "te"].contains(&method), "{truth}");
        assert!(found["decided"].as_u64().unwrap() <= candidates);
        let lighting = fs::read(folder.path().join(method).join("lighting.npy")).unwrap();
        assert_eq!(lighting.len(), 128 + ROWS * COLUMNS * 8);
        let text = folder.run(&["decompose", "a.toml", "--method", method]).stdout;
        assert!(text.contains(&format!("\n  method: {method}")), "{text}");
        assert!(!text.contains("NaN"), "{text}");
    }
    let gain = SCENARIO.replace("lighting_total", "gain = true\nlighting_total");
    folder.file("b.toml", &gain);
    let refused = folder.run(&["decompose", "b.toml", "--method", "grey-body"]);
    assert!(refused.stderr.contains("unknown.gain") && refused.stderr.contains("take --method ml or te"));
}

/// A class in the library: its members are materials, and its pixels are counted together; the wall of the cube is one of them.
#[test]
fn a_class_in_the_library_counts_its_members_together() {
    let folder = with(SCENARIO);
    let column = |name: &str, i: usize| {
        let text = (0..BANDS).fold("wavenumber_cm1,emissivity".to_owned(), |text, w| {
            format!("{text}\n{},{}", wavenumber(w), emissivity(i, w))
        });
        folder.file(name, &text);
    };
    column("wall.csv", 0);
    column("pane.csv", 1);
    let flat = "wavenumber_cm1,emissivity\n700,0.7\n1300,0.72\n";
    folder.file("flat.csv", flat);
    let classes = "\n[class.stone]\nmaterials = [\"wall.csv\", \"flat.csv\"]\nweights = [3.0, 1.0]\n";
    let asked = SCENARIO
        .replace("path = \"library.csv\"", "materials = [\"stone\", \"pane.csv\"]")
        .replace("material = \"material.npy\"\n", "")
        + classes;
    folder.file("a.toml", &asked);
    let answer = folder.json(&["decompose", "a.toml"]);
    let names: Vec<&str> =
        answer["materials"].as_array().unwrap().iter().filter_map(|m| m.as_str()).collect();
    assert_eq!(names, ["stone/wall", "stone/flat", "pane"]);
    let class = &answer["classes"][0];
    assert_eq!(
        (class["class"].as_str(), class["spectra"].as_u64(), class["pixels"].as_u64()),
        (Some("stone"), Some(2), Some(3))
    );
    assert_eq!(answer["scenario"]["class"]["stone"]["weights"][0].as_f64(), Some(3.0));
    for (old, new, said) in [
        ("\"flat.csv\"", "\"none.csv\"", "there is no such file"),
        ("weights = [3.0, 1.0]", "mixtures = true", "mixtures of the class `stone`; leave mixtures out"),
        (
            "\"pane.csv\"]",
            "\"wall.csv\", \"stone\"]",
            "`stone/wall` stands in the library twice; name it once",
        ),
        ("[\"stone\", ", "[\"stones\", ", "there is no material `stones`"),
    ] {
        folder.file("b.toml", &asked.replace(old, new));
        let refused = folder.refusal(&["decompose", "b.toml"]);
        assert!(refused.contains(said), "{refused}\n{said}");
    }
}
