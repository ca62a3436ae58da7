//! Cubes that other programs have written (`tests/data/cubes/make.py`): every sample is 100 row + 10 column + band.

use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar_formats::cube::{Axes, EnviBands, Opened, envi_files};
use hadar_formats::envi_header::Interleave;
use std::path::PathBuf;

pub(crate) fn path(name: &str) -> PathBuf {
    hadar_testing::repository().join("tests/data/cubes").join(name)
}

pub(crate) fn open(name: &str, variable: Option<&str>, axes: Option<&str>) -> hadar::Result<Opened> {
    hadar_formats::cube::open_as(&path(name), variable, axes.map(|axes| Axes::named(axes).unwrap()))
}

pub(crate) fn refusal(name: &str, variable: Option<&str>, axes: Option<&str>) -> String {
    open(name, variable, axes).unwrap_err().to_string()
}

/// All samples, read in one piece and, the last row first, one by one.
pub(crate) fn samples(cube: &Cube) -> Vec<f64> {
    fn of<S: Sample>(cube: &dyn Rows<S>) -> Vec<f64> {
        let (shape, mut buffer) = (cube.shape(), Vec::new());
        let numbers = |samples: &[S]| samples.iter().map(|&sample| sample.into()).collect::<Vec<f64>>();
        let whole = numbers(cube.read(0..shape.rows(), &mut buffer).unwrap());
        for row in (0..shape.rows()).rev() {
            let one = numbers(cube.read(row..row + 1, &mut buffer).unwrap());
            assert!(same(&one, &whole[row * shape.row_len()..][..shape.row_len()]));
        }
        assert!(cube.read(0..0, &mut buffer).unwrap().is_empty());
        assert!(cube.read(1..shape.rows() + 1, &mut buffer).is_err());
        whole
    }
    match cube {
        Cube::F32(cube) => of(cube.as_ref()),
        Cube::F64(cube) => of(cube.as_ref()),
    }
}

/// Equal, where a number for nothing is equal to another.
pub(crate) fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a == b || a.is_nan() && b.is_nan())
}

fn cube_of(value: impl Fn(usize, usize, usize) -> f64) -> Vec<f64> {
    let place = |i: usize| (i / 20, i / 5 % 4, i % 5);
    (0..60).map(place).map(|(row, column, band)| value(row, column, band)).collect()
}

pub(crate) fn plain(row: usize, column: usize, band: usize) -> f64 {
    (100 * row + 10 * column + band) as f64
}

/// Opens a file that must hold these values, stored so, and is `f64` where it must be.
pub(crate) fn check(
    name: &str,
    variable: Option<&str>,
    axes: Option<&str>,
    stored: &str,
    value: impl Fn(usize, usize, usize) -> f64,
) {
    let Opened { cube, found } = open(name, variable, axes).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(cube.shape(), Shape::new(3, 4, 5).unwrap(), "{name}");
    assert_eq!((found.shape, found.stored, found.file.as_str()), (cube.shape(), stored, name));
    let double = matches!(stored, "f64" | "i32" | "u32" | "i64" | "u64" | "double");
    assert_eq!(matches!(cube, Cube::F64(_)), double, "{name}");
    let (found, expected) = (samples(&cube), cube_of(value));
    assert!(same(&found, &expected), "{name}: {found:?}");
}

#[test]
fn numpy_writes_any_type_in_any_order() {
    for (name, stored) in [
        ("i2", "i16"),
        ("u1", "u8"),
        ("u2", "u16"),
        ("i4", "i32"),
        ("u4", "u32"),
        ("i8", "i64"),
        ("u8", "u64"),
        ("f2", "f16"),
        ("f4", "f32"),
        ("f8", "f64"),
        ("fortran", "f32"),
        ("fortran_u2be", "u16"),
    ] {
        check(&format!("numpy_{name}.npy"), None, None, stored, plain);
    }
    check("numpy_i1.npy", None, None, "i8", |r, c, b| plain(r, c, b) - 120.0);
    assert!(
        refusal("numpy_bool.npy", None, None)
            .contains("the samples are truth values; write what was counted")
    );
    assert!(refusal("numpy_complex.npy", None, None).contains("complex numbers; write one of its parts"));
}

#[test]
fn axes_in_any_order_are_as_they_are_named() {
    check("numpy_bands_first.npy", None, Some("bands,rows,columns"), "u16", plain);
    check("numpy_bands_first_fortran.npy", None, Some("bands, rows, columns"), "f64", plain);
    check("numpy_columns_first.npy", None, Some("columns,rows,bands"), "f32", plain);
    check("scipy_bands_first.mat", None, Some("bands,rows,columns"), "single", plain);
    // All six orders of one file, against each other.
    let bare = samples(&open("numpy_bands_first.npy", None, None).unwrap().cube);
    for axes in [
        "rows,columns,bands",
        "columns,rows,bands",
        "rows,bands,columns",
        "bands,columns,rows",
        "columns,bands,rows",
    ] {
        let cube = open("numpy_bands_first.npy", None, Some(axes)).unwrap().cube;
        let names: Vec<&str> = axes.split(',').collect();
        let of = |name: &str| names.iter().position(|own| *own == name).unwrap();
        let sides = [5, 3, 4];
        let shape = ["rows", "columns", "bands"].map(|name| sides[of(name)]);
        assert_eq!(cube.shape(), Shape::new(shape[0], shape[1], shape[2]).unwrap());
        let mut expected = Vec::new();
        for row in 0..shape[0] {
            for column in 0..shape[1] {
                for band in 0..shape[2] {
                    let mut place = [0; 3];
                    (place[of("rows")], place[of("columns")], place[of("bands")]) = (row, column, band);
                    expected.push(bare[(place[0] * 3 + place[1]) * 4 + place[2]]);
                }
            }
        }
        assert_eq!(samples(&cube), expected, "{axes}");
    }
    assert!(Axes::named("bands,rows").is_err() && Axes::named("bands,lines,samples").is_err());
    assert!(refusal("envi_bsq_f4_0.hdr", None, Some("bands,rows,columns")).contains("leave axes out"));
}

#[test]
fn a_first_axis_that_may_be_the_bands_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npy");
    for (sides, suspicious) in [([3, 8, 9], true), ([8, 9, 3], false), ([1, 8, 9], false), ([5, 9, 9], false)]
    {
        let shape = Shape::new(sides[0], sides[1], sides[2]).unwrap();
        hadar_formats::cube::write_npy(&path, shape, &vec![1.0_f32; shape.len()]).unwrap();
        assert_eq!(
            hadar_formats::cube::open_as(&path, None, None).unwrap().found.may_begin_with_bands(),
            suspicious
        );
        let said = hadar_formats::cube::open_as(&path, None, Some(Axes::default())).unwrap().found;
        assert!(!said.may_begin_with_bands());
    }
}

#[test]
fn archives_of_numpy_have_arrays_by_name() {
    check("numpy_stored.npz", None, None, "f32", plain);
    check("numpy_packed.npz", Some("cube"), None, "i16", plain);
    check("numpy_packed.npz", None, None, "i16", plain);
    check("numpy_two.npz", Some("left"), None, "f64", plain);
    assert_eq!(open("numpy_stored.npz", None, None).unwrap().found.memory_bytes, None);
    assert_eq!(open("numpy_packed.npz", None, None).unwrap().found.memory_bytes, Some(240));
    let several = refusal("numpy_two.npz", None, None);
    assert!(
        several.contains("2 arrays that may be meant: `left` (3 x 4 x 5), `right` (3 x 4 x 5); name one"),
        "{several}"
    );
    assert!(refusal("numpy_two.npz", Some("lift"), None).contains("there is no array `lift`"));
}

#[test]
fn envi_in_every_interleave_type_and_order_of_bytes() {
    for (name, stored) in [
        ("bsq_f4_0", "f32"),
        ("bil_f4_0", "f32"),
        ("bip_f4_0", "f32"),
        ("bsq_i2_1", "i16"),
        ("bil_f8_1", "f64"),
        ("bip_u2_1", "u16"),
        ("bil_u1_0", "u8"),
        ("bsq_i4_0", "i32"),
        ("bip_u4_1", "u32"),
        ("bil_i8_0", "i64"),
        ("bsq_u8_1", "u64"),
    ] {
        for ending in ["hdr", "img"] {
            check(&format!("envi_{name}.{ending}"), None, None, stored, plain);
        }
    }
    let found = open("envi_bil_f4_0.img", None, None).unwrap().found;
    assert_eq!(found.centres_cm1.unwrap(), [800.0, 1000.0, 1e4 / 9.0, 1e4 / 8.5, 1250.0]);
    // 1e4/12.25 - 1e4/12.75.
    assert!((found.widths_cm1.unwrap()[0] - 32.012_805_122).abs() < 1e-6);
    assert_eq!(found.bad_bands, [2, 4]);
    let said = open("envi_bil_f4_0.img", None, None).unwrap().found.to_string();
    assert_eq!(
        said,
        "3 rows x 4 columns x 5 bands, f32, envi_bil_f4_0.img (ENVI BIL; bands 2, 4 bad by its list)"
    );
    assert!(
        refusal("envi_bil_f4_0.img", Some("S"), None).contains("an ENVI file has one array without a name")
    );
}

#[test]
fn envi_numbers_stand_for_what_the_header_says() {
    let gap = |r, c, b| if (r, c, b) == (1, 2, 3) { f64::NAN } else { plain(r, c, b) };
    check("envi_scaled.hdr", None, None, "f64", gap);
    assert_eq!(open("envi_scaled.hdr", None, None).unwrap().found.missing, [-9999.0]);
    // The nearest f32 to number / 100, which is no whole number in binary.
    check("envi_reflectance.hdr", None, None, "u16", plain);
}

/// What is written is read again, in every interleave; the reader is checked above against another program's files.
#[test]
fn envi_is_written_as_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let shape = Shape::new(3, 4, 5).unwrap();
    let doubles = cube_of(|r, c, b| plain(r, c, b) + 0.1);
    let singles: Vec<f32> = cube_of(plain).into_iter().map(|x| x as f32).collect();
    let bands = EnviBands { centres_cm1: &[700.0, 710.5, 720.0, 730.0, 740.0], widths_cm1: Some(&[10.0; 5]) };
    for (interleave, name) in [(Interleave::Bsq, "bsq"), (Interleave::Bil, "bil"), (Interleave::Bip, "bip")] {
        let path = folder.path().join(format!("{name}.hdr"));
        let put = |(header, data): (String, Vec<u8>)| {
            std::fs::write(&path, header).unwrap();
            std::fs::write(path.with_extension(""), data).unwrap();
            hadar_formats::cube::open_as(&path, None, None).unwrap()
        };
        let opened = put(envi_files(shape, &doubles, interleave, Some(bands)).unwrap());
        assert_eq!(samples(&opened.cube), doubles);
        assert_eq!(opened.found.centres_cm1.unwrap(), bands.centres_cm1);
        assert_eq!(opened.found.widths_cm1.unwrap(), [10.0; 5]);
        assert!(matches!(opened.cube, Cube::F64(_)));
        let opened = put(envi_files(shape, &singles, interleave, None).unwrap());
        assert_eq!(samples(&opened.cube), cube_of(plain));
        assert!(matches!(opened.cube, Cube::F32(_)));
        // As `spectral` has written the same cube.
        let theirs = std::fs::read(super::cubes::path(&format!("envi_{name}_f4_0.img"))).unwrap();
        assert_eq!(std::fs::read(path.with_extension("")).unwrap(), theirs);
    }
}

#[test]
fn envi_that_does_not_fit_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let header = std::fs::read_to_string(path("envi_bip_f4_0.hdr")).unwrap();
    let data = std::fs::read(path("envi_bip_f4_0.img")).unwrap();
    let message = |from: &str, to: &str, len: usize| {
        let own = folder.path().join("a.hdr");
        assert!(header.contains(from));
        std::fs::write(&own, header.replace(from, to)).unwrap();
        std::fs::write(own.with_extension("img"), &data[..len]).unwrap();
        hadar_formats::cube::open(&own, None).unwrap_err().to_string()
    };
    let short = message("lines = 3", "lines = 3", 239);
    assert!(short.contains("the file has 239 bytes, where its header announces 240"), "{short}");
    let long = message("lines = 3", "lines = 2", 240);
    assert!(long.contains("the file has 240 bytes, where its header announces 160"), "{long}");
    assert!(message("data type = 4", "data type = 6", 240).contains("complex"));
    assert!(message("lines = 3", "lines = 9999999999999999", 240).contains("where its header announces"));
    assert!(message("12.5 ,", "-12.5 ,", 240).contains("wavelength is -12.5 um; it must be above 0"));
    let twice = "bands = 5\nreflectance scale factor = 2\ndata gain values = {1,1,1,1,1}";
    assert!(message("bands = 5", twice, 240).contains("keep the one that holds"));
    std::fs::remove_file(folder.path().join("a.img")).unwrap();
    let alone = hadar_formats::cube::open(&folder.path().join("a.hdr"), None).unwrap_err().to_string();
    assert!(alone.contains("not beside it"), "{alone}");
}

#[test]
fn matlab_files_of_scipy_are_read() {
    check("scipy_plain.mat", None, None, "double", plain);
    check("scipy_packed.mat", None, None, "uint16", plain);
    assert_eq!(open("scipy_plain.mat", None, None).unwrap().found.memory_bytes, Some(480));
}

#[cfg(feature = "hdf5")]
#[test]
fn hdf5_in_any_layout_and_type() {
    check("h5py.h5", Some("plain"), None, "f32", plain);
    check("h5py.h5", Some("packed"), None, "i16", plain);
    check("h5py.h5", Some("half"), None, "f16", plain);
    check("h5py.h5", Some("night/images"), Some("bands,rows,columns"), "u32", plain);
    check("h5py.h5", Some("night/lines"), Some("rows,bands,columns"), "f64", plain);
    assert!(refusal("h5py.h5", Some("truth"), None).contains("truth: the samples are truth values"));
    check("h5py_new.h5", None, None, "f64", plain);
    let memory = |name| open("h5py.h5", Some(name), None).unwrap().found.memory_bytes;
    assert_eq!((memory("plain"), memory("packed"), memory("night/lines")), (None, None, None));
    let images = open("h5py.h5", Some("night/images"), Some("bands,rows,columns")).unwrap();
    assert_eq!(images.found.memory_bytes, Some(480));
    let several = refusal("h5py.h5", None, None);
    assert!(
        several.contains("5 arrays that may be meant") && several.contains("`night/images` (5 x 3 x 4 u32)"),
        "{several}"
    );
    assert!(refusal("h5py.h5", Some("complex"), None).contains("complex: the samples are complex numbers"));
    assert!(
        refusal("h5py.h5", Some("text"), None).contains("text: the variable is no array of such numbers")
    );
    assert!(refusal("h5py.h5", Some("plane"), None).contains("there is no variable `plane`"));
}

/// A chunk that is said to be of four gigabytes, or to stand beyond the end: room is made for none of it.
#[cfg(feature = "hdf5")]
#[test]
fn chunks_are_held_against_the_file_before_they_are_read() {
    let whole = std::fs::read(path("h5py.h5")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let damaged = folder.path().join("damaged.h5");
    // Behind the head of 24 bytes of the tree of an array: bytes of the first chunk, filters, four places; where it stands.
    let trees: Vec<usize> = (0..whole.len()).filter(|at| whole[*at..].starts_with(b"TREE\x01")).collect();
    assert_eq!(trees.len(), 3);
    for tree in trees {
        for (place, wrong) in [(24, &4_108_611_929_u32.to_le_bytes()[..]), (64, &(1_u64 << 40).to_le_bytes())]
        {
            let mut bytes = whole.clone();
            bytes[tree + place..][..wrong.len()].copy_from_slice(wrong);
            std::fs::write(&damaged, bytes).unwrap();
            let refused =
                ["packed", "half", "night/images", "night/lines", "plain"].into_iter().filter(|name| {
                    let said = hadar_formats::cube::open_as(&damaged, Some(name), None)
                        .err()
                        .map(|error| error.to_string());
                    said.is_some_and(|said| {
                        said.contains("a chunk of ") && said.contains("and the file has 20104")
                    })
                });
            assert_eq!(refused.count(), 1, "{tree} {place}");
        }
    }
}

#[cfg(feature = "hdf5")]
#[test]
fn matlab_7_3_has_its_dimensions_the_other_way_round() {
    check("matlab73.mat", Some("S"), None, "f64", plain);
    check("matlab73.mat", Some("P"), None, "f32", plain);
    let found = open("matlab73.mat", Some("P"), None).unwrap().found;
    assert_eq!((found.format, found.memory_bytes), ("MATLAB 7.3", Some(240)));
}

#[cfg(feature = "hdf5")]
#[test]
fn netcdf_says_what_its_numbers_stand_for() {
    let gap = |r, c, b| if (r, c, b) == (1, 2, 3) { f64::NAN } else { plain(r, c, b) };
    check("netcdf.nc", Some("radiance"), Some("bands,rows,columns"), "i16", gap);
    let found = open("netcdf.nc", Some("radiance"), Some("bands,rows,columns")).unwrap().found;
    assert_eq!(found.centres_cm1.unwrap(), [800.0, 1000.0, 1e4 / 9.0, 1e4 / 8.5, 1250.0]);
    // What nobody has written is what NetCDF fills it with.
    check("netcdf.nc", Some("partly"), None, "f32", |r, c, b| if r == 0 { plain(r, c, b) } else { f64::NAN });
    assert!(refusal("netcdf.nc", Some("never"), None).contains("the array was never written"));
    let said = open("netcdf.nc", Some("radiance"), None).unwrap().found.to_string();
    assert!(
        said.ends_with("axes bands,rows,columns; -1 taken as missing; gain 0.5 applied; offset -3 applied; whole in memory, 0.0 MB)"),
        "{said}"
    );
}

#[cfg(feature = "hdf5")]
#[test]
fn attributes_say_which_samples_are_valid_and_what_they_are() {
    let within = |r: usize, c: usize, b: usize| (10.0..=220.0).contains(&plain(r, c, b));
    let valid = |scale: f64, offset: f64| {
        move |r, c, b| if within(r, c, b) { scale * plain(r, c, b) + offset } else { f64::NAN }
    };
    let below = |r, c, b| if plain(r, c, b) <= 220.0 { plain(r, c, b) } else { f64::NAN };
    check("h5py_said.h5", Some("valid_max/cube"), None, "i16", below);
    // In what is stored, and in what it stands for.
    check("h5py_said.h5", Some("valid_range/cube"), None, "i16", valid(0.5, 2.0));
    check("h5py_said.h5", Some("valid_unpacked/cube"), None, "i16", valid(0.5, 2.0));
    let said = open("h5py_said.h5", Some("valid_range/cube"), None).unwrap().found.to_string();
    assert!(
        said.contains("below 10 and above 220 taken as missing; gain 0.5 applied; offset 2 applied"),
        "{said}"
    );
    let kelvin = open("h5py_said.h5", Some("kelvin/cube"), None).unwrap().found;
    assert_eq!((kelvin.unit.as_deref(), kelvin.valid), (Some("K"), None));
    for (name, message) in [
        ("scale_text", "scale_factor: the attribute is the text `0.1`; write it as a number"),
        ("scale_list", "scale_factor: the attribute is a list of 3 numbers; write one number"),
        (
            "range_of_one",
            "valid_range: the attribute is a list of 1 numbers; write the least and the largest",
        ),
    ] {
        let refused = refusal("h5py_said.h5", Some(&format!("{name}/cube")), None);
        assert!(refused.contains(message), "{refused}");
    }
    // The only array of a file is meant, whatever is wrong with it.
    let refused = refusal("h5py_scale_text.h5", None, None);
    assert!(refused.contains("scale_factor: the attribute is the text `0.1`"), "{refused}");
}

#[cfg(feature = "hdf5")]
#[test]
fn dimensions_of_netcdf_are_read_by_name() {
    for (name, axes) in [
        ("a", "bands,rows,columns"),
        ("b", "rows,bands,columns"),
        ("c", "rows,columns,bands"),
        ("d", "columns,rows,bands"),
        ("e", "bands,columns,rows"),
    ] {
        check("netcdf_dimensions.nc", Some(name), None, "u16", plain);
        let found = open("netcdf_dimensions.nc", Some(name), None).unwrap().found;
        assert_eq!(found.axes.unwrap().to_string(), axes);
        assert_eq!(found.centres_cm1.unwrap().len(), 5);
    }
    // What is said counts.
    let said = open("netcdf_dimensions.nc", Some("a"), Some("rows,columns,bands")).unwrap();
    assert_eq!(said.cube.shape(), Shape::new(5, 3, 4).unwrap());
    // Dimensions of one length are told apart by their numbers, or by labels; where there are neither they have to be written.
    let named = |file: &str, variable: &str| {
        let found = open(file, Some(variable), None).unwrap().found;
        (found.shape, found.axes.unwrap().to_string())
    };
    let bands_first = (Shape::new(4, 7, 4).unwrap(), "bands,rows,columns".to_owned());
    assert_eq!(named("netcdf_dimensions.nc", "square/s"), bands_first);
    assert_eq!(named("h5py_scales.h5", "labelled"), bands_first);
    let refused = refusal("h5py_scales.h5", Some("scaled"), None);
    assert!(refused.contains("4 may be band or y") && refused.contains("write axes = "), "{refused}");
    let said = open("h5py_scales.h5", Some("scaled"), Some("bands,rows,columns")).unwrap();
    assert_eq!(said.cube.shape(), bands_first.0);
    assert_eq!(named("h5py_scales.h5", "apart").1, "rows,columns,bands");
}

/// Lists of NumPy and SciPy say where the bands are, if their names have a unit.
#[test]
fn a_list_beside_the_cube_says_its_bands() {
    for name in ["numpy_listed.npz", "numpy_listed_packed.npz", "scipy_listed.mat", "scipy_listed_packed.mat"]
    {
        let stored = if name.ends_with("mat") { "double" } else { "f32" };
        check(name, None, None, stored, plain);
        let found = open(name, None, None).unwrap().found;
        let centres = found.centres_cm1.unwrap_or_else(|| panic!("{name}"));
        for (band, centre) in centres.iter().enumerate() {
            assert!((centre * (8.0 + band as f64) / 1e4 - 1.0).abs() < 1e-6, "{name}: {centres:?}");
        }
        assert!(centres.len() == 5 && !found.axis_without_unit, "{name}");
    }
    for name in ["numpy_listed_without_unit.npz", "scipy_listed_without_unit.mat"] {
        let found = open(name, None, None).unwrap().found;
        assert!(found.axis_without_unit && found.centres_cm1.is_none(), "{name}");
    }
}

/// A factor or an offset under a name that no convention has is neither applied nor passed over, wherever it stands.
#[cfg(all(feature = "hdf5", feature = "zarr"))]
#[test]
fn samples_that_are_packed_otherwise_are_refused() {
    for (name, key) in [
        ("packed_array.h5", "Slope"),
        ("packed_array.nc", "Slope"),
        ("packed_array.zarr", "Slope"),
        ("packed_array.hdr", "radiance scale factor"),
        ("packed_hdf_eos.h5", "ScaleFactor"),
        ("packed_hdf_eos.nc", "ScaleFactor"),
        ("packed_hdf_eos.zarr", "ScaleFactor"),
        ("packed_folder.h5", "scale_factor"),
        ("packed_folder.nc", "scale_factor"),
        ("packed_folder.zarr", "scale_factor"),
        ("packed_beside.h5", "radiance_scales"),
        ("packed_beside.npz", "scale"),
        ("packed_beside.mat", "radiance_slope"),
        ("packed_scalar.npz", "scale"),
        ("packed_scalar.mat", "radiance_slope"),
    ] {
        let said = refusal(name, None, None);
        assert!(said.contains(key) || said.contains("Offset"), "{name}: {said}");
        assert!(said.contains("packed") && said.contains("unpacked"), "{name}: {said}");
    }
    for end in ["h5", "nc", "zarr", "npz", "mat", "hdr"] {
        let name = format!("packed_neutral.{end}");
        let opened = open(&name, None, None).unwrap_or_else(|error| panic!("{error}"));
        assert!(same(&samples(&opened.cube), &cube_of(plain)), "{name}");
    }
}
