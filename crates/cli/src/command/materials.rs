//! `hadar materials`: the library.

mod classes;
mod files;
mod import;

use super::global::Global;
use clap::{Args, Subcommand};
use files::{Columns, SHOWN_CM1};
use hadar::demand::Thing;
use hadar::error::{Error, Result};
use hadar::material::{Library, Material, Summary};
use hadar_report::bundle::Bundle;
use hadar_report::json;
use hadar_report::size::figures;
use hadar_report::text::significant;
use hadar_study::Surface;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct MaterialsArgs {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// All materials and classes
    List,
    /// One material: what it is, how it is known, its emissivity; or one class: its members and how each is known
    Show {
        /// Name of the material or class, or a file of one material
        name: String,
        #[command(flatten)]
        columns: Columns,
    },
    /// Draw emissivities into the folder given by --out
    Plot {
        /// Names of the materials, or files of one each
        #[arg(required = true)]
        names: Vec<String>,
        #[command(flatten)]
        columns: Columns,
    },
    /// Read spectra from files, say what they hold and as what they were read, and with --out write them as two-column CSV
    Import {
        /// Files (tables of any layout, ECOSTRESS, JCAMP-DX, ENVI spectral libraries) or folders of them
        #[arg(required = true)]
        files: Vec<PathBuf>,
        #[command(flatten)]
        columns: Columns,
    },
}

pub(super) fn run(args: &MaterialsArgs, global: &Global) -> Result<ExitCode> {
    match &args.action {
        Action::List => list(&global.library()?, global)?,
        Action::Show { name, columns } => {
            let library = global.library()?;
            match library.classes().find(|(own, _)| own == name) {
                Some((_, class)) => classes::show(name, class, &library, global)?,
                None => show(&columns.find(&library, name)?, &library, global)?,
            }
        }
        Action::Plot { names, columns } => plot(&global.library()?, names, columns, global)?,
        Action::Import { files, columns } => import::run(files, columns, global)?,
    }
    Ok(ExitCode::SUCCESS)
}

fn list(library: &Library, global: &Global) -> Result<()> {
    let summaries: Vec<Summary> = library.iter().map(Material::summary).collect();
    let width = summaries.iter().map(|summary| summary.name.len()).max().unwrap_or(0);
    let mut out = String::new();
    for summary in &summaries {
        let basis = summary.provenance.basis.to_string();
        let _ = writeln!(out, "{:<width$}  {basis:<26}  {}", summary.name, summary.provenance.description);
    }
    let _ = writeln!(
        out,
        "\n{} materials; `hadar materials show NAME` prints source, licence and range",
        summaries.len()
    );
    out.push_str(&classes::listed(library));
    let json = serde_json::json!({ "materials": summaries, "classes": classes::members(library) });
    global.answer_with(json, &out, &library.work())
}

/// A material, its emissivity in the paper's bands and what it was taken from.
#[derive(serde::Serialize)]
struct Shown {
    #[serde(flatten)]
    summary: Summary,
    wavenumber_cm1: Vec<f64>,
    emissivity: Vec<f64>,
}

fn show(material: &Material, library: &Library, global: &Global) -> Result<()> {
    let summary = material.summary();
    let (wavenumber_cm1, emissivity) = sampled(material)?;
    let mut out = format!("{}: {}\n\n", summary.name, summary.provenance.description);
    let provenance = &summary.provenance;
    let range = summary.range_cm1.map_or_else(
        || "everywhere".into(),
        |(low, high)| format!("{} to {} cm^-1", significant(low, 5), significant(high, 5)),
    );
    for (label, value) in [
        ("known as", provenance.basis.to_string()),
        ("category", provenance.category.clone()),
        ("source", provenance.source.clone()),
        ("licence", provenance.licence.clone()),
        ("note", provenance.note.clone()),
        ("read as", summary.read_as.clone()),
        ("range", range),
    ] {
        if !value.is_empty() {
            let _ = writeln!(out, "  {label:<10} {value}");
        }
    }
    for warning in &summary.warnings {
        let _ = writeln!(out, "  {:<10} {warning}", "warning");
    }
    let _ = writeln!(out, "\n  wavenumber [cm^-1]  wavelength [um]  emissivity");
    let step = (wavenumber_cm1.len() / 11).max(1);
    for (nu, e) in wavenumber_cm1.iter().zip(&emissivity).step_by(step) {
        let _ = writeln!(out, "  {nu:>18.0}  {:>15.2}  {e:>10.4}", 1e4 / nu);
    }
    let json = json::value(&Shown { summary, wavenumber_cm1, emissivity })?;
    global.answer_with(json, &out, &library.work())
}

/// The emissivity every 1 cm⁻¹ where the paper's bands and the material's range overlap.
fn sampled(material: &Material) -> Result<(Vec<f64>, Vec<f64>)> {
    let (low, high) = material.range_cm1().unwrap_or(SHOWN_CM1);
    let (low, high) = (low.max(SHOWN_CM1.0).ceil(), high.min(SHOWN_CM1.1).floor());
    if high < low {
        return Err(Error::malformed(
            format!("`{}` is not known between {} and {} cm^-1", material.name(), SHOWN_CM1.0, SHOWN_CM1.1),
            "choose a material that covers the thermal infrared",
        ));
    }
    let nodes: Vec<f64> = (0..=(high - low) as u32).map(|i| low + f64::from(i)).collect();
    let emissivity = material.emissivity(&nodes)?;
    Ok((nodes, emissivity))
}

fn plot(library: &Library, names: &[String], columns: &Columns, global: &Global) -> Result<()> {
    let Some(out) = &global.out else {
        return Err(Error::malformed("there is no folder to draw into", "add --out DIR"));
    };
    let materials = names.iter().map(|name| columns.find(library, name)).collect::<Result<Vec<_>>>()?;
    let nodes: Vec<f64> =
        (0..=(SHOWN_CM1.1 - SHOWN_CM1.0) as u32).map(|i| SHOWN_CM1.0 + f64::from(i)).collect();
    let surfaces =
        materials.iter().map(|material| Surface::of(material, &nodes)).collect::<Result<Vec<_>>>()?;
    let drawn: Vec<&Surface> = surfaces.iter().collect();
    let mut bundle = Bundle::about(Some("Emissivities"));
    bundle.add_plots(&figures::emissivities("Emissivities", &nodes, &drawn))?;
    let text = format!("drew {}", names.join(", "));
    global.write(&bundle, out, Some(&text))?;
    let drawn: Vec<Summary> = materials.iter().map(|material| material.summary()).collect();
    let mut work = library.work();
    work.compute(Thing::Figures, bundle.figures() as u64);
    global.answer_with(serde_json::json!({ "materials": drawn }), &text, &work)
}
