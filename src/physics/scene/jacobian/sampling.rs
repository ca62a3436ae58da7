//! From spectra at the nodes to signals of the bands, by the shortest way.

use super::kernels::scale_by;
use crate::spectrum::Bands;

/// How spectra at the nodes become band signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sampling {
    /// One node of weight 1 per band: node values are band signals.
    Unit,
    /// One node per band.
    Scaled,
    /// A weighted sum over several nodes.
    Integrated,
}

impl Sampling {
    pub(super) fn of(bands: &Bands) -> Self {
        if !bands.one_node_per_band() {
            Self::Integrated
        } else if bands.weights_cm1().iter().all(|&weight| weight == 1.0) {
            Self::Unit
        } else {
            Self::Scaled
        }
    }

    /// Band signals of the spectrum that `write` puts into the slice it is given.
    pub(crate) fn sample(
        self,
        bands: &Bands,
        scratch: &mut [f64],
        out: &mut [f64],
        write: impl FnOnce(&mut [f64]),
    ) {
        match self {
            Self::Unit => write(out),
            Self::Scaled => {
                write(out);
                scale_by(bands.weights_cm1(), out);
            }
            Self::Integrated => {
                write(scratch);
                bands.weigh_into(scratch, out);
            }
        }
    }
}
