//! Measures of texture.
