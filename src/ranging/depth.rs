//! Depth bound: δz, and what a demanded δz asks of the stereo camera.
