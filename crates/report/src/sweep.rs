//! A sweep: one table of all rows, what is said of it, pictures over one or two of its keys.

mod basis;
mod figures;
mod gathered;
mod journal;
mod keys;
mod over;
mod swept;

pub use crate::words::sweep::{kept, text};
pub use basis::{Basis, Hashes};
pub use gathered::Gathered;
pub use journal::{Journal, Row};
pub use keys::Keys;
pub use swept::Swept;

pub(crate) use over::{Undrawn, none};

use crate::bundle::Bundle;
use crate::parquet::{self, Column};
use crate::table;
use hadar::error::Result;

/// The table and the pictures of a sweep.
///
/// # Errors
/// A chosen column that no row has; a figure that cannot be drawn.
pub fn bundle(swept: &Swept, title: &str) -> Result<Bundle> {
    let columns = swept.gathered.columns(&swept.chosen)?;
    let mut bundle = Bundle::about(Some(title));
    bundle.add("sweep.csv", csv(&columns)?);
    if cfg!(feature = "parquet") {
        bundle.add("sweep.parquet", parquet::file(&columns)?);
    }
    bundle.add_plots(&figures::plots(swept))?;
    Ok(bundle)
}

fn csv(columns: &[Column]) -> Result<String> {
    let header: Vec<String> = columns.iter().map(|column| column.name.clone()).collect();
    let cell = |column: &Column, row: usize| column.cells.get(row).map_or_else(String::new, parquet::text);
    let row = |row: usize| columns.iter().map(|column| cell(column, row)).collect();
    let rows = columns.first().map_or(0, |column| column.cells.len());
    table::csv_of(std::iter::once(header).chain((0..rows).map(row)))
}
