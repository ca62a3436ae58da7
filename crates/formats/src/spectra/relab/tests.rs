use super::super::damage::{refused, rows};
use super::*;

const FILE: &str = "  3\n  8.000  0.10000  0.00100\n 10.000  0.20000  0.00100\n 12.500  0.40000  0.00200\n\n\n\
                    C1SF02      .ASC\n\nSF-EAS-002\nRoof tile, ground\n";

fn read(text: &str) -> Result<Content> {
    parse(text, Path::new("c1sf02.asc"), &Reading::default())
}

#[test]
fn rows_below_their_number_become_an_emissivity() {
    assert!(is_one(FILE) && !is_one("wavelength_um,emissivity\n8,0.9\n9,0.8\n") && !is_one("8 0.9\n9 0.8\n"));
    let due = [(800.0, 0.6), (1000.0, 0.8), (1250.0, 0.9)];
    assert_eq!(rows(read(FILE)), [due]);
    let material = read(FILE).and_then(Content::materials).unwrap().remove(0);
    assert_eq!(material.name(), "c1sf02");
    assert!(material.provenance().description.contains("Roof tile, ground"), "{:?}", material.provenance());
    assert!(
        material.warnings().iter().any(|warning| warning.contains("hemispherical")),
        "{:?}",
        material.warnings()
    );
    let named = "3\nWavelength(nm)\tReflectance\n8000\t0.1\n10000\t0.2\n12500\t0.4\n";
    assert!(is_one(named));
    assert_eq!(rows(read(named)), [due]);
    for (from, to, part) in [
        ("  3\n", "  4\n", "line 1: 3 rows where the first line announces 4"),
        ("  3\n", "  2\n", "line 1: 3 rows where the first line announces 2"),
        (" 10.000  0.2", " 10.000  x.2", "line 1: 1 rows"),
    ] {
        let message = refused(read(&FILE.replace(from, to)));
        assert!(message.contains(part), "{message}");
    }
}
