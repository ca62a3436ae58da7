//! What no claim may do, searched for in small images of every kind.

use super::*;
use crate::segmentation::{Groups, Part, groups};
use proptest::prelude::*;

/// 0 skin, 1 paint, 2 asphalt, 3 fabric (a person, or within a car), 4 metal (a robot, or within a car), 5 concrete (road or house),
/// 6 a material of no category.
fn categories(extra: Option<(usize, usize, bool)>) -> Categories {
    let mut parts = vec![
        vec![Part::open(0), Part::open(3)],
        vec![Part::open(1), Part::enclosed(3), Part::enclosed(4)],
        vec![Part::open(4)],
        vec![Part::open(2), Part::open(5)],
        vec![Part::open(5)],
    ];
    if let Some((category, material, enclosed)) = extra
        && !parts[category].iter().any(|part| part.material == material)
    {
        parts[category].push(Part { material, enclosed });
    }
    Categories::new(7, &parts).unwrap()
}

/// The sets of any and of all of some candidates; anything where there are none.
fn sets(candidates: &[Vec<usize>], categories: &Categories) -> (Vec<u64>, Vec<u64>) {
    let own: Vec<u64> = categories.sets().iter().map(|set| if *set == 0 { OTHER } else { *set }).collect();
    let of = |candidates: &Vec<usize>| match candidates.is_empty() {
        true => (u64::MAX, u64::MAX),
        false => candidates.iter().fold((0, u64::MAX), |(any, all), m| (any | own[*m], all & own[*m])),
    };
    candidates.iter().map(of).unzip()
}

fn found(
    candidates: &[Vec<usize>],
    columns: usize,
    categories: &Categories,
    rule: Rule,
    safety: u64,
) -> Claims {
    let (possible, common) = sets(candidates, categories);
    claims(&possible, &common, columns, categories, rule, safety).unwrap()
}

/// Pixels that are mostly of one material, in patches, so that regions and what encloses them occur.
fn image() -> impl Strategy<Value = (usize, Vec<Vec<usize>>)> {
    let pixel = prop_oneof![
        6 => prop::sample::select(vec![0_usize, 1, 1, 2, 3, 3, 4, 5, 6]).prop_map(|m| vec![m]),
        1 => prop::collection::vec(0_usize..7, 2..4),
        1 => Just(Vec::new()),
    ];
    let patch = (0_usize..8, 0_usize..8, 1_usize..6, 1_usize..6, pixel);
    let base = prop::sample::select(vec![1_usize, 2, 3]).prop_map(|m| vec![m]);
    (2_usize..9, 2_usize..9, base, prop::collection::vec(patch, 0..9)).prop_map(
        |(rows, columns, base, patches)| {
            let mut pixels = vec![base; rows * columns];
            for (row, column, high, wide, own) in patches {
                for r in row..(row + high).min(rows) {
                    for c in column..(column + wide).min(columns) {
                        pixels[r * columns + c] = own.clone();
                    }
                }
            }
            (columns, pixels)
        },
    )
}

fn rule() -> impl Strategy<Value = Rule> {
    prop_oneof![Just(Rule::Regions), Just(Rule::Raster)]
}

fn decided(claims: &Claims) -> usize {
    claims.told.iter().filter(|told| **told == Told::ByItself).count()
}

fn listed(candidates: &[Vec<usize>], columns: usize, smallest: usize, safety: u64) -> (Claims, Groups) {
    let categories = categories(None);
    let claims = found(candidates, columns, &categories, Rule::Regions, safety);
    let (possible, _) = sets(candidates, &categories);
    let sets = claims.sets(&possible);
    let is_decided: Vec<bool> = claims.told.iter().map(|told| *told == Told::ByItself).collect();
    let groups = groups(&sets, &is_decided, columns, smallest).unwrap();
    (claims, groups)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A pixel that becomes undecided gives no pixel a category that it had not, and makes nothing more decided.
    #[test]
    fn what_is_less_known_claims_less(
        (columns, pixels) in image(), at in any::<prop::sample::Index>(), rule in rule(), safety in 0_u64..32,
        more in prop::option::of(0_usize..7),
    ) {
        let categories = categories(None);
        let before = found(&pixels, columns, &categories, rule, safety);
        let at = at.index(pixels.len());
        let mut less = pixels.clone();
        match more {
            Some(more) if !less[at].is_empty() => less[at].push(more),
            _ => less[at].clear(),
        }
        let after = found(&less, columns, &categories, rule, safety);
        for i in (0..pixels.len()).filter(|i| *i != at) {
            prop_assert!(
                after.category[i] == NO_CATEGORY || after.category[i] == before.category[i],
                "pixel {} of {:?}", i, pixels
            );
        }
        // The pixel itself may become shared, and be settled, but is decided by itself no more.
        prop_assert!(decided(&after) <= decided(&before));
    }

    /// A further category of a material makes no pixel decided by itself that was not.
    #[test]
    fn a_further_category_decides_nothing(
        (columns, pixels) in image(), rule in rule(), category in 0_usize..5, material in 0_usize..6, enclosed in any::<bool>(),
    ) {
        let before = found(&pixels, columns, &categories(None), rule, 0);
        let after = found(&pixels, columns, &categories(Some((category, material, enclosed))), rule, 0);
        for (before, after) in before.told.iter().zip(&after.told) {
            prop_assert!(*before == Told::ByItself || *after != Told::ByItself);
        }
    }

    /// The mirror image has the mirror image of the categories.
    #[test]
    fn a_mirror_mirrors((columns, pixels) in image(), safety in 0_u64..32) {
        let categories = categories(None);
        let flip = |row: &mut dyn Iterator<Item = Vec<usize>>| { let mut row: Vec<_> = row.collect(); row.reverse(); row };
        let mirrored: Vec<Vec<usize>> =
            pixels.chunks(columns).flat_map(|row| flip(&mut row.iter().cloned())).collect();
        let found = |pixels: &[Vec<usize>]| found(pixels, columns, &categories, Rule::Regions, safety);
        let (one, other) = (found(&pixels), found(&mirrored));
        for (i, category) in one.category.iter().enumerate() {
            prop_assert_eq!(*category, other.category[i / columns * columns + columns - 1 - i % columns]);
        }
        // And upside down.
        let upside: Vec<Vec<usize>> = pixels.chunks(columns).rev().flatten().cloned().collect();
        let other = found(&upside);
        let back: Vec<u8> = other.category.chunks(columns).rev().flatten().copied().collect();
        prop_assert_eq!(one.category, back);
    }

    /// A pixel that may be of a category for safety is given another one by no neighbour, and is in a listed object if any pixel of its
    /// object is decided, whatever the least size.
    #[test]
    fn safety_is_lost_by_neither_neighbours_nor_size((columns, pixels) in image(), safety in 0_u64..32, smallest in 1_usize..100) {
        let (claims, groups) = listed(&pixels, columns, smallest, safety);
        let (possible, _) = sets(&pixels, &categories(None));
        for (i, told) in claims.told.iter().enumerate() {
            if *told == Told::ByNeighbours {
                prop_assert_eq!(possible[i] & safety & !(1 << claims.category[i]), 0);
            }
            if *told == Told::ByItself {
                prop_assert!(groups.of_pixel[i].is_some());
            }
        }
        let all: usize = groups.all.iter().map(|group| group.decided).sum();
        prop_assert_eq!(all, decided(&claims));
    }

    /// A category that a pixel is given is one that it may be of.
    #[test]
    fn a_claim_is_possible((columns, pixels) in image(), rule in rule()) {
        let claims = found(&pixels, columns, &categories(None), rule, 0);
        let (possible, _) = sets(&pixels, &categories(None));
        for (category, possible) in claims.category.iter().zip(possible).filter(|(one, _)| **one != NO_CATEGORY) {
            prop_assert!(possible >> category & 1 == 1);
        }
    }
}

/// The seats of a car are the car's, and fabric on the road a person's; a robot wholly before a car is one or the other for safety.
#[test]
fn what_is_enclosed_on_all_sides_is_settled() {
    let of = |picture: &[&str], safety: u64| {
        let letter = |b: u8| match b {
            b's' => vec![0],
            b'p' => vec![1],
            b'.' => vec![2],
            b'f' => vec![3],
            b'm' => vec![4],
            _ => Vec::new(),
        };
        let pixels: Vec<Vec<usize>> = picture.concat().bytes().map(letter).collect();
        found(&pixels, picture[0].len(), &categories(None), Rule::Regions, safety)
    };
    let street = [
        ".........", //
        ".pppp..f.",
        ".pffp..f.",
        ".pppp..f.",
        ".........",
    ];
    let found = of(&street, 0);
    assert_eq!((found.category[2 * 9 + 2], found.category[2 * 9 + 7]), (1, 0));
    assert_eq!(found.told[2 * 9 + 2], Told::ByNeighbours);
    let careful = of(&street, 0b1);
    assert_eq!((careful.category[2 * 9 + 2], careful.category[2 * 9 + 7]), (NO_CATEGORY, 0));
    // One pixel of the rim that fits nothing leaves the seats open, as a street may be behind it; the person has enough of the road about it,
    // but not where half of the rim is unknown.
    let rim = [".........", ".p?pp....", ".pffp..f.", ".pppp..?.", "........."];
    let found = of(&rim, 0);
    assert_eq!((found.category[2 * 9 + 2], found.category[2 * 9 + 7]), (NO_CATEGORY, 0));
    let rim = [".........", ".pppp..?.", ".pffp.?f.", ".pppp..?.", "........."];
    let found = of(&rim, 0);
    assert_eq!((found.category[2 * 9 + 2], found.category[2 * 9 + 7]), (1, NO_CATEGORY));
}
