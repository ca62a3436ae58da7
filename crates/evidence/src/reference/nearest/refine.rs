//! Newton's method downhill to the least separation, within the range of the state.
//!
//! Second derivatives are differences of the gradient over a step of 2⁻¹⁷⁰, which leaves them half of the 512 bits.
//! Parameters at an end of their range that the gradient presses against are held, and where ΣV has reached its limit
//! the step keeps it. A step that does not lead downhill is damped, one that leads too far is halved.

use super::{NearestReference, Target, coordinate};
use crate::reference::Extended;
use crate::reference::local::ExtendedState;
use hadar::scene::{Parameter, State};

/// Steps of a refinement.
const STEPS: usize = 60;
/// Step of a difference, as a power of two of the coordinate's size.
const DIFFERENCE: i32 = -170;
/// Relative change of d² below which its least value is known.
const SETTLED: f64 = 1e-60;
/// Largest |ln G′|: as wide as the fast path searches.
const LOG_GAIN: f64 = 14.0;
/// Lowest and highest temperature of an environment object, K: as wide as the fast path searches.
const ENVIRONMENT_K: [f64; 2] = [0.1, 1e6];

/// Where a step leads, and how far it may go.
struct Downhill {
    step: Vec<Extended>,
    /// Half of the change of d² to first order, below 0.
    slope: Extended,
}

impl NearestReference<'_> {
    /// The least separation that is reached downhill from a start, and the state, rounded.
    pub(super) fn refine(&mut self, target: &Target<'_>, start: &State) -> (Extended, State) {
        let mut state = ExtendedState::from(start);
        let limit = self.sum_limit(&state);
        let mut cost = self.cost(target, &state);
        for _ in 0..STEPS {
            if self.parameters.is_empty() || cost.is_zero() {
                break;
            }
            self.spectra.forget();
            let Some(downhill) = self.downhill(target, &state, &limit) else { break };
            let mut share = self.longest(&state, &downhill.step, &limit);
            let mut moved = None;
            for _ in 0..40 {
                let candidate = self.moved(&state, &downhill.step, &share);
                let next = self.cost(target, &candidate);
                if next < cost {
                    moved = Some((candidate, next));
                    break;
                }
                share = share.times_power_of_two(-1);
            }
            let Some((candidate, next)) = moved else { break };
            (state, cost) = (candidate, next);
            if downhill.slope.abs() <= Extended::from(SETTLED) * &cost {
                break;
            }
        }
        (cost.sqrt(), rounded(&state))
    }

    /// Where the sum of the free lighting factors ends.
    fn sum_limit(&self, state: &ExtendedState) -> Extended {
        let limit = self.unknowns.known_lighting_total().unwrap_or(self.range.lighting_sum);
        Extended::from(limit).max(self.lit(state))
    }

    fn lit(&self, state: &ExtendedState) -> Extended {
        let lit = |parameter: &&Parameter| matches!(parameter, Parameter::Lighting(_));
        self.parameters.iter().filter(lit).map(|&parameter| coordinate(state, parameter)).sum()
    }

    fn bounds(&self, parameter: Parameter, now: &Extended) -> [Extended; 2] {
        let [low, high] = match parameter {
            Parameter::Temperature => self.range.temperature_k,
            Parameter::Lighting(_) => self.range.lighting,
            Parameter::Gain => [-LOG_GAIN, LOG_GAIN],
            Parameter::EnvironmentTemperature(_) => ENVIRONMENT_K,
            Parameter::Material => [0.0, 0.0],
        }
        .map(Extended::from);
        // A start may stand outside by a rounding.
        let low = if now < &low { now.clone() } else { low };
        [low, high.max(now.clone())]
    }

    fn second_derivatives(
        &mut self,
        target: &Target<'_>,
        state: &ExtendedState,
        gradient: &[Extended],
    ) -> Vec<Vec<Extended>> {
        let parameters = self.parameters.clone();
        let along = |(i, &parameter): (usize, &Parameter)| {
            let size = match parameter {
                Parameter::Lighting(_) | Parameter::Gain => Extended::one(),
                other => coordinate(state, other),
            };
            let change = size.times_power_of_two(DIFFERENCE);
            let mut step = vec![Extended::zero(); parameters.len()];
            step[i] = change.clone();
            let beyond = self.moved_freely(state, &step, &Extended::one());
            let there = self.gradient(target, &beyond);
            there.iter().zip(gradient).map(|(there, here)| (there - here) / &change).collect()
        };
        parameters.iter().enumerate().map(along).collect()
    }

    /// Newton's step on the parameters that are not held; nothing at a minimum.
    fn downhill(&mut self, target: &Target<'_>, state: &ExtendedState, limit: &Extended) -> Option<Downhill> {
        let gradient = self.gradient(target, state);
        let second = self.second_derivatives(target, state, &gradient);
        let free: Vec<usize> = (0..gradient.len())
            .filter(|&i| {
                let now = coordinate(state, self.parameters[i]);
                let [low, high] = self.bounds(self.parameters[i], &now);
                let held = (now <= low && gradient[i].is_positive())
                    || (now >= high && (-&gradient[i]).is_positive());
                !held && !second[i][i].is_zero()
            })
            .collect();
        let lighting: Vec<usize> = (0..free.len())
            .filter(|&row| matches!(self.parameters[free[row]], Parameter::Lighting(_)))
            .collect();
        let full = !lighting.is_empty() && self.lit(state) >= *limit;
        let mut damping = Extended::zero();
        for _ in 0..40 {
            for keep_sum in [false, true] {
                if keep_sum && !full {
                    continue;
                }
                let summed: &[usize] = if keep_sum { &lighting } else { &[] };
                let Some(part) = solve(&second, &gradient, &free, summed, &damping) else { continue };
                let raised: Extended = lighting.iter().map(|&row| part[row].clone()).sum();
                if full && !keep_sum && raised.is_positive() {
                    continue;
                }
                let mut step = vec![Extended::zero(); gradient.len()];
                for (&i, part) in free.iter().zip(part) {
                    step[i] = part;
                }
                let slope: Extended = step.iter().zip(&gradient).map(|(step, g)| step * g).sum();
                if (-&slope).is_positive() {
                    return Some(Downhill { step, slope });
                }
            }
            damping = damping.max(Extended::from(1e-9)) * Extended::from(10.0);
        }
        None
    }

    /// The largest share of a step, up to all of it, that stays within the range.
    fn longest(&self, state: &ExtendedState, step: &[Extended], limit: &Extended) -> Extended {
        let mut share = Extended::one();
        let mut shorten = |room: Extended, change: &Extended| {
            if change.is_positive() && room < change * &share {
                share = room / change;
            }
        };
        let mut raised = Extended::zero();
        for (&parameter, change) in self.parameters.iter().zip(step) {
            let now = coordinate(state, parameter);
            let [low, high] = self.bounds(parameter, &now);
            shorten(high - &now, change);
            shorten(now - low, &-change);
            if matches!(parameter, Parameter::Lighting(_)) {
                raised = raised + change;
            }
        }
        // Rounding of a step that keeps the sum does not count.
        if raised > Extended::from(1e-120) {
            shorten(limit - self.lit(state), &raised);
        }
        share
    }

    fn moved(&self, state: &ExtendedState, step: &[Extended], share: &Extended) -> ExtendedState {
        let mut moved = self.moved_freely(state, step, share);
        for (i, &parameter) in self.parameters.iter().enumerate() {
            // A share that was cut at an end of a range leads there up to rounding.
            let now = coordinate(state, parameter);
            let [low, high] = self.bounds(parameter, &now);
            let there = coordinate(&moved, parameter);
            let near = |end: &Extended| (&there - end).abs() <= Extended::from(1e-120);
            if parameter != Parameter::Gain && !step[i].is_zero() {
                if near(&low) {
                    set(&mut moved, parameter, low);
                } else if near(&high) {
                    set(&mut moved, parameter, high);
                }
            }
        }
        self.close_total(&mut moved);
        moved
    }

    fn moved_freely(&self, state: &ExtendedState, step: &[Extended], share: &Extended) -> ExtendedState {
        let mut moved = state.clone();
        for (&parameter, change) in self.parameters.iter().zip(step) {
            let change = change * share;
            if parameter == Parameter::Gain {
                moved.gain = &state.gain * change.exp();
            } else {
                set(&mut moved, parameter, coordinate(state, parameter) + change);
            }
        }
        self.close_total(&mut moved);
        moved
    }

    /// With a known total the last factor is what the others leave of it.
    fn close_total(&self, state: &mut ExtendedState) {
        let (Some(total), true) =
            (self.unknowns.known_lighting_total(), self.unknowns.contains(hadar::fisher::Nuisance::Lighting))
        else {
            return;
        };
        if let [others @ .., last] = state.lighting.as_mut_slice() {
            *last = Extended::from(total) - others.iter().cloned().sum::<Extended>();
        }
    }
}

fn set(state: &mut ExtendedState, parameter: Parameter, to: Extended) {
    match parameter {
        Parameter::Temperature => state.temperature = to,
        Parameter::Lighting(k) => state.lighting[k] = to,
        Parameter::EnvironmentTemperature(k) => state.environment[k] = to,
        Parameter::Gain => state.gain = to.exp(),
        Parameter::Material => {}
    }
}

fn rounded(state: &ExtendedState) -> State {
    let all = |values: &[Extended]| values.iter().map(Extended::to_f64).collect();
    State {
        temperature_k: state.temperature.to_f64(),
        lighting: all(&state.lighting),
        gain: state.gain.to_f64(),
        environment_k: all(&state.environment),
    }
}

/// Solves H p = −g on the free parameters, H's diagonal raised by `damping` of itself; with `summed` rows the sum of
/// their steps is 0 (one more unknown, its multiplier). Gauss with row pivots; nothing if H is singular.
fn solve(
    second: &[Vec<Extended>],
    gradient: &[Extended],
    free: &[usize],
    summed: &[usize],
    damping: &Extended,
) -> Option<Vec<Extended>> {
    let bordered = free.len() + usize::from(!summed.is_empty());
    let mut rows = vec![vec![Extended::zero(); bordered + 1]; bordered];
    // Unit diagonal, so that parameters of any unit are alike.
    let scale: Vec<Extended> = free.iter().map(|&i| second[i][i].abs().sqrt()).collect();
    for (row, &i) in free.iter().enumerate() {
        for (column, &j) in free.iter().enumerate() {
            rows[row][column] = &second[i][j] / (&scale[row] * &scale[column]);
        }
        rows[row][row] = &rows[row][row] + damping;
        rows[row][bordered] = -(&gradient[i] / &scale[row]);
    }
    for &row in summed {
        rows[row][free.len()] = Extended::one() / &scale[row];
        rows[free.len()][row] = Extended::one() / &scale[row];
    }
    for pivot in 0..bordered {
        let largest = (pivot..bordered).max_by(|&a, &b| {
            rows[a][pivot].abs().partial_cmp(&rows[b][pivot].abs()).unwrap_or(std::cmp::Ordering::Equal)
        })?;
        rows.swap(pivot, largest);
        let head = rows[pivot].clone();
        if head[pivot].is_zero() {
            return None;
        }
        for row in rows.iter_mut().skip(pivot + 1) {
            let share = &row[pivot] / &head[pivot];
            for (value, head) in row.iter_mut().zip(&head).skip(pivot) {
                *value = &*value - &share * head;
            }
        }
    }
    let mut solution = vec![Extended::zero(); bordered];
    for row in (0..bordered).rev() {
        let known: Extended = (row + 1..bordered).map(|j| &rows[row][j] * &solution[j]).sum();
        solution[row] = (&rows[row][bordered] - known) / &rows[row][row];
    }
    let steps = solution.into_iter().zip(scale).map(|(step, scale)| step / scale);
    Some(steps.collect())
}
