//! Connected parts of an image: two neighbours that are the same are of one part.
//!
//! Parts are joined in one pass from the first row (union–find with path halving) and numbered in the order of their first pixels, so
//! that the numbers do not depend on how they were found.

/// The part of a pixel that is in none.
pub(super) const NO_PART: u32 = u32::MAX;

/// Which pixels are neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Neighbours {
    /// Those that share a side.
    Four,
    /// Those that share a corner too.
    Eight,
}

/// The part of every pixel and how many parts there are, of an image of so many columns. `value` is what has to be the same; pixels
/// without one are in no part.
pub(super) fn components<V: PartialEq>(
    pixels: usize,
    columns: usize,
    neighbours: Neighbours,
    value: impl Fn(usize) -> Option<V>,
) -> (Vec<u32>, usize) {
    let mut parent = vec![NO_PART; pixels];
    for i in 0..pixels {
        let Some(own) = value(i) else { continue };
        parent[i] = i as u32;
        let (left, right) = (!i.is_multiple_of(columns), (i + 1) % columns != 0);
        let eight = neighbours == Neighbours::Eight;
        let before = [
            (left, 1),
            (i >= columns, columns),
            (eight && left && i >= columns, columns + 1),
            (eight && right && i >= columns, columns.saturating_sub(1)),
        ];
        for (_, back) in before.into_iter().filter(|(is_there, back)| *is_there && *back > 0) {
            if value(i - back).is_some_and(|other| other == own) {
                let (a, b) = (root(&mut parent, i), root(&mut parent, i - back));
                // The earlier pixel is the root.
                parent[a.max(b)] = a.min(b) as u32;
            }
        }
    }
    let mut number = 0_u32;
    let mut parts = vec![NO_PART; pixels];
    for i in 0..pixels {
        if parent[i] == NO_PART {
            continue;
        }
        let root = root(&mut parent, i);
        if root == i {
            parts[i] = number;
            number += 1;
        } else {
            parts[i] = parts[root];
        }
    }
    (parts, number as usize)
}

fn root(parent: &mut [u32], mut i: usize) -> usize {
    while parent[i] as usize != i {
        let above = parent[parent[i] as usize];
        parent[i] = above;
        i = above as usize;
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The same parts by filling from every pixel that has none yet.
    fn filled(image: &[u8], columns: usize, neighbours: Neighbours) -> (Vec<u32>, usize) {
        let rows = image.len() / columns;
        let mut parts = vec![NO_PART; image.len()];
        let mut number = 0;
        for start in 0..image.len() {
            if image[start] == 0 || parts[start] != NO_PART {
                continue;
            }
            let mut open = vec![start];
            parts[start] = number;
            while let Some(i) = open.pop() {
                for (down, across) in (-1..=1).flat_map(|d: i32| (-1..=1).map(move |a: i32| (d, a))) {
                    let (row, column) = ((i / columns) as i32 + down, (i % columns) as i32 + across);
                    let is_inside = (0..rows as i32).contains(&row) && (0..columns as i32).contains(&column);
                    let is_near = neighbours == Neighbours::Eight || down == 0 || across == 0;
                    let j = if is_inside { row as usize * columns + column as usize } else { continue };
                    if is_near && image[j] == image[start] && parts[j] == NO_PART {
                        parts[j] = number;
                        open.push(j);
                    }
                }
            }
            number += 1;
        }
        (parts, number as usize)
    }

    proptest! {
        #[test]
        fn parts_are_those_of_a_flood(
            columns in 1_usize..9,
            image in prop::collection::vec(0_u8..3, 1..80),
            eight in any::<bool>(),
        ) {
            let image = &image[..image.len() / columns * columns];
            let neighbours = if eight { Neighbours::Eight } else { Neighbours::Four };
            let found = components(image.len(), columns, neighbours, |i| (image[i] > 0).then_some(image[i]));
            prop_assert_eq!(found, filled(image, columns, neighbours));
        }
    }
}
