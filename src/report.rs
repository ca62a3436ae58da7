//! Results made readable: files, tables, plots and text. Physics never imports this module.

pub mod bundle;
pub mod figures;
pub mod plot;
pub mod table;
pub mod text;
