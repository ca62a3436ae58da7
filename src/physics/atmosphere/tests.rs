use super::*;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Rows of an embedded table, read without the library.
fn columns(name: &str) -> (Vec<f64>, Vec<Vec<f64>>) {
    let table = embedded::TABLES.iter().find(|table| table.name == name).unwrap();
    let rows = table.text.lines().filter(|line| !line.starts_with(['#', 'w']));
    rows.map(|row| {
        let mut cells = row.split(',').map(|cell| cell.parse::<f64>().unwrap());
        (cells.next().unwrap(), cells.collect())
    })
    .unzip()
}

const LENGTHS_M: [f64; 7] = [10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4];

fn table(lengths_m: &[f64], rows: &[(f64, Vec<f64>)]) -> Result<Atmosphere> {
    let mut text = "wavenumber_cm1".to_owned();
    lengths_m.iter().for_each(|length| text += &format!(",tau_{length}m"));
    for (wavenumber, taus) in rows {
        text += &format!("\n{wavenumber}");
        taus.iter().for_each(|tau| text += &format!(",{tau}"));
    }
    Atmosphere::from_csv(&text, Path::new("a.csv"))
}

#[test]
fn columns_are_hit_and_names_and_heads_agree() {
    for (embedded, name) in embedded::TABLES.iter().zip(Atmosphere::names()) {
        assert_eq!(embedded.name, *name);
        assert!(embedded.text.contains(&format!("T={} K", embedded.temperature_k)), "{name}");
        let air = Atmosphere::embedded(name).unwrap();
        let stated = (air.name(), air.temperature_k(), air.range_cm1(), air.longest_m());
        assert_eq!(stated, (*name, Some(embedded.temperature_k), (700.0, 1350.0), 1e4));
        let (nodes, rows) = columns(name);
        assert_eq!(nodes.len(), 131);
        for (column, length) in LENGTHS_M.into_iter().enumerate() {
            let found = air.transmittance(&nodes, length).unwrap();
            for (tau, row) in found.iter().zip(&rows) {
                // e to a logarithm of at most 12 loses 12 ulp; a 0 stands for less than half its last digit.
                let allowed = if row[column] == 0.0 { 5e-6 } else { 4e-15 * row[column] };
                assert!((tau - row[column]).abs() <= allowed, "{name} {length}: {tau} {}", row[column]);
            }
        }
        assert!(air.transmittance(&nodes, 0.0).unwrap().iter().all(|&tau| tau == 1.0));
    }
    // Three numbers off the printed table, and the depth half-way between two rows.
    let air = Atmosphere::embedded("us-standard").unwrap();
    let near = |nodes: &[f64], length: f64, expected: f64| {
        let found = air.transmittance(nodes, length).unwrap()[0];
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    };
    near(&[700.0], 10.0, 0.798_80);
    near(&[785.0], 3000.0, 0.549_45);
    near(&[1e4 / (1e4 / 770.0)], 1000.0, 0.746_70);
    near(&[772.5], 1000.0, (0.746_70f64 * 0.764_86).sqrt());
}

/// The parabola of ln z through three distances misses τ by no more than is said, and by a good part of that somewhere.
#[test]
fn the_sag_between_two_distances_bounds_what_a_parabola_misses() {
    let nodes: Vec<f64> = (0..261).map(|i| 700.0 + 2.5 * f64::from(i)).collect();
    for name in Atmosphere::names() {
        let air = Atmosphere::embedded(name).unwrap();
        for [near, far] in
            [[1.0, 1.3], [8.0, 10.0], [10.0, 30.0], [30.0, 33.0], [250.0, 300.0], [2e3, 2.01e3], [9e3, 1e4]]
        {
            let sag = air.sag(&nodes, [near, far]).unwrap();
            let at = |share: f64| air.transmittance(&nodes, near * (far / near).powf(share)).unwrap();
            let [from, middle, to] = [0.0, 0.5, 1.0].map(at);
            let mut most = vec![0.0f64; nodes.len()];
            for step in 1..40 {
                let share = f64::from(step) / 40.0;
                for (j, (tau, most)) in at(share).into_iter().zip(&mut most).enumerate() {
                    let control = 2.0 * middle[j] - 0.5 * (from[j] + to[j]);
                    let left = 1.0 - share;
                    let line = left * left * from[j] + 2.0 * share * left * control + share * share * to[j];
                    *most = most.max((tau - line).abs());
                }
            }
            for (j, (most, sag)) in most.iter().zip(&sag).enumerate() {
                assert!(most <= sag, "{name} {near}..{far} {}: {most:e} {sag:e}", nodes[j]);
            }
            // Terms of other signs are not taken off each other.
            let total = |x: &[f64]| x.iter().sum::<f64>() - 1e-15 * x.len() as f64;
            let (found, said) = (total(&most), total(&sag));
            assert!(found > 0.02 * said, "{name} {near}..{far}: {found:e} {said:e}");
        }
        // Beyond a column slopes may break: what τ falls by.
        let [sag, from, to] =
            [air.sag(&nodes, [9.0, 12.0]), air.transmittance(&nodes, 9.0), air.transmittance(&nodes, 12.0)]
                .map(Result::unwrap);
        assert!((0..nodes.len()).all(|j| (sag[j] - 1.5 * (from[j] - to[j])).abs() < 1e-15));
    }
}

/// What the head of the module states: every column from the others.
#[test]
fn a_column_left_out_is_found_again_within_the_stated_error() {
    let (mut inside, mut below) = (0.0f64, 0.0f64);
    for name in Atmosphere::names() {
        let (nodes, rows) = columns(name);
        for out in 0..LENGTHS_M.len() - 1 {
            let kept = |values: &[f64]| -> Vec<f64> {
                values.iter().enumerate().filter(|(i, _)| *i != out).map(|(_, value)| *value).collect()
            };
            let rest: Vec<_> = nodes.iter().zip(&rows).map(|(node, row)| (*node, kept(row))).collect();
            let air = table(&kept(&LENGTHS_M), &rest).unwrap();
            let found = air.transmittance(&nodes, LENGTHS_M[out]).unwrap();
            let worst = found.iter().zip(&rows).map(|(tau, row)| (tau - row[out]).abs()).fold(0.0, f64::max);
            let measured = if out == 0 { &mut below } else { &mut inside };
            *measured = measured.max(worst);
        }
    }
    assert!((inside - 0.0040).abs() < 5e-5, "{inside}");
    assert!((below - 0.0027).abs() < 5e-5, "{below}");
}

/// A band model of two power laws, from its values at the columns.
#[test]
fn a_band_model_is_followed_between_its_columns() {
    let tau = |strength: f64, power: f64, continuum: f64, length: f64| {
        (-(strength * length).powf(power) - continuum * length).exp()
    };
    let mut worst = 0.0f64;
    for strength in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
        for (power, continuum) in [(0.5, 1e-5), (0.55, 1e-4), (0.65, 3e-4), (0.8, 1e-6)] {
            let row = LENGTHS_M.map(|length| tau(strength, power, continuum, length)).to_vec();
            let air = table(&LENGTHS_M, &[(700.0, row.clone()), (800.0, row)]).unwrap();
            for step in 0..=300 {
                let length = 10f64.powf(1.0 + f64::from(step) / 100.0);
                let found = air.transmittance(&[750.0], length).unwrap()[0];
                worst = worst.max((found - tau(strength, power, continuum, length)).abs());
            }
        }
    }
    assert!(worst < 5e-4, "{worst}");
}

#[test]
fn gray_air_follows_beers_law_at_any_length() {
    // Any cubic of ln D in ln z keeps a straight line, also below the first column.
    let k = 3.7e-4;
    let row = LENGTHS_M.map(|length| (-k * length).exp()).to_vec();
    let air = table(&LENGTHS_M, &[(1200.0, row.clone()), (700.0, row)]).unwrap();
    for length in [1e-9, 0.3, 5.0, 17.0, 30.0, 64.0, 999.0, 5e3, 1e4] {
        let depth = air.optical_depth(&[700.0, 801.3, 1200.0], length).unwrap();
        // D of the first column has lost 1e-16/D = 3e-14, and the slope there as much.
        for depth in depth {
            assert!((depth / (k * length) - 1.0).abs() < 1e-11, "{length} {depth}");
        }
    }
    let short = air.path_radiance(&[1000.0], 1e-9, 290.0).unwrap()[0];
    let expected = k * 1e-9 * planck::photon_radiance(1000.0, 290.0);
    assert!((short / expected - 1.0).abs() < 1e-11, "1 - tau is 4e-13 and has all its digits");
    // Where all is absorbed, the path is a blackbody.
    let us = Atmosphere::embedded("us-standard").unwrap();
    let fog = us.path_radiance(&[700.0], 1e4, 288.2).unwrap()[0];
    assert!((fog / planck::photon_radiance(700.0, 288.2) - 1.0).abs() < 1e-5);
}

#[test]
fn the_growth_is_that_of_the_interpolation() {
    // Beer's law: ∂D/∂z = k at any length, below the first column too.
    let k = 3.7e-4;
    let row = LENGTHS_M.map(|length| (-k * length).exp()).to_vec();
    let beer = table(&LENGTHS_M, &[(1200.0, row.clone()), (700.0, row)]).unwrap();
    for length in [0.3, 10.0, 17.0, 100.0, 999.0, 1e4] {
        for growth in beer.optical_depth_and_growth(&[700.0, 801.3], length).unwrap().1 {
            assert!((growth / k - 1.0).abs() < 1e-11, "{length} {growth}");
        }
    }
    // Differences of the depth itself, at and between columns; h² of them is left.
    let nodes: Vec<f64> = (0..261).map(|i| 700.0 + 2.5 * f64::from(i)).collect();
    for name in Atmosphere::names() {
        let air = Atmosphere::embedded(name).unwrap();
        for length in [3.0, 15.0, 30.0, 77.0, 100.0, 640.0, 3e3, 8e3] {
            let h = 1e-4 * length;
            let at = |z: f64| air.optical_depth(&nodes, z).unwrap();
            let (depth, growth) = air.optical_depth_and_growth(&nodes, length).unwrap();
            assert_eq!(depth, at(length));
            for ((growth, high), low) in growth.iter().zip(at(length + h)).zip(at(length - h)) {
                let slope = (high - low) / (2.0 * h);
                // At a column the cubics' bends differ: h of them is left, and there the slope may be 0.
                assert!((growth - slope).abs() <= 1e-3 * slope + 1e-12, "{name} {length}: {growth} {slope}");
            }
        }
    }
    assert!(beer.optical_depth_and_growth(&[700.0], 0.0).is_err());
}

#[test]
fn digits_that_are_not_there_are_no_infinities() {
    let row = |taus: [f64; 4]| {
        let air =
            table(&[1.0, 10.0, 100.0, 1000.0], &[(700.0, taus.to_vec()), (701.0, taus.to_vec())]).unwrap();
        [0.1, 1.0, 5.0, 10.0, 50.0, 100.0, 500.0, 1e3].map(|z| air.optical_depth(&[700.5], z).unwrap()[0])
    };
    assert_eq!(row([1.0; 4]), [0.0; 8], "a vacuum");
    for taus in
        [[0.0; 4], [1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.5, 0.0], [1.0, 1.0, 1.0, 0.99999], [0.9, 0.9, 0.9, 0.9]]
    {
        let depths = row(taus);
        assert!(depths.iter().all(|d| d.is_finite() && *d > 0.0), "{taus:?}: {depths:?}");
        assert!(depths.windows(2).all(|pair| pair[0] <= pair[1]), "{taus:?}: {depths:?}");
    }
    // Beer's law back from D = 0.69 at 100 m would show in the digits at 10 m: they allow at most 5e-6, and then
    // a tenth of it. Forward, it would show less than the 12.2 that a 0 stands for.
    let found = row([1.0, 1.0, 0.5, 0.0]);
    for (at, expected) in [(1, 5e-7), (3, 5e-6), (5, std::f64::consts::LN_2), (7, 2e5f64.ln())] {
        assert!((found[at] / expected - 1.0).abs() < 1e-12, "{at}: {found:?}");
    }
}

#[test]
fn what_is_outside_the_table_is_named() {
    let air = Atmosphere::embedded("tropical").unwrap();
    let error = |nodes: &[f64], length: f64| air.transmittance(nodes, length).unwrap_err().to_string();
    assert_eq!(
        error(&[800.0, 1400.0], 10.0),
        "wavenumber is 1400 cm^-1; it must be from 700 to 1350 cm^-1, where the air of `tropical` is known; \
         narrow the bands"
    );
    assert!(error(&[f64::NAN], 10.0).starts_with("wavenumber is NaN"));
    assert_eq!(
        error(&[800.0], 2e4),
        "distance is 20000 m; it must be at most 10000 m, the longest path in the air of `tropical`"
    );
    assert!(error(&[800.0], -1.0).contains("0 or above") && error(&[800.0], f64::NAN).contains("finite"));
    assert!(air.path_radiance(&[800.0], 10.0, 0.0).is_err());
    assert_eq!(
        Atmosphere::embedded("us standard").unwrap_err().to_string(),
        "there is no model atmosphere `us standard`; did you mean `us-standard`?"
    );
}

#[test]
fn bad_tables_are_refused_with_their_place() {
    let error = |text: &str| Atmosphere::from_csv(text, Path::new("a.csv")).unwrap_err().to_string();
    let head = "wavenumber_cm1,tau_10m,tau_0.1km\n";
    for (text, message) in [
        ("wavelength_um,tau_10m,tau_1km\n8,1,1\n", "a.csv:1: the first column is `wavelength_um`"),
        ("wavenumber_cm1,tau_10,tau_1km\n8,1,1\n", "a.csv:1: tau_10: a column `tau_10`"),
        ("wavenumber_cm1,tau_0m,tau_1km\n8,1,1\n", "a.csv:1: tau_0m: length of the path is 0 m"),
        ("wavenumber_cm1,tau_100m,tau_0.1km\n8,1,1\n", "a.csv:1: the length 100 m is there twice"),
        ("wavenumber_cm1,tau_100m\n8,1\n9,1\n", "a.csv:1: there is one path length"),
        (&format!("{head}700,0.5,0.6\n"), "a.csv:2: tau_0.1km: the transmittance 0.6 is above the 0.5"),
        (
            &format!("{head}700,1.5,0.6\n"),
            "a.csv:2: tau_10m: transmittance is 1.5; it must be between 0 and 1",
        ),
        (&format!("{head}-1,0.5,0.4\n"), "a.csv:2: wavenumber is -1 cm^-1"),
        (&format!("{head}700,0.5,0.4\n"), "a.csv: 1 rows; a spectrum needs at least 2 rows"),
        (&format!("{head}700,0.5,0.4\n700,0.5,0.4\n"), "a.csv: the wavenumber 700 cm^-1 is there twice"),
        ("", "a.csv: the file has no rows"),
    ] {
        assert!(error(text).starts_with(message), "{}", error(text));
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..Default::default()
    })]

    /// Any table that falls with length, zeros and ones among it, five digits or all.
    #[test]
    fn transmittance_never_rises_with_distance(
        mut taus in proptest::collection::vec(prop_oneof![0.0..=1.0f64, Just(0.0), Just(1.0), 0.999..=1.0f64], 2..7),
        mut gaps in proptest::collection::vec(1e-3..5.0f64, 7),
        digits in any::<bool>(),
        mut at in proptest::collection::vec(-8.0..1.0f64, 30),
        share in 0.0..=1.0f64,
    ) {
        taus.sort_by(|a, b| b.total_cmp(a));
        if digits {
            taus.iter_mut().for_each(|tau| *tau = (*tau * 1e5).round() / 1e5);
        }
        gaps.truncate(taus.len());
        let mut ln = 0.0;
        let lengths: Vec<f64> = gaps.iter().map(|gap| { ln += gap; f64::exp(ln) }).collect();
        let other: Vec<f64> = taus.iter().map(|tau| tau * tau).collect();
        let air = table(&lengths, &[(700.0, taus.clone()), (710.0, other)]).unwrap();
        let longest = air.longest_m();
        at.sort_by(f64::total_cmp);
        let mut last = 1.0;
        for z in at.into_iter().map(|at| (longest * at.exp()).min(longest)).chain([longest]) {
            let tau = air.transmittance(&[700.0 + 10.0 * share], z).unwrap()[0];
            // D keeps 1e-15 of itself, and x e^-x is at most 1/e.
            prop_assert!((0.0..=1.0).contains(&tau) && tau <= last + 1e-14, "{z}: {tau} after {last}");
            last = tau;
        }
        for pair in lengths.windows(2) {
            let [near, far] = [0.25, 0.75].map(|x: f64| pair[0] * (pair[1] / pair[0]).powf(x * share));
            let node = [700.0 + 10.0 * share];
            let tau = |z: f64| air.transmittance(&node, z).unwrap()[0];
            let sag = air.sag(&node, [near, far]).unwrap()[0];
            let share = |x: f64| tau(near * (far / near).powf(x));
            let off = share(0.25) - 0.375 * share(0.0) - 0.75 * share(0.5) + 0.125 * share(1.0);
            prop_assert!(off.abs() <= sag + 1e-14, "{near} to {far}: {off:e} {sag:e}");
        }
    }

    #[test]
    fn any_text_gives_a_table_or_one_line(
        head in proptest::sample::select(vec!["wavenumber_cm1,tau_1m,tau_2km", "wavenumber_cm1,tau_3m", "x,y", ""]),
        cells in proptest::collection::vec(
            prop_oneof!["[0-9]{1,3}", "0?\\.[0-9]{1,6}", "-?[0-9]e-?[0-9]{1,3}", "[01]", "nan|inf||[a-z]|#"], 0..12),
        width in 2..4usize,
        z in prop_oneof![0.0..3e3f64, Just(f64::MIN_POSITIVE), Just(5e-324), Just(1.0), Just(2e3)],
        at in 0.0..1e3f64,
    ) {
        let rows: Vec<String> = cells.chunks(width).map(|row| row.join(",")).collect();
        match Atmosphere::from_csv(&format!("{head}\n{}", rows.join("\n")), Path::new("a.csv")) {
            Ok(air) => {
                let (low, high) = air.range_cm1();
                for tau in air.transmittance(&[low, high, at.clamp(low, high)], z.min(air.longest_m())).unwrap() {
                    prop_assert!((0.0..=1.0).contains(&tau), "{tau}");
                }
            }
            Err(error) => {
                let message = error.to_string();
                prop_assert!(message.starts_with("a.csv") && !message.contains(char::is_control), "{message}");
            }
        }
    }
}

#[test]
fn rows_that_are_missing_are_not_bridged() {
    let rows = |kept: &dyn Fn(u32) -> bool| {
        let all = (0..90).filter(|i| kept(*i));
        all.map(|i| (800.0 + 4.0 * f64::from(i), vec![0.9, 0.3])).collect::<Vec<_>>()
    };
    let whole = table(&[10.0, 1e3], &rows(&|_| true)).unwrap();
    let cut = table(&[10.0, 1e3], &rows(&|i| !(30..60).contains(&i))).unwrap();
    for nu in (800..1156).map(f64::from) {
        assert!(whole.transmittance(&[nu], 100.0).is_ok());
        assert_eq!(cut.transmittance(&[nu], 100.0).is_ok(), !(917.0..1040.0).contains(&nu), "{nu}");
    }
    let refusal = cut.optical_depth_and_growth(&[950.0], 100.0).unwrap_err().to_string();
    assert!(refusal.starts_with("no rows between 916.00 and 1040.00 cm^-1"), "{refusal}");
}
