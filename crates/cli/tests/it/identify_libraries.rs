//! Five materials as in the paper, measured spectra and the authors' own tables, from the command line.

use crate::support::answers::{FIVE, by_alternative, example, identify, number, pairs, texts};
use crate::support::folder::Folder;
use hadar_testing::shared;
use serde_json::Value;
use std::fs;

/// Extended Data Fig. 6: at the photons of the example silica and paint are identifiable among the five, skin and
/// aluminium are not told apart.
#[test]
fn the_five_materials_fall_apart_as_in_the_paper() {
    let result = Folder::with("").json(&["identify", &example(), "--matrix"]);
    let photons = number(&result["photon_radiance"]);
    println!("{photons:.3e} photons s^-1 m^-2 sr^-1");
    let verdicts: Vec<(&str, bool)> = result["matrix"]["targets"]
        .as_array()
        .unwrap()
        .iter()
        .map(|verdict| (verdict["material"].as_str().unwrap(), verdict["identifiable"].as_bool().unwrap()))
        .collect();
    let expected =
        [("skin", false), ("aluminium", false), ("fused-silica", true), ("pmma", true), ("concrete", true)];
    assert_eq!(verdicts, expected);
    let not = pairs(&result["matrix"]["apart"]["not_told_apart"]);
    assert!(not.contains(&("aluminium".to_owned(), "skin".to_owned())), "{not:?}");
    assert_eq!(result["matrix"]["targets"][0]["limiting"], "aluminium");
}

/// The same with measured spectra (ECOSTRESS): a quartz glass, a paint and concrete as they come.
#[test]
fn measured_spectra_fall_apart_as_in_the_paper() {
    let Some(folder_of_spectra) = shared("ecostress") else { return };
    let file = |name: &str| format!("{:?}", folder_of_spectra.join(name).display().to_string());
    let materials = [
        "\"aluminium\"".to_owned(),
        file("mineral.silicate.tectosilicate.solid.tir.quartz_1.jhu.nicolet.spectrum.txt"),
        file("manmade.generalconstructionmaterial.paint.solid.all.0402uuupnt.jhu.becknic.spectrum.txt"),
        file("manmade.concrete.pavingconcrete.solid.all.0092uuu_cnc.jhu.becknic.spectrum.txt"),
    ];
    let scenario = fs::read_to_string(example()).unwrap().replace(
        "[\"aluminium\", \"fused-silica\", \"pmma\", \"concrete\"]",
        &format!("[{}]", materials.join(", ")),
    );
    let result = identify(&Folder::with(&scenario), &["--matrix"]);
    let matrix = &result["matrix"];
    let names = texts(&matrix["materials"]);
    for (i, name) in names.iter().enumerate() {
        println!(
            "{name}: d = {}, hardest {}",
            matrix["targets"][i]["statistical_distance_minimum"], matrix["targets"][i]["limiting"]
        );
    }
    let identifiable: Vec<bool> =
        matrix["targets"].as_array().unwrap().iter().map(|v| v["identifiable"].as_bool().unwrap()).collect();
    assert_eq!(identifiable[..4], [false, false, true, true], "{names:?}");
    assert!(pairs(&matrix["apart"]["not_told_apart"]).contains(&("aluminium".to_owned(), "skin".to_owned())));
}

/// A person among all of the authors' 54-channel table, through the command line: rows 5a–5d of
/// `../shared/reproduction.md`.
#[test]
fn the_authors_library_from_the_command_line() {
    let Some(table) = shared("hadar-library/emissivity_54.csv") else { return };
    let table = table.display().to_string();
    let scenario = "[target]\nmaterial = \"human\"\ntemperature = \"37 degC\"\nextrapolate = \"hold\"\n\
         [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n[alternatives]\nextrapolate = \"hold\"\n";
    let folder = Folder::with(scenario);
    let library = ["--library", &table, "--only-library"];
    let result = identify(&folder, &[&library[..], &["--matrix", "--by", "local-unknown-gain"]].concat());
    let of = |key: &str, other: &str| by_alternative(&result, key)[other].clone();
    // The digits that the recomputation prints; half of the last one is what each may be off by.
    for (what, value, printed, half) in [
        ("5a raw counts", number(&of("distance_local", "al")), 7.5e-4, 5e-6),
        ("5a S29", number(&of("distance_local_unknown_gain", "al")), 1.48e-4, 5e-7),
        ("5b photons by S29", number(&of("photons_required", "al")), 4.6e7, 5e5),
        ("5c glass", number(&of("distance_local", "crystal-glass")), 0.0484, 5e-5),
        ("5c glass S29", number(&of("distance_local_unknown_gain", "crystal-glass")), 0.039, 5e-4),
        ("5c glass nearest", number(&of("distance_nearest", "crystal-glass")), 0.052, 5e-4),
        ("5d degC", number(&of("nearest_state", "al")["temperature_k"]) - 273.15, 82.74, 5e-3),
        ("5d V", number(&of("nearest_state", "al")["lighting"][0]), 0.188, 5e-4),
    ] {
        println!("{what}: {value:e}");
        assert!((value - printed).abs() <= half, "{what}: {value:e}, not {printed:e}");
    }
    assert_eq!(result["pairs"].as_array().unwrap().len(), 26, "all but the person and the sky");
    assert_eq!(result["limiting"], "al");
    // The other way round stands in the matrix: 8.9e-4 (Notes, LIB49 hazard).
    let matrix = &result["matrix"];
    let names = texts(&matrix["materials"]);
    let at = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let back = number(&matrix["distance_local_unknown_gain"][at("al")][at("human")]);
    assert!((back - 8.9e-4).abs() <= 5e-6, "{back:e}");
}

/// Both tables of the authors at once: names that both define carry the file's, and those that end above the bands are
/// named or left out.
#[test]
fn materials_that_do_not_cover_the_bands_are_named_or_left_out() {
    let Some(tables) = shared("hadar-library") else { return };
    let library = ["--library", &tables.display().to_string(), "--only-library"].map(str::to_owned);
    let scenario = FIVE
        .replace("\"skin\"", "\"human@emissivity-54\"")
        .replace(
            "[alternatives]\nmaterials = [\"aluminium\", \"fused-silica\", \"pmma\", \"concrete\"]\n",
            "",
        )
        .replace("step = \"5 cm^-1\"", "start = \"720 cm^-1\"\nstep = \"10 cm^-1\"");
    let folder = Folder::with(&scenario);
    let library: Vec<&str> = library.iter().map(String::as_str).collect();
    let said = folder.refusal(&[&["identify", "a.toml", "--out", "report"], &library[..]].concat());
    assert!(
        said.contains("alternatives do not cover the bands (720 to 1250 cm^-1): ")
            && said.contains("al@emissivity-49"),
        "{said}"
    );
    assert!(said.contains("--skip-uncovered"), "{said}");
    let kept = identify(&folder, &[&library[..], &["--skip-uncovered"]].concat());
    let names = by_alternative(&kept, "distance_nearest");
    assert!(names.contains_key("al@emissivity-54") && !names.contains_key("al@emissivity-49"), "{names:?}");
    let skipped: Vec<&Value> =
        kept["warnings"].as_array().unwrap().iter().filter(|w| w["code"] == "material-skipped").collect();
    assert!(
        skipped.iter().any(|w| w["message"].as_str().unwrap().contains("al@emissivity-49")),
        "{skipped:?}"
    );
    assert!(names.len() >= 26);
    let ambiguous = Folder::with(&scenario.replace("human@emissivity-54", "human"));
    let said = ambiguous.refusal(&[&["identify", "a.toml"], &library[..]].concat());
    assert!(said.contains("write one of `human@emissivity-49`, `human@emissivity-54`"), "{said}");
}
