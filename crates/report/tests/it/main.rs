//! Tests of reports.

mod figures;
mod named_values;

mod support {
    pub(crate) mod figures;
}
