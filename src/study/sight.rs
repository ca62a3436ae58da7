//! What a camera sees of the scene: the bands as they reach it, and the light that is mixed in.

use super::Study;
use crate::instrument::{Camera, View};

impl Study {
    /// What a pixel of `camera` sees from the scenario's distance.
    #[must_use]
    pub fn view_of(&self, _camera: &Camera) -> View {
        View::at(self.scenario.target.distance_m)
    }
}
