//! The paper's human-robot numbers beside ours: makes `reports/human_vs_robot`.
//!
//! `cargo run --release --example compare_with_paper -- reports/human_vs_robot` sizes the camera of
//! `examples/human_vs_robot.toml` through the library and writes the plots, the tables, the scenario and a
//! comparison with what Bao et al., Nature 619, 743 (2023), print.

use hadar::material::Library;
use hadar::report::bundle::Bundle;
use hadar::report::sizing;
use hadar::report::table::Table;
use hadar::scenario::Scenario;
use hadar::study::{Sizing, Study};
use std::path::{Path, PathBuf};

/// One line of the comparison: what, as printed, ours by the three readings or alone, and what to make of it.
struct Line {
    quantity: &'static str,
    paper: &'static str,
    ours: [String; 3],
    verdict: &'static str,
}

fn lines(result: &Sizing) -> Option<Vec<Line>> {
    let pair = result.pairs.iter().find(|pair| pair.alternative == result.limiting)?;
    let camera = result.camera.as_ref()?;
    let reference = camera.camera.figures().ok()?;
    let (n, h) = (result.requirement.photons_by, result.requirement.hardware_by_m2_s);
    let state = &pair.nearest_state;
    let short =
        |value: Option<f64>, digits: usize| value.map_or("-".into(), |value| format!("{value:.digits$e}"));
    let alone = |text: String| [text, "-".into(), "-".into()];
    let robot = format!("{:.2} degC, {:.3}", state.temperature_k - 273.15, state.lighting.first()?);
    Some(vec![
        Line {
            quantity: "semantic distance d0, skin to aluminium",
            paper: "about 0.001",
            ours: [pair.distance_nearest, pair.distance_local, pair.distance_local_unknown_gain]
                .map(|d| format!("{d:.2e}")),
            verdict: "reproduced by the nearest distance; S29 as printed gives 200 times less",
        },
        Line {
            quantity: "photons for d = 1",
            paper: ">= 1e6",
            ours: [short(n.nearest, 2), short(n.local, 2), short(n.local_unknown_gain, 1)],
            verdict: "reproduced by the nearest distance",
        },
        Line {
            quantity: "t A_p/((1+gamma) F^2) for d = 1 [m^2 s]",
            paper: ">= 5e-16",
            ours: [short(h.nearest, 1), short(h.local, 1), short(h.local_unknown_gain, 1)],
            verdict: "reproduced by the nearest distance",
        },
        Line {
            quantity: "nearest robot (temperature, lighting)",
            paper: "83.46 degC, 0.17",
            ours: alone(robot),
            verdict: "ours is by shot noise; with the same noise in every band (unweighted fit, or this camera's own noise) it is 83.55 degC, 0.167, which is the paper's",
        },
        Line {
            quantity: "FLIR A325sc: photons of a 30 degC blackbody in one frame",
            paper: "2.51e9 (implied)",
            ours: alone(format!("{:.3e}", reference.photons)),
            verdict: "reproduced",
        },
        Line {
            quantity: "FLIR A325sc: noise of a band reading [counts]",
            paper: "1.77e6",
            ours: alone(format!("{:.2e}", reference.noise_counts)),
            verdict: "reproduced",
        },
        Line {
            quantity: "FLIR A325sc: gamma of a band, 536 bands",
            paper: "6.68e5",
            ours: alone(format!("{:.2e}", reference.gamma_per_band)),
            verdict: "reproduced within 2 %",
        },
        Line {
            quantity: "FLIR A325sc: t A_p/((1+gamma) F^2) in one frame [m^2 s]",
            paper: "8.16e-18",
            ours: alone(format!("{:.2e}", reference.hardware_m2_s)),
            verdict: "not reproduced: the paper's own inputs give ours",
        },
        Line {
            quantity: "FLIR A325sc: least semantic distance in one frame",
            paper: "0.0078",
            ours: alone(format!("{:.4}", camera.least_distance)),
            verdict: "follows from the line above; ours is for the photons of this scene",
        },
    ])
}

fn comparison(lines: &[Line]) -> hadar::Result<(String, String)> {
    let mut table = Table::new([
        "quantity",
        "paper",
        "nearest_distance",
        "local_raw_counts",
        "local_unknown_gain",
        "verdict",
    ]);
    let mut markdown = String::from(
        "# Can a camera tell a person from a robot?\n\n\
         Made by `cargo run --release --example compare_with_paper -- reports/human_vs_robot` from `scenario.toml`.\n\
         Paper: Bao et al., Nature 619, 743 (2023), doi:10.1038/s41586-023-06174-6.\n\n\
         | quantity | paper | nearest distance | local, raw counts (S27) | local, unknown gain (S29) | verdict |\n\
         |---|---|---|---|---|---|\n",
    );
    for line in lines {
        let mut row = vec![line.quantity.to_owned(), line.paper.to_owned()];
        row.extend(line.ours.iter().cloned());
        row.push(line.verdict.to_owned());
        markdown.push_str(&format!("| {} |\n", row.join(" | ")));
        table.push(row);
    }
    for (name, alt) in [
        ("identifiability.png", "Information against photons"),
        ("incident_spectra.png", "The two nearly identical spectra"),
        ("required_photons.png", "Photons required over temperature and lighting"),
        ("emissivities.png", "Emissivities"),
    ] {
        markdown.push_str(&format!("\n![{alt}]({name})\n"));
    }
    Ok((markdown, table.to_csv()?))
}

fn run(out: &Path) -> hadar::Result<()> {
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/human_vs_robot.toml");
    let study = Study::new(&Scenario::from_file(&scenario)?, &Library::embedded()?)?;
    let result = study.size()?;
    let mut bundle: Bundle = sizing::bundle(&study, &result, out)?;
    let (markdown, csv) = comparison(&lines(&result).unwrap_or_default())?;
    bundle.add("README.md", markdown);
    bundle.add("comparison.csv", csv);
    bundle.write(out)?;
    println!("{}\nwrote {}", result.verdict.sentence, out.display());
    Ok(())
}

fn main() -> std::process::ExitCode {
    let out =
        std::env::args().nth(1).map_or_else(|| PathBuf::from("target/compare_with_paper"), PathBuf::from);
    match run(&out) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            std::process::ExitCode::FAILURE
        }
    }
}
