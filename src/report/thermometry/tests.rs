use super::*;
use crate::material::Library;
use crate::scenario::Scenario;

fn result() -> (Study, Thermometry) {
    let text = "[target]\nmaterial = \"silicon-carbide\"\ntemperature = \"60 degC\"\n\
                [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
                [alternatives]\nmaterials = [\"aluminium\"]\n\
                [bands]\nstart = \"720 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"50 cm^-1\"\n\
                [camera]\npreset = \"nicolet-is50\"";
    let study = Study::new(&Scenario::from_toml(text, None).unwrap(), &Library::embedded().unwrap()).unwrap();
    let found = study.thermometry(&[350.0, 310.0], 50, 1, &|_, _| {}).unwrap();
    (study, found)
}

#[test]
fn every_row_fills_every_column() {
    let (study, found) = result();
    let csv = table(&found).to_csv().unwrap();
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert_eq!(columns, [39, 39, 39]);
    let names: Vec<String> =
        bundle(&study, &found, Path::new("out")).unwrap().names().map(str::to_owned).collect();
    for name in ["thermometry.csv", "temperature_error.png", "temperature_rmse.svg", "scenario.toml"] {
        assert!(names.iter().any(|found| found == name), "{name}: {names:?}");
    }
}

/// The plots show what the table says, by rising temperature.
#[test]
fn plots_are_the_numbers() {
    let (_, found) = result();
    let csv = rmse(&found).table.to_csv().unwrap();
    let second: Vec<f64> = csv.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap()).collect();
    let row = &found.rows[1];
    assert_eq!(second[0], 310.0);
    assert_eq!(second[1], 1e3 * row.lighting_known.bound_k.unwrap());
    assert_eq!(second[4], 1e3 * row.lighting_unknown.as_ref().unwrap().errors.rmse);
    let csv = errors(&found).table.to_csv().unwrap();
    let second: Vec<f64> = csv.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap()).collect();
    assert_eq!(second[4], row.fixed.errors.unwrap().bias);
}

#[test]
fn text_leads_with_the_answer() {
    let (_, found) = result();
    let text = text(&found);
    assert!(text.starts_with("nicolet-is50 reads silicon-carbide at 36.9 to 76.9 degC"), "{text}");
    assert!(text.contains("seed 1") && !text.contains("NaN"));
}
