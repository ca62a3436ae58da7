//! What is said of blackbodies whose uncertainty is not.

use crate::Warning;
use hadar_scenario::calibrate::blackbodies::BlackbodySpec;

/// Temperatures that are taken as exact since nothing is said of them.
pub(super) fn uncertainty_not_stated(specs: &[BlackbodySpec]) -> Option<Warning> {
    let silent: Vec<usize> = (0..specs.len()).filter(|k| specs[*k].uncertainty_k.is_none()).collect();
    (!silent.is_empty()).then_some(Warning::UncertaintyNotStated { blackbodies: silent, of: specs.len() })
}
