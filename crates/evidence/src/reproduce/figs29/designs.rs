//! Other temperatures and filters, all of them in the same time.

use super::best::Design;
use hadar::calibration::determined::Determined;
use hadar::calibration::filter_wheel::FilterWheel;
use hadar::calibration::sent::Unknown;
use hadar::error::Result;
use hadar_estimate::calibrate::twin::{FILTERS, FilterWheelTwin};
use hadar_report::table::{Table, number};

/// Passbands to choose from: centres every 30 cm⁻¹, three widths.
const CATALOGUE_WIDTHS_CM1: [f64; 3] = [50.0, 90.0, 200.0];

/// What a design determines.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub(super) number: usize,
    pub(super) effective: f64,
    /// Median over the values of the deviation with smoothness.
    pub(super) sigma: f64,
}

/// A choice of temperatures and filters.
pub(super) struct Choice {
    pub(super) name: String,
    pub(super) filters: Vec<[f64; 2]>,
    pub(super) design: Design,
    pub(super) exact: Row,
    pub(super) uncertain: Row,
}

fn celsius(low: f64, high: f64, count: usize) -> Vec<f64> {
    let step = (high - low) / (count - 1) as f64;
    (0..count).map(|k| 273.15 + low + step * k as f64).collect()
}

/// All choices; `sigma` is the deviation of a reading that takes all the time.
pub(super) fn choices(twin: &FilterWheelTwin, sigma: f64, error_k: f64) -> Result<Vec<Choice>> {
    let papers = twin.temperatures_k.as_slice();
    let (wide, wider) = (celsius(5.0, 150.0, 16), celsius(-20.0, 250.0, 16));
    let even_filters = |count: usize| -> Vec<[f64; 2]> {
        let step = 620.0 / count as f64;
        (0..count).map(|q| [690.0 + step * (q as f64 + 0.5), step]).collect()
    };
    let catalogue: Vec<[f64; 2]> = CATALOGUE_WIDTHS_CM1
        .iter()
        .flat_map(|width| (0..21).map(move |i| [680.0 + 30.0 * f64::from(i), *width]))
        .collect();
    let ten = FILTERS.as_slice();
    let mut out = Vec::new();
    let mut add = |name: &str, filters: &[[f64; 2]], design: Design, wheel: &FilterWheel| -> Result<()> {
        out.push(Choice {
            name: name.to_owned(),
            exact: row(twin, wheel, &design, sigma, 0.0)?,
            uncertain: row(twin, wheel, &design, sigma, error_k)?,
            filters: filters.to_vec(),
            design,
        });
        Ok(())
    };
    let all = |wheel: &FilterWheel| (0..wheel.filters()).collect::<Vec<_>>();
    for (name, temperatures) in [
        ("paper: 31 from 35 to 110 °C", papers),
        ("2: 35 and 110 °C", &[papers[0], papers[30]]),
        ("3: 35, 72.5 and 110 °C", &[papers[0], papers[15], papers[30]]),
        ("16 from 5 to 150 °C", &wide),
        ("16 from -20 to 250 °C", &wider),
    ] {
        add(name, ten, Design::even(temperatures, &all(&twin.wheel)), &twin.wheel)?;
    }
    let best = |wheel: &FilterWheel, temperatures: &[f64]| {
        Design::best(wheel, &twin.prior, temperatures, &all(wheel), sigma)
    };
    let few = |temperatures: &[f64]| temperatures.iter().step_by(3).copied().collect::<Vec<_>>();
    add("35 to 110 °C, time shared best", ten, best(&twin.wheel, &few(papers))?, &twin.wheel)?;
    add("-20 to 250 °C, time shared best", ten, best(&twin.wheel, &few(&wider))?, &twin.wheel)?;
    let many = twin.wheel_of(&catalogue)?;
    for (name, temperatures) in [
        ("10 best of 63 filters, 35 to 110 °C", few(&celsius(35.0, 110.0, 16))),
        ("10 best of 63 filters, -20 to 250 °C", few(&wider)),
    ] {
        let design = Design::best_filters(&many, &twin.prior, &temperatures, 10, sigma)?;
        add(name, &catalogue, design, &many)?;
    }
    for count in [10, 20, 30] {
        let filters = even_filters(count);
        let wheel = twin.wheel_of(&filters)?;
        let name = format!("{count} filters side by side, 35 to 110 °C");
        add(&name, &filters, Design::even(papers, &all(&wheel)), &wheel)?;
    }
    let filters = even_filters(20);
    let wheel = twin.wheel_of(&filters)?;
    add("20 filters side by side, -20 to 250 °C", &filters, Design::even(&wider, &all(&wheel)), &wheel)?;
    Ok(out)
}

fn row(
    twin: &FilterWheelTwin,
    wheel: &FilterWheel,
    design: &Design,
    sigma: f64,
    error_k: f64,
) -> Result<Row> {
    let readings = design.readings(sigma);
    let blackbodies = readings.iter().map(|reading| reading.blackbody + 1).max().unwrap_or(0);
    let errors = Unknown::temperatures(&vec![error_k; blackbodies]);
    let about = (error_k > 0.0).then_some((errors.as_slice(), twin.response.as_slice()));
    let found = Determined::of(&wheel.scores(&readings, about)?, &twin.prior)?;
    let mut sigmas = found.sigma_smooth;
    sigmas.sort_by(f64::total_cmp);
    Ok(Row { number: found.number, effective: found.effective, sigma: sigmas[sigmas.len() / 2] })
}

/// The choice that determines the most.
pub(super) fn most(choices: &[Choice]) -> &Choice {
    let better = |a: &&Choice, b: &&Choice| a.uncertain.effective.total_cmp(&b.uncertain.effective);
    choices.iter().max_by(better).unwrap_or(&choices[0])
}

pub(super) fn table(choices: &[Choice]) -> Table {
    let mut table = Table::new([
        "choice",
        "readings",
        "determined_exact_temperatures",
        "effective_exact_temperatures",
        "median_sigma_exact_temperatures",
        "determined",
        "effective",
        "median_sigma",
        "gain_left_nats",
    ]);
    for one in choices {
        let mut cells = vec![one.name.clone(), one.design.shares.len().to_string()];
        for row in [one.exact, one.uncertain] {
            cells.extend([row.number.to_string(), number(row.effective), number(row.sigma)]);
        }
        cells.push(number(one.design.gap_nats));
        table.push(cells);
    }
    table
}

/// How the time is shared where it was searched for.
pub(super) fn shares(choices: &[Choice]) -> Table {
    let mut table = Table::new(["choice", "temperature_celsius", "filter_cm1", "filter_width_cm1", "share"]);
    for one in choices.iter().filter(|one| one.design.gap_nats.is_finite()) {
        for (t, q, share) in &one.design.shares {
            let [centre, width] = one.filters[*q];
            let numbers = [t - 273.15, centre, width, *share].map(number);
            table.push(std::iter::once(one.name.clone()).chain(numbers).collect());
        }
    }
    table
}
