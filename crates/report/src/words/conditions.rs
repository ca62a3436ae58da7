//! What a 'yes' is subject to.

use super::Say;
use hadar::words::{length, quantity};
use hadar_study::Proviso;

/// It completes 'yes, if '.
impl Say for Proviso {
    fn say(&self) -> String {
        let (time, way) = (quantity(self.time_s, "s"), length(self.way_m));
        format!("its {} frames can be registered ({time}, a way of {way})", self.frames)
    }
}
