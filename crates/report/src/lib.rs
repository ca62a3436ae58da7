//! Results made readable: a module a command, with its tables, its figures and the files of `--out`; what it says is in [`words`].
//!
//! What they share: [`plot`] draws, [`figures`] joins a figure and its table, [`table`] writes CSV, [`parquet`](mod@parquet) the same with types, [`tables`] and [`text`]
//! say what several commands say, [`bundle`] gathers files and makes one page of them, [`folder`] puts them in place, all or none,
//! with a [`manifest`] of whose they are.

pub mod air_ranging;
pub mod bundle;
pub mod calibrate;
pub mod cameras;
pub mod classes;
pub mod cube_format;
pub mod decompose;
pub mod diff;
mod document;
pub mod explain;
pub mod figures;
pub mod find;
pub mod folder;
mod html;
pub mod identify;
pub mod json;
pub mod library;
pub mod manifest;
pub mod parquet;
pub mod plot;
pub mod range;
pub mod render;
pub mod rule;
pub mod several;
mod shown;
pub mod simulate;
pub mod size;
pub mod sweep;
pub mod table;
pub mod tables;
pub mod verify;
pub mod words;

pub use html::READINGS;
pub use words::text;
