//! Band integrals of the continuous spectrum to a stated tolerance.
//!
//! Each band is cut at the kinks of the spectra in play (rows of tables, rows of filter curves); on each
//! piece the integrands are smooth, so an n-point Gauss–Legendre rule converges geometrically. A piece
//! is halved until, for every integrand, one rule over it and two rules over its halves agree to the
//! tolerance times the integral over the band. The two halves are what is kept, so the error left is
//! about 4⁻ⁿ of the accepted difference.

use super::bands::{Bands, edges, transmittance};
use crate::error::{Error, Result, check};

/// Default relative tolerance of band integrals.
pub const INTEGRATION_TOLERANCE: f64 = 1e-9;
/// Points of the Gauss–Legendre rule.
const POINTS: usize = 5;
/// Halvings after which a piece is given up.
const MAX_HALVINGS: usize = 40;

/// A piece of a band: band index, edges in cm⁻¹, and its integrals if the parent knows them.
struct Piece {
    band: usize,
    low: f64,
    high: f64,
}

impl Bands {
    /// The same bands with nodes and weights that integrate the continuous spectra over each band.
    ///
    /// `kinks_cm1` are wavenumbers where an integrand is not smooth; `integrands` evaluates all spectra
    /// that must be integrated at the wavenumbers it is given (cm⁻¹), one vector per spectrum.
    ///
    /// # Errors
    /// A tolerance outside (0, 1), an error of `integrands`, or a piece that does not converge.
    pub fn integrated(
        &self,
        kinks_cm1: &[f64],
        tolerance: f64,
        integrands: impl Fn(&[f64]) -> Result<Vec<Vec<f64>>>,
    ) -> Result<Self> {
        check::positive("tolerance of the band integrals", tolerance, "")?;
        let rule = legendre_rule()?;
        let mut pending = Vec::new();
        for (band, (outline, shape)) in self.bands.iter().zip(&self.shapes).enumerate() {
            for pair in edges(outline, shape, kinks_cm1).windows(2) {
                pending.push(Piece { band, low: pair[0], high: pair[1] });
            }
        }
        let scale = self.band_scales(&pending, &rule, &integrands)?;
        let mut accepted: Vec<Piece> = Vec::new();
        for _ in 0..MAX_HALVINGS {
            if pending.is_empty() {
                return Ok(self.with_pieces(accepted, &rule));
            }
            let halves: Vec<Piece> = pending.iter().flat_map(Piece::halves).collect();
            let whole = self.integrals(&pending, &rule, &integrands)?;
            let parts = self.integrals(&halves, &rule, &integrands)?;
            let mut refined = Vec::new();
            for (i, (piece, pair)) in pending.iter().zip(halves.chunks(2)).enumerate() {
                let converged = scale.iter().zip(whole.iter().zip(&parts)).all(|(scale, (whole, parts))| {
                    let difference = (parts[2 * i] + parts[2 * i + 1] - whole[i]).abs();
                    difference <= tolerance * scale[piece.band]
                });
                let target = if converged { &mut accepted } else { &mut refined };
                target.extend(pair.iter().map(|half| Piece { ..*half }));
            }
            pending = refined;
        }
        Err(Error::out_of_range(
            "tolerance of the band integrals",
            tolerance,
            "",
            "larger; it was not reached",
        ))
    }

    /// Σ|integral| over the pieces of each band, per integrand: what the tolerance is relative to.
    fn band_scales(
        &self,
        pieces: &[Piece],
        rule: &[(f64, f64)],
        integrands: &impl Fn(&[f64]) -> Result<Vec<Vec<f64>>>,
    ) -> Result<Vec<Vec<f64>>> {
        let integrals = self.integrals(pieces, rule, integrands)?;
        Ok(integrals
            .iter()
            .map(|values| {
                let mut scale = vec![0.0; self.len()];
                for (piece, value) in pieces.iter().zip(values) {
                    scale[piece.band] += value.abs();
                }
                scale
            })
            .collect())
    }

    fn integrals(
        &self,
        pieces: &[Piece],
        rule: &[(f64, f64)],
        integrands: &impl Fn(&[f64]) -> Result<Vec<Vec<f64>>>,
    ) -> Result<Vec<Vec<f64>>> {
        let (nodes, weights) = self.place(pieces, rule);
        let values = integrands(&nodes)?;
        Ok(values
            .iter()
            .map(|values| {
                values
                    .chunks(POINTS)
                    .zip(weights.chunks(POINTS))
                    .map(|(f, w)| crate::sum::dot(f, w))
                    .collect()
            })
            .collect())
    }

    fn place(&self, pieces: &[Piece], rule: &[(f64, f64)]) -> (Vec<f64>, Vec<f64>) {
        let placed = pieces.iter().flat_map(|piece| {
            let (center, half) = (0.5 * (piece.low + piece.high), 0.5 * (piece.high - piece.low));
            rule.iter().map(move |&(x, w)| {
                let node = x.mul_add(half, center);
                (node, w * half * transmittance(&self.shapes[piece.band], node))
            })
        });
        placed.unzip()
    }

    fn with_pieces(&self, mut pieces: Vec<Piece>, rule: &[(f64, f64)]) -> Self {
        pieces.sort_by(|a, b| a.band.cmp(&b.band).then(a.low.total_cmp(&b.low)));
        let (nodes_cm1, weights_cm1) = self.place(&pieces, rule);
        let first_node =
            (0..=self.len()).map(|band| POINTS * pieces.partition_point(|piece| piece.band < band)).collect();
        Self { bands: self.bands.clone(), shapes: self.shapes.clone(), nodes_cm1, weights_cm1, first_node }
    }
}

impl Piece {
    fn halves(&self) -> [Self; 2] {
        let middle = 0.5 * (self.low + self.high);
        [Self { high: middle, ..*self }, Self { low: middle, ..*self }]
    }
}

fn legendre_rule() -> Result<Vec<(f64, f64)>> {
    let rule = bilby::GaussLegendre::new(POINTS)
        .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))?;
    Ok(rule.nodes().iter().copied().zip(rule.weights().iter().copied()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(center: f64, width: f64) -> impl Fn(&[f64]) -> Result<Vec<Vec<f64>>> {
        move |nodes| Ok(vec![nodes.iter().map(|x| 1.0 / (1.0 + ((x - center) / width).powi(2))).collect()])
    }

    #[test]
    fn a_sharp_line_integrates_to_its_arctangent() {
        let bands = Bands::from_rows([(900.0, 100.0)]).unwrap();
        for width in [50.0, 1.0, 1e-3] {
            let fine = bands.integrated(&[], 1e-10, line(903.0, width)).unwrap();
            let value = fine.weigh(&line(903.0, width)(fine.nodes_cm1()).unwrap()[0])[0];
            let exact = width * ((47.0 / width).atan() + (53.0 / width).atan());
            assert!((value / exact - 1.0).abs() < 1e-9, "{width}: {value} {exact}");
        }
    }

    #[test]
    fn a_kink_given_as_such_costs_nothing() {
        let bands = Bands::from_rows([(900.0, 100.0)]).unwrap();
        let tent = |nodes: &[f64]| Ok(vec![nodes.iter().map(|x| (x - 913.0_f64).abs()).collect()]);
        let fine = bands.integrated(&[913.0], 1e-12, tent).unwrap();
        assert_eq!(fine.nodes_cm1().len(), 4 * POINTS);
        let value = fine.weigh(&tent(fine.nodes_cm1()).unwrap()[0])[0];
        let exact = 0.5 * (63.0_f64.powi(2) + 37.0_f64.powi(2));
        assert!((value / exact - 1.0).abs() < 1e-13);
    }
}
