//! Tables and the picture of the errors.

use super::methods::{Compared, METHODS};
use super::street::{MATERIALS, TakenApart};
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, NamedSeries, NamedValues};
use hadar_report::table::{Table, number};

/// Published errors of smoothness: NEDT (K), temperature (K), emissivity.
pub(super) const PUBLISHED: [[f64; 3]; 2] = [[0.03, 0.5, 0.01], [0.1, 1.0, 0.015]];

pub(super) fn methods(compared: &[Compared]) -> Table {
    let mut table = Table::new([
        "sky",
        "nedt_k",
        "method",
        "temperature_rms_k",
        "temperature_median_k",
        "emissivity_rms",
        "emissivity_median",
        "answered",
        "scenes",
    ]);
    for one in compared {
        let mut row = |method: &str, cells: [f64; 5]| {
            let head = [one.sky.to_owned(), number(one.nedt_k), method.to_owned()];
            table.push(head.into_iter().chain(cells.map(number)).chain([one.scenes.to_string()]).collect());
        };
        for (method, e) in METHODS.iter().zip(&one.errors) {
            let cells = [
                e.temperature_rms_k,
                e.temperature_median_k,
                e.emissivity_rms,
                e.emissivity_median,
                e.answered,
            ];
            row(method, cells);
        }
        let none = f64::NAN;
        row("van Trees bound, smooth prior", [one.rigorous_temperature_k, none, none, none, 1.0]);
        row("bound, smooth prior", [one.bound_temperature_k, none, one.bound_emissivity, none, 1.0]);
    }
    table
}

pub(super) fn street(street: &TakenApart) -> Table {
    let mut table = Table::new([
        "cluster",
        "material",
        "fitted_pixels",
        "emissivity_mean_sigma",
        "temperature_common_sigma_k",
        "chi_square_reduced",
    ]);
    for (i, (one, m)) in street.found.clusters.iter().zip(&street.material).enumerate() {
        table.push(vec![
            (i + 1).to_string(),
            MATERIALS[*m].to_owned(),
            one.fitted.to_string(),
            number(one.sigma_mean),
            number(one.sigma_temperature_k),
            number(one.chi_square_reduced),
        ]);
    }
    table
}

/// Temperature errors of all methods over the noise, under the last sky.
pub(super) fn errors(compared: &[Compared]) -> Plot {
    let mut table = Table::new(
        ["nedt_k".to_owned()]
            .into_iter()
            .chain(METHODS.iter().map(|method| format!("{method}: temperature rms (K)")))
            .chain(["bound (K)".to_owned(), "published, smoothness (K)".to_owned()]),
    );
    let sky = compared.last().map_or("", |one| one.sky);
    let rows: Vec<&Compared> = compared.iter().filter(|one| one.sky == sky).collect();
    let published = |nedt_k: f64| PUBLISHED.iter().find(|p| p[0] == nedt_k).map_or(f64::NAN, |p| p[1]);
    for one in &rows {
        let cells = one.errors.iter().map(|e| e.temperature_rms_k);
        let cells = std::iter::once(one.nedt_k).chain(cells);
        table
            .push_numbers(&cells.chain([one.bound_temperature_k, published(one.nedt_k)]).collect::<Vec<_>>());
    }
    let mut names: Vec<String> = METHODS.iter().map(|method| (*method).to_owned()).collect();
    names.extend(["bound, smooth prior", "published, smoothness"].map(str::to_owned));
    let mut figure = NamedValues::new(
        "Which method reads temperatures best without a library?",
        names,
        Axis::log("temperature error, rms (K)"),
    )
    .subtitle(format!(
        "Measured spectra of surfaces that are no bare metals, each left out of what a method learns; clear sky {sky}. The bound holds for \
         emissivities drawn from its prior, averaged."
    ));
    for one in &rows {
        let own = one.errors.iter().map(|e| e.temperature_rms_k);
        let values = own.chain([one.bound_temperature_k, published(one.nedt_k)]).collect();
        figure = figure.series(NamedSeries::new(format!("NEDT {} K", one.nedt_k), values));
    }
    Plot { name: "temperature_errors".into(), figure: figure.into(), table }
}
