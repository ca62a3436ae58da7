//! An accuracy held against the limit.

use hadar::error::Result;
use hadar_simulate::efficiency::PhotonShare;
use hadar_simulate::experiment::Performance;

/// An interval with a half width above this share of what the limit has over guessing is too wide to say that it is reached.
const NARROW: f64 = 0.25;
/// What one classifier achieved, held against the limit.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SimulatedPerformance {
    /// How often it was right.
    #[serde(flatten)]
    pub performance: Performance,
    /// Information log₂ 2P of its balanced accuracy P, bits; `None` for more than two classes.
    pub information_bits: Option<f64>,
    /// Share of the photons with which an ideal classifier of known states would have been as accurate, with its
    /// interval; `None` for more than two classes, with electronic noise (whose d² does not grow with the
    /// photons), and where every decision was right.
    pub photon_share: Option<f64>,
    /// Lower end of its interval.
    pub photon_share_low: Option<f64>,
    /// Upper end of its interval.
    pub photon_share_high: Option<f64>,
    /// How its accuracy compares with the limit; `None` for more than two classes.
    pub standing: Option<Standing>,
}

hadar::named! {
    /// An accuracy against the limit.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Standing {
        /// Above it by more than chance explains in all comparisons together: the limit would be wrong.
        Beyond = "beyond",
        /// An interval that is narrow enough to mean something reaches up to the limit.
        Reaches = "reaches",
        /// The interval reaches up to the limit, but is too wide to mean much.
        Undecided = "undecided",
        /// Below it.
        Below = "below",
    }
    /// The name in tables.
    name
}

/// A performance beside the limit of the accuracy of its pair of classes; `distance` is theirs, where the share of
/// photons can be told from it, levels are those of all comparisons together and of one.
pub(super) fn held_against(
    performance: Performance,
    limit: Option<f64>,
    distance: Option<f64>,
    (together, level): (f64, f64),
) -> Result<SimulatedPerformance> {
    let confusion = &performance.confusion;
    let spectra: f64 = confusion.spectra().iter().sum();
    let right = performance.accuracy * spectra;
    let share = match distance.filter(|distance| *distance > 0.0) {
        Some(distance) => Some(PhotonShare::of(right, spectra.round() as u64, distance, level)?),
        _ => None,
    };
    let guessing = 1.0 / confusion.spectra().len().max(1) as f64;
    let standing = limit.map(|limit| {
        let interval = performance.interval;
        if confusion.interval(together).low > limit {
            Standing::Beyond
        } else if interval.high < limit {
            Standing::Below
        } else if interval.half_width() > NARROW * (limit - guessing) {
            Standing::Undecided
        } else {
            Standing::Reaches
        }
    });
    Ok(SimulatedPerformance {
        information_bits: (confusion.spectra().len() == 2).then(|| (2.0 * performance.accuracy).log2()),
        photon_share: share.and_then(|share| share.share),
        photon_share_low: share.map(|share| share.share_low),
        photon_share_high: share.and_then(|share| share.share_high),
        standing,
        performance,
    })
}
