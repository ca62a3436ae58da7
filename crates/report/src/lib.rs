//! Results made readable: files, tables, plots and text. Physics never imports this module.

pub mod accuracy;
pub mod bundle;
pub mod cameras;
pub mod figures;
pub mod library;
pub mod plot;
pub mod ranging;
pub mod rule;
pub mod simulation;
pub mod sizing;
pub mod table;
pub mod tables;
pub mod text;
pub mod thermometry;
