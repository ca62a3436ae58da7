//! Spectra in the layouts that programs and people write: the same rows come out of all of them.

use hadar::material::Material;
use hadar_formats::spectra::Reading;
use hadar_testing::{repository, shared};
use proptest::prelude::*;
use std::path::{Path, PathBuf};

/// The spectrum of the files in `tests/data/spectra`, cm⁻¹ and emissivity.
const ROWS: [(f64, f64); 11] = [
    (700.0, 0.9798),
    (760.0, 0.9665),
    (820.0, 0.9247),
    (880.0, 0.8723),
    (940.0, 0.8318),
    (1000.0, 0.8205),
    (1060.0, 0.8433),
    (1120.0, 0.8903),
    (1180.0, 0.9415),
    (1240.0, 0.9749),
    (1300.0, 0.9763),
];

fn data(name: &str) -> PathBuf {
    repository().join("tests/data/spectra").join(name)
}

fn check(what: &str, material: &Material) {
    assert_eq!(material.rows(), ROWS.len(), "{what}");
    let (low, high) = material.range_cm1().unwrap();
    assert!((low - 700.0).abs() < 1e-3 && (high - 1300.0).abs() < 1e-3, "{what}: {low} to {high}");
    for (wavenumber, emissivity) in ROWS {
        // At the ends rounding of the axis may leave the row outside by as much.
        let asked = wavenumber.clamp(low, high);
        let found = material.emissivity(&[asked]).unwrap_or_else(|error| panic!("{what}: {error}"))[0];
        assert!((found - emissivity).abs() < 2e-6, "{what} at {wavenumber}: {found}");
    }
}

#[test]
fn files_of_other_programs_hold_the_same_spectrum() {
    for (file, read_as) in [
        ("pandas_comma.csv", "wavelength in um, emissivity"),
        ("pandas_index.csv", "wavelength in um, emissivity"),
        (
            "pandas_german.csv",
            "wavelength in um, emissivity in percent, semicolons between columns, decimal commas",
        ),
        ("pandas_tab.txt", "wavelength in nm, reflectance in percent, tabs between columns"),
        ("pandas_quoted.csv", "wavenumber in cm^-1, reflectance in percent"),
        ("pandas_terahertz.csv", "frequency in THz, emissivity"),
        ("pandas_utf16.txt", "wavenumber in cm^-1, emissivity, tabs between columns"),
        ("pandas_series.csv", "wavenumber in cm^-1, emissivity"),
        ("numpy_header.txt", "wavelength in um, emissivity, blanks between columns"),
        ("numpy_semicolon.csv", "wavelength in um, reflectance, semicolons between columns"),
        ("jcamp_affn.jdx", "JCAMP-DX, wavenumber in cm^-1, reflectance"),
    ] {
        let material =
            hadar_formats::spectra::material(&data(file)).unwrap_or_else(|error| panic!("{error}"));
        check(file, &material);
        assert_eq!(material.summary().read_as, read_as, "{file}");
    }
    let wide = hadar_formats::spectra::from_file(&data("pandas_wide.csv")).unwrap();
    assert_eq!(wide.iter().map(Material::name).collect::<Vec<_>>(), ["paint", "copper"]);
    wide.iter().for_each(|material| check("wide", material));
    for file in ["spectral_library.sli", "spectral_library.hdr"] {
        let library = hadar_formats::spectra::from_file(&data(file)).unwrap();
        assert_eq!(library.iter().map(Material::name).collect::<Vec<_>>(), ["roof-tile", "gray-paint"]);
        check(file, &library[0]);
        let gray = library[1].emissivity(&[1000.0]).unwrap()[0];
        assert!((gray - 0.8205 * 0.8205).abs() < 1e-6, "{gray}");
    }
    let bare = data("numpy_bare.dpt");
    let message = hadar_formats::spectra::from_file(&bare).unwrap_err().to_string();
    assert!(
        message.contains("numpy_bare.dpt:1: there is no header")
            && message.contains("--columns wavenumber_cm1,emissivity"),
        "{message}"
    );
    let columns = ["wavenumber_cm1", "emissivity"];
    check("bare", &Reading::default().columns(columns).file(&bare).unwrap()[0]);
}

/// Real files in squeezed forms, against the values that the Python package `jcamp` 1.3.2 reads. As they are they hold absorbance and
/// transmittance, which is refused; said to be reflectance in a smaller unit, their numbers are read.
#[test]
fn squeezed_files_of_spectrometers_hold_what_another_reader_finds() {
    let message =
        hadar_formats::spectra::from_file(&data("perkin_elmer_difdup.jdx")).unwrap_err().to_string();
    assert!(message.contains(":10: YUNITS: `ABSORBANCE`, from which no emissivity follows"), "{message}");
    let text = std::fs::read_to_string(data("perkin_elmer_difdup.jdx")).unwrap();
    let tenth = [("ABSORBANCE", "REFLECTANCE"), (".0001", ".00001"), ("1.1663", ".11663")];
    let text = tenth.iter().fold(text, |text, (from, to)| text.replace(from, to));
    let material = &hadar_formats::spectra::from_text(&text, Path::new("a.jdx")).unwrap()[0];
    let wavenumbers: Vec<f64> = (0..440).map(|i| 1e7 / (250.0 + 0.5 * f64::from(i))).collect();
    let reflectance: Vec<f64> =
        material.emissivity(&wavenumbers).unwrap().iter().map(|emissivity| 1.0 - emissivity).collect();
    let sum: f64 = reflectance.iter().sum();
    assert!((sum - 16.476_04).abs() < 1e-9, "{sum}");
    for (at, due) in [(0, 0.116_63), (220, 0.122_57), (439, 0.016_26)] {
        assert!((reflectance[at] - due).abs() < 1e-9, "{at}: {}", reflectance[at]);
    }

    let message = hadar_formats::spectra::from_file(&data("specfile_sqzdup.dx")).unwrap_err().to_string();
    assert!(message.contains("YUNITS: `TRANSMITTANCE`"), "{message}");
    let text = std::fs::read_to_string(data("specfile_sqzdup.dx")).unwrap();
    let material =
        &hadar_formats::spectra::from_text(&text.replace("TRANSMITTANCE", "%R"), Path::new("a.dx")).unwrap()
            [0];
    assert_eq!((material.rows(), material.range_cm1()), (1801, Some((400.0, 4000.0))));
    let emissivity = material.emissivity(&[400.0, 2200.0, 4000.0]).unwrap();
    for (found, due) in emissivity.iter().zip([0.977_371_872_2, 0.945_746_973_6, 0.828_309_849_4]) {
        assert!((1.0 - found - due).abs() < 1e-9, "{emissivity:?}");
    }
}

/// A spectral library of two spectra of six channels, as 32-bit floats.
fn library_of(header: &str, spectra: [[f32; 6]; 2]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let samples = spectra.as_flattened().iter().flat_map(|value| value.to_le_bytes());
    std::fs::write(folder.path().join("a.sli"), samples.collect::<Vec<u8>>()).unwrap();
    let text = format!(
        "ENVI\nfile type = ENVI Spectral Library\nsamples = 6\nlines = 2\ndata type = 4\nbyte order = 0\n\
         wavelength units = Micrometers\nwavelength = {{8, 9, 10, 11, 12, 12.5}}\nspectra names = {{one, two}}\n\
         z plot titles = {{Wavelength, Emissivity}}\n{header}\n"
    );
    std::fs::write(folder.path().join("a.hdr"), text).unwrap();
    folder
}

/// Numbers that stand for nothing are told as the file holds them, in 32 bits: the usual -1.23e34 is another number in 64.
#[test]
fn channels_that_are_bad_or_not_known_are_left_out() {
    let nothing = -1.23e34_f32;
    let spectra = [[nothing, 0.9, nothing, 0.8, 0.7, 0.6], [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]];
    let header = "bbl = {1, 1, 1, 1, 1, 0}\ndata ignore value = -1.2300000e+034";
    let folder = library_of(header, spectra);
    let read = hadar_formats::spectra::from_file(&folder.path().join("a.sli")).unwrap();
    let [one, two] = read.as_slice() else { panic!("{read:?}") };
    // At the ends they are outside of the range.
    assert_eq!(one.range_cm1(), Some((1e4 / 12.0, 1e4 / 9.0)));
    assert_eq!((two.range_cm1(), two.rows()), (Some((1e4 / 12.0, 1250.0)), 5));
    assert!(
        one.warnings().iter().any(|said| said.starts_with("3 of 6 channels are bad")),
        "{:?}",
        one.warnings()
    );
    // Between others they are known to be unknown.
    let message = one.emissivity(&[1050.0]).unwrap_err().to_string();
    assert!(message.contains("row at 1000 cm^-1 is bad or missing"), "{message}");
    let known = one.emissivity(&[9.0, 11.0, 12.0].map(|um| 1e4 / um)).unwrap();
    assert!(known.iter().zip([0.9, 0.8, 0.7]).all(|(found, due)| (found - due).abs() < 1e-6), "{known:?}");
    let nowhere = library_of(header, [[nothing; 6], spectra[1]]);
    let read = hadar_formats::spectra::from_file(&nowhere.path().join("a.sli")).unwrap();
    assert_eq!(read.iter().map(Material::name).collect::<Vec<_>>(), ["two"]);
    assert!(read[0].warnings().iter().any(|said| said.contains("left out of the same file: of `one`")));
    let nowhere = library_of("bbl = {0, 0, 0, 0, 0, 1}", spectra);
    let message = hadar_formats::spectra::from_file(&nowhere.path().join("a.sli")).unwrap_err().to_string();
    assert!(message.contains("of `one`, `two` less than 2 channels"), "{message}");
}

/// Files that are called alike are told apart by what else their paths have, in whatever order.
#[test]
fn names_are_unique_where_names_of_files_are_not() {
    let paint = |percent: f64| Material::from_table("a", &[(700.0, percent), (1300.0, percent)]).unwrap();
    let (one, two, three) = (paint(0.1), paint(0.2), paint(0.3));
    for (files, due) in [
        (["lib/a.csv", "lib/a.txt"], ["a@csv", "a@txt"]),
        (["x/a.csv", "y/a.csv"], ["a@x", "a@y"]),
        (["lib/a.csv", "lib/b.csv"], ["a@a", "a@b"]),
    ] {
        let of = [(&one, Path::new(files[0])), (&two, Path::new(files[1]))];
        assert_eq!(hadar_formats::spectra::unique_names(&of), due);
        let backwards = [of[1], of[0]];
        assert_eq!(hadar_formats::spectra::unique_names(&backwards), [due[1], due[0]]);
    }
    // A name that another one has by itself.
    let own = three.clone().with_name("a@csv");
    let of = [(&one, Path::new("lib/a.csv")), (&two, Path::new("lib/a.txt")), (&own, Path::new("lib/c.csv"))];
    assert_eq!(hadar_formats::spectra::unique_names(&of), ["a@csv", "a@txt", "a@csv-2"]);
}

/// Customary layouts as people write them by hand, each with three rows of the same spectrum.
#[test]
fn twenty_two_customary_layouts_are_read() {
    let layouts = [
        "wavelength_um,emissivity\n8,0.9\n10,0.8\n12.5,0.7\n",
        "wavelength (um),emissivity\n8,0.9\n10,0.8\n12.5,0.7\n",
        "Wavelength [µm],Emissivity\n8.0,0.90\n10.0,0.80\n12.5,0.70\n",
        "Wavelength (microns), Reflectance\n8, 0.1\n10, 0.2\n12.5, 0.3\n",
        "nm,emissivity\n8000,0.9\n10000,0.8\n12500,0.7\n",
        "wavelength_nm,reflectance_percent\n8000,10\n10000,20\n12500,30\n",
        "wavenumber [cm^-1],emissivity\n1250,0.9\n1000,0.8\n800,0.7\n",
        "cm-1,%R\n1250,10\n1000,20\n800,30\n",
        "Wavenumber (cm-1)\tReflectance (%)\n1250\t10\n1000\t20\n800\t30\n",
        "Wavenumber,Emissivity\n800,0.7\n1000,0.8\n1250,0.9\n",
        "frequency (THz),emissivity\n37.4740572500,0.9\n29.9792458,0.8\n23.98339664,0.7\n",
        "wavelength (um);reflectance (%)\n8;10\n10;20\n12,5;30\n",
        "Wavelength/µm;Emissivity/%\n8,0;90,0\n10,0;80,0\n12,5;70,0\n",
        "wavelength_um emissivity\n 8.0 0.9\n10.0 0.8\n12.5 0.7\n",
        "Wavelength (um)   Emissivity\n8.0   0.9\n10.0   0.8\n12.5   0.7\n",
        "# made by a program\n# wavelength_um emissivity\n8.0 0.9\n10.0 0.8\n12.5 0.7\n",
        "Sample: tile\nOperator: me\n\nwavelength (µm),emissivity\n8,0.9\n10,0.8\n12.5,0.7\n",
        "wavelength,reflectance\num,%\n8,10\n10,20\n12.5,30\n",
        "sep=;\r\n\"wavelength (um)\";\"emissivity\"\r\n\"8\";\"0,9\"\r\n\"10\";\"0,8\"\r\n\"12,5\";\"0,7\"\r\n",
        "wavelength_um,wavenumber_cm1,emissivity,emissivity_std\n8,1250,0.9,0.01\n10,1000,0.8,0.01\n12.5,800,0.7,0.01\n",
        ",wavelength_um,emissivity\n0,8,0.9\n1,10,0.8\n2,12.5,0.7\n",
        "λ (µm)\tε\r8\t0.9\r10\t0.8\r12.5\t0.7\r",
    ];
    assert_eq!(layouts.len(), 22);
    for text in layouts {
        let materials = hadar_formats::spectra::from_text(text, Path::new("My tile.csv"))
            .unwrap_or_else(|error| panic!("{error}: {text}"));
        assert_eq!((materials.len(), materials[0].name()), (1, "my-tile"), "{text}");
        let emissivity = materials[0].emissivity(&[1_249.999_999, 1000.0, 800.000_001]).unwrap();
        for (found, due) in emissivity.iter().zip([0.9, 0.8, 0.7]) {
            assert!((found - due).abs() < 1e-8, "{text}: {emissivity:?}");
        }
    }
}

/// Two samples of one name are two materials, by names that do not hang on the order of their files.
#[test]
fn measured_samples_have_short_names_of_their_own() {
    let Some(directory) = shared("ecostress") else { return };
    let read_all = |backwards: bool| {
        let mut files = hadar_formats::spectra::spectra_in(&directory).unwrap().files;
        if backwards {
            files.reverse();
        }
        let all: Vec<(Material, PathBuf)> = files
            .into_iter()
            .filter_map(|file| Some((hadar_formats::spectra::material(&file).ok()?, file)))
            .collect();
        let of: Vec<(&Material, &Path)> =
            all.iter().map(|(material, file)| (material, file.as_path())).collect();
        let mut names = hadar_formats::spectra::unique_names(&of);
        names.sort();
        names
    };
    let names = read_all(false);
    assert_eq!(names.len(), 100);
    assert!(names.iter().all(|name| name.len() <= 50), "{:?}", names.iter().max_by_key(|name| name.len()));
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
    assert!(names.contains(&"black-gloss-paint@0402uuupnt".to_owned()), "{names:?}");
    assert!(names.contains(&"distilled-water".to_owned()));
    assert_eq!(names, read_all(true));
}

/// A number with a decimal sign.
fn written(value: f64, decimal: char) -> String {
    format!("{value:.9}").replace('.', &decimal.to_string())
}

proptest! {
    #![proptest_config(hadar_testing::seeded(37, 300))]

    /// Any delimiter, decimal sign, unit and quantity of the same rows gives the same rows.
    #[test]
    fn any_layout_of_a_spectrum_gives_the_same_rows(
        rows in prop::collection::btree_map(710u32..1290, 0.001..0.999f64, 2..40),
        delimiter in prop::sample::select(vec![",", ";", "\t", "  ", " ", " , ", "|"]),
        comma in any::<bool>(),
        unit in prop::sample::select(vec![
            ("wavelength (um)", 0), ("Wavelength [µm]", 0), ("wavelength_um", 0), ("nm", 1), ("Wavelength (nm)", 1), ("wavelength (\u{3bc}m)", 0), ("wavelength (A)", 4),
            ("wavenumber [cm^-1]", 2), ("cm-1", 2), ("wavenumber_cm1", 2), ("Frequency (THz)", 3),
        ]),
        quantity in prop::sample::select(vec![
            ("emissivity", 0), ("Emissivity (%)", 1), ("reflectance", 2), ("%R", 3), ("Reflectance [%]", 3), ("reflectance_percent", 3),
        ]),
        newline in prop::sample::select(vec!["\n", "\r\n", "\r"]),
        header_in_comment in any::<bool>(),
    ) {
        let decimal = if comma && !delimiter.contains(',') { ',' } else { '.' };
        let comment = if header_in_comment { "# " } else { "" };
        let mut text = format!("{comment}{}{delimiter}{}{newline}", unit.0, quantity.0);
        for (&nu, &e) in &rows {
            let nu = f64::from(nu);
            let x = match unit.1 { 0 => 1e4 / nu, 1 => 1e7 / nu, 4 => 1e8 / nu, 2 => nu, _ => nu * 0.029_979_245_8 };
            let y = match quantity.1 { 0 => e, 1 => 100.0 * e, 2 => 1.0 - e, _ => 100.0 * (1.0 - e) };
            text.push_str(&format!("{}{delimiter}{}{newline}", written(x, decimal), written(y, decimal)));
        }
        let materials = hadar_formats::spectra::from_text(&text, Path::new("x.csv"));
        let materials = materials.unwrap_or_else(|error| panic!("{error}\n{text}"));
        prop_assert_eq!(materials.len(), 1);
        prop_assert_eq!(materials[0].rows(), rows.len());
        let (low, high) = materials[0].range_cm1().unwrap();
        for (&nu, &e) in &rows {
            let found = materials[0].emissivity(&[f64::from(nu).clamp(low, high)]).unwrap()[0];
            prop_assert!((found - e).abs() < 1e-6, "{} {} at {}: {}", e, found, nu, text);
        }
    }
}

#[test]
fn noise_is_cut_off_where_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("noisy.csv");
    let text = "wavenumber_cm1,paint,skin\n700,1.013,0.9\n709,nan,0.8\n718,0.9,\n727,0.8,0.75\n1000,-0.004,0.7\n1300,0.5,0.6\n";
    std::fs::write(&file, text).unwrap();
    let refused = |reading: &Reading| reading.file(&file).unwrap_err().to_string();
    let message = refused(&Reading::default());
    assert!(
        message.contains("noisy.csv:3: paint: `nan` is not a finite number") && message.contains("--clip 0"),
        "{message}"
    );
    let message = refused(&Reading::default().clipping(0.01).unwrap());
    assert!(message.contains("noisy.csv:2: paint") && message.contains("the clip of 0.01"), "{message}");
    let read = Reading::default().clipping(0.02).unwrap().file(&file).unwrap();
    assert_eq!(read[0].emissivity(&[700.0, 709.0, 1000.0]).unwrap(), [1.0, 0.95, 0.0]);
    let said = "2 rows outside 0 to 1 clipped, the worst by 0.013 at 700.0 cm^-1 (clip 0.02); 1 row without a number left \
                out, the widest gap from 700.0 to 718.0 cm^-1 is bridged";
    assert_eq!((read[0].warnings()[0].as_str(), read[0].provenance().note.as_str()), (said, said));
    assert_eq!((read[1].rows(), read[1].warnings().len()), (5, 1));
    std::fs::write(&file, text.replace("nan", "0.9").replace("0.9,\n", "0.9,0.9\n")).unwrap();
    assert!(refused(&Reading::default()).contains("`hadar materials import --clip 0.013` cuts it off"));
    assert!(Reading::default().clipping(0.2).is_err() && Reading::default().clipping(f64::NAN).is_err());
}

#[test]
fn what_is_beside_a_file_on_a_mac_is_passed_over_and_other_kinds_are_named() {
    use hadar::material::Library;
    use hadar_formats::ReadLibrary as _;
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("paint.csv"), "wavenumber_cm1,emissivity\n700,0.9\n1300,0.8\n").unwrap();
    std::fs::write(at("._paint.csv"), b"\0\x05\x16\x07\0\x02\0\0Mac OS X        \0\x02").unwrap();
    for strict in [false, true] {
        let mut library = Library::empty().strict(strict);
        library.add_directory(folder.path()).unwrap();
        assert_eq!(library.names().collect::<Vec<_>>(), ["paint"]);
        assert!(
            library
                .warnings()
                .iter()
                .any(|warning| warning.contains("._paint.csv: this is what macOS keeps")),
            "{:?}",
            library.warnings()
        );
    }
    let message = hadar_formats::spectra::from_file(&at("._paint.csv")).unwrap_err().to_string();
    assert!(message.contains("._paint.csv: this is what macOS keeps"), "{message}");
    std::fs::write(at("sheet.csv"), b"PK\x03\x04\x14\0\x06\0xl/worksheets/sheet1.xml").unwrap();
    let message = hadar_formats::spectra::from_file(&at("sheet.csv")).unwrap_err().to_string();
    assert!(message.contains("sheet.csv: this is an Excel workbook (.xlsx); save the sheet"), "{message}");
}
