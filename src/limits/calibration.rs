//! What a calibration can find out: bounds of response and offset, of what is measured with them, and what their errors cost.
//!
//! * [`determined`]: how many directions of a response curve readings determine, and how well each value is known;
//! * [`finer`]: the integral over a response by a finer sum than it has values;
//! * [`filter_wheel`]: readings of blackbodies behind filters as scores of the response (paper S49–S51);
//! * [`blackbody`]: response and offset of a spectrometer, and the radiance measured with it (S52–S56);
//! * [`sent`]: what a blackbody sends that is not quite black;
//! * [`surface`]: emissivity and surroundings from a surface at several temperatures (S57, S58).

pub mod blackbody;
pub mod determined;
pub mod filter_wheel;
pub mod finer;
pub mod sent;
pub mod surface;
