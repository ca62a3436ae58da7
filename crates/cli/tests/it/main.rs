//! Tests of the command `hadar`, and what several packages do together.

mod air_ranging;
mod anywhere;
mod arrows;
mod asked;
mod calibrate;
mod calibrate_blackbodies;
mod cameras;
mod certificate;
mod classes;
mod cli;
mod cli_mistakes;
mod companion;
mod cube_judges;
mod cube_shares;
mod cube_surroundings;
mod cubes;
mod cut_bands;
mod decompose;
mod decompose_by_rows;
mod decompose_image;
mod demand;
mod diff;
mod evidence;
mod explain;
mod extremes;
mod fuzz;
mod house;
mod identify;
mod identify_libraries;
mod identify_mistakes;
mod identify_sections;
mod identify_words;
mod large_cubes;
mod laws;
mod library;
mod messages;
mod nearest;
mod own_cameras;
mod packs;
mod papers;
mod range;
mod range_bad;
mod remarks;
mod render;
mod rests_on;
mod robust;
mod rule;
mod rule_clauses;
mod rule_evidence;
mod rule_mistakes;
mod rule_uncertainty;
mod safety;
mod safety_of_cameras;
mod safety_of_pairs;
mod segmentation;
mod serve;
mod shell;
mod simulate;
mod spectra;
mod stand_in;
mod stopped;
mod sweep;
mod vectors;
mod verify;
mod vocabulary;
mod written;

mod support {
    pub(crate) mod answers;
    pub(crate) mod documented;
    pub(crate) mod folder;
    #[path = "../../../../study/tests/it/support/mutation.rs"]
    pub(crate) mod mutation;
    pub(crate) mod page;
    pub(crate) mod rules;
    pub(crate) mod sound;
    pub(crate) mod uses;
}

/// The program that is tested.
const PROGRAM: &str = env!("CARGO_BIN_EXE_hadar");
