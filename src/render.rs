//! Renders stereo pairs of heat cubes from a scene.
