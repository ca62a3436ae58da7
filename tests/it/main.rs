//! Tests of the numerical crate, seen from outside.

mod calibrate_noise;
mod calibrate_stripes;
mod cameras;
mod classes;
mod decision;
mod decompose;
mod decompose_methods;
mod decompose_spatial;
mod derivatives;
mod detection_reference;
mod distil;
mod exact_probability;
mod inputs;
mod likelihood;
mod many_materials;
mod nearest_extremes;
mod nearest_minimum;
mod nearest_search;
mod noise_budget;
mod pairs_reference;
mod planck_reference;
mod properties;
mod ranging_reference;
mod segmentation;
mod selection;
mod separation;

mod support {
    pub(crate) mod scenes;
}
