use crate::simulate::thermometry::*;
use hadar::fisher::precision::Sight;
use hadar::material::Library;
use hadar_scenario::Scenario;

fn read(target: &str, unknown: &str, camera: &str, trials: usize) -> (Study, Thermometry) {
    let text = format!(
        "[target]\nmaterial = \"{target}\"\ntemperature = \"60 degC\"\n\
         [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
         [alternatives]\nmaterials = [\"aluminium\"]\n\
         [bands]\nstart = \"720 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"50 cm^-1\"\n{unknown}\n\
         [camera]\npreset = \"{camera}\""
    );
    let study =
        Study::new(&Scenario::from_toml(&text, None).unwrap(), &Library::embedded().unwrap()).unwrap();
    let found = study.thermometry(&[350.0, 310.0], trials, 1, &|_, _| {}).unwrap();
    (study, found)
}

fn result() -> (Study, Thermometry) {
    read("silicon-carbide", "", "nicolet-is50", 50)
}

#[test]
fn every_row_fills_every_column() {
    let (study, found) = result();
    let csv = table(&found).to_csv().unwrap();
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert_eq!(columns, [39, 39, 39]);
    let names: Vec<String> = bundle(&study, &found).unwrap().names().map(str::to_owned).collect();
    for name in ["thermometry.csv", "temperature_error.png", "temperature_rmse.svg", "scenario.toml"] {
        assert!(names.iter().any(|found| found == name), "{name}: {names:?}");
    }
}

/// The plots show what the table says, by rising temperature.
#[test]
fn plots_are_the_numbers() {
    let (_, found) = result();
    let csv = rmse(&found).table.to_csv().unwrap();
    let second: Vec<f64> =
        csv.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap_or(f64::NAN)).collect();
    let row = &found.rows[1];
    assert_eq!(second[0], 310.0);
    assert_eq!(second[1], row.lighting_known.bound_k.unwrap());
    assert_eq!(second[4], row.lighting_unknown.as_ref().unwrap().errors.rmse);
    let csv = errors(&found).table.to_csv().unwrap();
    let second: Vec<f64> =
        csv.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap_or(f64::NAN)).collect();
    assert_eq!(second[4], row.fixed.errors.unwrap().bias);
}

#[test]
fn text_leads_with_the_answer() {
    let (_, found) = result();
    let text = text(&found);
    assert!(text.starts_with("nicolet-is50 reads silicon-carbide at 36.9 to 76.9 degC"), "{text}");
    assert!(text.contains("seed 1") && !text.contains("NaN"));
}

/// What is known and unknown is the scenario's, and priors are named.
#[test]
fn text_knows_what_is_known() {
    let assumed = |unknown: &str| {
        let text = text(&read("silicon-carbide", unknown, "nicolet-is50", 2).1);
        assert!(!text.contains("-0 ") && !text.contains("-0.00"), "{text}");
        text
    };
    let all = assumed("");
    assert!(
        all.contains("known: emissivity, temperature of the surroundings and the camera's response; unknown: temperature, lighting\n"),
        "{all}"
    );
    let known = assumed("[unknown]\nnuisances = []");
    assert!(known.contains(", its lighting known,") && !known.contains("lighting unknown"), "{known}");
    assert!(
        known.contains("surroundings, lighting and the camera's response; unknown: temperature\n"),
        "{known}"
    );
    let gain = "[unknown]\nnuisances = [\"temperature\", \"gain\"]\npriors = { gain = 0.02 }";
    let gain = assumed(gain);
    assert!(
        gain.contains(
            "known: emissivity, temperature of the surroundings and lighting; unknown: temperature, gain\n"
        ),
        "{gain}"
    );
    assert!(gain.contains("which lowers the bound: gain to +- 0.02 ("), "{gain}");
}

/// Fits that the range stops are said to be, with their share, and only they have the bound averaged over it.
#[test]
fn held_fits_are_said_to_be() {
    let (_, held) = read("skin", "", "flir-a325sc", 100);
    let told = text(&held);
    assert!(
        told.contains(": the range of the lighting stops ")
            && told.contains(" % of the fits at 2 of 2 temper"),
        "{told}"
    );
    assert!(!told.contains("that bound"), "{told}");
    let sixth = |found: &Thermometry| {
        let csv = rmse(found).table.to_csv().unwrap();
        csv.lines().nth(1).unwrap().split(',').nth(5).unwrap().to_owned()
    };
    assert!(sixth(&held).parse::<f64>().is_ok_and(|k| k > 0.0));
    assert!(sixth(&result().1).parse::<f64>().map_or(true, f64::is_nan));
}

/// Where no reader sees the temperature, no error is given as if one did.
#[test]
fn nothing_seen_is_nothing_read() {
    let (_, mut found) = result();
    for row in &mut found.rows {
        for reader in std::iter::once(&mut row.lighting_known).chain(&mut row.lighting_unknown) {
            (reader.sight, reader.bound_k, reader.efficiency) = (Sight::Imitated, None, None);
        }
    }
    let told = text(&found);
    assert!(
        told.starts_with("A spectrum in these bands holds no information on the temperature. The other"),
        "{told}"
    );
    assert!(!told.contains(" reads "), "{told}");
}
