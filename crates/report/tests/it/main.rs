//! Tests of reports.

mod figures;
mod named_values;
mod vectors;

mod support {
    pub(crate) mod figures;
}
