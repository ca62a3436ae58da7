//! The table of keys and the readers are one: every key of the table is read as its row says, and refused otherwise.

use hadar::error::Result;
use hadar_scenario::calibrate::{BlackbodyScenario, NoiseScenario, ResponseScenario, StripesScenario};
use hadar_scenario::cameras::StatedCameras;
use hadar_scenario::keys::{FILES, Key, Silent, Table, Value};
use hadar_scenario::{
    AirRangingScenario, DecomposeScenario, LibraryScenario, RangeScenario, RenderScenario, Rule, Scenario,
    Setting, Written,
};

const TASK: &str = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n\
    [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n[class.x]\nmaterials = [\"skin\"]\n";
const RULE: &str = "[[camera]]\npreset = \"flir-a325sc\"\nname = \"ours\"\n[[clause]]\nname = \"a\"\n\
    [[clause.environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
    [[test]]\ncamera = \"ours\"\nverdict = \"fails\"\n\
    [[reform]]\nname = \"b\"\nset = [\"target.temperature = 36 degC\"]\nchoice = \"why\"\n\
    [[grid]]\nname = \"g\"\nspeed_step = \"5 km/h\"\n\
    [[source]]\nkeys = [\"target\", \"environment\", \"class\", \"clause\", \"category\", \"grid\"]\nchoice = \"why\"\n";
const CAMERA: &str = "[camera]\npreset = \"flir-a325sc\"\n";
const STREET: &str = "[scene]\nsky = { material = \"skin\", temperature = \"288 K\" }\n\
    ground = { material = \"skin\", temperature = \"12 degC\" }\n\
    [[object]]\nshape = \"car\"\nmaterial = \"skin\"\ntemperature = \"33 degC\"\nat = [\"0 m\", \"8 m\"]\n\
    [[category]]\nname = \"a\"\nmaterials = [\"skin\"]\nsurfaces = [\"car\"]\n";
const VIEWS: &str = "[cube]\nleft = \"a.npy\"\n[stereo]\nbaseline = \"0.2 m\"\n";
const STEREO: &str = "[stereo]\nbaseline = \"0.2 m\"\n";
const CUBE: &str = "[cube]\ndata = \"a.npy\"\nunit = \"W m^-2 sr^-1 per cm^-1\"\nnoise = 1e-4\n\
    [[environment]]\ntemperature = \"20 degC\"\n";
const LIBRARY: &str = "[library]\nmaterials = [\"skin\"]\n[class.x]\nmaterials = [\"skin\"]\n\
    [[category]]\nname = \"a\"\nmaterials = [\"skin\"]\n";
const BLACKBODIES: &str = "[[blackbody]]\ntemperature = \"10 degC\"\ndata = \"a.npy\"\n\
    [[blackbody]]\ntemperature = \"60 degC\"\ndata = \"b.npy\"\n[noise]\nsample = 1.5\n";

const FIND: &str = "[[find.lenses]]\nf_number = 1.0\nfocal_length = \"14 mm\"\n";
const CATEGORY: &str = "[[category]]\nname = \"person\"\nmaterials = [\"skin\"]\n";

/// A file of a kind in which any key may be set.
fn base(kind: &str) -> String {
    match kind {
        "task" => format!("{TASK}{CATEGORY}{FIND}"),
        "rule" => format!("{TASK}{RULE}{CATEGORY}{FIND}"),
        "stereo" => format!("{VIEWS}{CAMERA}"),
        "scene" => format!("{STREET}{CAMERA}"),
        "air" => {
            let target = TASK
                .replace("[class.x]\nmaterials = [\"skin\"]\n", "")
                .replace("37 degC\"", "37 degC\"\ndistance = \"50 m\"");
            format!("signal = \"air\"\n{target}[atmosphere]\nmodel = \"us-standard\"\n{CAMERA}")
        }
        "cube" => format!("{CUBE}{LIBRARY}"),
        "library" => format!("{CUBE}[clusters]\ncount = 6\n"),
        "response" => format!("[response]\nfilters = \"f.csv\"\n{BLACKBODIES}"),
        "blackbodies" => format!("[bands]\nstep = \"5 cm^-1\"\n{BLACKBODIES}"),
        "noise" => "[cube]\ndata = \"a.npy\"\n[noise]\n".to_owned(),
        "stripes" => "[cube]\ndata = \"a.npy\"\n[stripes]\n".to_owned(),
        "cameras" => "[[camera]]\nname = \"ours\"\n".to_owned(),
        other => panic!("a kind of file without a base: {other}"),
    }
}

/// Reads a file, and writes it with every default filled in.
fn read(kind: &str, written: &Written) -> Result<String> {
    Ok(match kind {
        "task" => Scenario::from_written(written)?.to_toml(),
        "rule" => Rule::from_written(written)?.to_toml(),
        "stereo" => RangeScenario::from_written(written)?.to_toml(),
        "scene" => RenderScenario::from_written(written)?.to_toml(),
        "air" => AirRangingScenario::from_written(written)?.to_toml(),
        "cube" => DecomposeScenario::from_written(written)?.to_toml(),
        "library" => LibraryScenario::from_written(written)?.to_toml(),
        "response" => ResponseScenario::from_written(written)?.to_toml(),
        "blackbodies" => BlackbodyScenario::from_written(written)?.to_toml(),
        "noise" => NoiseScenario::from_written(written)?.to_toml(),
        "cameras" => {
            StatedCameras::from_written(written)?;
            String::new()
        }
        _ => StripesScenario::from_written(written)?.to_toml(),
    })
}

/// Keys that are read beside another one alone, each with that.
const BESIDE: [(&str, &str, &str); 15] = [
    ("environment[0].column", "environment[0]", "{ spectrum = \"a.csv\" }"),
    ("scene.sky.column", "scene.sky", "{ spectrum = \"a.csv\" }"),
    ("object[0].height", "object[0].shape", "\"person\""),
    ("object[0].radius", "object[0].shape", "\"post\""),
    ("object[0].above", "object[0].shape", "\"ball\""),
    ("clause[0].scene", "clause[0].kind", "\"depth-error\""),
    ("clause[0].stereo", "clause[0].kind", "\"depth-error\""),
    ("clause[0].scene", "clause[0].requirement", "{ depth_error = \"1 m\" }"),
    ("clause[0].stereo", "clause[0].requirement", "{ depth_error = \"1 m\" }"),
    ("object[0].radius", "object[0].height", "\"3 m\""),
    ("object[0].above", "object[0].size", "[\"1 m\", \"1 m\", \"1 m\"]"),
    ("distances.to", "distances.from", "\"10 m\""),
    ("distances.points", "distances.from", "\"10 m\""),
    ("distances.points", "distances.to", "\"200 m\""),
    ("clause[0].scene.sky.column", "clause[0].scene.sky", "{ spectrum = \"a.csv\" }"),
];
/// Keys of the other one of two commands that one file serves.
const OF_ANOTHER: [&str; 3] = ["stereo category", "stereo object", "scene requirement"];

fn set(key: &str, value: &str) -> Setting {
    Setting { key: key.into(), value: value.into(), by: "--set" }
}

/// What must be there for a key to be read: the other keys of its tables that must be, where the file has none of them.
fn needed(root: &Table, path: &str, base: &toml::Table) -> Vec<Setting> {
    let mut found: Vec<Setting> = Vec::new();
    let (mut table, mut above, mut whole) = (Some(root), String::new(), path);
    while let (Some(of), Some((first, rest))) = (table, whole.split_once('.')) {
        let name = first.split('[').next().unwrap();
        let value = of.value(name).unwrap();
        above = format!("{above}{first}.");
        let (inner, rest) = match value {
            Value::Named(_) => {
                (value.table(), rest.split_once('.').map(|(class, rest)| (format!("{class}."), rest)))
            }
            _ => (value.table(), Some((String::new(), rest))),
        };
        let Some((class, rest)) = rest else { break };
        above.push_str(&class);
        for key in inner.unwrap().keys().filter(|key| key.silent == Silent::Refused) {
            let full = format!("{above}{}", key.name);
            if at(base, &full).is_none() && full != path && key.value.table().is_none() {
                found.push(set(&full, key.example.split(" or ").next().unwrap()));
            }
        }
        (table, whole) = (inner, rest);
    }
    found
}

/// All keys of a file by their paths, with places in lists.
fn paths(table: &Table, above: &str, found: &mut Vec<(String, Key)>) {
    for key in table.keys() {
        let path = if above.is_empty() { key.name.to_owned() } else { format!("{above}.{}", key.name) };
        found.push((path.clone(), key));
        match key.value {
            Value::Table(table) => paths(table, &path, found),
            Value::Tables(table) => paths(table, &format!("{path}[0]"), found),
            Value::Named(table) => paths(table, &format!("{path}.x"), found),
            _ => {}
        }
    }
}

#[test]
fn every_key_is_read_as_its_row_says() {
    let mut read_as_told = 0;
    let mut amiss = Vec::new();
    for kind in FILES {
        let mut all = Vec::new();
        paths(kind.root, "", &mut all);
        for (path, Key { value, example, .. }) in all {
            let of_street =
                kind.name == "stereo" && (path.starts_with("scene") || path.starts_with("object"));
            let text = if of_street { format!("{STREET}{STEREO}{CAMERA}") } else { base(kind.name) };
            let base = Written::of(&text, None);
            assert_eq!(read(kind.name, &base).err().map(|error| error.to_string()), None, "{}", kind.name);
            let beside = BESIDE.iter().filter(|(key, ..)| {
                path.starts_with(key) || (path.ends_with(key) && !path.starts_with("clause"))
            });
            let mut settings: Vec<Setting> = beside.map(|(_, key, value)| set(key, value)).collect();
            settings.extend(needed(kind.root, &path, &text.parse().unwrap()));
            let read = |value: &str| read(kind.name, &base.with(settings.clone()).with([set(&path, value)]));
            if value.table().is_none()
                && let Err(error) = read(example)
                && error.to_string().contains("report this as a bug")
            {
                amiss.push(format!("{} {path} = {example}: {error}", kind.name));
            }
            let is_flag = |value: &Value| matches!(value, Value::Flag);
            let may_be_flag =
                is_flag(&value) || matches!(value, Value::Either(all) if all.iter().any(is_flag));
            let wrong = if may_be_flag { "\"yes\"" } else { "true" };
            let name = path.rsplit('.').next().unwrap_or(&path);
            let own = format!("{} {path}", kind.name);
            match read(wrong) {
                Err(error) if error.to_string().contains(name) && !error.to_string().contains("a bug") => {
                    read_as_told += 1;
                }
                _ if OF_ANOTHER.iter().any(|other| own.starts_with(other)) && !of_street => {}
                Err(error) => amiss.push(format!("{own} = {wrong}: {error}")),
                Ok(_) => amiss.push(format!("{own} is not read")),
            }
        }
    }
    assert!(amiss.is_empty(), "{}", amiss.join("\n"));
    assert!(read_as_told > 600, "{read_as_told}");
}

/// Values of every kind, most of them wrong at any one key.
const VALUES: [&str; 14] = [
    "true",
    "-1",
    "0.5",
    "7",
    "1e300",
    "[]",
    "{}",
    "\"\"",
    "\"5 kg\"",
    "\"30 degC\"",
    "\"2,5 m\"",
    "[\"1 m\", \"2 m\"]",
    "[0.1, 0.9]",
    "{ nothing = 1 }",
];

/// Figures that a noise of the file's own is stated for: set over the file they leave that noise as it is, written into it they do not.
const OF_NOISE: [&str; 5] = ["exposure", "frame_rate", "f_number", "optics_efficiency", "pixel"];

/// A message without its place, which says what was set instead of a line.
fn told(error: hadar::error::Error) -> String {
    match error {
        hadar::error::Error::At { source, .. } => source.to_string(),
        other => other.to_string(),
    }
}

/// The same is read, or the same message given, whether a text is parsed once or for every reading, and whether a value is set or
/// written into it: for every key of every file, its example, values of every kind, and a second key that is set beside it.
#[test]
fn a_value_that_is_set_in_a_parsed_text_is_read_as_in_one_that_is_written() {
    let mut draw = 1_u64;
    let mut any = move |below: usize| {
        draw = draw.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (draw >> 33) as usize % below
    };
    let (mut read_alike, mut refused_alike, mut written_alike) = (0, 0, 0);
    for kind in FILES {
        let text = base(kind.name);
        let (anew, once) = (Written::of(&text, None), Written::of(&text, None).parsed());
        let table: toml::Table = text.parse().unwrap();
        let mut all = Vec::new();
        paths(kind.root, "", &mut all);
        for (path, key) in &all {
            let example = key.example.split(" or ").next().unwrap();
            let beside = needed(kind.root, path, &table);
            for value in VALUES.into_iter().chain([example]) {
                let mut settings = beside.clone();
                settings.push(set(path, value));
                let alone = settings.clone();
                if any(3) == 0 {
                    let other = &all[any(all.len())];
                    settings.insert(any(settings.len()), set(&other.0, VALUES[any(VALUES.len())]));
                }
                let own = format!("{} {settings:?}", kind.name);
                let of = |file: &Written| {
                    read(kind.name, &file.with(settings.clone())).map_err(|error| error.to_string())
                };
                let found = of(&once);
                assert_eq!(found, of(&anew), "{own}");
                match found {
                    Ok(_) => read_alike += 1,
                    Err(_) => refused_alike += 1,
                }
                // A rule wants a source of every figure that is written into it.
                let moved = kind.name == "rule"
                    || path.starts_with("camera") && OF_NOISE.iter().any(|figure| path.ends_with(figure));
                let Some(file) = written(&table, &alone).filter(|_| !moved) else { continue };
                let set = read(kind.name, &once.with(alone.clone())).map_err(told);
                let in_file = read(kind.name, &Written::of(&file, None)).map_err(told);
                assert_eq!(set, in_file, "{own}\n{file}");
                written_alike += 1;
            }
        }
    }
    let counts = [read_alike, refused_alike, written_alike];
    assert!(counts.iter().all(|count| *count > 1000), "{counts:?}");
}

/// The text of a file with values in their places; none where it has no place for them.
fn written(table: &toml::Table, settings: &[Setting]) -> Option<String> {
    fn put(table: &mut toml::Table, path: &str, value: toml::Value) -> Option<()> {
        let Some((first, rest)) = path.split_once('.') else {
            table.insert(path.to_owned(), value);
            return Some(());
        };
        let inner = match first.strip_suffix("[0]") {
            Some(list) => table.get_mut(list)?.as_array_mut()?.first_mut()?,
            None => table.entry(first).or_insert_with(|| toml::Table::new().into()),
        };
        put(inner.as_table_mut()?, rest, value)
    }
    let mut table = table.clone();
    for setting in settings {
        let value: toml::Table = format!("value = {}", setting.value).parse().ok()?;
        let value = value.get("value")?.clone();
        // A number of other digits is another one in a message.
        if value.to_string() != setting.value {
            return None;
        }
        put(&mut table, &setting.key, value)?;
    }
    toml::to_string(&table).ok()
}

/// The value at a path, places in lists included.
fn at<'t>(table: &'t toml::Table, path: &str) -> Option<&'t toml::Value> {
    let (first, rest) = path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)));
    let value = match first.strip_suffix("[0]") {
        Some(list) => table.get(list)?.as_array()?.first()?,
        None => table.get(first)?,
    };
    match rest {
        Some(rest) => at(value.as_table()?, rest),
        None => Some(value),
    }
}

/// Whether two values are the same, in whatever unit.
fn same(value: Value, a: &toml::Value, b: &toml::Value) -> bool {
    let number = |value: &toml::Value| value.as_float().or(value.as_integer().map(|whole| whole as f64));
    match (a, b, value) {
        (toml::Value::Array(a), toml::Value::Array(b), Value::Pair(of) | Value::List(of)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(*of, a, b))
        }
        (toml::Value::String(a), toml::Value::String(b), Value::Quantity(dimension, _)) => {
            (dimension.parse(a).unwrap() - dimension.parse(b).unwrap()).abs() < 1e-9
        }
        _ => a == b || number(a).is_some_and(|number_a| number(b) == Some(number_a)),
    }
}

/// Takes a key out of a file.
fn without(table: &toml::Table, path: &str) -> Option<toml::Table> {
    fn take(table: &mut toml::Table, path: &str) -> Option<()> {
        let Some((first, rest)) = path.split_once('.') else { return table.remove(path).map(drop) };
        let value = match first.strip_suffix("[0]") {
            Some(list) => table.get_mut(list)?.as_array_mut()?.first_mut()?,
            None => table.get_mut(first)?,
        };
        take(value.as_table_mut()?, rest)
    }
    let mut less = table.clone();
    take(&mut less, path).map(|()| less)
}

#[test]
fn what_must_be_there_is_missed_and_nothing_else() {
    let (mut missed, mut amiss) = (0, Vec::new());
    for kind in FILES {
        let text: toml::Table = base(kind.name).parse().unwrap();
        let mut all = Vec::new();
        paths(kind.root, "", &mut all);
        for (path, key) in all {
            let Some(less) = without(&text, &path) else { continue };
            let told = key.silent == Silent::Refused;
            let hangs_on_more = matches!(key.silent, Silent::Means(words) if words.contains("must be there"));
            match read(kind.name, &Written::of(&less.to_string(), None)).map_err(|error| error.to_string()) {
                Ok(_) if told => amiss.push(format!("{} {path} need not be there", kind.name)),
                Err(error) if error.contains("missing") && error.contains(&format!("{path}: ")) => {
                    missed += 1;
                    if !told && !hangs_on_more {
                        amiss.push(format!("{} {path} is missed: {error}", kind.name));
                    }
                }
                _ => {}
            }
        }
    }
    assert!(amiss.is_empty(), "{}", amiss.join("\n"));
    assert!(missed > 30, "{missed}");
}

#[test]
fn what_silence_means_is_what_is_filled_in() {
    let mut compared = Vec::new();
    for kind in FILES {
        let text = base(kind.name);
        let plain: toml::Table = text.parse().unwrap();
        let base = Written::of(&text, None);
        let mut all = Vec::new();
        paths(kind.root, "", &mut all);
        let tables =
            all.iter().filter(|(path, key)| matches!(key.value, Value::Table(_)) && !path.contains('.'));
        let files = tables
            .filter(|(path, _)| at(&plain, path).is_none())
            .map(|(path, _)| base.with([set(path, "{}")]));
        for file in std::iter::once(base.clone()).chain(files.collect::<Vec<_>>()) {
            let Ok(written) = read(kind.name, &file) else { continue };
            let written: toml::Table = written.parse().unwrap();
            for (path, key) in &all {
                if let Silent::Is(value) = key.silent
                    && at(&plain, path).is_none()
                    && let Some(found) = at(&written, path)
                {
                    let told: toml::Table = format!("value = {value}").parse().unwrap();
                    assert!(
                        same(key.value, &told["value"], found),
                        "{} {path}: told {value}, filled in {found}",
                        kind.name
                    );
                    compared.push(format!("{} {path}", kind.name));
                }
            }
        }
    }
    compared.sort();
    compared.dedup();
    assert!(compared.len() > 40, "{compared:?}");
}
