//! What `render` draws of an array, found in the picture by an analysis of variance.

use hadar::instrument::{Extent, View};
use hadar::material::Library;
use hadar_scenario::RenderScenario;
use hadar_study::render::{RenderPlan, RenderStudy};

const SCENE: &str = r#"
    [scene]
    sky = { material = "sky-us-standard", temperature = "288 K" }
    ground = { material = "asphalt", temperature = "12 degC" }
    size = [120, 90]
    [[object]]
    shape = "block"
    material = "brick-red"
    temperature = "14 degC"
    at = ["0 m", "9 m"]
    size = ["1 m", "1 m", "1 m"]
    [bands]
    ranges = [["8 um", "9 um"], ["9 um", "10 um"], ["10 um", "11 um"], ["11 um", "12 um"], ["12 um", "13 um"]]
    [camera]
    preset = "flir-boson-640-14mm"
    f_number = 1.0
    fixed_pattern = "0 mK"
    "#;

fn study(figures: &str) -> RenderStudy {
    let scenario = RenderScenario::from_toml(&format!("{SCENE}{figures}"), None).unwrap();
    RenderStudy::new(&scenario, &Library::embedded().unwrap()).unwrap()
}

/// Variances of row means, column means, picture means and of what is left, mean over the bands, of what was added to the expected counts.
fn parts(study: &RenderStudy, seeds: std::ops::Range<u64>) -> [f64; 4] {
    let drawn = |seed| study.render(RenderPlan { seed }, &|_, _| ()).unwrap();
    let expected = drawn(None);
    let [rows, columns, bands] = [expected.shape.rows(), expected.shape.columns(), expected.shape.bands()];
    let mut sums = [0.0; 4];
    let count = (seeds.end - seeds.start) as f64 * bands as f64;
    for seed in seeds {
        let noisy = drawn(Some(seed));
        for band in 0..bands {
            let off = |row: usize, column: usize| {
                let place = (row * columns + column) * bands + band;
                f64::from(noisy.views[0].counts[place]) - f64::from(expected.views[0].counts[place])
            };
            let of_rows: Vec<f64> = (0..rows)
                .map(|row| (0..columns).map(|column| off(row, column)).sum::<f64>() / columns as f64)
                .collect();
            let of_columns: Vec<f64> = (0..columns)
                .map(|column| (0..rows).map(|row| off(row, column)).sum::<f64>() / rows as f64)
                .collect();
            let all = of_rows.iter().sum::<f64>() / rows as f64;
            let scatter = |means: &[f64]| {
                means.iter().map(|mean| (mean - all).powi(2)).sum::<f64>() / (means.len() - 1) as f64
            };
            let left: f64 = (0..rows * columns)
                .map(|i| {
                    let (row, column) = (i / columns, i % columns);
                    (off(row, column) - of_rows[row] - of_columns[column] + all).powi(2)
                })
                .sum();
            sums[0] += scatter(&of_rows) / count;
            sums[1] += scatter(&of_columns) / count;
            sums[2] += all * all / count;
            sums[3] += left / ((rows - 1) * (columns - 1)) as f64 / count;
        }
    }
    sums
}

#[test]
fn rows_columns_and_offsets_are_stripes_of_a_picture() {
    let stated = study("row_noise = \"300 mK\"\ncolumn_noise = \"200 mK\"\noffset_drift = \"150 mK\"\n");
    let [of_rows, of_columns, of_all, left] = parts(&stated, 0..12);
    let camera = stated.camera();
    let bands = stated.bands();
    // What the budget of one pixel says, term by term; of a whole picture frame by frame nothing is stated.
    let lines = camera.added_noise(bands, &View { extent: Extent::ONE, ..View::default() });
    let of = |label: &str| lines.iter().find(|line| line.label == label).unwrap().var_counts[0];
    let own = left;
    let close = |found: f64, told: f64, draws: f64| {
        let sigmas = (found / told - 1.0) / (2.0 / draws).sqrt();
        assert!(sigmas.abs() < 4.0, "{found} against {told}: {sigmas} deviations");
    };
    close(of_rows, of("row noise") + own / 90.0, 12.0 * 5.0 * 119.0);
    close(of_columns, of("column noise") + own / 120.0, 12.0 * 5.0 * 89.0);
    close(of_all, of("offset drift") + of("row noise") / 120.0 + of("column noise") / 90.0, 60.0);
    // Without a pattern a picture is what each pixel counts for itself.
    let silent = study("row_noise = \"0 mK\"\ncolumn_noise = \"0 mK\"\n");
    let [rows_alone, columns_alone, all_alone, alone] = parts(&silent, 20..24);
    close(left, alone, 4.0 * 5.0 * 119.0 * 89.0 * 0.5);
    close(rows_alone, alone / 90.0, 4.0 * 5.0 * 119.0);
    close(columns_alone, alone / 120.0, 4.0 * 5.0 * 89.0);
    assert!(all_alone < 20.0 * alone / (120.0 * 90.0));
}

/// Rows that change from frame to frame add to what a pixel's own NETD says, as in the budget of one pixel.
#[test]
fn what_changes_from_frame_to_frame_adds_to_the_noise_of_a_pixel() {
    let quiet = "row_noise = \"0 mK\"\ncolumn_noise = \"0 mK\"\n";
    let [of_rows, _, of_all, left] =
        parts(&study(&format!("{quiet}temporal_row_noise = \"30 mK\"\n")), 40..52);
    let [.., alone] = parts(&study(quiet), 52..56);
    // 30 mK are the rows', and 40 mK are left for each pixel.
    let own = of_rows - left / 90.0;
    assert!(
        (own / alone / (900.0 / 1600.0) - 1.0).abs() < 4.0 * (2.0f64 / (12.0 * 5.0 * 119.0)).sqrt() + 0.03,
        "{own} {left} {alone}"
    );
    assert!((left / alone - 1.0).abs() < 0.03, "{left} {alone}");
    assert!(of_all < of_rows);
}
