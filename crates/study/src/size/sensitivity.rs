//! What a verdict hangs on: how much one percent of each quantity changes the statistical distance, and what errors of the
//! emissivities do to it.

mod emissivity;
pub(crate) mod linear;
pub(crate) mod ripple;
pub(crate) mod scatter;

pub use emissivity::EmissivityErrors;
pub use scatter::ScatterOf;

use crate::size::Reach;
use crate::{Study, Surface};
use hadar::error::Result;
use hadar::instrument::Camera;
use hadar::policy::elasticity::{Elasticity, Lever, elasticity};
use serde::ser::{SerializeMap, Serializer};

/// Sensitivity of the verdict on a camera, against the limiting alternative.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Sensitivity {
    /// Relative change of d for a relative change of each figure q, ∂ln d/∂ln q.
    pub elasticities: Elasticities,
    /// What errors of the emissivities do.
    pub emissivity: EmissivityErrors,
}

/// Elasticities in the order of [`Lever::ALL`]; `None` for what is not known or changes nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Elasticities(pub Vec<(Lever, Option<Elasticity>)>);

impl serde::Serialize for Elasticities {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (lever, found) in &self.0 {
            map.serialize_entry(lever.key(), found)?;
        }
        map.end()
    }
}

impl Study {
    /// What the verdict on `camera` hangs on, against `alternative`, which is the `index`-th.
    pub(crate) fn sensitivity(
        &self,
        camera: &Camera,
        alternative: &Surface,
        index: usize,
    ) -> Result<Sensitivity> {
        let own = self.task(camera).own();
        let mut reach = Reach::new(self, alternative);
        reach.anew(&own)?;
        let mut found = Vec::with_capacity(Lever::ALL.len());
        for lever in Lever::ALL {
            let value = match lever {
                Lever::Distance if own.distance_m.is_none() => None,
                // A table of the air may end before the farther of two distances.
                Lever::Distance => elasticity(lever, &own, |trial| reach.followed(trial)).unwrap_or(None),
                _ => elasticity(lever, &own, |trial| reach.followed(trial))?,
            };
            found.push((lever, value));
        }
        let emissivity = self.emissivity_errors(camera, alternative, index)?;
        Ok(Sensitivity { elasticities: Elasticities(found), emissivity })
    }
}
