//! How well depth can be measured, in a sentence.

use super::results::{DepthFinding, Signal};
use crate::words::error_of;
use hadar::words::{self, significant};
use serde::{Serialize, Serializer};
use std::fmt::{self, Display, Formatter};

impl Display for DepthFinding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Judged { met, error, share, required_share, signal, beside } => {
                write!(
                    f,
                    "{}: depth can be measured to within {} in {} of the windows at best, by the {} ({} demanded)",
                    if *met { "Yes" } else { "No" },
                    error_of(*error),
                    words::share(*share),
                    signal.name(),
                    words::share(*required_share),
                )?;
                if let Some((signal, share)) = beside {
                    let name = match signal {
                        Signal::ThermalImage => "thermal image, all bands together,",
                        _ => "heat cube, all bands apart,",
                    };
                    write!(f, "; a {name} allows it in {}", words::share(*share))?;
                }
                f.write_str(".")
            }
            Self::NoDepth { disparity_error_px } => write!(
                f,
                "A window's disparity can be known to {} pixels at best (median, heat cube); give the depth for what that \
                 means in metres.",
                significant(*disparity_error_px, 2)
            ),
            Self::NoBound => f.write_str("No window has a bound."),
        }
    }
}

impl Serialize for DepthFinding {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
