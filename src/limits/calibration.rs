//! What a calibration can find out: bounds of response and offset, of what is measured with them, and what their errors cost.
//!
//! * [`determined`]: how many directions of a response curve readings determine, and how well each value is known;
//! * [`filter_wheel`]: readings of blackbodies behind filters as scores of the response (paper S49–S51);
//! * [`design`]: which temperatures and filters determine the most in a given time;
//! * [`blackbody`]: response and offset of a spectrometer, and the radiance measured with it (S52–S56);
//! * [`surface`]: emissivity and surroundings from a surface at several temperatures (S57, S58);
//! * [`choice`]: the best temperatures for either;
//! * [`stripes`]: what errors of the calibration leave of the information of a cube.

pub mod blackbody;
pub mod choice;
pub mod design;
pub mod determined;
pub mod filter_wheel;
pub mod stripes;
pub mod surface;
