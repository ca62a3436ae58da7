//! What the tests of `hadar` have: the program run in a folder of its own, and a page of HTML read.

// Not all of it is used here.
#[allow(dead_code)]
#[path = "../../../cli/tests/it/support/folder.rs"]
pub(crate) mod folder;
#[allow(dead_code)]
#[path = "../../../cli/tests/it/support/page.rs"]
pub(crate) mod page;
