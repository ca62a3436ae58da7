//! What one case finds: comparisons with the reference, and what is wrong.

/// One scene near equilibrium: what its distance keeps of its digits.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Point {
    /// Number of the case in its family.
    pub case: u64,
    /// Relative difference of the temperatures of target and surroundings, |T − T₀|/T₀.
    pub apart: f64,
    /// 1 − V: the part of the hemisphere that is dark.
    pub unlit: f64,
    /// Digits kept by the differences that the crate forms.
    pub digits: f64,
    /// Digits kept by B(T) − V·B(T₀) in doubles.
    pub digits_naive: f64,
    /// Digits that the solver itself claims.
    pub digits_claimed: f64,
}

/// What cases of one kind stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Photon radiance, its slope, its logarithmic slope, its differences.
    Planck,
    /// Local distance per √photon over all ranges.
    Local,
    /// Local distance with electronic noise.
    Noise,
    /// Local distance where target and surroundings are nearly in equilibrium.
    Equilibrium,
    /// Local distance where nuisances are nearly, or quite, dependent.
    Dependence,
    /// Local distance in a hundred to a hundred thousand bands.
    ManyBands,
    /// Distances of materials against each other.
    Matrix,
    /// Nearest distance.
    Nearest,
    /// Nearest distance in hard scenes, and back to the target's material.
    ThereAndBack,
    /// Probabilities from distances, and back.
    Detection,
    /// Exact error of the best test on few counts.
    Exact,
    /// Photons, exposure, lens and noise solved for, and put back.
    Requirement,
}

impl Family {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 12] = [
        Self::Planck,
        Self::Local,
        Self::Noise,
        Self::Equilibrium,
        Self::Dependence,
        Self::ManyBands,
        Self::Matrix,
        Self::Nearest,
        Self::ThereAndBack,
        Self::Detection,
        Self::Exact,
        Self::Requirement,
    ];

    /// What it stresses, in a line.
    #[must_use]
    pub const fn stresses(self) -> &'static str {
        match self {
            Self::Planck => {
                "B, slope and differences: T 1 to 1e5 K, 1e-3 to 1e5 cm^-1, differences to the last bit"
            }
            Self::Local => {
                "local distance: 0 to 8 objects, V and e from 0 to 1, materials equal to the last bits"
            }
            Self::Noise => {
                "local distance with noise: 1 to 1e30 photons, noise over photons 0 to 1e30, priors"
            }
            Self::Equilibrium => "local distance near equilibrium: T - T0 from 1000 K to the last bit and 0",
            Self::Dependence => "local distance with nuisances that are nearly or quite the same",
            Self::ManyBands => "local distance in 100 to 100 000 bands",
            Self::Matrix => "distances of materials against each other",
            Self::Nearest => "nearest distance against the valley it stands in",
            Self::ThereAndBack => "nearest distance in hard scenes, its proof and its brackets, and back",
            Self::Detection => "probabilities and information for distances 0 to 38, and back",
            Self::Exact => "exact error of the best test on few counts against the sum over all of them",
            Self::Requirement => "exposure, pixel, lens, noise, frames and photons solved for and put back",
        }
    }

    /// The family of a case: fixed shares of every ten thousand.
    #[must_use]
    pub const fn of(case: u64) -> Self {
        // The rare and costly ones are spread evenly.
        if case % 200 == 77 {
            return Self::ManyBands;
        }
        if case % 200 == 177 {
            return Self::ThereAndBack;
        }
        match case % 50 {
            0..=13 => Self::Planck,
            14..=22 => Self::Local,
            23..=29 => Self::Noise,
            30..=35 => Self::Equilibrium,
            36..=41 => Self::Dependence,
            42 => Self::Matrix,
            43 => {
                if case % 100 < 50 {
                    Self::Nearest
                } else {
                    Self::Requirement
                }
            }
            44 => Self::Exact,
            _ => Self::Detection,
        }
    }
}

/// What a case has found.
#[derive(Debug, Default)]
pub(super) struct Findings {
    /// True relative error, and the bound that was given for it.
    pub(super) checks: Vec<(f64, f64)>,
    /// What is wrong.
    pub(super) faults: Vec<String>,
    pub(super) points: Vec<Point>,
}

impl Findings {
    /// Compares a true relative error with the bound that was given for it.
    pub(super) fn check(&mut self, what: &str, error: f64, bound: f64) {
        self.checks.push((error, bound));
        if error.is_nan() || bound.is_nan() || error > bound {
            self.faults.push(format!("{what}: relative error {error:.2e} where {bound:.2e} was said"));
        }
    }

    /// Notes a fault unless something holds.
    pub(super) fn require(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            self.faults.push(what());
        }
    }
}
