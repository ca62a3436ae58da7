//! For tests of binary formats: a file that is cut short is refused, and none makes a reader panic.

use super::content::Content;
use super::reading::Reading;
use hadar::error::Result;
use proptest::prelude::*;
use std::path::Path;

/// A reader of one format.
type Parse = fn(&[u8], &Path, &Reading) -> Result<Content>;

/// Emissivities at the rows of all spectra, ascending.
pub(super) fn rows(read: Result<Content>) -> Vec<Vec<(f64, f64)>> {
    let all = read.and_then(Content::materials).unwrap_or_else(|error| panic!("{error}"));
    let of = |material: &hadar::material::Material| {
        let (low, high) = material.range_cm1().unwrap();
        let mut places = material.breakpoints_cm1(low, high);
        places.extend([low, high]);
        places.sort_by(f64::total_cmp);
        places.dedup();
        let emissivities = material.emissivity(&places).unwrap();
        places.into_iter().zip(emissivities).collect()
    };
    all.iter().map(of).collect()
}

/// The message of a file that is refused.
pub(super) fn refused(read: Result<Content>) -> String {
    read.and_then(Content::materials).map(|_| ()).unwrap_err().to_string()
}

/// No start of the file is taken for all of it; changed bytes are read or refused.
pub(super) fn check(parse: Parse, bytes: &[u8]) {
    let read =
        |bytes: &[u8]| parse(bytes, Path::new("a.bin"), &Reading::default()).and_then(Content::materials);
    read(bytes).unwrap();
    for length in 0..bytes.len() {
        assert!(read(&bytes[..length]).is_err(), "{length} of {} bytes", bytes.len());
    }
    let changes = prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6);
    proptest!(hadar_testing::seeded(46, 2000), |(changes in changes)| {
        let mut other = bytes.to_vec();
        for (at, byte) in changes {
            other[at.index(bytes.len())] = byte;
        }
        if let Ok(materials) = read(&other) {
            prop_assert!(materials.iter().all(|material| material.rows() >= 2));
        }
    });
}
