use super::super::damage::{self, refused, rows};
use super::*;

/// A file of four channels from 9000 nm in steps of 500 nm.
fn file(revision: &str, code: u8, kind: u8, values: &[u8], white: Option<&[u8]>) -> Vec<u8> {
    let mut bytes = vec![0; SAMPLES];
    bytes[..3].copy_from_slice(revision.as_bytes());
    bytes[3..12].copy_from_slice(b"Roof tile");
    bytes[186] = code;
    bytes[191..195].copy_from_slice(&9000.0_f32.to_le_bytes());
    bytes[195..199].copy_from_slice(&500.0_f32.to_le_bytes());
    bytes[199] = kind;
    bytes[204..206].copy_from_slice(&4_u16.to_le_bytes());
    bytes.extend(values);
    if let Some(white) = white {
        bytes.extend([0xff, 0xff]);
        bytes.extend([0; 16]);
        bytes.extend(5_u16.to_le_bytes());
        bytes.extend(b"panel");
        bytes.extend(white);
    }
    bytes
}

fn doubles(values: [f64; 4]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn floats(values: [f32; 4]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn read(bytes: &[u8]) -> Result<Content> {
    assert!(is_one(bytes));
    parse(bytes, Path::new("a.asd"), &Reading::default())
}

#[test]
fn a_part_of_the_white_reference_becomes_an_emissivity() {
    let due: Vec<f64> = vec![0.5, 0.75, 0.9, 0.8];
    let (values, white) = ([200.0, 50.0, 30.0, 100.0], [1000.0, 500.0, 120.0, 200.0]);
    for code in 0..3 {
        let bytes = file("as7", code, 2, &doubles(values), Some(&doubles(white)));
        let found = rows(read(&bytes)).remove(0);
        // Ascending in wavenumber: 10500, 10000, 9500 and 9000 nm.
        for ((place, emissivity), (due, nm)) in
            found.iter().zip(due.iter().zip([10500.0, 10000.0, 9500.0, 9000.0]))
        {
            assert!((place - 1e7 / nm).abs() < 1e-9 && (emissivity - due).abs() < 1e-12, "{found:?}");
        }
        damage::check(parse, &bytes);
    }
    // A reflectance without reference, of the first revision, in floats.
    let bytes = file("ASD", 1, 0, &floats([0.5, 0.25, 0.125, 0.5]), None);
    assert_eq!(rows(read(&bytes))[0][1].1, 0.875);
}

#[test]
fn what_has_no_white_reference_is_refused() {
    let values = floats([1.0; 4]);
    for (bytes, part) in [
        (file("as8", 0, 0, &values, None), "counts without a white reference"),
        (file("as8", 2, 0, &values, Some(&floats([0.0; 4]))), "radiance without a white reference"),
        (file("as8", 6, 0, &values, Some(&values)), "`transmittance`"),
        (file("as8", 4, 0, &values, Some(&values)), "`irradiance`"),
        (file("as8", 1, 7, &values, Some(&values)), "unknown kind"),
    ] {
        let message = refused(read(&bytes));
        assert!(message.contains(part), "{message}");
    }
    // Dead channels are not known.
    let dead = file("as6", 1, 0, &floats([0.5, 0.5, 0.5, 0.5]), Some(&floats([1.0, 1.0, 1.0, 0.0])));
    let material = read(&dead).and_then(Content::materials).unwrap().remove(0);
    assert!(
        material
            .warnings()
            .iter()
            .any(|warning| warning.starts_with("1 of 4 channels are bad or not known; left out")),
        "{:?}",
        material.warnings()
    );
}
