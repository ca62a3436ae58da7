use super::*;

fn refused(text: &str, column: &str) -> String {
    of_text(text, column).unwrap_err().to_string()
}

/// Planck's law by wavelength, W m⁻² sr⁻¹ µm⁻¹, in its textbook form.
fn planck_per_um(um: f64, kelvin: f64) -> f64 {
    let (h, c, k) = (6.626_070_15e-34, 299_792_458.0, 1.380_649e-23);
    let metres = um * 1e-6;
    2.0 * h * c * c / metres.powi(5) / (h * c / (metres * k * kelvin)).exp_m1() * 1e-6
}

#[test]
fn one_sky_in_every_unit() {
    let due = [(800.0, 270.0), (1000.0, 260.0), (1250.0, 240.0)]
        .map(|(nu, kelvin)| (nu, photon_radiance(nu, kelvin)));
    let rows = |of: &dyn Fn(f64) -> f64| {
        let line =
            |(um, kelvin): &(f64, f64)| format!("{um},{},{}\n", of(planck_per_um(*um, *kelvin)), kelvin);
        [(12.5, 270.0), (10.0, 260.0), (8.0, 240.0)].iter().map(line).collect::<String>()
    };
    for (axis, unit, of) in [
        ("wavelength_um", "W m^-2 sr^-1 um^-1", &(|value: f64| value) as &dyn Fn(f64) -> f64),
        ("Wavelength [µm]", "microflick", &|value| 100.0 * value),
        ("wavelength (um)", "mW/(m2 sr nm)", &|value| value),
    ] {
        let text = format!("{axis},sky [{unit}],brightness temperature [K]\n{}", rows(of));
        for column in ["sky", "brightness temperature"] {
            for ((nu, value), (due_nu, due)) in of_text(&text, column).unwrap().iter().zip(due) {
                assert!(
                    (nu / due_nu - 1.0).abs() < 1e-12 && (value / due - 1.0).abs() < 1e-9,
                    "{unit} {column}: {value} {due}"
                );
            }
        }
    }
}

#[test]
fn what_is_no_radiance_is_refused() {
    let table = |header: &str, value: f64| format!("wavenumber_cm1,{header}\n800,{value}\n1200,{value}\n");
    for (header, value, column, part) in [
        ("sky [K]", 250.0, "sky", "line 1: sky: `K`, a temperature and no radiance"),
        ("sky (DN)", 250.0, "sky", "`DN` is no unit of spectral radiance"),
        ("brightness temperature", 250.0, "brightness temperature", "write `brightness temperature [K]`"),
        ("brightness temperature [K]", -1.0, "brightness temperature", "line 2: brightness temperature: "),
        (
            "sky",
            7.5,
            "sky",
            "sky: as photons s^-1 m^-2 sr^-1 per cm^-1 nothing in it is brighter than a blackbody of",
        ),
        ("sky [W m^-2 sr^-1 um^-1]", 7.5e9, "sky", "as bright as a blackbody"),
        ("sky", 1e18, "sky2", "there is no column `sky2`"),
        ("sky [microflick],sky [flick],a", 1.0, "sky", "2 columns called `sky`"),
    ] {
        let text = match header.contains(",a") {
            true => format!("wavenumber_cm1,{header}\n800,1,1,1\n1200,1,1,1\n"),
            false => table(header, value),
        };
        let message = refused(&text, column);
        assert!(message.contains(part), "{message}");
    }
    // Nothing at all is no unit.
    assert_eq!(of_text(&table("sky", 0.0), "sky").unwrap()[0], (800.0, 0.0));
}

const TAPE7: &str = "TMF 6    2    1    0    0\n  720  0  0\n   800.000  1000.000\n\
    FREQ  TOT_TRANS  PTH_THRML  THRML_SCT  SURF_EMIS   SOL_SCAT  SING_SCAT  GRND_RFLT  DRCT_RFLT  TOTAL_RAD  REF_SOL  SOL@OBS   DEPTH DIR_EM    TOA_SUN BBODY_T[K]\n\
    800.00 0.50000000 6.0000E-06 0.0000E+00 0.0000E+00 0.0000E+00 0.7000E-05 0.693 0.5 270.0\n\
    1000.0 0.60000000 4.0000E-06 0.0000E+00 0.0000E+00 0.0000E+00 0.4000E-05 0.511 0.4 262.0\n -9999.\n";

#[test]
fn tape7_is_in_watts_per_square_centimetre() {
    let unit = RadianceUnit::spelt("W m^-2 sr^-1 per cm^-1").unwrap();
    let total = of_text(TAPE7, "TOTAL_RAD").unwrap();
    for ((nu, value), (due_nu, due)) in total.iter().zip([(800.0, 0.07), (1000.0, 0.04)]) {
        assert!(
            (value / (due * unit.photons_per_cm1(*nu)) - 1.0).abs() < 1e-12 && *nu == due_nu,
            "{total:?}"
        );
    }
    assert_eq!(of_text(TAPE7, "BBODY_T[K]").unwrap()[0], (800.0, photon_radiance(800.0, 270.0)));
    // Names of two words, all columns filled.
    let old = "  FREQ   TOT TRANS  PTH THRML  THRML SCT  SURF EMIS   SOL SCAT  SING SCAT  GRND RFLT  DRCT RFLT  TOTAL RAD  REF SOL  SOL@OBS   DEPTH\n\
               800. .5 6e-6 0 0 0 0 0 0 7e-6 0 0 .7\n1000. .6 4e-6 0 0 0 0 0 0 4e-6 0 0 .5\n-9999.\n";
    assert_eq!(of_text(old, "TOTAL_RAD").unwrap(), total);
    for (text, column, part) in [
        (TAPE7.to_owned(), "TOT_TRANS", "line 4: the column `TOT_TRANS` of MODTRAN, which is no radiance"),
        (TAPE7.to_owned(), "SOL_SCAT", "line 5: `SOL_SCAT` is empty in a run without the sun"),
        (TAPE7.to_owned(), "TOTAL", "there is no column `TOTAL`; the nearest are `TOTAL_RAD`"),
        (TAPE7.replace(" -9999.\n", ""), "TOTAL_RAD", "the row of -9999"),
        (TAPE7.replace(" 0.4 262.0", ""), "TOTAL_RAD", "line 6: 8 numbers where 10 columns are named"),
        (format!("{TAPE7}{TAPE7}"), "TOTAL_RAD", "another run begins on line 11"),
        (TAPE7.replace("FREQ ", "WAVLEN(NM) "), "TOTAL_RAD", "whose unit the file does not say"),
        (TAPE7.replace("FREQ ", "FREQ LOS "), "TOTAL_RAD", "several lines of sight"),
    ] {
        let message = refused(&text, column);
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn text_of_lblrtm_is_read_and_its_records_are_named() {
    let unit = RadianceUnit::spelt("W m^-2 sr^-1 per cm^-1").unwrap();
    let text = "1 sky of a summer's day\n V1 = 800\n0     WAVENUMBER          RADIANCE  \n\n   800.0000   7.0000E-06\n  1000.0000   4.0000E-06\n";
    let sky = of_text(text, "RADIANCE").unwrap();
    assert!((sky[0].1 / (0.07 * unit.photons_per_cm1(800.0)) - 1.0).abs() < 1e-12, "{sky:?}");
    let warm = text
        .replace("   RADIANCE", "TEMPERATURE")
        .replace("7.0000E-06", "270.0")
        .replace("4.0000E-06", "262.0");
    assert_eq!(of_text(&warm, "TEMPERATURE").unwrap()[0], (800.0, photon_radiance(800.0, 270.0)));
    assert!(
        refused(&text.replace("RADIANCE", "TRANSMISSION"), "RADIANCE").contains("`TRANSMISSION` of LBLRTM")
    );
    assert!(refused(text, "sky").contains("there is no column `sky`"));
    let record = [&16_u32.to_le_bytes()[..], &[7; 16], &16_u32.to_le_bytes()].concat();
    assert!(simulated::refuse_unformatted(&record).unwrap_err().to_string().contains("TAPE12"));
    assert!(simulated::refuse_unformatted(b"wavenumber_cm1,sky\n").is_ok());
}

/// What MODTRAN 6 writes with commas has no public description: no layout of it is taken for a table.
#[test]
fn a_table_of_modtran_6_with_commas_is_named() {
    let rows = "700,.5,8.7e-6,1e-6\n710,.5,8.6e-6,1e-6\n-9999.\n";
    for above in ["", "MODTRAN6.0\n\nRadiance\n"] {
        for names in [
            "freq,path trans,path emiss,total rad",
            "FREQ,TOT_TRANS,PTH_THRML,TOTAL_RAD",
            "Freq, path-trans, path-emiss, total-rad",
        ] {
            let text = format!("{above}{names}\n{rows}");
            for column in ["total rad", "TOTAL_RAD", "freq"] {
                let refused = refused(&text, column);
                assert!(refused.contains("MODTRAN 6") && refused.contains(".tp7"), "{refused}");
            }
            assert_eq!(simulated::program(&text), Some("MODTRAN"));
        }
    }
    // A table of one's own with a frequency is none.
    assert!(!refused("frequency,sky\n1,2\n", "sky").contains("MODTRAN"));
}

#[test]
fn the_air_of_one_path_is_no_table_of_lengths() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("air.tp7");
    std::fs::write(&file, TAPE7).unwrap();
    let message = atmosphere(&file).unwrap_err().to_string();
    assert!(
        message.contains("air.tp7: this is what MODTRAN writes of one path") && message.contains("tau_1km"),
        "{message}"
    );
    std::fs::write(&file, "wavenumber_cm1,tau_10m,tau_1km\n700,0.9,0.2\n1300,0.95,0.4\n").unwrap();
    assert_eq!(atmosphere(&file).unwrap().range_cm1(), (700.0, 1300.0));
}

proptest::proptest! {
    #![proptest_config(hadar_testing::seeded(46, 256))]

    #[test]
    fn no_text_makes_the_reader_panic(cut in 0_usize..700, body in "[0-9A-Z_.,\\[\\] ()eE+\n-]{0,80}") {
        for text in [format!("{}{body}", &TAPE7[..cut.min(TAPE7.len())]), format!("wavenumber_cm1,sky [{body}"), body] {
            for column in ["TOTAL_RAD", "sky", ""] {
                drop(of_text(&text, column));
            }
        }
    }
}
