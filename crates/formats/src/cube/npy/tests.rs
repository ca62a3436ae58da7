use super::*;
use crate::cube::raw::read_reopened;
use hadar::cube::{Cube, MemoryCube, Rows};
use std::path::PathBuf;

/// Headers as NumPy 2.4 writes them, without the blanks before the line feed: version, dictionary, bytes in all.
const NUMPY: [(&[u8], &str, usize); 4] = [
    (b"\x93NUMPY\x01\x00v\x00", "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), }", 128),
    (b"\x93NUMPY\x01\x00v\x00", "{'descr': '>f8', 'fortran_order': False, 'shape': (3, 2), }", 128),
    (
        b"\x93NUMPY\x02\x00t\x00\x00\x00",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2, 2), }",
        128,
    ),
    (
        b"\x93NUMPY\x03\x00t\x00\x00\x00",
        "{'descr': '>f4', 'fortran_order': False, 'shape': (1, 2, 2), }",
        128,
    ),
];

fn padded(start: &[u8], dictionary: &str, len: usize) -> Vec<u8> {
    let mut bytes = start.to_vec();
    bytes.extend(dictionary.bytes());
    bytes.resize(len - 1, b' ');
    bytes.push(b'\n');
    bytes
}

/// A file of version 1 with any dictionary.
fn version_1(dictionary: &str, data: &[u8]) -> Vec<u8> {
    let len = (11 + dictionary.len()).next_multiple_of(64);
    let mut start = b"\x93NUMPY\x01\x00".to_vec();
    start.extend((len as u16 - 10).to_le_bytes());
    let mut bytes = padded(&start, dictionary, len);
    bytes.extend(data);
    bytes
}

fn f4(shape: &str, data: &[u8]) -> Vec<u8> {
    version_1(&format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}"), data)
}

#[derive(Debug)]
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn file(&self, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join("a.npy");
        // Some file systems wait for the disk when a file is overwritten.
        let _ = std::fs::remove_file(&path);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// The message without the path.
    fn refusal(&self, bytes: &[u8]) -> String {
        let path = self.file(bytes);
        let message = crate::cube::open(&path, None).unwrap_err().to_string();
        message.strip_prefix(&format!("{}: ", path.display())).unwrap().to_owned()
    }
}

/// All samples, read in pieces of `height` rows from the last to the first.
fn samples(cube: &Cube, height: usize) -> Vec<f64> {
    fn of<S: Sample>(cube: &dyn Rows<S>, height: usize) -> Vec<f64> {
        let (rows, mut buffer, mut pieces) = (cube.shape().rows(), Vec::new(), Vec::new());
        for first in (0..rows).step_by(height).rev() {
            let piece = cube.read(first..rows.min(first + height), &mut buffer).unwrap();
            pieces.push(piece.iter().map(|&sample| sample.into()).collect::<Vec<f64>>());
        }
        pieces.into_iter().rev().flatten().collect()
    }
    match cube {
        Cube::F32(cube) => of(cube.as_ref(), height),
        Cube::F64(cube) => of(cube.as_ref(), height),
    }
}

#[test]
fn what_numpy_writes_is_read_in_either_order_of_bytes() {
    let folder = Folder::new();
    let shapes = [(2, 3, 4), (3, 2, 1), (1, 2, 2), (1, 2, 2)].map(|(r, c, b)| Shape::new(r, c, b).unwrap());
    for ((start, dictionary, len), shape) in NUMPY.into_iter().zip(shapes) {
        let mut bytes = padded(start, dictionary, len);
        for value in (0..shape.len()).map(|i| i as f64 - 1.5) {
            match dictionary.split('\'').nth(3).unwrap() {
                "<f4" => bytes.extend((value as f32).to_le_bytes()),
                ">f4" => bytes.extend((value as f32).to_be_bytes()),
                "<f8" => bytes.extend(value.to_le_bytes()),
                _ => bytes.extend(value.to_be_bytes()),
            }
        }
        let cube = crate::cube::open(&folder.file(&bytes), None).unwrap();
        assert_eq!(cube.shape(), shape);
        assert_eq!(matches!(cube, Cube::F64(_)), dictionary.contains("f8"));
        for height in 1..=3 {
            assert_eq!(samples(&cube, height), (0..shape.len()).map(|i| i as f64 - 1.5).collect::<Vec<_>>());
        }
    }
}

#[test]
fn what_is_written_is_what_numpy_writes_and_is_read_again() {
    let folder = Folder::new();
    let shape = Shape::new(2, 3, 4).unwrap();
    let singles: Vec<f32> = (0..24).map(|i| 0.1 * i as f32).collect();
    let mut bytes = Vec::new();
    write_npy_to(&mut bytes, shape, &singles).unwrap();
    if cfg!(target_endian = "little") {
        let (start, dictionary, len) = NUMPY[0];
        assert_eq!(bytes[..128], padded(start, dictionary, len));
    }
    let wide = Shape::new(5, 1, 12_345).unwrap();
    let doubles: Vec<f64> = (0..wide.len()).map(|i| (i as f64).sqrt()).collect();
    let path = folder.0.path().join("cube.npy");
    write_npy(&path, wide, &doubles).unwrap();
    assert_eq!(samples(&crate::cube::open(&path, None).unwrap(), 2), doubles);
    write_npy(&path, shape, &singles).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
    let short = write_npy(&path, shape, &singles[1..]).unwrap_err().to_string();
    assert_eq!(short, "samples of a cube: 23 values where 24 are needed");
    assert!(
        write_npy(folder.0.path(), shape, &singles)
            .unwrap_err()
            .to_string()
            .contains("cannot write the cube")
    );
}

#[test]
fn rows_can_be_asked_for_anyhow_but_not_beyond_the_last() {
    let folder = Folder::new();
    let shape = Shape::new(40, 3, 5).unwrap();
    let all: Vec<f32> = (0..shape.len()).map(|i| i as f32).collect();
    let path = folder.0.path().join("cube.npy");
    write_npy(&path, shape, &all).unwrap();
    let Cube::F32(cube) = crate::cube::open(&path, None).unwrap() else { panic!("f32") };
    let mut buffer = Vec::new();
    for rows in [0..40, 7..9, 39..40, 3..3, 0..1] {
        assert_eq!(cube.read(rows.clone(), &mut buffer).unwrap(), &all[rows.start * 15..rows.end * 15]);
    }
    let memory = MemoryCube::new(shape, all.clone()).unwrap();
    #[expect(clippy::reversed_empty_ranges, reason = "what a caller may get wrong")]
    for rows in [39..41, 41..41, 5..4, 0..usize::MAX] {
        let refused = cube.read(rows.clone(), &mut buffer).unwrap_err();
        assert_eq!(refused, memory.read(rows, &mut Vec::new()).unwrap_err());
    }
    std::thread::scope(|scope| {
        for thread in 0..4 {
            let (cube, all) = (&cube, &all);
            scope.spawn(move || {
                let mut buffer = Vec::new();
                for row in (0..400).map(|i| (i * 7 + thread) % 40) {
                    assert_eq!(cube.read(row..row + 1, &mut buffer).unwrap(), &all[row * 15..][..15]);
                }
            });
        }
    });
    let mut again = [0.0_f32; 15];
    read_reopened(&path, bytemuck::cast_slice_mut(&mut again), 128 + 3 * 60).unwrap();
    assert_eq!(again, all[45..60]);
    // Cut while it is open.
    File::options().write(true).open(&path).unwrap().set_len(500).unwrap();
    let cut = cube.read(30..40, &mut buffer).unwrap_err().to_string();
    assert!(cut.contains("cannot read rows 30 to 40 of the cube: the file has become shorter"), "{cut}");
}

/// Whole numbers of every width and order of bytes, the largest and the least of each among them.
#[test]
fn whole_numbers_are_counts() {
    let folder = Folder::new();
    let cases: [(&str, &[u8], [f64; 2]); 6] = [
        ("|u1", &[7, 255], [7.0, 255.0]),
        ("|i1", &[7, 128], [7.0, -128.0]),
        ("<u2", &[1, 2, 255, 255], [513.0, 65535.0]),
        (">i2", &[1, 2, 128, 0], [258.0, -32768.0]),
        (">u4", &[0, 1, 0, 0, 255, 255, 255, 255], [65536.0, 4_294_967_295.0]),
        ("<i8", &[3, 0, 0, 0, 0, 0, 0, 0, 254, 255, 255, 255, 255, 255, 255, 255], [3.0, -2.0]),
    ];
    for (descr, bytes, expected) in cases {
        let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (1, 1, 2), }}");
        let cube = crate::cube::open(&folder.file(&version_1(&header, bytes)), None).unwrap();
        let found: Vec<f64> = match &cube {
            Cube::F32(rows) => {
                rows.read(0..1, &mut Vec::new()).unwrap().iter().map(|x| (*x).into()).collect()
            }
            Cube::F64(rows) => rows.read(0..1, &mut Vec::new()).unwrap().to_vec(),
        };
        assert_eq!(found, expected, "{descr}");
    }
}

#[test]
fn types_that_are_no_counts_are_named_with_the_remedy() {
    let folder = Folder::new();
    for descr in ["'<f16'", "'|O'", "'<M8[s]'", "'|f4'", "'=f4'", "'f4'", "'<f+4'", "'<<f4'", "'<'", "''"] {
        let file =
            version_1(&format!("{{'descr': {descr}, 'fortran_order': False, 'shape': (1, 2), }}"), &[0; 64]);
        let message = folder.refusal(&file);
        let expected = format!(
            "the samples are of type {descr}, not floating-point or whole numbers; write them with np.save(path, a.astype(np.float32))"
        );
        assert_eq!(message, expected);
    }
    let structured = "{'descr': [('a', '<f4'), ('b', '<i2')], 'fortran_order': False, 'shape': (1, 2), }";
    let message = folder.refusal(&version_1(structured, &[0; 12]));
    assert!(
        message.starts_with("the samples are of type [('a', '<f4'), ('b', '<i2')], not floating-point"),
        "{message}"
    );
}

#[test]
fn sizes_that_do_not_fit_are_found_at_opening() {
    let folder = Folder::new();
    for (file, message) in [
        (
            f4("(2, 2)", &[0; 15]),
            "the file has 15 of the 16 bytes of samples that its header announces; it was not written or copied to its end; write it again",
        ),
        (
            f4("(2, 2)", &[]),
            "the file has 0 of the 16 bytes of samples that its header announces; it was not written or copied to its end; write it again",
        ),
        (
            f4("(2, 2)", &[0; 17]),
            "the file has 1 bytes more than its header announces; write the array alone with np.save(path, a)",
        ),
        (
            f4("(2, 0, 3)", &[]),
            "a cube of 2 rows, 0 columns and 3 bands; give one with at least one of each, and no more than memory can address",
        ),
        (
            f4("(4294967296, 4294967296, 2)", &[]),
            "a cube of 4294967296 rows, 4294967296 columns and 2 bands; give one with at least one of each, and no more than memory can address",
        ),
        (
            f4("(4,)", &[0; 16]),
            "the array has 1 dimension; give [row][column][band]; a spectrum as [1][1][band]",
        ),
        (
            f4("()", &[0; 4]),
            "the array has 0 dimensions; give [row][column][band], or [row][column] for one band",
        ),
        (
            f4("(1, 1, 2, 2)", &[0; 16]),
            "the array has 4 dimensions; give [row][column][band], or [row][column] for one band",
        ),
        (
            f4("(900000000, 900000000)", &[0; 16]),
            "the file has 16 of the 3240000000000000000 bytes of samples that its header announces; it was not written or copied to its end; write it again",
        ),
    ] {
        assert_eq!(folder.refusal(&file), message);
    }
    for shape in ["(99999999999999999999, 1)", "(-1, 2)", "(1.5, 2)", "'no'"] {
        let message = folder.refusal(&f4(shape, &[0; 16]));
        assert!(message.starts_with("the header `{'descr': '<f4'"), "{message}");
    }
}

#[test]
fn files_of_another_kind_are_told_apart() {
    let folder = Folder::new();
    for (bytes, message) in [
        (b"".as_slice(), "the file is empty"),
        (b"row,column\n1,2\n", "this is not an NPY file: it does not begin with \\x93NUMPY"),
        (b"PK\x03\x04....", "the archive is damaged"),
        (b"\x93NUMPY\x04\x00v\x00{}..", "the file is of version 4 of the NPY format"),
        (b"\x93NUMPY\x01\x00v", "the file ends within its header"),
        (b"\x93NUMPY\x01\x00v\x00{'descr': '<f4'", "the file ends within its header"),
    ] {
        let found = folder.refusal(bytes);
        assert!(found.starts_with(message), "{found}");
    }
    let named = crate::cube::open(&folder.file(&f4("(1, 1)", &[0; 4])), Some("S")).unwrap_err().to_string();
    assert!(named.contains("a variable `S` is named, but an NPY file has one array"), "{named}");
    let missing = crate::cube::open(&folder.0.path().join("none.npy"), None).unwrap_err().to_string();
    assert!(
        missing.ends_with("cannot read the cube: there is no such file; check its name and folder"),
        "{missing}"
    );
    let directory = crate::cube::open(folder.0.path(), None).unwrap_err().to_string();
    assert!(directory.ends_with("this is a directory; name a file"), "{directory}");
    if cfg!(unix) {
        let device = crate::cube::open("/dev/null".as_ref(), None).unwrap_err().to_string();
        assert!(device.contains("this is no ordinary file"), "{device}");
    }
}

#[test]
fn no_header_makes_it_panic() {
    let folder = Folder::new();
    let good = f4("(2, 3, 4)", &[0; 96]);
    assert!(crate::cube::open(&folder.file(&good), None).is_ok());
    for len in 0..good.len() {
        assert!(crate::cube::open(&folder.file(&good[..len]), None).is_err(), "{len}");
    }
    for place in 0..128 {
        for value in [good[place] ^ 1, good[place] ^ 0x10, good[place] ^ 0x80, b'9', b'(', b'[', b'\\'] {
            let mut bad = good.clone();
            bad[place] = value;
            let _ = crate::cube::open(&folder.file(&bad), None);
        }
    }
    // Nested as deep as is allowed, on the small stack of a test's thread, and deeper.
    for depth in [61, 5000] {
        let nested = f4(&format!("{}{}", "(".repeat(depth), ")".repeat(depth)), &[]);
        assert!(crate::cube::open(&folder.file(&nested), None).is_err());
    }
}

#[test]
fn a_short_text_is_read_in_either_width() {
    let unit = "W m-2 sr-1 um-1";
    let wide: Vec<u8> = unit.chars().flat_map(|c| u32::from(c).to_le_bytes()).collect();
    for (descr, data) in [("<U15", wide.as_slice()), ("|S15", unit.as_bytes())] {
        let file = version_1(&format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (), }}"), data);
        assert_eq!(text(&mut file.as_slice(), file.len() as u64, 100).as_deref(), Some(unit));
        assert_eq!(text(&mut file.as_slice(), file.len() as u64, 14), None);
        assert_eq!(text(&mut &file[..file.len() - 1], file.len() as u64 - 1, 100), None);
    }
    let numbers = f4("(1,)", &[0; 4]);
    assert_eq!(text(&mut numbers.as_slice(), numbers.len() as u64, 100), None);
}
