//! Whether a cube follows the model that it is decomposed with, and what may be otherwise than it was told.
//!
//! All pixels together are asked ([`hadar_estimate::decompose::judge`]): their p-values, the residual that they have in common in
//! each band, and along each [`Cause`]. A model is rejected where one of them is so far from nothing that of a thousand right cubes a few
//! are at most: p-values [`P_LIMIT`] deviations below their mean, a cause (a band is one) [`LIMIT`] deviations from 0; or where most pixels
//! fit nothing. What is seen and does no harm, as it moves temperatures by less than [`HARM`] of their deviations, is told and rejects
//! nothing: of many pixels any model is a little wrong. What is said of its pixels then holds only if the model does, and the deviations of temperatures hold what the
//! causes that explain most would do.
//!
//! Assumptions: those of the sums. With stated errors of the library, which are the same in all pixels of a material, p-values and bands are not asked, and
//! causes beside what these errors do. Not judged are methods that leave light out.

use super::DecomposeStudy;
use super::estimated::{AGAINST, Estimated};
use crate::cube_sample::{LOOKED, some};
use crate::model_judged::{BandResidual, CauseRow, ModelJudged, ModelVerdict, p_values, said};
use crate::shared_unknown::hottest_k;
use hadar::atmosphere::Atmosphere;
use hadar::cube::Cube;
use hadar::error::Result;
use hadar_estimate::decompose::{
    Cause, Judged, Light, Maps, Method, Options, Setting, Shared, ToHold, Together, decompose_by, judge,
    p_deviations,
};
use hadar_scenario::decompose::LightSource;

/// Deviations of the mean p-value from which on a model is rejected: three of a hundred thousand right ones are.
const P_LIMIT: f64 = 4.0;
/// Deviations of a band or a cause: seven of a million of each.
const LIMIT: f64 = 4.5;
/// Deviations of a temperature, rms over the pixels, below which a cause does no harm: 95 % intervals then hold 93 %.
const HARM: f64 = 0.4;
/// The same of the mean p-value.
const P_HARM: f64 = 0.01;
/// Share of the pixels that fit nothing from which on the model is rejected by that alone.
const UNFIT: f64 = 0.5;
/// Share of what the best cause explains from which on another one may be it as well.
const MAY_BE: f64 = 0.5;
/// Temperature of the standard atmosphere at the ground, K.
const AIR_K: f64 = 288.15;

/// What was asked of some pixels, and what is to be put into the deviations.
#[derive(Debug, Default)]
pub(super) struct Asked {
    causes: Vec<Cause>,
    judged: Option<Judged>,
    most_decided: bool,
    /// Pixels that some material fits, the sum of their p-values, and pixels that none fits, where other hypotheses beside the materials are in the maps.
    plain: Option<(usize, f64, usize)>,
    /// Whether the library is taken as exact.
    exact: bool,
    /// Whether materials can be decided with what is known of what the cube shares.
    is_told: bool,
    /// What was estimated far from what was stated of it.
    against: Vec<CauseRow>,
}

/// What the deviations of temperatures have to hold.
#[derive(Debug)]
pub(super) struct Wider {
    /// Causes with how much of each.
    pub(super) causes: Vec<ToHold>,
    /// By how much all noise is larger.
    pub(super) noise: f64,
}

impl Asked {
    /// Asks the pixels of whole maps, or some of the cube that are decomposed for that.
    pub(super) fn of(
        study: &DecomposeStudy,
        method: Method,
        setting: &Setting<'_>,
        options: &Options,
        (whole, estimated): (Option<&Maps>, Option<&Estimated>),
    ) -> Result<Self> {
        let exact = options.library_error.is_none();
        let is_told = estimated.is_none_or(Estimated::is_told);
        let shared = estimated.map(|estimated| &estimated.shared);
        if method != Method::Ml || setting.gain {
            return Ok(Self { exact, is_told, ..Self::default() });
        }
        let shape = study.cube.shape();
        let mut causes = causes(study, setting, exact);
        let known = shared.map_or_else(Vec::new, Shared::causes);
        causes.retain(|cause| !known.iter().any(|one| said(one) == said(cause)));
        let against = shared.map_or_else(Vec::new, against);
        let mut asked = Self { causes, exact, is_told, against, ..Self::default() };
        let error = (options.library_error, shared);
        let pixels = |maps: &Maps| {
            let (fitting, _, unfit) = p_values(maps);
            fitting + unfit
        };
        let (judged, asked_of) = match whole.filter(|_| shape.rows() * shape.columns() <= LOOKED) {
            Some(maps) => (judge(setting, &asked.causes, error, maps, &study.cube)?, pixels(maps)),
            None => {
                let some = match &study.cube {
                    Cube::F32(rows) => Cube::F32(Box::new(some(rows.as_ref(), LOOKED)?)),
                    Cube::F64(rows) => Cube::F64(Box::new(some(rows.as_ref(), LOOKED)?)),
                };
                let has_doubts = options.other.is_some() || options.mixed.is_some();
                let plain = Options { spatial: None, other: None, mixed: None, ..options.clone() };
                let maps = decompose_by(method, setting, &plain, &some, &|_| ())?;
                asked.plain = Some(p_values(&maps)).filter(|_| has_doubts);
                (judge(setting, &asked.causes, error, &maps, &some)?, pixels(&maps))
            }
        };
        asked.most_decided = 2 * judged.all.pixels > asked_of;
        asked.judged = Some(judged);
        Ok(asked)
    }

    /// The sums that causes are told from: of pixels that fit, unless most do not. Nothing where few pixels are decided: those few are
    /// the ones that their noise made clear, which is a cause of its own.
    fn sums(&self) -> Option<&Together> {
        let judged = self.judged.as_ref().filter(|_| self.most_decided)?;
        let most_fit = 2 * judged.fitting.pixels >= judged.all.pixels;
        Some(if most_fit { &judged.fitting } else { &judged.all })
    }

    /// What χ² gains by a cause.
    fn gain(sums: &Together, cause: usize) -> f64 {
        sums.alone(cause).map_or(0.0, |found| found.gain_chi_square)
    }

    /// What the likelihood gains by larger noise in all bands, twice, and the factor of its deviations; nothing where errors of the library are in
    /// the residuals.
    fn noise(&self, sums: &Together) -> Option<(f64, f64)> {
        let ratio = sums.chi_square / sums.freedom;
        (self.exact && ratio > 0.0 && ratio.is_finite())
            .then(|| (sums.freedom * (ratio - 1.0 - ratio.ln()), ratio.sqrt()))
    }

    /// What must be gained by what may be the cause: half as much as by the best one, if that is no chance.
    fn least_gain(&self, sums: &Together) -> f64 {
        let best = (0..self.causes.len()).map(|i| Self::gain(sums, i)).fold(0.0, f64::max);
        let best = best.max(self.noise(sums).map_or(0.0, |(gain, _)| gain));
        if best > LIMIT * LIMIT { MAY_BE * best } else { f64::INFINITY }
    }

    /// Causes that the pixels see and that explain at least half as much as the best.
    fn may_be(&self, sums: &Together) -> Vec<usize> {
        let least = self.least_gain(sums);
        (0..self.causes.len()).filter(|i| Self::gain(sums, *i) >= least).collect()
    }

    /// Whether what explains most would move temperatures by more than is harmless, or another that may be it by twice as much.
    fn does_harm(&self, sums: &Together) -> bool {
        let may_be = self.may_be(sums);
        let best =
            may_be.iter().copied().max_by(|a, b| Self::gain(sums, *a).total_cmp(&Self::gain(sums, *b)));
        best.is_some_and(|best| sums.temperature_moved(best) > HARM)
            || may_be.into_iter().any(|i| sums.temperature_moved(i) > 2.0 * HARM)
    }

    /// Whether bands or causes reject the model.
    fn rejects(&self) -> bool {
        let (Some(sums), Some(Judged { fitting, all, .. })) = (self.sums(), &self.judged) else {
            return false;
        };
        let unfit = (fitting.pixels as f64) < (1.0 - UNFIT) * all.pixels as f64;
        unfit
            || !self.against.is_empty()
            || self.exact && below(fitting.p_values, fitting.pixels)
            || self.does_harm(sums)
    }

    /// What the deviations have to hold; nothing while nothing speaks against the model.
    pub(super) fn to_hold(&self) -> Option<Wider> {
        let sums = self.sums().filter(|_| self.rejects())?;
        let of = |i: usize| {
            let (cause, amount) = (self.causes.get(i)?.clone(), sums.alone(i)?.estimate);
            Some(ToHold { cause, amount, follow: sums.follow(i).to_vec() })
        };
        let larger = self.noise(sums).filter(|(gain, _)| *gain >= self.least_gain(sums));
        Some(Wider {
            causes: self.may_be(sums).into_iter().filter_map(of).collect(),
            noise: larger.map_or(1.0, |(_, factor)| factor.max(1.0)),
        })
    }

    /// What is said of the model.
    pub(super) fn found(
        &self,
        study: &DecomposeStudy,
        method: Method,
        counted: (usize, f64, usize),
    ) -> ModelJudged {
        let (pixels, p_sum, unfit) = self.plain.unwrap_or(counted);
        // Only what is known of all pixels, or of some together.
        let is_judged = method == Method::Ml && pixels + unfit > 0 && (self.exact || self.sums().is_some());
        let p_z = p_deviations(p_sum, pixels);
        let unfit_share = unfit as f64 / (pixels + unfit).max(1) as f64;
        let rejected = self.exact && below(p_sum, pixels) || unfit_share > UNFIT || self.rejects();
        let sums = self.sums();
        let wide = study.told.bands.weigh(study.told.bands.nodes_cm1());
        let widths = study.told.bands.widths_cm1();
        let bands =
            sums.zip(self.judged.as_ref()).filter(|_| self.exact).map_or_else(Vec::new, |(sums, judged)| {
                let of = |(band, [sum, var]): (&usize, &[f64; 2])| BandResidual {
                    band: *band,
                    wavenumber_cm1: wide[*band] / widths[*band],
                    residual: sum / sums.pixels.max(1) as f64,
                    deviations: if *var > 0.0 { sum / var.sqrt() } else { 0.0 },
                };
                judged.bands.iter().zip(&sums.residual).map(of).collect()
            });
        let of_exact = |x: f64| (is_judged && self.exact && x.is_finite()).then_some(x);
        ModelJudged {
            verdict: match (is_judged, rejected) {
                (true, true) => ModelVerdict::Rejected,
                _ if !self.is_told => ModelVerdict::SharedNotTold,
                // Where no cause was asked for, nothing was heard against it.
                (true, false) if sums.is_some() => ModelVerdict::NotRejected,
                _ => ModelVerdict::NotJudged,
            },
            pixels,
            p_value_mean: of_exact(p_sum / pixels as f64),
            p_value_deviations: of_exact(p_z),
            unfit: is_judged.then_some(unfit_share),
            pixels_asked: sums.map_or(0, |sums| sums.pixels),
            chi_square_reduced: sums
                .filter(|sums| self.exact && sums.freedom > 0.0)
                .map(|sums| sums.chi_square / sums.freedom),
            bands,
            causes: sums.map_or_else(Vec::new, |sums| self.rows(sums)),
        }
    }

    fn rows(&self, sums: &Together) -> Vec<CauseRow> {
        let mut rows: Vec<CauseRow> = (0..self.causes.len())
            .filter_map(|i| {
                let found = sums.alone(i)?;
                let (cause, light, band, unit) = said(self.causes.get(i)?);
                Some(CauseRow {
                    cause,
                    light,
                    band,
                    estimate: found.estimate,
                    sigma: found.sigma,
                    unit,
                    gain_chi_square: found.gain_chi_square,
                    temperature_moved: Some(sums.temperature_moved(i)),
                    may_be: false,
                })
            })
            .collect();
        if let Some((gain, factor)) = self.noise(sums) {
            rows.push(CauseRow {
                cause: "noise",
                light: None,
                band: None,
                estimate: factor - 1.0,
                sigma: (0.5 / sums.freedom).sqrt() * factor,
                unit: "",
                gain_chi_square: gain,
                temperature_moved: None,
                may_be: false,
            });
        }
        rows.sort_by(|a, b| b.gain_chi_square.total_cmp(&a.gain_chi_square));
        let least = self.least_gain(sums);
        rows.iter_mut().for_each(|row| row.may_be = row.gain_chi_square >= least);
        rows.splice(0..0, self.against.iter().cloned());
        rows
    }
}

/// Whether the mean of p-values is below that of a right model, by chance hardly and by more than does no harm.
fn below(sum: f64, pixels: usize) -> bool {
    p_deviations(sum, pixels) > P_LIMIT && 0.5 - sum / pixels.max(1) as f64 > P_HARM
}

/// What was estimated too far from what was stated of it: with how many deviations of the prior, squared.
fn against(shared: &Shared) -> Vec<CauseRow> {
    let each = shared.unknowns.iter().zip(&shared.amounts).enumerate();
    each.filter(|(_, (one, amount))| amount.abs() > AGAINST * one.sigma)
        .map(|(i, (one, amount))| {
            let (cause, light, band, unit) = said(&one.cause);
            CauseRow {
                cause,
                light,
                band,
                estimate: *amount,
                sigma: shared.sigma(i),
                unit,
                gain_chi_square: (amount / one.sigma).powi(2),
                temperature_moved: None,
                may_be: true,
            }
        })
        .collect()
}

/// What may be otherwise than told in a study.
fn causes(study: &DecomposeStudy, setting: &Setting<'_>, exact: bool) -> Vec<Cause> {
    let nodes = setting.bands.nodes_cm1();
    let mut all = vec![Cause::Gain, Cause::WavelengthShift(study.spectra.clone())];
    for (light, source) in study.scenario.environment.iter().enumerate() {
        all.extend([Cause::LightScale(light), Cause::LightShape { light, order: 1 }]);
        if let (LightSource::Surface { temperature_k, .. }, Some(Light::Radiance(_))) =
            (source, setting.surroundings.get(light))
        {
            all.push(Cause::LightTemperature { light, temperature_k: *temperature_k });
        }
    }
    if setting.lighting_total.is_some() {
        all.push(Cause::LightingTotal);
    }
    all.push(Cause::LightMissing { temperature_k: hottest_k(&study.scenario.environment) });
    // Where the table of the air does not reach the bands, it cannot be told.
    let (depth, temperature_k) = match &study.air {
        Some((air, distance_m)) => {
            let growth = air.table.optical_depth_and_growth(nodes, *distance_m);
            (growth.map(|(_, growth)| growth), air.temperature_k)
        }
        None => (Atmosphere::embedded("us-standard").and_then(|air| air.optical_depth(nodes, 1.0)), AIR_K),
    };
    all.extend(depth.map(|depth_per_m| Cause::Air { depth_per_m, temperature_k }));
    // Errors of the library are such in every band.
    let is_used = |band: &usize| exact && !setting.bad_bands.contains(band);
    all.extend((0..setting.bands.len()).filter(is_used).map(Cause::Band));
    all
}
