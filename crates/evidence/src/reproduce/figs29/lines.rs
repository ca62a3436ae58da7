//! What the paper says of its calibration, and what comes out.

use super::super::ledger::{Line, Verdict};
use super::designs;
use super::shown::{PIXELS, Shown, TEMPERATURE_ERROR_K};

pub(super) fn all(shown: &Shown) -> Vec<Line> {
    let (exact, uncertain) = (&shown.exact, &shown.uncertain);
    let equations = (shown.twin.temperatures_k.len() - 1) * shown.twin.wheel.filters();
    let best = designs::most(&shown.choices);
    let off: Vec<f64> = (0..30).map(|j| shown.found.values[j] - shown.twin.response[j]).collect();
    let rms = |values: &[f64]| (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt();
    let sigma: Vec<f64> = (0..30).map(|j| shown.found.sigma(j)).collect();
    let typical: Vec<f64> =
        shown.twin.prior.mean().iter().zip(&shown.twin.response).map(|(a, b)| a - b).collect();
    vec![
        Line::new(
            "SIV C",
            "equations of 31 blackbodies and 10 filters, one blackbody the reference",
            "(31 - 1) x 10 = 310",
            equations.to_string(),
            if equations == 310 { Verdict::Reproduced } else { Verdict::PaperInError },
            "30 x 10 is 300; 310 are the readings, the ten of the reference among them",
        ),
        Line::new(
            "SIV C",
            "response values that the readings determine",
            "30, solved by least squares",
            format!("{} of 30 ({} at exact temperatures)", uncertain.number, exact.number),
            if uncertain.number == 30 { Verdict::UnderAChoice } else { Verdict::NotReproduced },
            format!(
                "directions known to a tenth of the peak, means of {PIXELS} pixels of 50 mK, temperatures to {:.0} mK, filters of ours: the rest is \
                 the typical curve and smoothness, which the paper adds too without saying how much",
                1e3 * TEMPERATURE_ERROR_K
            ),
        ),
        Line::new(
            "SIV C",
            "the response comes out with smoothness and the typical curve",
            "a smooth curve near the typical ones",
            format!("rms error {:.3} of the peak (typical curve: {:.3})", rms(&off), rms(&typical)),
            if rms(&off) < rms(&typical) { Verdict::UnderAChoice } else { Verdict::NotReproduced },
            format!("of a twin whose truth is known; its own error bars say {:.3}", rms(&sigma)),
        ),
        Line::new(
            "SIV C",
            "normalisation constant of the response",
            "25010",
            "-",
            Verdict::NotReproduced,
            "counts of one camera with its gain; neither readings nor units are printed",
        ),
        Line::new(
            "not in the paper",
            "values determined by another choice in the same time",
            "-",
            format!(
                "{} ({}), effective {:.1} against {:.1}",
                best.uncertain.number, best.name, best.uncertain.effective, uncertain.effective
            ),
            Verdict::NotInThePaper,
            "uncertain temperatures; all choices are in `designs.csv`, their shares of the time in `shares.csv`",
        ),
        Line::new(
            "not in the paper",
            "95 % intervals that hold: values of the response, radiances behind filters",
            "-",
            format!(
                "{:.3} ± {:.3}, {:.3} ± {:.3}",
                shown.coverage.response.share,
                shown.coverage.response.sigma,
                shown.coverage.radiance.share,
                shown.coverage.radiance.sigma
            ),
            Verdict::NotInThePaper,
            format!("{} drawn calibrations, responses drawn from the prior", shown.experiments),
        ),
    ]
}
