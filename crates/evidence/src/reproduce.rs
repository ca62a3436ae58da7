//! The paper's figures and tables made again from the product's own code, with a ledger of what agrees.
//!
//! Paper: Bao et al., 'Heat-assisted detection and ranging', Nature 619, 743 (2023), doi:10.1038/s41586-023-06174-6, with
//! its Supplementary Information. Every item gives the files of its figure (tables, plots, the scenario it rests on) and
//! lines of the ledger: what, the paper's value, ours, a verdict, and why.
//!
//! [`Effort::Quick`] makes fewer of the experiments of a figure, each of them the same to the last bit as in the full
//! form, so that a quick run can be held against committed files.
//!
//! [`FurtherStudy`] are questions of this project beyond the paper's figures: no part of `all`, no lines of the ledger.

mod candidates;
mod coverage;
mod edfig1;
mod edfig5;
mod edfig6;
mod edfig7;
mod edfig8;
mod edfig9;
mod edfig9a;
mod fig3b;
mod fig3c;
mod fig4;
mod figs17;
mod figs19;
mod figs20;
mod figs29;
mod inverse_trade_off;
mod ledger;
mod locking;
mod night;
mod order;
mod pixels;
mod policy;
mod scene;
mod studies;
mod tabs2;
mod tabs5;
mod texture;
mod textured;

pub(crate) use ledger::{Line, Verdict, markdown, table};
pub(crate) use order::{Effort, Order, Progress};
pub(crate) use studies::FurtherStudy;

use hadar::error::{Error, Result};
use hadar_report::bundle::Bundle;
use order::Figures;

/// What can be made again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Item {
    /// Classifiers against the limit over photons, 536 bands.
    Fig3b,
    /// The same in three bands, and with a detector's noise.
    FigS7,
    /// Photons required over temperature and lighting.
    Fig3c,
    /// Five materials.
    EdFig6,
    /// A person before a car, and a robot.
    EdFig7,
    /// Segmentation by materials.
    EdFig8,
    /// Texture of the sky's light.
    EdFig1,
    /// Textures: standard deviation and information.
    EdFig5,
    /// Thermometry.
    EdFig9,
    /// Letters that a thermal imager does not see.
    EdFig9a,
    /// Ranging: bounds by signal, and matching beside them.
    Fig4,
    /// Measures of texture.
    FigS12,
    /// Loss over the size of the library.
    FigS17,
    /// Ranging on textures.
    FigS19,
    /// Methods of decomposition.
    FigS20,
    /// Calibration of the response.
    FigS29,
    /// Detectors.
    TabS2,
    /// What resolution is worth in ranging.
    TabS5,
    /// The policy numbers.
    Policy,
}

/// What came of an item.
#[derive(Debug, Clone)]
pub(crate) struct Reproduction {
    /// Its files.
    pub bundle: Bundle,
    /// Its lines of the ledger.
    pub lines: Vec<Line>,
}

impl Item {
    /// All of them, the quickest first.
    pub(crate) const ALL: [Self; 19] = [
        Self::TabS2,
        Self::TabS5,
        Self::Policy,
        Self::Fig3c,
        Self::EdFig9a,
        Self::FigS17,
        Self::FigS20,
        Self::EdFig7,
        Self::EdFig8,
        Self::FigS29,
        Self::FigS12,
        Self::EdFig1,
        Self::EdFig5,
        Self::FigS19,
        Self::Fig4,
        Self::EdFig6,
        Self::EdFig9,
        Self::FigS7,
        Self::Fig3b,
    ];

    /// The name on the command line, and of its folder.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Fig3b => "fig3b",
            Self::FigS7 => "figs7",
            Self::Fig3c => "fig3c",
            Self::EdFig1 => "edfig1",
            Self::EdFig5 => "edfig5",
            Self::EdFig6 => "edfig6",
            Self::EdFig7 => "edfig7",
            Self::EdFig8 => "edfig8",
            Self::EdFig9 => "edfig9",
            Self::EdFig9a => "edfig9a",
            Self::Fig4 => "fig4",
            Self::FigS12 => "figs12",
            Self::FigS17 => "figs17",
            Self::FigS19 => "figs19",
            Self::FigS20 => "figs20",
            Self::FigS29 => "figs29",
            Self::TabS5 => "tabs5",
            Self::TabS2 => "tabs2",
            Self::Policy => "policy",
        }
    }

    /// What it shows.
    #[must_use]
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Fig3b => "Fig. 3b: classifiers against the shot-noise limit, 536 bands",
            Self::FigS7 => "Fig. S7: the same in three bands, and with a detector's noise",
            Self::Fig3c => "Fig. 3c: photons required over temperature and lighting",
            Self::EdFig1 => "Extended Data Fig. 1b: texture of the sky's light",
            Self::EdFig5 => "Extended Data Fig. 5: textures by standard deviation and by information",
            Self::EdFig6 => "Extended Data Fig. 6: five materials",
            Self::EdFig7 => "Extended Data Fig. 7: a person before a car, and a robot",
            Self::EdFig8 => "Extended Data Fig. 8: segmentation by materials",
            Self::EdFig9 => "Extended Data Fig. 9f: thermometry against its bound",
            Self::EdFig9a => "Extended Data Fig. 9a-d: letters that a thermal imager does not see",
            Self::Fig4 => "Fig. 4: ranging by a thermal image, a heat cube and scattered light",
            Self::FigS12 => "Fig. S12: measures of texture",
            Self::FigS17 => "Fig. S17: what more materials in the library explain",
            Self::FigS19 => "Fig. S19 and Table I: ranging on decomposed texture",
            Self::FigS20 => "Fig. S20: scattered light separated, or not",
            Self::FigS29 => "Fig. S29: the camera's response from blackbodies, and what they determine",
            Self::TabS5 => "Tables S4 and S5: what resolution is worth",
            Self::TabS2 => "Table S2: detectors",
            Self::Policy => "Policy: can a camera distinguish a person from a robot?",
        }
    }

    /// The item of a name.
    ///
    /// # Errors
    /// An unknown name; the message lists those there are.
    pub(crate) fn from_name(name: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|item| item.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            let studies = FurtherStudy::ALL.map(FurtherStudy::name).join(", ");
            Error::malformed(
                format!("unknown figure or table `{name}`"),
                format!("choose among {names}, all; or the further studies {studies}"),
            )
        })
    }

    /// Makes it; its scenario is written for a folder `out`.
    ///
    /// # Errors
    /// A figure that cannot be drawn.
    pub(crate) fn make(self, order: Order, progress: Progress<'_>) -> Result<Reproduction> {
        let (mut bundle, lines, figures) = match self {
            Self::Fig3b => fig3b::all_bands(order, progress)?,
            Self::FigS7 => fig3b::three_bands(order, progress)?,
            Self::Fig3c => fig3c::make()?,
            Self::EdFig1 => edfig1::make(order)?,
            Self::EdFig5 => edfig5::make(order)?,
            Self::EdFig6 => edfig6::make(order, progress)?,
            Self::EdFig7 => edfig7::make(order)?,
            Self::EdFig8 => edfig8::make(order, progress)?,
            Self::EdFig9 => edfig9::make(order, progress)?,
            Self::EdFig9a => edfig9a::make(order)?,
            Self::Fig4 => fig4::make(order, progress)?,
            Self::FigS12 => fig4::textures(order)?,
            Self::FigS17 => figs17::make(order)?,
            Self::FigS19 => figs19::make(order)?,
            Self::FigS20 => figs20::make(order)?,
            Self::FigS29 => figs29::make(order)?,
            Self::TabS5 => tabs5::make()?,
            Self::TabS2 => tabs2::make()?,
            Self::Policy => policy::make()?,
        };
        bundle.add_table("ledger.csv", table(&lines))?;
        bundle.add("README.md", page(self, order.effort, &lines, &figures));
        Ok(Reproduction { bundle: bundle.titled(self.title()), lines })
    }
}

fn page(item: Item, effort: Effort, lines: &[Line], figures: &Figures) -> String {
    let name = item.name();
    let made = match effort {
        Effort::Full => format!("Made by `hadar reproduce {name}`"),
        Effort::Quick => format!("Some of the experiments only, made by `hadar reproduce {name} --quick`"),
    };
    let mut page = format!(
        "# {}\n\n{made} from {}.\n\
         Paper: Bao et al., Nature 619, 743 (2023), doi:10.1038/s41586-023-06174-6.\n\n{}",
        item.title(),
        match item {
            Item::FigS17 | Item::FigS20 | Item::EdFig9a => "pixels that it draws",
            Item::FigS29 => "readings that it draws",
            _ => "the scenarios beside it",
        },
        markdown(lines)
    );
    for (file, caption) in &figures.pictures {
        page.push_str(&format!("\n![{caption}]({file})\n"));
    }
    if !figures.text.is_empty() {
        page.push_str(&format!("\n{}", figures.text));
    }
    page
}
