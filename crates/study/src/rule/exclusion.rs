//! What it rests on that a camera excludes a category: what meeting the clause would rest on, did it demand Φ⁻¹(0.99).

use super::apart::TellApart;
use super::pairs::Searched;
use super::results::{CameraVerdict, EnvelopeResult};
use super::safety::{SafetyOfRule, rows};
use super::search::Limit;
use crate::Study;
use crate::condition::Condition;
use crate::identify::AT_99;
use hadar::error::Result;

impl TellApart {
    /// Of every category with `safety = true` and every camera, each with the worst that was found of it.
    pub(super) fn safety(
        &self,
        envelope: &EnvelopeResult,
        cameras: &[CameraVerdict],
        worst: &[&Searched],
        constants: &[String],
    ) -> Result<Vec<SafetyOfRule>> {
        let mut rows = rows(&self.scenario.categories, envelope, cameras, constants);
        for row in rows.iter_mut().filter(|row| row.excluded) {
            let Some(index) = cameras.iter().position(|camera| camera.name == row.camera) else { continue };
            row.conditions = match worst.get(index) {
                Some(worst) if self.required < AT_99 => {
                    self.conditions_at(AT_99, index, worst, cameras[index].lower_bound)?
                }
                _ => cameras[index].conditions.clone(),
            };
        }
        Ok(rows)
    }

    /// What meeting a demand that is more than the clause's own rests on.
    fn conditions_at(
        &self,
        required: f64,
        index: usize,
        worst: &Searched,
        lower_bound: Option<f64>,
    ) -> Result<Vec<Condition>> {
        let mut candidate = self.candidates[index].clone();
        let looked = candidate.sighted.iter_mut().chain(&mut candidate.between);
        looked.map(|sighted| &mut sighted.study).chain(&mut candidate.near).for_each(|study| {
            study.required = required;
        });
        let strict = Self { required, candidates: Vec::new(), ..self.clone() };
        let sighted = worst.between.as_deref().unwrap_or(&candidate.sighted[worst.pair.sighted]);
        let at = Study { state: worst.pair.state.clone(), required, ..sighted.study.clone() };
        let image = at.camera.as_ref().map(|camera| strict.image(&candidate, camera)).unwrap_or_default();
        let surface = &sighted.study.alternatives[worst.pair.alternative];
        strict.conditions(&candidate, true, &image, &Limit { at: &at, surface, lower_bound })
    }
}
