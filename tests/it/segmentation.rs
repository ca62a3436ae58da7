//! Maps of materials as maps of categories.

use hadar_estimate::segmentation::{
    Agreement, Categories, NO_CATEGORY, Object, Part, Rule, objects, segment, smoothed,
};
use proptest::prelude::*;

const NONE: u16 = u16::MAX;
const RULES: [Rule; 2] = [Rule::Raster, Rule::Regions];

/// Materials of a picture of letters: p paint, g glass, m metal, s skin, r road.
fn picture(rows: &[&str]) -> (Vec<u16>, usize) {
    let place =
        |letter: u8| b"pgmsr".iter().position(|one| *one == letter).map_or(NONE, |place| place as u16);
    (rows.iter().flat_map(|row| row.bytes().map(place)).collect(), rows[0].len())
}

/// Car (paint, glass and metal within), robot (metal), person (skin), road.
fn street() -> Categories {
    let car = vec![Part::open(0), Part::enclosed(1), Part::enclosed(2)];
    Categories::new(5, &[car, vec![Part::open(2)], vec![Part::open(3)], vec![Part::open(4)]]).unwrap()
}

fn letters(found: &[u8], columns: usize) -> Vec<String> {
    let letter = |one: &u8| match one {
        0 => 'c',
        1 => 'R',
        2 => 'P',
        3 => '-',
        _ => '?',
    };
    found.chunks(columns).map(|row| row.iter().map(letter).collect()).collect()
}

/// The case of the paper's Fig. S25: the emblem is the car's, the robot is none.
#[test]
fn an_emblem_is_the_cars_and_a_robot_is_not() {
    let (map, columns) = picture(&[
        "rrrrrrrrrr",
        "rppppprrmm",
        "rpggmprrmm", //
        "rppppprrmm",
        "rrrrrrrrrr",
    ]);
    for rule in RULES {
        let found = segment(&map, columns, &street(), rule).unwrap();
        let expected = [
            "----------",
            "-ccccc--RR",
            "-ccccc--RR", //
            "-ccccc--RR",
            "----------",
        ];
        assert_eq!(letters(&found, columns), expected, "{rule:?}");
    }
}

/// A robot to the right of a car: the neighbour on its left makes Algorithm 4 call all of it a car; as a region it is a robot.
#[test]
fn a_robot_beside_a_car_is_a_robot_only_as_a_region() {
    let (map, columns) = picture(&[
        "rrrrrrrr", "rpppmmrr", //
        "rpppmmrr", "rrrrmmrr",
    ]);
    let by = |rule| letters(&segment(&map, columns, &street(), rule).unwrap(), columns);
    assert_eq!(by(Rule::Raster), ["--------", "-ccccc--", "-ccccc--", "----cc--"]);
    assert_eq!(by(Rule::Regions), ["--------", "-cccRR--", "-cccRR--", "----RR--"]);
}

/// What has no neighbour yet is asked for once more from the end; what touches nothing has no category.
#[test]
fn glass_before_its_paint_and_glass_alone() {
    let (map, columns) = picture(&[
        "gprr", //
        "pprr", "xxxx", "xgxx",
    ]);
    for rule in RULES {
        let found = segment(&map, columns, &street(), rule).unwrap();
        // Glass is in the car alone, so it needs no neighbour.
        assert_eq!(letters(&found, columns), ["cc--", "cc--", "????", "?c??"], "{rule:?}");
    }
    let two = Categories::new(2, &[vec![Part::open(0), Part::enclosed(1)], vec![Part::enclosed(1)]]).unwrap();
    for rule in RULES {
        assert_eq!(segment(&[1, 0, NONE, 1], 4, &two, rule).unwrap(), [0, 0, NO_CATEGORY, NO_CATEGORY]);
    }
}

/// Glass within metal within paint: the inner region waits for the outer one.
#[test]
fn regions_within_regions_are_decided_from_the_outside() {
    let parts = |open| vec![Part::open(open), Part::enclosed(1), Part::enclosed(2)];
    let categories = Categories::new(4, &[parts(0), parts(3)]).unwrap();
    let rows = ["ppppp", "pmmmp", "pmgmp", "pmmmp", "ppppp"];
    let (map, columns) = picture(&rows);
    let found = segment(&map, columns, &categories, Rule::Regions).unwrap();
    assert!(found.iter().all(|one| *one == 0), "{found:?}");
}

#[test]
fn agreement_by_hand() {
    // The last column is undecided. Truth 0 0 0 1 1, none of them, not known; found 0 0 1 1 none, 0, 0.
    let none = NO_CATEGORY;
    let truth = [Some(0), Some(0), Some(0), Some(1), Some(1), Some(none), None];
    let agreement = Agreement::of(&[0, 0, 1, 1, none, 0, 0], truth, 3);
    assert_eq!(agreement.confusion, [[2, 1, 0, 0, 0], [0, 1, 0, 1, 0], [0, 0, 0, 0, 0], [1, 0, 0, 0, 0]]);
    let [a, b, c] = agreement.iou[..] else { panic!() };
    assert!((a.unwrap() - 0.5).abs() < 1e-15 && (b.unwrap() - 1.0 / 3.0).abs() < 1e-15 && c.is_none());
    assert!((agreement.mean_iou.unwrap() - 5.0 / 12.0).abs() < 1e-15);
    assert!((agreement.right.unwrap() - 0.5).abs() < 1e-15 && agreement.pixels == 6);
    assert_eq!(Agreement::of(&[none], [Some(none)], 1).mean_iou, None);
    assert_eq!(Agreement::of(&[0], [None], 1).right, None);
}

#[test]
fn objects_are_connected_parts_the_largest_first() {
    let n = NO_CATEGORY;
    #[rustfmt::skip]
    let map = [
        1, n, 0, n,
        n, 1, 0, n,
        n, n, 0, n,
        n, 0, 0, 2,
    ];
    let found = objects(&map, 4, 2).unwrap();
    let expected = [
        Object { category: 0, pixels: 5, rows: [0, 4], columns: [1, 3] },
        Object { category: 1, pixels: 2, rows: [0, 2], columns: [0, 2] },
    ];
    assert_eq!(found.all, expected);
    assert_eq!((found.of_pixel[0], found.of_pixel[14], found.of_pixel[15]), (Some(1), Some(0), None));
}

#[test]
fn what_is_wrong_is_said() {
    let says = |made: hadar::Result<Categories>| made.unwrap_err().to_string();
    assert!(says(Categories::new(2, &[vec![Part::open(0)], vec![]])).starts_with("category[1]: no material"));
    assert!(says(Categories::new(2, &[vec![Part::open(2)]])).contains("material 2 of 2"));
    let twice = vec![Part::open(0), Part::enclosed(0)];
    assert!(says(Categories::new(2, &[twice])).contains("twice"));
    assert!(says(Categories::new(1, &vec![vec![Part::open(0)]; 256])).contains("at most 63"));
    let error = segment(&[0; 5], 2, &street(), Rule::Raster).unwrap_err().to_string();
    assert!(error.contains("5 pixels in rows of 2 columns"), "{error}");
    for columns in [0, 3] {
        assert!(segment(&[], columns, &street(), Rule::Regions).unwrap().is_empty());
        assert!(smoothed(&[], columns).unwrap().is_empty());
    }
    assert!(smoothed(&[1], 0).is_err() && objects(&[1], 0, 1).is_err());
}

/// The commonest of a window, from all of it at once.
fn commonest(map: &[u8], columns: usize, row: usize, column: usize) -> u8 {
    let rows = map.len() / columns;
    let mirrored = |mut at: i64, length: i64| loop {
        at = match at {
            ..0 => -1 - at,
            _ if at >= length => 2 * length - 1 - at,
            _ => return at as usize,
        };
    };
    let mut counts = std::collections::BTreeMap::new();
    for down in -2..=2 {
        for across in -2..=2 {
            let (i, j) =
                (mirrored(row as i64 + down, rows as i64), mirrored(column as i64 + across, columns as i64));
            *counts.entry(map[i * columns + j]).or_insert(0) += 1;
        }
    }
    let most = *counts.values().max().unwrap();
    let own = map[row * columns + column];
    if counts[&own] == most { own } else { *counts.iter().find(|(_, count)| **count == most).unwrap().0 }
}

proptest! {
    #[test]
    fn smoothing_is_the_commonest_of_the_window(
        columns in 1_usize..9,
        map in prop::collection::vec(prop_oneof![0_u8..4, Just(NO_CATEGORY)], 9..90),
    ) {
        let map = &map[..map.len() / columns * columns];
        let found = smoothed(map, columns).unwrap();
        for (i, one) in found.iter().enumerate() {
            prop_assert_eq!(*one, commonest(map, columns, i / columns, i % columns));
        }
    }

    /// Regions know neither left nor right, and a pixel only gets a category that its material can be in.
    #[test]
    fn regions_have_no_direction(columns in 1_usize..12, map in prop::collection::vec(0_u16..6, 12..140)) {
        let map = &map[..map.len() / columns * columns];
        let categories = Categories::new(
            5,
            &[
                vec![Part::open(0), Part::enclosed(1), Part::enclosed(2)],
                vec![Part::open(2), Part::enclosed(3)],
                vec![Part::open(3), Part::enclosed(1)],
            ],
        ).unwrap();
        let turned = |of: &[u16]| of.iter().rev().copied().collect::<Vec<u16>>();
        let found = segment(map, columns, &categories, Rule::Regions).unwrap();
        let mut back = segment(&turned(map), columns, &categories, Rule::Regions).unwrap();
        back.reverse();
        let allowed = [&[0][..], &[0, 2], &[0, 1], &[1, 2], &[], &[]];
        for (i, one) in found.iter().enumerate() {
            let allowed = allowed[usize::from(map[i])];
            prop_assert!(allowed.contains(one) || *one == NO_CATEGORY);
        }
        prop_assert_eq!(found, back);
    }

    /// Where every material is in one category both rules say the same.
    #[test]
    fn materials_of_one_category_need_no_neighbour(columns in 1_usize..9, map in prop::collection::vec(0_u16..4, 9..90)) {
        let map = &map[..map.len() / columns * columns];
        let categories =
            Categories::new(3, &[vec![Part::enclosed(2)], vec![Part::open(0), Part::open(1)]]).unwrap();
        let expected: Vec<u8> = map.iter().map(|m| [1, 1, 0, NO_CATEGORY][usize::from(*m)]).collect();
        for rule in RULES {
            prop_assert_eq!(&segment(map, columns, &categories, rule).unwrap(), &expected);
        }
    }
}
