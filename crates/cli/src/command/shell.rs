//! `hadar completions` and `hadar man`: what a shell and a manual have to know of the command line, made from it.

use super::global::{Global, put};
use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;
use hadar::error::{Error, Result};
use hadar_report::bundle::Bundle;
use hadar_report::manifest::VERSION;
use std::io;
use std::path::Path;
use std::process::ExitCode;

/// In bash, flags are offered from `-` on alone: where files may stand, they would be in the place of their names.
const NO_FLAGS_UNASKED: &str = r#"
_hadar_words() {
    _hadar "$@"
    [[ ${COMP_WORDS[COMP_CWORD]} == -* ]] && return 0
    local word words=()
    for word in "${COMPREPLY[@]}"; do
        [[ ${word} == -* ]] || words+=("${word}")
    done
    COMPREPLY=("${words[@]}")
}
complete -F _hadar_words -o nosort -o bashdefault -o default hadar 2>/dev/null ||
    complete -F _hadar_words -o bashdefault -o default hadar
"#;

#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

#[derive(Debug, Args)]
pub(super) struct ManArgs {}

pub(super) fn completions(args: &CompletionsArgs, mut line: Command) -> Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut line, "hadar", &mut script);
    if args.shell == Shell::Bash {
        script.extend_from_slice(NO_FLAGS_UNASKED.as_bytes());
    }
    put(String::from_utf8_lossy(&script).trim_end())?;
    Ok(ExitCode::SUCCESS)
}

/// The page of the program, or with a folder one for each command.
pub(super) fn man(mut line: Command, global: &Global) -> Result<ExitCode> {
    // Commands get their full names.
    line.build();
    let Some(out) = &global.out else {
        let page = page(&line).map_err(failed)?;
        put(String::from_utf8_lossy(&page).trim_end())?;
        return Ok(ExitCode::SUCCESS);
    };
    let mut bundle = Bundle::default();
    add(&line, &mut bundle).map_err(failed)?;
    global.write(&bundle, out, None)?;
    Ok(ExitCode::SUCCESS)
}

fn add(command: &Command, bundle: &mut Bundle) -> io::Result<()> {
    bundle.add(format!("{}.1", name(command)), page(command)?);
    let shown = |child: &&Command| child.get_name() != "help" && !child.is_hide_set();
    command.get_subcommands().filter(shown).try_for_each(|child| add(child, bundle))
}

fn page(command: &Command) -> io::Result<Vec<u8>> {
    let mut page = Vec::new();
    Man::new(command.clone()).source(format!("hadar {VERSION}")).render(&mut page)?;
    Ok(page)
}

/// As a manual calls it: `hadar-calibrate-noise`.
fn name(command: &Command) -> String {
    command.get_display_name().unwrap_or_else(|| command.get_name()).to_owned()
}

fn failed(error: io::Error) -> Error {
    Error::file("write the manual", Path::new("stdout"), error)
}
