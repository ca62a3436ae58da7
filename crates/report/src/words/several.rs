//! Several scenarios asked the same, in words.

/// A verdict that hangs on something, which the answer itself says.
pub(crate) const YES_IF: &str = "yes, if";

/// A verdict that what is known does not settle.
pub(crate) const UNDECIDED: &str = "undecided";

/// The verdict of a rule that does not hold on the day.
pub(crate) const NOT_IN_FORCE: &str = "no, not in force";

/// The best camera of a rule.
pub(crate) fn of_best(rule: &str, camera: &str) -> String {
    format!("{rule}, {camera}")
}

/// What the 'yes' of a scenario rests on, by all of its codes.
pub(crate) fn only_if(scenario: &str, codes: &str) -> String {
    format!("{scenario}: yes only if {codes}")
}

/// Below a table in which some rows have no answer.
pub(crate) fn unanswered(failed: usize, all: usize) -> String {
    format!("{failed} of {all} scenarios without an answer.")
}

/// A verdict on a camera by a rule that does not hold on the day.
pub(crate) const BESIDES: &str = "as if in force: yes";

/// The same where it hangs on something.
pub(crate) const BESIDES_IF: &str = "as if in force: yes, if";

/// The title of rules side by side.
pub(crate) const SIDE_BY_SIDE: &str = "Rules side by side";

/// Below that title.
pub(crate) const LEAST_OR_SPOILED: &str =
    "The least margin of all clauses and scenes; a camera whose image is spoiled fails whatever its margin.";

/// What a marked name of them means.
pub(crate) const NOT_ALL: &str = "not every rule is met";

/// Below their table.
pub(crate) const IN_BRACKETS: &str = "  in brackets: least margin, above 1 where the demand is met, or what spoils the image, and the clause of it; - : the rule does not name the camera\n";

/// Which cameras meet all rules.
pub(crate) fn before_all(
    meet: &[&str],
    conditional: bool,
    cameras: usize,
    laws: usize,
    asked: usize,
) -> String {
    let of = if laws == asked {
        format!("all {laws} rules")
    } else {
        format!("all {laws} of {asked} rules that have an answer")
    };
    let on = if conditional { ", under conditions" } else { "" };
    match meet {
        [] => format!("None of {cameras} cameras meets {of}.\n\n"),
        [one] => format!("{one} alone of {cameras} cameras meets {of}{on}.\n\n"),
        some => format!("{} of {cameras} cameras meet {of}{on}: {}.\n\n", some.len(), some.join(", ")),
    }
}

/// That one name stands for several cameras.
pub(crate) const NOT_THE_SAME: &str = "  cameras of one name but different figures are listed apart, with their rule in brackets; `--judge` judges one camera by all rules\n";

/// A camera of a name that one of another rule has too.
pub(crate) fn of_rule(camera: &str, law: &str) -> String {
    format!("{camera} (of {law})")
}

/// The scenes that decide by a rule.
pub(crate) fn hardest(law: &str, scenes: &[(&str, &str)]) -> String {
    let lines: Vec<String> = scenes.iter().map(|(camera, scene)| format!("  {camera}: {scene}\n")).collect();
    format!("\nHardest scenes of {law}\n{}", lines.concat())
}
