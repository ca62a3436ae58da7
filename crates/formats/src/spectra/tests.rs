use super::*;
use proptest::prelude::*;

fn read_one(text: &str) -> Result<Material> {
    let mut materials = from_text(text, Path::new("dir/My paint.csv"))?;
    assert_eq!(materials.len(), 1);
    Ok(materials.remove(0))
}

fn refusal(text: &str) -> String {
    from_text(text, Path::new("a.csv")).unwrap_err().to_string()
}

#[test]
fn all_four_kinds_of_two_columns_give_the_same_emissivity() {
    for text in [
        "wavenumber_cm1,emissivity\n800,0.7\n1250,0.9\n",
        "wavenumber_cm1,reflectance\n1250,0.1\n800,0.3\n",
        "wavelength_um,emissivity\n8,0.9\n12.5,0.7\n",
        "wavelength_um,reflectance\n12.5,0.3\n8,0.1\n",
    ] {
        let material = read_one(text).unwrap();
        assert_eq!(material.name(), "my-paint");
        assert_eq!(material.emissivity(&[1250.0, 800.0]).unwrap(), [0.9, 0.7], "{text}");
        assert_eq!(material.range_cm1(), Some((800.0, 1250.0)));
    }
}

#[test]
fn comments_blanks_carriage_returns_quotes_and_a_byte_order_mark_do_no_harm() {
    let text = "\u{feff}# made by hand\r\n\r\n \"wavenumber_cm1\" , emissivity \r\n# more\r\n 900 ,\t0.5 \r\n\r\n800,0.25\r\n";
    let material = read_one(text).unwrap();
    assert_eq!(material.emissivity(&[850.0]).unwrap(), [0.375]);
}

#[test]
fn a_wide_table_gives_one_material_for_each_column() {
    let materials =
        from_text("wavenumber_cm1,tilePavement,al2o3\n700,0.1,0.2\n800,0.3,0.4\n", Path::new("x.csv"))
            .unwrap();
    let names: Vec<&str> = materials.iter().map(Material::name).collect();
    assert_eq!(names, ["tile-pavement", "al2o3"]);
    assert_eq!(materials[1].emissivity(&[800.0, 700.0]).unwrap(), [0.4, 0.2]);
}

#[test]
fn optical_constants_give_a_half_space() {
    let glass = read_one("wavelength_um,n,k\n8,1.5,0\n12,1.5,0\n").unwrap();
    assert!((glass.emissivity(&[1000.0]).unwrap()[0] - 0.96).abs() < 1e-15);
}

/// Every bad input has one message that names the file, the line and column where there is one, and the remedy.
#[test]
fn each_bad_input_says_where_and_what_to_write_instead() {
    let head = "wavenumber_cm1,emissivity\n";
    for (text, parts) in [
        (String::new(), &["a.csv: the file has no rows", "wavenumber_cm1,emissivity"][..]),
        ("# only a comment\n".into(), &["no rows"]),
        (head.into(), &["a.csv: there are no rows below the header", "at least 2"]),
        (format!("{head}700,0.5\n"), &["only 1 row", "at least 2"]),
        (
            format!("{head}700,0.5\n800,high\n"),
            &["a.csv:3: emissivity: `high` is not a finite number", "0.95"],
        ),
        (format!("{head}700,0.5\n800,NaN\n"), &["a.csv:3: emissivity: `NaN` is not a finite number"]),
        (format!("{head}700,0.5\n800,inf\n"), &["a.csv:3: emissivity: `inf`"]),
        (format!("{head}700,0.5\n800,\n"), &["a.csv:3: emissivity: the cell is empty"]),
        (format!("{head}700,0.5\nx,0.5\n"), &["a.csv:3: wavenumber_cm1: `x`"]),
        (format!("{head}700,0.5\n800\n"), &["a.csv:3: 1 cells where the header has 2"]),
        (format!("{head}700,0.5\n-8,0.5\n"), &["a.csv:3: wavenumber_cm1", "-8 cm^-1", "above 0"]),
        (
            format!("{head}700,0.5\n800,1.01\n"),
            &["a.csv:3: emissivity", "1.01", "between 0 and 1", "percent"],
        ),
        (format!("{head}700,0.5\n800,-0.1\n"), &["a.csv:3: emissivity", "-0.1"]),
        (
            format!("{head}700,0.5\n\n# note\n800,0.6\n700,0.5\n"),
            &["a.csv:6: wavenumber_cm1: 700 cm^-1 is there already on line 2", "keep one"],
        ),
        (
            "wavelength_um,reflectance\n10,5\n11,6\n".into(),
            &[
                "a.csv:2: reflectance: reflectance is 5",
                "if it is percent, write the header wavelength_um,reflectance (%)",
            ],
        ),
        (
            "wavelength_um,reflectance_percent\n10,5\n11,106\n".into(),
            &["a.csv:3: reflectance_percent: reflectance is 106 percent", "between 0 and 100 percent"],
        ),
        // Nothing says what the numbers are.
        (
            "wavelength_um,paint\n10,5\n11,6\n".into(),
            &[
                "a.csv:1: paint: ",
                "whether it is emissivity or reflectance",
                "such as wavelength_um,reflectance_percent",
            ],
        ),
        ("x,y\n1000,0.9\n1200,0.8\n".into(), &["a.csv:1: ", "such as wavenumber_cm1,emissivity"]),
        (
            "wavelength,emissivity\n400,0.9\n900,0.8\n".into(),
            &["a.csv:1: wavelength", "without its unit", "such as wavelength_nm,emissivity"],
        ),
        (
            "wavelength (cm-1),emissivity\n700,0.9\n900,0.8\n".into(),
            &["a.csv:1: wavelength (cm-1)", "write wavenumber_cm1"],
        ),
        (
            "wavelength_um,emissivity\n8,5,0,95\n9,5,0,96\n".into(),
            &["a.csv:2: 4 cells where the header has 2", "decimal point", "semicolons"],
        ),
        (
            "wavelength_nm;emissivity\n8,000;1\n9,000;1\n".into(),
            &["a.csv:2: `8,000` may be 8.000 or 8000", "decimal points"],
        ),
        (
            "wavelength_um,wavenumber_cm1,emissivity\n8,1250,0.5\n10,900,0.5\n".into(),
            &["a.csv:3: ", "1000.00 cm^-1 by one column and at 900.00"],
        ),
        (
            "wavelength_um,transmittance\n1,0.5\n2,0.5\n".into(),
            &["`transmittance`", "no emissivity follows", "reflectance"],
        ),
        (
            "wavelength_um,specular reflectance\n1,0.5\n2,0.5\n".into(),
            &["a.csv:1: specular reflectance: ", "hemispherical reflectance"],
        ),
        (
            "wavelength_um,emissivity,reflectance\n1,0.5,0.5\n2,0.5,0.5\n".into(),
            &[
                "a.csv:1: emissivity: ",
                "of emissivity and of reflectance",
                "name each column after its material",
            ],
        ),
        ("700,0.5\n800,0.6\n".into(), &["a.csv:1: there is no header", "wavenumber_cm1,emissivity"]),
        (
            "wavenumber_cm1;emissivity\n700;0,5\n800;0.5\n900;0,5\n".into(),
            &["a.csv:3: emissivity: `0.5` has a decimal point where other numbers have commas"],
        ),
        (
            "wavelength_nm;emissivity\n8.000;0,9\n9.000;0,8\n".into(),
            &["a.csv:2: ", "`8.000` has a point and `0,9` a comma", "nothing between thousands"],
        ),
        (
            "wavenumber_cm1,tireA,tire-a\n700,0.5,0.5\n800,0.5,0.5\n".into(),
            &["a.csv:1: two columns", "tire-a"],
        ),
        ("wavelength_um,n,k\n8,0,1\n9,1,1\n".into(), &["a.csv:2", "above 0"]),
    ] {
        let message = refusal(&text);
        for part in parts {
            assert!(message.contains(part), "{text:?}: {message}");
        }
        assert!(!message.contains('\n'), "{message}");
    }
}

#[test]
fn files_that_cannot_be_read_say_so() {
    let directory = tempfile::tempdir().unwrap();
    let message = from_file(directory.path()).unwrap_err().to_string();
    assert!(message.contains("this is a directory"), "{message}");
    let message = from_file(&directory.path().join("gone.csv")).unwrap_err().to_string();
    assert!(message.contains("gone.csv") && message.contains("no such file"), "{message}");
}

const HEADER: &str = "Name: Test paint\r\nType: manmade\r\nWavelength Range: All\r\nDescription: caf\u{e9}: blue\r\n\
    X Units: Wavelength (micrometers)\r\nY Units:Reflectance (percent)\r\nNumber of X Values: 3\r\n\
    Additional Information: none\r\n\r\n";

#[test]
fn a_spectral_library_file_becomes_an_emissivity() {
    let text = format!("{HEADER} 8.0000\t 5.5200\r\n 10.0\t10\r\n 14.0000\t 20.0\r\n\r\n");
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("latin1.spectrum.txt");
    let latin: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
    std::fs::write(&path, latin).unwrap();
    let material = material(&path).unwrap();
    assert_eq!(material.name(), "test-paint");
    let emissivity = material.emissivity(&[1250.0, 1000.0]).unwrap();
    assert!((emissivity[0] - 0.9448).abs() < 2e-16 && (emissivity[1] - 0.9).abs() < 2e-16, "{emissivity:?}");
    assert_eq!(material.provenance().description, "Test paint; café: blue");
    assert_eq!(material.warnings(), [] as [String; 0]);
    assert_eq!(material.rows(), 3);
}

/// Nothing is clamped: the import warns, and only bands that need the bad row fail.
#[test]
fn reflectance_beyond_0_to_100_percent_is_a_warning_and_then_an_error() {
    let material = read_one(&format!("{HEADER}8\t-0.5\n10\t10\n14\t20\n")).unwrap();
    assert!(
        material.warnings()[0].contains("1 rows from 1250.0 to 1250.0 cm^-1"),
        "{:?}",
        material.warnings()
    );
    assert!(material.warnings()[0].contains("-0.500 percent"));
    assert_eq!(material.emissivity(&[1000.0]).unwrap(), [0.9]);
    let message = material.emissivity(&[1100.0]).unwrap_err().to_string();
    assert!(message.contains("`test-paint`") && message.contains("row at 1250 cm^-1 is 1.005"), "{message}");
}

#[test]
fn a_spectrum_without_long_wave_rows_is_warned_about_and_fails_in_use() {
    let material = read_one(&format!("{HEADER}0.4\t5\n1.0\t10\n2.5\t20\n")).unwrap();
    assert!(
        material.warnings()[0]
            .contains("0.400 to 2.50 um (4000 to 25000 cm^-1), read as ECOSTRESS, wavelength in um"),
        "{:?}",
        material.warnings()
    );
    assert!(matches!(material.emissivity(&[1000.0]), Err(Error::OutsideSpectrum { .. })));
}

/// The unit of an axis that is wrong, or that of sunlight, leaves nothing in the thermal infrared.
#[test]
fn a_spectrum_from_elsewhere_is_warned_about_with_its_range_and_unit() {
    let jcamp = "##TITLE= x\n##XUNITS= NANOMETERS\n##YUNITS= REFLECTANCE\n##XYPOINTS= (XY..XY)\n8,0.1 13,0.2\n##END=\n";
    for (text, parts) in [
        ("wavelength_um,emissivity\n8000,0.9\n13000,0.8\n", ["8000 to 13000 um", "read as wavelength in um"]),
        ("nm,emissivity\n8,0.9\n13,0.8\n", ["0.00800 to 0.0130 um", "read as wavelength in nm"]),
        ("wavelength_um,roof,wall\n700,0.9,0.5\n1300,0.8,0.5\n", ["7.69 to 14.3 cm^-1", "wavelength in um"]),
        ("wavelength_um,n,k\n0.4,1.5,0\n2.5,1.5,0\n", ["0.400 to 2.50 um", "n and k"]),
        (jcamp, ["0.00800 to 0.0130 um", "wavelength in nm"]),
    ] {
        for material in from_text(text, Path::new("a")).unwrap() {
            let [warning] = material.warnings() else { panic!("{text}: {:?}", material.warnings()) };
            assert!(parts.iter().all(|part| warning.contains(part)), "{warning}");
        }
    }
    for text in ["wavelength_um,emissivity\n0.4,0.9\n3.1,0.8\n", "cm-1,emissivity\n100,0.9\n501,0.8\n"] {
        assert_eq!(read_one(text).unwrap().warnings(), [] as [String; 0], "{text}");
    }
}

#[test]
fn percent_that_are_fractions_by_their_size_are_warned_about() {
    let jcamp = |percent: f64| {
        format!(
            "##TITLE= x\n##XUNITS= 1/CM\n##YUNITS= %R\n##XYPOINTS= (XY..XY)\n700,0.1 1300,{percent}\n##END=\n"
        )
    };
    let ecostress = |percent: f64| format!("{HEADER}7\t0.1\n10\t{percent}\n14\t0.2\n");
    let table = |percent: f64| format!("cm-1,%R\n700,0.1\n1300,{percent}\n");
    for text in [&jcamp as &dyn Fn(f64) -> String, &ecostress, &table] {
        let warned = |percent: f64| {
            let warnings = read_one(&text(percent)).unwrap().warnings().to_vec();
            warnings.iter().any(|warning| warning.contains("as a fraction it would be another"))
        };
        assert!(warned(0.95) && !warned(1.05), "{}", text(0.95));
    }
}

#[test]
fn each_bad_library_file_says_where_and_what_to_do() {
    let rows = "8\t5\n10\t10\n14\t20\n";
    let with = |from: &str, to: &str| format!("{}{rows}", HEADER.replace(from, to));
    for (text, parts) in [
        (
            with("Reflectance (percent)", "Transmittance (percent)"),
            &["a.csv:6: y units", "transmittance"][..],
        ),
        (with("Reflectance (percent)", "Transittance (percent)"), &["transmittance"]),
        (with("Reflectance (percent)", "Reflectance"), &["`Reflectance` is not reflectance in percent"]),
        (with("Y Units:", "Mineral:"), &["no line `Y Units:`", "ancillary"]),
        (with("micrometers", "nanometers"), &["a.csv:5: x units", "micrometers"]),
        (with("Values: 3", "Values: 4"), &["a.csv:7", "3 rows where the header announces 4"]),
        (format!("{HEADER}8\t5\n10\tx\n14\t20\n"), &["a.csv:11: reflectance: `x`"]),
        (format!("{HEADER}8\t5\n10\tNaN\n14\t20\n"), &["a.csv:11: reflectance: `NaN`"]),
        (format!("{HEADER}8\t5\n-10\t5\n14\t20\n"), &["a.csv:11: wavelength", "above 0"]),
        (format!("{HEADER}8\t5\n10\n14\t20\n"), &["a.csv:11: 1 numbers"]),
        (format!("{HEADER}8\t5\n8\t5\n14\t20\n"), &["a.csv:11: this wavelength is there already on line 10"]),
        (HEADER.replace("Values: 3", "Values: 0"), &["0 rows below the header"]),
    ] {
        let message = refusal(&text);
        for part in parts {
            assert!(message.contains(part), "{text:?}: {message}");
        }
    }
}

#[test]
fn names_become_kebab_case() {
    for (name, kebab) in [
        ("tilePavement", "tile-pavement"),
        ("al2o3", "al2o3"),
        ("fused_silica", "fused-silica"),
        ("Construction  Concrete", "construction-concrete"),
        (" White -- (Gypsum) dune. ", "white-gypsum-dune"),
        ("al@emissivity_54", "al@emissivity-54"),
        ("---", ""),
    ] {
        assert_eq!(hadar::words::kebab_case(name), kebab);
        assert_eq!(hadar::words::kebab_case(kebab), kebab);
    }
}

proptest! {
    #[test]
    fn no_text_makes_a_reader_panic(text in "\\PC*") {
        let _ = from_text(&text, Path::new("x"));
    }

    #[test]
    fn no_text_that_looks_like_a_spectrum_makes_a_reader_panic(
        head in prop::sample::select(vec![
            "wavenumber_cm1,emissivity\n", "wavelength_um,reflectance\n", "wavelength_um,n,k\n",
            "wavenumber_cm1,a,b\n", "Name: x\nX Units: micrometers\nY Units: Reflectance percent\n\n",
        ]),
        body in "([0-9eE.,+\\-\t\n #a-z]|1e400|1e-320|nan|,){0,80}",
    ) {
        if let Ok(materials) = from_text(&format!("{head}{body}"), Path::new("x")) {
            for material in materials {
                if let Ok(emissivity) = material.emissivity(&[500.0, 1000.0, 1e4]) {
                    prop_assert!(emissivity.iter().all(|e| (0.0..=1.0).contains(e)));
                }
            }
        }
    }
}
