//! Extended Data Fig. 9a–d: plastic letters on a silicon wafer that is 5 K warmer, camouflaged for a thermal imager.
//!
//! S = e B(T) + (1 − e) V B(T₀) through ten filters, counted by the paper's camera. What the paper does not say is stated here: letters
//! of acrylic (`pmma`), a room T₀ as [`ROOM_K`], filters of Gaussian transmittance evenly over the camera's range, [`FRAMES`] frames each. An
//! unpolished wafer is one of larger area: its pits are cavities of one temperature, e' = e/(e + (1 − e)/A) with A times the area. A is
//! chosen so that camera and room make the camouflage exact: the hardest case, and the one of the paper's picture.
//!
//! The thermal imager has no filter; it takes the emissivity for [`ENTERED`] and the room for known, as its menu does.

use super::ledger::{Line, Verdict};
use super::order::{Figures, Made, Order};
use hadar::decompose::{Light, Maps, Options, Setting, decompose};
use hadar::error::Result;
use hadar::fisher::precision::PrecisionSolver;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::instrument::{Camera, View, presets};
use hadar::material::Library;
use hadar::planck::photon_radiance;
use hadar::ranging::cube::{Cube, MemoryCube, Shape};
use hadar::root::crossing;
use hadar::scene::{EnvironmentObject, Parameter, State, Surroundings};
use hadar::simulate::draws::{Draws, generator};
use hadar::spectrum::{Bands, FilterCurve};
use hadar::statistics::Statistics;
use hadar::words::significant;
use hadar_report::bundle::Bundle;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Painted, Picture, Pictures, Series, categorical};
use hadar_report::table::{Table, number};
use rayon::prelude::*;

/// Letters, and pixels of one dot of theirs.
const WORD: &str = "HADAR";
const DOT: usize = 4;
/// Plastic and wafer, K.
const LETTERS_K: f64 = 312.15;
const WAFER_K: f64 = 317.15;
const ROOM_K: f64 = 295.15;
/// Frames of each filter, and of the thermal imager.
const FRAMES: u32 = 100;
/// Filters: how many, full width at half maximum in cm⁻¹, largest transmittance.
const FILTERS: usize = 10;
const WIDTH_CM1: f64 = 70.0;
const PEAK: f64 = 0.8;
/// What the imager takes the emissivity for.
const ENTERED: f64 = 0.95;
/// What a pixel may be; the first is the wafer, the second the letters.
const MATERIALS: [&str; 7] =
    ["silicon", "pmma", "pet", "polycarbonate", "polystyrene", "pvc-tape", "aluminium-rough"];
/// Those of them that are plastics.
const PLASTICS: std::ops::RangeInclusive<usize> = 1..=5;
const RANGE_K: [f64; 2] = [280.0, 350.0];
/// Deviations that hold 95 %.
const NINETY_FIVE: f64 = 1.959_963_984_540_054;

/// What is before the camera.
struct Bench {
    camera: Camera,
    bands: Bands,
    counting: Counting,
    surroundings: Surroundings,
    /// At the nodes of the filters.
    library: Vec<Vec<f64>>,
    area_ratio: f64,
    columns: usize,
    /// Whether a pixel is of a letter.
    is_letter: Vec<bool>,
}

/// What is read.
struct Read {
    maps: Maps,
    right: [f64; 2],
    mean_k: [f64; 2],
    over_bound: [f64; 2],
    covered: [f64; 2],
    bound_k: [f64; 2],
    /// Between a pixel and the nearest other material, and the nearest of the other kind: wafer and plastics.
    limit: [f64; 2],
    limit_of_kind: [f64; 2],
    nearest: [&'static str; 2],
    /// Share whose kind is right, whichever plastic is named.
    right_kind: [f64; 2],
    /// Root mean square error of all pixels of that kind, whichever material is named, K.
    rms_all_k: [f64; 2],
}

/// Rows of a letter's dots.
fn dots(letter: char) -> [u8; 7] {
    match letter {
        'H' => [17, 17, 17, 31, 17, 17, 17],
        'A' => [14, 17, 17, 31, 17, 17, 17],
        'D' => [30, 17, 17, 17, 17, 17, 30],
        'R' => [30, 17, 17, 30, 20, 18, 17],
        _ => [0; 7],
    }
}

/// The word with a dot of wafer around it.
fn written() -> (Vec<bool>, usize) {
    let (rows, columns) = (9 * DOT, (6 * WORD.len() + 1) * DOT);
    let at = |row: usize, column: usize| {
        let (row, column) = ((row / DOT).checked_sub(1)?, (column / DOT).checked_sub(1)?);
        let letter = WORD.chars().nth(column / 6)?;
        Some(dots(letter).get(row)? >> (4_usize.checked_sub(column % 6)?) & 1 == 1)
    };
    let all = (0..rows).flat_map(|row| (0..columns).map(move |column| at(row, column).unwrap_or(false)));
    (all.collect(), columns)
}

impl Bench {
    fn new(materials: &Library) -> Result<Self> {
        let camera = Camera { frames: FRAMES, ..presets::get("flir-a325sc")? };
        let [low, high] = [790.0, 1210.0];
        let filter = |i: usize| {
            let centre = low + (high - low) * i as f64 / (FILTERS - 1) as f64;
            let rows = (-18..=18).map(|step| {
                let off = f64::from(step) / 15.0;
                (centre + off * WIDTH_CM1, PEAK * (-4.0 * std::f64::consts::LN_2 * off * off).exp())
            });
            FilterCurve::new(format!("filter {}", i + 1), rows.collect())
        };
        let bands = Bands::from_filters((0..FILTERS).map(filter).collect::<Result<_>>()?)?;
        let own = camera.received(&camera.own_bands()?);
        let wafer = materials.get("silicon-wafer")?;
        let pmma = materials.get("pmma")?;
        let seen = |emissivity: &[f64], temperature_k: f64| signal(&own, emissivity, temperature_k);
        let (bare, letters) = (wafer.emissivity(own.nodes_cm1())?, pmma.emissivity(own.nodes_cm1())?);
        let plastic = seen(&letters, LETTERS_K);
        let area_ratio = crossing(1.0, 1e3, |a| Ok(seen(&pitted(&bare, a), WAFER_K) - plastic))?;
        let nodes = bands.nodes_cm1();
        let of = |name: &&str| match *name {
            "silicon" => Ok(pitted(&wafer.emissivity(nodes)?, area_ratio)),
            other => materials.get(other)?.emissivity(nodes),
        };
        let room = EnvironmentObject { temperature_k: ROOM_K, emissivity: None };
        let (is_letter, columns) = written();
        Ok(Self {
            library: MATERIALS.iter().map(of).collect::<Result<_>>()?,
            surroundings: Surroundings::new(nodes, vec![room])?,
            counting: camera.counting(&bands, &View::default()),
            camera,
            bands,
            area_ratio,
            columns,
            is_letter,
        })
    }

    fn state(&self, is_letter: bool) -> Result<State> {
        self.surroundings.state(if is_letter { LETTERS_K } else { WAFER_K }, &[1.0])
    }

    fn counts(&self, seed: u64) -> Result<Vec<f32>> {
        let of = |is_letter: bool| {
            let nodes = self.bands.nodes_cm1();
            let (emissivity, temperature_k) = kind(&self.library, is_letter);
            let signal = nodes.iter().zip(emissivity).map(|(nu, e)| {
                e * photon_radiance(*nu, temperature_k) + (1.0 - e) * photon_radiance(*nu, ROOM_K)
            });
            let mean: Vec<f64> = self
                .bands
                .weigh(&signal.collect::<Vec<_>>())
                .iter()
                .map(|s| s * self.counting.counts_per_radiance)
                .collect();
            Draws::new(&Statistics::Poisson, &mean)?.with_electronic_noise(&self.var())
        };
        let draws = [of(false)?, of(true)?];
        let one = |(i, is_letter): (usize, &bool)| {
            let mut counts = vec![0.0; FILTERS];
            draws[usize::from(*is_letter)].draw_into(&mut generator(seed, i as u64), &mut counts);
            counts.into_iter().map(|n| n as f32).collect::<Vec<f32>>()
        };
        Ok(self.is_letter.par_iter().enumerate().map(one).collect::<Vec<_>>().concat())
    }

    fn var(&self) -> Vec<f64> {
        (0..FILTERS).map(|band| self.counting.var_added(band)).collect()
    }

    fn taken_apart(&self, counts: Vec<f32>, lighting_total: Option<f64>) -> Result<Maps> {
        let shape = Shape::new(self.is_letter.len() / self.columns, self.columns, FILTERS)?;
        let cube = Cube::F32(Box::new(MemoryCube::new(shape, counts)?));
        let radiance = self.bands.nodes_cm1().iter().map(|nu| photon_radiance(*nu, ROOM_K)).collect();
        let setting = Setting {
            bands: &self.bands,
            library: &self.library,
            surroundings: &[Light::Radiance(radiance)],
            counts_per_radiance: &[self.counting.counts_per_radiance; FILTERS],
            var_added: &self.var(),
            units_per_count: 1.0,
            temperature_k: RANGE_K,
            lighting_total,
            gain: false,
            bad_bands: &[],
        };
        decompose(&setting, &Options::default(), &cube, &|_| ())
    }

    fn read(&self, counts: Vec<f32>, lighting_total: Option<f64>) -> Result<Read> {
        let maps = self.taken_apart(counts, lighting_total)?;
        let mut nuisances = vec![Nuisance::Temperature];
        nuisances.extend(lighting_total.is_none().then_some(Nuisance::Lighting));
        let unknowns = Unknowns::new(nuisances)?;
        let range = StateRange { temperature_k: RANGE_K, ..StateRange::default() };
        let mut read = Read {
            maps,
            right: [0.0; 2],
            mean_k: [0.0; 2],
            over_bound: [0.0; 2],
            covered: [0.0; 2],
            bound_k: [0.0; 2],
            limit: [0.0; 2],
            limit_of_kind: [0.0; 2],
            nearest: [""; 2],
            right_kind: [0.0; 2],
            rms_all_k: [0.0; 2],
        };
        for place in 0..2 {
            let is_letter = place == 1;
            let (emissivity, truth_k) = kind(&self.library, is_letter);
            let state = self.state(is_letter)?;
            let mut precision = PrecisionSolver::new(&self.bands, &self.surroundings, unknowns.clone());
            let bound_k = precision.bound(emissivity, &state, &self.counting, Parameter::Temperature)?.sigma;
            let mut solver = NearestSolver::new(&self.bands, &self.surroundings, unknowns.clone(), range);
            let mut nearest = (f64::INFINITY, "");
            let mut of_kind = f64::INFINITY;
            for (i, (other, name)) in self.library.iter().zip(MATERIALS).enumerate() {
                if i == place {
                    continue;
                }
                let distance = solver.with_counting(emissivity, other, &state, &self.counting)?.distance;
                if PLASTICS.contains(&i) != is_letter {
                    of_kind = of_kind.min(distance);
                }
                if distance < nearest.0 {
                    nearest = (distance, name);
                }
            }
            let own: Vec<usize> =
                (0..self.is_letter.len()).filter(|i| self.is_letter[*i] == is_letter).collect();
            let right: Vec<usize> =
                own.iter().copied().filter(|i| usize::from(read.maps.material[*i]) == place).collect();
            let off: Vec<f64> =
                right.iter().map(|i| f64::from(read.maps.temperature_k[*i]) - truth_k).collect();
            let held = right
                .iter()
                .zip(&off)
                .filter(|(i, off)| off.abs() <= NINETY_FIVE * f64::from(read.maps.temperature_sigma_k[**i]));
            let count = off.len().max(1) as f64;
            let is_kind = |i: &usize| PLASTICS.contains(&usize::from(read.maps.material[*i])) == is_letter;
            let of_own_kind: Vec<usize> = own.iter().copied().filter(is_kind).collect();
            let square = |i: &usize| (f64::from(read.maps.temperature_k[*i]) - truth_k).powi(2);
            read.right_kind[place] = of_own_kind.len() as f64 / own.len().max(1) as f64;
            read.rms_all_k[place] = (own.iter().map(square).sum::<f64>() / own.len().max(1) as f64).sqrt();
            read.limit_of_kind[place] = detection::probability(of_kind);
            read.covered[place] = held.count() as f64 / count;
            read.right[place] = right.len() as f64 / own.len().max(1) as f64;
            read.mean_k[place] = truth_k + off.iter().sum::<f64>() / count;
            read.bound_k[place] = bound_k;
            read.over_bound[place] = (off.iter().map(|k| k * k).sum::<f64>() / count).sqrt() / bound_k;
            read.limit[place] = detection::probability(nearest.0);
            read.nearest[place] = nearest.1;
        }
        Ok(read)
    }

    /// Temperatures as the thermal imager says, K, and the deviation of one.
    fn thermograph(&self, materials: &Library, seed: u64) -> Result<(Vec<f64>, f64)> {
        let own = self.camera.received(&self.camera.own_bands()?);
        let nodes = own.nodes_cm1();
        let wafer = pitted(&materials.get("silicon-wafer")?.emissivity(nodes)?, self.area_ratio);
        let plastic = materials.get("pmma")?.emissivity(nodes)?;
        let counting = self.camera.counting(&own, &View::default());
        let entered = vec![ENTERED; nodes.len()];
        let said = |counts: f64| {
            crossing(200.0, 400.0, |k| Ok(signal(&own, &entered, k) * counting.counts_per_radiance - counts))
        };
        let mean = [(&wafer, WAFER_K), (&plastic, LETTERS_K)]
            .map(|(e, k)| signal(&own, e, k) * counting.counts_per_radiance);
        let var = counting.var_added(0);
        let draws = mean.map(|mean| Draws::new(&Statistics::Poisson, &[mean])?.with_electronic_noise(&[var]));
        let [wafer, letters] = draws;
        let draws = [wafer?, letters?];
        let one = |(i, is_letter): (usize, &bool)| {
            let mut counts = [0.0];
            draws[usize::from(*is_letter)].draw_into(&mut generator(seed, i as u64), &mut counts);
            said(counts[0])
        };
        let image = self.is_letter.par_iter().enumerate().map(one).collect::<Result<Vec<f64>>>()?;
        let sigma = (mean[1] + var).sqrt();
        Ok((image, said(mean[1] + sigma)? - said(mean[1])?))
    }
}

/// Signal of a surface in the room, all of the bands together.
fn signal(bands: &Bands, emissivity: &[f64], temperature_k: f64) -> f64 {
    let at = |(nu, e): (&f64, &f64)| {
        e * photon_radiance(*nu, temperature_k) + (1.0 - e) * photon_radiance(*nu, ROOM_K)
    };
    let all: Vec<f64> = bands.nodes_cm1().iter().zip(emissivity).map(at).collect();
    bands.weigh(&all).iter().sum()
}

/// Emissivity of a surface of so many times its area.
fn pitted(emissivity: &[f64], area_ratio: f64) -> Vec<f64> {
    emissivity.iter().map(|e| e / (e + (1.0 - e) / area_ratio)).collect()
}

fn kind(library: &[Vec<f64>], is_letter: bool) -> (&[f64], f64) {
    let (place, temperature_k) = if is_letter { (1, LETTERS_K) } else { (0, WAFER_K) };
    (library.get(place).map_or(&[], Vec::as_slice), temperature_k)
}

/// Mean of wafer and of letters.
fn means(is_letter: &[bool], values: &[f64]) -> [f64; 2] {
    [false, true].map(|kind| {
        let own = || is_letter.iter().zip(values).filter(|(one, _)| **one == kind).map(|(_, x)| x);
        own().sum::<f64>() / own().count().max(1) as f64
    })
}

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
        rows.dedup_by(|a, b| a.0 == b.0);
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
