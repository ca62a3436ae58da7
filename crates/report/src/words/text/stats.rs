//! The ledger of what a question took, as aligned lines.

use super::columns::aligned;
use hadar::demand::{Line, Work};
use hadar::words::whole;

/// What there could have been, what was computed, what was spared and why.
#[must_use]
pub fn stats(work: &Work) -> String {
    let head = ["work", "possible", "computed", "spared", ""].map(str::to_owned);
    let rows = work.lines().map(|(thing, line)| {
        let [possible, computed, spared] = [line.possible(), line.computed(), line.spared()].map(whole);
        [thing.words().to_owned(), possible, computed, spared, why(line)]
    });
    let mut out = aligned(&std::iter::once(head).chain(rows).collect::<Vec<_>>(), &[1, 2, 3]);
    if !work.spares_anything() {
        out.push_str(
            "nothing could be spared: all of it was asked for, and no proof made any of it needless\n",
        );
    }
    out
}

fn why(line: &Line) -> String {
    let reasons = line.reasons().map(|(reason, count)| format!("{} {}", whole(count), reason.words()));
    reasons.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::demand::{Reason, Thing};

    #[test]
    fn the_ledger_is_aligned() {
        let mut booked = Work::default();
        booked.compute(Thing::LibrarySpectra, 68);
        assert!(stats(&booked).contains("nothing could be spared"), "{}", stats(&booked));
        booked.compute(Thing::Windows, 1200);
        booked.spare(Thing::Windows, Reason::ProvedAbove, 34_000);
        booked.spare(Thing::Windows, Reason::ProvedBelow, 7);
        let expected = [
            "work                    possible  computed  spared",
            "spectra of the library        68        68       0",
            "windows                   35 207     1 200  34 007  34 000 proved to reach the demand, 7 proved not to reach it",
            "",
        ];
        assert_eq!(stats(&booked), expected.join("\n"));
    }
}
