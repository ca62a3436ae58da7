//! What the bands tell of one pair: derivatives of the counts, their variance, and what must be known.
//!
//! Counts N_w of band w change by ∂_iN_w with nuisance i and by ∂_gN_w with the mixing fraction g of the
//! alternative, and have the variance N_w + σ²_w, of which N_w and the noise of other light come with the photons: the statistical distance is d = ½ min_c ‖∂_gN − Σcᵢ∂ᵢN‖ in the
//! inner product with weights 1/(N + σ²) (see [`crate::fisher`]).

use crate::error::{Error, Result, check};
use crate::fisher::{Counting, Unknowns};
use crate::scene::{Jacobian, Parameter, State, Surroundings};
use crate::spectrum::Bands;

/// Derivatives and noise of the counts of one pair of materials, band by band.
#[derive(Debug, Clone, PartialEq)]
pub struct Scores {
    /// ∂N/∂θ of every nuisance and, last, of the mixing fraction g; counts per unit of θ.
    pub(super) columns: Vec<Vec<f64>>,
    /// Variance of what comes with photons, N and the noise of other light, counts²: adds up over the bands of a filter.
    pub(super) var_photons: Vec<f64>,
    /// σ², counts², of one reading: once for a filter.
    pub(super) var_reading: Vec<f64>,
    /// (column, deviation σ_p) of every prior.
    pub(super) priors: Vec<(usize, f64)>,
    /// Factor by which rounding errors of the last column exceed a few ulp.
    pub(super) cancellation: f64,
    /// The distance that is asked of this pair.
    pub(super) required: f64,
}

impl Scores {
    /// Scores of a target against one alternative at the target's own state.
    ///
    /// With `counting` the distances are those of the camera, priors included; without, they are per √photon of
    /// the whole spectrum in the limit of shot noise, where priors count for nothing. All added noise is taken for that of a
    /// reading: see [`Scores::with_photon_noise`].
    ///
    /// # Errors
    /// A scene without photons.
    pub fn of(
        bands: &Bands,
        surroundings: &Surroundings,
        unknowns: &Unknowns,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: Option<&Counting>,
    ) -> Result<Self> {
        let mut parameters = unknowns.parameters(surroundings.objects().len());
        parameters.push(Parameter::Material);
        let mut jacobian = Jacobian::new(bands, surroundings);
        let total_known = unknowns.known_lighting_total().is_some();
        jacobian.evaluate(emissivity, alternative, state, &parameters, total_known);
        let total = crate::sum::sum(jacobian.signal());
        check::positive("photon radiance of the target", total, "photons s^-1 m^-2 sr^-1")?;
        let scale = counting.map_or(1.0 / total, |counting| counting.counts_per_radiance);
        let scaled = |values: &[f64]| values.iter().map(|value| scale * value).collect::<Vec<f64>>();
        let priors = match counting {
            None => Vec::new(),
            Some(_) => parameters
                .iter()
                .enumerate()
                .filter_map(|(i, parameter)| unknowns.sigma_prior(*parameter).map(|sigma| (i, sigma)))
                .collect(),
        };
        Ok(Self {
            columns: (0..parameters.len()).map(|i| scaled(jacobian.column(i))).collect(),
            var_photons: scaled(jacobian.signal()),
            var_reading: (0..bands.len()).map(|w| counting.map_or(0.0, |c| c.var_added(w))).collect(),
            priors,
            cancellation: jacobian.cancellation(),
            required: 1.0,
        })
    }

    /// Scores from numbers: the derivatives of the counts with respect to every nuisance, the difference that is to
    /// be seen (∂N/∂g, or the difference of two spectra of counts), the counts N and the variances σ² of a reading
    /// (see [`Scores::with_photon_noise`] for what is not of a reading).
    ///
    /// # Errors
    /// Lists of different length, no bands, or a number that is not finite or (counts, variances) below 0.
    pub fn from_columns(
        nuisances: Vec<Vec<f64>>,
        difference: Vec<f64>,
        counts: Vec<f64>,
        var_added: Vec<f64>,
    ) -> Result<Self> {
        if counts.is_empty() {
            return Err(Error::malformed("there are no bands", "give at least one"));
        }
        let columns: Vec<Vec<f64>> = nuisances.into_iter().chain([difference]).collect();
        for column in columns.iter().chain([&var_added]) {
            same_length("numbers per band", column.len(), counts.len())?;
        }
        for value in columns.iter().flatten() {
            check::finite("derivative of the counts", *value, "")?;
        }
        for value in counts.iter().chain(&var_added) {
            check::non_negative("variance of the counts", *value, "")?;
        }
        Ok(Self {
            columns,
            var_photons: counts,
            var_reading: var_added,
            priors: Vec::new(),
            cancellation: 1.0,
            required: 1.0,
        })
    }

    /// The same where this part of the variance σ² of each band, counts², comes with photons, as the noise of other light
    /// does: it adds up over the bands of a filter, and is not of a reading.
    ///
    /// # Errors
    /// A list of another length, or a variance below 0 or above σ² by more than rounding.
    pub fn with_photon_noise(mut self, var: &[f64]) -> Result<Self> {
        same_length("variances of other light", var.len(), self.bands())?;
        for (w, &var) in var.iter().enumerate() {
            let whole = self.var_reading[w];
            let most = whole * (1.0 + 8.0 * f64::EPSILON);
            if !(0.0..=most).contains(&var) {
                let expected = format!("from 0 to the variance of the band, {whole}");
                return Err(Error::out_of_range("variance of other light", var, "counts^2", expected));
            }
            self.var_photons[w] += var;
            // What summing in another order leaves is no noise of a reading.
            let rest = whole - var;
            self.var_reading[w] = if rest > 8.0 * f64::EPSILON * whole { rest } else { 0.0 };
        }
        Ok(self)
    }

    /// The same with Gaussian priors on nuisances, each by its place among the columns and its deviation in the unit of that
    /// column's parameter.
    ///
    /// # Errors
    /// A column that is not a nuisance, or a deviation that is not positive.
    pub fn with_priors(mut self, priors: impl IntoIterator<Item = (usize, f64)>) -> Result<Self> {
        for (column, sigma) in priors {
            if column + 1 >= self.columns.len() {
                let expected = format!("below the number of nuisances, {}", self.columns.len() - 1);
                return Err(Error::out_of_range("column of a prior", column as f64, "", expected));
            }
            self.priors.push((column, check::positive("deviation of a prior", sigma, "")?));
        }
        Ok(self)
    }

    /// The same pair, of which this distance is required: choices among many pairs then maximise the smallest
    /// ratio of distance to requirement. Required is 1 where nothing is said.
    ///
    /// # Errors
    /// A distance that is not above 0.
    pub fn required(mut self, distance: f64) -> Result<Self> {
        self.required = check::positive("required distance", distance, "")?;
        Ok(self)
    }

    /// Number of bands.
    #[must_use]
    pub fn bands(&self) -> usize {
        self.var_photons.len()
    }
}

pub(super) fn same_length(what: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected { Ok(()) } else { Err(Error::Length { what: what.to_owned(), found, expected }) }
}
