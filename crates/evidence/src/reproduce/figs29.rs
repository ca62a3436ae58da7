//! Fig. S29: the camera's response from blackbodies, and how much of it they determine.
//!
//! A twin of prototype 1 ([`FilterWheelTwin`]), whose truth is known: 31 blackbodies, ten filters, 30 values of the response. Readings are means
//! over [`shown::PIXELS`] pixels about the centre. How many of the 30 values they determine, what smoothness adds and costs, and what other
//! temperatures and filters would determine in the same time ([`designs`]).

mod best;
mod designs;
mod lines;
mod pictures;
mod shown;

use super::coverage::filter_wheel;
use super::order::{Effort, Figures, Made, Order};
use designs::Row;
use hadar::calibration::determined::Determined;
use hadar::calibration::sent::Unknown;
use hadar::error::Result;
use hadar::statistics::Statistics;
use hadar_estimate::calibrate::response::Response;
use hadar_estimate::calibrate::twin::FilterWheelTwin;
use hadar_report::bundle::Bundle;
use hadar_report::table::{Table, number};
use hadar_simulate::draws::{Draws, generator};
use shown::{PIXELS, Shown, TEMPERATURE_ERROR_K};

const EXPERIMENTS: usize = 600;
const QUICK_EXPERIMENTS: usize = 60;
/// Deviations of a reading, counts, over which the number is shown.
const SIGMAS: [f64; 9] = [10.0, 3.0, 1.0, 0.3, 0.1, 0.05, 0.02, 0.005, 0.001];

pub(super) fn make(order: Order) -> Result<Made> {
    let twin = FilterWheelTwin::prototype()?;
    let sigma = 1.0 / PIXELS.sqrt();
    let readings = twin.readings(sigma);
    let errors = Unknown::temperatures(&vec![TEMPERATURE_ERROR_K; twin.temperatures_k.len()]);
    let truth = twin.response.as_slice();
    let known = |sigma: f64, errors: Option<(&[Unknown], &[f64])>| {
        Determined::of(&twin.wheel.scores(&twin.readings(sigma), errors)?, &twin.prior)
    };
    let (exact, uncertain) = (known(sigma, None)?, known(sigma, Some((&errors, truth)))?);
    let mean = twin.prior.mean();
    let bias = (0..mean.len())
        .map(|j| {
            let seen = (0..mean.len()).map(|i| uncertain.kernels[(j, i)] * (truth[i] - mean[i])).sum::<f64>();
            mean[j] + seen - truth[j]
        })
        .collect();
    let mut over_noise = Vec::new();
    for sigma in SIGMAS {
        let (a, b) = (known(sigma, None)?, known(sigma, Some((&errors, truth)))?);
        over_noise.push([sigma, a.number as f64, b.number as f64, a.effective, b.effective]);
    }
    let found = drawn(&twin, &errors, sigma, order.seed)?;
    let experiments = if order.effort == Effort::Full { EXPERIMENTS } else { QUICK_EXPERIMENTS };
    let coverage = filter_wheel(&twin, sigma, TEMPERATURE_ERROR_K, 320.0, experiments, order.seed)?;
    let choices = designs::choices(&twin, sigma / (readings.len() as f64).sqrt(), TEMPERATURE_ERROR_K)?;
    let shown = Shown { found, exact, uncertain, bias, over_noise, choices, coverage, experiments, twin };
    let mut bundle = Bundle::default();
    bundle.add_table("values.csv", response_table(&shown))?;
    bundle.add_table("kernels.csv", kernels(&shown))?;
    bundle.add_table("designs.csv", designs::table(&shown.choices))?;
    bundle.add_table("shares.csv", designs::shares(&shown.choices))?;
    bundle.add_plots(&pictures::all(&shown))?;
    let text = text(&shown);
    let pictures = vec![
        ("response.png", "The response of the twin, estimated and true"),
        ("resolved.png", "Which part of the true response does a value of the estimate see?"),
        ("directions.png", "How well each direction of the response is known"),
        ("number_over_noise.png", "Values that are determined over the noise of a reading"),
        ("choices.png", "What other temperatures and filters would determine in the same time"),
    ];
    Ok((bundle, lines::all(&shown), Figures { pictures, text }))
}

/// One calibration with drawn temperatures and readings.
fn drawn(twin: &FilterWheelTwin, errors: &[Unknown], sigma: f64, seed: u64) -> Result<Response> {
    let readings = twin.readings(sigma);
    let mut rng = generator(seed, 1 << 30);
    // Normal numbers: readings of no photons with such noise.
    let mut normal = |count: usize| -> Result<Vec<f64>> {
        let draws =
            Draws::new(&Statistics::Poisson, &vec![0.0; count])?.with_electronic_noise(&vec![1.0; count])?;
        let mut out = vec![0.0; count];
        draws.draw_into(&mut rng, &mut out);
        Ok(out)
    };
    let shifts: Vec<f64> =
        normal(errors.len())?.iter().zip(errors).map(|(z, one)| z * one.deviation).collect();
    let mut counts = twin.means(&readings, &twin.response, &shifts);
    counts.iter_mut().zip(normal(readings.len())?).for_each(|(count, z)| *count += sigma * z);
    Response::found(&twin.wheel, &twin.prior, &readings, &counts, errors)
}

fn response_table(shown: &Shown) -> Table {
    let mut table = Table::new([
        "wavenumber_cm1",
        "response_true",
        "response_typical",
        "response_estimated",
        "sigma",
        "sigma_beforehand",
        "sigma_without_smoothness_exact_temperatures",
        "bias_of_smoothness",
    ]);
    for (j, nu) in shown.twin.wheel.centres_cm1().iter().enumerate() {
        table.push_numbers(&[
            *nu,
            shown.twin.response[j],
            shown.twin.prior.mean()[j],
            shown.found.values[j],
            shown.found.sigma(j),
            shown.exact.sigma_prior[j],
            pictures::told(shown.exact.sigma_free[j]),
            shown.bias[j],
        ]);
    }
    table
}

fn kernels(shown: &Shown) -> Table {
    let centres = shown.twin.wheel.centres_cm1();
    let names = centres.iter().map(|nu| format!("from_{nu:.0}_cm1"));
    let mut table = Table::new(std::iter::once("estimate_at_cm1".to_owned()).chain(names));
    for (j, nu) in centres.iter().enumerate() {
        let row = shown.uncertain.kernels.row(j);
        table.push(std::iter::once(number(*nu)).chain(row.iter().map(|x| number(*x))).collect());
    }
    table
}

fn text(shown: &Shown) -> String {
    let (exact, uncertain) = (&shown.exact, &shown.uncertain);
    let of = |place: usize| shown.choices.get(place).map_or(0, |choice| choice.uncertain.number);
    let Row { number: best, effective, .. } = designs::most(&shown.choices).uncertain;
    format!(
        "The twin's filters and response are stated in its source; the paper's are pictures. A reading is the mean of {PIXELS} pixels of 50 mK noise \
         each ({:.1} mK); temperatures are set to {:.0} mK. Determined is a direction of the 30 values, of length 1, whose coefficient is known to a \
         tenth of the response's peak from the readings alone; the effective number is the trace of the resolving kernels with a prior of 0.15 \
         of the peak, correlated over 100 cm⁻¹, about the typical curve.\n\n\
         Of 30 values {} are determined, {} were the temperatures exact (numerical rank {}); effective numbers {:.1} and {:.1}. The most of the \
         choices below, '{}', determines {best} (effective {effective:.1}) in the same time.\n\n\
         Wider temperatures and more, narrower filters determine more. More readings between the same ends hardly do: {} with two temperatures, {} \
         with three, {} with 31; nor does time that is shared by the most information (ln det, exact temperatures).\n\n\
         Intervals of 95 % hold {:.3} ± {:.3} of the values and {:.3} ± {:.3} of the radiances behind filters in {} calibrations of responses that \
         are drawn from the prior. For the twin's own response smoothness costs at most {:.3} of the peak (`values.csv`).\n",
        1e3 * 0.05 / PIXELS.sqrt(),
        1e3 * TEMPERATURE_ERROR_K,
        uncertain.number,
        exact.number,
        exact.rank,
        uncertain.effective,
        exact.effective,
        designs::most(&shown.choices).name,
        of(1),
        of(2),
        of(0),
        shown.coverage.response.share,
        shown.coverage.response.sigma,
        shown.coverage.radiance.share,
        shown.coverage.radiance.sigma,
        shown.experiments,
        shown.bias.iter().fold(0.0_f64, |most, bias| most.max(bias.abs())),
    )
}
