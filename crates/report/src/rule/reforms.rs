//! Files about reforms beside the law: every camera by each as a table, margins as a picture.

use crate::bundle::Bundle;
use crate::figures::Plot;
use crate::plot::{Axis, Figure, NamedSeries, NamedValues};
use crate::table::{Table, number};
use crate::words::rule::{LEAST, title_of_reforms};
use hadar::error::Result;
use hadar_study::{BeforeLaw, Reforms};

/// All files.
///
/// # Errors
/// A table that cannot be written.
pub fn reforms_bundle(found: &Reforms, title: Option<&str>) -> Result<Bundle> {
    let title = title_of_reforms(title);
    let mut bundle = Bundle::about(Some(&title));
    bundle.add_plots(&[margins(found, &title)])?;
    Ok(bundle)
}

fn margins(found: &Reforms, title: &str) -> Plot {
    let mut table =
        Table::new(["reform", "from", "camera", "verdict", "conditions", "margin", "limiting_clause"]);
    let mut add = |name: &str, from: &str, cameras: &[BeforeLaw]| {
        for one in cameras {
            table.push(vec![
                name.to_owned(),
                from.to_owned(),
                one.camera.clone(),
                one.verdict.name().to_owned(),
                one.conditions.join(" "),
                number(one.margin),
                one.limiting_clause.clone().unwrap_or_default(),
            ]);
        }
    };
    add("", "", &found.law);
    for reform in &found.reforms {
        add(&reform.name, reform.from.as_deref().unwrap_or_default(), &reform.cameras);
    }
    let names = found.law.iter().map(|one| one.camera.clone()).collect();
    let of = |cameras: &[BeforeLaw]| cameras.iter().map(|one| one.margin).collect::<Vec<_>>();
    let axis = Axis::log("margin: value reached over value required (for an error the inverse)");
    let mut figure = NamedValues::new(title.to_owned(), names, axis)
        .subtitle(LEAST.to_owned())
        .series(NamedSeries::new("the rule as it is", of(&found.law)));
    for reform in &found.reforms {
        figure = figure.series(NamedSeries::new(reform.name.clone(), of(&reform.cameras)));
    }
    let figure = figure.threshold(1.0, "demanded");
    Plot { name: "reforms".into(), figure: Figure::from(figure), table }
}
