//! How well depth can be measured, in a sentence.

pub(crate) mod captions;
mod text;

pub use text::text;

use super::Say;
use super::demand::error_of;
use hadar::words::{self, significant};
use hadar_study::range::{DepthFinding, Signal};

impl Say for DepthFinding {
    fn say(&self) -> String {
        match self {
            Self::Judged { met, error, share, required_share, signal, beside } => {
                let mut out = format!(
                    "{}: depth can be measured to within {} in {} of the windows at best, by the {} ({} demanded)",
                    if *met { "Yes" } else { "No" },
                    error_of(*error),
                    words::share(*share),
                    signal.name(),
                    words::share(*required_share),
                );
                if let Some((signal, share)) = beside {
                    out += &format!("; a {} allows it in {}", beside_it(*signal), words::share(*share));
                }
                out + "."
            }
            Self::NoDepth { disparity_error_px } => format!(
                "A window's disparity can be known to {} pixels at best (median, heat cube); give the depth for what that \
                 means in metres.",
                significant(*disparity_error_px, 2)
            ),
            Self::NoBound => "No window has a bound.".into(),
        }
    }
}

/// The signal that does not decide, with what it is.
const fn beside_it(signal: Signal) -> &'static str {
    match signal {
        Signal::ThermalImage => "thermal image, all bands together,",
        Signal::HeatCube => "heat cube, all bands apart,",
        Signal::Reconstructed => "heat cube, temperature estimated,",
        Signal::ReconstructedBlind => "heat cube, temperature and emissivity estimated,",
        Signal::ScatteredAsMeasured => "scattered signal, as if it were measured,",
    }
}
