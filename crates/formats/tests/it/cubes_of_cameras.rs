//! Files of other fields and of cameras: NetCDF-3, FITS, TIFF, Zarr, FLIR, Telops (`tests/data/cubes/make.py`), whole and damaged.

use crate::cubes::{check, open, path, plain, refusal, same, samples};
use hadar::cube::Shape;
use proptest::prelude::*;
use std::path::Path;

const MICROMETRES: [f64; 5] = [8.0, 9.0, 10.0, 11.0, 12.0];

fn near(found: &[f64], expected: &[f64]) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-6)
}

/// Whether a file says its bands at 8 to 12 µm.
fn says_its_bands(name: &str, variable: Option<&str>) {
    let centres = open(name, variable, None).unwrap().found.centres_cm1.unwrap_or_else(|| panic!("{name}"));
    assert!(near(&centres, &MICROMETRES.map(|um| 1e4 / um)), "{name}: {centres:?}");
}

/// Whatever the list is called, if its name or its attributes say what it is.
#[cfg(feature = "hdf5")]
#[test]
fn bands_are_found_by_every_name_of_their_list() {
    let groups =
        ["wavelength", "wavelengths_um", "band_wavelength", "wl", "nu", "channel", "lambda_um", "attribute"];
    for group in groups {
        let found = open("h5py_listed.h5", Some(&format!("{group}/cube")), None).unwrap().found;
        let expected: Vec<f64> = (0..5).map(|band| 1e4 / (8.0 + f64::from(band))).collect();
        assert!(near(&found.centres_cm1.unwrap_or_default(), &expected), "{group}");
    }
    for (group, unused) in [("no_wavelength", true), ("no_band", false), ("no_wavelength_error", false)] {
        let found = open("h5py_listed.h5", Some(&format!("{group}/cube")), None).unwrap().found;
        assert_eq!((found.centres_cm1, found.axis_without_unit), (None, unused), "{group}");
    }
    let found = open("matlab73_listed.mat", Some("S"), None).unwrap().found;
    assert_eq!(
        (found.unit.as_deref(), found.centres_cm1.map(|all| all.len())),
        (Some("microflick"), Some(5))
    );
}

/// Another array is not taken in the place of one that cannot be read.
#[test]
fn an_array_that_is_not_read_is_not_passed_over() {
    for (name, message) in [
        #[cfg(feature = "zarr")]
        ("zarr_unread.zarr", "2 arrays that may be meant: `bt_background` (4 x 4 f32), `bt` (4 x 4 numbers"),
        #[cfg(feature = "hdf5")]
        ("h5py_four.h5", "radiance: the array has 4 dimensions (1 x 3 x 4 x 5); write it with"),
        (
            "astropy_packed_beside.fits",
            "2 arrays that may be meant: `RADIANCE` (5 x 3 x 4 f32), `PACKED` (5 x 3 x 4",
        ),
    ] {
        let refused = refusal(name, None, None);
        assert!(refused.contains(message), "{refused}");
    }
    #[cfg(feature = "zarr")]
    {
        assert!(refusal("zarr_unread.zarr", Some("bt"), None).contains("sharding"));
        let found = open("zarr_unread.zarr", Some("bt_background"), None).unwrap().found;
        assert_eq!(found.missing, Vec::<f64>::new());
    }
    check("astropy_packed_beside.fits", Some("RADIANCE"), None, "f32", plain);
    assert!(refusal("astropy_packed_beside.fits", Some("PACKED"), None).contains("ZIMAGE"));
    assert!(refusal("tifffile_white.tif", None, None).contains("white for 0"));
}

#[cfg(feature = "hdf5")]
#[test]
fn links_of_hdf5_are_no_arrays_and_hide_none() {
    for name in ["h5py_links.h5", "h5py_links_new.h5"] {
        check(name, None, None, "f32", plain);
        says_its_bands(name, None);
    }
    let found = open("netcdf_group.nc", None, None).unwrap().found;
    says_its_bands("netcdf_group.nc", None);
    assert_eq!(found.bad_bands, [2]);
    let widths = MICROMETRES.map(|um| 1e4 / (um - 0.025) - 1e4 / (um + 0.025));
    assert!(near(&found.widths_cm1.unwrap(), &widths));
}

#[test]
fn classic_netcdf_in_all_three_kinds() {
    let gap = |r, c, b| if (r, c, b) == (1, 2, 3) { f64::NAN } else { plain(r, c, b) };
    for name in ["netcdf3_classic.nc", "netcdf3_64bit_offset.nc", "netcdf3_64bit_data.nc"] {
        check(name, Some("fixed"), None, "i16", gap);
        check(name, Some("records"), None, "f32", plain);
        says_its_bands(name, Some("fixed"));
        let found = open(name, Some("fixed"), None).unwrap().found;
        assert_eq!(found.unit.as_deref(), Some("W m-2 sr-1 um-1"));
        assert_eq!(
            (found.memory_bytes, found.axes.unwrap().to_string().as_str()),
            (None, "bands,rows,columns")
        );
        assert_eq!(open(name, Some("records"), None).unwrap().found.memory_bytes, Some(240));
        assert!(refusal(name, None, None).contains("`fixed` (5 x 3 x 4 i16), `records` (3 x 4 x 5 f32)"));
        assert!(refusal(name, Some("record"), None).contains("records"));
    }
    check("netcdf3_record_axis.nc", None, None, "f32", plain);
    says_its_bands("netcdf3_record_axis.nc", None);
    // What nobody wrote is what NetCDF fills its type with.
    check("netcdf3_packed_axis.nc", None, None, "i16", gap);
    says_its_bands("netcdf3_packed_axis.nc", None);
    // Records of one variable alone stand one behind the other.
    check("scipy_records.nc", None, None, "i16", plain);
}

#[test]
fn fits_images_and_extensions() {
    check("astropy_f4.fits", None, None, "f32", plain);
    says_its_bands("astropy_f4.fits", None);
    check("astropy_u2.fits", None, None, "i16", plain);
    let gap = |r, c, b| if (r, c, b) == (1, 2, 3) { f64::NAN } else { plain(r, c, b) };
    check("astropy_extensions.fits", None, None, "i16", gap);
    let found = open("astropy_extensions.fits", Some("SCENE"), None).unwrap().found;
    assert!(near(&found.centres_cm1.unwrap(), &[800.0, 900.0, 1000.0, 1100.0, 1200.0]));
    assert_eq!(found.missing, [-32768.0]);
    // Another axis than that of the wavelengths has none.
    let turned = open("astropy_f4.fits", None, Some("rows,columns,bands")).unwrap().found;
    assert_eq!((turned.centres_cm1, turned.axis_without_unit), (None, true));
    assert_eq!(open("astropy_extensions.fits", Some("MAP"), None).unwrap().cube.shape().bands(), 1);
    assert!(
        refusal("astropy_packed.fits", None, None)
            .contains("compressed in a table (ZIMAGE); unpack it with funpack")
    );
}

#[test]
fn tiff_samples_planes_pages_and_what_gdal_says() {
    for (name, stored) in [
        ("tiff_samples.tif", "f32"),
        ("tiff_planes.tif", "u16"),
        ("tiff_pages.tif", "f64"),
        ("tiff_big.tif", "i16"),
    ] {
        check(name, None, None, stored, plain);
    }
    // 6 stands for nothing: sample 11 of the cube.
    check(
        "tiff_gdal.tif",
        None,
        None,
        "f32",
        |r, c, b| if plain(r, c, b) == 11.0 { f64::NAN } else { plain(r, c, b) },
    );
    // Of pages the number for nothing is that of the first.
    check("tiff_pages_gdal.tif", None, None, "f32", |r, c, b| {
        if plain(r, c, b) == 11.0 { f64::NAN } else { plain(r, c, b) }
    });
    says_its_bands("tiff_gdal.tif", None);
    assert_eq!(open("tiff_gdal.tif", None, None).unwrap().found.unit.as_deref(), Some("W m-2 sr-1 um-1"));
    let page = open("tiff_pages.tif", Some("2"), None).unwrap();
    let expected: Vec<f64> = (0..12).map(|i| plain(i / 4, i % 4, 2)).collect();
    assert!(same(&samples(&page.cube), &expected));
    assert_eq!(open("tiff_one.tif", None, None).unwrap().cube.shape(), Shape::new(3, 4, 1).unwrap());
    assert!(refusal("tiff_colours.tif", None, None).contains("the samples are colours"));
    assert!(
        refusal("tiff_pages.tif", Some("5"), None).contains("there is no frame `5`; count from 0 up to 4")
    );
}

#[test]
fn zarr_of_both_versions_with_every_codec() {
    for name in ["2_none", "2_blosc", "2_zstd", "2_lz4", "2_zlib", "3_none", "3_zstd", "3_gzip", "3_blosc"] {
        check(&format!("zarr{name}.zarr"), None, None, "f32", plain);
    }
    // Chunks of the last row were never written.
    let half = |r: usize, c, b| if r < 2 { 0.5 * plain(r, c, b) } else { f64::NAN };
    check("zarr_group.zarr", Some("radiance"), None, "i16", half);
    says_its_bands("zarr_group.zarr", None);
    let found = open("zarr_group.zarr", None, None).unwrap().found;
    assert_eq!((found.absent_chunks, found.unit.as_deref()), (1, Some("W m-2 sr-1 um-1")));
    assert!(found.to_string().contains("1 chunks never written, their samples missing"), "{found}");
    assert!(refusal("zarr_group.zarr", Some("radiances"), None).contains("radiance"));
    assert!(refusal("zarr2_none.zarr", Some("cube"), None).contains("one array, which has no name"));
}

/// The readings of ExifTool, and T = B/ln(R1/(R2 (n + O)) + F) of them in double precision.
#[test]
fn radiometric_files_of_flir() {
    // The offset O of the camera is -342.
    let raw = [13658.0, 13758.0, 13858.0, 14658.0, 15658.0, 16658.0];
    let kelvin = [429.295_521, 430.204_986, 431.111_446, 438.259_191, 446.952_562, 455.404_437];
    for (name, [number, temperature]) in [
        ("flir.jpg", ["signal", "temperature"]),
        ("flir.fff", ["signal", "temperature"]),
        ("flir.seq", ["signal[0]", "temperature[0]"]),
    ] {
        let found = open(name, Some(number), None).unwrap();
        assert!(same(&samples(&found.cube), &raw), "{name}");
        assert_eq!(
            (found.cube.shape(), found.found.unit.as_deref()),
            (Shape::new(2, 3, 1).unwrap(), Some("DN"))
        );
        let found = open(name, Some(temperature), None).unwrap();
        let read = samples(&found.cube);
        assert!(read.iter().zip(kelvin).all(|(a, b)| (a - b).abs() < 1e-4), "{name}: {read:?}");
        assert_eq!(found.found.unit.as_deref(), Some("K"));
    }
    let second: Vec<f64> = raw.iter().map(|n| n + 100.0).collect();
    assert!(same(&samples(&open("flir.seq", Some("signal[1]"), None).unwrap().cube), &second));
    assert!(same(&samples(&open("flir.jpg", None, None).unwrap().cube), &raw));
    assert!(
        refusal("flir.seq", None, None).contains("2 frames; name one as the variable, as in \"signal[0]\"")
    );
    assert!(refusal("flir.seq", Some("signal[2]"), None).contains("signal[2]"));
    let refused = refusal("picture.jpg", None, None);
    assert!(refused.contains("a JPEG picture without radiometry"), "{refused}");
}

#[test]
fn sequences_of_telops() {
    let first: Vec<f64> = (0..60).map(|n| f64::from(273.15_f32) + f64::from(n) / 256.0).collect();
    let found = open("telops_rt.hcc", Some("0"), None).unwrap();
    assert!(samples(&found.cube).iter().zip(&first).all(|(a, b)| (a - b).abs() < 1e-4));
    assert_eq!(found.found.unit.as_deref(), Some("K"));
    assert!(
        refusal("telops_rt.hcc", None, None)
            .contains("2 frames; name one by its number, from variable = \"0\" to \"1\"")
    );
    let raw = open("telops_raw.hcc", None, None).unwrap();
    assert!(same(&samples(&raw.cube), &(0..60).map(f64::from).collect::<Vec<_>>()));
    assert_eq!(raw.found.unit.as_deref(), Some("DN"));
}

/// A block without records ends somewhere; a flat picture has no order of bytes.
#[test]
fn damaged_radiometry_is_refused_in_no_time() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |bytes: &[u8]| {
        let path = folder.path().join("it.seq");
        std::fs::write(&path, bytes).unwrap();
        hadar_formats::cube::open(&path, None).unwrap_err().to_string()
    };
    let mut empty = std::fs::read(path("flir.fff")).unwrap();
    empty[0x18..0x20].fill(0);
    assert!(
        refused(&empty).contains("no readings") || refused(&empty).contains("frame"),
        "{}",
        refused(&empty)
    );
    let whole = std::fs::read(path("flir.fff")).unwrap();
    let apart = [&whole[..], &[0; 70_000], &whole[..]].concat();
    assert!(refused(&apart).contains("behind frame 1 are no frame"), "{}", refused(&apart));
    // The constant B of 1428 K, times ten: no camera sees at 1 µm.
    let mut odd = whole.clone();
    let place = odd.windows(4).position(|bytes| bytes == 1428.0_f32.to_le_bytes()).unwrap();
    odd[place..place + 4].copy_from_slice(&14_280.0_f32.to_le_bytes());
    assert!(refused(&odd).contains("its constant B is 14280 K"), "{}", refused(&odd));
}

/// What is not read says what it is.
#[test]
fn other_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    for (bytes, what) in [
        (&b"\x89PNG\r\n\x1a\n"[..], "a PNG picture"),
        (b"GRIB\0\0", "a GRIB file"),
        (b"\x1f\x8b\x08", "gunzip"),
        (b"%PDF-1.7", "a PDF document"),
        (b"\x0e\x03\x13\x01", "h4toh5convert"),
        (b"RIFF....AVI ", "a film"),
        (b"PAR1", "pandas.read_parquet"),
        (b"wavelength,radiance\n8,1\n", "this is text"),
        (b"\xff\xfe\x00\x01", "none of the files a cube is read from"),
    ] {
        let path = folder.path().join("it.bin");
        std::fs::write(&path, bytes).unwrap();
        let refused = hadar_formats::cube::open(&path, None).unwrap_err().to_string();
        assert!(refused.contains(what), "{refused}");
    }
}

/// Every part of a damaged file that is read is read as of the whole file, and nothing panics; what is cut short is refused.
fn damaged_is_no_other(name: &str, variable: Option<&str>, change: impl Fn(&mut Vec<u8>), is_cut: bool) {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join(name);
    let mut bytes = std::fs::read(path(name)).unwrap();
    change(&mut bytes);
    std::fs::write(&own, bytes).unwrap();
    let opened = hadar_formats::cube::open_as(&own, variable, None);
    if let Ok(opened) = opened {
        if is_cut {
            let whole = open(name, variable, None).unwrap();
            assert!(same(&samples(&opened.cube), &samples(&whole.cube)), "{name} is read short");
        } else {
            read(&opened.cube);
        }
    }
}

/// Reads all rows, whatever comes of it.
fn read(cube: &hadar::cube::Cube) {
    let rows = 0..cube.shape().rows();
    match cube {
        hadar::cube::Cube::F32(cube) => drop(cube.read(rows, &mut Vec::new())),
        hadar::cube::Cube::F64(cube) => drop(cube.read(rows, &mut Vec::new())),
    }
}

const FILES: [(&str, Option<&str>); 13] = [
    ("netcdf3_classic.nc", Some("fixed")),
    ("netcdf3_64bit_data.nc", Some("records")),
    ("scipy_records.nc", None),
    ("astropy_f4.fits", None),
    ("astropy_extensions.fits", None),
    ("tiff_samples.tif", None),
    ("tiff_planes.tif", None),
    ("tiff_pages.tif", None),
    ("tiff_gdal.tif", None),
    ("flir.jpg", Some("temperature")),
    ("flir.seq", Some("signal[1]")),
    ("telops_rt.hcc", Some("1")),
    ("h5py_links.h5", Some("radiance")),
];

proptest! {
    #![proptest_config(hadar_testing::seeded(46, 400))]

    #[test]
    fn what_is_cut_short_is_refused(file in 0..FILES.len(), share in 0.0..1.0_f64) {
        let (name, variable) = FILES[file];
        damaged_is_no_other(name, variable, |bytes| bytes.truncate((share * bytes.len() as f64) as usize), true);
    }

    #[test]
    fn what_is_spoilt_panics_nowhere(file in 0..FILES.len(), at in prop::collection::vec((0.0..1.0_f64, any::<u8>()), 1..6)) {
        let (name, variable) = FILES[file];
        // Where what says how to read stands, mostly.
        let change = |bytes: &mut Vec<u8>| for (share, byte) in &at {
            let place = (share * share * bytes.len() as f64) as usize;
            bytes[place] = *byte;
        };
        damaged_is_no_other(name, variable, change, false);
    }

    #[test]
    fn spoilt_zarr_panics_nowhere(array in 0..10_usize, file in any::<prop::sample::Index>(), at in prop::collection::vec((0.0..1.0_f64, any::<u8>()), 1..4)) {
        let names = ["2_none", "2_blosc", "2_zstd", "2_lz4", "2_zlib", "3_none", "3_zstd", "3_gzip", "3_blosc", "_group"];
        let folder = tempfile::tempdir().unwrap();
        let own = folder.path().join("it.zarr");
        let files = copied(&path(&format!("zarr{}.zarr", names[array])), &own);
        let spoilt = file.get(&files);
        let mut bytes = std::fs::read(spoilt).unwrap();
        for (share, byte) in &at {
            let place = (share * bytes.len() as f64) as usize;
            bytes[place] = *byte;
        }
        std::fs::write(spoilt, bytes).unwrap();
        if let Ok(opened) = hadar_formats::cube::open_as(&own, (array == 9).then_some("radiance"), None) {
            read(&opened.cube);
        }
    }
}

/// Copies a folder, and lists its files.
fn copied(from: &Path, to: &Path) -> Vec<std::path::PathBuf> {
    std::fs::create_dir_all(to).unwrap();
    let mut files = Vec::new();
    let mut entries: Vec<_> = std::fs::read_dir(from).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        let own = to.join(path.file_name().unwrap());
        if path.is_dir() {
            files.extend(copied(&path, &own));
        } else {
            std::fs::copy(&path, &own).unwrap();
            files.push(own);
        }
    }
    files
}
