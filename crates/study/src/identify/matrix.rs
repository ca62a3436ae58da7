//! All materials against all: who can be told from whom, and the groups that cannot.

mod results;

pub use results::{Apart, Check, Matrix, Rows, TargetVerdict};

use crate::decision::YesNo;
use crate::{Study, Surface};
use hadar::demand::{self, Ledger, Reason, Skipping, Thing};
use hadar::error::{Error, Result};
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::multi::{self, LibraryScene, LocalMatrix, NearestMatrix, Passes, Progress};
use hadar_scenario::DistanceKind;
use std::collections::HashMap;

impl Study {
    /// Target and alternatives, each once; of classes all members.
    ///
    /// # Errors
    /// A single material; different spectra of the same name.
    pub fn materials(&self) -> Result<Vec<&Surface>> {
        let mut all: Vec<&Surface> = Vec::new();
        let mut by_name: HashMap<&str, &Surface> = HashMap::new();
        for surface in self.all_members() {
            match by_name.insert(&surface.name, surface) {
                Some(known) if known.emissivity == surface.emissivity => {}
                Some(_) => {
                    let found = format!("two different spectra are called `{}`", surface.name);
                    return Err(Error::malformed(found, "rename one of them")
                        .at(self.scenario.place("alternatives.materials")));
                }
                None => all.push(surface),
            }
        }
        if all.len() > 1 {
            return Ok(all);
        }
        let found = format!("`{}` is the only material", self.target.name);
        let instead = "name at least one other in alternatives.materials";
        Err(Error::malformed(found, instead).at(self.scenario.place("alternatives")))
    }

    /// The scene that all materials share.
    pub(crate) fn library_scene(&self) -> LibraryScene<'_> {
        LibraryScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            unknowns: &self.unknowns,
            range: self.range,
            state: &self.state,
            tolerance: Some(self.tolerance()),
        }
    }

    /// Distances of all materials against all, and with a camera who can be told from whom. `progress` is told the targets
    /// whose nearest distances are searched.
    ///
    /// # Errors
    /// As [`Study::materials`] and [`Study::identify`].
    pub fn matrix(&self, progress: Progress<'_>) -> Result<Matrix> {
        let materials = self.materials()?;
        let emissivities: Vec<&[f64]> = materials.iter().map(|m| m.emissivity.as_slice()).collect();
        let names: Vec<String> = materials.iter().map(|m| m.name.clone()).collect();
        let (count, kind) = (names.len(), self.scenario.requirement.by);
        let counting = self.counting();
        let again = counting.is_some() && kind == DistanceKind::Nearest;
        let all = count * (1 + usize::from(again));
        let second = |done, _| progress(count + done, all);
        let of =
            |kind, counting: Option<&Counting>| self.all_distances(kind, &emissivities, counting, &second);
        let mut solver = LocalMatrix::new(&self.bands, &self.surroundings, self.unknowns.clone());
        let local = solver
            .per_photon(&emissivities, &self.state)
            .map_err(|error| error.at(self.scenario.place("bands")))?;
        let relative_error = solver.relative_errors(&local);
        let found = self.library_scene().nearest_per_photon(&emissivities, &|done, _| progress(done, all))?;
        let unproved = (0..count * count).filter(|&i| !found.is_proved_to(i, self.tolerance())).count();
        let NearestMatrix { distance: nearest, lower, relative_error: relative_error_nearest } = found;
        let statistical = counting.as_ref().map(|counting| of(kind, Some(counting))).transpose()?;
        let (by_kind, error_by_kind) = match kind {
            DistanceKind::Nearest => (nearest.clone(), None),
            DistanceKind::Local => (local.clone(), Some(relative_error.clone())),
            DistanceKind::LocalUnknownGain => {
                let all = of(kind, None)?;
                (all.found, all.errors)
            }
        };
        // What is proved that the camera reaches, whatever rounding did to it.
        let reached = statistical.as_ref().map(|all| surely(&all.lower, all.errors.as_deref()));
        let statistical = statistical.map(|all| all.found);
        let distances_asked = count * (count - 1);
        self.book_passes(solver.passes(), distances_asked);
        demand::computed(Thing::NearestSearches, distances_asked as u64);
        if statistical.is_some() {
            self.book_distances(kind, distances_asked);
        }
        if kind == DistanceKind::LocalUnknownGain {
            self.book_distances(kind, distances_asked);
        }
        let required = match &counting {
            Some(counting) => self.surely_required(counting),
            None => self.required,
        };
        let targets = (0..count)
            .map(|target| {
                let decisive = |other: &usize| {
                    let at = target * count + other;
                    reached.as_ref().map_or(by_kind[at], |d| d[at])
                };
                let others = (0..count).filter(|&other| other != target);
                let limiting = others.min_by(|a, b| decisive(a).total_cmp(&decisive(b))).unwrap_or(target);
                let least = statistical.as_ref().map(|d| d[target * count + limiting]);
                TargetVerdict {
                    material: names[target].clone(),
                    limiting: names[limiting].clone(),
                    distance_minimum: by_kind[target * count + limiting],
                    statistical_distance_minimum: least,
                    statistical_distance_minimum_lower: reached
                        .as_ref()
                        .map(|d| d[target * count + limiting]),
                    identifiable: reached.as_ref().map(|reached| {
                        (0..count)
                            .filter(|&other| other != target)
                            .all(|other| reached[target * count + other] >= required)
                    }),
                }
            })
            .collect();
        let apart = reached.as_ref().map(|d| {
            let told = |a: usize, b: usize| d[a * count + b] >= required && d[b * count + a] >= required;
            sorted_out(&names, told)
        });
        Ok(Matrix {
            by: kind.name(),
            distance_nearest: rows(&nearest, count),
            distance_nearest_lower: rows(&lower, count),
            relative_error_nearest: rows(&relative_error_nearest, count),
            distance_local: rows(&local, count),
            relative_error: rows(&relative_error, count),
            distance_local_unknown_gain: (kind == DistanceKind::LocalUnknownGain)
                .then(|| rows(&by_kind, count)),
            relative_error_unknown_gain: error_by_kind
                .filter(|_| kind == DistanceKind::LocalUnknownGain)
                .map(|errors| rows(&errors, count)),
            statistical_distance: statistical.map(|d| rows(&d, count)),
            statistical_distance_lower: reached.map(|d| rows(&d, count)),
            required_distance: self.required,
            targets,
            apart,
            safety: self.safety_of_matrix(&materials)?,
            unproved,
            passes: solver.passes(),
            materials: names,
        })
    }

    /// The local distances of a matrix, with the columns of derivatives that targets lent to all their pairs.
    fn book_passes(&self, passes: Passes, distances: usize) {
        self.book_local(&self.unknowns, passes.alone);
        let shared = distances.saturating_sub(passes.alone);
        let objects = self.surroundings.objects().len();
        let (asked, all) = (self.unknowns.parameters(objects).len(), 3 + 2 * objects);
        // A target's nuisances are formed once, and the alternatives' columns band by band as they are used.
        let formed = passes.shared_targets * asked;
        demand::computed(Thing::LocalDistances, shared as u64);
        demand::computed(Thing::DerivativeColumns, formed as u64);
        demand::spared(
            Thing::DerivativeColumns,
            Reason::Shared,
            (shared * asked).saturating_sub(formed) as u64,
        );
        demand::spared(Thing::DerivativeColumns, Reason::NotAsked, (shared * (all - asked)) as u64);
    }

    /// Which materials the camera tells apart, stopping at the first proof of each pair. `progress` is told the pairs decided.
    ///
    /// # Errors
    /// As [`Study::matrix`]; a scenario without a camera.
    pub fn told_apart(&self, skipping: Skipping, progress: Progress<'_>) -> Result<Apart> {
        let materials = self.materials()?;
        let emissivities: Vec<&[f64]> = materials.iter().map(|m| m.emissivity.as_slice()).collect();
        let names: Vec<String> = materials.iter().map(|m| m.name.clone()).collect();
        let counting = self.needed_counting()?;
        let (kind, required) = (self.scenario.requirement.by, self.surely_required(&counting));
        if kind == DistanceKind::Nearest {
            let scene = self.library_scene();
            let found = scene.told_apart(&emissivities, &counting, required, skipping, progress)?;
            return Ok(sorted_out(&names, |a, b| found.told_apart(a, b)));
        }
        // All local distances together take less time than bounds on each would.
        let all = self.all_distances(kind, &emissivities, Some(&counting), progress)?;
        let d = surely(&all.lower, all.errors.as_deref());
        let count = names.len();
        let told = |a: usize, b: usize| d[a * count + b] >= required && d[b * count + a] >= required;
        self.book_distances(kind, count * (count - 1));
        Ok(sorted_out(&names, told))
    }

    /// Whether the camera tells the target from every alternative, ending at the first one it does not.
    ///
    /// # Errors
    /// As [`Study::told_apart`].
    pub fn check(&self, skipping: Skipping) -> Result<Check> {
        let counting = self.needed_counting()?;
        let kind = self.scenario.requirement.by;
        let ledger = Ledger::open();
        demand::add(&self.looked_up);
        let failed = if self.has_classes() {
            self.classes.iter().position(|answer| answer.told_apart != Some(true))
        } else if kind == DistanceKind::Nearest
            && self.errors_shared().is_none()
            && self.counts_are_many(&self.bands, &counting)
        {
            let emissivities: Vec<&[f64]> =
                std::iter::once(&self.target).chain(&self.alternatives).map(|m| &m.emissivity[..]).collect();
            let scene = self.library_scene();
            let failed = scene.first_not_told_from(0, &emissivities, &counting, self.required, skipping)?;
            failed.map(|i| i - 1)
        } else {
            skipping.until(
                self.alternatives.iter().enumerate(),
                &[Thing::LocalDistances],
                |(i, alternative)| {
                    let decision = self.decided(kind, alternative, &counting)?;
                    Ok((decision.told != YesNo::Yes).then_some(i))
                },
            )?
        };
        Ok(Check {
            scenario: self.scenario.clone(),
            identifiable: failed.is_none(),
            not_told_from: failed.map(|index| self.alternatives[index].name.clone()),
            failed,
            conditions: Vec::new(),
            accepted: Vec::new(),
            stats: ledger.close(),
        })
    }

    /// The same with what it rests on: of a 'yes' that takes all distances.
    ///
    /// # Errors
    /// As [`Study::check`].
    pub fn check_with_conditions(&self, skipping: Skipping) -> Result<Check> {
        let mut check = self.check(skipping)?;
        if let Some(camera) = &self.camera {
            let pairs = if check.identifiable { self.identify()?.pairs } else { Vec::new() };
            check.conditions = self.conditions_of_pairs(camera, &pairs, &[])?;
        }
        Ok(check)
    }

    fn needed_counting(&self) -> Result<Counting> {
        self.counting().ok_or_else(|| {
            let found = "without a camera nothing decides which materials can be distinguished";
            let instead = "add a [camera], e.g. preset = \"flir-a325sc\"";
            Error::malformed(found, instead).at(self.scenario.place("camera"))
        })
    }

    /// Distances of a kind, row-major: statistical ones of the camera, or without `counting` those per √photon; with their
    /// relative errors where the solver tells them.
    pub(crate) fn all_distances(
        &self,
        kind: DistanceKind,
        emissivities: &[&[f64]],
        counting: Option<&Counting>,
        progress: Progress<'_>,
    ) -> Result<All> {
        let local = |unknowns: Unknowns| {
            let mut matrix = LocalMatrix::new(&self.bands, &self.surroundings, unknowns);
            let found = match counting {
                Some(counting) => matrix.with_counting(emissivities, &self.state, counting),
                None => matrix.per_photon(emissivities, &self.state),
            }?;
            let errors = Some(matrix.relative_errors(&found));
            Ok(All { lower: found.clone(), found, errors })
        };
        let proved = |found: NearestMatrix| All {
            lower: self.all_sure(&found),
            found: found.distance,
            errors: counting.is_some().then_some(found.relative_error),
        };
        let scene = self.library_scene();
        let found = match (kind, counting) {
            (DistanceKind::Nearest, Some(counting)) => {
                scene.nearest_with_counting(emissivities, counting, progress).map(proved)
            }
            (DistanceKind::Nearest, None) => scene.nearest_per_photon(emissivities, progress).map(proved),
            (DistanceKind::Local, _) => local(self.unknowns.clone()),
            (DistanceKind::LocalUnknownGain, _) => local(self.unknowns.with(Nuisance::Gain)),
        };
        found.map_err(|error| error.at(self.scenario.place("bands")))
    }

    /// What verdicts may rest on of nearest states, 0 on the diagonal.
    fn all_sure(&self, found: &NearestMatrix) -> Vec<f64> {
        let sure = |i| self.sure(found.distance[i], found.lower[i]);
        (0..found.distance.len()).map(sure).collect()
    }
}

/// Distances of all against all, row-major: as they were found, and what a verdict may rest on.
pub(crate) struct All {
    pub(crate) found: Vec<f64>,
    pub(crate) lower: Vec<f64>,
    /// Their relative errors, where the solver tells them.
    pub(crate) errors: Option<Vec<f64>>,
}

/// What distances are at least, whatever rounding did to them.
fn surely(distances: &[f64], relative_errors: Option<&[f64]>) -> Vec<f64> {
    let error = |i: usize| relative_errors.and_then(|errors| errors.get(i)).copied().unwrap_or(0.0);
    distances.iter().enumerate().map(|(i, d)| d * (1.0 - error(i))).collect()
}

fn rows(distances: &[f64], count: usize) -> Rows {
    let row = |(target, row): (usize, &[f64])| {
        row.iter().enumerate().map(|(other, d)| (other != target).then_some(*d)).collect()
    };
    distances.chunks(count).enumerate().map(row).collect()
}

fn sorted_out(names: &[String], told: impl Fn(usize, usize) -> bool) -> Apart {
    let (mut told_apart, mut not_told_apart) = (Vec::new(), Vec::new());
    for a in 0..names.len() {
        for b in a + 1..names.len() {
            let pair = [names[a].clone(), names[b].clone()];
            if told(a, b) { told_apart.push(pair) } else { not_told_apart.push(pair) }
        }
    }
    let named = |groups: Vec<Vec<usize>>| -> Vec<Vec<String>> {
        groups.iter().map(|group| group.iter().map(|&i| names[i].clone()).collect()).collect()
    };
    let alike = |a: usize, b: usize| a != b && !told(a, b);
    let clusters = named(multi::clusters(names.len(), alike));
    let chains = named(multi::chains(names.len(), alike));
    Apart { told_apart, not_told_apart, clusters, chains }
}
