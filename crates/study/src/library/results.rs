//! What is said of a library that was made out of a cube.

use crate::Warning;
use crate::cube_bad::BadFound;
use crate::decompose::{FlagCount, There, flags};
use crate::heat_cube::Measured;
use crate::light_found::LightFound;
use crate::shared_unknown::Stated;
use hadar::cube::Shape;
use hadar::demand::Work;
use hadar_estimate::decompose::{Maps, NO_MATERIAL};
use hadar_estimate::separation::{Cluster, Found, Tried};
use hadar_scenario::LibraryScenario;
use serde::Serialize;
use std::collections::BTreeMap;

/// A library out of a cube.
#[derive(Debug, Clone, Serialize)]
pub struct LibraryFound {
    /// The question as it was asked, defaults filled in.
    pub scenario: LibraryScenario,
    /// What the file of the cube was read as.
    pub read: hadar_formats::cube::Found,
    /// Numbers of rows, columns and bands of the cube.
    pub shape: Shape,
    /// Mean wavenumber of each band, cm⁻¹.
    pub wavenumbers_cm1: Vec<f64>,
    /// Lowest and highest wavenumber at which a band is sampled, cm⁻¹.
    pub range_cm1: [f64; 2],
    /// Number of all pixels of the cube.
    pub pixels: usize,
    /// Pixels with one cluster left.
    pub decided: usize,
    /// Pixels that were drawn to make the library, with all their samples.
    pub drawn: usize,
    /// Those of them without an emissivity by themselves.
    pub without_nem: usize,
    /// The clusters, that of the most pixels first.
    pub clusters: Vec<ClusterRow>,
    /// Places of those whose pixels one emissivity does not explain.
    #[serde(skip)]
    pub misfits: Vec<usize>,
    /// Every count that was tried, where there were several.
    pub tried: Vec<Tried>,
    /// Prior probability of each cluster in a pixel, in any scale: that of its mean emissivity.
    pub prior: Vec<f64>,
    /// How many pixels have each flag.
    pub flags: Vec<FlagCount>,
    /// What emissivities may be off by, errors of the library and spread of its pixels, over the emissivities, both as root mean squares.
    pub emissivity_error: f64,
    /// Surroundings that were found in the cube, with their errors; empty where all are told.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub surroundings_found: Vec<LightFound>,
    /// What unknowns that the whole cube shares do to the emissivities; their deviations hold it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shared: Vec<SharedOfLibrary>,
    /// What was named or found to be bad.
    pub bad: BadFound,
    /// How good it is, where that is known.
    pub truth: Option<TruthOfClusters>,
    /// What was done and what was spared.
    pub stats: Work,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// The cube decomposed by the library.
    #[serde(skip)]
    pub maps: Maps,
}

/// What an unknown does to the emissivities.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SharedOfLibrary {
    /// Which one.
    #[serde(flatten)]
    pub stated: Stated,
    /// What its deviation does to an emissivity, rms over bands and clusters.
    pub emissivity_rms: f64,
    /// Clusters that no cluster is like then: nothing is known of their emissivities.
    pub lost: usize,
}

/// One cluster.
#[derive(Debug, Clone, Serialize)]
pub struct ClusterRow {
    /// Its name in the library.
    pub name: String,
    /// Pixels of which it is the most probable.
    pub pixels: usize,
    /// Median of their temperatures, K.
    pub temperature_median_k: f64,
    /// Mean emissivity of the cluster over all bands, 0 to 1.
    pub emissivity_mean: f64,
    /// The emissivity and its errors.
    #[serde(flatten)]
    pub cluster: Cluster,
}

/// Clusters against what is there.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct TruthOfClusters {
    /// Share of pixels whose material is the most frequent one of their cluster.
    pub right_material: Option<f64>,
    /// That material of each cluster, as an index of the truth.
    pub material_of_cluster: Vec<Option<usize>>,
    /// Root mean square error of the temperature, K.
    pub temperature_rmse_k: Option<f64>,
    /// The same of the half of the pixels that err least, as a median of absolute errors, K.
    pub temperature_median_error_k: Option<f64>,
}

pub(super) fn name(place: usize) -> String {
    format!("cluster-{}", place + 1)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

pub(super) fn against(truth: &There, maps: &Maps) -> TruthOfClusters {
    let mut found = TruthOfClusters::default();
    if let Some(material) = &truth.material {
        let mut table: BTreeMap<u16, BTreeMap<usize, usize>> = BTreeMap::new();
        let mut known = 0usize;
        for (own, there) in maps.material.iter().zip(material) {
            if *there == usize::from(NO_MATERIAL) {
                continue;
            }
            known += 1;
            if *own != NO_MATERIAL {
                *table.entry(*own).or_default().entry(*there).or_default() += 1;
            }
        }
        let most = |row: &BTreeMap<usize, usize>| {
            row.iter().fold(
                (None, 0),
                |best, (there, count)| if *count > best.1 { (Some(*there), *count) } else { best },
            )
        };
        let right: usize = table.values().map(|row| most(row).1).sum();
        found.right_material = (known > 0).then(|| right as f64 / known as f64);
        let last = table.keys().max().map_or(0, |last| usize::from(*last) + 1);
        found.material_of_cluster =
            (0..last).map(|i| table.get(&(i as u16)).and_then(|row| most(row).0)).collect();
    }
    if let Some(temperature_k) = &truth.temperature_k {
        let off: Vec<f64> = maps
            .temperature_k
            .iter()
            .zip(temperature_k)
            .map(|(own, there)| (f64::from(*own) - there).abs())
            .filter(|off| off.is_finite())
            .collect();
        let square: f64 = off.iter().map(|x| x * x).sum();
        found.temperature_rmse_k = (!off.is_empty()).then(|| (square / off.len() as f64).sqrt());
        found.temperature_median_error_k = median(off);
    }
    found
}

pub(super) fn summary(
    scenario: &LibraryScenario,
    measured: &Measured,
    found: Found,
    truth: Option<TruthOfClusters>,
    shared: Vec<SharedOfLibrary>,
    (misfits, mut warnings): (Vec<usize>, Vec<Warning>),
) -> LibraryFound {
    let Found { clusters, prior, tried, drawn, without_nem, maps, .. } = found;
    let bands = &measured.bands;
    let widths = bands.widths_cm1();
    let wavenumbers_cm1 =
        bands.weigh(bands.nodes_cm1()).iter().zip(&widths).map(|(sum, width)| sum / width).collect();
    let (low, high) = bands.range_cm1();
    let pixels = maps.material.len();
    let used: Vec<usize> = (0..bands.len()).filter(|band| !measured.bad_bands.contains(band)).collect();
    let rows: Vec<ClusterRow> = clusters
        .into_iter()
        .enumerate()
        .map(|(i, cluster)| {
            let own: Vec<usize> = (0..pixels).filter(|p| usize::from(maps.material[*p]) == i).collect();
            let temperatures = own.iter().map(|p| f64::from(maps.temperature_k[*p])).collect();
            ClusterRow {
                name: name(i),
                pixels: own.len(),
                temperature_median_k: median(temperatures).unwrap_or(f64::NAN),
                emissivity_mean: used.iter().map(|band| cluster.emissivity[*band]).sum::<f64>()
                    / used.len().max(1) as f64,
                cluster,
            }
        })
        .collect();
    // Every cluster counts as much as it has pixels.
    let (mut square, mut weight) = (0.0, 0.0);
    for row in &rows {
        for band in &used {
            let one = &row.cluster;
            let pixels = row.pixels as f64;
            square += pixels * (one.sigma[*band].powi(2) + one.spread[*band].powi(2));
            weight += pixels * one.emissivity[*band].powi(2);
        }
    }
    let skipped = flags(&maps, &measured.bad, &mut warnings);
    LibraryFound {
        scenario: scenario.clone(),
        read: measured.read.clone(),
        shape: measured.cube.shape(),
        wavenumbers_cm1,
        range_cm1: [low, high],
        pixels,
        decided: (0..pixels).filter(|i| maps.is_decided(*i)).count(),
        drawn,
        without_nem,
        clusters: rows,
        misfits,
        tried,
        prior,
        flags: skipped,
        emissivity_error: if weight > 0.0 { f64::sqrt(square / weight) } else { 0.0 },
        shared,
        surroundings_found: measured.found.clone(),
        bad: measured.bad.clone(),
        truth,
        stats: maps.spared.work(),
        warnings,
        maps,
    }
}
