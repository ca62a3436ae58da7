//! A trained network, and how it is written: everything that decides its scores, and nothing that follows from it.

use super::layers::Layers;
use super::options::NetworkOptions;
use super::standard::Standard;
use super::training::Outcome;
use hadar::error::{Error, Result};

/// A trained network.
///
/// ```
/// use hadar_simulate::classifier::network::{Network, NetworkOptions};
/// use hadar_simulate::{classifier::Classifier, draws::Draws, spectra::Split};
/// use hadar::statistics::Statistics;
/// let class = |means: &[f64]| Draws::new(&Statistics::Poisson, means);
/// let split = Split::draw(&[class(&[1e4, 1e4])?, class(&[1.1e4, 0.9e4])?], 400, 1)?;
/// let network = Network::train(&split.training, &split.validation, &NetworkOptions::default(), &|_, _| ())?;
/// let mut scores = [0.0; 2];
/// assert!(network.judge().score(&[1.1e4, 0.9e4], &mut scores) && scores[1] > scores[0]);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "Stored", into = "Stored")]
pub struct Network {
    pub(super) layers: Layers,
    pub(super) options: NetworkOptions,
    pub(super) standard: Standard,
    pub(super) weights: Vec<f32>,
    pub(super) outcome: Outcome,
}

/// What is written of a [`Network`]. f32 and f64 come back with the same bits from any format that keeps them.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    bands: usize,
    classes: usize,
    options: NetworkOptions,
    standard: Standard,
    weights: Vec<f32>,
    outcome: Outcome,
}

impl From<Network> for Stored {
    fn from(network: Network) -> Self {
        let Network { layers, options, standard, weights, outcome } = network;
        Self { bands: layers.bands, classes: layers.classes, options, standard, weights, outcome }
    }
}

impl TryFrom<Stored> for Network {
    type Error = Error;

    fn try_from(stored: Stored) -> Result<Self> {
        let Stored { bands, classes, options, standard, weights, outcome } = stored;
        let layers = Layers::checked(bands, classes, options.settings())?;
        for (what, found, expected) in [
            ("weights of the network", weights.len(), layers.weights()),
            ("weights of the network's outcome", outcome.weights, layers.weights()),
            ("means of the network's bands", standard.means.len(), bands),
            ("scales of the network's bands", standard.scales.len(), bands),
        ] {
            if found != expected {
                return Err(Error::Length { what: what.into(), found, expected });
            }
        }
        let mut numbers = weights.iter().copied().map(f64::from);
        let others = standard.means.iter().chain(&standard.scales).chain([&outcome.validation_loss]);
        if let Some(number) = numbers.find(|x| !x.is_finite()).or(others.copied().find(|x| !x.is_finite())) {
            return Err(Error::out_of_range("a number of the network", number, "", "a finite number"));
        }
        Ok(Self { layers, options, standard, weights, outcome })
    }
}
