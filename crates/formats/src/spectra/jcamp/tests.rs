use super::*;

/// The numbers of one line in every form, as the publication of the format has them.
#[test]
fn every_form_of_ordinates_gives_the_same_numbers() {
    let expected = [
        4.0, 0.0, 0.0, 0.0, 0.0, 2.0, 4.0, 4.0, 4.0, 7.0, 5.0, 4.0, 4.0, 5.0, 5.0, 7.0, 10.0, 11.0, 11.0,
        6.0, 5.0, 7.0, 6.0, 9.0, 9.0, 7.0,
    ];
    for line in [
        "4 0 0 0 0 2 4 4 4 7 5 4 4 5 5 7 10 11 11 6 5 7 6 9 9 7",
        "4+0+0+0+0+2+4+4+4+7+5+4+4+5+5+7+10+11+11+6+5+7+6+9+9+7",
        "4@@@@BDDDGEDDEEGA0A1A1FEGFIIG",
        "4@VBDUGEDTETGA0A1TFEGFITG",
        "4@%%%K K%%L k j%J%K L J%n j K j L%k",
        "4@VKT%TLkj%J%KLJ%njKjL%k",
    ] {
        let (values, starts) =
            ordinates::read(&[(1, line)]).unwrap_or_else(|error| panic!("{line}: {error}"));
        assert_eq!((values.as_slice(), starts.len(), starts[0].x), (&expected[1..], 1, 4.0), "{line}");
    }
    let (values, _) = ordinates::read(&[(1, "4 -1.5E+01,2.5e-1;-3")]).unwrap();
    assert_eq!(values, [-15.0, 0.25, -3.0]);
}

#[test]
fn the_first_ordinate_after_differences_is_a_check() {
    let (values, starts) = ordinates::read(&[(1, "100B0J0%"), (2, "103C0J0J0")]).unwrap();
    assert_eq!(values, [20.0, 30.0, 30.0, 40.0, 50.0]);
    assert_eq!(starts.iter().map(|start| start.index).collect::<Vec<_>>(), [0, 2]);
    assert_eq!(ordinates::read(&[(1, "100B0J0%"), (2, "103@")]).unwrap().0, [20.0, 30.0, 30.0]);
    let message = ordinates::read(&[(1, "100B0J0%"), (2, "103C1J0J0")]).unwrap_err().to_string();
    assert!(
        message.contains("line 2: the check at the begin of the line is 31 where the ordinate before is 30"),
        "{message}"
    );
    for (line, part) in
        [("1 2?3", "`?`"), ("1 S", "repeats what is not there"), ("1 J", "changes what is not there")]
    {
        let message = ordinates::read(&[(7, line)]).unwrap_err().to_string();
        assert!(message.contains("line 7") && message.contains(part), "{message}");
    }
}

const FILE: &str = "##TITLE= Roof tile, red $$ of mine\n##JCAMP-DX= 4.24\n##DATA TYPE= INFRARED SPECTRUM\n##ORIGIN= Laboratory\n\
    ##XUNITS= 1/CM\n##YUNITS= REFLECTANCE\n##XFACTOR= 1.0\n##YFACTOR= 0.001\n##FIRSTX= 1000\n##LASTX= 800\n##DELTAX= -50\n\
    ##NPOINTS= 5\n##FIRSTY= 0.1\n##XYDATA= (X++(Y..Y))\n1000 100 150 200\n850 250 300\n##END=\n";

fn read(text: &str) -> Result<Vec<Material>> {
    parse(text, Path::new("a.jdx"), &Reading::default()).and_then(Content::materials)
}

#[test]
fn a_file_becomes_an_emissivity() {
    let materials = read(FILE).unwrap();
    let tile = &materials[0];
    assert_eq!((materials.len(), tile.name(), tile.rows()), (1, "roof-tile-red", 5));
    let emissivity = tile.emissivity(&[1000.0, 925.0, 800.0]).unwrap();
    for (found, due) in emissivity.iter().zip([0.9, 0.825, 0.7]) {
        assert!((found - due).abs() < 1e-12, "{emissivity:?}");
    }
    assert_eq!(tile.summary().read_as, "JCAMP-DX, wavenumber in cm^-1, reflectance");
    let pairs = "##XYPOINTS= (XY..XY)\n1000,100; 950,150; 900,200\n850,250 800,300\n##END=\n";
    let start = FILE.split("##XYDATA").next().unwrap();
    let again = read(&format!("{start}{pairs}")).unwrap();
    assert_eq!(again[0].emissivity(&[925.0]).unwrap(), tile.emissivity(&[925.0]).unwrap());
    // Wavelengths, in percent, two blocks in one.
    let percent =
        FILE.replace("REFLECTANCE", "%R").replace("0.001", "0.1").replace("FIRSTY= 0.1", "FIRSTY= 10");
    let other = percent.replace("Roof tile, red", "Wall").replace("1/CM", "MICROMETERS");
    let both = format!("##TITLE= both\n##DATA TYPE= LINK\n##BLOCKS= 2\n{percent}{other}##END=\n");
    let both = read(&both).unwrap();
    assert!((both[0].emissivity(&[925.0]).unwrap()[0] - 0.825).abs() < 1e-12);
    assert!((both[1].emissivity(&[1e4 / 900.0]).unwrap()[0] - 0.8).abs() < 1e-12);
}

#[test]
fn a_block_that_cannot_be_used_leaves_the_others_and_equal_titles_are_counted() {
    let compound = |blocks: &[String]| {
        format!("##TITLE= set\n##JCAMP-DX= 4.24\n##DATA TYPE= LINK\n##BLOCKS= 2\n{}##END=\n", blocks.concat())
    };
    let through = FILE.replace("REFLECTANCE", "TRANSMITTANCE").replace("Roof tile, red", "Window");
    let one = read(&compound(&[through.clone(), FILE.to_owned()])).unwrap();
    assert_eq!(one.iter().map(Material::name).collect::<Vec<_>>(), ["roof-tile-red"]);
    assert!(
        one[0].warnings().iter().any(|warning| warning.starts_with(
            "the block `Window` is left out: line 10: YUNITS: `TRANSMITTANCE`, from which no emissivity follows"
        )),
        "{:?}",
        one[0].warnings()
    );
    let other = FILE.replace("200\n", "250\n");
    let both = read(&compound(&[FILE.to_owned(), other])).unwrap();
    assert_eq!(both.iter().map(Material::name).collect::<Vec<_>>(), ["roof-tile-red@1", "roof-tile-red@2"]);
    assert!((both[0].emissivity(&[900.0]).unwrap()[0] - 0.8).abs() < 1e-12);
    assert!((both[1].emissivity(&[900.0]).unwrap()[0] - 0.75).abs() < 1e-12);
    let said = "2 blocks have this title: it is number 2, that of line 22";
    assert!(both[1].warnings().iter().any(|warning| warning == said), "{:?}", both[1].warnings());
    // A block that is damaged may be any: nothing is taken from beside it.
    assert!(read(&compound(&[FILE.to_owned(), FILE.replace("NPOINTS= 5", "NPOINTS= 6")])).is_err());
    assert!(read(&compound(&[through.clone(), through])).is_err());
}

#[test]
fn each_mistake_says_where_and_what_to_do() {
    for (from, to, parts) in [
        ("REFLECTANCE", "TRANSMITTANCE", &["line 6: YUNITS: `TRANSMITTANCE`", "opaque sample"][..]),
        ("REFLECTANCE", "ABSORBANCE", &["YUNITS: `ABSORBANCE`, from which no emissivity follows"]),
        ("REFLECTANCE", "KUBELKA-MUNK", &["YUNITS"]),
        ("1/CM", "SECONDS", &["line 5: XUNITS: `SECONDS`", "1/CM, MICROMETERS"]),
        (
            "NPOINTS= 5",
            "NPOINTS= 6",
            &["line 12: NPOINTS: 5 points where the header announces 6", "cut short"],
        ),
        ("DELTAX= -50", "DELTAX= -40", &["line 11: DELTAX: steps of -40", "-50"]),
        ("##FIRSTX= 1000\n", "", &["there is no ##FIRSTX="]),
        ("FIRSTY= 0.1", "FIRSTY= 0.2", &["line 13: FIRSTY: the first ordinate is 0.1"]),
        (
            "\n850 250",
            "\n650 250",
            &["line 16: this line begins at x = 650 where its first ordinate is at 850"],
        ),
        ("YFACTOR= 0.001", "YFACTOR= x", &["line 8: YFACTOR: `x`"]),
        ("(X++(Y..Y))", "(X++(R..R))", &["line 14: XYDATA: `(X++(R..R))`"]),
        ("XYDATA= (X++(Y..Y))", "PEAK TABLE= (XY..XY)", &["peaks are no spectrum"]),
        ("##YFACTOR= 0.001\n", "", &["line 6: YUNITS: reflectance up to 300", "##YUNITS= %REFLECTANCE"]),
        ("200\n", "200 !\n", &["line 15: `!`"]),
    ] {
        assert!(FILE.contains(from), "{from}");
        let text = FILE.replace(from, to);
        let text = if to.is_empty() { text.replace("##FIRSTY= 0.1\n", "") } else { text };
        let message = read(&text).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{to}: {message}");
        }
    }
}

proptest::proptest! {
    #![proptest_config(hadar_testing::seeded(46, 256))]

    #[test]
    fn no_ordinates_make_the_reader_panic(body in "([0-9@A-Za-z%+.,; -]|\n){0,60}") {
        let start = FILE.split("1000 100").next().unwrap().replace("##NPOINTS= 5\n", "").replace("##DELTAX= -50\n", "");
        for text in [format!("{start}{body}"), format!("{start}100{body}").replace("XYDATA= (X++(Y..Y))", "XYPOINTS= (XY..XY)")] {
            if let Ok(materials) = read(&text) {
                proptest::prop_assert!(materials.iter().all(|material| material.rows() >= 2));
            }
        }
    }
}
