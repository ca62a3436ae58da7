//! What a page of a report says of itself and of its parts, in HTML where that is marked.

/// The title of a page about a scenario that has none.
pub(crate) const TITLE: &str = "What a thermal camera can see";
/// The heading of what stands before everything else.
pub(crate) const FIRST: &str = "On one page";
/// What the file with the question is good for.
pub(crate) const ASKED_AGAIN: &str = "All of it, with what was left to the program filled in. Given to the program again, it gives this report again.";
/// The caption of the inputs.
pub(crate) const INPUTS: &str = "All that was read";
/// In the place of the hash of a stream.
pub(crate) const READ_ONCE: &str = "can be read only once";
/// What stands before the remedy of a warning.
pub(crate) const REMEDY: &str = "What to do:";
/// About the files beside the page, in HTML.
pub(crate) const WRITTEN: &str = "The files that were written with this one are listed in <code>hadar.json</code>, with their hashes. It bears no date: the \
                                  same program, command and inputs make the same bytes.";

/// The caption of a figure, in HTML.
pub(crate) fn figure(number: usize, name: &str) -> String {
    format!("Figure {number}. Its numbers are in <code>{name}.csv</code>.")
}

/// Instead of a table of many columns, in HTML.
pub(crate) fn too_wide(name: &str, columns: usize) -> String {
    format!("<code>{name}</code> has {columns} columns, too many for a page.")
}

/// Which rows of a table are shown, the first of all; nothing where all are.
pub(crate) fn shown(first: usize, rows: usize) -> String {
    if rows > first { format!(": the first {first} of {rows} rows") } else { String::new() }
}
