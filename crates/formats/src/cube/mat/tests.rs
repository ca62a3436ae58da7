use super::*;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;
use std::path::PathBuf;

/// A number as it stands in the file, in both orders of bytes.
trait Bytes: Copy {
    const KIND: u32;
    fn bytes(self, little_endian: bool) -> Vec<u8>;
}

macro_rules! bytes {
    ($($type:ty = $kind:literal),*) => {
        $(impl Bytes for $type {
            const KIND: u32 = $kind;
            fn bytes(self, little_endian: bool) -> Vec<u8> {
                if little_endian { self.to_le_bytes().to_vec() } else { self.to_be_bytes().to_vec() }
            }
        })*
    };
}

bytes!(i8 = 1, u8 = 2, i16 = 3, u16 = 4, i32 = 5, u32 = 6, f32 = 7, f64 = 9, i64 = 12, u64 = 13);

/// Writes files of version 5.
#[derive(Debug, Clone, Copy)]
struct Writer {
    little_endian: bool,
    compressed: bool,
}

const PLAIN: Writer = Writer { little_endian: true, compressed: false };
const ZLIB: Writer = Writer { little_endian: true, compressed: true };

impl Writer {
    fn part<T: Bytes>(self, kind: u32, numbers: &[T]) -> Vec<u8> {
        let data: Vec<u8> = numbers.iter().flat_map(|number| number.bytes(self.little_endian)).collect();
        let len = data.len() as u32;
        // MATLAB puts up to four bytes into the tag.
        if (1..=4).contains(&len) {
            return [(kind | len << 16).bytes(self.little_endian), data, vec![0; 4 - len as usize]].concat();
        }
        let padding = vec![0; len.next_multiple_of(8) as usize - data.len()];
        [kind.bytes(self.little_endian), len.bytes(self.little_endian), data, padding].concat()
    }

    /// An array of a class, with the bits beside it in its flags.
    fn array<T: Bytes>(self, name: &str, class: u32, dimensions: &[i32], numbers: &[T]) -> Vec<u8> {
        let parts = [
            self.part(6, &[class, 0]),
            self.part(5, dimensions),
            self.part(1, name.as_bytes()),
            self.part(T::KIND, numbers),
        ]
        .concat();
        let len = (parts.len() as u32).bytes(self.little_endian);
        let element = [14_u32.bytes(self.little_endian), len, parts].concat();
        if !self.compressed {
            return element;
        }
        let mut stream = ZlibEncoder::new(Vec::new(), Compression::default());
        stream.write_all(&element).unwrap();
        let stream = stream.finish().unwrap();
        [15_u32.bytes(self.little_endian), (stream.len() as u32).bytes(self.little_endian), stream].concat()
    }

    fn file(self, arrays: &[Vec<u8>]) -> Vec<u8> {
        let mut file = b"MATLAB 5.0 MAT-file, Platform: GLNXA64".to_vec();
        file.resize(124, b' ');
        file.extend(if self.little_endian { *b"\0\x01IM" } else { *b"\x01\0MI" });
        file.extend(arrays.concat());
        file
    }
}

#[derive(Debug)]
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn file(&self, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join("a.mat");
        // Some file systems wait for the disk when a file is overwritten.
        let _ = std::fs::remove_file(&path);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    fn open(&self, bytes: &[u8], variable: Option<&str>) -> Result<Cube> {
        crate::cube::open(&self.file(bytes), variable)
    }

    /// The message without the path.
    fn refusal(&self, bytes: &[u8], variable: Option<&str>) -> String {
        let path = self.file(bytes);
        let message = crate::cube::open(&path, variable).unwrap_err().to_string();
        message.strip_prefix(&path.display().to_string()).unwrap().trim_start_matches(": ").to_owned()
    }
}

fn samples(cube: &Cube) -> Vec<f64> {
    let rows = 0..cube.shape().rows();
    match cube {
        Cube::F32(cube) => cube.read(rows, &mut Vec::new()).unwrap().iter().map(|&n| f64::from(n)).collect(),
        Cube::F64(cube) => cube.read(rows, &mut Vec::new()).unwrap().to_vec(),
    }
}

/// Place of `[row][column][band]` in MATLAB's order, for every sample in ours.
fn places(shape: Shape) -> impl Iterator<Item = usize> {
    let (rows, columns, bands) = (shape.rows(), shape.columns(), shape.bands());
    (0..rows).flat_map(move |row| {
        (0..columns)
            .flat_map(move |column| (0..bands).map(move |band| row + rows * (column + columns * band)))
    })
}

fn check<T: Bytes>(class: u32, double: bool, to: impl Fn(usize) -> T, value: impl Fn(usize) -> f64) {
    let folder = Folder::new();
    // Rows and bands beyond a tile, and fewer than one.
    for (rows, columns, bands) in [(2, 3, 4), (1, 1, 2), (17, 3, 33), (35, 2, 16), (16, 4, 1)] {
        let shape = Shape::new(rows, columns, bands).unwrap();
        let numbers: Vec<T> = (0..shape.len()).map(&to).collect();
        let sides = [rows as i32, columns as i32, bands as i32];
        let sides = if bands == 1 { &sides[..2] } else { &sides };
        for (little_endian, compressed) in [(true, false), (true, true), (false, false), (false, true)] {
            let writer = Writer { little_endian, compressed };
            let cube = folder.open(&writer.file(&[writer.array("S", class, sides, &numbers)]), None).unwrap();
            assert_eq!((cube.shape(), matches!(cube, Cube::F64(_))), (shape, double));
            assert_eq!(samples(&cube), places(shape).map(&value).collect::<Vec<_>>());
        }
    }
}

#[test]
fn every_class_and_type_of_storage_comes_out_as_rows_columns_and_bands() {
    check::<f64>(6, true, |i| (i as f64).sqrt(), |i| (i as f64).sqrt());
    check::<f32>(7, false, |i| 0.1 * i as f32, |i| f64::from(0.1 * i as f32));
    // Doubles and singles that are whole numbers are stored as the smallest integer that holds them.
    check::<u8>(6, true, |i| i as u8, |i| f64::from(i as u8));
    check::<i16>(7, false, |i| -(i as i16), |i| -(i as f64));
    check::<i32>(6, true, |i| i as i32 * 1_000_003, |i| i as f64 * 1_000_003.0);
    // Integers of at most 16 bits fit into f32, others need f64.
    check::<i8>(8, false, |i| i as i8, |i| f64::from(i as i8));
    check::<u8>(9, false, |i| i as u8, |i| f64::from(i as u8));
    check::<i16>(10, false, |i| i as i16, |i| i as f64);
    check::<u16>(11, false, |i| 65_535 - i as u16, |i| 65_535.0 - i as f64);
    check::<i32>(12, true, |i| i as i32, |i| i as f64);
    check::<u32>(13, true, |i| u32::MAX - i as u32, |i| f64::from(u32::MAX) - i as f64);
    check::<i64>(14, true, |i| -(i as i64), |i| -(i as f64));
    check::<u64>(15, true, |i| 1 << 53 | i as u64, |i| (1_u64 << 53 | i as u64) as f64);
}

#[test]
fn another_reader_finds_the_same_numbers() {
    let shape = Shape::new(5, 4, 3).unwrap();
    let numbers: Vec<f64> = (0..60).map(|i| f64::from(i).exp()).collect();
    let folder = Folder::new();
    for writer in [PLAIN, ZLIB] {
        let file = writer.file(&[writer.array("S", 6, &[5, 4, 3], &numbers)]);
        let other = matfile::MatFile::parse(file.as_slice()).unwrap();
        let array = other.find_by_name("S").unwrap();
        assert_eq!(array.size(), &[5, 4, 3]);
        let matfile::NumericData::Double { real, imag: None } = array.data() else { panic!("{array:?}") };
        let theirs: Vec<f64> = places(shape).map(|place| real[place]).collect();
        assert_eq!(samples(&folder.open(&file, None).unwrap()), theirs);
    }
}

#[test]
fn the_variable_is_the_one_that_is_named_or_the_only_one_meant() {
    let folder = Folder::new();
    let cube = |name: &str, value: f64| PLAIN.array(name, 6, &[1, 1, 2], &[value, value]);
    let matrix = |name: &str| ZLIB.array(name, 7, &[2, 1], &[7.0_f32, 8.0]);
    let text = PLAIN.array("author", 4, &[1, 2], &[65_u16, 66]);
    // What MATLAB keeps for objects has no name.
    let nameless = PLAIN.array("", 9, &[1, 8], &[0_u8; 8]);
    let first = |file: &[Vec<u8>], name| samples(&folder.open(&PLAIN.file(file), name).unwrap())[0];
    assert_eq!(first(&[matrix("x"), cube("S", 3.0), text.clone(), matrix("y")], None), 3.0);
    assert_eq!(first(&[matrix("x"), text.clone(), nameless], None), 7.0);
    assert_eq!(first(&[cube("S", 3.0), cube("S2", 4.0)], Some("S2")), 4.0);
    assert_eq!(first(&[cube("S", 3.0), matrix("x")], Some("x")), 7.0);
    for (arrays, name, message) in [
        (
            vec![cube("left", 1.0), matrix("x"), cube("right", 1.0)],
            None,
            "the file has 2 arrays that may be meant: `left` (1 x 1 x 2 double), `right` (1 x 1 x 2 double); name one of them as the variable",
        ),
        (
            vec![matrix("x"), matrix("y")],
            None,
            "the file has 2 arrays that may be meant: `x` (2 x 1 single), `y` (2 x 1 single); name one of them as the variable",
        ),
        (
            vec![cube("left", 1.0), text.clone()],
            Some("Left"),
            "there is no variable `Left`; the file has `left` (1 x 1 x 2 double), `author` (1 x 2 char)",
        ),
        (
            vec![text.clone()],
            None,
            "the file has `author` (1 x 2 char), but no array of numbers; save the cube as a double or single array [row][column][band]",
        ),
        (
            vec![text],
            Some("author"),
            "author: the variable is of class char; save the cube as a double or single array [row][column][band]",
        ),
        (
            vec![],
            None,
            "the file has no variable, but no array of numbers; save the cube as a double or single array [row][column][band]",
        ),
    ] {
        assert_eq!(folder.refusal(&PLAIN.file(&arrays), name), message);
    }
}

#[test]
fn arrays_that_are_no_cubes_are_refused() {
    let folder = Folder::new();
    let refusal = |array: Vec<u8>| folder.refusal(&PLAIN.file(&[array]), None);
    let four = PLAIN.array("S", 6, &[1, 1, 1, 2], &[1.0, 2.0]);
    assert!(refusal(four).starts_with("S: the array has 4 dimensions; give"));
    assert!(
        refusal(PLAIN.array::<f64>("S", 6, &[2, 0, 3], &[])).starts_with("S: a cube of 2 rows, 0 columns")
    );
    assert!(refusal(PLAIN.array("S", 0x806, &[1, 2], &[1.0, 2.0])).starts_with("S: the variable is complex"));
    assert!(refusal(PLAIN.array("S", 0x209, &[1, 2], &[1_u8, 0])).starts_with("S: the variable is logical"));
    for (dimensions, message) in [
        (
            vec![2, 2],
            "S: the file is damaged: it has 16 bytes of numbers, not 4 numbers; write or copy it again",
        ),
        (
            vec![1 << 29, 1 << 30],
            "S: the file is damaged: it has 16 bytes of numbers, not 576460752303423488 numbers",
        ),
        (vec![i32::MAX, i32::MAX, i32::MAX], "S: a cube of 2147483647 rows"),
        (vec![-1, 2], "the file is damaged: an array has a negative dimension"),
        (vec![2], "the file is damaged: an array has no dimensions"),
    ] {
        let found = refusal(PLAIN.array("S", 6, &dimensions, &[1.0, 2.0]));
        assert!(found.starts_with(message), "{found}");
    }
}

#[test]
fn files_of_other_versions_are_told_apart() {
    let folder = Folder::new();
    let older = folder.refusal(&[0; 200], None);
    assert!(older.starts_with("this is not a MATLAB file of version 5 or 7.3; write one"), "{older}");
}

#[test]
fn no_truncated_or_changed_file_makes_it_panic() {
    let folder = Folder::new();
    let numbers: Vec<f64> = (0..60).map(f64::from).collect();
    for writer in [PLAIN, ZLIB] {
        let good =
            writer.file(&[writer.array("x", 6, &[1, 1], &[1.5]), writer.array("S", 6, &[5, 4, 3], &numbers)]);
        let truth = samples(&folder.open(&good, None).unwrap());
        let second = 128 + writer.array("x", 6, &[1, 1], &[1.5]).len();
        for len in 0..good.len() {
            // What ends between two arrays is a sound file without the second.
            assert!(folder.open(&good[..len], Some("S")).is_err(), "{len}");
            assert_eq!(folder.open(&good[..len], None).is_ok(), len == second, "{len}");
        }
        for place in 120..good.len() {
            for change in [1, 0x80, 0xff] {
                let mut bad = good.clone();
                bad[place] ^= change;
                let outcome = folder.open(&bad, Some("S"));
                // A stream has a checksum: whatever is read of it is what was written.
                if let (true, true, Ok(cube)) = (writer.compressed, place >= second + 8, outcome) {
                    assert_eq!(samples(&cube), truth, "{place} {change}");
                }
            }
        }
    }
}

/// As MATLAB writes text, in characters of two bytes, and as SciPy does, in UTF-8.
#[test]
fn a_text_beside_the_cube_is_its_unit() {
    let folder = Folder::new();
    let cube = |writer: Writer| writer.array("S", 6, &[1, 1, 2], &[1.0_f64, 2.0]);
    for writer in [PLAIN, ZLIB, Writer { little_endian: false, ..PLAIN }] {
        let said = "W m-2 sr-1 um-1";
        let wide: Vec<u16> = said.encode_utf16().collect();
        let text = writer.array("units", 4, &[1, wide.len() as i32], &wide);
        let path = folder.file(&writer.file(&[cube(writer), text]));
        let opened = open(File::open(path).unwrap(), writer.little_endian, None, None).unwrap();
        assert_eq!(opened.found.unit.as_deref(), Some(said));
    }
    // Of something else, of another array, or no text.
    let axis: Vec<u16> = "um".encode_utf16().collect();
    let numbers = PLAIN.array("units", 6, &[1, 1], &[1.0_f64]);
    for other in [PLAIN.array("units", 4, &[1, 2], &axis), numbers] {
        let path = folder.file(&PLAIN.file(&[cube(PLAIN), other]));
        let found = open(File::open(path).unwrap(), true, Some("S"), None).unwrap().found;
        assert_eq!(found.unit, None);
    }
}
