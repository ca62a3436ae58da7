//! The bands that a camera can have: its own, or filters before a camera of one.
//!
//! A camera whose figures were stated for one band becomes a spectral one by filters, which are exposed one after the other.
//! All else is another instrument, with other figures: bands that would take it are refused.

use super::{Warning, camera};
use hadar::error::{Error, Place, Result};
use hadar::instrument::{Camera, Readout};
use hadar::spectrum::{Band, Bands};
use hadar::units::Spectral;
use hadar_scenario::{BandSource, CameraSpec};
use std::borrow::Cow;

/// Filters that a wheel is taken to hold at most where bands are an even grid; more take a word on how they are read.
const WHEEL: usize = 24;
/// Share of the mean width of an instrument's own bands below which a band is finer than it resolves.
const FINEST: f64 = 0.5;

/// What bands are asked for where the scenario may be silent.
pub(super) fn asked(source: &BandSource, camera: Option<(&Camera, &CameraSpec)>) -> BandSource {
    match (source, camera) {
        (BandSource::Unsaid, Some((camera, spec)))
            if camera.spectral_bands == Some(1) && !is_modelled(camera, spec) =>
        {
            BandSource::Ranges(vec![camera.spectral_range_cm1.map(Spectral::Wavenumber)])
        }
        (BandSource::Unsaid, _) => BandSource::papers_grid(),
        (said, _) => said.clone(),
    }
}

/// What the entry of a known camera says; nothing of a camera of one's own.
fn documented(spec: &CameraSpec) -> Cow<'static, CameraSpec> {
    match camera::known(spec).ok().flatten() {
        Some(Cow::Borrowed(known)) => Cow::Borrowed(&known.figures),
        Some(Cow::Owned(known)) => Cow::Owned(known.figures),
        None => Cow::default(),
    }
}

/// Whether the entry of a camera of one band models it as if it read more of them, and the scenario leaves it so.
fn is_modelled(camera: &Camera, spec: &CameraSpec) -> bool {
    let entry = documented(spec);
    camera.readout != Readout::Sequential
        && (entry.spectral_bands, entry.readout) == (camera.spectral_bands, Some(camera.readout))
}

/// Refuses bands that a camera cannot have; a warning where its entry models more than the camera is.
///
/// # Errors
/// More bands than it has, finer ones, or a reading of them that takes another instrument.
pub(super) fn check(
    camera: &Camera,
    spec: &CameraSpec,
    asked: &BandSource,
    bands: &Bands,
    place: &dyn Fn(&str) -> Place,
) -> Result<Option<Warning>> {
    let (Some(own), count) = (camera.spectral_bands, bands.len()) else { return Ok(None) };
    let name = camera::called(camera, spec);
    let documented = documented(spec);
    let refuse =
        |key: &str, found: String, instead: String| Err(Error::malformed(found, instead).at(place(key)));
    if own == 1 && count > 1 && camera.readout != Readout::Sequential {
        let how = camera.readout.name();
        if is_modelled(camera, spec) {
            return Ok(Some(Warning::BandsModelled { camera: name, bands: count, readout: camera.readout }));
        }
        let found = format!("{name} has one band, of which readout = \"{how}\" makes no {count}");
        let instead = format!(
            "write readout = \"sequential\" for filters one after the other; with other optics before it, state \
             spectral_bands = {count} and what these cost"
        );
        return refuse("camera.readout", found, instead);
    }
    let said = spec.readout.is_some() || documented.readout.is_some();
    if own == 1 && count > WHEEL && !said && matches!(asked, BandSource::Grid { .. }) {
        let found = format!("{name} has one band, and a grid asks for {count}");
        let instead = "write the filters before it, as filters = \"my_filters.csv\" or ranges = [[\"8 um\", \"9 um\"], \
                       [\"9 um\", \"10 um\"]]; or camera.readout = \"sequential\" if there is a filter for every band";
        return refuse("bands", found, instead.into());
    }
    if own > 1 && count > own as usize {
        let found = format!("{name} has {own} bands, and {count} are asked for");
        return refuse("bands", found, grid_of(camera, own));
    }
    let [low, high] = camera.spectral_range_cm1;
    let finer = |band: &&Band| {
        // Even in wavenumber or in wavelength, whichever is finer there.
        let (of_all, center) = (1.0 / f64::from(own), band.center_cm1);
        let mean = (high - low).min((1e4 / low - 1e4 / high) * center * center / 1e4) * of_all;
        band.high_cm1 - band.low_cm1 < FINEST * mean
    };
    if own > 1
        && documented.spectral_range_cm1.is_some()
        && let Some(band) = bands.bands().iter().find(finer)
    {
        let found = format!(
            "a band from {:.2} to {:.2} cm^-1 is finer than {name} resolves with {own} bands from {low} to {high} cm^-1",
            band.low_cm1, band.high_cm1
        );
        return refuse("bands", found, grid_of(camera, own));
    }
    Ok(None)
}

/// The grid of so many bands over the range of a camera.
fn grid_of(camera: &Camera, own: u32) -> String {
    let [low, high] = camera.spectral_range_cm1;
    // Rounded up: a grid of the rounded step has no more bands than there are.
    let step = (100.0 * (high - low) / f64::from(own)).ceil() / 100.0;
    let start = low + 0.5 * step;
    format!(
        "write at most {own} of them, e.g. start = \"{start:.2} cm^-1\", stop = \"{:.2} cm^-1\", step = \"{step} cm^-1\"",
        high - 0.5 * step
    )
}
