//! The bands of a scenario as they are stated; [`super::integration`] says over which of them spectra are integrated.

use hadar::error::{Error, Result};
use hadar::instrument::Camera;
use hadar::spectrum::{Band, Bands};
use hadar::units::Spectral;
use hadar_scenario::{BandSource, Scenario, Source};

/// The bands of a scenario as the paper samples them, at band centres; ranges and filters at midpoints 1 cm⁻¹ apart.
pub(super) fn at_centres(spec: &BandSource, source: &Source) -> Result<Bands> {
    let made = match spec {
        BandSource::Unsaid => return at_centres(&BandSource::papers_grid(), source),
        BandSource::Grid { start, stop, step } => match (start, stop, step) {
            (Spectral::Wavelength(start), Spectral::Wavelength(stop), Spectral::Wavelength(step)) => {
                Bands::uniform_wavelength(*start, *stop, *step)
            }
            _ => Bands::uniform(start.number(), stop.number(), step.number()),
        },
        BandSource::Rows(path) => return hadar_formats::bands(path),
        BandSource::Filters(path) => return hadar_formats::filters(path),
        BandSource::Ranges(ranges) => {
            let edges: Vec<(f64, f64)> = ranges
                .iter()
                .map(|[a, b]| (a.wavenumber_cm1(), b.wavenumber_cm1()))
                .map(|(a, b)| (a.min(b), a.max(b)))
                .collect();
            Bands::from_ranges(&edges)
        }
    };
    made.map_err(|error| error.at(source.place("bands")))
}

/// Refuses bands that the detector does not see at all.
///
/// # Errors
/// A filter outside the stated range of the detector, or bands all of which are.
pub(super) fn check_detector(bands: &Bands, camera: &Camera, scenario: &Scenario) -> Result<()> {
    // A grid that reaches beyond the range is only warned of, since that is often stated of something else than the detector.
    let [low, high] = camera.spectral_range_cm1;
    let is_outside = |band: &Band| band.high_cm1 <= low || band.low_cm1 >= high;
    let all = bands.bands().iter().all(is_outside);
    let Some(band) = bands.bands().iter().find(|band| is_outside(band) && (all || band.name.is_some()))
    else {
        return Ok(());
    };
    let which = band.name.as_ref().map_or_else(String::new, |name| format!(" of filter `{name}`"));
    let found = format!(
        "the band{which} from {:.0} to {:.0} cm^-1 lies outside the range of the detector, {low:.0} to {high:.0} cm^-1",
        band.low_cm1, band.high_cm1
    );
    Err(Error::malformed(found, "leave it out, or take another camera").at(scenario.place("bands")))
}
