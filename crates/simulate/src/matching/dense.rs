//! Disparity maps by block matching.
//!
//! Blocks of rows are worked on in parallel, each with running sums of its own: the cost hardly depends on the
//! window, and the map not on the number of threads.

use super::block::Block;
use super::layout::{Layout, View};
use super::search::{Match, Search, StereoPair, check_window};
use hadar::error::Result;
use hadar::parallel;
use std::ops::Range;

/// Rows of a block; windows higher than a quarter of it have longer ones.
const ROWS: usize = 32;

/// Disparities of all windows that lie within the left view.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DisparityMap {
    /// Rows of the windows' centres.
    pub rows: Range<usize>,
    /// Columns of the centres.
    pub columns: Range<usize>,
    /// `[row][column]` of the centres.
    pub matches: Vec<Match>,
}

impl DisparityMap {
    /// The disparity about a pixel of the left view; `None` where no window fits.
    #[must_use]
    pub fn at(&self, row: usize, column: usize) -> Option<Match> {
        if !self.rows.contains(&row) || !self.columns.contains(&column) {
            return None;
        }
        self.matches.get((row - self.rows.start) * self.columns.len() + column - self.columns.start).copied()
    }
}

/// Matches every window of the left view.
///
/// ```
/// use hadar::{cube::Shape, ranging::information::Window};
/// use hadar_simulate::matching::{Search, StereoPair, block::Block, dense::disparity_map, texture::Texture};
/// let shape = Shape::new(20, 60, 1)?;
/// let texture = Texture::random(1, &[1e4], 0.1, 0.2, 40)?;
/// let (left, right) = (texture.view(shape, 0.0)?, texture.view(shape, 7.0)?);
/// let pair = StereoPair::new(shape, &left, &right)?;
/// let map = disparity_map(&pair, &Block::new(Window::new(5, 5)?), Search::new(0, 15)?)?;
/// assert!((map.at(10, 40).unwrap().unwrap() - 7.0).abs() < 0.2);
/// # Ok::<(), hadar::Error>(())
/// ```
///
/// # Errors
/// A window larger than the image.
pub fn disparity_map(pair: &StereoPair, block: &Block, search: Search) -> Result<DisparityMap> {
    let (shape, window) = (pair.shape(), block.window);
    check_window(window, shape)?;
    let layout = Layout::full(shape);
    let (left, right) = rayon::join(|| layout.gather(pair.left()), || layout.gather(pair.right()));
    let [left, right] = [&left, &right].map(|samples| View { layout: &layout, samples });
    let rows = window.half_rows()..shape.rows() - window.half_rows();
    let columns = window.half_columns()..shape.columns() - window.half_columns();
    let height = ROWS.max(4 * window.rows());
    let starts: Vec<usize> = rows.clone().step_by(height).collect();
    let blocks: Vec<Vec<Match>> = parallel::map_with(
        starts.len(),
        || block.strip(search),
        |strip, i| {
            let start = starts[i];
            let mut matches = Vec::with_capacity(height * columns.len());
            for row in start..(start + height).min(rows.end) {
                if row == start {
                    strip.start(left, right, row, columns.clone());
                } else {
                    strip.advance(left, right, row);
                }
                for (at, column) in columns.clone().enumerate() {
                    let within = search.within(column, shape.columns(), window.half_columns());
                    matches.push(block.peak(strip.scores(at), within, search));
                }
            }
            matches
        },
    );
    Ok(DisparityMap { rows, columns, matches: blocks.into_iter().flatten().collect() })
}
