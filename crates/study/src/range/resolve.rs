//! Names and files of a ranging scenario looked up: camera, bands, scene or cubes.

use super::RangeStudy;
use super::subject::{Depth, Measured, Rendered, Resolved};
use super::watched::Watch;
use crate::cube_bands::{InOrder, Stated, axes_in_doubt};
use crate::cube_outliers::Picture;
use crate::cube_unit::check_counts;
use crate::cube_without::without;
use crate::{bands, camera, camera_bands, stage};
use hadar::cube::{Cube, Shape};
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::instrument::{Camera, Readout, View};
use hadar::material::Library;
use hadar::ranging::depth::StereoGeometry;
use hadar::ranging::noise::NoiseVariance;
use hadar::spectrum::Bands;
use hadar_formats::cube::Opened;
use hadar_scenario::decompose::Bad;
use hadar_scenario::range::{CubeSpec, DepthSource, NoiseSource, Subject};
use hadar_scenario::{RangeScenario, SceneSpec};

impl RangeStudy {
    /// Looks up everything that `scenario` names, materials in `library`, and opens its cubes.
    ///
    /// # Errors
    /// An unknown material or camera, a file that cannot be used, views or noise that do not fit each other; each with file, line
    /// and key.
    pub fn new(scenario: &RangeScenario, library: &Library) -> Result<Self> {
        let source = &scenario.source;
        let camera = scenario.camera.as_ref().map(|spec| camera::resolved(spec, source)).transpose()?;
        let mut scenario = scenario.clone();
        if let Some(spec) = &mut scenario.bands {
            spec.source = camera_bands::asked(&spec.source, camera.as_ref().zip(scenario.camera.as_ref()));
        }
        let asked = scenario.bands.as_ref().map(|spec| &spec.source);
        let bands = asked.map(|asked| bands::at_centres(asked, source)).transpose()?;
        if let (Some(camera), Some(spec), Some(asked), Some(bands)) =
            (&camera, &scenario.camera, asked, &bands)
        {
            camera_bands::check(camera, spec, asked, bands, &|key| scenario.place(key))?;
        }
        let bands = match (&camera, bands) {
            (Some(camera), Some(bands)) => Some(camera.received(&bands)),
            (_, bands) => bands,
        };
        if camera.as_ref().is_some_and(|camera| camera.readout == Readout::FourierTransform) {
            let found =
                "an interferometer mixes all bands in every reading, which the depth bounds do not know";
            let instead = "write readout = \"simultaneous\", or give the cube with its noise_variance";
            return Err(Error::malformed(found, instead).at(scenario.place("camera.readout")));
        }
        let length = |own: Option<f64>, from: Option<f64>| own.or(from).unwrap_or(f64::NAN);
        let stereo = &scenario.stereo;
        let geometry = StereoGeometry::new(
            stereo.baseline_m,
            length(stereo.focal_length_m, camera.as_ref().map(|camera| camera.focal_length_m)),
            length(stereo.pixel_m, camera.as_ref().map(|camera| camera.pixel_m)),
        )
        .map_err(|error| error.at(scenario.place("stereo")))?;
        let subject = match &scenario.subject {
            Subject::Scene(spec) => {
                let (Some(camera), Some(bands)) = (&camera, &bands) else {
                    let found = Error::malformed("a scene without camera", "write [camera]");
                    return Err(found.at(scenario.place("scene")));
                };
                Resolved::Scene(Box::new(scene(spec, &scenario, library, camera, bands)?))
            }
            Subject::Cube(spec) => {
                Resolved::Cube(Box::new(cube(spec, &scenario, camera.as_ref(), bands.as_ref())?))
            }
        };
        Ok(Self { scenario, camera, bands, geometry, subject, looked_up: library.work() })
    }
}

fn scene(
    spec: &SceneSpec,
    scenario: &RangeScenario,
    library: &Library,
    camera: &Camera,
    bands: &Bands,
) -> Result<Rendered> {
    let place = |key: &str| scenario.place(key);
    let staged = stage::staged(spec, bands, library, &place)?;
    let rig = stage::rig(spec, camera, scenario.stereo.baseline_m, bands, &place)?;
    let counting = camera.counting(bands, &View::default());
    let noise = camera_noise(&counting, bands.len());
    Ok(Rendered { scene: staged.scene, rig, options: stage::options(spec), counting, noise })
}

/// The camera's noise in every band.
pub(crate) fn camera_noise(counting: &Counting, bands: usize) -> NoiseVariance {
    let var: Vec<f64> = (0..bands).map(|w| counting.var_added(w)).collect();
    match var.as_slice() {
        [first, rest @ ..] if rest.iter().all(|var| var == first) => match *first {
            0.0 => NoiseVariance::None,
            var => NoiseVariance::Uniform(var),
        },
        _ => NoiseVariance::PerBand(var),
    }
}

fn cube(
    spec: &CubeSpec,
    scenario: &RangeScenario,
    camera: Option<&Camera>,
    bands: Option<&Bands>,
) -> Result<Measured> {
    // An error that names a file has no line of the scenario.
    let at = |key: &'static str| {
        move |error: Error| match &error {
            Error::At { place, .. } if place.path.is_some() => error.for_key(key),
            _ => error.at(scenario.place(key)),
        }
    };
    let asked = scenario.bands.as_ref().map(|spec| &spec.source);
    let stated = asked.map(Stated::of).transpose().map_err(at("bands"))?;
    let listed = stated.as_ref().and_then(|stated| stated.listed.as_deref());
    let by_band = bands.filter(|_| spec.noise.is_none() && camera.is_some());
    let open = |key: &'static str, path: &std::path::Path| {
        let variable = spec.variable.as_deref();
        let opened = InOrder::open(path, variable, spec.axes, listed).and_then(|opened| {
            by_band.map_or(Ok(()), |bands| opened.check(bands))?;
            check_counts(&opened.found, spec.photons_per_unit.is_some())?;
            Ok(Opened { cube: opened.cube, found: opened.found })
        });
        opened.map_err(at(key))
    };
    let Opened { cube: left, found: read } = open("cube.left", &spec.left)?;
    let order_taken = stated.as_ref().filter(|_| by_band.is_some()).and_then(|stated| stated.warning(&read));
    let warnings = axes_in_doubt(&read, bands).into_iter().chain(order_taken).collect();
    let shape = left.shape();
    let right = spec.right.as_deref().map(|path| open("cube.right", path)).transpose()?;
    let right = right.map(|opened| opened.cube);
    if let Some(found) = right.as_ref().map(Cube::shape)
        && found != shape
    {
        let error = Error::malformed(
            format!("the right view has {}, the left one {}", dimensions(found), dimensions(shape)),
            "give two views of one size and the same bands",
        );
        return Err(at("cube.right")(error));
    }
    if let Some(bands) = bands
        && bands.len() != shape.bands()
    {
        let error = Error::malformed(
            format!("[bands] are {}, the cube has {}", bands.len(), shape.bands()),
            "make them those of the cube, or leave [bands] out",
        );
        return Err(at("bands")(error));
    }
    let noise = match (&spec.noise, camera) {
        (Some(NoiseSource::Uniform(0.0)), _) => NoiseVariance::None,
        (Some(NoiseSource::Uniform(var)), _) => NoiseVariance::Uniform(*var),
        (Some(NoiseSource::File(path)), _) => {
            hadar_formats::noise_variance(path, shape, Some(&read.rising_bands(listed)))
                .map_err(at("cube.noise_variance"))?
        }
        (None, Some(camera)) => {
            let Some(bands) = bands else {
                let found = "the camera's noise depends on the bands, which are not given";
                let instead = "write [bands], or noise_variance in [cube]";
                return Err(at("cube.noise_variance")(Error::malformed(found, instead)));
            };
            camera_noise(&camera.counting(bands, &View::default()), bands.len())
        }
        (None, None) => NoiseVariance::None,
    };
    let depth = match &spec.depth {
        None => None,
        Some(DepthSource::Uniform(depth_m)) => Some(Depth::Uniform(*depth_m)),
        Some(DepthSource::File(path)) => {
            let depth = hadar_formats::cube::open(path, None).map_err(at("cube.depth"))?;
            Some(Depth::Map(depth_map(&depth, shape).map_err(at("cube.depth"))?))
        }
    };
    let photons_per_unit = spec.photons_per_unit.unwrap_or(1.0);
    let (mut watches, mut bad) = (Vec::new(), Vec::new());
    let var_added = match &noise {
        NoiseVariance::None | NoiseVariance::PerSample(_) => Vec::new(),
        NoiseVariance::Uniform(var) => vec![*var],
        NoiseVariance::PerBand(var) => var.clone(),
    };
    let picture =
        Picture { counts_per_unit: photons_per_unit, var_added: &var_added, keeps: spec.bad == Bad::Keep };
    // What is dead is seen by the watch, and by nobody else.
    let mut watched = |key: &'static str, view: Cube| {
        let (view, watch) = Watch::over(view);
        watches.push(watch);
        let found = picture.find(&view).map_err(at(key))?;
        let view = without(view, &found.map);
        bad.push(found);
        Ok::<_, Error>(view)
    };
    let left = watched("cube.left", left)?;
    let right = right.map(|right| watched("cube.right", right)).transpose()?;
    Ok(Measured { left, read, warnings, right, watches, noise, photons_per_unit, depth, bad })
}

fn depth_map(depth: &Cube, shape: Shape) -> Result<Vec<f64>> {
    let found = depth.shape();
    if (found.rows(), found.columns(), found.bands()) != (shape.rows(), shape.columns(), 1) {
        return Err(Error::malformed(
            format!("the depths are {}, the view is {}", dimensions(found), dimensions(shape)),
            "give one depth per pixel of the left view",
        ));
    }
    let mut map = Vec::with_capacity(shape.rows() * shape.columns());
    match depth {
        Cube::F32(rows) => {
            map.extend(rows.read(0..shape.rows(), &mut Vec::new())?.iter().map(|z| f64::from(*z)))
        }
        Cube::F64(rows) => map.extend_from_slice(rows.read(0..shape.rows(), &mut Vec::new())?),
    }
    // What is not known, as such maps have it, is not above 0; nothing else is wrong with a depth.
    map.iter_mut().filter(|z| z.is_nan() || **z <= 0.0).for_each(|z| *z = f64::NAN);
    if map.iter().all(|z| z.is_nan()) {
        return Err(Error::malformed("no depth is above 0 m", "give depths in metres"));
    }
    Ok(map)
}

fn dimensions(shape: Shape) -> String {
    format!("{} rows, {} columns, {} bands", shape.rows(), shape.columns(), shape.bands())
}
