//! The report's text.

use super::photons::{Photons, Rows};
use super::ranges::{Ranged, range_cells};
use crate::reproduce::studies::page::markdown;
use hadar::identifiability::detection;

fn photon_cells(rows: &Rows, keep: &[f64]) -> Vec<Vec<String>> {
    let print = |n: Option<f64>| n.map_or_else(|| "infinite".into(), |n| format!("{n:.1e}"));
    rows.iter()
        .filter(|(keys, _)| keep.iter().any(|k| (k - keys[0]).abs() < 1e-6))
        .map(|(keys, photons)| {
            std::iter::once(format!("{}", keys[0])).chain(photons.all().map(print)).collect()
        })
        .collect()
}

/// What a prior does at equilibrium.
pub(super) fn finding(wide: &Rows) -> String {
    let print = |n: Option<f64>| n.map_or_else(|| "infinitely many".into(), |n| format!("{n:.2e}"));
    let line = |(keys, photons): &(Vec<f64>, Photons)| {
        format!(
            "At equilibrium, prior of {} K: between {} and {} photons on average, {} by the hybrid bound",
            keys[0],
            print(photons.average_lower),
            print(photons.average_upper),
            print(photons.bound)
        )
    };
    wide.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// README.md.
pub(super) fn readme(
    one: &Rows,
    half: &Rows,
    wide: &Rows,
    rows: &[Ranged],
    simulated: [f64; 2],
    seed: u64,
) -> String {
    let shown = [10.0, 15.0, 18.0, 20.0, 22.0, 25.0, 37.0, 45.0];
    let header = |first: &'static str| {
        [
            first,
            "no prior, nearest",
            "no prior, local",
            "prior, hybrid bound",
            "prior, average: not enough",
            "prior, average: enough",
        ]
    };
    let simulated = simulated.map(|share| format!("{share:.3}"));
    format!(
        "# What priors do\n\n\
         Skin or aluminium? 536 bands (715 to 1250 cm⁻¹, step 1), surroundings at 20 °C, photon noise only, \
         temperature and lighting V of either unknown. All photon numbers are for {:.1} % correct decisions \
         (statistical distance 1). Where target and surroundings have one temperature and V = 1, every surface \
         sends the same light: no number of photons distinguishes anything. With a prior on the temperature the \
         target is a little off equilibrium nearly always, and the number becomes finite.\n\n\
         Which curve is what:\n\n\
         * **No prior, nearest**: the limit for a target at exactly the temperature of the axis.\n\
         * **No prior, local**: the paper's distance for the same; it can err either way.\n\
         * **Prior, average**: skin and aluminium equally likely, the state of either drawn from its prior, decided by \
         the ratio of the two likelihoods averaged over the priors, the best test there is. Fewer photons than 'not \
         enough' are not enough for any test; 'enough' is enough for that one. Plan with these.\n\
         * **Prior, hybrid bound**: a bound on estimates: no unbiased estimate of a small admixture of \
         aluminium needs fewer photons. It is no bound on decisions between skin and aluminium. Near equilibrium \
         it is far below what decisions need, since it averages the information of rare targets far from equilibrium \
         with that of the others; away from equilibrium it is above it, since it is local.\n\n\
         ## V = 1, priors of 2 K on the temperature and 0.1 on the lighting: photons\n\n{}\n\
         ![Photons against target temperature, V = 1](temperature_v1.png)\n\n\
         ## V = 0.5, the same priors: photons\n\n{}\n\
         ![Photons against target temperature, V = 0.5](temperature_v05.png)\n\n\
         Half of the surroundings are cold sky, so equal temperatures are nothing special, and the photons are finite \
         without a prior. Yet it helps here too, and as much for a target at 37 °C: without a prior the aluminium \
         may be the far hotter one that looks like skin, with it that one is excluded.\n\n\
         Simulated decisions (`hadar simulate --average`) at the photons that are enough, priors about 37 °C: {} right at \
         V = 1 and {} at V = 0.5 (± 0.005; 0.841 wanted, more where 300 photons are the fewest that is asked about).\n\n\
         ## Width of the prior at equilibrium (20 °C, V = 1 and known): photons\n\n{}\n\
         ![Photons against the width of the prior](prior_width.png)\n\n\
         A prior twice as wide needs four times fewer photons (slope −2): at equilibrium it helps that the target \
         is off it, not that its temperature is known. The hybrid bound is far below what decisions need.\n\n\
         ## What the alternative may do\n\n\
         A range of the alternative's state is a prior too. Skin at 37 °C, V = 0.5; T′ and V′ are what the \
         alternative may be. d₀ is the nearest distance per √photon, photons are 1/d₀².\n\n{}\n\
         The aluminium that looks like skin is far hotter than skin: who may exclude that needs hundreds of times \
         fewer photons, and fewer still who may exclude odd lighting. The glass that looks like skin has its \
         temperature: only the lighting helps.\n\n\
         ## How it was made\n\n\
         `hadar reproduce priors --out reports`. `hadar identify --average reports/priors/scenario.toml` \
         gives the figures with priors at 20 °C and V = 1. The priors are Gaussians centred at the nominal \
         state, cut at 0 ≤ V ≤ 1; seed {seed}. All numbers are in the CSV files beside the plots and in `state_ranges.csv`; three digits \
         are given.\n",
        100.0 * detection::probability(1.0),
        markdown(&header("target (°C)"), &photon_cells(one, &shown)),
        markdown(&header("target (°C)"), &photon_cells(half, &shown)),
        simulated[0],
        simulated[1],
        markdown(&header("prior (K)"), &photon_cells(wide, &[0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0])),
        markdown(
            &[
                "T′",
                "V′",
                "aluminium: d₀",
                "photons",
                "nearest state (T′, V′)",
                "window glass: d₀",
                "photons",
                "nearest state (T′, V′)",
            ],
            &range_cells(rows)
        ),
    )
}
