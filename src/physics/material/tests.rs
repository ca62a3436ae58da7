use super::*;
use proptest::prelude::*;

fn sloped() -> Material {
    Material::from_table("slope", &[(800.0, 0.5), (900.0, 0.6), (1000.0, 0.9)]).unwrap()
}

#[test]
fn a_grey_body_is_known_everywhere() {
    let skin = Material::constant("skin", 0.95).unwrap();
    assert_eq!(skin.emissivity(&[1e-3, 1000.0, 1e6]).unwrap(), [0.95; 3]);
    assert_eq!(skin.range_cm1(), None);
    assert_eq!(skin.provenance().basis.to_string(), "constant");
    assert!(skin.emissivity(&[0.0]).is_err());
    assert!(skin.emissivity(&[f64::NAN]).is_err());
    assert!(Material::constant("x", 1.000_001).is_err());
    assert!(Material::constant("x", f64::NAN).is_err());
}

#[test]
fn outside_its_rows_a_table_needs_a_rule() {
    let table = sloped();
    let error = table.emissivity(&[850.0, 790.0]).unwrap_err();
    assert_eq!(
        error,
        Error::OutsideSpectrum { name: "slope".into(), known_min: 800.0, known_max: 1000.0, needed: 790.0 }
    );
    let held = table.clone().with_extrapolation(Extrapolation::Hold);
    assert_eq!(held.emissivity(&[1.0, 2000.0]).unwrap(), [0.5, 0.9]);
    let linear = table.with_extrapolation(Extrapolation::Linear);
    let emissivity = linear.emissivity(&[790.0, 1030.0]).unwrap();
    assert!((emissivity[0] - 0.49).abs() < 1e-14 && (emissivity[1] - 0.99).abs() < 1e-14, "{emissivity:?}");
    let message = linear.emissivity(&[1040.0]).unwrap_err().to_string();
    assert!(message.contains("`slope` at 1040 cm^-1 is 1.02"), "{message}");
    assert!(linear.emissivity(&[200.0]).is_err(), "below 0");
}

#[test]
fn a_formula_with_a_range_is_extrapolated_along_its_tangent() {
    let library = Library::embedded().unwrap();
    let robot = library.get("aluminium").unwrap().clone().with_extrapolation(Extrapolation::Linear);
    let t = |wavenumber: f64| (wavenumber - 985.0) / 265.0;
    let value = |t: f64| 0.49287 - 0.0782 * t + 0.00892 * t * t;
    assert!((robot.emissivity(&[1000.0]).unwrap()[0] - value(t(1000.0))).abs() < 1e-15);
    let tangent = (-0.0782 + 2.0 * 0.00892 * t(1362.0)) / 265.0;
    let expected = value(t(1362.0)) + tangent * 38.0;
    // the slope is that of a chord of 1 cm^-1: off by half the second derivative, 1.3e-7 per cm^-1
    assert!((robot.emissivity(&[1400.0]).unwrap()[0] - expected).abs() < 38.0 * 1.5e-7);
}

#[test]
fn kinks_are_listed_between_the_limits() {
    assert_eq!(sloped().breakpoints_cm1(800.0, 1000.0), [900.0]);
    assert_eq!(sloped().breakpoints_cm1(0.0, 2000.0), [800.0, 900.0, 1000.0]);
    assert!(Material::constant("x", 0.5).unwrap().breakpoints_cm1(0.0, 1e4).is_empty());
}

#[test]
fn materials_can_be_shared_between_threads() {
    fn shared<T: Send + Sync + Clone + std::fmt::Debug>() {}
    shared::<Material>();
    shared::<Library>();
}

proptest! {
    #[test]
    fn emissivity_lies_between_its_neighbouring_rows(
        rows in prop::collection::btree_map(500u32..1500, 0.0..=1.0f64, 2..30),
        asked in 500.0..1500.0f64,
    ) {
        let rows: Vec<(f64, f64)> = rows.into_iter().map(|(x, e)| (f64::from(x), e)).collect();
        let material = Material::from_table("x", &rows).unwrap();
        if let Ok(emissivity) = material.emissivity(&[asked]) {
            let above = rows.iter().position(|&(x, _)| x >= asked).unwrap();
            let (a, b) = (rows[above.saturating_sub(1)].1, rows[above].1);
            prop_assert!((a.min(b) - 1e-15..=a.max(b) + 1e-15).contains(&emissivity[0]));
        }
        for &(x, e) in &rows {
            prop_assert_eq!(material.emissivity(&[x]).unwrap()[0], e);
        }
    }

    #[test]
    fn every_embedded_material_stays_between_0_and_1(asked in 700.1..1350.0f64) {
        static LIBRARY: std::sync::LazyLock<Library> = std::sync::LazyLock::new(|| Library::embedded().unwrap());
        for material in LIBRARY.iter() {
            let emissivity = material.emissivity(&[asked]).unwrap()[0];
            prop_assert!((0.0..=1.0).contains(&emissivity), "{} {}", material.name(), emissivity);
        }
    }
}
