//! Fig. 3c: photons required over target temperature and lighting, with the singularity at thermal equilibrium.

use super::ledger::{Line, Verdict};
use super::order::{Figures, Made};
use super::scene;
use hadar::error::Result;
use hadar_report::bundle::Bundle;
use hadar_report::size::figures;
use hadar_scenario::examples;

pub(super) fn make() -> Result<Made> {
    let study = scene::study(examples::HUMAN_VS_ROBOT)?;
    let mut bundle = Bundle::default();
    bundle.add_asked("scenario.toml", study.scenario().to_toml());
    let mut lines = Vec::new();
    let result = study.identify()?;
    if let ([rival], [pair]) = (study.alternatives(), result.pairs.as_slice())
        && let Some(map) = study.photon_map(rival)?
    {
        let state = study.state();
        let here = (state.temperature_k, state.lighting.first().copied().unwrap_or(0.0));
        let by = study.scenario().requirement.by.name();
        let pair_names = [study.target().name.as_str(), rival.name.as_str()];
        let drawn = figures::photon_map(&map, pair_names, here, by, None);
        bundle.add_plots(&drawn.into_iter().collect::<Vec<_>>())?;
        let endless = map.photons.iter().filter(|photons| photons.is_infinite()).count();
        let least = map.photons.iter().copied().fold(f64::INFINITY, f64::min);
        let most = map.photons.iter().copied().filter(|n| n.is_finite()).fold(0.0, f64::max);
        let photons = pair.photons_required.unwrap_or(f64::INFINITY);
        lines.push(Line::compared(
            "Fig. 3c",
            "photons for d = 1 at 37 degC, V = 0.5",
            (">= 1e6", 1e6),
            (format!("{photons:.2e}"), photons),
            (0.3, true),
            "the paper's d0 is printed with one digit; by the nearest distance, a reading chosen after the fact: 1.87e6 by the \
             local one, 3.8e10 by S29 as printed",
        ));
        lines.push(Line::new(
            "Fig. 3c",
            "states on the map that no number of photons tells",
            "diverges at V = 1, T = T0",
            format!("{endless} of {}", map.photons.len()),
            if endless == 1 { Verdict::Reproduced } else { Verdict::NotReproduced },
            "the equilibrium singularity, and no other state",
        ));
        lines.push(Line::new(
            "Fig. 3c",
            "photons for d = 1 elsewhere on the map",
            "only drawn",
            format!("{least:.1e} to {most:.1e}"),
            Verdict::NoValuePrinted,
            "temperatures within 32 K of the surroundings, V from 0 to 1",
        ));
    }
    let caption = "Photons required over temperature and lighting";
    Ok((bundle, lines, Figures { pictures: vec![("required_photons.png", caption)], text: String::new() }))
}
