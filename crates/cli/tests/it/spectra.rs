//! `hadar materials` and `--library` with files of many layouts: what is read, as what, and what is passed over.

use crate::support::folder::Folder;
use serde_json::Value;
use std::fs;

const TABLE: &str = "wavelength (µm);Reflectance (%)\n8;10,5\n10;20\n12,5;30\n";
const BAD: &str = "wavenumber_cm1,emissivity\n700,0.5\n800,high\n";

fn messages(warnings: &Value) -> Vec<&str> {
    warnings.as_array().unwrap().iter().map(|warning| warning["message"].as_str().unwrap()).collect()
}

fn paint(sample: &str, percent: f64) -> String {
    format!(
        "Name: Black gloss paint\nSample No.: {sample}\nX Units: Wavelength (micrometers)\nY Units: Reflectance (percent)\n\n\
         7\t{percent}\n14\t{percent}\n"
    )
}

#[test]
fn a_file_is_shown_and_imported_as_what_it_was_read() {
    let folder = Folder::with("");
    folder.file("tile.csv", TABLE);
    let shown = folder.json(&["materials", "show", "tile.csv"]);
    let read_as = "wavelength in um, reflectance in percent, semicolons between columns, decimal commas";
    assert_eq!(shown["read_as"], read_as);
    let text = folder.run(&["materials", "show", "tile.csv"]).stdout;
    assert!(text.contains(&format!("read as    {read_as}")), "{text}");
    let imported = folder.run(&["materials", "import", "tile.csv", "--out", "mine"]);
    assert!(imported.stdout.contains(&format!("  read as {read_as}")), "{}", imported.stdout);
    let written = fs::read_to_string(folder.path().join("mine/tile.csv")).unwrap();
    assert!(written.contains("wavenumber_cm1,emissivity\n800,0.7\n1000,0.8\n1250,0.895\n"), "{written}");
    assert_eq!(folder.run(&["materials", "plot", "tile.csv", "skin", "--out", "drawn"]).code, 1);
    folder.file("wide.csv", "wavenumber_cm1,emissivity\n700,0.5\n1300,0.5\n");
    assert_eq!(folder.run(&["materials", "plot", "wide.csv", "skin", "--out", "drawn"]).code, 0);
    folder.file("two.csv", "wavenumber_cm1,roof,wall\n700,0.5,0.6\n1300,0.5,0.6\n");
    let said = folder.refusal(&["materials", "show", "two.csv"]);
    assert!(said.starts_with("two.csv: a table of 2 materials") && said.ends_with("roof, wall"), "{said}");
}

#[test]
fn a_file_without_header_is_told_its_columns() {
    let folder = Folder::with("");
    folder.file("bare.dpt", "700\t0.5\n1300\t0.6\n");
    let said = folder.refusal(&["materials", "import", "bare.dpt"]);
    assert!(said.contains("bare.dpt:1: there is no header"), "{said}");
    let flag = said.split("with ").nth(1).unwrap();
    assert_eq!(flag, "--columns wavenumber_cm1,emissivity");
    let arguments: Vec<&str> = flag.split(' ').collect();
    let imported =
        folder.json(&[&["materials", "import", "bare.dpt", "--out", "mine"], arguments.as_slice()].concat());
    assert_eq!(imported["materials"][0]["name"], "bare");
    assert!(folder.path().join("mine/bare.csv").is_file());
    let shown = folder.json(&["materials", "show", "bare.dpt", "--columns", "wavenumber_cm1,reflectance"]);
    assert_eq!(shown["emissivity"][0], 0.4975);
    folder.file("headed.csv", "wavenumber_cm1,emissivity\n700,0.5\n1300,0.6\n");
    let said =
        folder.refusal(&["materials", "import", "headed.csv", "--columns", "wavenumber_cm1,emissivity"]);
    assert!(said.contains("leave --columns out"), "{said}");
}

/// One rule for a file that is no spectrum: passed over with its reason, or all refused.
#[test]
fn a_bad_file_in_a_folder_is_passed_over_or_refused() {
    let folder = Folder::with("");
    fs::create_dir(folder.path().join("lab")).unwrap();
    folder.file("lab/tile.csv", TABLE);
    folder.file("lab/bad.csv", BAD);
    folder.file("lab/glass.txt", &paint("1", 5.0).replace("Reflectance", "Transmittance"));
    let reasons = [
        "passed over: lab/bad.csv:3: emissivity: `high`",
        "passed over: lab/glass.txt:4: y units: this is transmittance",
    ];
    let listed = folder.json(&["materials", "list", "--library", "lab", "--only-library"]);
    assert_eq!(listed["materials"].as_array().unwrap().len(), 1);
    let imported = folder.json(&["materials", "import", "lab", "--out", "mine"]);
    for said in [messages(&listed["library_warnings"]), messages(&imported["warnings"])] {
        assert_eq!(said.len(), 2);
        assert!(said.iter().zip(reasons).all(|(said, due)| said.starts_with(due)), "{said:?}");
    }
    let text = folder.run(&["materials", "list", "--library", "lab", "--only-library"]);
    assert!(text.stderr.contains(reasons[0]), "{}", text.stderr);
    let text = folder.run(&["materials", "import", "lab/tile.csv", "lab/bad.csv"]);
    assert!(text.code == 0 && text.stdout.contains(reasons[0]), "{}", text.stdout);
    for arguments in [
        &["materials", "list", "--library", "lab", "--strict"][..],
        &["materials", "import", "lab", "--strict"],
        &["materials", "import", "lab/bad.csv"],
    ] {
        let said = folder.refusal(arguments);
        assert!(said.starts_with("lab/bad.csv:3: emissivity: `high`"), "{said}");
    }
    fs::remove_file(folder.path().join("lab/tile.csv")).unwrap();
    for arguments in [&["materials", "list", "--library", "lab"][..], &["materials", "import", "lab"]] {
        let said = folder.refusal(arguments);
        assert!(said.contains("none of") && said.contains("2 files is a spectrum: lab/bad.csv:3"), "{said}");
    }
}

#[test]
fn samples_of_one_name_are_imported_under_names_of_their_own() {
    let folder = Folder::with("");
    folder.file("manmade.paint.solid.0402.spectrum.txt", &paint("0402UUUPNT", 5.0));
    folder.file("manmade.paint.solid.0403.spectrum.txt", &paint("0403UUUPNT", 10.0));
    folder.file("again.txt", &paint("0405UUUPNT", 20.0));
    let (a, b) = ("manmade.paint.solid.0402.spectrum.txt", "manmade.paint.solid.0403.spectrum.txt");
    let names = |answer: &Value| -> Vec<String> {
        answer["materials"]
            .as_array()
            .unwrap()
            .iter()
            .map(|one| one["name"].as_str().unwrap().to_owned())
            .collect()
    };
    let expected = ["black-gloss-paint@0402uuupnt", "black-gloss-paint@0403uuupnt"];
    assert_eq!(names(&folder.json(&["materials", "import", a, b, "--out", "mine"])), expected);
    let mut other_way = names(&folder.json(&["materials", "import", b, a]));
    other_way.reverse();
    assert_eq!(other_way, expected);
    // Alone it has its own name; another file of that name stands beside it, the same one in its place.
    assert_eq!(names(&folder.json(&["materials", "import", a, "--out", "grown"])), ["black-gloss-paint"]);
    assert_eq!(
        names(&folder.json(&["materials", "import", "again.txt", "--out", "grown"])),
        ["black-gloss-paint@0405uuupnt"]
    );
    assert_eq!(names(&folder.json(&["materials", "import", a, "--out", "grown"])), ["black-gloss-paint"]);
    let first = fs::read_to_string(folder.path().join("grown/black-gloss-paint.csv")).unwrap();
    assert!(first.contains(",0.95\n"), "{first}");
    let listed = folder.json(&["materials", "list", "--library", "grown", "--only-library"]);
    assert_eq!(names(&listed), ["black-gloss-paint", "black-gloss-paint@0405uuupnt"]);
}

/// Where nothing is taken, for whatever reason, it is an error that says why.
#[test]
fn an_import_of_nothing_is_an_error() {
    let folder = Folder::with("");
    for name in ["empty", "other", "lab"] {
        fs::create_dir(folder.path().join(name)).unwrap();
    }
    folder.file("other/notes.md", "no spectrum");
    let said = folder.refusal(&["materials", "import", "empty", "other"]);
    assert!(
        said.starts_with("there is no file of spectra in empty, other; ") && said.contains(".csv, .txt"),
        "{said}"
    );
    // They can be read, but what they hold cannot be written.
    folder.file("lab/a.txt", &paint("1", -5.0));
    folder.file("lab/b.txt", &paint("2", 105.0));
    let said = folder.refusal(&["materials", "import", "lab", "--out", "mine"]);
    assert!(
        said.contains("none of 2 files is a spectrum: lab/a.txt: ") && said.ends_with("lab/b.txt"),
        "{said}"
    );
}

/// Files of one name but for their endings or folders are all there, under names of their own.
#[test]
fn names_that_clash_are_told_apart() {
    let folder = Folder::with("");
    for name in ["lab", "lab2"] {
        fs::create_dir(folder.path().join(name)).unwrap();
    }
    let table = |e: f64| format!("wavenumber_cm1,emissivity\n700,{e}\n1300,{e}\n");
    folder.file("lab/a.csv", &table(0.1));
    folder.file("lab/a.txt", &table(0.2));
    folder.file("lab2/a.csv", &table(0.3));
    let names = |answer: &Value| -> Vec<String> {
        let materials = answer["materials"].as_array().unwrap().iter();
        materials.map(|one| one["name"].as_str().unwrap().to_owned()).collect()
    };
    for strict in [&[][..], &["--strict"]] {
        let listed =
            folder.json(&[&["materials", "list", "--library", "lab", "--only-library"], strict].concat());
        assert_eq!(names(&listed), ["a@csv", "a@txt"]);
        let imported = folder.json(&[&["materials", "import", "lab", "lab/a.csv"], strict].concat());
        assert_eq!(names(&imported), ["a@csv", "a@txt"]);
    }
    // One by one into the same folder, none replaces another.
    for (file, name) in
        [("lab/a.csv", "a"), ("lab/a.txt", "a@a"), ("lab2/a.csv", "a@a-2"), ("lab/a.txt", "a@a")]
    {
        assert_eq!(names(&folder.json(&["materials", "import", file, "--out", "mine"])), [name], "{file}");
    }
    assert_eq!(
        fs::read_dir(folder.path().join("mine"))
            .unwrap()
            .filter(|file| { file.as_ref().unwrap().file_name().to_string_lossy().ends_with(".csv") })
            .count(),
        3
    );
}

/// What is to be known of a spectrum stays with what is imported of it.
#[test]
fn an_import_keeps_the_warnings() {
    let folder = Folder::with("");
    let rows: String = (0..80)
        .map(|i| {
            format!(
                "{},{}\n",
                700 + 8 * i,
                if i == 9 { "nan".into() } else { format!("{}", 0.9 + 0.002 * f64::from(i % 3)) }
            )
        })
        .collect();
    folder.file("noisy.csv", &format!("wavenumber_cm1,emissivity\n{}", rows));
    folder.json(&["materials", "import", "noisy.csv", "--clip", "0", "--out", "lib"]);
    let text = std::fs::read_to_string(folder.path().join("lib/noisy.csv")).unwrap();
    assert!(text.contains("# warning: 1 row without a number left out"), "{text}");
    let shown = folder.json(&["materials", "show", "noisy", "--library", "lib"]);
    assert!(shown.to_string().contains("1 row without a number left out"), "{shown}");
}
