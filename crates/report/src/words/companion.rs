//! What sizing practice says: what a number is worth, its caveat, and why there is none.

mod text;

pub(crate) use text::text;

use super::Say;
use hadar_study::companion::{Caveat, Kind, Unknown};

impl Say for Kind {
    fn say(&self) -> String {
        let words = match self {
            Self::RuleOfThumb => "rule of thumb",
            Self::ObserverModel => "observer model",
            Self::Bound => "bound",
        };
        words.into()
    }
}

impl Say for Caveat {
    fn say(&self) -> String {
        let words = match self {
            Self::Geometry => {
                "geometry alone: no noise, contrast, air, blur or motion; the same whatever the target's temperature and material"
            }
            Self::FieldOfViewDiffers => {
                "the camera's field of view over its pixels is another angle than its pixel over its focal length: one of \
                 the figures is wrong, and with it every range of geometry"
            }
            Self::NetdAlone => {
                "computed at the background temperature of ASTM E1543, whose scope is scanning systems; 'intercomparisons \
                 based solely on NETD figures may be misleading'"
            }
            Self::Observers => {
                "fitted to people before displays; the cycles are those of the pixels, without noise, contrast and blur; shape, \
                 not material"
            }
            Self::Mrtd => {
                "the eye is in the factor of perception, which is a choice; differences below 0.2 degC are insignificant \
                 (ASTM E1213); a lens without aberrations; what is behind the target must differ by so much"
            }
            Self::Limit => {
                "no algorithm is right more often by one pixel; a limit, not a promise; material, not shape"
            }
            Self::AllAlike => {
                "no algorithm is right more often by all pixels of a square target whose pixels are all in the state of the \
                 scenario, their noise independent where the verdict is of one; a limit, not a promise; material, not shape"
            }
        };
        words.into()
    }
}

impl Say for Unknown {
    fn say(&self) -> String {
        let words = match self {
            Self::NoCamera => "there is no camera",
            Self::NoSize => "the size of the target is not given",
            Self::NoDistance => "the distance of the target is not given",
            Self::NoLight => "the camera counts no photons of a blackbody at that temperature",
            Self::BeyondNumbers => "size over distance is beyond all numbers",
            Self::FinerThanPixels => "such bars are finer than the pixels sample",
            Self::FinerThanLens => "the lens leaves nothing of such bars",
            Self::NotCompared => "nothing was distinguished from anything",
        };
        words.into()
    }
}
