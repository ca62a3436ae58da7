//! Whether the samples of a cube are what is expected of them, by the unit that its file states.

use hadar::error::{Error, Result};
use hadar::radiance_unit::RadianceUnit;
use hadar_formats::cube::{Found, SampleUnit, TemperatureUnit};
use hadar_scenario::decompose::CubeUnit;

/// Refuses samples that are no counts by their file. What is in proportion to counts is taken where `scale_is_said`: how many counts a
/// unit of the file stands for.
///
/// # Errors
/// Temperatures and shares, of which no factor makes counts; another unit without a scale.
pub(super) fn check_counts(found: &Found, scale_is_said: bool) -> Result<()> {
    let Some(unit) = &found.unit else { return Ok(()) };
    match SampleUnit::spelt(unit) {
        SampleUnit::Counts => Ok(()),
        SampleUnit::Temperature | SampleUnit::Share => Err(no_light(unit)),
        SampleUnit::Other if scale_is_said => Ok(()),
        SampleUnit::Other => Err(Error::malformed(
            format!("the samples are in `{unit}` by their file, not in photons"),
            "give photon counts, or write photons_per_unit = 250.0, the photons that a sample of 1 stands for in every band",
        )),
    }
}

/// Refuses samples that are not in proportion to light by their file.
///
/// # Errors
/// Temperatures and shares.
pub(super) fn check_light(found: &Found) -> Result<()> {
    match &found.unit {
        Some(unit) if matches!(SampleUnit::spelt(unit), SampleUnit::Temperature | SampleUnit::Share) => {
            Err(no_light(unit))
        }
        _ => Ok(()),
    }
}

/// The unit of a cube's samples by its file, where that is another than the scenario's; spectral radiances alone are converted.
///
/// # Errors
/// A file whose samples are something else than the scenario says.
pub(super) fn of_file(found: &Found, said: &CubeUnit) -> Result<Option<RadianceUnit>> {
    let Some(of_file) = &found.unit else { return Ok(None) };
    if let CubeUnit::BrightnessTemperature { written, .. } = said {
        // As temperatures they are in their file's unit.
        let is_other = temperature(found).is_none() && !SampleUnit::says_nothing(of_file);
        return if is_other { Err(another(of_file, written)) } else { Ok(None) };
    }
    let says_nothing = SampleUnit::says_nothing(without_name(of_file));
    let (other, radiance) = (SampleUnit::spelt(of_file), RadianceUnit::spelt(without_name(of_file)));
    match (said, radiance) {
        (CubeUnit::Radiance { unit, .. }, Ok(own)) => Ok((!own.is(*unit)).then_some(own)),
        (CubeUnit::Radiance { .. }, Err(_)) if says_nothing => Ok(None),
        // What is not known is no other unit.
        (CubeUnit::Radiance { .. }, Err(Error::Malformed { found, .. })) if other == SampleUnit::Other => {
            Err(Error::malformed(
                format!("the unit of the samples by their file: {found}"),
                "write it into the file as in \"W m^-2 sr^-1 um^-1\", or leave it out of the file if the scenario's is right",
            ))
        }
        (CubeUnit::Radiance { written, .. }, Err(_)) => Err(another(of_file, written)),
        (_, Ok(_)) => Err(Error::malformed(
            format!("the samples are radiances by their file, in `{of_file}`, and counts by the scenario"),
            format!("write unit = \"{of_file}\" and noise, the deviation of a sample in that unit"),
        )),
        // Digital numbers have another noise than the photons they stand for.
        (CubeUnit::Camera, Err(_)) if other == SampleUnit::Other => Err(Error::malformed(
            format!(
                "the samples are in `{of_file}` by their file, and photons that the camera counts by the scenario"
            ),
            "give photoelectrons, or radiances with unit and noise; or write counts_per_photon_radiance if the samples are counts whose variance is their number",
        )),
        (_, Err(_)) => Ok(None),
    }
}

/// The unit of temperatures that a file states.
pub(super) fn temperature(found: &Found) -> Option<TemperatureUnit> {
    found.unit.as_deref().and_then(TemperatureUnit::spelt)
}

fn another(of_file: &str, written: &str) -> Error {
    Error::malformed(
        format!("the samples are in `{of_file}` by their file, and in `{written}` by the scenario"),
        "mend the one that is wrong, or name another array of the file as the variable; of a file that states no unit that of the scenario is taken",
    )
}

/// What is behind `Radiance`, as files write it before a unit or in its place.
fn without_name(unit: &str) -> &str {
    let mut rest = unit.trim();
    for name in ["spectral ", "radiance"] {
        let head = rest.get(..name.len()).unwrap_or_default();
        if head.eq_ignore_ascii_case(name) {
            rest = rest.get(name.len()..).unwrap_or_default().trim_start();
        }
    }
    rest
}

fn no_light(unit: &str) -> Error {
    Error::malformed(
        format!("the samples are `{unit}` by their file, of which no factor makes photons"),
        "give the counts or radiances that they were made of, or mend the unit in the file",
    )
}
