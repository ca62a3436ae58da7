//! A trained network as it is written: everything that decides its scores, and nothing that follows from it.

use super::layers::Layers;
use super::{Network, NetworkOptions, Outcome, Standard};
use crate::error::{Error, Result};

/// What is written of a [`Network`]. f32 and f64 come back with the same bits from any format that keeps them.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Stored {
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
