//! The conditions of a verdict on a camera in a scene ([`Condition`]), made of the same data as the answer.

use crate::condition::{Condition, RangeDecides, hardest_first};
use crate::proviso::Proviso;
use crate::{Apart, PairResult, Study};
use hadar::demand::Skipping;
use hadar::error::Result;
use hadar::fisher::Nuisance;
use hadar::identifiability::nearest::StateRange;
use hadar::instrument::{Assumed, Camera, Readout};
use hadar::planck;
use hadar::policy::caps::longest_wavelength_m;
use hadar::spectrum::Bands;
use hadar_scenario::{BandSource, DistanceKind, FilterPlace, Filters, PixelsFilled, Setting};
use std::collections::{HashMap, HashSet};

/// Share of draws of the emissivities that settles a question.
const SETTLED: f64 = 0.95;
/// To what an end of a range of temperatures is found beyond which the answer changes, K, and of lighting.
const TEMPERATURE_STEP_K: f64 = 0.25;
const LIGHTING_STEP: f64 = 1e-3;
/// Share of the hemisphere that is rounding.
const UNLIT: f64 = 1e-9;
/// Relative difference between times that is rounding.
const SAME: f64 = 1e-9;

/// What the camera and the scene are asked about.
#[derive(Debug, Clone)]
pub(crate) struct Circumstances {
    /// Speed of the vehicle, m s⁻¹, if one is demanded.
    pub(crate) speed_m_s: Option<f64>,
    /// What nobody stated of where the target is in the picture.
    pub(crate) path: Option<Condition>,
    /// The farthest target, m, where that is known.
    pub(crate) distance_m: Option<f64>,
    /// Whether a rule asks, whose own text then stands above what is set over it.
    pub(crate) of_rule: bool,
    /// Whether the time until all is read is judged.
    pub(crate) is_timed: bool,
    /// Share of the hemisphere above the target that no object fills, at most.
    pub(crate) unlit: f64,
}

/// What of a verdict its conditions depend on.
pub(crate) struct Reached<'a> {
    /// The pair that decides.
    pub(crate) pair: &'a PairResult,
    /// Error of the emissivities, root mean square, and the share of draws with such errors that meet the requirement; where it was asked for.
    pub(crate) errors: Option<[f64; 2]>,
    /// Counts of the fullest reading.
    pub(crate) brightest: f64,
}

impl Study {
    /// What a 'yes' rests on; of a 'no' what was taken on the unfavourable side.
    pub(crate) fn conditions(
        &self,
        camera: &Camera,
        met: bool,
        reached: &Reached<'_>,
    ) -> Result<Vec<Condition>> {
        let mut found = self.unstated(camera, reached.brightest);
        let pair = reached.pair;
        found.extend(
            self.one_numbers(&pair.alternative).map(|emissivities| Condition::Constants { emissivities }),
        );
        let is_object = self.scenario.is_of_object();
        found.extend(self.of_pair(camera, bounds_lower(pair), reached.errors.filter(|_| !is_object)));
        if let (true, Some(other)) = (is_object && met, self.alternative(&pair.alternative)) {
            found.extend(self.usual_errors(other)?);
        }
        if met {
            found.extend(self.ranges_that_decide(true, &|range| self.holds_in(range))?);
        }
        found.retain(|one| one.counts(met));
        hardest_first(&mut found);
        Ok(found)
    }

    /// The same of an answer to many questions: the target against each alternative, and all materials against all.
    pub(crate) fn conditions_of_pairs(
        &self,
        camera: &Camera,
        pairs: &[PairResult],
        apart: &[&Apart],
    ) -> Result<Vec<Condition>> {
        let told = pairs.iter().enumerate().filter(|(_, pair)| pair.told_apart == Some(true));
        let told: Vec<(usize, f64)> =
            told.map(|(index, pair)| (index, bounds_lower(pair).unwrap_or_default())).collect();
        self.conditions_of_told(camera, &told, apart)
    }

    /// The same of the alternatives that are told, by their places, and of what is proved of the distance of each.
    pub(crate) fn conditions_of_told(
        &self,
        camera: &Camera,
        told: &[(usize, f64)],
        apart: &[&Apart],
    ) -> Result<Vec<Condition>> {
        let mut found = self.unstated(camera, self.brightest_member(camera));
        let others = apart.iter().flat_map(|found| &found.told_apart);
        let constants = told
            .iter()
            .find_map(|(index, _)| self.against(*index).target.placeholders(self.alternatives.get(*index)?))
            .or_else(|| self.one_numbers_among(others.clone()));
        found.extend(constants.map(|emissivities| Condition::Constants { emissivities }));
        let hardest = told.iter().copied().min_by(|(_, a), (_, b)| a.total_cmp(b));
        if let Some((index, lower)) = hardest {
            let own = self.against(index);
            let alternative = own.alternatives.get(index);
            let is_object = self.scenario.is_of_object();
            let of_pixel = alternative.filter(|_| !is_object);
            let errors = of_pixel.map(|other| own.emissivity_errors(camera, other, index)).transpose()?;
            let errors = errors.map(|found| [found.error, found.share_met]);
            found.extend(own.of_pair(camera, Some(lower), errors));
            for other in alternative.into_iter().filter(|_| is_object) {
                found.extend(own.usual_errors(other)?);
            }
        }
        if self.scenario.is_of_object() && others.clone().next().is_some() {
            found.push(Condition::EmissivityKnown);
        }
        // Distances alone are compared here.
        found.extend(self.spoiled_here().into_iter().map(|by| Condition::Spoiled { by }));
        let of_told = self.only(&told.iter().map(|(index, _)| *index).collect::<Vec<_>>());
        let mut ranges = of_told.ranges_that_decide(true, &|range| of_told.holds_in(range))?;
        if ranges.is_empty() && others.clone().next().is_some() {
            let hold_in = |range: StateRange| {
                let told = Self { range, ..self.clone() }.told_apart(Skipping::On, &|_, _| ())?.told_apart;
                let told: HashSet<&[String; 2]> = told.iter().collect();
                Ok(others.clone().all(|pair| told.contains(pair)))
            };
            ranges = self.ranges_that_decide(false, &hold_in)?;
        }
        found.extend(ranges);
        let met = hardest.is_some() || others.clone().next().is_some();
        found.retain(|one| one.counts(met));
        hardest_first(&mut found);
        Ok(found)
    }

    /// Emissivities of the first pair of materials of which each is entered as one number.
    fn one_numbers_among<'p>(&self, mut pairs: impl Iterator<Item = &'p [String; 2]>) -> Option<[f64; 2]> {
        let mut one_number: HashMap<&str, Option<f64>> = HashMap::new();
        for surface in self.all_members() {
            one_number.entry(&surface.name).or_insert(surface.one_number);
        }
        let of = |name: &String| one_number.get(name.as_str()).copied().flatten();
        pairs.find_map(|[one, other]| Some([of(one)?, of(other)?]))
    }

    /// What the distance of a pair hangs on, of which so much is proved. `errors` as in [`Reached`].
    pub(crate) fn of_pair(
        &self,
        camera: &Camera,
        lower: Option<f64>,
        errors: Option<[f64; 2]>,
    ) -> Vec<Condition> {
        let mut found = Vec::new();
        if let Some([error, share_met]) = errors.filter(|[_, share_met]| *share_met < SETTLED) {
            found.push(Condition::Emissivities { error, share_met });
        }
        if let (false, Some(lower)) = (camera.photon_bunching, lower) {
            // Each mode adds no more than occupancy to the variance of the photons.
            let occupancy = self.occupancy();
            if lower < self.required * (1.0 + occupancy).sqrt() {
                found.push(Condition::Bunching { occupancy });
            }
        }
        found
    }

    /// Photons per mode of the hottest at the longest wavelength.
    pub(crate) fn occupancy(&self) -> f64 {
        let hottest = self.state.environment_k.iter().copied().fold(self.state.temperature_k, f64::max);
        planck::occupancy(self.bands.range_cm1().0, hottest)
    }

    /// What meeting a clause of a rule rests on, `more` of which only the clause knows.
    pub(crate) fn conditions_of_clause(
        &self,
        (camera, brightest): (&Camera, f64),
        asked: Circumstances,
        more: Vec<Condition>,
        met: bool,
    ) -> Vec<Condition> {
        let mut found = more;
        found.extend(self.of_camera(camera, brightest));
        found.extend(self.of_scene(camera, asked));
        let is_of_errors =
            |one: &Condition| matches!(one, Condition::SharedErrors { .. } | Condition::EmissivityKnown);
        if self.scenario.is_of_object() && !found.iter().any(is_of_errors) {
            found.push(Condition::EmissivityKnown);
        }
        found.retain(|one| one.counts(met));
        hardest_first(&mut found);
        found
    }

    /// What nobody stated of camera and scene.
    pub(crate) fn unstated(&self, camera: &Camera, brightest: f64) -> Vec<Condition> {
        let mut found = self.of_camera(camera, brightest);
        let speed_m_s = self.scenario.requirement.speed_m_s;
        let (distance_m, is_timed) =
            (self.scenario.target.distance_m, self.scenario.requirement.time_s.is_some());
        let unlit = 1.0 - self.state.lighting.iter().sum::<f64>();
        let path = speed_m_s.map(|_| Condition::NobodyCrosses);
        let asked = Circumstances { speed_m_s, path, distance_m, of_rule: false, is_timed, unlit };
        found.extend(self.of_scene(camera, asked));
        found
    }

    /// Figures of the camera that nobody stated and that count here.
    pub(crate) fn of_camera(&self, camera: &Camera, brightest: f64) -> Vec<Condition> {
        let mut found = of_figures(camera, self.bands.len(), Some(brightest));
        let filters = self.open_bands.bands().iter().any(|band| band.name.is_some());
        if filters && camera.sensor_temperature_k.is_none() {
            found.push(Condition::NoFilterLight);
        }
        let cut = self.open_bands.cut_filters(camera.spectral_range_cm1);
        found.extend(cut.map(|share| Condition::FilterCut { share }));
        if let BandSource::Filters(Filters { place, .. }) = &self.scenario.bands.source
            && !matches!(place, Some(FilterPlace::Sensor { .. }))
        {
            let before_lens = place.is_some();
            found.push(Condition::FilterAngle { before_lens, sine: camera.rim_sine() });
        }
        found
    }

    /// What nobody stated of the scene, and what must hold in it meanwhile.
    pub(crate) fn of_scene(&self, camera: &Camera, asked: Circumstances) -> Vec<Condition> {
        let scenario = &self.scenario;
        let mut found = meanwhile(camera, self.bands.len(), asked.speed_m_s, asked.is_timed);
        found.extend(asked.path);
        if scenario.requirement.by != DistanceKind::Nearest {
            found.push(Condition::NoLimit);
        }
        // The farther, the fewer.
        let pixels = self.extent(camera, asked.distance_m).pixels();
        if scenario.is_of_object() {
            let square = matches!(scenario.target.pixels, Some(PixelsFilled::All(2..)));
            found.push(Condition::AlikePixels { pixels, square });
            if camera.pixels.is_none() && pixels > 1.0 {
                let figure = Assumed::favourable("pixels", "enough");
                found.push(Condition::Assumed { figure, counts: None });
            }
        }
        let figures = camera.pattern.unstated(false);
        let is_object = scenario.is_of_object();
        if is_object && scenario.target.size_m.is_some() && camera.contradicts_its_view() {
            found.push(Condition::PixelsByLens);
        }
        if !camera.pattern.is_none() && self.bands.len() > 1 {
            found.push(Condition::PatternOfEachBand);
        }
        let length = self.errors_shared().map(|spec| spec.correlation_cm1);
        if let (Some(length_cm1), false) = (length, scenario.source.states("sensitivity.correlation")) {
            found.push(Condition::ErrorsCorrelated { length_cm1 });
        }
        if is_object && !figures.is_empty() && !camera.is_ideal() {
            found.push(Condition::FrameNoise { figures });
        }
        if scenario.target.size_m.is_none() && !scenario.is_of_object() {
            let footprint_m = asked.distance_m.map(|z| camera.footprint_m(z));
            found.push(Condition::FillsPixel { footprint_m });
        }
        // The farther, the less of its pixel the target fills.
        let fill = self.fill(camera, asked.distance_m);
        if fill < 1.0 {
            found.push(Condition::InOnePixel { fill });
        }
        let outside = self.bands_beyond(camera);
        if outside > 0 {
            found.push(Condition::BeyondRange { outside, bands: self.bands.len() });
        }
        found.extend(self.sampled_cm1().map(|width_cm1| Condition::Sampled { width_cm1 }));
        found.extend(diffraction(camera, &self.bands));
        if camera.spectral_bands == Some(1) && self.bands.len() > 1 && camera.readout != Readout::Sequential {
            found.push(Condition::Modelled { bands: self.bands.len() });
        }
        if scenario.atmosphere.is_none() {
            found.push(Condition::NoAir);
        }
        if self.surroundings.objects().is_empty() {
            found.push(Condition::NoSurroundings);
        }
        if asked.unlit > UNLIT && !self.surroundings.objects().is_empty() {
            found.push(Condition::DarkRest { share: asked.unlit });
        }
        let objects = self.surroundings.objects();
        if !self.is_unknown(Nuisance::EnvironmentTemperature) && !objects.is_empty() {
            let black = objects.iter().filter(|object| object.emissivity.is_none()).count();
            found.push(Condition::SurroundingsKnown { black });
        }
        if !self.is_unknown(Nuisance::Temperature) {
            found.push(Condition::TemperatureKnown);
        }
        if !self.is_unknown(Nuisance::Lighting) && !objects.is_empty() {
            found.push(Condition::LightingKnown);
        }
        if !self.is_unknown(Nuisance::Gain) {
            found.push(Condition::Calibrated);
        }
        if !self.extrapolated.is_empty() {
            found.push(Condition::Extrapolated { materials: self.extrapolated.clone() });
        }
        if !self.left_out.is_empty() {
            found.push(Condition::LeftOut { materials: self.left_out.clone() });
        }
        found.extend(settings(&scenario.source.settings, asked.of_rule));
        found
    }

    /// Ranges of the alternatives' states that the scenario sets and without which the answer would be another; `farther`, with how far each
    /// may go.
    pub(crate) fn ranges_that_decide(
        &self,
        farther: bool,
        holds_in: &dyn Fn(StateRange) -> Result<bool>,
    ) -> Result<Vec<Condition>> {
        let (own, physical) = (self.range, StateRange::default());
        let (mut found, mut narrowed) = (Vec::new(), Vec::new());
        if self.scenario.requirement.by != DistanceKind::Nearest {
            return Ok(found);
        }
        for (figure, step) in
            [("alternatives.temperature", TEMPERATURE_STEP_K), ("alternatives.lighting", LIGHTING_STEP)]
        {
            let is_temperature = figure == "alternatives.temperature";
            let of = |range: &StateRange| if is_temperature { range.temperature_k } else { range.lighting };
            let with = |range: [f64; 2]| match is_temperature {
                true => StateRange { temperature_k: range, ..own },
                false => StateRange { lighting: range, ..own },
            };
            let (stated, widest) = (of(&own), of(&physical));
            if stated == widest {
                continue;
            }
            narrowed.push(RangeDecides { figure, stated, holds: None });
            if holds_in(with(widest))? {
                continue;
            }
            let mut holds = stated;
            for end in if farther { 0..2 } else { 0..0 } {
                let holds_to = |value: f64| {
                    let mut range = stated;
                    range[end] = value;
                    holds_in(with(range))
                };
                holds[end] = farthest(stated[end], widest[end], step, holds_to)?;
            }
            let holds = farther.then_some(holds);
            found.push(Condition::Range(RangeDecides { figure, stated, holds }));
        }
        // Each may do by itself and both together not.
        if found.is_empty() && narrowed.len() > 1 && !holds_in(physical)? {
            found.extend(narrowed.into_iter().map(Condition::Range));
        }
        Ok(found)
    }

    /// Whether every alternative is told apart where its states are of such a range.
    fn holds_in(&self, range: StateRange) -> Result<bool> {
        let wider = Self { range, remembered: None, ..self.clone() };
        Ok(wider.of_worst_members(Skipping::On)?.check(Skipping::On)?.identifiable)
    }

    /// The same of these alternatives alone.
    fn only(&self, kept: &[usize]) -> Self {
        fn of<T: Clone>(all: &[T], kept: &[usize]) -> Vec<T> {
            kept.iter().filter_map(|index| all.get(*index).cloned()).collect()
        }
        let [targets, others] = &self.members;
        Self {
            alternatives: of(&self.alternatives, kept),
            paired: of(&self.paired, kept),
            classes: of(&self.classes, kept),
            members: [targets.clone(), of(others, kept)],
            remembered: None,
            ..self.clone()
        }
    }
}

/// What is proved of the statistical distance of a pair.
fn bounds_lower(pair: &PairResult) -> Option<f64> {
    pair.statistical_distance_bounds.map(|[lower, _]| lower)
}

/// That the lens blurs a point over more than a pixel.
pub(crate) fn diffraction(camera: &Camera, bands: &Bands) -> Option<Condition> {
    let blur_m = longest_wavelength_m(bands) * camera.f_number;
    (camera.pixel_m < blur_m).then_some(Condition::Diffraction { blur_m })
}

/// Figures of a camera of so many bands that nobody stated and that count.
pub(crate) fn of_figures(camera: &Camera, bands: usize, brightest: Option<f64>) -> Vec<Condition> {
    let exposures = camera.readout.exposures(bands) as f64 * f64::from(camera.frames);
    // Flicker grows faster with the time than all other noise.
    let longer = camera.integration_s() > camera.noise_exposure_s * (1.0 + SAME);
    let counts = |figure: &&Assumed| match figure.figure {
        "flicker_fraction" => longer,
        "readout" => bands > 1,
        "frame_rate" => exposures > 1.0,
        _ => true,
    };
    let assumed = camera.assumed.iter().filter(counts).map(|figure| {
        let counts = brightest.filter(|_| figure.figure == "full_well");
        Condition::Assumed { figure: figure.clone(), counts }
    });
    assumed.collect()
}

/// What must hold while all bands of all frames are read.
fn meanwhile(camera: &Camera, bands: usize, speed_m_s: Option<f64>, is_timed: bool) -> Vec<Condition> {
    let time_s = camera.acquisition_s(bands);
    let Some(speed_m_s) = speed_m_s else { return vec![Condition::StillScene { time_s }] };
    let frames = Proviso::of(camera, bands, speed_m_s).map(Condition::RegisteredFrames);
    let waits = (!is_timed).then_some(Condition::Waits { time_s });
    frames.into_iter().chain(waits).collect()
}

/// What is set in the place of a file's values.
fn settings(set: &[Setting], of_rule: bool) -> impl Iterator<Item = Condition> {
    set.iter().map(move |one| {
        let (key, value) = (one.key.clone(), one.value.clone());
        Condition::Setting { key, value, of_rule }
    })
}

/// What meeting a clause of a rule rests on that demands a number: `figures` where counts decide it, and the rest.
pub(crate) fn of_measured(
    figures: Vec<Condition>,
    (camera, bands): (&Camera, usize),
    (speed_m_s, path, is_timed): (Option<f64>, Option<Condition>, bool),
    set: &[Setting],
    met: bool,
) -> Vec<Condition> {
    let mut found = figures;
    found.extend(meanwhile(camera, bands, speed_m_s, is_timed));
    found.extend(path);
    found.extend(settings(set, true));
    that_count(found, met)
}

/// What ranging by stereo rests on: a camera, if there is one, that reads so many bands, and `more` that is known of the views.
pub(crate) fn of_stereo(
    camera: Option<(&Camera, usize, Option<f64>)>,
    more: Vec<Condition>,
    set: &[Setting],
    met: bool,
) -> Vec<Condition> {
    let mut found = more;
    if let Some((camera, bands, brightest)) = camera {
        found.extend(of_figures(camera, bands, brightest));
        found.extend(meanwhile(camera, bands, None, false));
        found.extend(camera.pattern.is_shared().then_some(Condition::PatternOfEachPixel));
    }
    found.extend(settings(set, false));
    that_count(found, met)
}

/// Those on which such a verdict rests, hardest first.
pub(crate) fn that_count(mut found: Vec<Condition>, met: bool) -> Vec<Condition> {
    found.retain(|one| one.counts(met));
    hardest_first(&mut found);
    found
}

/// How far from `near` towards `far` it holds, to within a step; it holds at `near`.
fn farthest(near: f64, far: f64, step: f64, holds: impl Fn(f64) -> Result<bool>) -> Result<f64> {
    if near == far || holds(far)? {
        return Ok(far);
    }
    let direction = (far - near).signum();
    let (mut good, mut width) = (0.0, step);
    let reach = (far - near).abs();
    // Steps that double until it holds no more, then the one in between is halved.
    let mut bad = loop {
        let next = (good + width).min(reach);
        if next >= reach || !holds(near + direction * next)? {
            break next;
        }
        (good, width) = (next, 2.0 * width);
    };
    while bad - good > step {
        let middle = 0.5 * (good + bad);
        if holds(near + direction * middle)? { good = middle } else { bad = middle }
    }
    Ok(near + direction * good)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_farthest_end_is_found_on_either_side() {
        let below = |limit: f64| move |value: f64| Ok(value <= limit);
        let found = farthest(300.0, 1e6, 0.25, below(333.3)).unwrap();
        assert!(found <= 333.3 && found > 333.3 - 0.25, "{found}");
        assert_eq!(farthest(300.0, 1e6, 0.25, below(2e6)).unwrap(), 1e6);
        assert_eq!(farthest(300.0, 1e6, 0.25, below(300.1)).unwrap(), 300.0);
        let found = farthest(300.0, 0.1, 0.25, |value| Ok(value >= 250.0)).unwrap();
        assert!((250.0..250.25).contains(&found), "{found}");
    }
}
