use super::super::damage::{self, refused, rows};
use super::*;
use proptest::prelude::*;
use spc_spectra::{SpcBuilder, XType, YType};

fn read(bytes: &[u8]) -> Result<Content> {
    parse(bytes, Path::new("My tile.spc"), &Reading::default())
}

/// What another program writes is read as it meant it.
fn of_builder(spectra: &[Vec<f64>]) -> Vec<u8> {
    let builder = match spectra {
        [one] => SpcBuilder::new(1300.0, 700.0, one.clone()),
        many => {
            SpcBuilder::series(1300.0, 700.0, (0_u8..).map(f32::from).zip(many.iter().cloned()).collect())
        }
    };
    let spc = builder.x_type(XType::Wavenumber).y_type(YType::Reflectance).comment("Roof tile");
    spc.build().unwrap().to_bytes().unwrap()
}

proptest! {
    #![proptest_config(hadar_testing::seeded(46, 64))]
    #[test]
    fn a_file_of_another_program_is_read_as_it_was_meant(
        spectra in (2_usize..40).prop_flat_map(|points| prop::collection::vec(prop::collection::vec(0.0..1.0, points), 1..4))
    ) {
        let bytes = of_builder(&spectra);
        prop_assert!(is_one(&bytes));
        let found = rows(read(&bytes));
        prop_assert_eq!(found.len(), spectra.len());
        for (found, due) in found.iter().zip(&spectra) {
            prop_assert_eq!(found.len(), due.len());
            let step = 600.0 / (due.len() - 1) as f64;
            // The file descends in wavenumber, and is reflectance.
            for (at, ((place, emissivity), reflectance)) in found.iter().zip(due.iter().rev()).enumerate() {
                prop_assert!((place - (700.0 + step * at as f64)).abs() < 1e-9);
                prop_assert!((emissivity - (1.0 - reflectance)).abs() < 1e-7);
            }
        }
    }
}

/// Files that the other program does not write, by the description of the format.
struct Written {
    flags: u8,
    version: u8,
    exponent: i8,
    axis: u8,
    values: u8,
    labels: &'static [u8],
}

const PLAIN: Written = Written { flags: 0, version: b'K', exponent: -128, axis: 1, values: 129, labels: b"" };

impl Written {
    fn word(&self, value: u32) -> [u8; 4] {
        if self.version == b'L' { value.to_be_bytes() } else { value.to_le_bytes() }
    }

    fn double(&self, value: f64) -> [u8; 8] {
        if self.version == b'L' { value.to_be_bytes() } else { value.to_le_bytes() }
    }

    fn float(&self, value: f32) -> [u8; 4] {
        self.word(value.to_bits())
    }

    fn header(&self, points: u32, (first, last): (f64, f64), traces: u32) -> Vec<u8> {
        let mut bytes = vec![0; 512];
        bytes[0] = self.flags;
        bytes[1] = self.version;
        bytes[3] = self.exponent.cast_unsigned();
        bytes[4..8].copy_from_slice(&self.word(points));
        bytes[8..16].copy_from_slice(&self.double(first));
        bytes[16..24].copy_from_slice(&self.double(last));
        bytes[24..28].copy_from_slice(&self.word(traces));
        bytes[28] = self.axis;
        bytes[29] = self.values;
        bytes[218..218 + self.labels.len()].copy_from_slice(self.labels);
        bytes
    }

    /// Header of a trace with its exponent and number of points.
    fn trace(&self, points: u32) -> Vec<u8> {
        let mut bytes = vec![0; 32];
        bytes[1] = self.exponent.cast_unsigned();
        bytes[16..20].copy_from_slice(&self.word(points));
        bytes
    }

    /// A file of three evenly spaced points.
    fn even(&self, values: &[u8]) -> Vec<u8> {
        [self.header(3, (800.0, 1200.0), 1), self.trace(0), values.to_vec()].concat()
    }
}

/// Reflectances of 1/8, 1/4 and 1/2 at 800, 1000 and 1200 cm⁻¹.
const DUE: [(f64, f64); 3] = [(800.0, 0.875), (1000.0, 0.75), (1200.0, 0.5)];
const VALUES: [f32; 3] = [0.125, 0.25, 0.5];

#[test]
fn every_form_gives_the_same_spectrum() {
    for version in [b'K', b'L'] {
        let plain = Written { version, ..PLAIN };
        let floats: Vec<u8> = VALUES.iter().flat_map(|value| plain.float(*value)).collect();
        assert_eq!(rows(read(&plain.even(&floats))), [DUE]);
        // n 2^(1 − 32) and n 2^(1 − 16).
        let whole = Written { exponent: 1, ..plain };
        let words: Vec<u8> =
            VALUES.iter().flat_map(|value| plain.word((value * 2.0_f32.powi(31)) as u32)).collect();
        assert_eq!(rows(read(&whole.even(&words))), [DUE]);
        let short = Written { flags: 0x01, ..whole };
        let halves = VALUES.iter().map(|value| (value * 32768.0) as u16);
        let halves: Vec<u8> = halves
            .flat_map(|half| if version == b'L' { half.to_be_bytes() } else { half.to_le_bytes() })
            .collect();
        assert_eq!(rows(read(&short.even(&halves))), [DUE]);
        // An axis that is a list, for all traces or in each, with a directory or without.
        let axis: Vec<u8> =
            [800.0_f32, 1000.0, 1200.0].iter().flat_map(|place| plain.float(*place)).collect();
        let listed = Written { flags: 0x80, ..plain };
        let bytes = [listed.header(3, (0.0, 0.0), 1), axis.clone(), listed.trace(0), floats.clone()].concat();
        assert_eq!(rows(read(&bytes)), [DUE]);
        let each = Written { flags: 0xc4, ..plain };
        let trace = [each.trace(3), axis.clone(), floats.clone()].concat();
        let bytes = [each.header(0, (0.0, 0.0), 2), trace.clone(), trace.clone()].concat();
        assert_eq!(rows(read(&bytes)), [DUE, DUE]);
        let entry = |at: u32| [each.word(at), each.word(56), each.word(0)].concat();
        let directory = [entry(512), entry(568)].concat();
        let bytes = [each.header(624, (0.0, 0.0), 2), trace.clone(), trace, directory].concat();
        assert_eq!(rows(read(&bytes)), [DUE, DUE]);
        damage::check(parse, &bytes);
        damage::check(parse, &plain.even(&floats));
    }
    let old = |exponent: i16, values: &[u8]| {
        let mut bytes = vec![0; 256];
        bytes[1] = b'M';
        bytes[2..4].copy_from_slice(&exponent.to_le_bytes());
        bytes[4..8].copy_from_slice(&3.0_f32.to_le_bytes());
        bytes[8..12].copy_from_slice(&800.0_f32.to_le_bytes());
        bytes[12..16].copy_from_slice(&1200.0_f32.to_le_bytes());
        bytes[16] = 1;
        bytes[17] = 129;
        [bytes, values.to_vec()].concat()
    };
    // Of the integer the half with the higher bits comes first.
    let swapped = VALUES.iter().map(|value| ((value * 2.0_f32.powi(31)) as u32).rotate_left(16));
    let bytes = old(1, &swapped.flat_map(u32::to_le_bytes).collect::<Vec<u8>>());
    assert_eq!(rows(read(&bytes)), [DUE]);
    damage::check(parse, &bytes);
    assert_eq!(signed(4_294_967_295.0), -1.0);
}

#[test]
fn only_reflectance_and_emissivity_are_taken() {
    let floats: Vec<u8> = VALUES.iter().flat_map(|value| value.to_le_bytes()).collect();
    for (written, parts) in [
        (Written { values: 2, ..PLAIN }, &["`absorbance`, from which no emissivity follows"][..]),
        (Written { values: 128, ..PLAIN }, &["`transmission`"]),
        (Written { axis: 13, ..PLAIN }, &["a Raman shift"]),
        (Written { values: 0, ..PLAIN }, &["`arbitrary intensity`", "--columns wavenumber_cm1,reflectance"]),
        (Written { values: 131, ..PLAIN }, &["`emission`, which may be"]),
        (Written { axis: 0, ..PLAIN }, &["does not say in which unit"]),
        (Written { flags: 0x20, labels: b"cm-1\0Transmittance\0", ..PLAIN }, &["`Transmittance`"]),
        (Written { flags: 0x01, ..PLAIN }, &["floats by their exponent and of 16 bits"]),
    ] {
        let message = refused(read(&written.even(&floats)));
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    // Labels take the place of codes.
    let labelled =
        Written { flags: 0x20, labels: b"Wavenumber (cm-1)\0Emissivity\0", axis: 0, values: 0, ..PLAIN };
    let due = [(800.0, 0.125), (1000.0, 0.25), (1200.0, 0.5)];
    assert_eq!(rows(read(&labelled.even(&floats))), [due]);
    // What the file leaves open the columns say, and never the contrary.
    let open = Written { values: 0, ..PLAIN }.even(&floats);
    let said = |columns: [&str; 2]| parse(&open, Path::new("a.spc"), &Reading::default().columns(columns));
    assert_eq!(rows(said(["wavenumber_cm1", "emissivity"])), [due]);
    assert_eq!(rows(said(["cm-1", "%R"]))[0][2], (1200.0, 0.995));
    assert!(refused(said(["um", "emissivity"])).contains("cm^-1 by the file and um by --columns"));
    let own =
        parse(&PLAIN.even(&floats), Path::new("a.spc"), &Reading::default().columns(["cm-1", "emissivity"]));
    assert!(refused(own).contains("reflectance by the file and emissivity by --columns"));
    // Percent where fractions are announced.
    let percent: Vec<u8> = VALUES.iter().flat_map(|value| (100.0 * value).to_le_bytes()).collect();
    assert!(refused(read(&PLAIN.even(&percent))).contains("reflectance up to 50"));
}
