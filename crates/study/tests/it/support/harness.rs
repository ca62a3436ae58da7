//! What must hold for whatever bytes a user's file has: one function per reader, shared by the targets in `fuzz/` and the
//! module `fuzz_readers` of these tests.
//!
//! Every reader is given the bytes as a file, the way a user gives them. It must not panic. What it accepts must be
//! sound: numbers finite and within their range, names on one line, text that is written again read as the same. What it
//! refuses, it must refuse in one short line. Time and memory are watched by whoever runs this.

use hadar::Error;
use hadar::cube::{Cube, Rows, Sample, Shape, first_invalid, panchromatic};
use hadar::material::{Library, Material};
use hadar::ranging::noise::NoiseVariance;
use hadar::spectrum::Bands;
use hadar::units::{Dimension, Spectral};
use hadar_formats::ReadLibrary as _;
use hadar_formats::cube::Axes;
use hadar_scenario::{AirRangingScenario, RangeScenario, RangingScenario, Scenario};
use hadar_simulate::classifier::{Classifier, SavedModel};
use std::path::{Path, PathBuf};

/// A reader of files, by the name of its target and of its folder of seeds.
pub(crate) struct Reader {
    pub name: &'static str,
    check: fn(&Folder, &[u8]),
}

/// All of them.
pub(crate) const READERS: &[Reader] = &[
    Reader { name: "material", check: material },
    Reader { name: "library", check: library },
    Reader { name: "manifest", check: manifest },
    Reader { name: "optical_constants", check: optical_constants },
    Reader { name: "spectral_library", check: spectral_library },
    Reader { name: "band_rows", check: band_rows },
    Reader { name: "filters", check: filters },
    Reader { name: "scenario", check: scenario },
    Reader { name: "range_scenario", check: range_scenario },
    Reader { name: "quantity", check: quantity },
    Reader { name: "npy", check: npy },
    Reader { name: "mat", check: mat },
    Reader { name: "npz", check: npz },
    Reader { name: "envi", check: envi },
    Reader { name: "hdf5", check: hdf5 },
    Reader { name: "cube", check: cube },
    Reader { name: "noise", check: noise },
    Reader { name: "model", check: model },
];

/// Characters that no message needs more of, the place included.
const LONGEST_MESSAGE: usize = 1800;
/// Samples of a cube that are looked at.
const MOST_SAMPLES: usize = 1 << 22;

impl Reader {
    /// Checks one file's worth of bytes.
    ///
    /// # Panics
    /// Where the reader does not do what it should.
    pub(crate) fn check(&self, bytes: &[u8]) {
        thread_local!(static FOLDER: Folder = Folder::new());
        FOLDER.with(|folder| (self.check)(folder, bytes));
    }
}

/// Where the bytes are put; in memory where the system has such a place.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let memory = Path::new("/dev/shm");
        let made = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
        let folder = Self(made.expect("a temporary folder"));
        for kind in ["library", "manifest", "constants"] {
            std::fs::create_dir(folder.path(kind)).expect("a folder in it");
        }
        folder.put("library/neighbour.csv", b"wavenumber_cm1,roof,wall\n500,0.5,0.25\n2000,0.75,1\n");
        folder.put("manifest/nk.csv", b"wavelength_um,n,k\n5,1.5,0\n10,2.5,0.125\n20,10,60\n");
        folder.put("manifest/e.csv", b"wavenumber_cm1,emissivity\n500,0.5\n2000,0.75\n");
        folder.put(
            "constants/manifest.toml",
            b"version = 1\n[[material]]\nname = \"a\"\nmodel = { half-space = { nk = \"nk.csv\" } }\n\
              [[material]]\nname = \"b\"\nmodel = { slab = { medium = { nk = \"nk.csv\" }, thickness_um = 3.0 } }\n",
        );
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn put(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, bytes).expect("a file in a temporary folder");
        path
    }
}

/// What was read, if the refusal is worth reading.
fn accepted<T>(read: hadar::Result<T>) -> Option<T> {
    read.map_err(|error| refusal(&error)).ok()
}

fn refusal(error: &Error) {
    let message = error.to_string();
    one_line(&message);
    assert!(message.chars().count() < LONGEST_MESSAGE, "a message of {} bytes: {message}", message.len());
}

fn one_line(text: &str) {
    assert!(!text.trim().is_empty(), "there is no text");
    assert!(!text.contains(char::is_control), "more than a line: {text:?}");
}

fn sound(material: &Material) {
    one_line(material.name());
    let provenance = material.provenance();
    for text in [&provenance.description, &provenance.source, &provenance.note, &provenance.licence] {
        assert!(!text.contains(char::is_control), "more than a line: {text:?}");
    }
    material.warnings().iter().for_each(|warning| one_line(warning));
    let mut wavenumbers = vec![1e-3, 500.0, 800.0, 1000.0, 1250.0, 2000.0, 1e5];
    if let Some((low, high)) = material.range_cm1() {
        assert!(0.0 < low && low < high && high < f64::INFINITY, "from {low} to {high}");
        wavenumbers.extend([low, high, 0.5 * low + 0.5 * high]);
        wavenumbers.extend(material.breakpoints_cm1(low, high).iter().take(50));
    }
    for wavenumber in wavenumbers {
        if let Some(emissivity) = accepted(material.emissivity(&[wavenumber])) {
            assert!((0.0..=1.0).contains(&emissivity[0]), "{emissivity:?} at {wavenumber}");
        }
    }
}

fn material(folder: &Folder, bytes: &[u8]) {
    sound_materials(&folder.put("a.csv", bytes));
}

/// The header of a spectral library of two spectra in eleven channels.
fn spectral_library(folder: &Folder, bytes: &[u8]) {
    let samples: Vec<u8> = (0..22_u8).flat_map(|i| (f32::from(i) / 32.0).to_le_bytes()).collect();
    folder.put("spectra.sli", &samples);
    sound_materials(&folder.put("spectra.hdr", bytes));
}

fn sound_materials(path: &Path) {
    let Some(materials) = accepted(hadar_formats::spectra::from_file(path)) else { return };
    assert!(!materials.is_empty());
    for (index, material) in materials.iter().take(100).enumerate() {
        sound(material);
        assert!(material.range_cm1().is_some() && material.rows() >= 2);
        assert!(materials[..index].iter().all(|other| other.name() != material.name()));
    }
}

/// All materials of a library that was made of a folder.
fn sound_library(folder: &Path) {
    let mut library = Library::empty();
    if accepted(library.add_path(folder)).is_none() {
        return;
    }
    library.warnings().iter().for_each(|warning| one_line(warning));
    for name in library.names().take(100) {
        sound(library.get(name).expect("a name of the library"));
    }
}

fn library(folder: &Folder, bytes: &[u8]) {
    folder.put("library/a.txt", bytes);
    sound_library(&folder.path("library"));
}

fn manifest(folder: &Folder, bytes: &[u8]) {
    folder.put("manifest/manifest.toml", bytes);
    sound_library(&folder.path("manifest"));
}

fn optical_constants(folder: &Folder, bytes: &[u8]) {
    folder.put("constants/nk.csv", bytes);
    sound_library(&folder.path("constants"));
}

fn sound_bands(bands: &Bands) {
    assert!(!bands.is_empty());
    let positive = |value: f64| value > 0.0 && value < f64::INFINITY;
    for band in bands.bands() {
        let (low, high) = (band.low_cm1, band.high_cm1);
        assert!(low.is_finite() && positive(high) && low <= high, "{band:?}");
        assert!(low <= band.center_cm1 && band.center_cm1 <= high, "{band:?}");
    }
    assert!(bands.nodes_cm1().iter().all(|&node| positive(node)));
    assert!(bands.widths_cm1().iter().all(|&width| positive(width)), "{:?}", bands.widths_cm1());
}

fn band_rows(folder: &Folder, bytes: &[u8]) {
    if let Some(bands) = accepted(hadar_formats::bands(&folder.put("bands.csv", bytes))) {
        sound_bands(&bands);
    }
}

fn filters(folder: &Folder, bytes: &[u8]) {
    if let Some(bands) = accepted(hadar_formats::filters(&folder.put("filters.csv", bytes))) {
        sound_bands(&bands);
    }
}

fn scenario(folder: &Folder, bytes: &[u8]) {
    let path = folder.put("scenario.toml", bytes);
    let Some(scenario) = accepted(Scenario::from_file(&path)) else { return };
    let kelvins = scenario.environment.iter().map(|object| object.temperature_k);
    let kelvins = kelvins.chain([scenario.target.temperature_k]);
    assert!(kelvins.into_iter().all(|kelvin| kelvin > 0.0 && kelvin.is_finite()));
    let lighting: f64 = scenario.environment.iter().map(|object| object.lighting).sum();
    assert!((0.0..=1.0 + 1e-9).contains(&lighting), "lighting {lighting}");
    let text = scenario.to_toml();
    match Scenario::from_toml(&text, Some(&path)) {
        Ok(again) => assert!(again == scenario, "{again:?}\nis not\n{scenario:?}\n{text}"),
        Err(error) => panic!("{error}\n{text}"),
    }
}

fn air_ranging_scenario(scenario: &AirRangingScenario, path: &Path) {
    let text = scenario.to_toml();
    match AirRangingScenario::from_toml(&text, Some(path)) {
        Ok(again) => assert_eq!(&again, scenario, "{text}"),
        Err(error) => panic!("{error}\n{text}"),
    }
}

fn range_scenario(folder: &Folder, bytes: &[u8]) {
    let path = folder.put("range.toml", bytes);
    let scenario = match accepted(RangingScenario::from_file(&path)) {
        Some(RangingScenario::Stereo(scenario)) => scenario,
        Some(RangingScenario::Air(scenario)) => return air_ranging_scenario(&scenario, &path),
        None => return,
    };
    let text = scenario.to_toml();
    let again = match RangeScenario::from_toml(&text, Some(&path)) {
        Ok(again) => again,
        Err(error) => panic!("{error}\n{text}"),
    };
    let same = again.title == scenario.title
        // A file of another folder that stood there with its whole path has its name alone.
        && (again.subject == scenario.subject || again.to_toml() == text)
        && again.bands == scenario.bands
        && again.camera == scenario.camera
        && again.stereo == scenario.stereo
        && again.requirement == scenario.requirement;
    assert!(same, "{again:?}\nis not\n{scenario:?}\n{text}");
}

/// A line per quantity.
fn quantity(_: &Folder, bytes: &[u8]) {
    for text in String::from_utf8_lossy(bytes).lines().take(100) {
        for dimension in [
            Dimension::Temperature,
            Dimension::TemperatureDifference,
            Dimension::Length,
            Dimension::Time,
            Dimension::Speed,
            Dimension::Angle,
            Dimension::Detectivity,
            Dimension::Wavenumber,
            Dimension::Wavelength,
        ] {
            if let Some(value) = accepted(dimension.parse(text)) {
                assert!(value.is_finite(), "{text} is {value}");
                assert_eq!(dimension.parse(&dimension.format(value)), Ok(value));
            }
        }
        if let Some(value) = accepted(Spectral::parse(text)) {
            assert!(value.number().is_finite(), "{text} is {value:?}");
            assert_eq!(Spectral::parse(&value.format()), Ok(value));
        }
    }
}

/// Reads a cube whole, twice: in one piece and row by row.
fn sound_cube(cube: &Cube) {
    match cube {
        Cube::F32(cube) => sound_rows(cube.as_ref()),
        Cube::F64(cube) => sound_rows(cube.as_ref()),
    }
}

fn sound_rows<S: Sample>(cube: &dyn Rows<S>) {
    let shape = cube.shape();
    if shape.len() > MOST_SAMPLES {
        return;
    }
    let (mut whole, mut part) = (Vec::new(), Vec::new());
    let Some(samples) = accepted(cube.read(0..shape.rows(), &mut whole)) else { return };
    assert_eq!(samples.len(), shape.len());
    for row in [0, shape.rows() - 1] {
        let alone = cube.read(row..row + 1, &mut part).expect("a row of the cube");
        let same = alone.iter().zip(&samples[row * shape.row_len()..]).all(|(&a, &b)| {
            let (a, b): (f64, f64) = (a.into(), b.into());
            a.to_bits() == b.to_bits()
        });
        assert!(alone.len() == shape.row_len() && same);
    }
    refusal(&cube.read(shape.rows()..shape.rows() + 1, &mut part).expect_err("there is no such row"));
    if let Some(error) = first_invalid(samples, 0, shape) {
        refusal(&error);
    }
}

fn npy(folder: &Folder, bytes: &[u8]) {
    let path = folder.put("a.npy", bytes);
    for variable in [None, Some("S")] {
        let Some(cube) = accepted(hadar_formats::cube::open(&path, variable)) else { continue };
        // Samples are not compressed, so that there cannot be more of them than bytes.
        assert!(cube.shape().len() < bytes.len() || !bytes.starts_with(b"\x93NUMPY"));
        sound_cube(&cube);
        if let (Cube::F32(_), true) = (&cube, cube.shape().len() < MOST_SAMPLES) {
            let added = accepted(panchromatic(&cube));
            assert!(added.is_none_or(|sum| sum.shape().bands() == 1));
        }
    }
}

fn mat(folder: &Folder, bytes: &[u8]) {
    let path = folder.put("a.mat", bytes);
    for variable in [None, Some("S")] {
        if let Some(cube) = accepted(hadar_formats::cube::open(&path, variable)) {
            sound_cube(&cube);
        }
    }
}

/// A file that is told by its first bytes, with its axes in two orders and an array by name.
fn arrays(folder: &Folder, name: &str, bytes: &[u8]) {
    let path = folder.put(name, bytes);
    let images = Axes::named("bands,rows,columns").expect("three axes");
    for (variable, axes) in
        [(None, None), (Some("S"), None), (None, Some(images)), (Some("night/images"), Some(images))]
    {
        if let Some(opened) = accepted(hadar_formats::cube::open_as(&path, variable, axes)) {
            one_line(&opened.found.to_string());
            assert_eq!(opened.found.shape, opened.cube.shape());
            sound_cube(&opened.cube);
        }
    }
}

fn npz(folder: &Folder, bytes: &[u8]) {
    arrays(folder, "a.npz", bytes);
}

/// Files of other fields and of cameras.
fn cube(folder: &Folder, bytes: &[u8]) {
    arrays(folder, "a.bin", bytes);
    let path = folder.put("a.bin", bytes);
    for name in ["fixed", "SCENE", "1", "temperature", "signal[1]"] {
        if let Some(opened) = accepted(hadar_formats::cube::open_as(&path, Some(name), None)) {
            sound_cube(&opened.cube);
        }
    }
}

fn hdf5(folder: &Folder, bytes: &[u8]) {
    arrays(folder, "a.h5", bytes);
}

/// A header, beside data of 240 bytes: 3 x 4 x 5 samples of 32 bits, and what else there is of that size.
fn envi(folder: &Folder, bytes: &[u8]) {
    folder.put("a.img", &[0x41; 240]);
    let path = folder.put("a.hdr", bytes);
    if let Some(opened) = accepted(hadar_formats::cube::open_as(&path, None, None)) {
        one_line(&opened.found.to_string());
        let bands = opened.cube.shape().bands();
        for list in [&opened.found.centres_cm1, &opened.found.widths_cm1].into_iter().flatten() {
            assert!(
                list.len() == bands && list.iter().all(|value| *value > 0.0 && value.is_finite()),
                "{list:?}"
            );
        }
        assert!(opened.found.bad_bands.iter().all(|band| *band < bands));
        sound_cube(&opened.cube);
    }
}

fn noise(folder: &Folder, bytes: &[u8]) {
    let path = folder.put("noise", bytes);
    for bands in [1, 3] {
        let shape = Shape::new(2, 1, bands).expect("a small shape");
        match accepted(hadar_formats::noise_variance(&path, shape, None)) {
            Some(NoiseVariance::PerBand(variances)) => {
                assert_eq!(variances.len(), bands);
                assert!(variances.iter().all(|variance| *variance >= 0.0 && variance.is_finite()));
            }
            Some(NoiseVariance::PerSample(cube)) => assert_eq!(cube.shape(), shape),
            Some(other) => panic!("{other:?} from a file"),
            None => {}
        }
    }
}

fn model(_: &Folder, bytes: &[u8]) {
    let Some(saved) = accepted(SavedModel::from_json(&String::from_utf8_lossy(bytes))) else { return };
    let again = SavedModel::from_json(&saved.to_json().expect("a model that can be written"));
    assert_eq!(again.as_ref(), Ok(&saved));
    let (bands, classes) = (saved.model.bands(), saved.model.classes());
    assert!(bands >= 1 && classes >= 2);
    assert_eq!((saved.wavenumber_cm1.len(), saved.classes.len()), (bands, classes));
    assert!(saved.photons > 0.0 && saved.photons.is_finite());
    assert!(saved.wavenumber_cm1.iter().all(|&centre| centre > 0.0 && centre.is_finite()));
    let mut scores = vec![0.0; classes];
    if saved.model.judge().score(&vec![1.0; bands], &mut scores) {
        assert!(scores.iter().all(|score| !score.is_nan()), "{scores:?}");
    }
    accepted(saved.check_fits(&[1.0], &["a".to_owned()]));
}
