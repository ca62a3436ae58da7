//! Whether the samples of a cube are what is expected of them, by the unit that its file states.

use hadar::cube::{Found, SampleUnit};
use hadar::error::{Error, Result};

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

fn no_light(unit: &str) -> Error {
    Error::malformed(
        format!("the samples are `{unit}` by their file, of which no factor makes photons"),
        "give the counts or radiances that they were made of, or mend the unit in the file",
    )
}
