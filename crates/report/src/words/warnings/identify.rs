//! Distances between materials, and the scene that they are of.

use super::block::words;
use hadar::scene::Parameter;
use hadar::words::{fixed, significant};

words! {
    Identical {
        meaning: "The two materials have equal emissivities in every band: no camera distinguishes them.",
        remedy: "Choose bands in which they differ.",
        Identical => "the two emissivities are equal in every band",
    }
    Placeholders {
        meaning: "Both materials are entered as one number for all wavenumbers, so that nothing is known of \
            what distinguishes them.",
        remedy: "Give a measured spectrum of at least one of them.",
        Placeholders { target, alternative, emissivities } => format!(
            "{target} and {alternative} are each entered as one number ({} and {}): that they can or cannot be distinguished \
             says nothing of real surfaces",
            emissivities[0], emissivities[1]
        ),
    }
    Equilibrium {
        meaning: "Target and surroundings are in thermal equilibrium, where every material looks like a \
            blackbody.",
        remedy: "Look at another time or place, where temperatures differ, or light the scene.",
        Equilibrium => "target and surroundings are in thermal equilibrium; every material looks like a blackbody",
    }
    Blind {
        meaning: "A change of the unknowns looks exactly like the change of material, to first order.",
        remedy: "Take more bands, or make an unknown known (fewer nuisances, a prior, lighting_total).",
        Blind => "a change of the unknowns looks exactly like the change of material",
    }
    NearestAtEdge {
        meaning: "The state in which the alternative is most similar to the target is at the end of a range that the \
            scenario sets.",
        remedy: "Check that the range covers what can occur: the answer depends on it.",
        NearestAtEdge { parameters, objects } => format!(
            "the closest confuser is at the edge of its range ({}); the range decides the answer",
            listed(parameters, *objects)
        ),
    }
    LocalDiffers {
        meaning: "Local and nearest distance differ much: the linear approximation in the unknowns has \
            failed.",
        remedy: "Use the nearest distance (requirement.by = \"nearest\").",
        LocalDiffers { local, nearest, ratio } => format!(
            "local ({}) and nearest ({}) distance differ by a factor {}; only the nearest one is a limit",
            significant(*local, 3),
            significant(*nearest, 3),
            fixed(*ratio, 1)
        ),
    }
    Fragile {
        meaning: "Spectra are nearly featureless, so that small errors of the emissivities change the \
            distance several times over.",
        remedy: "Measure the emissivities better, or take the answer as an order of magnitude.",
        Fragile => "the spectra are nearly featureless: errors of 0.1 % in the emissivities can change this distance several \
             times over",
        FragileScene => "the spectra of the limiting scene are nearly featureless: errors of 0.1 % in the emissivities \
             can change the distance several times over",
    }
    UnknownWithoutEffect {
        meaning: "An unknown changes nothing in this scene and was left out.",
        remedy: "Nothing; or take it out of unknown.nuisances.",
        UnknownWithoutEffect { parameters, objects } => {
            let change = if parameters.len() == 1 { "changes" } else { "change" };
            format!("{} {change} nothing in this scene", listed(parameters, *objects))
        },
        AirUnknownWithoutEffect { unknowns } => format!(
            "{} {} nothing in this scene",
            unknowns.join(", "),
            if unknowns.len() == 1 { "changes" } else { "change" }
        ),
    }
    NearestSearch {
        meaning: "The closest confuser was searched and not proved to be the closest: its distance may be too large.",
        remedy: "Rely on what is proved (distance_nearest_lower), or make an unknown known.",
        NearestSearch { distance, lower, priors } => {
            let why = if *priors { ", which leaves priors out," } else { "" };
            let proved = match 1.0 - lower / distance {
                // Three digits would show the same number twice.
                gap if gap < 0.01 => format!("comes within {gap:.0e} of it"),
                _ => format!("says no more than that it is at least {}", significant(*lower, 3)),
            };
            format!("the nearest distance, {}, is the best of a search; the proof{why} {proved}", significant(*distance, 3))
        },
        MatrixNotProved { searches } => {
            format!("{searches} nearest distances of the matrix are searched and not proved; verdicts rest on what is proved")
        },
    }
    FewDigits {
        meaning: "Rounding leaves fewer correct digits of a distance than are printed, or none.",
        remedy: "Do not rely on that distance; take away unknowns that hardly differ from others, or light \
            that nearly cancels.",
        FewDigits { distance, relative_error } if *relative_error < 1.0 => {
            format!("rounding leaves only the first digits of the {distance}: its relative error is about {relative_error:.0e}")
        },
        FewDigits { distance, .. } => format!("rounding leaves no digit of the {distance}: it may have any value"),
    }
    Bunching {
        meaning: "The number of photons per mode is high enough for bunching to raise the noise noticeably.",
        remedy: "Set camera.photon_bunching = true to include it.",
        Bunching { occupancy, wavenumber_cm1, included } => {
            let what = if *included {
                "bunching raises the noise of the light that is counted, which is included"
            } else {
                "bunching, which is neglected (camera.photon_bunching), raises the noise by as much"
            };
            format!("{} photons per mode at {wavenumber_cm1:.0} cm^-1: {what}", fixed(*occupancy, 2))
        },
    }
    EnvelopeNotSearched {
        meaning: "The scenario has an operating envelope, and this answer is for its one scene.",
        remedy: "Ask `hadar rule` for the worst scene of the operating envelope.",
        EnvelopeNotSearched => "this is the answer for the one scene; the [envelope] is searched by `hadar rule`",
    }
    MatrixPriors {
        meaning: "Distances of the matrix per sqrt(photon) do not include the priors; its \
            statistical distances do.",
        remedy: "Read the statistical distances.",
        MatrixPriors => "the matrix's distances per sqrt(photon) are those of many photons, where priors have no weight; \
             its statistical distances include them",
    }
    TrialsEnded {
        meaning: "Simulations ended at the maximum number of trials with intervals wider than asked for.",
        remedy: "Raise --trials, or ask for less with --half-width.",
        TrialsEnded { wide, simulations, most_trials, widest, asked } => format!(
            "{wide} of {simulations} simulations ended after {most_trials} trials of a state with intervals of up to \
             +- {widest:.2}, not the +- {asked} asked for; raise --trials, or ask for less with --half-width"
        ),
    }
}

/// Parameters as a reader calls them.
fn listed(parameters: &[Parameter], objects: usize) -> String {
    let words = parameters.iter().map(|parameter| in_words(*parameter, objects));
    words.collect::<Vec<_>>().join(", ")
}

fn in_words(parameter: Parameter, objects: usize) -> String {
    let of = |what: &str, k: usize| {
        if objects > 1 {
            format!("{what} of environment[{k}]")
        } else {
            format!("{what} of the surroundings")
        }
    };
    match parameter {
        Parameter::Temperature => "temperature".into(),
        Parameter::Lighting(k) => of("lighting", k),
        Parameter::Gain => "gain".into(),
        Parameter::EnvironmentTemperature(k) => of("temperature", k),
        Parameter::Material => "material".into(),
    }
}
