//! How well depth can be measured, in a sentence.

pub(crate) mod captions;
mod text;

pub use text::{text, verdict};

use super::demand::error_of;
use super::{Say, conditions};
use hadar::words::{self, significant};
use hadar_study::range::{DepthFinding, Signal};
use std::fmt::Write as _;

impl Say for DepthFinding {
    fn say(&self) -> String {
        match self {
            Self::Judged {
                met,
                error,
                share,
                required_share,
                signal,
                beside,
                windows: [judged, of],
                overfull,
                conditions,
            } => {
                let mut out = format!(
                    "{}: depth can be measured to within {} in {} of {} at best, by the {} ({} required)",
                    match (met, overfull) {
                        (_, Some(full)) => format!("No, as {}; if all could be counted", saturates(*full)),
                        (Some(true), _) => conditions::yes(conditions).replacen('y', "Y", 1),
                        (Some(false), _) => "No".into(),
                        (None, _) => "Undecided".into(),
                    },
                    error_of(*error),
                    words::share(*share),
                    if judged == of { "the windows".to_owned() } else { format!("all {of} windows") },
                    signal.name(),
                    words::share(*required_share),
                );
                if let Some((signal, share)) = beside {
                    out += &format!("; a {} allows it in {}", beside_it(*signal), words::share(*share));
                }
                if judged < of {
                    let _ = write!(
                        out,
                        "; {judged} of {of} windows were judged: the others have no depth, a missing sample or no partner in the right \
                         view, and count as not reaching it"
                    );
                    if met.is_none() {
                        out += ", but could";
                    }
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

/// That the brightest reading does not fit into the well, of photons of both.
pub(crate) fn saturates([counts, full_well]: [f64; 2]) -> String {
    format!(
        "the brightest reading holds {} photons and the full well {} (the pixel saturates)",
        significant(counts, 2),
        significant(full_well, 2)
    )
}
