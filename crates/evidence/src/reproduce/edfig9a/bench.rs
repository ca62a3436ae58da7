//! Letters on a wafer before ten filters: what is there, what the camera counts, what is read of it, and what could be.

use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::error::Result;
use hadar::fisher::precision::PrecisionSolver;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::instrument::{Camera, View, presets};
use hadar::material::Library;
use hadar::planck::photon_radiance;
use hadar::root::crossing;
use hadar::scene::{EnvironmentObject, Parameter, State, Surroundings};
use hadar::spectrum::{Bands, FilterCurve};
use hadar::statistics::Statistics;
use hadar_estimate::decompose::{Light, Maps, Options, Setting, decompose};
use hadar_simulate::draws::{Draws, generator};
use rayon::prelude::*;

/// Letters, and pixels of one dot of theirs.
const WORD: &str = "HADAR";
const DOT: usize = 4;
/// Plastic and wafer, K.
pub(super) const LETTERS_K: f64 = 312.15;
pub(super) const WAFER_K: f64 = 317.15;
pub(super) const ROOM_K: f64 = 295.15;
/// Frames of each filter, and of the thermal imager.
pub(super) const FRAMES: u32 = 100;
/// Filters: how many, full width at half maximum in cm⁻¹, largest transmittance.
const FILTERS: usize = 10;
pub(super) const WIDTH_CM1: f64 = 70.0;
const PEAK: f64 = 0.8;
/// What the imager takes the emissivity for.
pub(super) const ENTERED: f64 = 0.95;
/// What a pixel may be; the first is the wafer, the second the letters.
pub(super) const MATERIALS: [&str; 7] =
    ["silicon", "pmma", "pet", "polycarbonate", "polystyrene", "pvc-tape", "aluminium-rough"];
/// Those of them that are plastics.
const PLASTICS: std::ops::RangeInclusive<usize> = 1..=5;
const RANGE_K: [f64; 2] = [280.0, 350.0];
/// Deviations that hold 95 %.
const NINETY_FIVE: f64 = 1.959_963_984_540_054;

/// What is before the camera.
pub(super) struct Bench {
    pub(super) camera: Camera,
    pub(super) bands: Bands,
    pub(super) counting: Counting,
    pub(super) surroundings: Surroundings,
    /// At the nodes of the filters.
    pub(super) library: Vec<Vec<f64>>,
    pub(super) area_ratio: f64,
    pub(super) columns: usize,
    /// Whether a pixel is of a letter.
    pub(super) is_letter: Vec<bool>,
}

/// What is read.
pub(super) struct Read {
    pub(super) maps: Maps,
    pub(super) right: [f64; 2],
    pub(super) mean_k: [f64; 2],
    pub(super) over_bound: [f64; 2],
    pub(super) covered: [f64; 2],
    pub(super) bound_k: [f64; 2],
    /// Between a pixel and the nearest other material, and the nearest of the other kind: wafer and plastics.
    pub(super) limit: [f64; 2],
    pub(super) limit_of_kind: [f64; 2],
    pub(super) nearest: [&'static str; 2],
    /// Share whose kind is right, whichever plastic is named.
    pub(super) right_kind: [f64; 2],
    /// Root mean square error of all pixels of that kind, whichever material is named, K.
    pub(super) rms_all_k: [f64; 2],
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
    pub(super) fn new(materials: &Library) -> Result<Self> {
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

    pub(super) fn counts(&self, seed: u64) -> Result<Vec<f32>> {
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
            path: None,
            light_besides: &[],
        };
        decompose(&setting, &Options::default(), &cube, &|_| ())
    }

    pub(super) fn read(&self, counts: Vec<f32>, lighting_total: Option<f64>) -> Result<Read> {
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
    pub(super) fn thermograph(&self, materials: &Library, seed: u64) -> Result<(Vec<f64>, f64)> {
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
pub(super) fn means(is_letter: &[bool], values: &[f64]) -> [f64; 2] {
    [false, true].map(|kind| {
        let own = || is_letter.iter().zip(values).filter(|(one, _)| **one == kind).map(|(_, x)| x);
        own().sum::<f64>() / own().count().max(1) as f64
    })
}
