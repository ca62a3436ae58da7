//! The bands of a scenario as they are stated; [`super::integration`] says over which of them spectra are integrated.

use hadar::error::{Error, Result};
use hadar::instrument::{Camera, catalogue};
use hadar::order;
use hadar::spectrum::{Band, Bands, FilterCurve};
use hadar::units::Spectral;
use hadar_scenario::{BandSource, FilterList, FilterPlace, Filters, Scenario, Source};

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
        BandSource::Filters(filters) => return of_filters(filters, source, None),
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

/// Which place in the list that states them each of the bands has, in rising wavenumber; none of a grid, which is no list.
pub(super) fn as_listed(spec: &BandSource) -> Result<Option<Vec<usize>>> {
    let by = |numbers: &[f64]| {
        let mut places: Vec<usize> = (0..numbers.len()).collect();
        order::ascending(&mut places, |place| numbers.get(*place).copied().unwrap_or(f64::NAN));
        Some(places)
    };
    Ok(match spec {
        BandSource::Unsaid | BandSource::Grid { .. } => None,
        BandSource::Rows(path) => by(&hadar_formats::listed_bands(path)?.1),
        BandSource::Filters(filters) => {
            let curves = curves(&filters.list)?;
            let low = |name: &str| {
                let found = curves.iter().find(|curve| curve.name() == name);
                found.map_or(f64::NAN, |curve| curve.range_cm1().0)
            };
            match &filters.names {
                Some(names) => by(&names.iter().map(|name| low(name)).collect::<Vec<_>>()),
                None => by(&curves.iter().map(|curve| curve.range_cm1().0).collect::<Vec<_>>()),
            }
        }
        BandSource::Ranges(ranges) => {
            let edges = |[a, b]: &[Spectral; 2]| (a.wavenumber_cm1(), b.wavenumber_cm1());
            let edges: Vec<(f64, f64)> =
                ranges.iter().map(edges).map(|(a, b)| (a.min(b), a.max(b))).collect();
            let mut places: Vec<usize> = (0..edges.len()).collect();
            // Ranges that begin alike stand by their ends.
            order::ascending(&mut places, |place| edges.get(*place).map_or(f64::NAN, |edges| edges.1));
            order::ascending(&mut places, |place| edges.get(*place).map_or(f64::NAN, |edges| edges.0));
            Some(places)
        }
    })
}

/// The same as a camera sees them: filters before its sensor in the cone of light of its lens, `sine` that of the angle of its rim.
pub(super) fn seen_by(spec: &BandSource, source: &Source, sine: Option<f64>) -> Result<Bands> {
    match spec {
        BandSource::Filters(filters) => of_filters(filters, source, sine),
        _ => at_centres(spec, source),
    }
}

/// Filters of a list, those that are named.
fn of_filters(filters: &Filters, source: &Source, sine: Option<f64>) -> Result<Bands> {
    let place = |key: &str| source.place(&format!("bands.{key}"));
    let mut curves = curves(&filters.list).map_err(|error| match error {
        Error::At { .. } => error,
        error => error.at(place("filters")),
    })?;
    if let Some(names) = &filters.names {
        let named = |name: &String| {
            let found = curves.iter().find(|curve| curve.name() == name).cloned();
            found.ok_or_else(|| {
                let known = curves.iter().map(FilterCurve::name);
                Error::unknown_name("filter", name, known).at(place("names"))
            })
        };
        curves = names.iter().map(named).collect::<Result<_>>()?;
    }
    if let Some(FilterPlace::Sensor { index }) = filters.place {
        let Some(sine) = sine else {
            let found = "filters before a sensor whose lens is not known";
            return Err(Error::malformed(found, "leave place and index out").at(place("place")));
        };
        let in_cone =
            |curve: &FilterCurve| curve.in_cone(index, sine).map_err(|error| error.at(place("index")));
        curves = curves.iter().map(in_cone).collect::<Result<_>>()?;
    }
    Bands::from_filters(curves).map_err(|error| error.at(place("filters")))
}

/// The filters of a list.
pub(super) fn curves(list: &FilterList) -> Result<Vec<FilterCurve>> {
    match list {
        FilterList::File(path) => hadar_formats::filter_curves(path),
        FilterList::Catalogue => catalogue::filters()?.iter().map(catalogue::FilterShape::curve).collect(),
    }
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
