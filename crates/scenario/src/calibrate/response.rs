//! A camera behind a filter wheel before blackbodies (`hadar calibrate response`): filters, the response that is sought, the blackbodies,
//! the noise, and a scene with its reference.

use super::super::Source;
use super::super::entries::{Document, Entries};
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::paths::{Paths, file};
use super::super::reader::file;
use super::super::section::{Entry, Section};
use super::blackbodies::{BlackbodySpec, CubeFile, blackbodies, noise};
use hadar::calibration::determined::CurveSmoothness;
use hadar::error::{Error, Result};
use hadar::units::Dimension;
use std::path::PathBuf;

const MINIMUM: &str = "write [response] with filters = \"filters.csv\", [[blackbody]] twice with temperature = \"35 degC\" and data = \"35.npy\", and \
                       [noise] with sample = 1.5";
/// The paper's values.
const START_CM1: f64 = 595.0;
const STOP_CM1: f64 = 1340.0;
const VALUES: u32 = 30;
/// A scale that is free, a shape that is not.
const KNOWN: CurveSmoothness = CurveSmoothness { scale: 0.5, shape: 0.15, correlation_cm1: 100.0 };
/// Rows and columns about the centre on each side of it.
const HALF: u32 = 10;

/// Everything that the file says.
#[derive(Debug, Clone)]
pub struct ResponseScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// The response that is to be estimated (`[response]`).
    pub response: ResponseSpec,
    /// The blackbodies that were recorded (`[[blackbody]]`).
    pub blackbodies: Vec<BlackbodySpec>,
    /// Deviation of one sample, in the unit of the cubes (`[noise] sample`).
    pub noise: f64,
    /// The cube to be calibrated (`[scene]`).
    pub scene: Option<SceneSpec>,
    /// Where it was read from.
    pub source: Source,
}

/// The response that is sought (`[response]`). Paths are absolute.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseSpec {
    /// Transmittances, a column a filter, in the order of the cubes' bands.
    pub filters: PathBuf,
    /// First and last wavenumber of its values, cm⁻¹.
    pub range_cm1: [f64; 2],
    /// How many values.
    pub values: usize,
    /// The typical curve, in any unit; level where none is given.
    pub typical: Option<PathBuf>,
    /// Relative deviation of the scale of the whole curve.
    pub scale_error: Option<f64>,
    /// Deviation of its shape, of the peak.
    pub shape_error: Option<f64>,
    /// Difference of wavenumbers at which the correlation of the shape has fallen to a quarter, cm⁻¹.
    pub correlation_cm1: Option<f64>,
    /// Rows and columns about the centre, on each side, whose mean is a reading.
    pub centre_half: usize,
}

impl ResponseSpec {
    /// What is known beforehand, as it is reckoned with.
    #[must_use]
    pub fn known(&self) -> CurveSmoothness {
        CurveSmoothness {
            scale: self.scale_error.unwrap_or(KNOWN.scale),
            shape: self.shape_error.unwrap_or(KNOWN.shape),
            correlation_cm1: self.correlation_cm1.unwrap_or(KNOWN.correlation_cm1),
        }
    }
}

/// A scene, and the reference that is taken off (`[scene]`).
#[derive(Debug, Clone, PartialEq)]
pub struct SceneSpec {
    /// The cube.
    pub data: CubeFile,
    /// The cube of the reference.
    pub reference: PathBuf,
    /// Temperature of the reference, K.
    pub reference_k: f64,
    /// Deviation of that temperature, K.
    pub reference_error_k: f64,
}

file!(ResponseScenario, source, (Kind::Calibrate, MINIMUM, &files::RESPONSE));

impl ResponseScenario {
    fn of_root(root: &Section<'_>) -> Result<Self> {
        Ok(Self {
            title: root.title("\"Response of the camera\"")?,
            response: response(&root.table("response", MINIMUM)?)?,
            blackbodies: blackbodies(root)?,
            noise: noise(root)?,
            scene: root.read("scene", scene)?,
            source: Source::default(),
        })
    }

    fn document(&self, paths: Paths<'_>) -> Document {
        let (spec, nu) = (&self.response, Dimension::Wavenumber);
        let written = Entries::default()
            .put("filters", paths.file(&spec.filters))
            .put_quantity("start", nu, Some(spec.range_cm1[0]))
            .put_quantity("stop", nu, Some(spec.range_cm1[1]))
            .put("values", spec.values as i64)
            .put_if("typical", spec.typical.as_ref().map(|path| paths.file(path)))
            .put_if("scale_error", spec.scale_error)
            .put_if("shape_error", spec.shape_error)
            .put_quantity("correlation", nu, spec.correlation_cm1)
            .put("centre_half", spec.centre_half as i64);
        let scene = |scene: &SceneSpec| {
            let (kelvin, error) = (Some(scene.reference_k), Some(scene.reference_error_k));
            let written = scene.data.written(paths).put("reference", paths.file(&scene.reference));
            written.put_quantity("reference_temperature", Dimension::Temperature, kelvin).put_quantity(
                "reference_uncertainty",
                Dimension::TemperatureDifference,
                error,
            )
        };
        Document::titled(self.title.as_ref())
            .put("response", written)
            .put("blackbody", self.blackbodies.iter().map(|spec| spec.written(paths)).collect::<Vec<_>>())
            .put("noise", Entries::default().put("sample", self.noise))
            .put_if("scene", self.scene.as_ref().map(scene))
    }
}

fn response(entry: &Entry<'_>) -> Result<ResponseSpec> {
    let section = entry.section()?;
    let nu = |key: &str| section.quantity(key);
    let range_cm1 = [nu("start")?.unwrap_or(START_CM1), nu("stop")?.unwrap_or(STOP_CM1)];
    if range_cm1[0] >= range_cm1[1] {
        let found = format!("values from {} to {} cm^-1", range_cm1[0], range_cm1[1]);
        let error = Error::malformed(found, "write start = \"595 cm^-1\" and stop = \"1340 cm^-1\"");
        return Err(section.fail("stop", error));
    }
    let values = section.read("values", |entry| entry.count("30"))?.unwrap_or(VALUES);
    Ok(ResponseSpec {
        filters: file(&section.require("filters")?)?,
        range_cm1,
        values: values as usize,
        typical: section.read("typical", file)?,
        scale_error: section.number("scale_error")?,
        shape_error: section.number("shape_error")?,
        correlation_cm1: nu("correlation")?,
        centre_half: section.read("centre_half", |entry| entry.count("10"))?.unwrap_or(HALF) as usize,
    })
}

fn scene(entry: &Entry<'_>) -> Result<SceneSpec> {
    let section = entry.section()?;
    let reference_k = section.require("reference_temperature")?;
    Ok(SceneSpec {
        data: CubeFile::read(&section)?,
        reference: file(&section.require("reference")?)?,
        reference_k: reference_k.quantity()?,
        reference_error_k: section.quantity("reference_uncertainty")?.unwrap_or(0.0),
    })
}
