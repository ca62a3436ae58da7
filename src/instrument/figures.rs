//! What may be stated of a camera: every figure once.
//!
//! [`CameraSpec`] holds what is stated, each figure or none: by a document ([`super::presets`]), by the `[camera]` of a
//! scenario, or by both, one laid over the other. [`TABLE`] has a [`Row`] for every key of `[camera]`: what kind of value it
//! is, which are allowed, an example, what it means, and where it stands in [`CameraSpec`]. Reading and writing a scenario,
//! laying one camera over another, checking ranges, naming a changed camera, the sheet of a camera, what is asked
//! for where it is missing are loops over it.
//!
//! A new figure takes a block of `figures/list.rs`, of which fields, row, reading and writing are made, and the physics that uses it. What
//! stands for it where it is not stated is said in `made.rs`, unless it is nothing.

mod list;
mod noise;
mod row;
mod spec;
mod table;

pub(super) use list::every_figure;
pub use noise::{NoiseFigures, StatedNoise};
pub use row::{BLANK, Kind, Line, Part, Row, Slot};
pub use spec::{CameraSpec, Efficiency};
pub use table::{FASTEST_F_NUMBER, NOISES, TABLE};

/// The row of a key.
#[must_use]
pub fn row(key: &str) -> Option<&'static Row> {
    TABLE.iter().find(|row| row.key == key)
}

impl CameraSpec {
    /// Whether it states a noise of its own.
    #[must_use]
    pub fn states_noise(&self) -> bool {
        // One is of its own kind.
        self.noise.is_of_kind(&self.noise)
    }
}
