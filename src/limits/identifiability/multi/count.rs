//! How many materials can be compared with each other: of n there are n² distances, of which all are kept.

use crate::error::{Error, Result};

/// Materials compared with each other at most: one matrix of their distances takes 3.2 GB.
const MOST: usize = 20_000;
/// A nearest distance with its proof in some hundreds of bands takes about that long, s.
const DISTANCE_S: f64 = 1e-4;

/// Makes sure that there is room for all pairs of so many materials.
///
/// # Errors
/// Of more than 20 000, with what they would take.
pub fn check_count(count: usize) -> Result<()> {
    if count <= MOST {
        return Ok(());
    }
    let pairs = (count as f64).powi(2);
    let (gigabytes, hours) = (8e-9 * pairs, DISTANCE_S * pairs / 3600.0);
    let expected = format!(
        "at most {MOST}: a matrix of that many distances takes {gigabytes:.0} GB and some {hours:.0} hours of a core; divide the \
         library, or ask for one target against all"
    );
    Err(Error::out_of_range("number of materials compared with each other", count as f64, "", expected))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_many_materials_are_refused_with_what_they_would_take() {
        assert!(check_count(MOST).is_ok());
        let told = check_count(100_000).unwrap_err().to_string();
        assert!(told.contains("80 GB") && told.contains("278 hours") && told.contains("20000"), "{told}");
    }
}
