//! Stereo matching of noisy views, held against its bound.
