//! The units in which a scenario was written, for the texts that answer it: whoever writes mph and °F is answered so.

use super::Source;
use hadar::units::Dimension;
use hadar::words::{length, quantity, significant};

/// Below it a length is told in inches by whoever writes feet.
const FOOT_M: f64 = 0.3048;

/// Units of temperatures, lengths and speeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Units {
    temperature: &'static str,
    length: &'static str,
    speed: &'static str,
}

impl Default for Units {
    fn default() -> Self {
        Self { temperature: "degC", length: "m", speed: "m/s" }
    }
}

impl Units {
    /// Those of the first quantity of each kind among the keys that say where, how warm and how fast.
    #[must_use]
    pub fn of(source: &Source) -> Self {
        let first = |dimension: Dimension, keys: &[&str]| {
            keys.iter().filter_map(|key| source.written(key)).find_map(|text| dimension.unit_in(text))
        };
        let default = Self::default();
        let temperatures = [
            "target.temperature",
            "environment[0].temperature",
            "scene.person_temperature",
            "scene.ground_temperature",
        ];
        let lengths = ["target.distance", "envelope.distance[0]", "cube.depth", "scene.person_distance"];
        Self {
            temperature: first(Dimension::Temperature, &temperatures).unwrap_or(default.temperature),
            length: first(Dimension::Length, &lengths).unwrap_or(default.length),
            speed: first(Dimension::Speed, &["requirement.speed", "stop.speed", "stop.speed[0]"])
                .unwrap_or(default.speed),
        }
    }

    /// Unit of temperatures, as it was written.
    #[must_use]
    pub const fn temperature_unit(self) -> &'static str {
        self.temperature
    }

    /// The number of an absolute temperature in K.
    #[must_use]
    pub fn temperature_number(self, kelvin: f64) -> f64 {
        Dimension::Temperature.in_unit(kelvin, self.temperature).unwrap_or(kelvin)
    }

    /// An absolute temperature, in K, to a hundredth of a degree.
    #[must_use]
    pub fn temperature(self, kelvin: f64) -> String {
        format!("{:.2} {}", self.temperature_number(kelvin), self.temperature)
    }

    /// A length in m; a metric one with a prefix that keeps it short, a short one of feet in inches.
    #[must_use]
    pub fn length(self, metres: f64) -> String {
        if !matches!(self.length, "ft" | "in") {
            return quantity(metres, "m");
        }
        let unit = if metres < FOOT_M { "in" } else { self.length };
        let number = Dimension::Length.in_unit(metres, unit).unwrap_or(metres);
        format!("{} {unit}", significant(number, 3))
    }

    /// A length in m of which two digits are known.
    #[must_use]
    pub fn rough_length(self, metres: f64) -> String {
        match Dimension::Length.in_unit(metres, self.length) {
            Some(number) if matches!(self.length, "ft" | "in") => {
                format!("{} {}", significant(number, 2), self.length)
            }
            _ => length(metres),
        }
    }

    /// A speed in m s⁻¹.
    #[must_use]
    pub fn speed(self, m_s: f64) -> String {
        format!("{} {}", significant(self.speed_number(m_s), 3), self.speed)
    }

    /// The number of a speed in m s⁻¹.
    #[must_use]
    pub fn speed_number(self, m_s: f64) -> f64 {
        Dimension::Speed.in_unit(m_s, self.speed).unwrap_or(m_s)
    }

    /// Unit of speeds, as it was written.
    #[must_use]
    pub const fn speed_unit(self) -> &'static str {
        self.speed
    }

    /// A range of temperatures in K, with the digits it was written with.
    #[must_use]
    pub fn temperatures(self, range_k: [f64; 2]) -> String {
        interval(range_k.map(|kelvin| self.temperature_number(kelvin)), self.temperature)
    }

    /// A range of lengths in m, with the digits it was written with.
    #[must_use]
    pub fn lengths(self, range_m: [f64; 2]) -> String {
        let number = |metres| Dimension::Length.in_unit(metres, self.length).unwrap_or(metres);
        interval(range_m.map(number), self.length)
    }
}

/// A range without the last bits of a conversion; one number where both ends are the same.
pub fn interval([low, high]: [f64; 2], unit: &str) -> String {
    let shown = |value: f64| {
        let rounded = (value * 1e6).round() / 1e6;
        if rounded == 0.0 { "0".to_owned() } else { format!("{rounded}") }
    };
    let range = if low == high { shown(low) } else { format!("{} to {}", shown(low), shown(high)) };
    if unit.is_empty() { range } else { format!("{range} {unit}") }
}
