//! Each kind of mistake in a scenario file, and the one line that is said about it.

use std::path::Path;

use hadar_scenario::Scenario;

/// The message for a scenario that is right up to `rest`, which begins on line 4 of `a.toml`.
#[track_caller]
fn message(rest: &str) -> String {
    whole(&format!("[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n{rest}"))
}

#[track_caller]
fn whole(text: &str) -> String {
    match Scenario::from_toml(text, Some(Path::new("a.toml"))) {
        Ok(scenario) => panic!("{text} was read as {scenario:?}"),
        Err(error) => error.to_string(),
    }
}

macro_rules! messages {
    ($read:ident: $($text:expr => $expected:expr,)+) => {
        $(assert_eq!($read($text), $expected, "\n{}", $text);)+
    };
}

#[test]
fn a_file_that_cannot_be_read_is_said_to_be_so() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str, content: Option<&[u8]>| {
        let path = folder.path().join(name);
        if let Some(content) = content {
            std::fs::write(&path, content).unwrap();
        }
        let message = Scenario::from_file(&path).unwrap_err().to_string();
        message.strip_prefix(&path.display().to_string()).unwrap().to_owned()
    };
    assert_eq!(
        message("none.toml", None),
        ": cannot read the scenario: there is no such file; check its name and folder"
    );
    assert_eq!(
        message("", None),
        ": cannot read the scenario: it is a directory; name the .toml file inside it"
    );
    let empty = ": the file is empty; write [target] with material = \"skin\" and temperature = \"37 degC\"";
    assert_eq!(message("a.toml", Some(b"")), empty);
    assert_eq!(message("a.toml", Some(b" \r\n\n")), empty);
    assert_eq!(
        message("a.toml", Some(b"title = \"x\"\n# \xff\n")),
        ":2: the file is not UTF-8 text; name a TOML file, saved as UTF-8"
    );
    assert_eq!(
        message("a.toml", Some(&vec![b' '; (1 << 20) + 1])),
        ": cannot read the scenario: it is longer than 1 MiB, more than such a file needs"
    );
}

#[test]
fn a_file_that_is_no_scenario_says_what_is_missing() {
    messages! { whole:
        "# nothing" =>
            r#"a.toml: target: the table is missing; write [target] with material = "skin" and temperature = "37 degC""#,
        r#"title = "x""# =>
            r#"a.toml: target: the table is missing; write [target] with material = "skin" and temperature = "37 degC""#,
        "[target]\nmaterial = \"skin\"" =>
            r#"a.toml:1: target.temperature: the key is missing; write temperature = "37 degC""#,
        "[target]\n\ntemperature = \"37 degC\"" =>
            r#"a.toml:1: target.material: the key is missing; write material = "skin""#,
        "[target]\nmaterial = \"skin\"\ntemperature = 37 degC" =>
            r#"a.toml:3: this is not TOML: string values must be quoted, expected literal string; correct the line (a quantity is text in quotes, as in temperature = "37 degC")"#,
        "[target]\nmaterial = \"skin\ntemperature = \"37 degC\"" =>
            r#"a.toml:2: this is not TOML: invalid basic string, expected `"`; correct the line (a quantity is text in quotes, as in temperature = "37 degC")"#,
        "[target]\nmaterial = \"skin\"\nmaterial = \"skin\"" =>
            "a.toml:3: this is not TOML: duplicate key; write each key and each [table] once",
        "[target]\nmaterial = \"skin\"\ntemprature = \"37 degC\"" =>
            "a.toml:3: target: there is no key `temprature`; the nearest are `temperature`, `extrapolate`",
        "[[target]]\nmaterial = \"skin\"" =>
            "a.toml:1: target: a list was found; write the table as [target], once",
        "[target]\nmaterial = \"skin\"\ntemperature = 37" =>
            r#"a.toml:3: target.temperature: `37` is a number without a unit; write "37 degC" or "310.15 K""#,
        "[target]\nmaterial = \"skin\"\ntemperature = \"37\"" =>
            r#"a.toml:3: target.temperature: `37` is a number without a unit; write "37 degC" or "310.15 K""#,
        "[target]\nmaterial = \"skin\"\ntemperature = \"37 m\"" =>
            r#"a.toml:3: target.temperature: `m` is not a unit of temperature; write "37 degC" or "310.15 K""#,
        "[target]\nmaterial = \"skin\"\ntemperature = \"-300 degC\"" =>
            "a.toml:3: target.temperature: `-300 degC` is out of range; it must be above 0 K (-273.15 degC)",
        "[target]\nmaterial = \"skin\"\ntemperature = \"0 K\"" =>
            "a.toml:3: target.temperature: `0 K` is out of range; it must be above 0 K (-273.15 degC)",
        "[target]\nmaterial = \"skin\"\ntemperature = true" =>
            "a.toml:3: target.temperature: the value true was found; write a number and its unit in quotes",
        "[target]\nmaterial = \"skin\"\ntemperature = [\"37 degC\"]" =>
            "a.toml:3: target.temperature: a list was found; write a number and its unit in quotes",
        "[target]\nmaterial = \"skin\"\ntemperature = \"nan K\"" =>
            r#"a.toml:3: target.temperature: `nan K` does not begin with a number; write "37 degC" or "310.15 K""#,
        "[target]\nmaterial = 5" =>
            r#"a.toml:2: target.material: the number 5 was found; write text in quotes, e.g. material = "skin""#,
        "[target]\nmaterial = \"\"" =>
            r#"a.toml:2: target.material: the text is empty; write for example material = "skin""#,
        "[target]\nmaterial = \"a\\nb\"" =>
            "a.toml:2: target.material: the text contains a line break or control character; write it on one line",
        "[target\nmaterial = \"skin\"" =>
            r#"a.toml:1: this is not TOML: unclosed table, expected `]`; correct the line (a quantity is text in quotes, as in temperature = "37 degC")"#,
    }
}

#[test]
fn a_key_that_is_not_known_or_out_of_range_is_named() {
    messages! { message:
        r#"distance = "-3 m""# =>
            "a.toml:4: target.distance: `-3 m` is out of range; it must be above 0",
        r#"distance = "1e308 km""# =>
            "a.toml:4: target.distance: `1e308 km` is out of range; it must be a finite number",
        r#"extrapolate = "yes""# =>
            r#"a.toml:4: target.extrapolate: `yes` is not known here; write "hold" or "linear""#,
        "zzz = 1" =>
            "a.toml:4: target: there is no key `zzz`; what may stand here is `material`, `temperature`, `distance`, `size`, `pixels` or `extrapolate`",
        r#""a\nb" = 1"# =>
            r#"a.toml:4: target: there is no key `a\nb`; what may stand here is `material`, `temperature`, `distance`, `size`, `pixels` or `extrapolate`"#,
        "[targets]" =>
            "a.toml:4: there is no key `targets`; the nearest are `target`, `alternatives`",
        "title = 5" =>
            "a.toml:4: target: there is no key `title`; did you mean `size`?",
        "camera = 5" =>
            "a.toml:4: target: there is no key `camera`; did you mean `material`?",
    }
}

#[test]
fn the_environment_is_checked_object_by_object_and_as_a_sum() {
    messages! { message:
        "[environment]\ntemperature = \"20 degC\"\nlighting = 0.5" =>
            "a.toml:4: environment: a table was found; write [[environment]], in double brackets, once for each object",
        "[[environment]]\ntemperature = \"20 degC\"" =>
            "a.toml:4: environment[0].lighting: the key is missing; write lighting = 0.5",
        "[[environment]]\nlighting = 0.5" =>
            r#"a.toml:4: environment[0].temperature: the key is missing; write temperature = "20 degC""#,
        "[[environment]]\ntemperature = \"20 degC\"\nlighting = \"0.5\"" =>
            r#"a.toml:6: environment[0].lighting: the text "0.5" was found; write a plain number without quotes, e.g. lighting = 0.5"#,
        "[[environment]]\ntemperature = \"20 degC\"\nlighting = -0.5" =>
            "a.toml:6: environment[0].lighting: lighting is -0.5; it must be between 0 and 1",
        "[[environment]]\ntemperature = \"20 degC\"\nlighting = nan" =>
            "a.toml:6: environment[0].lighting: lighting is NaN; it must be between 0 and 1",
        "[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.7\n[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5" =>
            "a.toml:9: environment[1].lighting: the lighting factors add up to 1.2; lower them to a sum of at most 1, as they share one hemisphere",
        "[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\nemissivity = 0.9" =>
            "a.toml:7: environment[0]: there is no key `emissivity`; what may stand here is `temperature`, `lighting`, `material` or `extrapolate`",
        "[unknown]\nlighting_total = 0.5\n[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.7\n[[environment]]\ntemperature = \"20 degC\"" =>
            "a.toml:9: environment[1].lighting: the other lighting factors add up to 0.7, lighting_total is 0.5; lower them, or raise unknown.lighting_total",
        "[unknown]\nlighting_total = 1.0\n[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.7\n[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.1" =>
            "a.toml:11: environment[1].lighting: the others and lighting_total = 1 leave 0.3, not 0.1; leave this one out",
        "[unknown]\nlighting_total = 1.0" =>
            "a.toml:5: unknown.lighting_total: there is no [[environment]] whose lighting this could be; add one",
        "[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.1\n[[environment]]\ntemperature = \"0 K\"\nlighting = 0.1" =>
            "a.toml:8: environment[1].temperature: `0 K` is out of range; it must be above 0 K (-273.15 degC)",
    }
}

#[test]
fn unknowns_and_their_priors_fit_together() {
    messages! { message:
        "[unknown]\nnuisances = [\"temperature\", \"emissivity\"]" =>
            r#"a.toml:5: unknown.nuisances[1]: `emissivity` is not known here; write "temperature", "lighting", "gain" or "environment-temperature""#,
        "[unknown]\nnuisances = [\"temperature\", \"temperature\"]" =>
            "a.toml:5: unknown.nuisances[1]: the same is already in the list; name it once",
        "[unknown]\nnuisances = \"temperature\"" =>
            r#"a.toml:5: unknown.nuisances: the text "temperature" was found; write nuisances = ["temperature", "lighting"]"#,
        "[unknown]\npriors = { gain = 0.1 }" =>
            "a.toml:5: unknown.priors.gain: `gain` is not among unknown.nuisances; add it there, or remove its prior",
        "[unknown]\npriors = { temperature = \"0 K\" }" =>
            "a.toml:5: unknown.priors.temperature: `0 K` is out of range; it must be above 0 (what is known exactly is left out of unknown.nuisances)",
        "[unknown]\npriors = { lighting = \"0.1\" }" =>
            r#"a.toml:5: unknown.priors.lighting: the text "0.1" was found; write a plain number without quotes, e.g. lighting = 0.1"#,
        "[unknown]\npriors = { temperature = 2 }" =>
            r#"a.toml:5: unknown.priors.temperature: `2` is a number without a unit; write "50 mK" or "2 K""#,
        "[unknown.priors]\ntemperatur = \"2 K\"" =>
            "a.toml:5: unknown.priors: there is no key `temperatur`; the nearest are `temperature`, `environment-temperature`",
    }
}

#[test]
fn alternatives_are_named_once_and_ranges_go_upwards() {
    messages! { message:
        "[alternatives]\nmaterials = []" =>
            "a.toml:5: alternatives.materials: the list is empty; name some, or leave the key out to take every other material of the library",
        "[alternatives]\nmaterials = \"gold\"" =>
            r#"a.toml:5: alternatives.materials: the text "gold" was found; write materials = ["aluminium"]"#,
        "[alternatives]\nmaterials = [\"gold\", 3]" =>
            r#"a.toml:5: alternatives.materials[1]: the number 3 was found; write text in quotes, e.g. "skin""#,
        "[alternatives]\nmaterials = [\n  \"gold\",\n  \"gold\",\n]" =>
            "a.toml:7: alternatives.materials[1]: the same is already in the list; name it once",
        "[alternatives]\ntemperature = [\"120 degC\", \"0 degC\"]" =>
            r#"a.toml:5: alternatives.temperature: the range goes from 120 degC to 0 degC; write the lower end first: ["0 degC", "120 degC"]"#,
        "[alternatives]\ntemperature = [\"20 degC\", \"20 degC\"]" =>
            r#"a.toml:5: alternatives.temperature: the two ends of the range are the same; write two that differ, as in ["0 degC", "120 degC"]"#,
        "[alternatives]\nlighting = [0.9, 0.1]" =>
            "a.toml:5: alternatives.lighting: the range goes from 0.9 to 0.1; write the lower end first: [0.1, 0.9]",
        "[envelope]\ntemperature = [\"40 °C\", \"30 °C\"]" =>
            r#"a.toml:5: envelope.temperature: the range goes from 40 °C to 30 °C; write the lower end first: ["30 °C", "40 °C"]"#,
        "[alternatives]\ntemperature = [\"120 degC\"]" =>
            r#"a.toml:5: alternatives.temperature: a range has two ends, but the list has 1; write temperature = ["0 degC", "120 degC"]"#,
        "[alternatives]\ntemperature = [0, 120]" =>
            r#"a.toml:5: alternatives.temperature[0]: `0` is a number without a unit; write "37 degC" or "310.15 K""#,
        "[alternatives]\nlighting = [0.0, 1.5]" =>
            "a.toml:5: alternatives.lighting[1]: lighting is 1.5; it must be between 0 and 1",
        "[alternatives]\nlighting = 0.5" =>
            "a.toml:5: alternatives.lighting: the number 0.5 was found; write lighting = [0.0, 1.0]",
    }
}

#[test]
fn bands_have_one_source_and_one_axis() {
    messages! { message:
        "[bands]\nstart = 715" =>
            r#"a.toml:5: bands.start: `715` is a number without a unit; write "715 cm^-1""#,
        "[bands]\nstart = \"8 um\"" =>
            "a.toml:4: bands.stop: stop is silent, which means 1250 cm^-1, but another of the three is a wavelength; write start, stop and step all in cm^-1, or all in um or nm",
        "[bands]\nstart = \"8 um\"\nstop = \"14 um\"" =>
            "a.toml:4: bands.step: step is silent, which means 1 cm^-1, but another of the three is a wavelength; write start, stop and step all in cm^-1, or all in um or nm",
        "[bands]\nstart = \"1300 cm^-1\"" =>
            "a.toml:4: bands.stop: stop (1250 cm^-1) is not above start (1300 cm^-1); write the lower end as start",
        "[bands]\nstart = \"-1 cm^-1\"" =>
            "a.toml:5: bands.start: `-1 cm^-1` is out of range; it must be above 0",
        "[bands]\nstep = \"0 cm^-1\"" =>
            "a.toml:5: bands.step: `0 cm^-1` is out of range; it must be above 0",
        "[bands]\nstep = \"1000 cm^-1\"" =>
            r#"a.toml:5: bands.step: the step (1000 cm^-1) is larger than the range from start to stop; lower it, or write a single band as ranges = [["8 um", "14 um"]]"#,
        "[bands]\nstep = \"1e-4 cm^-1\"" =>
            "a.toml:5: bands.step: a step of 0.0001 cm^-1 makes more than a million bands; raise it",
        "[bands]\nfilters = \"f.csv\"\nstep = \"1 cm^-1\"" =>
            "a.toml:5: bands.filters: `step` is given as well; keep only one of the two",
        "[bands]\nfilters = \"f.csv\"\nrows = \"f.csv\"" =>
            "a.toml:6: bands.rows: `filters` is given as well; keep only one of the two",
        "[bands]\nfilters = 3" =>
            r#"a.toml:5: bands.filters: the number 3 was found; write text in quotes, e.g. filters = "my_data.csv""#,
        "[bands]\nranges = [\"715 cm^-1\", \"800 cm^-1\"]" =>
            r#"a.toml:5: bands.ranges[0]: the text "715 cm^-1" was found; write ["715 cm^-1", "800 cm^-1"]"#,
        "[bands]\nranges = [[\"800 cm^-1\", \"715 cm^-1\"]]" =>
            r#"a.toml:5: bands.ranges[0]: the range goes from 800 cm^-1 to 715 cm^-1; write the lower end first: ["715 cm^-1", "800 cm^-1"]"#,
        "[bands]\nranges = [[\"8 um\", \"8 um\"]]" =>
            r#"a.toml:5: bands.ranges[0]: the two ends of the range are the same; write two that differ, as in ["715 cm^-1", "800 cm^-1"]"#,
        "[bands]\nranges = [[\"715 cm^-1\", \"8 um\"]]" =>
            "a.toml:5: bands.ranges[0]: the range goes from 715 cm^-1 to 8 um; write both ends in cm^-1, or both in um or nm",
        "[bands]\nranges = []" =>
            r#"a.toml:5: bands.ranges: the list is empty; write ranges = [["715 cm^-1", "800 cm^-1"]]"#,
        "[bands]\nranges = [[\"715 cm^-1\"]]" =>
            r#"a.toml:5: bands.ranges[0]: a range has two ends, but the list has 1; write ["715 cm^-1", "800 cm^-1"]"#,
        "[bands]\nintegrate = \"true\"" =>
            r#"a.toml:5: bands.integrate: the text "true" was found; write integrate = true or integrate = false, without quotes"#,
        "[bands]\ntolerance = 0" =>
            "a.toml:5: bands.tolerance: tolerance is 0; it must be between 1e-14 and 0.1",
        "[bands]\nstart = \"8 um\"\nstop = \"14 um\"\nstep = \"1 cm^-1\"" =>
            "a.toml:7: bands.step: step is 1 cm^-1, but another of the three is a wavelength; write start, stop and step all in cm^-1, or all in um or nm",
        "[bands]\nfilters = \"\"" =>
            r#"a.toml:5: bands.filters: the text is empty; write for example filters = "my_data.csv""#,
    }
}

#[test]
fn the_air_is_of_one_kind_and_has_a_temperature() {
    messages! { message:
        "[atmosphere]\nmodel = \"tropical\"\ntable = \"air.csv\"" =>
            "a.toml:6: atmosphere.table: `model` is given as well; keep only one of the two",
        "[atmosphere]" =>
            r#"a.toml:4: atmosphere: neither model nor table is given; write model = "us-standard" or table = "my_path.csv""#,
        "[atmosphere]\ntable = \"air.csv\"" =>
            r#"a.toml:4: atmosphere.temperature: the key is missing, and a table of transmittances does not know it; write temperature = "15 degC", that of the air"#,
        "[atmosphere]\nmodel = \"tropical\"\ntemperature = 15" =>
            r#"a.toml:6: atmosphere.temperature: `15` is a number without a unit; write "37 degC" or "310.15 K""#,
        "[atmosphere]\nmodel = \"tropical\"\ntemperature = \"-300 degC\"" =>
            "a.toml:6: atmosphere.temperature: `-300 degC` is out of range; it must be above 0 K (-273.15 degC)",
        "[atmosphere]\nmodel = 6" =>
            r#"a.toml:5: atmosphere.model: the number 6 was found; write text in quotes, e.g. model = "us-standard""#,
        "[atmosphere]\nmodel = \"\"" =>
            r#"a.toml:5: atmosphere.model: the text is empty; write for example model = "us-standard""#,
        "[atmosphere]\ntable = \"air.csv /.\"\ntemperature = \"1 K\"" =>
            "a.toml:5: atmosphere.table: `air.csv /.` is a path that ends in a blank; rename the file",
        "[atmosphere]\nmodell = \"tropical\"" =>
            "a.toml:5: atmosphere: there is no key `modell`; did you mean `model`?",
        "[atmosphere]\nhumidity = 0.5" =>
            "a.toml:5: atmosphere: there is no key `humidity`; what may stand here is `model`, `table` or `temperature`",
        "atmosphere = \"tropical\"" =>
            "a.toml:4: target: there is no key `atmosphere`; the nearest are `temperature`, `material`",
        "[[atmosphere]]\nmodel = \"tropical\"" =>
            "a.toml:4: atmosphere: a list was found; write the table as [atmosphere], once",
    }
}

#[test]
fn a_camera_is_possible() {
    messages! { message:
        "[camera]\nexposure = \"0 s\"" =>
            "a.toml:5: camera.exposure: `0 s` is out of range; it must be above 0",
        "[camera]\nexposure = \"12 m\"" =>
            r#"a.toml:5: camera.exposure: `m` is not a unit of time; write "12 ms""#,
        "[camera]\nexposure = 0.012" =>
            r#"a.toml:5: camera.exposure: `0.012` is a number without a unit; write "12 ms""#,
        "[camera]\nf_number = 0.4" =>
            "a.toml:5: camera.f_number: f_number is 0.4; it must be at least 0.5, the fastest that a lens in air can be",
        "[camera]\nf_number = \"f/1.3\"" =>
            r#"a.toml:5: camera.f_number: the text "f/1.3" was found; write a plain number without quotes, e.g. f_number = 1.3"#,
        "[camera]\noptics_efficiency = 1.2" =>
            "a.toml:5: camera.optics_efficiency: optics_efficiency is 1.2; it must be above 0, at most 1",
        "[camera]\nnetd = \"50 mK\"\nnoise_electrons = 100" =>
            "a.toml:6: camera.noise_electrons: `netd` is given as well; keep only one of the two",
        "[camera]\nframes = 2.5" =>
            "a.toml:5: camera.frames: the number 2.5 was found; write a whole number from 1 to 4294967295, e.g. frames = 16",
        "[camera]\nframes = 0" =>
            "a.toml:5: camera.frames: the number 0 was found; write a whole number from 1 to 4294967295, e.g. frames = 16",
        "[camera]\nreadout = \"rolling\"" =>
            r#"a.toml:5: camera.readout: `rolling` is not known here; write "simultaneous", "sequential", "fourier-transform" or "dispersive""#,
        "[camera]\nreadout = 1" =>
            r#"a.toml:5: camera.readout: the number 1 was found; write "simultaneous", "sequential", "fourier-transform" or "dispersive""#,
        "[camera]\nfield_of_view = \"180 deg\"" =>
            "a.toml:5: camera.field_of_view: `180 deg` is out of range; it must be above 0 and below 180 deg",
        "[camera]\nfnumber = 1.3" =>
            "a.toml:5: camera: there is no key `fnumber`; the nearest are `f_number`, `frame_rate`, `frames`",
        "[camera]\ngain = 1.3" =>
            "a.toml:5: camera: there is no key `gain`; what may stand here is `preset`, `exposure`, `pixel`, `f_number`, `focal_length`, `optics_efficiency`, `quantum_efficiency`, `netd`, `netd_temperature`, `netd_f_number`, `netd_optics_efficiency`, `netd_pixel`, `detectivity`, `nep`, `nesr`, `noise_electrons`, `noise_table`, `noise_bandwidth`, `noise_ … _rate`, `sensor_temperature`, `filter_temperature`, `field_of_view`, `pixels` or `spectral_range`",
        "[camera]\nflicker_fraction = 1.1" =>
            "a.toml:5: camera.flicker_fraction: flicker_fraction is 1.1; it must be between 0 and 1",
        "[camera]\npreset = true" =>
            r#"a.toml:5: camera.preset: the value true was found; write text in quotes, e.g. preset = "flir-a325sc""#,
    }
}

#[test]
fn a_requirement_is_one_and_can_be_met() {
    messages! { message:
        "[requirement]\ndetection_probability = 0.9\ndistance = 1.0" =>
            "a.toml:6: requirement.distance: `detection_probability` is given as well; keep only one of the two",
        "[requirement]\ndetection_probability = 0.5" =>
            "a.toml:5: requirement.detection_probability: detection_probability is 0.5; it must be above 0.5 (tossing a coin) and below 1 (never wrong)",
        "[requirement]\ndetection_probability = 1" =>
            "a.toml:5: requirement.detection_probability: detection_probability is 1; it must be above 0.5 (tossing a coin) and below 1 (never wrong)",
        "[requirement]\ndistance = \"30 m\"" =>
            r#"a.toml:5: requirement.distance: the text "30 m" was found; write a plain number without quotes, e.g. distance = 1.0"#,
        "[requirement]\nby = \"nearst\"" =>
            r#"a.toml:5: requirement.by: `nearst` is not known here; write "nearest", "local" or "local-unknown-gain""#,
        "[requirement]\nspeed = 30" =>
            r#"a.toml:5: requirement.speed: `30` is a number without a unit; write "30 mph" or "13.4 m/s""#,
        "[requirement]\nspeed = 1979-05-27" =>
            "a.toml:5: requirement.speed: the date 1979-05-27 was found; write a number and its unit in quotes",
    }
}

#[test]
fn a_decimal_comma_is_named() {
    messages! { message:
        "[camera]\nexposure = \"12,5 ms\"" =>
            r#"a.toml:5: camera.exposure: `12,5 ms` has a decimal comma; write 12.5, as in "12.5 ms""#,
        "[camera]\nf_number = \"1,3\"" => "a.toml:5: camera.f_number: `1,3` has a decimal comma; write 1.3",
        "[camera]\nf_number = 1,3  # fast" => "a.toml:5: `1,3` has a decimal comma; write 1.3",
        "[bands]\nstart = \"7,5 um\"" =>
            r#"a.toml:5: bands.start: `7,5 um` has a decimal comma; write 7.5, as in "7.5 um""#,
        "[alternatives]\ntemperature = [\"0,5 degC\", \"20 degC\"]" =>
            r#"a.toml:5: alternatives.temperature[0]: `0,5 degC` has a decimal comma; write 0.5, as in "0.5 degC""#,
    }
}
