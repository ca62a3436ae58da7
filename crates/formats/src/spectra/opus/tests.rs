use super::super::damage::{self, refused, rows};
use super::*;

/// A parameter: name, kind, value.
fn parameter(name: &str, kind: u16, value: &[u8]) -> Vec<u8> {
    let words = (value.len() / 2) as u16;
    [name.as_bytes(), &[0], &kind.to_le_bytes(), &words.to_le_bytes(), value].concat()
}

fn number(name: &str, value: f64) -> Vec<u8> {
    parameter(name, 1, &value.to_le_bytes())
}

/// Bits of a block of data or of its parameters.
const fn kind(quantity: u32, parameters: u32) -> u32 {
    3 | 3 << 2 | parameters << 4 | quantity << 10
}

/// A file of these blocks: a header, the blocks, the directory between.
fn file(blocks: &[(u32, Vec<u8>)]) -> Vec<u8> {
    let count = blocks.len() as u32;
    let mut at = 24 + 12 * count;
    let (mut directory, mut content) = (Vec::new(), Vec::new());
    for (kind, block) in blocks {
        directory.extend([*kind, block.len() as u32 / 4, at].iter().flat_map(|word| word.to_le_bytes()));
        content.extend(block);
        at += block.len() as u32;
    }
    let header = [
        &MAGIC[..],
        &920_622.0_f64.to_le_bytes(),
        &24_u32.to_le_bytes(),
        &count.to_le_bytes(),
        &count.to_le_bytes(),
    ];
    [header.concat(), directory, content].concat()
}

fn parameters(unit: &str, factor: f64, extreme: f64) -> Vec<u8> {
    [
        parameter("DPF", 0, &1_i32.to_le_bytes()),
        parameter("NPT", 0, &3_i32.to_le_bytes()),
        number("FXV", 1200.0),
        number("LXV", 800.0),
        number("CSF", factor),
        number("MXY", extreme),
        parameter("DXU", 2, &[unit.as_bytes(), &[0; 2][..4 - unit.len()]].concat()),
        b"END\0\0\0\0\0".to_vec(),
    ]
    .concat()
}

fn values(values: [f32; 3]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn reflectance() -> Vec<(u32, Vec<u8>)> {
    let name = parameter("SNM", 2, b"Roof tile\0");
    vec![
        (10 << 4, [name, b"END\0\0\0\0\0\0\0".to_vec()].concat()),
        (kind(1, 1), parameters("WN", 1.0, 9.0)),
        (kind(1, 0), values([9.0, 8.0, 7.0])),
        (kind(12, 1), parameters("WN", 1.0, 0.5)),
        (kind(12, 0), values([0.5, 0.25, 0.125])),
    ]
}

fn read(blocks: &[(u32, Vec<u8>)]) -> Result<Content> {
    parse(&file(blocks), Path::new("a.0"), &Reading::default())
}

#[test]
fn the_block_of_reflectance_becomes_an_emissivity() {
    let due = [(800.0, 0.875), (1000.0, 0.75), (1200.0, 0.5)];
    let tile = reflectance();
    assert_eq!(rows(read(&tile)), [due]);
    let materials = read(&tile).and_then(Content::materials).unwrap();
    assert_eq!(materials[0].name(), "roof-tile");
    assert_eq!(materials[0].read_as(), "OPUS, its block of reflectance, wavenumber in cm^-1, reflectance");
    damage::check(parse, &file(&tile));
    // A factor, another block beside it.
    let mut more = tile.clone();
    more[3].1 = parameters("WN", 0.5, 0.5);
    more[4].1 = values([1.0, 0.5, 0.25]);
    more.push((kind(4, 1), parameters("WN", 1.0, 3.0)));
    more.push((kind(4, 0), values([3.0, 2.0, 1.0])));
    assert_eq!(rows(read(&more)), [due]);
    let materials = read(&more).and_then(Content::materials).unwrap();
    assert!(materials[0].read_as().contains("(beside it absorbance)"), "{}", materials[0].read_as());
}

#[test]
fn what_is_no_reflectance_is_named() {
    let swapped = |quantity: u32| -> Vec<(u32, Vec<u8>)> {
        let of = |(bits, block): (u32, Vec<u8>)| {
            (if bits >> 10 == 12 { bits ^ (12 ^ quantity) << 10 } else { bits }, block)
        };
        reflectance().into_iter().map(of).collect()
    };
    for (blocks, parts) in [
        (swapped(4), &["blocks of absorbance, from which no emissivity follows"][..]),
        (swapped(5), &["transmittance"]),
        (swapped(11), &["`emission`, which may be", "--columns wavenumber_cm1,reflectance"]),
        (reflectance()[..3].to_vec(), &["single-channel spectrum"]),
        (reflectance()[..1].to_vec(), &["no block of a spectrum"]),
        (
            [&reflectance()[..3], &reflectance()[4..]].concat(),
            &["the parameters of the block of reflectance are missing"],
        ),
        ([reflectance(), reflectance()[3..].to_vec()].concat(), &["2 blocks of reflectance"]),
    ] {
        let message = refused(read(&blocks));
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    // The largest value is not that of the file; more points than there is room for; an axis of time.
    for (parameters, part) in [
        (parameters("WN", 1.0, 0.6), "MXY of the file is 0.6"),
        // Of a factor that makes another number of the largest value nobody knows whether it was applied.
        (parameters("WN", 0.01, 0.5), "MXY of the file is 0.5"),
        (parameters("WN", 0.0, 0.5), "CSF is 0"),
        (parameters("MIN", 1.0, 0.5), "`MIN`, no wavenumber"),
        (
            [parameter("NPT", 0, &4_i32.to_le_bytes()), number("FXV", 1.0), number("LXV", 2.0)].concat(),
            "room for 3",
        ),
    ] {
        let mut blocks = reflectance();
        blocks[3].1 = parameters;
        let message = refused(read(&blocks));
        assert!(message.contains(part), "{message}");
    }
}
