//! Studies of this project that are no figures of the paper: each gives the report in the folder of its name.

mod air_ranging;
mod decompose_limits;
mod emissivity_from_data;
mod exact_probability;
mod ftir_calibration;
mod library_figures;
mod page;
mod paper_scene;
mod person_or_robot;
mod priors;
mod stripes;

use super::order::{Order, Progress};
use hadar::error::Result;
use hadar::material::Library;
use hadar_report::bundle::Bundle;

/// What is studied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FurtherStudy {
    /// What a test achieves, beside what the distances promise.
    ExactProbability,
    /// What priors on the target's state do.
    Priors,
    /// How often the local distance misleads in a whole library.
    LibraryFigures,
    /// How near a decomposed heat cube comes to its limits.
    DecomposeLimits,
    /// A person against a robot, of several spectra each.
    PersonOrRobot,
    /// How well a distance can be read from the air on the path.
    AirRanging,
    /// What can be told of temperature and emissivity without a library.
    EmissivityFromData,
    /// Blackbodies before a spectrometer.
    FtirCalibration,
    /// What stripes of a cube cost.
    Stripes,
}

impl FurtherStudy {
    /// All of them, the quickest first.
    pub(crate) const ALL: [Self; 9] = [
        Self::FtirCalibration,
        Self::PersonOrRobot,
        Self::Stripes,
        Self::DecomposeLimits,
        Self::Priors,
        Self::AirRanging,
        Self::ExactProbability,
        Self::LibraryFigures,
        Self::EmissivityFromData,
    ];

    /// The name on the command line.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::ExactProbability => "exact-probability",
            Self::Priors => "priors",
            Self::LibraryFigures => "library-figures",
            Self::DecomposeLimits => "decompose-limits",
            Self::PersonOrRobot => "person-or-robot",
            Self::AirRanging => "air-ranging",
            Self::EmissivityFromData => "emissivity-from-data",
            Self::FtirCalibration => "ftir-calibration",
            Self::Stripes => "stripes",
        }
    }

    /// Its folder.
    #[must_use]
    pub(crate) fn folder(self) -> String {
        self.name().replace('-', "_")
    }

    /// What it shows.
    #[must_use]
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::ExactProbability => "What a test achieves, beside what the distances promise",
            Self::Priors => "What priors do",
            Self::LibraryFigures => "How often the local distance misleads in a whole library",
            Self::AirRanging => "How well a distance can be read from the air on the path",
            Self::DecomposeLimits => "How near a decomposed heat cube comes to what the photons allow",
            Self::PersonOrRobot => "Person or robot, with classes on both sides",
            Self::EmissivityFromData => "Temperature and emissivity without a library",
            Self::FtirCalibration => "Calibration of a spectrometer by blackbodies",
            Self::Stripes => "What stripes cost, and what destriping gives back",
        }
    }

    /// What has to be given with --library, where the built-in materials are not what is studied.
    #[must_use]
    pub(crate) const fn own_library(self) -> Option<&'static str> {
        match self {
            Self::LibraryFigures => Some(
                "takes all pairs of a library that is not part of this program; give it with --library FILE; for the committed report it is the \
                 table `emiLib_synthetic` of github.com/FanglinBao/HADAR as a CSV file",
            ),
            Self::EmissivityFromData => Some(
                "takes measured spectra that are not part of this program; give them with --library FOLDER; for the committed report they are files of \
                 the ECOSTRESS spectral library, speclib.jpl.nasa.gov",
            ),
            Self::PersonOrRobot => Some(
                "takes measured spectra that are not part of this program; give them with --library, twice: the folder of the ECOSTRESS spectral \
                 library, and the table `emiLib_synthetic` of github.com/FanglinBao/HADAR as a CSV file",
            ),
            _ => None,
        }
    }

    /// The study of a name.
    #[must_use]
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|study| study.name() == name)
    }

    /// Makes its files from the materials of a library, and says what came out.
    ///
    /// # Errors
    /// A library that lacks a material of the study; a figure that cannot be drawn.
    pub(crate) fn make(
        self,
        order: Order,
        library: &Library,
        progress: Progress<'_>,
    ) -> Result<(Bundle, String)> {
        let (bundle, finding) = match self {
            Self::ExactProbability => exact_probability::make(order, library, progress),
            Self::Priors => priors::make(order, library, progress),
            Self::LibraryFigures => library_figures::make(order, library, progress),
            Self::DecomposeLimits => decompose_limits::make(order, library, progress),
            Self::PersonOrRobot => person_or_robot::make(order, library, progress),
            Self::AirRanging => air_ranging::make(order, library, progress),
            Self::EmissivityFromData => emissivity_from_data::make(order, library, progress),
            Self::FtirCalibration => ftir_calibration::make(order, library, progress),
            Self::Stripes => stripes::make(order, library, progress),
        }?;
        Ok((bundle.titled(self.title()), finding))
    }
}
