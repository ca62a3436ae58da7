//! Temperature of the scenario's target, read by its camera at a series of true temperatures: the paper's Extended Data
//! Fig. 9e, f.
//!
//! At every temperature the same spectra are read by maximum likelihood with the lighting known, by maximum likelihood
//! with it unknown if the scenario has it among its unknowns, and by thermal imaging from the sum of the counts with a
//! fixed emissivity of 0.95 and with one entered by hand, calibrated at the lowest temperature
//! (`simulate::thermometry`). Beside them stand the Cramér–Rao bounds (`fisher::precision`) and whether they are
//! reached (`simulate::efficiency`).
//!
//! The bound for unbiased estimates does not hold where the range of the lighting, V₀ ≤ V ≤ V₀ + w, stops the fits:
//! [`Reader::at_edge`] counts them. Beside it stands a hybrid Cramér–Rao bound ([`ThermometryRow::bound_range_k`]):
//! T is fixed, V random with the law 2cos²(π(V − V₀ − ½w)/w)/w, whose information is (2π/w)². It limits the error,
//! averaged over that law, of estimates of T that are unbiased on average over it: not that of any estimate, nor the
//! error at one V. Of K objects w is the side of a box within the range and ΣV ≤ 1. The information of the counts is
//! taken at the scenario's own V instead of averaged over the law. With a prior on the lighting there is none: the law
//! would be the product of the two, whose information is not the sum of theirs.
//!
//! Known: the emissivity. Besides the temperature is unknown what the scenario says ([`Thermometry::unknown`]), with
//! its priors; bounds with a prior are hybrid ones too, for errors averaged over the prior.
//!
//! Source: paper, Methods 'HADAR thermography', Extended Data Fig. 9; van Trees, 'Detection, Estimation, and Modulation
//! Theory' I (1968), section 2.4; Rockah and Schultheiss, IEEE
//! Trans. Acoust. Speech Signal Process. 35, 286 (1987) (hybrid bound); Gill and Levit, Bernoulli 1, 59 (1995),
//! doi:10.2307/3318681 (law).

use crate::{Study, Warning};
use hadar::demand::{Reason, Thing, Work};
use hadar::error::{Error, Result};
use hadar::fisher::precision::{JointBound, Precision, Sight};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::scene::{Parameter, State};
use hadar_scenario::Units;
use hadar_simulate::draws::GENERATOR;
use hadar_simulate::efficiency::{Criteria, Efficiency, Errors, JointEfficiency, ParameterEfficiency};
use hadar_simulate::thermometry::{Conventional, Fits, Reading, Run, ThermometryScene};
use std::collections::BTreeMap;

/// The default emissivity of a thermal imager, as in the paper's figure.
pub const FIXED_EMISSIVITY: f64 = 0.95;
/// Most temperatures of a series.
const MOST_ROWS: usize = 10_000;
/// Share of the fits stopped by the range above which the bound for unbiased estimates is said not to apply.
const HELD: f64 = 1e-3;

/// A series of true temperatures and what is read at each.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Thermometry {
    /// Name of the target's material in the library.
    pub target: String,
    /// Name of the camera that reads the temperature.
    pub camera: String,
    /// Law by which the counts are distributed.
    pub statistics: &'static str,
    /// Units in which its scenario was written.
    #[serde(skip)]
    pub units: Units,
    /// True lighting factors of the target, 0 to 1.
    pub lighting: Vec<f64>,
    /// Temperatures of the surroundings, K.
    pub environment_k: Vec<f64>,
    /// What is unknown, by the names of scenario files: the temperature and what the scenario says.
    pub unknown: Vec<&'static str>,
    /// Deviations of the priors on unknowns, by their names (K, or dimensionless); they lower the bounds.
    pub priors: BTreeMap<&'static str, f64>,
    /// The known sum of the lighting factors.
    pub lighting_total: Option<f64>,
    /// Number of spectra drawn at each temperature.
    pub trials: usize,
    /// Seed from which the spectra were drawn.
    pub seed: u64,
    /// Generator that the seed belongs to.
    pub generator: &'static str,
    /// What intervals and verdicts rest on.
    pub criteria: Criteria,
    /// The imager with the default emissivity.
    pub fixed: Conventional,
    /// The imager with the emissivity entered by hand.
    pub manual: Conventional,
    /// Temperature at which that one is calibrated, K.
    pub calibrated_k: f64,
    /// Temperature by temperature, in the order asked for.
    pub rows: Vec<ThermometryRow>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

/// One true temperature.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ThermometryRow {
    /// True temperature of the target, K.
    pub temperature_k: f64,
    /// Photons of a spectrum, all bands together.
    pub photons: f64,
    /// Maximum likelihood with the lighting known.
    pub lighting_known: Reader,
    /// Maximum likelihood with the lighting unknown; `None` unless the scenario has it among its unknowns
    /// and surroundings.
    pub lighting_unknown: Option<Reader>,
    /// Hybrid bound with the lighting random within its range: for the error, averaged over that range, of estimates of
    /// the temperature that are unbiased on average over it, K. `None` with the lighting known or with a prior, or
    /// where nothing is seen.
    pub bound_range_k: Option<f64>,
    /// Thermal imaging with the default emissivity.
    pub fixed: ImagerErrors,
    /// Thermal imaging with the emissivity entered by hand.
    pub manual: ImagerErrors,
}

/// Maximum-likelihood estimates of the temperature compared with their bound.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Reader {
    /// Cramér–Rao bound of an unbiased estimate's deviation, K (hybrid, if there are priors); `None` if it is infinite.
    pub bound_k: Option<f64>,
    /// Estimated relative rounding error of the bound.
    pub bound_relative_error: f64,
    /// Whether temperature is seen at all.
    pub sight: Sight,
    /// Bias and errors of the estimates of the temperature, K.
    pub errors: Errors,
    /// Variance compared with the bound's, and the verdict; `None` without a bound.
    pub efficiency: Option<ParameterEfficiency>,
    /// The same over all unknown parameters together; `None` if one of them is not seen.
    pub joint: Option<JointEfficiency>,
    /// Share of the fits that ended at the edge of the parameters' range.
    pub at_edge: f64,
    /// Whether the bound, which is for unbiased estimates, says anything of these: at most 1 in 1000 ended at an edge.
    pub bound_applies: bool,
    /// Fits that did not converge.
    pub unconverged: usize,
}

/// Errors of a thermal imager.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ImagerErrors {
    /// Bias and errors of the readings, K; `None` if there are fewer than two.
    pub errors: Option<Errors>,
    /// Spectra that no temperature explains; not among the readings.
    pub without_reading: usize,
}

impl Study {
    /// Reads the temperature of the target from `trials` spectra of the camera at each true temperature. `progress` is
    /// called with the temperatures done and their number.
    ///
    /// # Errors
    /// No camera; no temperatures, or one that is not positive or outside of the range of states; fewer than two
    /// spectra at each; too many photons to draw.
    ///
    /// ```
    /// use hadar::material::Library;
    /// use hadar_scenario::Scenario;
    /// use hadar_study::Study;
    /// let text = r#"
    ///     [target]
    ///     material = "silicon-carbide"
    ///     temperature = "60 degC"
    ///     [[environment]]
    ///     temperature = "20 degC"
    ///     lighting = 0.5
    ///     [alternatives]
    ///     materials = ["aluminium"]
    ///     [bands]
    ///     start = "720 cm^-1"
    ///     stop = "1250 cm^-1"
    ///     step = "10 cm^-1"
    ///     [camera]
    ///     preset = "nicolet-is50"
    /// "#;
    /// let study = Study::new(&Scenario::from_toml(text, None)?, &Library::embedded()?)?;
    /// let found = study.thermometry(&[303.15, 373.15], 100, 1, &|_, _| {})?;
    /// // The emissivity entered by hand reads a hot target too cold.
    /// assert!(found.rows[1].manual.errors.is_some_and(|errors| errors.bias < -3.0));
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn thermometry(
        &self,
        temperatures_k: &[f64],
        trials: usize,
        seed: u64,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Thermometry> {
        let found = "thermometry reads temperatures, and excludes no category";
        self.no_safety(found)?;
        let Some((counting, camera)) = self.counting().zip(self.camera.as_ref()) else {
            let error = Error::malformed("thermometry without a camera", "add a [camera] to the scenario");
            return Err(error.at(self.scenario.place("camera")));
        };
        let total = temperatures_k.len();
        if !(1..=MOST_ROWS).contains(&total) {
            let expected = format!("1 to {MOST_ROWS}");
            return Err(Error::out_of_range("number of temperatures", total as f64, "", expected));
        }
        if trials < 2 {
            return Err(Error::out_of_range("spectra at each temperature", trials as f64, "", "at least 2"));
        }
        let states: Vec<State> = (temperatures_k.iter())
            .map(|&t| self.surroundings.state(t, &self.state.lighting))
            .collect::<Result<_>>()?;
        let scene = ThermometryScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            emissivity: &self.target.emissivity,
            range: self.range,
            counting: &counting,
        };
        let coldest = states.iter().min_by(|a, b| a.temperature_k.total_cmp(&b.temperature_k));
        let coldest = coldest.unwrap_or(&self.state);
        let lighting_known = self.thermometry_unknowns(false)?;
        let lighting_unknown = self.lighting_unknown()?;
        let readers = if lighting_unknown.is_some() { 2 } else { 1 };
        let all = lighting_unknown.as_ref().unwrap_or(&lighting_known);
        let (unknown, priors) = (self.effective(all), self.named_priors(all));
        let lighting_total = all.known_lighting_total();
        let series = Series {
            study: self,
            scene,
            lighting_known,
            lighting_unknown,
            criteria: Criteria { together: readers * total, ..Criteria::default() },
            fixed: Conventional::with_surroundings(FIXED_EMISSIVITY, &self.surroundings)?,
            manual: Conventional::calibrated(&scene, coldest)?,
        };
        let mut rows = Vec::with_capacity(total);
        for (index, state) in states.iter().enumerate() {
            progress(index, total);
            rows.push(series.row(state, Run { index: index as u32, trials, seed })?);
        }
        progress(total, total);
        let mut warnings = warnings(&rows);
        // Of the hottest of them, which is the brightest.
        let hottest = states.iter().max_by(|a, b| a.temperature_k.total_cmp(&b.temperature_k));
        let bright = Self { state: hottest.unwrap_or(&self.state).clone(), ..self.clone() };
        let seen = bright.camera_result(bright.photon_radiance());
        warnings.extend(seen.iter().flat_map(|seen| bright.image_warnings(seen)));
        let mut stats = self.looked_up.clone();
        // Every spectrum is drawn once, and read by the fits and by two imagers.
        let (drawn, read_by) = ((total * trials) as u64, readers as u64 + 2);
        stats.compute(Thing::Spectra, drawn);
        stats.spare(Thing::Spectra, Reason::Shared, drawn * (read_by - 1));
        stats.compute(Thing::Readings, drawn * read_by);
        Ok(Thermometry {
            target: self.target.name.clone(),
            camera: camera.name.clone(),
            statistics: scene.statistics()?.name(),
            units: self.units(),
            lighting: self.state.lighting.clone(),
            environment_k: self.state.environment_k.clone(),
            unknown: unknown.iter().map(|nuisance| nuisance.name()).collect(),
            priors,
            lighting_total,
            trials,
            seed,
            generator: GENERATOR,
            criteria: series.criteria,
            fixed: series.fixed,
            manual: series.manual,
            calibrated_k: coldest.temperature_k,
            rows,
            warnings,
            stats,
        })
    }

    /// The unknowns of the reader that does not know the lighting; `None` where there is none to know, or the scenario
    /// knows it.
    fn lighting_unknown(&self) -> Result<Option<Unknowns>> {
        let unknowns = self.thermometry_unknowns(true)?;
        let exists =
            self.is_unknown(Nuisance::Lighting) && self.effective(&unknowns).contains(&Nuisance::Lighting);
        Ok(exists.then_some(unknowns))
    }

    /// Nuisances that are parameters here: without surroundings there is no lighting, say.
    fn effective(&self, unknowns: &Unknowns) -> Vec<Nuisance> {
        let parameters = unknowns.parameters(self.surroundings.objects().len());
        let nuisances = unknowns.nuisances().iter().copied();
        nuisances.filter(|nuisance| parameters.contains(&parameter(*nuisance))).collect()
    }

    fn named_priors(&self, unknowns: &Unknowns) -> BTreeMap<&'static str, f64> {
        let with = |nuisance: Nuisance| Some((nuisance.name(), unknowns.sigma_prior(parameter(nuisance))?));
        self.effective(unknowns).into_iter().filter_map(with).collect()
    }

    /// The scenario's unknowns with temperature among them, lighting added or taken out.
    fn thermometry_unknowns(&self, with_lighting: bool) -> Result<Unknowns> {
        let others = self.unknowns.nuisances().iter().copied().filter(|n| *n != Nuisance::Lighting);
        let mut unknowns = Unknowns::new(others)?.with(Nuisance::Temperature);
        if with_lighting {
            unknowns =
                unknowns.with(Nuisance::Lighting).lighting_total(self.unknowns.known_lighting_total())?;
        }
        for nuisance in unknowns.nuisances().to_vec() {
            if let Some(sigma) = self.unknowns.sigma_prior(parameter(nuisance)) {
                unknowns = unknowns.prior(nuisance, sigma)?;
            }
        }
        Ok(unknowns)
    }
}

/// The first parameter of a kind.
fn parameter(nuisance: Nuisance) -> Parameter {
    match nuisance {
        Nuisance::Temperature => Parameter::Temperature,
        Nuisance::Lighting => Parameter::Lighting(0),
        Nuisance::Gain => Parameter::Gain,
        Nuisance::EnvironmentTemperature => Parameter::EnvironmentTemperature(0),
    }
}

/// What all rows share.
struct Series<'a> {
    study: &'a Study,
    scene: ThermometryScene<'a>,
    lighting_known: Unknowns,
    lighting_unknown: Option<Unknowns>,
    criteria: Criteria,
    fixed: Conventional,
    manual: Conventional,
}

impl Series<'_> {
    fn row(&self, state: &State, run: Run) -> Result<ThermometryRow> {
        let unknown: Vec<&Unknowns> =
            std::iter::once(&self.lighting_known).chain(&self.lighting_unknown).collect();
        let imagers = [&self.fixed, &self.manual];
        let (fits, readings) = self.scene.read(&unknown, &imagers, state, run)?;
        let mut fits = fits.into_iter();
        let mut next = |unknowns: &Unknowns| match fits.next() {
            Some(fits) => self.reader(unknowns, state, fits),
            None => Err(Error::malformed("a fit without an outcome", "report this as a bug")),
        };
        let lighting_known = next(&self.lighting_known)?;
        let (lighting_unknown, bound_range_k) = match &self.lighting_unknown {
            Some(unknown) => (Some(next(unknown)?), self.bound_range_k(unknown, state)?),
            None => (None, None),
        };
        let read = |i: usize| self.imager(readings.get(i).map(Vec::as_slice).unwrap_or_default(), state);
        Ok(ThermometryRow {
            temperature_k: state.temperature_k,
            photons: hadar::sum::sum(&self.scene.means(state)?),
            lighting_known,
            lighting_unknown,
            bound_range_k,
            fixed: read(0)?,
            manual: read(1)?,
        })
    }

    fn reader(&self, unknowns: &Unknowns, state: &State, fits: Fits) -> Result<Reader> {
        let bound = self.scene.bound(unknowns, state)?;
        let Some(own) = bound.each.iter().find(|one| one.parameter == Parameter::Temperature) else {
            return Err(Error::malformed("a fit without temperature", "report this as a bug"));
        };
        let estimates = fits.of(Parameter::Temperature);
        let truth = state.temperature_k;
        let errors = Errors::of(&estimates, truth, self.criteria.level)?;
        let joint = match &bound.joint {
            Some(joint) => Some(Efficiency::of(&fits.estimates, &fits.truth, joint, &self.criteria)?.joint),
            None => None,
        };
        let Fits { at_edge, unconverged, trials, .. } = fits;
        let at_edge = at_edge as f64 / trials as f64;
        Ok(Reader {
            bound_k: finite(own),
            bound_relative_error: own.relative_error,
            sight: own.sight,
            errors,
            efficiency: self.efficiency(own, &estimates, truth)?,
            joint,
            at_edge,
            bound_applies: at_edge <= HELD,
            unconverged,
        })
    }

    fn efficiency(
        &self,
        bound: &Precision,
        estimates: &[f64],
        truth: f64,
    ) -> Result<Option<ParameterEfficiency>> {
        let Some(sigma) = finite(bound) else { return Ok(None) };
        let bound = JointBound::from_sigma(sigma)?;
        let found = Efficiency::of(estimates, &[truth], &bound, &self.criteria)?;
        Ok(found.parameters.first().copied())
    }

    /// The bound with the range of the lighting as what is known of it beforehand.
    fn bound_range_k(&self, unknown: &Unknowns, state: &State) -> Result<Option<f64>> {
        if unknown.sigma_prior(Parameter::Lighting(0)).is_some() {
            return Ok(None);
        }
        let [low, high] = self.study.range.lighting;
        // Of several objects a box within what they may sum to.
        let objects = self.study.surroundings.objects().len().max(1) as f64;
        let sum = unknown.known_lighting_total().unwrap_or(self.study.range.lighting_sum);
        let width = high.min(sum / objects) - low;
        if width <= 0.0 {
            return Ok(None);
        }
        let sigma = width / std::f64::consts::TAU;
        let unknowns = unknown.clone().prior(Nuisance::Lighting, sigma)?;
        let bound = self.scene.bound(&unknowns, state)?;
        Ok(bound.each.iter().find(|one| one.parameter == Parameter::Temperature).and_then(finite))
    }

    fn imager(&self, readings: &[Reading], state: &State) -> Result<ImagerErrors> {
        let kelvin: Vec<f64> = (readings.iter())
            .filter_map(|reading| if let Reading::Kelvin(t) = reading { Some(*t) } else { None })
            .collect();
        let errors = match kelvin.len() {
            0 | 1 => None,
            _ => Some(Errors::of(&kelvin, state.temperature_k, self.criteria.level)?),
        };
        Ok(ImagerErrors { errors, without_reading: readings.len() - kelvin.len() })
    }
}

fn finite(bound: &Precision) -> Option<f64> {
    (bound.sight == Sight::Seen && bound.sigma.is_finite() && bound.sigma > 0.0).then_some(bound.sigma)
}

/// What the numbers do not say by themselves.
fn warnings(rows: &[ThermometryRow]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let readers =
        || rows.iter().flat_map(|row| std::iter::once(&row.lighting_known).chain(&row.lighting_unknown));
    let held = readers().filter(|reader| !reader.bound_applies);
    let (count, most) = held.fold((0, 0.0_f64), |(n, most), reader| (n + 1, most.max(reader.at_edge)));
    if count > 0 {
        warnings.push(Warning::RangeHoldsTheEstimates { at_edge: most, held: HELD });
    }
    let fits: usize = readers().map(|reader| reader.unconverged).sum();
    if fits > 0 {
        warnings.push(Warning::UnconvergedFits { fits });
    }
    let sums: usize = rows.iter().map(|row| row.fixed.without_reading + row.manual.without_reading).sum();
    if sums > 0 {
        warnings.push(Warning::NoReading { sums });
    }
    if readers().any(|reader| reader.sight != Sight::Seen) {
        warnings.push(Warning::TemperatureNotSeen);
    }
    warnings
}

#[cfg(test)]
mod tests;
