//! Classifiers by name, trained ones as data that a file can hold.

use super::network::{Network, NetworkOptions, Settings};
use super::{Classifier, Discriminant, Judge, Logistic, SHRINKAGES};
use crate::spectra::LabelledSpectra;
use hadar::error::{Error, Result};

hadar::named! {
    /// Ways to decide which class a spectrum is from.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Method {
        /// The likelihood ratio of known states: the optimum.
        LikelihoodRatio = "likelihood-ratio",
        /// The likelihood ratio of best fits: materials known, states not.
        BestFits = "best-fits",
        /// Linear discriminant, trained.
        Discriminant = "discriminant",
        /// Logistic regression, trained.
        Logistic = "logistic",
        /// The paper's small convolutional network, trained.
        Network = "network",
    }
    /// The name on the command line.
    name
}

impl Method {
    /// What it is called in a figure.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::LikelihoodRatio => "likelihood ratio, states known",
            Self::BestFits => "best fits, states unknown",
            Self::Discriminant => "linear discriminant",
            Self::Logistic => "logistic regression",
            Self::Network => "convolutional network",
        }
    }

    /// Whether it learns from spectra instead of knowing the physics.
    #[must_use]
    pub const fn is_trained(self) -> bool {
        !matches!(self, Self::LikelihoodRatio | Self::BestFits)
    }

    /// The method of a name.
    ///
    /// # Errors
    /// An unknown name; the message lists those there are.
    ///
    /// ```
    /// use hadar_simulate::classifier::Method;
    /// assert_eq!(Method::from_name("best-fits")?, Method::BestFits);
    /// assert!(Method::from_name("oracle").is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn from_name(name: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            Error::malformed(format!("unknown classifier `{name}`"), format!("choose among {names}"))
        })
    }

    /// Trains it; `None` for those that need no training. `seed` is that of everything random in it.
    ///
    /// # Errors
    /// Parts that do not belong together or lack a class.
    pub fn train(
        self,
        training: &LabelledSpectra,
        validation: &LabelledSpectra,
        seed: u64,
    ) -> Result<Option<Trained>> {
        Ok(match self {
            Self::LikelihoodRatio | Self::BestFits => None,
            Self::Discriminant => {
                Some(Trained::Discriminant(Discriminant::train(training, validation, &SHRINKAGES)?))
            }
            Self::Logistic => Some(Trained::Logistic(Logistic::train(training, validation)?)),
            Self::Network => {
                let options =
                    NetworkOptions::new(Settings { seed, ..Settings::for_bands(training.bands()) })?;
                Some(Trained::Network(Box::new(Network::train(training, validation, &options, &|_, _| {})?)))
            }
        })
    }
}

/// A trained classifier.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Trained {
    /// Linear discriminant.
    Discriminant(Discriminant),
    /// Logistic regression.
    Logistic(Logistic),
    /// Convolutional network.
    Network(Box<Network>),
}

impl Trained {
    /// Which method it is.
    #[must_use]
    pub const fn method(&self) -> Method {
        match self {
            Self::Discriminant(_) => Method::Discriminant,
            Self::Logistic(_) => Method::Logistic,
            Self::Network(_) => Method::Network,
        }
    }

    fn inner(&self) -> &dyn Classifier {
        match self {
            Self::Discriminant(trained) => trained,
            Self::Logistic(trained) => trained,
            Self::Network(trained) => trained.as_ref(),
        }
    }

    /// How training went, in a few words.
    #[must_use]
    pub fn training(&self) -> String {
        match self {
            Self::Discriminant(trained) => format!("shrinkage {}", trained.shrinkage()),
            Self::Logistic(trained) => format!("{} steps", trained.steps()),
            Self::Network(trained) => {
                let outcome = trained.outcome();
                format!("{} weights, epoch {} of {}", outcome.weights, outcome.best_epoch, outcome.epochs)
            }
        }
    }
}

impl Classifier for Trained {
    fn name(&self) -> &'static str {
        self.inner().name()
    }

    fn classes(&self) -> usize {
        self.inner().classes()
    }

    fn bands(&self) -> usize {
        self.inner().bands()
    }

    fn judge(&self) -> Box<dyn Judge + '_> {
        self.inner().judge()
    }
}

/// Version of the format of saved models.
const FORMAT: u32 = 1;
/// Relative difference of wavenumbers that are taken for the same.
const SAME_BAND: f64 = 1e-9;

/// A trained classifier with all it takes to use it again.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct SavedModel {
    /// Version of the format of the file, a whole number.
    #[serde(rename = "schema", alias = "format")]
    format: u32,
    /// Version of the program that trained it.
    hadar: String,
    /// Centres of its bands, cm⁻¹.
    pub wavenumber_cm1: Vec<f64>,
    /// Names of the classes, in the order of the scores.
    pub classes: Vec<String>,
    /// Photons of the first class in all bands, with which it was trained.
    pub photons: f64,
    /// Seed of its training spectra.
    pub seed: u64,
    /// Generator that the seed belongs to.
    pub generator: String,
    /// The trained classifier, with all its coefficients.
    pub model: Trained,
}

impl SavedModel {
    /// A model for bands with these centres (cm⁻¹) and classes of these names.
    ///
    /// # Errors
    /// Another number of bands or classes than the model's.
    pub fn new(
        model: Trained,
        wavenumber_cm1: Vec<f64>,
        classes: Vec<String>,
        photons: f64,
        seed: u64,
    ) -> Result<Self> {
        let generator = crate::draws::GENERATOR.to_owned();
        let hadar = env!("CARGO_PKG_VERSION").to_owned();
        Self { format: FORMAT, hadar, wavenumber_cm1, classes, photons, seed, generator, model }.checked()
    }

    /// The text of a file.
    ///
    /// # Errors
    /// A number that cannot be written, which no trained model has.
    pub fn to_json(&self) -> Result<String> {
        serde_json::to_string(self)
            .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))
    }

    /// From the text of a file.
    ///
    /// # Errors
    /// What no saved model holds.
    pub fn from_json(text: &str) -> Result<Self> {
        let saved: Self = serde_json::from_str(text).map_err(|error| {
            Error::malformed(format!("no saved model: {error}"), "give a file that --save-models wrote")
        })?;
        saved.checked()
    }

    fn checked(self) -> Result<Self> {
        if self.format != FORMAT {
            let found = format!("a saved model of format {}, which this version cannot read", self.format);
            return Err(Error::malformed(found, "train it again with --save-models"));
        }
        hadar::error::check::positive("photons of the saved model", self.photons, "")?;
        for &centre in &self.wavenumber_cm1 {
            hadar::error::check::positive("band centre of the saved model", centre, "cm^-1")?;
        }
        for (what, found, expected) in [
            ("bands of the saved model", self.wavenumber_cm1.len(), self.model.bands()),
            ("classes of the saved model", self.classes.len(), self.model.classes()),
        ] {
            if found != expected {
                return Err(Error::Length { what: what.into(), found, expected });
            }
        }
        Ok(self)
    }

    /// Makes sure that it was trained for these bands (cm⁻¹) and classes.
    ///
    /// # Errors
    /// Other bands or classes; the message says which.
    pub fn check_fits(&self, wavenumber_cm1: &[f64], classes: &[String]) -> Result<()> {
        let instead = "use a model trained for this scenario, or train one with --save-models";
        let own = &self.wavenumber_cm1;
        let same = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME_BAND * b.abs();
        if own.len() != wavenumber_cm1.len() || !own.iter().zip(wavenumber_cm1).all(same) {
            let range = |centres: &[f64]| match (centres.first(), centres.last()) {
                (Some(first), Some(last)) => format!("{} bands from {first} to {last} cm^-1", centres.len()),
                _ => "no bands".to_owned(),
            };
            let found = format!("the saved model has {}, the scenario {}", range(own), range(wavenumber_cm1));
            return Err(Error::malformed(found, instead));
        }
        if self.classes != classes {
            let (own, theirs) = (self.classes.join(", "), classes.join(", "));
            let found = format!("the saved model tells apart {own}; the scenario has {theirs}");
            return Err(Error::malformed(found, instead));
        }
        Ok(())
    }
}
