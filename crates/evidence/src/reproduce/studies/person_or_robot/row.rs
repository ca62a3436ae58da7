//! What came of one question of the study.

use hadar_study::ClassAnswer;

/// A camera whose figures are the paper's, and one that counts every photon.
pub(super) const CAMERAS: [&str; 2] = ["flir-a325sc", "ideal-pnrd"];

/// What came of one question.
pub(super) struct Row {
    pub(super) what: String,
    /// Per √photon; nothing is nearer than the second.
    pub(super) distance: f64,
    pub(super) lower: f64,
    pub(super) photons: Option<f64>,
    /// Statistical distance that each camera surely reaches.
    pub(super) reached: Vec<f64>,
    /// Where there are classes, by photons and before each camera.
    pub(super) classes: Vec<ClassAnswer>,
}

impl Row {
    /// The question for a reader, who does not know the library's names.
    pub(super) fn in_words(&self) -> String {
        let spectra = self.classes.first().map(|answer| [answer.target.spectra, answer.alternative.spectra]);
        let [own, other] = spectra.unwrap_or([1, 1]);
        let word = |name: &str| {
            match name {
                "skin" => "skin (0.95 in all bands)",
                "human" => "skin (authors' spectrum)",
                "al" => "aluminium (authors' spectrum)",
                "painted-robot" => "painted robot",
                "metal-robot" => "metal robot",
                name => name,
            }
            .to_owned()
        };
        let side = |name: &str, spectra: usize| match spectra {
            1 => word(name),
            _ => format!("{}, {spectra} spectra", word(name)),
        };
        let (question, mixed) = match self.what.split_once(", mixed") {
            Some((question, _)) => (question, " and their mixtures"),
            None => (self.what.as_str(), ""),
        };
        match question.split_once(" against ") {
            Some((target, alternative)) => {
                format!("{} against {}{mixed}", side(target, own), side(alternative, other))
            }
            None => self.what.clone(),
        }
    }
}
