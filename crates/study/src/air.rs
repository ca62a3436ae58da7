//! The air between target and camera, and what is behind the target.

use super::surface::Surface;
use hadar::atmosphere::Atmosphere;
use hadar::error::{Error, Result};
use hadar_scenario::{AtmosphereSource, AtmosphereSpec, Scenario, Source};

/// What is behind the target, on the nodes of the bands.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Behind {
    pub(super) surface: Surface,
    pub(super) temperature_k: f64,
}

/// The air on the path.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Air {
    pub(super) table: Atmosphere,
    pub(super) temperature_k: f64,
}

impl Air {
    /// The air of a scenario.
    ///
    /// # Errors
    /// An unknown model, a table that cannot be read, a target without a distance, bands that the table does not cover.
    pub(super) fn of(scenario: &Scenario) -> Result<Option<Self>> {
        let Some(spec) = &scenario.atmosphere else { return Ok(None) };
        let air = Self::looked_up(spec, &scenario.source)?;
        if scenario.target.distance_m.is_none() {
            let error = Error::malformed(
                "air on the path, but the target has no distance",
                "write distance = \"30 m\"",
            );
            return Err(error.at(scenario.place("target.distance")));
        }
        Ok(Some(air))
    }

    /// Air that is named or in a file.
    ///
    /// # Errors
    /// An unknown model, a table that cannot be read.
    pub(super) fn looked_up(spec: &AtmosphereSpec, source: &Source) -> Result<Self> {
        let table = match &spec.source {
            AtmosphereSource::Model(name) => {
                let known = Atmosphere::embedded(name).map_err(|error| match error {
                    Error::UnknownName { nearest, .. } if nearest.is_empty() => Error::malformed(
                        format!("there is no model atmosphere `{name}`"),
                        format!("choose among {}", Atmosphere::names().join(", ")),
                    ),
                    error => error,
                });
                known.map_err(|error| error.at(source.place("atmosphere.model")))?
            }
            AtmosphereSource::Table(path) => hadar_formats::spectra::atmosphere(path)?,
        };
        let Some(temperature_k) = spec.temperature_k.or(table.temperature_k()) else {
            let error = Error::malformed(
                "the temperature of the air is not given",
                "write temperature = \"15 degC\"",
            );
            return Err(error.at(source.place("atmosphere.temperature")));
        };
        Ok(Self { table, temperature_k })
    }
}
