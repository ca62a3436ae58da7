//! What diffraction and the size of the pixel leave of the position of a point source.
