use super::super::RangePlan;
use super::*;
use hadar::material::Library;
use hadar_formats::cube::write_npy;
use hadar_scenario::RangeScenario;

/// Takes maps into memory.
#[derive(Default)]
struct Kept(Mutex<(usize, MapRows)>);

/// Rows of maps, by map and row.
type MapRows = BTreeMap<(u8, usize), Vec<f64>>;

impl MapSink for Kept {
    fn begin(&self, signals: &[Signal], _rows: usize, columns: usize) -> Result<()> {
        assert_eq!(signals, SIGNALS);
        locked(&self.0).0 = columns;
        Ok(())
    }

    fn put(&self, signal: Signal, first: usize, disparity_error_px: &[f64]) -> Result<()> {
        locked(&self.0).1.insert((signal as u8, first), disparity_error_px.to_vec());
        Ok(())
    }
}

/// By rows or as a whole, the answer is the same; so are all bits of the maps.
#[test]
fn what_is_worked_on_by_rows_is_what_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let shape = Shape::new(190, 47, 5).unwrap();
    let mut state = 1_u32;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        (state >> 20) as f32
    };
    let mut samples: Vec<f32> = (0..shape.len()).map(|i| 500.0 + next() * (i % 7) as f32).collect();
    for place in [47 * 5 * 100 + 3, 47 * 5 * 150 + 46 * 5, 47 * 5 * 188 + 100] {
        samples[place] = f32::NAN;
    }
    write_npy(&folder.path().join("left.npy"), shape, &samples).unwrap();
    let scene = "[cube]\nleft = \"left.npy\"\nphotons_per_unit = 3.0\nnoise_variance = 40.0\n";
    let stereo =
        "[stereo]\nbaseline = \"0.2 m\"\nfocal_length = \"14 mm\"\npixel = \"12 um\"\nlines = [3, 91]\n";
    let demand = "[requirement]\ndepth_error = \"3 cm\"\n";
    for (depth, more) in [
        ("", ""),
        ("depth = \"10 m\"\n", "joined = \"one-reading\"\n"),
        ("depth = \"10 m\"\n", "window = [7, 3]\nderivative = \"cubic-spline\"\n"),
    ] {
        let path = folder.path().join("a.toml");
        std::fs::write(&path, [scene, depth, stereo, more, demand].concat()).unwrap();
        let scenario = RangeScenario::from_file(&path).unwrap();
        let study = RangeStudy::new(&scenario, &Library::empty()).unwrap();
        let Resolved::Cube(cube) = &study.subject else { panic!("no cube") };
        let whole = study.range(&RangePlan::default(), None, &|_, _| ()).unwrap();
        let kept = Kept::default();
        let rows = study.streamed(cube, &RangePlan::default(), Some(&kept), &|_, _| ()).unwrap();

        let near = |found: f64, exact: f64| {
            let same = found == exact || found.is_nan() && exact.is_nan();
            assert!(same || (found / exact - 1.0).abs() <= 2.001 * QUANTILE_ERROR, "{found} {exact}");
        };
        let [own, exact] = [&rows, &whole].map(|found| &found.objects[0]);
        assert_eq!((own.windows, own.depth_m, &own.name), (exact.windows, exact.depth_m, &exact.name));
        assert!(rows.missing_windows > 20 && rows.missing_windows == whole.missing_windows);
        assert_eq!(own.windows + rows.missing_windows, whole.maps.rows.len() * whole.maps.columns.len());
        for (own, exact) in own.signals.iter().zip(&exact.signals) {
            assert_eq!((own.signal, own.windows, own.share), (exact.signal, exact.windows, exact.share));
            near(own.photons, exact.photons);
            near(own.gamma, exact.gamma);
            near(own.information_per_px2, exact.information_per_px2);
            near(own.sigma_correspondence_px, exact.sigma_correspondence_px);
            near(own.disparity_error_px, exact.disparity_error_px);
            near(own.relative_depth_error.unwrap_or(0.0), exact.relative_depth_error.unwrap_or(0.0));
            near(own.largest_depth_m.unwrap(), exact.largest_depth_m.unwrap());
            let [own, exact] = [own, exact].map(|found| found.depth_error_m.unwrap_or_default());
            own.into_iter().zip(exact).for_each(|(own, exact)| near(own, exact));
        }
        let [own, exact] = [&rows, &whole].map(|found| found.cells.unwrap());
        near(own.total, exact.total);
        near(own.spatial, exact.spatial);
        near(own.spectral, exact.spectral);
        near(own.full, exact.full);
        near(own.other_derivative.unwrap(), exact.other_derivative.unwrap());
        // Debug says NaN like NaN.
        assert_eq!(format!("{:?}", rows.lines), format!("{:?}", whole.lines));
        let said = [&rows, &whole].map(|found| {
            let verdict = &found.verdict;
            (verdict.met, verdict.share, verdict.signal, std::mem::discriminant(&verdict.sentence))
        });
        assert_eq!(said[0], said[1]);
        let [own, exact] = [&rows, &whole].map(|found| found.solve_for.as_ref());
        assert_eq!(own.is_some(), exact.is_some());
        if let (Some(own), Some(exact)) = (own, exact) {
            let ratio = own.baseline_m.value.unwrap() / exact.baseline_m.value.unwrap();
            assert!((ratio - 1.0).abs() <= CLOSE_OF_MANY + 2.001 * QUANTILE_ERROR, "{ratio}");
        }

        let (columns, maps) = kept.0.into_inner().unwrap();
        assert_eq!(columns, whole.maps.columns.len());
        for (signal, exact) in &whole.maps.disparity_error_px {
            let own = maps.iter().filter(|((of, _), _)| *of == *signal as u8).flat_map(|(_, rows)| rows);
            let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
            assert!(own.zip(exact).all(same), "{signal:?}");
            assert!(exact.iter().filter(|px| px.is_finite()).count() > 1000);
        }
        let shown = [&rows, &whole].map(|found| format!("{:?}", found.maps.disparity_error_px));
        assert_eq!(shown[0], shown[1]);
    }
}

#[test]
fn what_is_shown_is_not_too_much() {
    assert_eq!((step(1000, 1000), step(1 << 11, 1 << 10), step(6796, 6796)), (1, 2, 7));
}
