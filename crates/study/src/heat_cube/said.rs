//! What a scenario says of its cube, and where it says it.

use hadar::error::Error;
use hadar_scenario::decompose::{HeatCube, LightSource};
use hadar_scenario::{BandsSpec, CameraSpec, Source};

/// What a scenario says of its cube.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Said<'a> {
    pub(crate) cube: &'a HeatCube,
    pub(crate) bands: Option<&'a BandsSpec>,
    pub(crate) camera: Option<&'a CameraSpec>,
    pub(crate) environment: &'a [LightSource],
    pub(crate) source: &'a Source,
    /// Temperatures that a surface may have, K.
    pub(crate) temperature_k: [f64; 2],
    /// Whether the scale of the counts is unknown.
    pub(crate) gain: bool,
}

impl Said<'_> {
    /// Puts the place of a key on an error that has none of its own.
    pub(crate) fn at(&self, key: &str) -> impl Fn(Error) -> Error + use<> {
        let place = self.source.place(key);
        let key = key.to_owned();
        move |error: Error| match &error {
            Error::At { place, .. } if place.path.is_some() => error.for_key(key.clone()),
            _ => error.at(place.clone()),
        }
    }
}
