use super::*;
use hadar::material::Library;
use hadar_scenario::Scenario;
use hadar_simulate::efficiency::Verdict;

fn study(target: &str, extra: &str, camera: &str) -> Study {
    let text = format!(
        "[target]\nmaterial = \"{target}\"\ntemperature = \"60 degC\"\n\
         [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
         [alternatives]\nmaterials = [\"aluminium\"]\n\
         [bands]\nstart = \"720 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"10 cm^-1\"\n{extra}\n{camera}"
    );
    Study::new(&Scenario::from_toml(&text, None).unwrap(), &Library::embedded().unwrap()).unwrap()
}

const SPECTROMETER: &str = "[camera]\npreset = \"nicolet-is50\"\nframes = 10";

/// Where many photons tell lighting and temperature apart, maximum likelihood has the bound's variance, within 4.5 of
/// its deviations (7e-6 for each of the four), and thermal imaging is off by what no number of photons mends.
#[test]
fn a_reflecting_target_is_read_as_precisely_as_photons_allow() {
    let study = study("silicon-carbide", "", SPECTROMETER);
    let trials = 4000;
    let found = study.thermometry(&[303.15, 363.15], trials, 2, &|_, _| {}).unwrap();
    let within = 4.5 * (2.0 / trials as f64).sqrt();
    for row in &found.rows {
        let unknown = row.lighting_unknown.as_ref().unwrap();
        for reader in [&row.lighting_known, unknown] {
            let efficiency = reader.efficiency.unwrap();
            assert!((efficiency.ratio - 1.0).abs() < within, "{efficiency:?}");
            assert!(matches!(efficiency.verdict, Verdict::Reaches | Verdict::Undecided), "{efficiency:?}");
            assert!(
                reader.bound_applies
                    && reader.at_edge == 0.0
                    && reader.unconverged == 0
                    && reader.bound_relative_error < 1e-9
            );
            let joint = reader.joint.unwrap();
            assert!((joint.ratio - 1.0).abs() < within, "{joint:?}");
        }
        let (known, unknown) = (row.lighting_known.bound_k.unwrap(), unknown.bound_k.unwrap());
        let range = row.bound_range_k.unwrap();
        assert!(known < range && range < unknown, "{known} {range} {unknown}");
    }
    let bias = |i: usize| found.rows[i].manual.errors.unwrap().bias;
    assert!(bias(0).abs() < 0.2 && bias(1) < -3.0, "{} {}", bias(0), bias(1));
    assert!(found.rows.iter().all(|row| row.fixed.errors.unwrap().bias < -3.0));
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    assert_eq!((found.calibrated_k, found.statistics), (303.15, "gaussian"));
}

/// The bolometer cannot see the lighting of skin: the range holds the fits, and that is said.
#[test]
fn where_the_range_tells_more_than_the_camera_it_is_said() {
    let found = study("skin", "", "[camera]\npreset = \"flir-a325sc\"")
        .thermometry(&[310.15], 500, 3, &|_, _| {})
        .unwrap();
    let unknown = found.rows[0].lighting_unknown.as_ref().unwrap();
    assert!(unknown.at_edge > 0.3 && unknown.efficiency.unwrap().verdict == Verdict::Below, "{unknown:?}");
    assert!(!unknown.bound_applies && found.rows[0].lighting_known.bound_applies);
    assert!(found.warnings.iter().any(|warning| matches!(warning, Warning::RangeHoldsTheEstimates { .. })));
    // The hybrid bound is for errors averaged over the range; at the middle of it this estimate errs more, too.
    assert!(unknown.errors.rmse > found.rows[0].bound_range_k.unwrap());
}

/// A prior of the scenario counts, known surroundings stay known, and a scene without any has nothing to light it.
#[test]
fn unknowns_are_the_scenario_s() {
    let prior = "[unknown]\nnuisances = [\"lighting\", \"gain\"]\npriors = { lighting = \"0.01\" }";
    let prior = prior.replace("\"0.01\"", "0.01");
    let with = study("silicon-carbide", &prior, SPECTROMETER);
    let known = with.thermometry_unknowns(false).unwrap();
    let unknown = with.lighting_unknown().unwrap().unwrap();
    assert_eq!(known.nuisances(), [Nuisance::Temperature, Nuisance::Gain]);
    assert_eq!(unknown.nuisances(), [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain]);
    assert_eq!(unknown.sigma_prior(Parameter::Lighting(0)), Some(0.01));
    assert!(!known.has_priors());
    let found = with.thermometry(&[350.0], 2, 1, &|_, _| {}).unwrap();
    assert_eq!(found.unknown, ["temperature", "lighting", "gain"]);
    assert_eq!(found.priors, BTreeMap::from([("lighting", 0.01)]));
    // The law of the range times that of the prior is neither.
    assert_eq!(found.rows[0].bound_range_k, None);
}

/// Where the scenario knows the lighting there is one reader, whose fits are those of the other scenario's.
#[test]
fn known_lighting_is_not_read_as_unknown() {
    let read = |nuisances: &str| {
        let unknown = format!("[unknown]\nnuisances = [{nuisances}]");
        study("silicon-carbide", &unknown, SPECTROMETER).thermometry(&[350.0], 50, 1, &|_, _| {}).unwrap()
    };
    let both = read("\"temperature\", \"lighting\"");
    assert_eq!((both.criteria.together, both.unknown.len()), (2, 2));
    for nuisances in ["", "\"temperature\""] {
        let found = read(nuisances);
        assert_eq!(found.unknown, ["temperature"]);
        assert_eq!((found.criteria.together, found.rows[0].bound_range_k), (1, None));
        assert!(found.rows[0].lighting_unknown.is_none());
        assert_eq!(found.rows[0].lighting_known.errors, both.rows[0].lighting_known.errors);
    }
}

#[test]
fn what_cannot_be_read_is_refused() {
    let with = study("silicon-carbide", "", SPECTROMETER);
    assert!(study("silicon-carbide", "", "").thermometry(&[300.0], 10, 1, &|_, _| {}).is_err());
    for (temperatures, trials) in
        [(&[][..], 10), (&[-1.0], 10), (&[300.0], 1), (&[f64::NAN], 10), (&[2e6], 10)]
    {
        assert!(with.thermometry(temperatures, trials, 1, &|_, _| {}).is_err(), "{temperatures:?}");
    }
    let one = with.thermometry(&[300.0], 1, 1, &|_, _| {}).unwrap_err().to_string();
    assert_eq!(one, "spectra at each temperature is 1; it must be at least 2");
}
