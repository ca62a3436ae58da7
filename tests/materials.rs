//! The embedded library and the readers against independently computed and published spectra.

use hadar::material::{Basis, Library};
use std::path::{Path, PathBuf};

/// A file or directory beside the repository; `None`, with a printed line, in a clone without it.
fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared").join(name);
    if !path.exists() {
        println!("skipped: {} is not there", path.display());
        return None;
    }
    Some(path)
}

fn rows(path: &Path) -> Vec<(f64, f64)> {
    let text = std::fs::read_to_string(path).unwrap();
    let body = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    body.map(|line| line.split_once(',').unwrap())
        .map(|(x, e)| (x.parse().unwrap(), e.parse().unwrap()))
        .collect()
}

/// The oracle's names that are not simply its own in kebab-case.
fn embedded_name(oracle: &str) -> String {
    match oracle {
        "aluminium" => "aluminium-polished".into(),
        "aluminium_rough5" => "aluminium-rough".into(),
        "aluminium_anodised5um" => "aluminium-anodised".into(),
        "brass_rough6" => "brass-rough".into(),
        "steel_rough5" => "steel-rough".into(),
        "silicon_wafer_0p5mm" => "silicon-wafer".into(),
        "concrete_quartz_agg" => "concrete-quartz-aggregate".into(),
        other => other.replace('_', "-"),
    }
}

/// Tables printed with five decimals, computed in another language from the same constants: half a unit of
/// the last decimal, and 1e-9 for the rounding of a value that lies on the edge of it.
#[test]
fn every_material_agrees_with_its_independent_evaluation() {
    let Some(directory) = shared("spectra/emissivity") else { return };
    let library = Library::embedded().unwrap();
    let mut compared = 0;
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let oracle = path.file_stem().unwrap().to_str().unwrap();
        let material = library.get(&embedded_name(oracle)).unwrap();
        let mut worst = 0.0f64;
        for (wavenumber, expected) in rows(&path) {
            // the nitride's last row is at 700.0002 cm^-1, where the oracle holds it
            let asked = if oracle == "silicon_nitride" { wavenumber.max(700.001) } else { wavenumber };
            let emissivity = material.emissivity(&[asked]).unwrap()[0];
            worst = worst.max((emissivity - expected).abs());
        }
        assert!(worst <= 5e-6 + 1e-9, "{oracle}: {worst}");
        compared += 1;
    }
    assert_eq!(compared, 62);
    assert_eq!(library.iter().count(), 62 + 1 + 5, "the oracle's, the paper's robot and five skies");
}

#[test]
fn every_material_says_how_it_is_known() {
    let library = Library::embedded().unwrap();
    let grid: Vec<f64> = (701..=1350).map(f64::from).collect();
    for material in library.iter() {
        let provenance = material.provenance();
        for text in [&provenance.description, &provenance.category, &provenance.source, &provenance.licence] {
            assert!(!text.is_empty(), "{}: {provenance:?}", material.name());
        }
        assert_ne!(provenance.basis, Basis::UserFile, "{}", material.name());
        let emissivity = material.emissivity(&grid).unwrap();
        assert!(emissivity.iter().all(|e| (0.0..=1.0).contains(e)), "{}", material.name());
    }
}
