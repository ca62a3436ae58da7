//! Band integrals of the continuous spectrum to a stated tolerance.
//!
//! A band is cut at the kinks of the spectra in play (rows of tables, rows of filter curves), and into parts of at most 32 cm⁻¹.
//! On each piece the integrands are smooth, so that Gauss–Legendre rules converge geometrically. A piece takes the first rule of 1,
//! 2, 3 and 5 points that agrees for every integrand with the next rule (2, 3, 5 and 8 points); where none does it is halved. A
//! piece wider than 2 cm⁻¹, on which a model may have a line of its own, begins with 3 points. Of a piece of width h in a band of
//! width H the two rules may differ by tolerance × ½(|integral over the piece| + h/H |integral over the band|), so that the differences of
//! a band add up to no more than the tolerance times its integral. Their sum is reported: the error is smaller, since the next rule is
//! closer by orders of magnitude.
//!
//! Rounding makes a floor of 1e-14.

use super::bands::{Band, Bands, Shape, edges, transmittance};
use crate::error::{Error, Result, check};

/// Default relative tolerance of band integrals.
pub const INTEGRATION_TOLERANCE: f64 = 1e-9;
/// Points of the Gauss–Legendre rules, each compared with the next.
const RULES: [usize; 5] = [1, 2, 3, 5, 8];
/// The rule that a wide piece begins with.
const WIDE_RULE: usize = 2;
/// From what width on a piece is wide, and the widest that is not cut, cm⁻¹.
const WIDE_CM1: f64 = 2.0;
const WIDEST_CM1: f64 = 32.0;
/// Halvings after which a piece is given up.
const MAX_HALVINGS: usize = 40;
/// More nodes than this are taken for a slip of the pen.
const MAX_NODES: usize = 10_000_000;
/// Least tolerance, and what is nothing whatever it is relative to.
const ROUNDING: f64 = 1e-14;
const NOTHING: f64 = 1e-280;
/// Pieces whose integrands are evaluated at a time.
const AT_A_TIME: usize = 4096;

/// Bands with nodes that integrate, and how well.
#[derive(Debug, Clone, PartialEq)]
pub struct Integrated {
    /// The bands.
    pub bands: Bands,
    /// Bound on the relative error of any integral over any band.
    pub relative_error: f64,
}

/// A piece of a band: band index, edges in cm⁻¹, which rule is tried, and how often it was halved.
#[derive(Debug, Clone, Copy)]
struct Piece {
    band: usize,
    low: f64,
    high: f64,
    rule: usize,
    halvings: usize,
}

type Rule = Vec<(f64, f64)>;

impl Bands {
    /// The same bands with nodes and weights that integrate the continuous spectra over each band; see [`Bands::integrated_where`].
    ///
    /// # Errors
    /// As [`Bands::integrated_where`].
    pub fn integrated(
        &self,
        kinks_cm1: &[f64],
        tolerance: f64,
        integrands: impl Fn(&[f64]) -> Result<Vec<Vec<f64>>>,
    ) -> Result<Self> {
        self.integrated_where(&vec![true; self.len()], kinks_cm1, tolerance, integrands)
            .map(|found| found.bands)
    }

    /// The same bands, with nodes and weights that integrate the continuous spectra over those that `which` names; the others keep
    /// theirs.
    ///
    /// `kinks_cm1` are wavenumbers where an integrand is not smooth, in any order; `integrands` evaluates all spectra
    /// that must be integrated at the wavenumbers it is given (cm⁻¹), one vector per spectrum.
    ///
    /// # Errors
    /// A tolerance that is not positive, an error of `integrands`, an integral that is no number, a piece that does not converge, or
    /// more than 10⁷ nodes.
    pub fn integrated_where(
        &self,
        which: &[bool],
        kinks_cm1: &[f64],
        tolerance: f64,
        integrands: impl Fn(&[f64]) -> Result<Vec<Vec<f64>>>,
    ) -> Result<Integrated> {
        let tolerance = check::positive("tolerance of the band integrals", tolerance, "")?.max(ROUNDING);
        let rules = RULES.iter().map(|points| legendre_rule(*points)).collect::<Result<Vec<_>>>()?;
        let mut kinks = kinks_cm1.to_vec();
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        let work = Work { bands: self, rules: &rules, tolerance, integrands: &integrands };
        let (mut accepted, mut relative_error, mut points) = (Vec::new(), 0.0, 0);
        let mut pieces: Vec<Piece> = Vec::new();
        for q in 0..self.len() {
            if which.get(q).copied().unwrap_or(false) {
                pieces_of(q, &self.bands[q], &self.shapes[q], &kinks, &mut pieces)?;
            }
            if pieces.len() >= AT_A_TIME || q + 1 == self.len() {
                let before = accepted.len();
                relative_error =
                    work.integrate(std::mem::take(&mut pieces), &mut accepted)?.max(relative_error);
                points += accepted[before..].iter().map(|piece: &Piece| RULES[piece.rule]).sum::<usize>();
                too_many(points)?;
            }
        }
        Ok(Integrated { bands: self.with_pieces(which, accepted, &rules), relative_error })
    }

    fn with_pieces(&self, which: &[bool], mut pieces: Vec<Piece>, rules: &[Rule]) -> Self {
        pieces.sort_by(|a, b| a.band.cmp(&b.band).then(a.low.total_cmp(&b.low)));
        let (mut nodes_cm1, mut weights_cm1, mut first_node) = (Vec::new(), Vec::new(), vec![0]);
        let mut rest = pieces.as_slice();
        for q in 0..self.len() {
            if which.get(q).copied().unwrap_or(false) {
                let (own, later) = rest.split_at(rest.partition_point(|piece| piece.band <= q));
                rest = later;
                for piece in own {
                    piece.place(&self.shapes[q], &rules[piece.rule], &mut nodes_cm1, &mut weights_cm1);
                }
            } else {
                let kept = self.first_node[q]..self.first_node[q + 1];
                nodes_cm1.extend_from_slice(&self.nodes_cm1[kept.clone()]);
                weights_cm1.extend_from_slice(&self.weights_cm1[kept]);
            }
            first_node.push(nodes_cm1.len());
        }
        Self { bands: self.bands.clone(), shapes: self.shapes.clone(), nodes_cm1, weights_cm1, first_node }
    }
}

fn too_many(points: usize) -> Result<()> {
    if points > MAX_NODES {
        let expected = "below 10^7: fewer bands, fewer rows, or a larger tolerance";
        return Err(Error::out_of_range(
            "number of nodes of the band integrals",
            points as f64,
            "",
            expected,
        ));
    }
    Ok(())
}

/// What a group of bands is integrated with.
struct Work<'w, F> {
    bands: &'w Bands,
    rules: &'w [Rule],
    tolerance: f64,
    integrands: &'w F,
}

impl<F: Fn(&[f64]) -> Result<Vec<Vec<f64>>>> Work<'_, F> {
    /// Pieces of whole bands, each with the rule that suffices, and the largest relative error of a band.
    fn integrate(&self, mut pending: Vec<Piece>, accepted: &mut Vec<Piece>) -> Result<f64> {
        crate::stop::check();
        let Some((from, to)) = pending.first().zip(pending.last()).map(|(a, b)| (a.band, b.band + 1)) else {
            return Ok(0.0);
        };
        // |integral| over each band and sum of the differences, integrand by integrand.
        let (mut scale, mut error): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        while !pending.is_empty() {
            let (few, more) = (self.integrals(&pending, 0)?, self.integrals(&pending, 1)?);
            if scale.is_empty() {
                error = vec![vec![0.0; to - from]; more.len()];
                scale.clone_from(&error);
                for (scale, more) in scale.iter_mut().zip(&more) {
                    pending
                        .iter()
                        .zip(more)
                        .for_each(|(piece, value)| scale[piece.band - from] += value.abs());
                }
            }
            let mut refined = Vec::new();
            for (i, piece) in pending.iter().enumerate() {
                let (q, band) = (piece.band - from, &self.bands.bands[piece.band]);
                let share = (piece.high - piece.low) / (band.high_cm1 - band.low_cm1);
                let agrees = (0..more.len()).all(|s| {
                    let allowed = 0.5 * self.tolerance * (more[s][i].abs() + share * scale[s][q]) + NOTHING;
                    (few[s][i] - more[s][i]).abs() <= allowed
                });
                if agrees {
                    error.iter_mut().zip(few.iter().zip(&more)).for_each(|(error, (a, b))| {
                        error[q] += (a[i] - b[i]).abs();
                    });
                    accepted.push(*piece);
                } else if piece.rule + 2 < RULES.len() {
                    refined.push(Piece { rule: piece.rule + 1, ..*piece });
                } else if piece.halvings < MAX_HALVINGS {
                    refined.extend(piece.halves());
                } else {
                    let (quantity, expected) =
                        ("tolerance of the band integrals", "larger; it was not reached");
                    return Err(Error::out_of_range(quantity, self.tolerance, "", expected));
                }
            }
            too_many(refined.len())?;
            pending = refined;
        }
        let each = error.iter().zip(&scale).flat_map(|(error, scale)| error.iter().zip(scale));
        Ok(each.map(|(error, scale)| error / (scale + NOTHING)).fold(0.0, f64::max))
    }

    /// Integrals over the pieces, integrand by integrand, by their rules or the next ones.
    fn integrals(&self, pieces: &[Piece], next: usize) -> Result<Vec<Vec<f64>>> {
        let mut found: Vec<Vec<f64>> = Vec::new();
        for pieces in pieces.chunks(AT_A_TIME) {
            crate::stop::check();
            let (mut nodes, mut weights) = (Vec::new(), Vec::new());
            for piece in pieces {
                let rule = &self.rules[piece.rule + next];
                piece.place(&self.bands.shapes[piece.band], rule, &mut nodes, &mut weights);
            }
            let values = (self.integrands)(&nodes)?;
            found.resize_with(values.len(), Vec::new);
            for (found, values) in found.iter_mut().zip(&values) {
                let mut at = 0;
                for piece in pieces {
                    let own = at..at + RULES[piece.rule + next];
                    at = own.end;
                    let integral = crate::sum::dot(&values[own.clone()], &weights[own]);
                    found.push(check::finite("integral of a spectrum over a band", integral, "")?);
                }
            }
        }
        Ok(found)
    }
}

/// A band cut at its kinks, and where it is wide.
fn pieces_of(
    band: usize,
    outline: &Band,
    shape: &Shape,
    kinks: &[f64],
    pieces: &mut Vec<Piece>,
) -> Result<()> {
    let (low, high) = (outline.low_cm1, outline.high_cm1);
    let inside = kinks.partition_point(|kink| *kink <= low)..kinks.partition_point(|kink| *kink < high);
    for pair in edges(outline, shape, kinks.get(inside).unwrap_or_default()).windows(2) {
        let parts = ((pair[1] - pair[0]) / WIDEST_CM1).ceil().max(1.0);
        let width = (pair[1] - pair[0]) / parts;
        let rule = if width > WIDE_CM1 { WIDE_RULE } else { 0 };
        // A cast saturates.
        let parts = parts as usize;
        too_many(pieces.len().saturating_add(parts))?;
        for i in 0..parts {
            let at = |i: usize| if i == parts { pair[1] } else { (i as f64).mul_add(width, pair[0]) };
            pieces.push(Piece { band, low: at(i), high: at(i + 1), rule, halvings: 0 });
        }
    }
    Ok(())
}

impl Piece {
    fn place(&self, shape: &Shape, rule: &Rule, nodes: &mut Vec<f64>, weights: &mut Vec<f64>) {
        let (center, half) = (0.5 * (self.low + self.high), 0.5 * (self.high - self.low));
        for &(x, w) in rule {
            let node = x.mul_add(half, center);
            nodes.push(node);
            weights.push(w * half * transmittance(shape, node));
        }
    }

    fn halves(&self) -> [Self; 2] {
        let middle = 0.5 * (self.low + self.high);
        let half = Self { rule: WIDE_RULE, halvings: self.halvings + 1, ..*self };
        [Self { high: middle, ..half }, Self { low: middle, ..half }]
    }
}

/// Nodes and weights on [-1, 1].
fn legendre_rule(points: usize) -> Result<Rule> {
    let rule = bilby::GaussLegendre::new(points)
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
            let fine = bands.integrated_where(&[true], &[], 1e-10, line(903.0, width)).unwrap();
            let value = fine.bands.weigh(&line(903.0, width)(fine.bands.nodes_cm1()).unwrap()[0])[0];
            let exact = width * ((47.0 / width).atan() + (53.0 / width).atan());
            assert!((value / exact - 1.0).abs() < 1e-9, "{width}: {value} {exact}");
        }
    }

    #[test]
    fn what_is_no_number_is_refused_at_once() {
        let bands = Bands::from_rows([(900.0, 100.0)]).unwrap();
        for large in [f64::NAN, f64::INFINITY, 1e308] {
            let found = bands.integrated(&[], 1e-9, |nodes| Ok(vec![vec![large; nodes.len()]]));
            assert!(found.unwrap_err().to_string().contains("integral of a spectrum"));
        }
    }

    #[test]
    fn a_kink_given_as_such_costs_nothing() {
        let bands = Bands::from_rows([(900.0, 100.0)]).unwrap();
        let tent = |nodes: &[f64]| Ok(vec![nodes.iter().map(|x| (x - 913.0_f64).abs()).collect()]);
        let fine = bands.integrated(&[913.0], 1e-12, tent).unwrap();
        // Two parts on either side of the kink, of three points each.
        assert_eq!(fine.nodes_cm1().len(), 12);
        let value = fine.weigh(&tent(fine.nodes_cm1()).unwrap()[0])[0];
        let exact = 0.5 * (63.0_f64.powi(2) + 37.0_f64.powi(2));
        assert!((value / exact - 1.0).abs() < 1e-13);
    }

    /// Narrow bands of a spectrum with many rows take a point or two a piece, the others keep their centre.
    #[test]
    fn bands_that_are_not_asked_for_keep_their_node() {
        let bands = Bands::uniform(800.0, 804.0, 1.0).unwrap();
        let bent = |nodes: &[f64]| Ok(vec![nodes.iter().map(|x| 1.0 + (x - 801.2_f64).abs()).collect()]);
        let which = [false, true, true, false, false];
        let found = bands.integrated_where(&which, &[801.2], 1e-9, bent).unwrap();
        assert_eq!(found.bands.nodes_per_band().collect::<Vec<_>>(), [1, 2, 1, 1, 1]);
        let values = found.bands.weigh(&bent(found.bands.nodes_cm1()).unwrap()[0]);
        let exact = [2.2, 1.0 + 0.5 * (0.49 + 0.09), 1.8, 2.8, 3.8];
        for (value, exact) in values.iter().zip(exact) {
            assert!((value - exact).abs() < 1e-12, "{value} {exact}");
        }
        assert!(found.relative_error < 1e-12);
    }

    #[test]
    fn tolerances_below_rounding_are_its_floor() {
        let bands = Bands::from_ranges(&[(700.0, 1300.0)]).unwrap();
        let planck =
            |nodes: &[f64]| Ok(vec![nodes.iter().map(|x| x * x / (x / 200.0_f64).exp_m1()).collect()]);
        let at = |tolerance: f64| bands.integrated(&[], tolerance, planck).unwrap();
        assert_eq!(at(1e-18), at(1e-14));
        assert!(
            bands.integrated(&[], 0.0, planck).is_err() && bands.integrated(&[], f64::NAN, planck).is_err()
        );
    }
}
