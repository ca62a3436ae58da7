//! Tests of reports.

mod figures;
mod labels;
mod named_values;

mod support {
    pub(crate) mod figures;
}
