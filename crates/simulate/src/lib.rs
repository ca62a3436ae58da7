//! Monte Carlo witnesses: what a test that draws its own counts really achieves, beside the bounds.
//!
//! * [`draws`]: counts about given means by the laws of [`hadar::statistics`];
//! * [`ratio`]: trials between two known states, from the law of their likelihood ratio;
//! * [`sequential`]: how sure a proportion of trials is, and when there have been enough;
//! * [`classifier`]: rules of decision, those that know the physics and those that learn, behind one trait;
//! * [`decision`]: the maximum-likelihood decision among materials whose states are not known;
//! * [`spectra`], [`experiment`]: labelled spectra, and how often each classifier is right about them;
//! * [`thermometry`]: temperatures read by maximum likelihood and by thermal imaging;
//! * [`air_ranging`]: distances read by maximum likelihood from the air on the path;
//! * [`efficiency`]: whether an estimator or a classifier reaches its bound;
//! * [`matching`]: stereo pairs drawn, and depth by block matching;
//! * [`render`]: stereo pairs of heat cubes of a scene.
//!
//! Bounds never make use of simulations. Every block of trials has a stream of random numbers of its own, so results
//! do not depend on the number of threads, and a seed brings them back.

pub mod air_ranging;
pub mod average;
pub mod classifier;
pub mod decision;
pub mod draws;
pub mod efficiency;
pub mod experiment;
pub mod matching;
pub mod ratio;
pub mod render;
pub mod sequential;
pub mod spectra;
pub mod thermometry;
