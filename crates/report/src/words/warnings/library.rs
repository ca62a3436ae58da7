//! Materials and classes: what was left out or replaced, and what their entries say.

use super::block::words;

words! {
    Library {
        meaning: "A file of a folder of spectra was passed over, or a material or class was replaced by one \
            of the files.",
        remedy: "Correct or remove the file; --strict makes it an error.",
        Library { remark } => remark,
    }
    Material {
        meaning: "The file or library entry of a material has a remark that its users must know.",
        remedy: "Read the entry; use another spectrum if it does not fit your surface.",
        Material { material, remark } => format!("{material}: {remark}"),
    }
    TargetAmongAlternatives {
        meaning: "The target's own material was named among the alternatives, from which it cannot be distinguished.",
        remedy: "Nothing; or leave it out of alternatives.materials.",
        TargetAmongAlternatives { target } => {
            format!("{target} is left out of the alternatives: it is the target")
        },
    }
    MaterialSkipped {
        meaning: "An alternative was left out since its spectrum does not cover the bands.",
        remedy: "Choose bands that its spectrum covers, or alternatives.extrapolate = \"hold\".",
        MaterialSkipped { material } => {
            format!("{material} is left out: its spectrum does not cover the bands")
        },
    }
    ClassReplacesPlaceholder {
        meaning: "A class of the scenario has the name of a material of the library that is entered as one \
            number, and replaces it.",
        remedy: "Nothing; or rename the class.",
        ClassReplacesPlaceholder { class } => format!(
            "`{class}` is the class of this scenario, not the material of the library that is entered as one number"
        ),
    }
    SolvedForOnePair {
        meaning: "Figures of the camera, elasticities and pictures are those of the pair of members that is \
            hardest to distinguish for the camera as it is.",
        remedy: "Ask again with the figure that was solved for: the verdict then covers all pairs.",
        SolvedForOnePair { target, alternative } => format!(
            "what each figure may be is solved for {target} against {alternative}, the hardest pair for the camera as it is; for \
             another camera another pair of members may be harder"
        ),
    }
    WorstMembers {
        meaning: "Of classes only the pair of members that is hardest to distinguish is simulated.",
        remedy: "Name other members to simulate them.",
        WorstMembers { target, alternative } => format!(
            "classes are represented by the pair of members that is hardest to distinguish, {target} and {alternative}; the others are not \
             drawn"
        ),
    }
}
