//! An axis as the caller states it, and the ruler that maps numbers to places along it.
//!
//! A ruler sends v to the fraction (t(v) − t(lo)) / (t(hi) − t(lo)) of the axis, with t the identity or
//! log₁₀. Numbers beyond 1e300 in size, and positive ones below 1e-300 on a logarithmic axis, cannot be
//! told from overflow and underflow and are treated as missing.

/// How numbers are spread along an axis or a colour bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal differences, equal lengths.
    #[default]
    Linear,
    /// Equal ratios, equal lengths; numbers of zero or below are left out.
    Log,
}

/// A second reading of an axis, drawn above or at the right of the plot, e.g. wavelength above wavenumber.
#[derive(Debug, Clone, PartialEq)]
pub struct Secondary {
    /// Title with unit.
    pub title: String,
    /// Position in the units of the main axis, and what to print there.
    pub ticks: Vec<(f64, String)>,
}

/// An axis: title with unit, scale, range.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Title with unit, e.g. `wavenumber (cm⁻¹)`.
    pub title: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// First and last value, in the unit of the title; the range of the data where `None` or unusable.
    /// A first value above the last one turns the axis round.
    pub range: Option<(f64, f64)>,
    /// Another reading of the same axis; not drawn for colours.
    pub secondary: Option<Secondary>,
}

impl Axis {
    /// A linear axis over the range of the data.
    pub fn linear(title: impl Into<String>) -> Self {
        Self { title: title.into(), scale: Scale::Linear, range: None, secondary: None }
    }

    /// A logarithmic axis over the range of the data.
    pub fn log(title: impl Into<String>) -> Self {
        Self { scale: Scale::Log, ..Self::linear(title) }
    }

    /// Sets first and last value.
    #[must_use]
    pub fn range(mut self, first: f64, last: f64) -> Self {
        self.range = Some((first, last));
        self
    }

    /// Adds a second reading at the other side of the plot: positions on this axis and what to print there.
    #[must_use]
    pub fn secondary(mut self, title: impl Into<String>, ticks: Vec<(f64, String)>) -> Self {
        self.secondary = Some(Secondary { title: title.into(), ticks });
        self
    }
}

const LARGEST: f64 = 1e300;
/// Spans below this part of the numbers themselves are rounding noise: the data count as constant.
const FLAT: f64 = 1e-9;

/// Position on the scale before shifting and stretching; `None` for a number that cannot be drawn.
pub(super) fn transform(scale: Scale, value: f64) -> Option<f64> {
    match scale {
        Scale::Linear if value.abs() <= LARGEST => Some(value),
        Scale::Log if (1.0 / LARGEST..=LARGEST).contains(&value) => Some(value.log10()),
        _ => None,
    }
}

/// Maps numbers to fractions of the axis. `first` ≠ `last`, both finite, on the transformed scale.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ruler {
    pub(super) scale: Scale,
    pub(super) first: f64,
    pub(super) last: f64,
}

impl Ruler {
    /// The stated range, or that of `values` widened at both ends by `padding` of its span.
    pub(super) fn fit(
        scale: Scale,
        range: Option<(f64, f64)>,
        values: impl Iterator<Item = f64>,
        padding: f64,
    ) -> Self {
        if let Some(ruler) = Self::stated(scale, range) {
            return ruler;
        }
        let (low, high) = values
            .filter_map(|value| transform(scale, value))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(t), high.max(t)));
        Self::over(scale, range, low, high, padding)
    }

    /// The stated range, or `low` to `high`, which are on the transformed scale, widened by `padding`.
    pub(super) fn over(scale: Scale, range: Option<(f64, f64)>, low: f64, high: f64, padding: f64) -> Self {
        if let Some(ruler) = Self::stated(scale, range) {
            return ruler;
        }
        let (first, last) = if low > high {
            (0.0, 1.0)
        } else if is_flat(scale, low, high) {
            let middle = low + (high - low) / 2.0;
            let half = match scale {
                Scale::Log => 0.5,
                Scale::Linear if middle.abs() < 1.0 / LARGEST => 1.0,
                Scale::Linear => 0.1 * middle.abs(),
            };
            (middle - half, middle + half)
        } else {
            let margin = padding * (high - low);
            let (first, last) = (low - margin, high + margin);
            // Padding must not suggest that a quantity without sign has one.
            match scale {
                Scale::Linear if low >= 0.0 && first < 0.0 => (0.0, last),
                Scale::Linear if high <= 0.0 && last > 0.0 => (first, 0.0),
                _ => (first, last),
            }
        };
        Self { scale, first, last }
    }

    /// The stated range, if it is usable.
    fn stated(scale: Scale, range: Option<(f64, f64)>) -> Option<Self> {
        let (first, last) = range.and_then(|(a, b)| Some((transform(scale, a)?, transform(scale, b)?)))?;
        (!is_flat(scale, first, last)).then_some(Self { scale, first, last })
    }

    /// Fraction of the axis at which `value` stands; outside [0, 1] when out of range.
    pub(super) fn fraction(&self, value: f64) -> Option<f64> {
        transform(self.scale, value).map(|t| self.place(t))
    }

    /// Fraction for a number already on the transformed scale, bounded so that pixels stay small.
    pub(super) fn place(&self, t: f64) -> f64 {
        ((t - self.first) / (self.last - self.first)).clamp(-1e3, 1e3)
    }

    /// Lower and upper end on the transformed scale.
    pub(super) fn bounds(&self) -> (f64, f64) {
        (self.first.min(self.last), self.first.max(self.last))
    }
}

fn is_flat(scale: Scale, a: f64, b: f64) -> bool {
    let size = match scale {
        Scale::Log => 1.0,
        Scale::Linear => a.abs().max(b.abs()).max(1.0 / LARGEST),
    };
    (b - a).abs() <= FLAT * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ruler_maps_ends_to_zero_and_one_and_the_geometric_mean_to_the_middle() {
        let ruler = Ruler::fit(Scale::Log, Some((1e3, 1e12)), std::iter::empty(), 0.0);
        assert!((ruler.fraction(10f64.powf(7.5)).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(ruler.fraction(-1.0), None);
        let turned = Ruler::fit(Scale::Linear, Some((10.0, 0.0)), std::iter::empty(), 0.0);
        assert_eq!(turned.fraction(2.5), Some(0.75));
    }

    #[test]
    fn ranges_without_extent_are_opened_and_unusable_ones_replaced() {
        let flat = Ruler::fit(Scale::Linear, None, [5.0, 5.0].into_iter(), 0.05);
        assert_eq!((flat.first, flat.last), (4.5, 5.5));
        let bad = Ruler::fit(Scale::Log, Some((-1.0, 10.0)), [10.0, 1000.0].into_iter(), 0.0);
        assert_eq!((bad.first, bad.last), (1.0, 3.0));
        let none = Ruler::fit(Scale::Linear, None, [f64::NAN].into_iter(), 0.05);
        assert_eq!((none.first, none.last), (0.0, 1.0));
        let positive = Ruler::fit(Scale::Linear, None, [0.01, 1.0].into_iter(), 0.05);
        assert_eq!(positive.first, 0.0);
    }
}
