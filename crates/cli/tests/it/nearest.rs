//! Nearest distances of scenes in which a search went wrong once, against minima of 60 digits.

use crate::support::answers::number;
use crate::support::folder::Folder;

/// The least distance; a range of the alternative's state that is wide, and one confined to the minimum: no range may make the
/// distance larger by being wider, and each is proved.
#[test]
fn wide_ranges_lose_no_state_that_narrow_ones_find() {
    let Some(folder) = hadar_testing::shared("reference/nearest") else { return };
    for (scene, least) in [
        ("nearest_8039_0", 8.8902e-8),
        ("nearest_8000_2", 0.048_891_6),
        ("nearest_6304_2", 0.001_783_21),
        ("nearest_12120_1", 9.5691e-4),
        ("nearest_6230_3", 1.226_95e-12),
    ] {
        for range in ["wide.toml", "narrow.toml"] {
            let scenario = folder.join(scene).join(range);
            let found = Folder::with("").json(&["identify", scenario.to_str().unwrap()]);
            let pair = &found["pairs"][0];
            let (distance, lower) =
                (number(&pair["distance_nearest"]), number(&pair["distance_nearest_lower"]));
            assert!((distance / least - 1.0).abs() < 1e-5, "{scene} {range}: {distance:e}");
            assert!(lower <= distance && lower >= distance * (1.0 - 1e-6), "{scene} {range}: {lower:e}");
            assert_eq!(pair["proof"], "proved", "{scene} {range}");
            let back = number(&pair["distance_return"]);
            assert!(back <= distance * (1.0 + 1e-9), "{scene} {range}: {back:e} {distance:e}");
            let warnings = found["warnings"].as_array().unwrap();
            assert!(warnings.iter().all(|warning| warning["code"] != "nearest-search"), "{warnings:?}");
        }
    }
}
