//! What is said of the image as a whole: a prior over it (`[spatial]`) and how its picture is coloured (`[vision]`).

use super::super::entries::Entries;
use super::super::section::Entry;
use super::{Brightness, VisionSpec};
use hadar::error::{Error, Result};
use hadar::units::Dimension;
use hadar_estimate::decompose::SpatialPrior;

/// Log-odds of a neighbour where nothing is said: below ln(1 + √q), beyond which the prior alone makes images of one material of q.
const POTTS_WEIGHT: f64 = 1.0;
/// The paper's p.
const TEX_SGD_WEIGHT: f64 = 0.1;
const BRIGHTNESS: [(&str, Brightness); 2] =
    [("texture", Brightness::Texture), ("distilled", Brightness::Distilled)];
const POTTS: &str = "potts";
const TEX_SGD: &str = "tex-sgd";

pub(super) fn spatial(entry: &Entry<'_>) -> Result<SpatialPrior> {
    let section = entry.section()?;
    let is_potts = section.require("prior")?.choice(&[(POTTS, true), (TEX_SGD, false)])?;
    let weight = section.number("weight")?;
    let temperature_step_k = section.quantity("temperature_step")?;
    match (is_potts, temperature_step_k) {
        (true, _) => Ok(SpatialPrior::Potts { weight: weight.unwrap_or(POTTS_WEIGHT), temperature_step_k }),
        (false, None) => Ok(SpatialPrior::TexSgd { weight: weight.unwrap_or(TEX_SGD_WEIGHT) }),
        (false, Some(_)) => {
            let found = "a step of temperatures beside a prior that has none";
            let instead = "leave it out, or write prior = \"potts\"";
            Err(section.fail("temperature_step", Error::malformed(found, instead)))
        }
    }
}

pub(super) fn spatial_written(prior: &SpatialPrior) -> Entries {
    match *prior {
        SpatialPrior::Potts { weight, temperature_step_k } => Entries::default()
            .put("prior", POTTS)
            .put("weight", weight)
            .put_quantity("temperature_step", Dimension::TemperatureDifference, temperature_step_k),
        SpatialPrior::TexSgd { weight } => Entries::default().put("prior", TEX_SGD).put("weight", weight),
    }
}

pub(super) fn vision(entry: &Entry<'_>) -> Result<VisionSpec> {
    let section = entry.section()?;
    let temperature = |end: &Entry<'_>| end.quantity();
    let hues = section.read("hues", |entry| {
        let table = entry.table()?;
        let hue = |name: &str| Some((name.to_owned(), table.get(name)?.number("210")));
        table.keys().filter_map(hue).map(|(name, hue)| Ok((name, hue?))).collect()
    })?;
    let sky = section.number("sky")?.map(|place| place as usize);
    let brightness = section.choice("brightness", &BRIGHTNESS)?.unwrap_or_default();
    if sky.is_none() && brightness == Brightness::Distilled {
        let found = "a distilled texture without a sky";
        let instead = "write sky = 0, the place of the sky among the [[environment]] tables, counted from 0";
        return Err(section.fail("brightness", Error::malformed(found, instead)));
    }
    Ok(VisionSpec {
        hues_deg: hues.unwrap_or_default(),
        sky,
        brightness,
        temperature_k: section
            .read("temperature", |entry| entry.wide_range("[\"0 degC\", \"40 degC\"]", temperature, |k| k))?,
    })
}

pub(super) fn vision_written(spec: &VisionSpec) -> Entries {
    let hues: toml::Table = spec.hues_deg.iter().map(|(name, hue)| (name.clone(), (*hue).into())).collect();
    let brightness = BRIGHTNESS.iter().find(|(_, own)| *own == spec.brightness);
    Entries::default()
        .put_if("hues", (!hues.is_empty()).then_some(hues))
        .put_range("temperature", Dimension::Temperature, spec.temperature_k)
        .put_if("sky", spec.sky.map(|sky| sky as i64))
        .put_if("brightness", brightness.filter(|_| spec.sky.is_some()).map(|(name, _)| *name))
}
