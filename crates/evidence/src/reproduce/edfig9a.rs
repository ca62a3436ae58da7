//! Extended Data Fig. 9a–d: plastic letters on a silicon wafer that is 5 K warmer, camouflaged for a thermal imager.
//!
//! S = e B(T) + (1 − e) V B(T₀) through ten filters, counted by the paper's camera. What the paper does not say is stated here: letters
//! of acrylic (`pmma`), a room T₀ as [`ROOM_K`], filters of Gaussian transmittance evenly over the camera's range, [`FRAMES`] frames each. An
//! unpolished wafer is one of larger area: its pits are cavities of one temperature, e' = e/(e + (1 − e)/A) with A times the area. A is
//! chosen so that camera and room make the camouflage exact: the hardest case, and the one of the paper's picture.
//!
//! The thermal imager has no filter; it takes the emissivity for [`ENTERED`] and the room for known, as its menu does.

mod bench;

use self::bench::{Bench, ENTERED, FRAMES, LETTERS_K, MATERIALS, ROOM_K, Read, WAFER_K, WIDTH_CM1, means};
use super::ledger::{Line, Verdict};
use super::order::{Figures, Made, Order};
use hadar::error::Result;
use hadar::material::Library;
use hadar::words::significant;
use hadar_report::bundle::Bundle;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Painted, Picture, Pictures, Series, categorical};
use hadar_report::table::{Table, number};

pub(super) fn make(order: Order) -> Result<Made> {
    let materials = Library::embedded()?;
    let bench = Bench::new(&materials)?;
    let counts = bench.counts(order.seed)?;
    let known = bench.read(counts.clone(), Some(1.0))?;
    let unknown = bench.read(counts, None)?;
    let (thermograph, sigma_k) = bench.thermograph(&materials, order.seed.wrapping_add(1))?;
    let said = means(&bench.is_letter, &thermograph);
    let mut bundle = Bundle::default();
    bundle.add_table("readings.csv", readings(&[("known", &known), ("unknown", &unknown)]))?;
    bundle.add_plots(&[plot(&bench, &known, &thermograph), spectra(&bench)])?;
    let text = format!(
        "Acrylic letters at {LETTERS_K} K on silicon at {WAFER_K} K in a room of {ROOM_K} K; the wafer's pits are {} times its plain area, \
         chosen so that the imager sees no contrast. Ten Gaussian filters of {WIDTH_CM1} cm^-1, {FRAMES} frames each, noise of \
         flir-a325sc. A pixel may be any of {}. Bounds: of one pixel, its material known; limits of the material: the largest share that is \
         right of any test between what is there and the nearest state of {} (wafer) and {} (letters).\n",
        significant(bench.area_ratio, 3),
        MATERIALS.join(", "),
        known.nearest[0],
        known.nearest[1],
    );
    let pictures = vec![
        ("letters.png", "What is there, what a thermal imager says, materials and temperatures read"),
        ("emissivities.png", "Emissivities of wafer and plastics"),
    ];
    Ok((bundle, lines(&known, &unknown, said, sigma_k), Figures { pictures, text }))
}

fn lines(known: &Read, unknown: &Read, said: [f64; 2], sigma_k: f64) -> Vec<Line> {
    let percent = |x: f64| format!("{} %", significant(100.0 * x, 3));
    let contrast = said[1] - said[0];
    let mut lines = vec![Line::new(
        "Ext. Data Fig. 9b",
        "letters 5 K colder than the wafer, as a thermal imager says, K",
        "camouflage",
        format!("{contrast:+.3}; deviation of a pixel {}", significant(sigma_k, 2)),
        if contrast.abs() < sigma_k { Verdict::UnderAChoice } else { Verdict::NotReproduced },
        "the roughness of the wafer, which the paper does not say, is chosen so",
    )];
    for (read, lighting) in [(known, "known"), (unknown, "unknown")] {
        let both = |of: [f64; 2]| format!("wafer {}, letters {}", percent(of[0]), percent(of[1]));
        lines.push(Line::new(
            "Ext. Data Fig. 9c",
            format!("pixels whose material is right, silicon or a plastic, lighting {lighting}"),
            "only drawn",
            both(read.right_kind),
            if read.right_kind.iter().all(|right| *right > 0.95) {
                Verdict::UnderAChoice
            } else {
                Verdict::NotReproduced
            },
            format!(
                "limits {}: between it and the nearest state of the other kind",
                both(read.limit_of_kind)
            ),
        ));
        lines.push(Line::new(
            "Ext. Data Fig. 9c",
            format!("the same, which plastic of five, lighting {lighting}"),
            "-",
            both(read.right),
            Verdict::NotInThePaper,
            format!(
                "limits {} between it and {} or {}, the nearest other ones: what guesses between two has 50 %, of six and more less",
                both(read.limit),
                read.nearest[0],
                read.nearest[1]
            ),
        ));
        lines.push(Line::new(
            "Ext. Data Fig. 9d",
            format!("temperatures read of wafer and letters, K, lighting {lighting}"),
            format!("{WAFER_K}, {LETTERS_K}"),
            format!("{:.2}, {:.2}", read.mean_k[0], read.mean_k[1]),
            if read.over_bound.iter().all(|ratio| (ratio - 1.0).abs() < 0.1) {
                Verdict::UnderAChoice
            } else {
                Verdict::NotReproduced
            },
            format!(
                "error of a pixel over its Cramér–Rao bound {} and {} (bounds {} and {} K), 95 % intervals hold {} and {}: of pixels of right material; errors of \
                 all pixels {} and {} K{}",
                significant(read.over_bound[0], 3),
                significant(read.over_bound[1], 3),
                significant(read.bound_k[0], 2),
                significant(read.bound_k[1], 2),
                percent(read.covered[0]),
                percent(read.covered[1]),
                significant(read.rms_all_k[0], 2),
                significant(read.rms_all_k[1], 2),
                match lighting {
                    "known" => "",
                    _ => "; the lighting is at the end of its range, which cuts errors on one side",
                }
            ),
        ));
    }
    lines
}

fn readings(reads: &[(&str, &Read)]) -> Table {
    let mut table = Table::new([
        "lighting",
        "part",
        "right_material",
        "right_material_limit",
        "right_kind",
        "right_kind_limit",
        "temperature_mean_k",
        "bound_k",
        "error_over_bound",
        "coverage_95",
        "error_of_all_k",
    ]);
    for (lighting, read) in reads {
        for (place, part) in ["wafer", "letters"].into_iter().enumerate() {
            let numbers = [
                read.right[place],
                read.limit[place],
                read.right_kind[place],
                read.limit_of_kind[place],
                read.mean_k[place],
                read.bound_k[place],
                read.over_bound[place],
                read.covered[place],
                read.rms_all_k[place],
            ];
            table.push([*lighting, part].map(str::to_owned).into_iter().chain(numbers.map(number)).collect());
        }
    }
    table
}

fn spectra(bench: &Bench) -> Plot {
    let (low, high) = bench.bands.range_cm1();
    let curve = |emissivity: &[f64]| {
        let all = bench.bands.nodes_cm1().iter().copied().zip(emissivity.iter().copied());
        let mut rows: Vec<(f64, f64)> = all.collect();
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        rows.dedup_by(|a, b| a.0 - b.0 < 1.0);
        rows
    };
    let mut table = Table::new(["material", "wavenumber_cm1", "emissivity"]);
    let mut figure = LineFigure::new(
        "What a pixel may be",
        Axis::linear("wavenumber (cm⁻¹)").range(low, high),
        Axis::linear("emissivity"),
    )
    .subtitle("silicon: an unpolished wafer, whose pits make it darker than it is plain.");
    for (i, (name, emissivity)) in MATERIALS.into_iter().zip(&bench.library).enumerate() {
        let rows = curve(emissivity);
        for (nu, e) in &rows {
            table.push(vec![name.to_owned(), number(*nu), number(*e)]);
        }
        let (x, y) = rows.into_iter().unzip();
        figure = figure.series(Series::line(name, x, y).colour(i));
    }
    Plot { name: "emissivities".into(), figure: figure.into(), table }
}

fn plot(bench: &Bench, read: &Read, thermograph: &[f64]) -> Plot {
    let columns = bench.columns;
    let scale = || Axis::linear("temperature (K)").range(307.0, 319.0);
    let truth: Vec<f64> =
        bench.is_letter.iter().map(|is_letter| if *is_letter { LETTERS_K } else { WAFER_K }).collect();
    let found: Vec<f64> = read.maps.temperature_k.iter().map(|k| f64::from(*k)).collect();
    let pixels = read.maps.material.iter().map(|place| categorical(usize::from(*place))).collect();
    let material: Vec<f64> = read.maps.material.iter().map(|place| f64::from(*place)).collect();
    let mut table =
        Table::new(["row", "column", "truth_k", "thermal_imager_k", "material_index", "temperature_k"]);
    for i in 0..truth.len() {
        let values = [truth[i], thermograph[i], material[i], found[i]].map(number);
        let places = [i / columns, i % columns].map(|place| place.to_string());
        table.push(places.into_iter().chain(values).collect());
    }
    let pictures = vec![
        Picture::new("What is there", scale(), columns, truth),
        Picture::new(format!("Thermal imager, emissivity {ENTERED}"), scale(), columns, thermograph.to_vec()),
        Picture::painted("Material read", Axis::linear(""), columns, Painted { pixels, ramp: None }),
        Picture::new("Temperature read", scale(), columns, found),
    ];
    let named = MATERIALS.iter().enumerate().map(|(i, name)| (categorical(i), (*name).to_owned()));
    let figure = Pictures::new("Letters that a thermal imager does not see", pictures)
        .subtitle(format!("Acrylic (pmma) at {LETTERS_K} K on silicon at {WAFER_K} K."))
        .no_value("nothing is told")
        .keys(named.collect());
    Plot { name: "letters".into(), figure: figure.into(), table }
}
