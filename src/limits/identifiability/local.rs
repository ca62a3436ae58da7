//! The paper's semantic distance: what one photon tells of the material, at the target's own state.
//!
//! d₀ = ½‖P⊥ s_g‖ per √photon, s_g the score of the mixing fraction g and P⊥ the projector that removes the
//! span of the nuisance scores; d₀ = 1/(2σ₀) with σ₀² = [1/J⁰]_gg. It is the tangent of the two surfaces at
//! the target: for finite separations it can err either way, see [`super::nearest`].
//!
//! Doubles do most of it. Where they leave fewer than nine digits, or find a nuisance dependent that need not be, or a
//! radiance underflows, the same is done in 128 or 512 bits (`fisher::careful`), so that the error reported is one of the
//! answer to the numbers given. A residual below 16 ε of the material's own column is nothing: its elements, formed in
//! doubles, would have no digit more.
//!
//! Source: paper S24–S30, Algorithm 2.

mod scaled;

use super::Status;
use crate::aligned::Aligned;
use crate::error::{Error, Result};
use crate::fisher::{CarefulProjector, Counting, Noise, Projection, Projector, Reduced, Unknowns};
use crate::scene::{Asked, Jacobian, Parameter, State, Surroundings};
use crate::spectrum::Bands;

/// Signals of which the sum is outside this range are whitened and scaled before they are squared.
pub(super) const SAFE_RANGE: std::ops::Range<f64> = 1e-100..1e100;

/// Local distance of a pair of materials.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalDistance {
    /// d₀ per √photon, or the statistical distance d, whichever was asked for.
    pub distance: f64,
    /// The same with no nuisance at all.
    pub distance_no_nuisance: f64,
    /// Estimated bound on the relative rounding error of `distance`.
    pub relative_error: f64,
    /// Of `distance_no_nuisance`.
    pub relative_error_no_nuisance: f64,
    /// What kind of answer it is.
    pub status: Status,
    /// Change of each nuisance (per unit of g) that imitates the alternative best.
    pub imitation: Vec<(Parameter, f64)>,
    /// Nuisances that change nothing, or nothing that the others do not: the distance is the same without them.
    pub dropped: Vec<Parameter>,
    /// ΣS of the target, photons s⁻¹ m⁻² sr⁻¹.
    pub photon_radiance: f64,
    projection: Projection,
}

impl LocalDistance {
    /// Condition number of the scaled scores (see [`Projection::condition_number`]).
    #[must_use]
    pub fn condition_number(&self) -> f64 {
        self.projection.condition_number()
    }
}

/// Computes local distances in fixed bands and surroundings, again and again without allocating much.
///
/// ```
/// use hadar::fisher::{Nuisance, Unknowns};
/// use hadar::identifiability::local::LocalSolver;
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar::spectrum::Bands;
///
/// let bands = Bands::uniform(715.0, 1250.0, 1.0)?;
/// let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object])?;
/// let skin = vec![0.95; bands.len()];
/// let fabric = vec![0.88; bands.len()];
/// let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
/// let state = surroundings.state(310.15, &[0.5])?;
/// let local = LocalSolver::new(&bands, &surroundings, unknowns).per_photon(&skin, &fabric, &state, f64::INFINITY)?;
/// assert!(local.distance < 0.1 * local.distance_no_nuisance);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LocalSolver<'a> {
    unknowns: Unknowns,
    parameters: Vec<Parameter>,
    jacobian: Jacobian<'a>,
    projector: Projector,
    careful: CarefulProjector<'a>,
    columns: Vec<f64>,
    weights: Aligned,
    /// Weights of whitened columns.
    ones: Vec<f64>,
}

impl<'a> LocalSolver<'a> {
    /// A solver for one set of bands, surroundings and unknowns.
    #[must_use]
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: Unknowns) -> Self {
        let mut parameters = unknowns.parameters(surroundings.objects().len());
        parameters.push(Parameter::Material);
        Self {
            unknowns,
            parameters,
            jacobian: Jacobian::new(bands, surroundings),
            projector: Projector::default(),
            careful: CarefulProjector::new(bands, surroundings),
            columns: Vec::new(),
            weights: Aligned::zeros(bands.len()),
            ones: Vec::new(),
        }
    }

    /// d₀ per √photon, in the limit of shot noise. Priors count as they do among `photons` photons;
    /// with infinitely many they count for nothing.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn per_photon(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        photons: f64,
    ) -> Result<LocalDistance> {
        let (total, found) = self.reduce_per_photon(emissivity, alternative, state, photons)?;
        Ok(self.judge(found, emissivity, alternative, state, total))
    }

    /// The distance of [`LocalSolver::per_photon`] with infinitely many photons, and its relative error.
    pub(super) fn distance(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
    ) -> Result<(f64, f64)> {
        let (_, found) = self.reduce_per_photon(emissivity, alternative, state, f64::INFINITY)?;
        let status = self.status(&found, emissivity, alternative, state);
        Ok(if status == Status::Ok { (0.5 * found.residual, found.relative_error) } else { (0.0, 0.0) })
    }

    /// Statistical distance d with the camera's own noise (S27 at N photons).
    ///
    /// # Errors
    /// As [`LocalSolver::per_photon`].
    pub fn with_counting(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: &Counting,
    ) -> Result<LocalDistance> {
        self.evaluate(emissivity, alternative, state);
        let total = positive(crate::sum::sum(self.jacobian.signal()))?;
        let counts = counting.counts_per_radiance;
        for (w, (weight, signal)) in self.weights.iter_mut().zip(self.jacobian.signal()).enumerate() {
            // κ²/(κS + σ²) with one κ taken out, so that nothing overflows before it must.
            let variance = signal + counting.var_added(w) / counts;
            *weight = if variance > 0.0 { counts / variance } else { 0.0 };
        }
        let mut in_doubles = None;
        if !self.unknowns.has_priors() {
            let root = |w: usize| self.weights[w].sqrt();
            let [cancellation, nuisances] = self.cancellations(emissivity, alternative, state, root);
            let found = self.projector.reduce(self.jacobian.columns_mut(), &self.weights, cancellation);
            in_doubles = Some(found.blurred(nuisances)).filter(|found| self.projector.in_range(*found));
        }
        let found = in_doubles.unwrap_or_else(|| {
            self.evaluate(emissivity, alternative, state);
            let root =
                |w: usize, signal: f64| counts.sqrt() / (signal + counting.var_added(w) / counts).sqrt();
            self.reduce_scaled(emissivity, alternative, state, root, 1.0)
        });
        let found = self.settled(found, emissivity, alternative, state, Noise::Counting(counting));
        Ok(self.judge(found, emissivity, alternative, state, total))
    }

    /// What was found in doubles, or if that is in doubt what more digits find.
    fn settled(
        &mut self,
        found: Reduced,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        noise: Noise<'_>,
    ) -> Reduced {
        let dependent = |i: usize| self.depends_exactly(i, state);
        let nothing = emissivity == alternative || self.in_equilibrium(state);
        // Of so little, products may have underflowed.
        let faint = self.loses_light(state) || found.norm < SAFE_RANGE.start;
        if nothing || !(faint || self.projector.in_doubt(found, dependent)) {
            return found;
        }
        let lighting_total_known = self.unknowns.known_lighting_total().is_some();
        let parameters = &self.parameters;
        let asked = Asked { emissivity, alternative, state, parameters, lighting_total_known };
        let careful = self.careful.project(asked, noise, &self.unknowns);
        self.projector.adopt(careful)
    }

    /// Whether a radiance of a state is so small that doubles may lose it.
    pub(super) fn loses_light(&self, state: &State) -> bool {
        self.careful.loses_light(state)
    }

    /// Whether nuisance i is the same as one before it: that of an object of the same temperature and emissivity.
    pub(super) fn depends_exactly(&self, i: usize, state: &State) -> bool {
        let objects = self.jacobian.surroundings().objects();
        let alike = |a: usize, b: usize| {
            state.environment_k[a] == state.environment_k[b] && objects[a].emissivity == objects[b].emissivity
        };
        let earlier = |same: fn(Parameter) -> Option<usize>| {
            let own = same(self.parameters[i]);
            own.is_some_and(|k| self.parameters[..i].iter().filter_map(|p| same(*p)).any(|j| alike(j, k)))
        };
        let last = objects.len().saturating_sub(1);
        match self.parameters[i] {
            Parameter::Lighting(k) if self.unknowns.known_lighting_total().is_some() && alike(k, last) => {
                true
            }
            _ if self.unknowns.has_priors() => false,
            Parameter::Lighting(_) => earlier(|p| match p {
                Parameter::Lighting(k) => Some(k),
                _ => None,
            }),
            // One without light changes nothing, and one of another share of the light the same but for a factor.
            Parameter::EnvironmentTemperature(k) => {
                let lit = |p: &Parameter| match *p {
                    Parameter::EnvironmentTemperature(j) => state.lighting[j] > 0.0 && alike(j, k),
                    _ => false,
                };
                state.lighting[k] == 0.0 || self.parameters[..i].iter().any(lit)
            }
            Parameter::Temperature | Parameter::Gain | Parameter::Material => false,
        }
    }

    fn evaluate(&mut self, emissivity: &[f64], alternative: &[f64], state: &State) {
        let total_known = self.unknowns.known_lighting_total().is_some();
        self.jacobian.evaluate(emissivity, alternative, state, &self.parameters, total_known);
    }

    /// How far the terms of the material's column cancel, and those of a nuisance at most.
    fn cancellations(
        &self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        root: impl Fn(usize) -> f64 + Copy,
    ) -> [f64; 2] {
        let material = self.jacobian.material_cancellation(emissivity, alternative, state, root);
        let nuisances = match self.unknowns.known_lighting_total() {
            Some(_) => self.jacobian.lighting_cancellation(emissivity, state, root),
            None => 1.0,
        };
        [material, nuisances]
    }

    /// ΣS, and the projection with the weights u = 1/(S ΣS).
    fn reduce_per_photon(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        photons: f64,
    ) -> Result<(f64, Reduced)> {
        self.evaluate(emissivity, alternative, state);
        let total = positive(crate::sum::sum(self.jacobian.signal()))?;
        let priors = self.unknowns.has_priors() && photons.is_finite();
        let mut in_doubles = None;
        if SAFE_RANGE.contains(&total) && !priors {
            let signal = self.jacobian.signal();
            let root = |w: usize| if signal[w] > 0.0 { 1.0 / signal[w].sqrt() } else { 0.0 };
            let [cancellation, nuisances] = self.cancellations(emissivity, alternative, state, root);
            let (columns, inverse) = self.jacobian.columns_and_inverse();
            let found = self.projector.reduce(columns, inverse, cancellation).blurred(nuisances);
            // ΣS comes in at the end, since it scales all the same.
            in_doubles = self.projector.in_range(found).then(|| found.times(1.0 / total.sqrt()));
        }
        let found = in_doubles.unwrap_or_else(|| {
            self.evaluate(emissivity, alternative, state);
            let root_total = total.sqrt();
            let root = |_, signal: f64| 1.0 / (signal.sqrt() * root_total);
            self.reduce_scaled(emissivity, alternative, state, root, photons.sqrt())
        });
        Ok((total, self.settled(found, emissivity, alternative, state, Noise::PerPhoton { photons })))
    }

    fn judge(
        &self,
        found: Reduced,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        total: f64,
    ) -> LocalDistance {
        let status = self.status(&found, emissivity, alternative, state);
        let projection = self.projector.projection(found);
        let imitation =
            self.parameters.iter().copied().zip(projection.coefficients.iter().copied()).collect();
        // What was dropped without a second look, as nothing was left of the material anyway, need not be dependent.
        let surely = |i: &&usize| {
            status == Status::Ok || self.projector.is_zero(**i) || self.depends_exactly(**i, state)
        };
        let dropped = projection.dropped.iter().filter(surely).map(|&i| self.parameters[i]).collect();
        LocalDistance {
            distance: if status == Status::Ok { 0.5 * projection.residual } else { 0.0 },
            distance_no_nuisance: 0.5 * projection.norm,
            relative_error: if status == Status::Ok { projection.relative_error } else { 0.0 },
            relative_error_no_nuisance: found.relative_error_norm,
            status,
            imitation,
            dropped,
            photon_radiance: total,
            projection,
        }
    }

    fn status(&self, found: &Reduced, emissivity: &[f64], alternative: &[f64], state: &State) -> Status {
        if emissivity == alternative {
            Status::Identical
        } else if self.in_equilibrium(state) {
            Status::Equilibrium
        } else if found.is_nothing() {
            Status::Blind
        } else {
            Status::Ok
        }
    }

    /// Every object at the target's temperature, black, and together all around, to the last bit of their shares: 0.3 and
    /// 0.7 are not quite 1.
    pub(super) fn in_equilibrium(&self, state: &State) -> bool {
        let rounding = if state.lighting.len() > 1 { 0.5 * f64::EPSILON } else { 0.0 };
        if crate::scene::unlit(&state.lighting).abs() > rounding {
            return false;
        }
        let black =
            self.jacobian.surroundings().objects().iter().zip(&state.lighting).all(|(object, &factor)| {
                factor == 0.0 || object.emissivity.iter().flatten().all(|&e| e == 1.0)
            });
        let warm = state.environment_k.iter().zip(&state.lighting);
        black && warm.fold(true, |so_far, (t, v)| so_far && (*v == 0.0 || *t == state.temperature_k))
    }
}

/// ΣS of a scene with photons.
fn positive(total: f64) -> Result<f64> {
    if total > 0.0 && total.is_finite() {
        return Ok(total);
    }
    Err(Error::out_of_range(
        "photon radiance of the target",
        total,
        "photons s^-1 m^-2 sr^-1",
        "above 0: a warmer scene, or bands at lower wavenumbers",
    ))
}

#[cfg(test)]
mod tests;
