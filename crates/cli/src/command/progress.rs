//! A progress bar on stderr, for people at a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal as _;
use std::sync::Once;

/// A bar that appears with the first step, when it is known of how many.
#[derive(Debug)]
pub struct Bar {
    bar: ProgressBar,
    appears: Once,
    hidden: bool,
}

impl Bar {
    pub(super) fn new(what: &'static str, quiet: bool) -> Self {
        let hidden = quiet || !std::io::stderr().is_terminal();
        let bar = ProgressBar::hidden();
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}, {eta} left") {
            bar.set_style(style);
        }
        bar.set_message(what);
        Self { bar, appears: Once::new(), hidden }
    }

    /// So many of so many are done.
    pub fn set(&self, done: usize, total: usize) {
        self.bar.set_length(total as u64);
        if !self.hidden && total > 0 {
            self.appears.call_once(|| self.bar.set_draw_target(ProgressDrawTarget::stderr()));
        }
        self.bar.set_position(done as u64);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
