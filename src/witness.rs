//! Witnesses of the limits: what draws counts and views, and estimates from them.

pub mod calibrate;
pub mod decompose;
pub mod render;
pub mod segmentation;
pub mod separation;
pub mod simulate;
