//! Fisher information about position in a scattered signal that is itself estimated from the bands.
