//! Over what the pictures of a sweep are drawn, or why there are none.

use super::swept::Swept;
use hadar_study::sweep::Input;
use std::collections::BTreeSet;

/// Most curves in a picture.
const MOST_CURVES: usize = 7;

/// Over what pictures are drawn.
pub(super) enum Over<'a> {
    /// A curve.
    One(&'a Input),
    /// A curve for each value of the second.
    OneForEach(&'a Input, &'a Input),
    /// A map.
    Two(&'a Input, &'a Input),
}

/// Why no picture of a sweep is drawn.
pub(crate) enum Undrawn {
    /// So many keys vary.
    Keys(usize),
    /// Some values of one key do not go with every value of the other.
    NoGrid,
    /// A key that takes a curve for each of so many values.
    Curves { key: String, values: usize, most: usize },
    /// Values without a place on an axis, of the one key or of both.
    NoNumbers { keys: usize },
}

/// Over what pictures of a sweep can be drawn, or why there are none.
pub(super) fn over(swept: &Swept) -> Result<Over<'_>, Undrawn> {
    let rows = swept.gathered.rows();
    let varied: Vec<&Input> = swept.gathered.inputs.iter().filter(|input| input.cells.len() > 1).collect();
    if varied.is_empty() || varied.len() > 2 {
        return Err(Undrawn::Keys(varied.len()));
    }
    let mut places = BTreeSet::new();
    let apart =
        (0..rows).all(|row| places.insert(varied.iter().map(|input| input.index(row)).collect::<Vec<_>>()));
    if !apart || varied.iter().map(|input| input.cells.len()).product::<usize>() != rows {
        return Err(Undrawn::NoGrid);
    }
    let is_number = |input: &&Input| input.cells.iter().all(|cell| cell.number().is_some());
    let few = |input: &Input| match input.cells.len() {
        values if values > MOST_CURVES => {
            Err(Undrawn::Curves { key: input.key.clone(), values, most: MOST_CURVES })
        }
        _ => Ok(()),
    };
    match varied.as_slice() {
        [x] if is_number(x) => Ok(Over::One(x)),
        [x, y] => match (is_number(x), is_number(y)) {
            (true, true) => Ok(Over::Two(x, y)),
            (true, false) => few(y).map(|()| Over::OneForEach(x, y)),
            (false, true) => few(x).map(|()| Over::OneForEach(y, x)),
            (false, false) => Err(Undrawn::NoNumbers { keys: 2 }),
        },
        _ => Err(Undrawn::NoNumbers { keys: 1 }),
    }
}

/// Why a sweep of several rows has no pictures.
pub(crate) fn none(swept: &Swept) -> Option<Undrawn> {
    over(swept).err().filter(|_| swept.gathered.rows() > 1)
}
