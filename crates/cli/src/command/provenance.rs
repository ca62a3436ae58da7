//! Which program this is, what it was told, and what it has read.

use hadar::error::Result;
use hadar::inputs;
use hadar_report::manifest::Provenance;
use hadar_report::rule::AS_READ;

/// Commit of the program's source, from its build.
pub(super) const COMMIT: &str = env!("HADAR_COMMIT");

/// Options that change no answer: where it is put, how it is printed, by how many threads, processes and runs it is found.
const SILENT: [&str; 6] = ["--json", "--stats", "--quiet", "-q", "--force", "--merge"];
const SILENT_WITH_VALUE: [&str; 7] =
    ["--out", "--threads", "--shard", "--recompute", "--inputs", "--time-limit", "--memory-limit"];

/// Names that most reports take. All of them are known only when the work is done, and are looked at then.
pub(super) const USUAL_NAMES: [&str; 8] = [
    "answer.txt",
    "report.html",
    "scenario.toml",
    "rule.toml",
    AS_READ,
    "pairs.csv",
    "warnings.csv",
    "README.md",
];

/// That of this process, with what it has read so far, without the words that are of other scenarios.
pub(super) fn of_this_run(seed: u64, of_others: &[String]) -> Result<Provenance> {
    let typed = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    let typed = typed.filter(|word| !of_others.contains(word));
    Provenance::of(COMMIT, command(typed), seed, &inputs::so_far())
}

fn command(typed: impl Iterator<Item = String>) -> Vec<String> {
    let (mut command, mut value) = (vec!["hadar".to_owned()], false);
    for word in typed {
        let (option, joined) =
            word.split_once('=').map_or((word.as_str(), false), |(option, _)| (option, true));
        let with_value = SILENT_WITH_VALUE.contains(&option);
        if value {
            value = false;
        } else if with_value {
            value = !joined;
        } else if joined || !SILENT.contains(&option) {
            command.push(word);
        }
    }
    command
}

#[cfg(test)]
mod tests {
    use super::command;

    #[test]
    fn a_command_is_what_its_answer_depends_on() {
        let typed =
            "--threads 2 size a.toml -q --out=o --by local --json --out x --seed 3 --threads=4 --force";
        let kept = command(typed.split(' ').map(str::to_owned)).join(" ");
        assert_eq!(kept, "hadar size a.toml --by local --seed 3");
    }
}
