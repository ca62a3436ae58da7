use super::super::damage::{refused, rows};
use super::*;
use std::fs;

const AXIS: &str = " splib07a Record=13: Wavelengths NIC4 Nicolet 1.12-216 microns\n 8.0000000e+000\n 1.0000000e+001\n 1.2500000e+001\n \
                    1.6000000e+001\n";
const TILE: &str = " splib07a Record=5932: Kaolinite CM5                 NIC4bb AREF\n 1.0000000e-001\n 2.0000000e-001\n 4.0000000e-001\n\
                    -1.2300000e+034\n";
const NAME: &str = "splib07a_Wavelengths_NIC4_Nicolet_1.12-216microns.txt";

fn read(folder: &Path, text: &str) -> Result<Content> {
    parse(text, Path::new("splib07a_Kaolinite.txt"), Some(folder), &Reading::default())
}

#[test]
fn values_meet_the_wavelengths_of_their_spectrometer() {
    let root = tempfile::tempdir().unwrap();
    let chapter = root.path().join("ChapterM_Minerals");
    fs::create_dir(&chapter).unwrap();
    assert!(is_one(AXIS) && is_one(TILE) && !is_one("wavelength_um,emissivity\n8,1\n"));
    assert!(refused(read(&chapter, TILE)).contains("splib07a_Wavelengths_NIC4"));
    // Another spectrometer's are none of them.
    fs::write(root.path().join("splib07a_Wavelengths_ASD.txt"), AXIS.replace("NIC4 Nicolet", "ASD")).unwrap();
    assert!(refused(read(&chapter, TILE)).contains("in another file, which is not here"));
    fs::write(root.path().join(NAME), AXIS).unwrap();
    let due = [(800.0, 0.6), (1000.0, 0.8), (1250.0, 0.9)];
    assert_eq!(rows(read(&chapter, TILE)), [due]);
    let material = read(&chapter, TILE).and_then(Content::materials).unwrap().remove(0);
    assert_eq!(material.name(), "kaolinite-cm5");
    assert!(material.read_as().contains(NAME), "{}", material.read_as());
    assert!(
        material.warnings().iter().any(|warning| warning.starts_with("1 of 4 channels")),
        "{:?}",
        material.warnings()
    );
    let relative =
        read(&chapter, &TILE.replace("AREF", "RREF")).and_then(Content::materials).unwrap().remove(0);
    assert!(relative.warnings().iter().any(|warning| warning.contains("RREF")), "{:?}", relative.warnings());
    for (text, part) in [
        (TILE.replace(" 4.0000000e-001\n", ""), "3 values where its wavelengths are 4"),
        (TILE.replace(" 4.0000000e-001\n", " x\n"), "line 4: `x`"),
        (TILE.replace("AREF", "TRAN"), "line 1: transmittance (`TRAN`)"),
        (TILE.replace("AREF", "RTGC"), "line 1: a title that ends in `RTGC`"),
        (AXIS.to_owned(), "what belongs to spectra and is none"),
    ] {
        let message = refused(read(&chapter, &text));
        assert!(message.contains(part), "{message}");
    }
    // Two files of the right length that nothing tells apart.
    fs::write(root.path().join(format!("b{NAME}")), AXIS).unwrap();
    assert!(refused(read(&chapter, TILE)).contains("leave only that of its spectrometer"));
    // A text without a folder has none beside it.
    assert!(refused(parse(TILE, Path::new("a.txt"), None, &Reading::default())).contains("not here"));
}

#[test]
fn version_6_has_its_wavelengths_in_it() {
    let text = "USGS Digital Spectral Library splib06a\nClark and others 2007, USGS, Data Series 231.\n\nline 17 to end: 3-columns of data:\n\
                -----------------------------------\nAcmite NMNH133746 Pyroxene   N1R1a AREF\ncopy of splib05a r 11\n\
                       8.000000      0.100000      0.001000\n      10.000000      -1.23e34      -1.23e34\n\
                      12.500000      0.400000      0.002000\n";
    assert!(is_one(text));
    let read = |text: &str| parse(text, Path::new("acmite.asc"), None, &Reading::default());
    let material = read(text).and_then(Content::materials).unwrap().remove(0);
    assert_eq!((material.name(), material.rows()), ("acmite-nmnh133746-pyroxene", 3));
    assert_eq!(material.emissivity(&[800.0, 1250.0]).unwrap(), [0.6, 0.9]);
    // Nothing is known at the deleted channel.
    assert!(material.emissivity(&[1000.0]).is_err());
    assert!(refused(read(&text.replace("      0.002000", ""))).contains("line 10: 2 cells"));
    assert!(refused(read(&text.replace("-----", "+++++"))).contains("no title"));
}
