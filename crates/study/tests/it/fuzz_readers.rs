//! Every reader of files against thousands of wrong files: the harness of `fuzz/`, driven without a fuzzer.
//!
//! Files are made of the seeds in `fuzz/seeds` by changes that a number decides, so that a run can be repeated.
//! `HADAR_FUZZ_INPUTS=1000000 cargo test --release -p hadar-study --test it fuzz_readers` makes so many for all readers
//! together. One that fails is kept in `target/tmp`; copied into the reader's seeds, it is checked ever after. Where the whole
//! process dies, the file that was read last is still in the temporary folder (`/dev/shm` or that of the system).

use crate::support::harness::{READERS, Reader};
use crate::support::mutation::mutated;
use flate2::{Compression, write::ZlibEncoder};
use hadar_testing::repository;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::process::Command;
use std::time::Duration;

/// Files that are made where nothing is said, for all readers together.
const INPUTS: u64 = 40_000;
/// Processor time that a file of at most a megabyte may take, where the system states it (Linux). Some milliseconds are usual.
const LONGEST: Duration = Duration::from_secs(10);
/// Memory that the process of one reader may have had at most, bytes.
const MOST_MEMORY: u64 = 1 << 30;
/// Set in the process of one reader.
const ALONE: &str = "HADAR_TEST_ALONE";

fn seeds(name: &str) -> Vec<(String, Vec<u8>)> {
    let folder = repository().join("fuzz/seeds").join(name);
    let mut files: Vec<_> = std::fs::read_dir(&folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    files
        .iter()
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(path).unwrap()))
        .collect()
}

/// Does the work of the test of this name in a process of its own, whose memory is that of no other test.
fn alone(name: &str, work: impl FnOnce()) {
    if std::env::var_os(ALONE).is_some() {
        work();
        return memory();
    }
    let test = format!("{}::{name}", module_path!().split_once("::").map_or("", |(_, module)| module));
    let arguments = [&test, "--exact", "--nocapture", "--test-threads=1"];
    let output =
        Command::new(std::env::current_exe().unwrap()).args(arguments).env(ALONE, "1").output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}\n{said}{}", output.status, String::from_utf8_lossy(&output.stderr));
    assert!(said.contains("1 passed"), "{test} is no test: {said}");
}

/// Processor time that this thread has had, where the system states it.
fn processor_time() -> Option<Duration> {
    let nanoseconds = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(Duration::from_nanos(nanoseconds.split(' ').next()?.parse().ok()?))
}

/// Checks one file; one that fails is kept and said.
fn check(reader: &Reader, what: &str, bytes: &[u8]) {
    let start = processor_time();
    let outcome = catch_unwind(AssertUnwindSafe(|| reader.check(bytes)));
    let taken = processor_time().zip(start).map(|(end, start)| end.saturating_sub(start));
    if outcome.is_ok() && taken.is_none_or(|taken| taken < LONGEST) {
        return;
    }
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}-{what}", reader.name));
    std::fs::write(&kept, bytes).unwrap();
    let shown: String =
        bytes.iter().take(2000).flat_map(|&byte| std::ascii::escape_default(byte)).map(char::from).collect();
    panic!("{} {what}, after {taken:?}, kept as {}:\n{shown}", reader.name, kept.display());
}

fn run(name: &str) {
    let reader = READERS.iter().find(|reader| reader.name == name).unwrap();
    let (names, files): (Vec<_>, Vec<_>) = seeds(name).into_iter().unzip();
    for (name, bytes) in names.iter().zip(&files) {
        check(reader, name, bytes);
    }
    let inputs = std::env::var("HADAR_FUZZ_INPUTS").map_or(INPUTS, |inputs| inputs.parse().unwrap());
    for number in 0..inputs.div_ceil(READERS.len() as u64) {
        check(reader, &number.to_string(), &mutated(&files, name, number));
    }
}

/// Where the system says how much memory the process has had at most, that it was not too much.
fn memory() {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return };
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = peak.and_then(|peak| peak.trim().strip_suffix(" kB")?.parse::<u64>().ok());
    let bytes = 1024 * kilobytes.expect("VmHWM in kB");
    assert!(bytes < MOST_MEMORY, "{bytes} bytes of memory for small files");
}

macro_rules! readers {
    ($($name:ident),* $(,)?) => {
        $(#[test]
        fn $name() {
            alone(stringify!($name), || run(stringify!($name)));
        })*

        #[test]
        fn every_reader_is_tested_and_fuzzed() {
            let tested = [$(stringify!($name)),*];
            assert_eq!(tested.to_vec(), READERS.iter().map(|reader| reader.name).collect::<Vec<_>>());
            let root = repository();
            let manifest = std::fs::read_to_string(root.join("fuzz/Cargo.toml")).unwrap();
            for name in tested {
                let target = std::fs::read_to_string(root.join(format!("fuzz/fuzz_targets/{name}.rs"))).unwrap();
                assert!(target.contains(&format!("check(\"{name}\", bytes)")), "{target}");
                assert!(manifest.contains(&format!("path = \"fuzz_targets/{name}.rs\"")), "{name}");
            }
        }
    };
}

readers! {
    material, library, manifest, optical_constants, spectral_library, band_rows, filters, scenario, range_scenario, quantity, npy, mat,
    npz, envi, hdf5, cube, noise, model,
}

/// Every four bytes of every binary seed as if they were a length that no file has.
#[test]
fn lengths_that_a_file_states_are_held_against_it() {
    alone("lengths_that_a_file_states_are_held_against_it", || {
        for name in ["npy", "mat", "npz", "hdf5", "cube"] {
            let reader = READERS.iter().find(|reader| reader.name == name).unwrap();
            for (seed, bytes) in seeds(name) {
                for place in (0..bytes.len().saturating_sub(4)).step_by(4) {
                    let wrong = [0xF4E4_E4E4_u32, 0x7FFF_FFFF, 0x0010_0000][place / 4 % 3];
                    let mut changed = bytes.clone();
                    changed[place..place + 4].copy_from_slice(&wrong.to_le_bytes());
                    check(reader, &format!("{seed}-{place}-{wrong}"), &changed);
                    if name == "cube" {
                        changed[place..place + 4].copy_from_slice(&wrong.to_be_bytes());
                        check(reader, &format!("{seed}-{place}-{wrong}-turned"), &changed);
                    }
                }
            }
        }
    });
}

/// Files that are long, wide or deep, which no change of a seed makes.
#[test]
fn long_wide_and_deep_files_take_neither_long_nor_much() {
    alone("long_wide_and_deep_files_take_neither_long_nor_much", long_wide_and_deep);
}

fn long_wide_and_deep() {
    let most = 1 << 19;
    let times = |text: &str| text.repeat(most / text.len());
    let rows =
        |start: usize, row: &dyn Fn(usize) -> String| (start..start + most / 20).map(row).collect::<String>();
    let texts = [
        times("a"),
        times(","),
        times("\n"),
        times("\0"),
        times("["),
        times("{"),
        times("("),
        times("a."),
        times("a=["),
        times("a={b="),
        times("\"a\":["),
        times("\u{85}\u{1b}"),
        format!("wavenumber_cm1,{}\n800{}\n900{}\n", times("a,"), ",1".repeat(9), ",1".repeat(9)),
        // As many materials as there are columns.
        {
            let columns: String = (0..most / 8).map(|i| format!(",x{i}")).collect();
            let cells = ",1".repeat(most / 8);
            format!("wavenumber_cm1{columns}\n800{cells}\n900{cells}\n")
        },
        format!("wavenumber_cm1,emissivity\n{}", rows(1, &|i| format!("{i},0.5\n"))),
        format!("wavelength;emissivity\n{}", rows(1, &|i| format!("{i},5;0,5\n"))),
        format!(
            "##TITLE= a\n##XUNITS= 1/CM\n##YUNITS= %R\n##FIRSTX= 1\n##LASTX= 9\n##XYDATA= (X++(Y..Y))\n1A{}\n",
            times("Z99%")
        ),
        format!("##TITLE= a\n{}", times("##TITLE= a\n##XYDATA=\n")),
        format!("ENVI\nfile type = ENVI Spectral Library\nwavelength = {}\n", times("{1,")),
        format!("wavelength_um,n,k\n{}", rows(1, &|i| format!("{i},1.5,0\n"))),
        format!("wavelength_um,{}\n1,1\n2,1\n", times("x")),
        format!("{}: a\n", times("Name")),
        format!(
            "Name: {0}\nX Units: micrometers {0}\nY Units: reflectance percent {0}\nNumber of X Values: {0}\n\n",
            "y".repeat(most / 4)
        ),
        format!("variance_counts2\n{}", times("1\n")),
        format!("band,variance_counts2\n{}", rows(0, &|i| format!("{i},1\n"))),
        // A key that every item of its list would repeat, and tables in tables.
        format!("{} = [{}]\n", "k".repeat(most / 2), "0,".repeat(most / 4)),
        format!("[target]\n{}\nmaterial = \"skin\"\n", rows(0, &|i| format!("key{i} = 0\n"))),
        format!("x = {}{}\n", format!("{{{}x = ", "y.".repeat(70)).repeat(70), "0"),
        format!("x = {}{}{}\n", format!("{{{}x = ", "y.".repeat(70)).repeat(70), "0", "}".repeat(70)),
        format!("[target]\nmaterial = \"{}\"\ntemperature = \"37 degC\"\n", times("m")),
        format!("[target]\nmaterial = \"skin\"\ntemperature = \"{}\"\n", times("3")),
        format!("[target]\nmaterial = \"skin\"\ntemperature = 1{}\n", times("0")),
        format!(
            "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n[alternatives]\nmaterials = [{}]\n",
            rows(0, &|i| format!("\"m{i}\","))
        ),
        format!(
            "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n{}",
            times("[[environment]]\ntemperature = \"1 K\"\nlighting = 0\n")
        ),
        // Every material is made of the one before it: twice of it, or it alone.
        {
            let doubled = |i: usize| {
                format!(
                    "[[material]]\nname = \"m{}\"\nmodel = {{ mixture = [{{ parts = 1.0, of = {{ material = \"m{i}\" }} }}, {{ parts = 1.0, of = {{ material = \"m{i}\" }} }}] }}\n",
                    i + 1
                )
            };
            format!(
                "version = 1\n[[material]]\nname = \"m0\"\nmodel = {{ table = \"e.csv\" }}\n{}",
                (0..60).map(doubled).collect::<String>()
            )
        },
        {
            let rough = |i: usize| {
                format!(
                    "[[material]]\nname = \"m{}\"\nmodel = {{ cavity = {{ area_ratio = 2.0, of = {{ material = \"m{i}\" }} }} }}\n",
                    i + 1
                )
            };
            format!(
                "version = 1\n[[material]]\nname = \"m0\"\nmodel = {{ constant = 0.5 }}\n{}",
                (0..5000).map(rough).collect::<String>()
            )
        },
        format!(
            "version = 1\n{}",
            rows(0, &|i| format!("[[material]]\nname = \"m{i}\"\nmodel = {{ constant = 0.5 }}\n"))
        ),
    ];
    let mut files: Vec<Vec<u8>> = texts.into_iter().map(String::into_bytes).collect();
    for deep in ["{", "(", "[", "{(", "([", "{1:", "b'", "-"] {
        let header = format!("{{'descr': {}", deep.repeat(60 / deep.len()));
        let len = u16::try_from(header.len()).unwrap().to_le_bytes();
        files.push([b"\x93NUMPY\x01\x00", len.as_slice(), header.as_bytes()].concat());
    }
    files.push(announces_more_than_it_holds());
    for reader in READERS {
        for (number, bytes) in files.iter().enumerate() {
            check(reader, &format!("large-{number}"), bytes);
        }
    }
}

/// A MATLAB file of 200 kB with a packed array of bytes that would be 1.6 GB of doubles.
fn announces_more_than_it_holds() -> Vec<u8> {
    let held = 200_000_u32;
    let side = 14_000_u32;
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    // Flags of a double array, dimensions, the name S, bytes.
    let head = words(&[6, 8, 6, 0, 5, 8, side, side, 1 << 16 | 1, u32::from(b'S'), 2, side * side]);
    let len = u32::try_from(head.len()).unwrap() + side * side;
    let array = [words(&[14, len]), head, vec![1; held as usize]].concat();
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::none());
    packed.write_all(&array).unwrap();
    let packed = packed.finish().unwrap();
    let mut file = vec![b' '; 124];
    file.extend(*b"\0\x01IM");
    file.extend(words(&[15, u32::try_from(packed.len()).unwrap()]));
    file.extend(packed);
    file
}
