//! The ledger: what the paper says, what comes out here, and why they differ where they do.

use hadar_report::table::{self, Table};

/// Whether a value of the paper comes out again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Verdict {
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
    /// Nothing of the kind is in the paper: a check of our own.
    NotInThePaper,
    /// Too few experiments to say.
    TooFewToSay,
}

impl Verdict {
    /// In words.
    #[must_use]
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::UnderAChoice => "reproduced under a stated choice",
            Self::NotReproduced => "not reproduced",
            Self::PaperInError => "error in the paper",
            Self::NoValuePrinted => "no value printed",
            Self::NotInThePaper => "not in the paper",
            Self::TooFewToSay => "too few experiments to say",
        }
    }
}

/// One value.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub(crate) struct Line {
    /// Figure, table or section of the paper.
    pub place: &'static str,
    /// Name of the quantity, with its unit.
    pub quantity: String,
    /// As the paper prints it.
    pub paper: String,
    /// As it comes out here.
    pub ours: String,
    /// Relative difference up to which they count as the same, where numbers were compared.
    pub tolerance: Option<f64>,
    /// Whether the paper's value and ours agree.
    pub verdict: Verdict,
    /// Why, or under which choice.
    pub why: String,
}

impl Line {
    /// A line whose verdict is that of two numbers, the paper's and ours: the same within `tolerance`, relative;
    /// `under_a_choice` says that ours rests on one that the paper does not state.
    pub(super) fn compared(
        place: &'static str,
        quantity: impl Into<String>,
        (paper, paper_value): (&str, f64),
        (ours, our_value): (impl Into<String>, f64),
        (tolerance, under_a_choice): (f64, bool),
        why: impl Into<String>,
    ) -> Self {
        let verdict = match (our_value / paper_value - 1.0).abs() <= tolerance {
            true if under_a_choice => Verdict::UnderAChoice,
            true => Verdict::Reproduced,
            false => Verdict::NotReproduced,
        };
        Self { tolerance: Some(tolerance), ..Self::new(place, quantity, paper, ours, verdict, why) }
    }

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
        Self { place, quantity, paper, ours, tolerance: None, verdict, why: why.into() }
    }

    fn cells(&self) -> [String; 7] {
        let [place, verdict] = [self.place, self.verdict.words()].map(str::to_owned);
        let tolerance = self.tolerance.map_or_else(String::new, |t| format!("{} %", 100.0 * t));
        let (quantity, paper, ours) = (self.quantity.clone(), self.paper.clone(), self.ours.clone());
        [place, quantity, paper, ours, tolerance, verdict, self.why.clone()]
    }
}

/// The ledger as CSV.
#[must_use]
pub(crate) fn table(lines: &[Line]) -> Table {
    let mut table = Table::new(["place", "quantity", "paper", "ours", "tolerance", "verdict", "why"]);
    lines.iter().for_each(|line| table.push(line.cells().to_vec()));
    table
}

/// The ledger in Markdown.
#[must_use]
pub(crate) fn markdown(lines: &[Line]) -> String {
    let head = ["place", "quantity", "paper", "ours", "tolerance", "verdict", "why"];
    table::markdown(&head, lines.iter().map(Line::cells))
}
