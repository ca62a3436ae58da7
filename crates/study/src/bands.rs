//! The bands of a scenario: sampled at their centres as in the paper, or integrated.

use hadar::error::{Error, Result};
use hadar::instrument::Camera;
use hadar::material::Material;
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::{Band, Bands};
use hadar::units::Spectral;
use hadar_scenario::{BandSource, Scenario, Source};
use std::borrow::Cow;

/// The bands of a scenario as the paper samples them: at band centres.
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

/// The materials of a scenario before they are sampled.
pub(super) struct Materials<'a> {
    /// All that target and alternatives may be of.
    pub(super) surfaces: &'a [&'a Material],
    /// One per environment object; a blackbody where `None`.
    pub(super) environment: &'a [Option<Cow<'a, Material>>],
}

impl Materials<'_> {
    fn surfaces(&self) -> impl Iterator<Item = &Material> {
        self.surfaces.iter().copied()
    }

    fn all(&self) -> impl Iterator<Item = &Material> {
        self.surfaces().chain(self.environment.iter().flatten().map(AsRef::as_ref))
    }
}

/// The same bands integrating the signals of target and alternatives, where the scenario asks for it.
pub(super) fn integrated(scenario: &Scenario, bands: Bands, materials: &Materials<'_>) -> Result<Bands> {
    if !scenario.bands.integrate {
        return Ok(bands);
    }
    let low = bands.bands().iter().map(|band| band.low_cm1).fold(f64::INFINITY, f64::min);
    let high = bands.bands().iter().map(|band| band.high_cm1).fold(0.0, f64::max);
    let kinks: Vec<f64> = materials.all().flat_map(|material| material.breakpoints_cm1(low, high)).collect();
    let lighting: Vec<f64> = scenario.environment.iter().map(|object| object.lighting).collect();
    bands
        .integrated(&kinks, scenario.bands.tolerance, |nodes| {
            let objects = scenario
                .environment
                .iter()
                .zip(materials.environment)
                .map(|(object, material)| {
                    let emissivity =
                        material.as_ref().map(|material| material.emissivity(nodes)).transpose()?;
                    Ok(EnvironmentObject { temperature_k: object.temperature_k, emissivity })
                })
                .collect::<Result<Vec<_>>>()?;
            let surroundings = Surroundings::new(nodes, objects)?;
            let state = surroundings.state(scenario.target.temperature_k, &lighting)?;
            materials
                .surfaces()
                .map(|material| Ok(surroundings.signal(&material.emissivity(nodes)?, &state)))
                .collect()
        })
        .map_err(|error| error.at(scenario.place("bands.integrate")))
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
