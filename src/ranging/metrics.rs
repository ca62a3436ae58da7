//! Standard metrics of a depth map.
