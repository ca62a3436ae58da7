//! What the network looks like and how it is trained.
//!
//! The paper gives three convolutions with ReLU, softmax, cross-entropy and Adam, but no sizes. Those of
//! [`Settings::default`] were found by trials with 1250 spectra of each of two classes for training and as many for
//! validation, Poisson counts whose means are ± d noise deviations off (optimum Φ(d)):
//!
//! * in 536 bands decay of the weights decides: without it the network's accuracy is 7.9, 3.0 and 1.4 % below the
//!   likelihood ratio's at d = 0.5, 1 and 2, with λ = 3 it is 1.6, 1.3 and 0.7 % below (1.0, 0.6 and 0.3 % where the
//!   classes differ smoothly from band to band, 2.7, 3.3 and 1.6 % where at random); with 5 and more, some trainings
//!   at d = 0.5 stop before they have learnt anything;
//! * stride 3 with 7 taps loses as little as stride 2 with 5, in 0.6 s of one core instead of 1.0;
//! * in 3 bands, where no layer is thinned out, λ = 1 ([`Settings::for_bands`]) loses nothing that four trainings could
//!   show at d = 0.2 to 2.2 (0.08 % or less), λ = 3 about 0.1 %; 0.04 s.

use super::convolution::BLOCK;
use hadar::error::{Error, Result, check};

/// Spectra that are worked on side by side in training.
pub(super) const LANES: usize = 16;

/// Sizes and training of a network, as they are written; [`NetworkOptions`] once they have been checked.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Channels of every convolution, a multiple of 8.
    pub channels: usize,
    /// Taps of every convolution, an odd number.
    pub taps: usize,
    /// Every how many positions a convolution is taken, in layers of 16 positions and more.
    pub stride: usize,
    /// Step of Adam at the beginning; it falls linearly to 0 over the epochs.
    pub learning_rate: f64,
    /// Spectra per step, a multiple of 16.
    pub batch: usize,
    /// Largest number of times that all spectra are gone through.
    pub epochs: usize,
    /// Epochs without a smaller validation loss after which training stops.
    pub patience: usize,
    /// Every step takes this times the learning rate off every weight, as a share of it.
    pub weight_decay: f64,
    /// Seed of the first weights and of the order of the spectra.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            channels: 8,
            taps: 7,
            stride: 3,
            learning_rate: 2e-3,
            batch: 64,
            epochs: 20,
            patience: 11,
            weight_decay: 3.0,
            seed: 1,
        }
    }
}

/// Fewer bands than this leave little to learn by heart, and take less decay.
const FEW_BANDS: usize = 16;

impl Settings {
    /// The default, with the decay of the weights that suits so many bands.
    #[must_use]
    pub fn for_bands(bands: usize) -> Self {
        let default = Self::default();
        Self { weight_decay: if bands < FEW_BANDS { 1.0 } else { default.weight_decay }, ..default }
    }
}

/// [`Settings`] that can be used.
///
/// ```
/// use hadar_simulate::classifier::network::{NetworkOptions, Settings};
/// let options = NetworkOptions::new(Settings { seed: 7, ..Settings::default() })?;
/// assert!(NetworkOptions::new(Settings { taps: 4, ..*options.settings() }).is_err());
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "Settings", into = "Settings")]
pub struct NetworkOptions(Settings);

impl NetworkOptions {
    /// Checks `settings`.
    ///
    /// # Errors
    /// Sizes of 0, above 1024, or that are no multiple of what they have to be; a step or decay that is no number.
    pub fn new(settings: Settings) -> Result<Self> {
        let whole = |what: &str, value: usize, ok: bool, expected: &str| {
            if ok { Ok(()) } else { Err(Error::out_of_range(what, value as f64, "", expected)) }
        };
        let Settings {
            channels,
            taps,
            stride,
            learning_rate,
            batch,
            epochs,
            patience,
            weight_decay,
            seed: _,
        } = settings;
        let multiple = |value: usize, of: usize| (of..=1024).contains(&value) && value.is_multiple_of(of);
        whole("channels", channels, multiple(channels, BLOCK), "a multiple of 8 up to 1024")?;
        whole("taps", taps, taps % 2 == 1 && taps < 1024, "an odd number below 1024")?;
        whole("stride", stride, (1..=1024).contains(&stride), "between 1 and 1024")?;
        whole("batch", batch, multiple(batch, LANES), "a multiple of 16 up to 1024")?;
        whole("epochs", epochs, epochs > 0, "at least 1")?;
        whole("patience", patience, patience > 0, "at least 1")?;
        check::positive("learning rate", learning_rate, "")?;
        check::non_negative("weight decay", weight_decay, "")?;
        Ok(Self(settings))
    }

    /// What was checked.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.0
    }
}

impl TryFrom<Settings> for NetworkOptions {
    type Error = Error;

    fn try_from(settings: Settings) -> Result<Self> {
        Self::new(settings)
    }
}

impl From<NetworkOptions> for Settings {
    fn from(options: NetworkOptions) -> Self {
        options.0
    }
}
