//! Tests of scenarios and studies.

mod air_ranging;
mod bands;
mod camera_bands;
mod companion;
mod conditions;
mod course;
mod find;
mod fuzz_readers;
mod grid;
mod keys;
mod object;
mod ordered;
mod published;
mod rendered;
mod rule_air;
mod scenario;
mod scenario_messages;
mod search_inputs;
mod shared_rows;
mod sight;
mod sizing;
mod solved;
mod stopped;
mod trade_offs;
mod units;

mod support {
    pub(crate) mod harness;
    pub(crate) mod mutation;
}
