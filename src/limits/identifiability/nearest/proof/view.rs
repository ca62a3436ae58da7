//! A pair in all its bands, or with neighbours counted as one: what a proof knows of it, as far as it was needed.
//!
//! Counting bands together never brings them farther apart, (√Σa − √Σb)² ≤ Σ(√a − √b)² by Cauchy and Schwarz: whatever is beyond
//! reach then is so in all bands. It loses what differs between neighbours alone, of smooth spectra next to nothing.

use super::amplitudes::Amplitudes;
use super::metric::Metric;
use super::priors::Priors;
use super::sources::{Source, Sources, Spectrum};
use super::vectors::{brightest_into, largest_share};
use crate::aligned::Aligned;
use crate::sum::dot;
use std::cell::OnceCell;

/// Rounding of a length, as a share of its terms, besides that of Planck's function.
const ROUNDING: f64 = 1e-15;
/// How many times as warm as its cold end an interval that is not narrow ends.
const WIDE: f64 = 1.2;
/// From how many times the radiance at its hot end on an interval is so wide that shapes are taken in any case, and that all are.
const WIDE_SHAPES: f64 = 2.0;
const ALWAYS: f64 = 1.0;
/// How much more hcν/kT is of what a source sends a twentieth.
const DIM: f64 = 3.0;

/// A spectrum of a source at one end of an interval.
pub(super) struct End {
    pub(super) spectrum: Spectrum,
    /// Its shape, and β.
    pub(super) shape: Option<(Spectrum, f64)>,
    /// The largest amplitude with which no band alone is beyond reach.
    pub(super) most: f64,
}

/// A pair in such bands.
pub(super) struct View<'a> {
    pub(super) sources: Sources<'a>,
    pub(super) allowed: Amplitudes,
    pub(super) priors: Priors,
    /// √(N + v), N and v of every band, in whole chunks, as all spectra here.
    pub(super) root: Aligned,
    pub(super) counts: Aligned,
    pub(super) noise: Aligned,
    /// The distance within which everything is.
    pub(super) reach: f64,
    /// Sources of unknown temperature, and their spectra at the temperatures known, as far as they were needed.
    pub(super) axes: Vec<usize>,
    ends: Vec<Vec<Option<End>>>,
    /// Rounding of the counts that are compared, as a share of them.
    pub(super) rounding: f64,
    /// From how many times the radiance at the hot end on the shape of an axis is taken instead of itself, where its amplitude is free.
    pub(super) shaped: Vec<Option<f64>>,
    /// Temperatures below which the axes send next to nothing.
    dark_k: Vec<f64>,
    /// Spectra of the sources of known temperature, once a box was looked at: where few bands suffice, all of them are never looked at.
    pub(super) fixed: Vec<Option<Spectrum>>,
    brightest: OnceCell<Aligned>,
    in_boxes: OnceCell<InBoxes>,
}

/// What only bounds over all amplitudes need.
pub(super) struct InBoxes {
    pub(super) about_target: Metric,
    /// N/y of every band, 0 where y is.
    pub(super) share: Vec<f64>,
}

impl<'a> View<'a> {
    pub(super) fn new(
        sources: Sources<'a>,
        allowed: Amplitudes,
        priors: Priors,
        [root, counts, noise]: [Aligned; 3],
        reach: f64,
    ) -> Self {
        let sent = crate::sum::sum(&counts);
        // (‖y‖ + d)² − Σv without the difference, of which much noise would leave nothing.
        let total = (sent + reach * (2.0 * dot(&root, &root).sqrt() + reach)) * (1.0 + 1e-12);
        let allowed = Amplitudes { total, ..allowed };
        let axes: Vec<usize> = (0..sources.list.len()).filter(|&s| sources.list[s].free()).collect();
        let ends = axes.iter().map(|_| Vec::new()).collect();
        let mut dark_k = vec![0.0; axes.len()];
        let shaped = axes.iter().zip(&mut dark_k).map(|(&s, dark_k)| {
            let range = s.checked_sub(1).map_or([1.0; 2], |k| allowed.ranges[k]);
            let is_known = !allowed.gain_free && range[0] >= range[1];
            let dark = if is_known { None } else { sources.dark_k(s, sent, range[1].min(allowed.sum)) };
            *dark_k = dark.unwrap_or(0.0);
            // Where the amplitude hangs on another one's, the shape hardly tells of that.
            let own = match s {
                0 => (0..allowed.ranges.len()).all(|k| allowed.tied(k).is_none()),
                _ => range[0] < range[1],
            };
            dark.map(|_| if own { ALWAYS } else { WIDE_SHAPES })
        });
        let shaped = shaped.collect();
        let rounding = ROUNDING + 2.0 * sources.rounding_of_target();
        Self {
            sources,
            allowed,
            priors,
            root,
            counts,
            noise,
            reach,
            axes,
            ends,
            rounding,
            shaped,
            dark_k,
            fixed: Vec::new(),
            brightest: OnceCell::new(),
            in_boxes: OnceCell::new(),
        }
    }

    /// Makes sure of what only a look at these bands needs.
    pub(super) fn look(&mut self) {
        crate::stop::check();
        if !self.fixed.is_empty() {
            return;
        }
        let known = |(s, source): (usize, &Source)| {
            (!source.free()).then(|| self.sources.spectrum(s, source.temperature_k[0]))
        };
        self.fixed = self.sources.list.iter().enumerate().map(known).collect();
    }

    /// The counts that each band can have within reach.
    pub(super) fn brightest(&self) -> &[f64] {
        self.brightest.get_or_init(|| {
            let mut most = Aligned::unset(self.root.len());
            brightest_into(&self.root, &self.noise, self.reach, &mut most);
            most
        })
    }

    /// What bounds over all amplitudes need, made once.
    pub(super) fn in_boxes(&self) -> &InBoxes {
        self.in_boxes.get_or_init(|| {
            let share = self.root.iter().zip(&self.counts);
            let share = share.map(|(y, n)| if *y > 0.0 { n / y } else { 0.0 });
            let about_target = Metric::about_target(&self.root, &self.counts, self.reach);
            InBoxes { about_target, share: share.collect() }
        })
    }

    /// Makes sure of the spectrum at an end of an interval.
    pub(super) fn know(&mut self, axis: usize, place: usize, temperature_k: f64) {
        crate::stop::check();
        self.look();
        if self.ends[axis].len() <= place {
            self.ends[axis].resize_with(place + 1, || None);
        }
        if self.ends[axis][place].is_some() {
            return;
        }
        let spectrum = self.sources.spectrum(self.axes[axis], temperature_k);
        let most = largest_share(self.brightest(), &spectrum.counts, &spectrum.slope, 0.0);
        let shape = if self.shaped[axis].is_some() { self.sources.shape(&spectrum) } else { None };
        self.ends[axis][place] = Some(End { spectrum, shape, most });
    }

    /// The temperature below which a source of free amplitude need not be looked at.
    pub(super) fn coldest_k(&self, axis: usize) -> f64 {
        self.dark_k[axis]
    }

    /// Where an interval of temperatures is best halved. What a wide one misses is near its hot end: a little colder a source sends
    /// a twentieth of that, and the rest down to nothing is as good as one box.
    pub(super) fn middle(&self, axis: usize, [cold_k, hot_k]: [f64; 2]) -> f64 {
        if hot_k <= WIDE * cold_k {
            return 0.5 * (cold_k + hot_k);
        }
        let mean = (cold_k * hot_k).sqrt();
        if self.shaped[axis].is_some() {
            return mean;
        }
        // Far below its peak a source sends next to nothing all along: there is nothing to be cut off.
        let dim = hot_k / (1.0 + DIM / self.sources.middle_x(hot_k));
        if dim * WIDE > hot_k { mean } else { mean.max(dim) }
    }

    /// Whether even `amplitude` of a source is beyond reach in some band at an end.
    pub(super) fn too_bright(
        &mut self,
        axis: usize,
        place: usize,
        temperature_k: f64,
        amplitude: f64,
    ) -> bool {
        self.know(axis, place, temperature_k);
        self.ends[axis][place].as_ref().is_some_and(|end| end.most < amplitude)
    }

    /// What is known of an end of an interval.
    pub(super) fn end(&self, axis: usize, place: usize) -> Option<&End> {
        self.ends[axis].get(place)?.as_ref()
    }

    /// The shapes at both ends of an interval, where it is so wide that these are taken.
    pub(super) fn shapes(&self, axis: usize, ends: [usize; 2]) -> Option<[&(Spectrum, f64); 2]> {
        let [cold, hot] = ends.map(|end| self.end(axis, end)?.shape.as_ref());
        let from = self.shaped[axis]?;
        cold.zip(hot).filter(|(cold, hot)| hot.1 > from * cold.1).map(|(cold, hot)| [cold, hot])
    }

    /// Takes shapes in wide intervals alone: of an amplitude that stands at its limit they know that only roughly.
    pub(super) fn at_limit(&mut self) {
        self.shaped.iter_mut().flatten().for_each(|from| *from = WIDE_SHAPES);
    }

    /// How much of the pieces an amplitude of 1 is, at one end of an interval or the other.
    pub(super) fn unit(&self, axis: usize, ends: [usize; 2], share: f64) -> f64 {
        self.shapes(axis, ends).map_or(1.0, |[cold, hot]| if share > 0.5 { hot.1 } else { cold.1 })
    }

    /// The spectrum of a source at a temperature of the pair's own.
    pub(super) fn spectrum(&self, s: usize, temperature_k: f64) -> Spectrum {
        match self.fixed.get(s) {
            Some(Some(spectrum)) => spectrum.clone(),
            // That of a known temperature is the same for every pair.
            _ if !self.sources.list[s].free() => self.sources.spectrum(s, temperature_k),
            _ => self.sources.own_spectrum(s, temperature_k),
        }
    }

    /// The amplitude of a source, where it is known.
    pub(super) fn held(&self, s: usize) -> Option<f64> {
        if self.allowed.gain_free {
            return None;
        }
        match s.checked_sub(1) {
            None => Some(1.0),
            Some(k) => {
                (self.allowed.ranges[k][0] == self.allowed.ranges[k][1]).then(|| self.allowed.ranges[k][0])
            }
        }
    }

    /// The largest amplitude that a source can have by its range.
    pub(super) fn most(&self, s: usize) -> f64 {
        let gain = if self.allowed.gain_free { self.allowed.gain_cap } else { 1.0 };
        match s.checked_sub(1) {
            None => gain,
            Some(k) => gain * self.allowed.ranges[k][1].min(self.allowed.sum),
        }
    }
}
