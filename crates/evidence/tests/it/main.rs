//! Tests of the references, of what is held against them, and of the program.

mod accuracy;
mod command;
mod reproduce;
mod skipping;
mod support;
mod vectors;
mod vectors_folder;

/// The program that is tested.
const PROGRAM: &str = env!("CARGO_BIN_EXE_hadar-evidence");
