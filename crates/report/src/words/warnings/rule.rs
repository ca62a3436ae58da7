//! Rules: their days, their envelopes, their cameras.

use super::block::{short, words};
use crate::words::Say;
use hadar_study::{NotInForce, Proviso};

words! {
    NotInForce {
        meaning: "The rule does not hold on the day that was asked about: nothing is demanded.",
        remedy: "Nothing; or ask about another day with --on.",
        NotInForce(idle) => idle.say(),
    }
    EmissivityErrorsLeftOut {
        meaning: "The rule has errors of emissivities, and this answer takes all spectra to be exact.",
        remedy: "Ask for a tolerance of the emissivity that covers them.",
        EmissivityErrorsLeftOut => "errors of the emissivities, [sensitivity], are not included: all spectra are taken to be exact",
    }
    NotProved {
        meaning: "That no scene of the operating envelope is below the requirement was searched for, not proved.",
        remedy: "Narrow the operating envelope, so that the search can prove it.",
        NotProved => "that no scene of the operating envelope is below the requirement was searched, not proved",
    }
    BrightestNoise {
        meaning: "Noise that depends on the scene is taken where it is largest, so that the distance is a \
            lower bound.",
        remedy: "Nothing; the verdict is on the safe side.",
        BrightestNoise => "noise that depends on the scene is taken in the brightest scene, so the distance is a lower bound; \
             what would fix the camera is computed in the limiting scene itself",
    }
    FramesInMotion {
        meaning: "The frames of a camera are added up while something moves: motion blur takes them to be \
            registered.",
        remedy: "Register the frames, or take fewer.",
        FramesInMotion(Proviso { frames, time_s, way_m }) => format!(
            "its {frames} frames take {} s, over {} m at the required speed: they must be registered, and the \
             scene must not change; motion blur is that of each by itself",
            short(*time_s),
            short(*way_m)
        ),
    }
}

impl Say for NotInForce {
    fn say(&self) -> String {
        let Self { day, from, until } = self;
        let but = match (from, until) {
            (Some(from), _) if day < from => format!(", it holds from {from}"),
            (_, Some(until)) => format!(", it held until {until}"),
            _ => String::new(),
        };
        format!("the rule does not hold on {day}{but}")
    }
}
