//! A cube without its stripes.

use super::opened::Measured;
use super::whole::check_memory;
use crate::Warning;
use hadar::cube::{Cube, Ordered, Rows, Sample, Shape};
use hadar::demand::{Thing, Work};
use hadar::error::{Error, Result};
use hadar_estimate::calibrate::{Destriped, Why, find_stripes};
use hadar_formats::cube::Found;
use hadar_scenario::calibrate::StripesScenario;
use serde::Serialize;

/// Bands from which on a thin object is told from a stripe.
const TELLING: usize = 4;

/// A cube that is open.
#[derive(Debug)]
pub struct StripesStudy {
    scenario: StripesScenario,
    cube: Cube,
    read: Found,
    /// The bands that are looked at.
    good: Vec<usize>,
    warnings: Vec<Warning>,
}

/// Samples of either kind.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// Of 32 bits.
    F32(Vec<f32>),
    /// Of 64 bits.
    F64(Vec<f64>),
}

/// A destriped cube.
#[derive(Debug, Clone, Serialize)]
pub struct StripesFound {
    /// The question as it was asked, defaults filled in.
    pub scenario: StripesScenario,
    /// What the file was read as.
    pub read: Found,
    /// Numbers of rows, columns and bands of the cube.
    pub shape: Shape,
    /// Striped lines, counted in every band.
    pub striped: usize,
    /// Root mean square of how far they were off, over the level of their band.
    pub off_relative: f64,
    /// Root mean square of the errors that are left, over the level of their band.
    pub left_relative: f64,
    /// The stripes.
    #[serde(flatten)]
    pub destriped: Destriped,
    /// What was done and what was spared.
    pub stats: Work,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// The cube before, one band of it.
    #[serde(skip)]
    pub before: Vec<f64>,
    /// Which band that is: the one of the most stripes.
    pub shown_band: usize,
    /// The cube without its stripes.
    #[serde(skip)]
    pub corrected: Samples,
}

impl StripesStudy {
    /// Opens the cube.
    ///
    /// # Errors
    /// A file that cannot be used, with file, line and key.
    pub fn new(scenario: &StripesScenario) -> Result<Self> {
        let opened = Measured::open(&scenario.cube, &scenario.source)?;
        let warnings = opened.warnings();
        let several = || Error::malformed("several cubes", "give one");
        let [cube] = <[Cube; 1]>::try_from(opened.cubes).map_err(|_| several())?;
        let [read] = <[Found; 1]>::try_from(opened.read).map_err(|_| several())?;
        Ok(Self { cube, read, good: opened.good, warnings, scenario: scenario.clone() })
    }

    fn found<S: Sample>(&self, cube: &dyn Rows<S>) -> Result<Destriped> {
        let bands = cube.shape().bands();
        if self.good.len() == bands {
            return find_stripes(cube, &self.scenario.stripes);
        }
        let good: &dyn Rows<S> = &Ordered::new(cube, self.good.clone())?;
        Ok(find_stripes(good, &self.scenario.stripes)?.among(&self.good, bands))
    }

    /// The cube without its stripes.
    ///
    /// # Errors
    /// A cube in which stripes cannot be told from the scene, each with what to give instead.
    pub fn destripe(&self) -> Result<StripesFound> {
        let place = |error: Error| match (&error, &self.scenario.source.path, self.scenario.cube.data.first())
        {
            (Error::At { place, .. }, ..) if place.path.is_some() => error,
            (_, Some(_), _) => error.at(self.scenario.source.place("cube.data")),
            (_, None, Some(path)) => error.in_file(path),
            _ => error,
        };
        // The samples without their stripes, once more in the file of the report.
        let bytes = if matches!(self.cube, Cube::F32(_)) { 8 } else { 16 };
        check_memory(self.cube.shape(), bytes, "the cube without its stripes").map_err(place)?;
        let sought = &self.scenario.stripes;
        let destriped = match &self.cube {
            Cube::F32(cube) => self.found(cube.as_ref()),
            Cube::F64(cube) => self.found(cube.as_ref()),
        }
        .map_err(place)?;
        let corrected = match &self.cube {
            Cube::F32(cube) => destriped.corrected(cube.as_ref()).map(Samples::F32),
            Cube::F64(cube) => destriped.corrected(cube.as_ref()).map(Samples::F64),
        }?;
        let shape = self.cube.shape();
        let mut of_band = vec![0_usize; shape.bands()];
        destriped.stripes.iter().for_each(|stripe| of_band[stripe.band] += 1);
        let shown_band =
            (0..shape.bands()).max_by_key(|band| (of_band[*band], shape.bands() - band)).unwrap_or(0);
        let before = match &self.cube {
            Cube::F32(cube) => band_of(cube.as_ref(), shown_band),
            Cube::F64(cube) => band_of(cube.as_ref(), shown_band),
        }?;
        let count = destriped.stripes.len();
        let rms = |value: &dyn Fn(&hadar_estimate::calibrate::Stripe) -> f64| {
            let square = |stripe: &hadar_estimate::calibrate::Stripe| {
                let level = destriped.levels.get(stripe.band).copied().unwrap_or(f64::NAN);
                (value(stripe) / level).powi(2)
            };
            (destriped.stripes.iter().map(square).sum::<f64>() / count.max(1) as f64).sqrt()
        };
        let (off_relative, left_relative) = (rms(&|stripe| stripe.off), rms(&|stripe| stripe.sigma));
        let mut warnings = self.warnings.clone();
        if !destriped.left.is_empty() {
            warnings
                .push(Warning::LinesLikeObjects { axis: sought.axis.name(), lines: destriped.left.clone() });
        }
        warnings.extend(differing(&destriped));
        let axis = sought.axis.name();
        let kept = |why: Why| -> Vec<[usize; 2]> {
            let own = destriped.kept.iter().filter(|kept| kept.why == why);
            own.map(|kept| [kept.line, kept.band]).collect()
        };
        for why in [
            Why::InPart,
            Why::NeighbouringBands,
            Why::BesideStep,
            Why::WithoutReference,
            Why::Dead,
            Why::Missing,
        ] {
            let lines = kept(why);
            if lines.is_empty() {
                continue;
            }
            warnings.push(match why {
                Why::InPart => Warning::LinesOffInPart { axis, lines },
                Why::NeighbouringBands => Warning::LinesOffBeside { axis, lines },
                Why::BesideStep => Warning::LinesBesideSteps { axis, lines },
                Why::Dead => Warning::LinesDead { axis, lines },
                Why::WithoutReference => Warning::LinesWithoutReference { axis, lines },
                Why::Missing => Warning::LinesMissing { axis, lines },
            });
        }
        if sought.in_all_bands {
            let bands = |line: usize| destriped.stripes.iter().filter(|one| one.line == line).count();
            let lines: Vec<usize> =
                (0..destriped.lines).filter(|line| 2 * bands(*line) > shape.bands()).collect();
            if !lines.is_empty() && shape.bands() >= TELLING {
                warnings.push(Warning::StripesInAllBands { axis, lines });
            }
        }
        if shape.bands() < TELLING && count > 0 {
            warnings.push(Warning::StripesOfFewBands { bands: shape.bands() });
        }
        let mut stats = Work::default();
        stats.compute(Thing::Samples, shape.len() as u64);
        Ok(StripesFound {
            scenario: self.scenario.clone(),
            read: self.read.clone(),
            shape,
            striped: count,
            off_relative,
            left_relative,
            destriped,
            stats,
            warnings,
            before,
            shown_band,
            corrected,
        })
    }
}

/// Bands whose lines differ from those beside them beyond noise.
fn differing(destriped: &Destriped) -> Option<Warning> {
    let apart = destriped.apart.iter().enumerate().filter_map(|(band, one)| Some((band, (*one)?)));
    let differ: Vec<_> = apart.filter(|(_, one)| one.lines > 0.0).collect();
    let (_, worst) = differ.iter().max_by(|a, b| a.1.lines.total_cmp(&b.1.lines))?;
    Some(Warning::LinesDiffer {
        axis: destriped.axis.name(),
        bands: differ.iter().map(|(band, _)| *band).collect(),
        of: destriped.bands,
        apart: worst.lines,
        noise: worst.noise,
    })
}

fn band_of<S: Sample>(cube: &dyn Rows<S>, band: usize) -> Result<Vec<f64>> {
    let shape = cube.shape();
    let (mut values, mut buffer) = (Vec::with_capacity(shape.rows() * shape.columns()), Vec::new());
    for row in 0..shape.rows() {
        let samples = cube.read(row..row + 1, &mut buffer)?;
        values.extend(samples.iter().skip(band).step_by(shape.bands()).map(|sample| (*sample).into()));
    }
    Ok(values)
}

impl StripesFound {
    /// The shown band without its stripes.
    #[must_use]
    pub fn after(&self) -> Vec<f64> {
        let bands = self.shape.bands();
        match &self.corrected {
            Samples::F32(all) => {
                all.iter().skip(self.shown_band).step_by(bands).map(|x| f64::from(*x)).collect()
            }
            Samples::F64(all) => all.iter().skip(self.shown_band).step_by(bands).copied().collect(),
        }
    }
}
