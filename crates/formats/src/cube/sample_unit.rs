//! What the samples of a cube are by the unit that its file states: counts, or something else that looks like them.

/// What samples are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleUnit {
    /// Photons or photoelectrons, counted; also what is said to have no unit.
    Counts,
    /// Temperatures.
    Temperature,
    /// Shares of light, such as reflectance and emissivity.
    Share,
    /// Something else that may be in proportion to counts, such as radiance or digital numbers.
    Other,
}

/// Spellings in lower case, without brackets, blanks, underscores and hyphens.
const COUNTS: &[&str] = &[
    "",
    "count",
    "counts",
    "photon",
    "photons",
    "photoncount",
    "photoncounts",
    "electron",
    "electrons",
    "photoelectron",
    "photoelectrons",
    "e",
    "none",
    "unitless",
    "dimensionless",
    "unknown",
    "n/a",
];
/// What a word holds that names one.
const TEMPERATURE_WORDS: &[&str] = &["kelvin", "celsius", "centigrade", "fahrenheit", "temperature"];
const SHARE_WORDS: &[&str] = &[
    "reflectance",
    "reflectivity",
    "emissivity",
    "emittance",
    "albedo",
    "transmittance",
    "absorbance",
    "percent",
    "%",
];

/// Those of them that say nothing of what is counted.
const NOTHING: &[&str] = &["", "none", "unitless", "dimensionless", "unknown", "n/a", "1"];

impl SampleUnit {
    /// Whether a unit says nothing of what samples are.
    #[must_use]
    pub fn says_nothing(text: &str) -> bool {
        NOTHING.contains(&text.trim().to_lowercase().as_str())
    }

    /// What samples in a unit are, spelt as files spell it: `K`, `degrees_Celsius`, `0.01 K`, `photons`, `W m-2 sr-1 um-1`, …
    ///
    /// ```
    /// use hadar_formats::cube::SampleUnit;
    /// assert_eq!(SampleUnit::spelt("Photon counts"), SampleUnit::Counts);
    /// assert_eq!(SampleUnit::spelt("0.01 K"), SampleUnit::Temperature);
    /// assert_eq!(SampleUnit::spelt("0.01*K"), SampleUnit::Temperature);
    /// assert_eq!(SampleUnit::spelt("toa_brightness_temperature"), SampleUnit::Temperature);
    /// assert_eq!(SampleUnit::spelt("%"), SampleUnit::Share);
    /// assert_eq!(SampleUnit::spelt("W m-2 sr-1 um-1"), SampleUnit::Other);
    /// assert_eq!(SampleUnit::spelt("DN"), SampleUnit::Other);
    /// ```
    #[must_use]
    pub fn spelt(text: &str) -> Self {
        let lower = text.to_lowercase();
        let parts = lower.split(|char: char| char.is_whitespace() || "_-()[]{}".contains(char));
        // A factor before the unit changes nothing of what it is.
        let is_factor = |part: &&str| part.parse::<f64>().is_ok() || matches!(*part, "*" | "x" | "·");
        let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
        let factors = parts.iter().take_while(|part| is_factor(part)).count();
        let unit = parts.get(factors..).unwrap_or_default().concat();
        let holds = |words: &[&str]| words.iter().any(|word| unit.contains(word));
        if TemperatureUnit::spelt(text).is_some() || holds(TEMPERATURE_WORDS) {
            Self::Temperature
        } else if holds(SHARE_WORDS) {
            Self::Share
        } else if factors == 0 && COUNTS.contains(&unit.as_str()) || parts == ["1"] {
            Self::Counts
        } else {
            Self::Other
        }
    }
}

/// A unit of temperatures: T = zero + number · kelvin, K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TemperatureUnit {
    kelvin: f64,
    zero_k: f64,
}

impl TemperatureUnit {
    /// K.
    pub const KELVIN: Self = Self { kelvin: 1.0, zero_k: 0.0 };

    /// The unit of a spelling, with a factor and with what the temperatures are of before it: `K`, `0.01 K`, `mK`, `degC`, `brightness temperature (K)`.
    ///
    /// ```
    /// use hadar_formats::cube::TemperatureUnit;
    /// assert!((TemperatureUnit::spelt("0.01 K").unwrap().kelvin(30015.0) - 300.15).abs() < 1e-12);
    /// assert_eq!(TemperatureUnit::spelt("degC").unwrap().kelvin(27.0), 300.15);
    /// assert_eq!(TemperatureUnit::spelt("brightness_temperature [degF]").unwrap().kelvin(32.0), 273.15);
    /// assert!(TemperatureUnit::spelt("W m-2").is_none());
    /// ```
    #[must_use]
    pub fn spelt(text: &str) -> Option<Self> {
        let lower = text.to_lowercase().replace('℃', "°c");
        let parts = lower.split(|char: char| char.is_whitespace() || "_-()[]{}*×·".contains(char));
        let what = ["toa", "brightness", "apparent", "blackbody", "temperature", "temperatures", "in"];
        let mut parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
        let named = parts.iter().any(|part| part.starts_with("temperature"));
        parts.retain(|part| !what.contains(part));
        let factor = match parts.first().map(|part| part.parse::<f64>()) {
            Some(Ok(factor)) if factor > 0.0 && factor.is_finite() => {
                parts.remove(0);
                factor
            }
            _ => 1.0,
        };
        let degree = |unit: &str| {
            unit.trim_start_matches("degrees")
                .trim_start_matches("degree")
                .trim_start_matches("deg")
                .trim_start_matches('°')
                .to_owned()
        };
        let (kelvin, zero_k) = match degree(&parts.concat()).as_str() {
            "k" | "kelvin" | "kelvins" => (1.0, 0.0),
            // Of CF's names the unit is K.
            "" if named && factor == 1.0 => (1.0, 0.0),
            "mk" | "millikelvin" => (1e-3, 0.0),
            "ck" | "centikelvin" => (1e-2, 0.0),
            "c" | "celsius" | "centigrade" => (1.0, 273.15),
            "f" | "fahrenheit" => (5.0 / 9.0, 273.15 - 32.0 * 5.0 / 9.0),
            _ => return None,
        };
        Some(Self { kelvin: kelvin * factor, zero_k })
    }

    /// The temperature of a number, K.
    #[must_use]
    pub fn kelvin(self, number: f64) -> f64 {
        self.zero_k + number * self.kelvin
    }

    /// The difference of temperatures that a number is, K.
    #[must_use]
    pub fn kelvin_apart(self, number: f64) -> f64 {
        number * self.kelvin
    }
}
