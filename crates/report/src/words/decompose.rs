//! A decomposed cube in words: how much of it is decided, what is there, how good that is, what was assumed.

pub(crate) mod judged;
mod segmented;
pub(crate) mod shared;

use crate::table::number;
use crate::text::columns::{Columns, left, right};
use crate::text::cubes::{AGAINST, lighting_total, noise};
use crate::text::footing::{read_as, warnings};
use crate::text::numbers::{degrees, listed};
use hadar::words::{quantity, share, significant, whole};
use hadar_estimate::decompose::{Method, Spatial, SpatialPrior, flag};
use hadar_scenario::decompose::{CubeUnit, PixelUnknown};
use hadar_study::decompose::{
    Besides, CORRELATION_CM1, Decomposed, LightFound, MixedFound, ModelVerdict, TruthFound,
};
use std::fmt::Write as _;

/// Materials that are listed.
const LISTED: usize = 12;
/// Pairs of them.
const LISTED_PAIRS: usize = 5;

/// The whole answer.
#[must_use]
pub fn text(result: &Decomposed) -> String {
    let is_rejected = result.model.verdict.takes_back();
    let safety =
        result.segmentation.as_ref().map_or_else(String::new, |found| segmented::safety(found, is_rejected));
    let others = surroundings_found(&result.surroundings_found) + &constants(result);
    let mut out = format!("{}{others}\n{safety}\n{}", sentence(result), read_as(&result.read));
    out.push_str(&judged::text(&result.model));
    out.push_str(&result.shared.as_ref().map_or_else(String::new, shared::text));
    out.push_str(&result.none_of_these.as_ref().map_or_else(String::new, none_of_these));
    out.push_str(&result.mixed.as_ref().map_or_else(String::new, mixed));
    out.push_str(&found(result));
    if let Some(segmentation) = &result.segmentation {
        out.push_str(&segmented::text(segmentation, is_rejected));
    }
    out.push_str(&flags(result));
    if let Some(truth) = &result.truth {
        out.push_str(&against(truth, result));
    }
    out.push_str(&distilled(result));
    out.push_str(&assumptions(result));
    out.push_str(&warnings(&result.warnings));
    out
}

fn distilled(result: &Decomposed) -> String {
    let Some(of_sky) = &result.vision.distilled else { return String::new() };
    let [texture, sigma] = of_sky.medians;
    let mut out = format!(
        "Texture of the sky's light (distilled_texture.npy)\n  {} photons s^-1 m^-2 sr^-1 with a deviation of {}, medians; {} scatterings\n",
        significant(texture, 4),
        significant(sigma, 2),
        of_sky.scatterings
    );
    for of in &of_sky.residues {
        let name = result.materials.get(of.material).map_or("", String::as_str);
        let _ = writeln!(
            out,
            "  residue of {name}: {} of a band's noise of {} is light that the surroundings do not explain",
            significant(of.light, 2),
            significant(of.noise, 2)
        );
    }
    out.push_str("  Residues beyond the noise are attributed to the sky; radiation of objects that are not listed as surroundings is contained in them.\n\n");
    out
}

fn of(part: usize, all: usize) -> String {
    format!("{} of {}", whole(part as u64), whole(all as u64))
}

/// What no surface was measured to be, and is decided for or against all the same.
fn constants(result: &Decomposed) -> String {
    let all = &result.constants;
    let each = if all.len() == 1 { "is entered as one number" } else { "are entered as one number each" };
    if all.is_empty() || !result.method.has_likelihood() {
        return String::new();
    }
    format!(" {} {each}, which was not measured: decisions for and against rest on it.", listed(all))
}

fn sentence(result: &Decomposed) -> String {
    let seen = result.pixels - result.skipped;
    if !result.method.has_likelihood() {
        let named = result.found.iter().map(|row| row.pixels).sum();
        return match result.method.names_materials() {
            true => {
                format!("{} pixels have a material named; the method gives no confidence.", of(named, seen))
            }
            false => {
                format!("{} pixels as one blackbody each: no material is determined.", whole(seen as u64))
            }
        };
    }
    let taken_back = match result.model.verdict {
        ModelVerdict::Rejected => Some(("The cube does not follow its model", "if it held")),
        ModelVerdict::SharedNotTold => Some((
            "The unknowns that all pixels share are not determined well enough",
            "with it as estimated",
        )),
        _ => None,
    };
    if let Some((why, condition)) = taken_back {
        return format!(
            "{why}: {} pixels ({}) would have one remaining material of {} {condition}; none is decided.",
            of(result.decided_if_model_holds, seen),
            share(result.decided_if_model_holds as f64 / seen.max(1) as f64),
            result.materials.len()
        );
    }
    let mut out = match result.decided {
        0 => format!("No pixel of {} is decided", whole(seen as u64)),
        decided => format!(
            "{} pixels ({}) have one remaining material of {}",
            of(decided, seen),
            share(decided as f64 / seen.max(1) as f64),
            result.materials.len()
        ),
    };
    match result.undecided {
        0 => out.push('.'),
        undecided => {
            let _ = write!(out, "; {} are undecided.", whole(undecided as u64));
        }
    }
    out
}

/// That surroundings were found in the cube, from how many pixels and with which error: behind the first sentence.
pub(crate) fn surroundings_found(all: &[LightFound]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let one = |one: &LightFound| {
        let mut errors = Vec::new();
        errors.extend(one.scale_sigma.map(|sigma| format!("{} in strength", share(sigma))));
        errors.extend(one.path_sigma.map(|sigma| format!("{} in the path of its light", share(sigma))));
        errors.extend(one.temperature_sigma_k.map(|sigma| quantity(sigma, "K")));
        errors.push(format!("{} in shape", share(one.shape_sigma)));
        format!(
            "{} ({} of {} pixels looked at, {} degC in the mean of the bands, +- {})",
            one.like,
            whole(one.pixels as u64),
            whole(one.pixels_asked as u64),
            degrees(one.temperature_k),
            errors.join(", ")
        )
    };
    let each: Vec<String> = all.iter().map(one).collect();
    format!(" The surroundings were found in the cube itself: {}.", each.join("; "))
}

/// Surfaces that are none of the library.
fn none_of_these(found: &Besides) -> String {
    format!(
        "None of these materials (smooth emissivities, prior {})\n  {}\n  \
         such a pixel is of no category, may be of any, and has a temperature with its standard deviation\n\n",
        share(found.prior),
        besides(found),
    )
}

fn besides(found: &Besides) -> String {
    format!(
        "likeliest in {} pixels, the only candidate in {}; more probable than 1 % in {}",
        whole(found.likeliest as u64),
        whole(found.alone as u64),
        whole(found.above_one_percent as u64),
    )
}

/// Pixels of two surfaces.
fn mixed(found: &MixedFound) -> String {
    let mut out = format!(
        "Two surfaces in a pixel (each a tenth of it at least, prior {})\n  {}\n  \
         such a pixel has no one material, where none alone fits it may be of any category, and its temperature is that of the larger\n",
        share(found.besides.prior),
        besides(&found.besides)
    );
    if found.unfitting > 0 {
        let _ = writeln!(
            out,
            "  in {} of these pixels two surfaces do not fit either (p below 1e-4): anything may be there",
            whole(found.unfitting as u64)
        );
    }
    for row in found.pairs.iter().take(LISTED_PAIRS) {
        let ([first, second], pixels) = (&row.materials, whole(row.pixels as u64));
        let _ = writeln!(
            out,
            "  {pixels:>9}  {first} and {second}, of the first {} in the mean",
            share(row.share_mean)
        );
    }
    if let Some(more) = found.pairs.len().checked_sub(LISTED_PAIRS).filter(|more| *more > 0) {
        let _ = writeln!(out, "  and {more} more pairs: hadar.json");
    }
    out.push('\n');
    out
}

fn found(result: &Decomposed) -> String {
    if !result.method.names_materials() {
        return String::new();
    }
    let shown = &result.found[..result.found.len().min(LISTED)];
    let width = shown.iter().map(|row| row.material.chars().count()).max().unwrap_or(0).max(8);
    // Under its condition, that is, while the model is rejected.
    let decided = if result.model.verdict.takes_back() { "if held" } else { "decided" };
    let mut table = Columns::new([
        left("", width),
        right("pixels", 9),
        right(decided, 9),
        right("median (degC)", 14),
        right("tenths (degC)", 18),
        right("sigma (K)", 10),
    ]);
    let says = |what: String| if result.method.has_likelihood() { what } else { "-".to_owned() };
    for row in shown {
        let [low, high] = row.temperature_tenths_k.map(degrees);
        table.row([
            row.material.clone(),
            whole(row.pixels as u64),
            says(whole(row.decided_if_model_holds as u64)),
            degrees(row.temperature_median_k),
            format!("{low} to {high}"),
            says(significant(row.temperature_sigma_median_k, 2)),
        ]);
    }
    let mut out = format!("Materials, the most probable of each pixel\n{}", table.text());
    if let Some(more) = result.found.len().checked_sub(LISTED).filter(|more| *more > 0) {
        let _ = writeln!(out, "  and {more} more: materials.csv");
    }
    for row in &result.classes {
        let _ =
            writeln!(out, "  {} of {} spectra: {} pixels", row.class, row.spectra, whole(row.pixels as u64));
    }
    out.push('\n');
    out
}

/// What a flag says in an answer.
pub(crate) fn flag_said(bit: u8, result: &Decomposed) -> &'static str {
    match bit {
        flag::NO_FIT => match (&result.none_of_these, &result.mixed) {
            (None, None) => "no material of the library fits (p below 1e-4)",
            (Some(_), None) => "no material of the library fits, or none of them is likelier",
            (None, Some(_)) => "no material of the library fits, or two in one pixel are likelier",
            (Some(_), Some(_)) => "no material of the library fits, or none of them or two are likelier",
        },
        flag::TEMPERATURE_AT_LIMIT => "temperature at an end of its range",
        flag::LIGHTING_AT_LIMIT => "lighting at an end of its range",
        flag::NO_INFORMATION => "in equilibrium with their surroundings: the material cannot be determined",
        flag::LIGHTING_UNKNOWN => {
            "the lighting is hardly determined: little is reflected, or the surroundings are alike"
        }
        flag::UNDECIDED => "several materials remain at 95 %",
        flag::SKIPPED => "omitted: a sample is missing, or the pixel is bad",
        flag::TEMPERATURE_UNKNOWN => "the temperature could be anything: nothing is emitted",
        _ => "",
    }
}

fn flags(result: &Decomposed) -> String {
    if result.flags.is_empty() {
        return String::new();
    }
    let mut out = String::from("Flags of pixels\n");
    for row in &result.flags {
        let meaning = flag_said(row.bit, result);
        let _ = writeln!(out, "  {:>9}  {meaning}", whole(row.pixels as u64));
    }
    out.push('\n');
    out
}

fn against(truth: &TruthFound, result: &Decomposed) -> String {
    let neighbours = result.spatial.is_some();
    let bound = match result.method {
        Method::Ml if neighbours => "its stated deviation",
        Method::Ml => "its Cramér–Rao bound",
        _ => "the deviation that the method says",
    };
    let mut out = format!("{AGAINST}\n");
    let percent = |x: f64| format!("{} %", significant(100.0 * x, 4));
    if let Some(right) = truth.right_material {
        let limit = truth.right_material_limit.map_or_else(String::new, |limit| {
            let error = truth.right_material_limit_error.unwrap_or(0.0);
            format!(
                "; {} +- {} by the nearest distances (upper limit of any test between a pixel{} and the closest confuser of another material, mean over {} pixels)",
                percent(limit),
                significant(100.0 * error, 1),
                if neighbours { ", without its neighbours," } else { "" },
                truth.right_material_limit_pixels
            )
        });
        let _ = writeln!(out, "  right material: {}{limit}", percent(right));
    }
    if let Some(right) = truth.right_where_decided {
        let _ = writeln!(out, "  right material where decided: {}", percent(right));
    }
    if let (Some(ratio), Some(covered)) = (truth.temperature_error_over_bound_rms, truth.coverage_95) {
        let _ = writeln!(
            out,
            "  temperature error over {bound}: {} rms; 95 % intervals hold {} ({} pixels of right material within all limits)",
            significant(ratio, 3),
            percent(covered),
            whole(truth.coverage_pixels as u64)
        );
    }
    if let Some(covered) = truth.coverage_95_all {
        let _ = writeln!(
            out,
            "  95 % intervals of all pixels, also of a wrong material or none that fits: {}",
            percent(covered)
        );
    }
    if let Some(rmse) = truth.temperature_rmse_k {
        let _ = writeln!(out, "  temperature error of all pixels: {} rms", quantity(rmse, "K"));
    }
    out.push('\n');
    out
}

/// How pixels are decomposed, in a few words.
pub(crate) fn how(result: &Decomposed) -> &'static str {
    match (result.scenario.spatial, result.method) {
        (Some(SpatialPrior::Potts { .. }), _) => {
            "Maximum posterior of every pixel with its neighbours (Potts prior)"
        }
        (Some(SpatialPrior::TexSgd { .. }), _) => "Least cost of every pixel with its neighbours (TeX-SGD)",
        (None, Method::Ml) => "Maximum likelihood of every pixel independently",
        (None, Method::AnalyticInverse) => "Inverse functions along wavenumber, every pixel independently",
        (None, Method::Te) => "Maximum likelihood without scattered light, every pixel independently",
        (None, Method::GreyBody) => "Brightness temperature of every pixel independently",
    }
}

/// Below the pictures of flags and p-values.
pub(crate) const FLAGGED: &str = "A pixel of which several things are said has the colour of the first of them in the list; flags.csv has all.";
pub(crate) const P_VALUES: &str =
    "Of a right model a thousandth of the pixels is below 1e-3; all from 1e-6 down have one colour.";

/// Below the picture of the categories.
pub(crate) const SEGMENTED: &str = "Every pixel that has a category is in segmentation.npy, every object in objects.csv. Hatched: undecided, what is there is one \
    of several categories, or not known.";

/// Below the picture of where a category cannot be excluded.
pub(crate) const NOT_EXCLUDED_SAID: &str = "It cannot where one of its materials is among what 99 % of the posterior leave, where nothing fits or tells, and where a \
    sample is missing.";

/// What brightness means in a picture whose contrast is limited so, and what it is where the lighting is unknown.
pub(crate) fn brightness_said(limit: f64, unlit: f64) -> String {
    format!(
        "Brightness: logarithm of the texture, equalised in tiles (contrast limited to {limit}); {} where the lighting is unknown. \
         Temperatures beyond the scale have the colours of its ends. Every pixel is in tex_vision_image.png, texture.npy and thermal.npy.",
        number(unlit),
    )
}

/// The prior over the image, a line; nothing where there is none.
fn neighbours(result: &Decomposed) -> String {
    let changed =
        |spatial: &Spatial| format!("; it changed the material of {} pixels", whole(spatial.changed as u64));
    let Some((prior, about)) = result.scenario.spatial.zip(result.spatial.as_ref()) else {
        return String::new();
    };
    match prior {
        SpatialPrior::Potts { weight, .. } => format!(
            "  neighbours (Potts): each of four adds {} to the log-odds of the neighbour's material and temperature{}{}\n",
            significant(weight, 3),
            about.temperature_step_k.map_or_else(String::new, |step| {
                format!("; temperatures of a material differ by {} from pixel to pixel", quantity(step, "K"))
            }),
            changed(about)
        ),
        SpatialPrior::TexSgd { weight } => format!(
            "  neighbours (TeX-SGD): temperatures are pulled to the median of 3 x 3 pixels, p = {}{}\n",
            significant(weight, 3),
            changed(about)
        ),
    }
}

/// That nothing else can be there, where nothing is said of it.
fn in_library(result: &Decomposed) -> &'static str {
    let library = &result.scenario.library;
    match (library.none_of_these, library.mixed) {
        (None, None) => {
            "  every pixel is taken for one surface of these materials; library.none_of_these and library.mixed state doubts\n"
        }
        (None, Some(_)) => {
            "  every surface is taken for one of these materials; library.none_of_these states a doubt\n"
        }
        (Some(_), None) => "  every pixel is taken for one surface; library.mixed states a doubt\n",
        (Some(_), Some(_)) => "",
    }
}

/// What nothing is stated of, and what is therefore taken as exact.
pub(crate) fn exact(unknown: &PixelUnknown, found: &[LightFound]) -> String {
    let shared = &unknown.shared;
    let of_lights = [shared.sky_scale, shared.sky_shape, shared.sky_path, shared.light_temperature_k];
    let are_stated = !found.is_empty() || of_lights.iter().any(Option::is_some);
    let parts = [
        ("the scale of the counts", unknown.gain || shared.gain.is_some()),
        ("the bands", shared.wavelength_shift_cm1.is_some()),
        ("the surroundings", are_stated),
    ];
    let silent: Vec<&str> =
        parts.into_iter().filter(|(_, is_stated)| !is_stated).map(|(what, _)| what).collect();
    if silent.is_empty() {
        return String::new();
    }
    format!("  taken as exact: {}; [unknown] states how well they are known\n", silent.join(", "))
}

fn assumptions(result: &Decomposed) -> String {
    let scenario = &result.scenario;
    let [low, high] = scenario.unknown.temperature_k;
    let total = lighting_total(scenario.unknown.lighting_total);
    let model = match &scenario.cube.unit {
        CubeUnit::Radiance { .. } | CubeUnit::BrightnessTemperature { .. } => "",
        CubeUnit::CountsPerPhotonRadiance(_) | CubeUnit::Camera => ", variance from the model",
    };
    let noise = noise(&scenario.cube.unit).to_owned() + model;
    let library =
        scenario.library.emissivity_error.filter(|error| *error > 0.0).map_or_else(String::new, |error| {
            let over = scenario.library.emissivity_correlation_cm1.unwrap_or(CORRELATION_CM1);
            format!(
                " but for errors of the library, {} of the emissivity, to a quarter over {}",
                share(error),
                quantity(over, "cm^-1")
            )
        });
    let method = result.method.name();
    let (model, intervals) = match (result.method, scenario.spatial) {
        (_, Some(SpatialPrior::Potts { .. })) => (
            "",
            "with the neighbours of its material, were it and the prior certain; materials: posterior under the prior",
        ),
        (_, Some(SpatialPrior::TexSgd { .. })) => (
            "",
            "Cramér–Rao bound of the pixel alone, which a temperature that was pulled need not keep; candidates: of the pixel alone",
        ),
        (Method::Ml, None) => {
            ("", "Cramér–Rao bound at the fit, were the material certain; materials: profile likelihoods")
        }
        (Method::Te, None) => (
            ", nothing is scattered",
            "those of this model, wrong where light is scattered; materials: profile likelihoods",
        ),
        (Method::AnalyticInverse, None) => {
            let out = format!(
                "Assumptions\n  method: {method}: the lighting has no slope along wavenumber (S46, S47); temperature {low} to {high} K, \
                 lighting of any total\n  intervals: none, the method has none\n\n"
            );
            return out;
        }
        (Method::GreyBody, None) => {
            let out = format!(
                "Assumptions\n  method: {method}: emissivity 1, all bands together\n  intervals: none, the method has none\n\n"
            );
            return out;
        }
    };
    let lighting = match result.method {
        Method::Te => String::new(),
        _ => format!(", lighting of {} surroundings, {total}", scenario.environment.len()),
    };
    format!(
        "Assumptions\n  method: {method}{model}\n  likelihood: {noise}; bands independent{library}\n  \
         unknown: material, temperature {low} to {high} K{lighting}{}\n  intervals: {intervals}\n{}{}\n",
        if scenario.unknown.gain { ", gain" } else { "" },
        exact(&scenario.unknown, &result.surroundings_found) + in_library(result),
        neighbours(result),
    )
}
