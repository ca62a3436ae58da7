//! Boxes of a search over unknown temperatures.

/// Intervals of the unknown temperatures: places of their ends among the spectra known.
#[derive(Debug, Clone)]
pub(super) struct Region {
    pub(super) ends: Vec<[usize; 2]>,
    /// Along which it is best halved, once that is known.
    pub(super) axis: Option<usize>,
}

impl Region {
    pub(super) fn of(ends: Vec<[usize; 2]>) -> Self {
        Self { ends, axis: None }
    }
}
