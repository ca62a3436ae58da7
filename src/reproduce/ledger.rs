//! The ledger: what the paper says, what comes out here, and why they differ where they do.

use crate::report::table::Table;

/// Whether a value of the paper comes out again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It does.
    Reproduced,
    /// Under a choice that the paper does not state.
    UnderAChoice,
    /// It does not.
    NotReproduced,
    /// The paper is in error.
    PaperInError,
    /// The paper prints no value.
    NoValuePrinted,
}

impl Verdict {
    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::UnderAChoice => "reproduced under a stated choice",
            Self::NotReproduced => "not reproduced",
            Self::PaperInError => "error in the paper",
            Self::NoValuePrinted => "no value printed",
        }
    }
}

/// One value.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Line {
    /// Figure, table or section of the paper.
    pub place: &'static str,
    /// What, with its unit.
    pub quantity: String,
    /// As the paper prints it.
    pub paper: String,
    /// As it comes out here.
    pub ours: String,
    /// Whether they agree.
    pub verdict: Verdict,
    /// Why, or under which choice.
    pub why: String,
}

impl Line {
    /// A line.
    pub(super) fn new(
        place: &'static str,
        quantity: impl Into<String>,
        paper: impl Into<String>,
        ours: impl Into<String>,
        verdict: Verdict,
        why: impl Into<String>,
    ) -> Self {
        let (quantity, paper, ours) = (quantity.into(), paper.into(), ours.into());
        Self { place, quantity, paper, ours, verdict, why: why.into() }
    }

    fn cells(&self) -> [String; 6] {
        let [place, verdict] = [self.place, self.verdict.words()].map(str::to_owned);
        [place, self.quantity.clone(), self.paper.clone(), self.ours.clone(), verdict, self.why.clone()]
    }
}

/// The ledger as CSV.
#[must_use]
pub fn table(lines: &[Line]) -> Table {
    let mut table = Table::new(["place", "quantity", "paper", "ours", "verdict", "why"]);
    lines.iter().for_each(|line| table.push(line.cells().to_vec()));
    table
}

/// The ledger in Markdown.
#[must_use]
pub fn markdown(lines: &[Line]) -> String {
    let mut text =
        String::from("| place | quantity | paper | ours | verdict | why |\n|---|---|---|---|---|---|\n");
    for line in lines {
        let cells = line.cells().map(|cell| cell.replace('|', "\\|"));
        text.push_str(&format!("| {} |\n", cells.join(" | ")));
    }
    text
}
