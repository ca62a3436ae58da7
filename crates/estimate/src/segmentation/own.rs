//! What a pixel is before its neighbours are asked.

/// What a pixel is by its own candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Own {
    /// Of this category.
    Category(u8),
    /// Of none.
    None,
    /// Of one of several, the place among those that occur.
    Shared(usize),
    /// Not known.
    Unknown,
}
