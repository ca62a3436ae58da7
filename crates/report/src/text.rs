//! Results as text for people: the answer in a sentence, then the numbers, then what they rest on.

mod apart;
mod bands;
mod camera;
mod camera_list;
mod compare;
mod exact;
mod footing;
mod many;
mod numbers;
mod pairs;
mod rule;
mod simulation;
mod sizing;
mod work;

pub use camera::camera;
pub use camera_list::cameras;
pub use compare::{comparison, comparison_sentence};
pub use many::{answers, check};
pub use numbers::{quantity, significant};
pub use rule::rule;
pub(super) use rule::{no_camera, scene, together, would_do};
pub use simulation::simulation;
pub use sizing::sizing;
pub use work::work;

pub(super) use self::footing::warnings;
use self::footing::{GAUSSIAN, assumptions};
use hadar_study::study::Study;

/// What every answer about a scene rests on.
pub(super) fn footing_of(study: &Study) -> String {
    assumptions(study, GAUSSIAN)
}
