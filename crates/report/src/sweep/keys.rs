//! By what a row of a sweep is found again: a hash of what it asks of whom.

use crate::manifest::sha256;
use hadar_study::sweep::Plan;

/// The rows of a plan by what they ask.
#[derive(Debug)]
pub struct Keys {
    of_rows: Vec<u128>,
    /// Numbers of the rows, by what they ask.
    sorted: Vec<usize>,
}

impl Keys {
    /// Those of a plan, where `common` says what all rows rest on.
    #[must_use]
    pub fn of(common: &str, plan: &Plan) -> Self {
        let of_rows: Vec<u128> = (0..plan.rows()).map(|row| key(common, plan, row)).collect();
        let mut sorted: Vec<usize> = (0..of_rows.len()).collect();
        sorted.sort_by_key(|row| of_rows.get(*row));
        Self { of_rows, sorted }
    }

    /// What a row asks.
    #[must_use]
    pub fn of_row(&self, row: usize) -> String {
        self.of_rows.get(row).map_or_else(String::new, |key| format!("{key:032x}"))
    }

    /// The rows that ask the same, rising; none of what no row asks.
    #[must_use]
    pub fn rows(&self, key: &str) -> &[usize] {
        let Some(key) = u128::from_str_radix(key, 16).ok().filter(|_| key.len() == 32) else { return &[] };
        let of = |row: &usize| self.of_rows.get(*row).copied();
        let from = self.sorted.partition_point(|row| of(row) < Some(key));
        let to = self.sorted.partition_point(|row| of(row) <= Some(key));
        self.sorted.get(from..to).unwrap_or_default()
    }
}

/// Half of a hash, which tells as many rows apart as anybody has.
fn key(common: &str, plan: &Plan, row: usize) -> u128 {
    let mut asked = common.to_owned();
    for setting in plan.settings(row) {
        asked.extend(["\0", &setting.key, "=", &setting.value]);
    }
    let hash = sha256(asked.as_bytes());
    hash.get(..32).and_then(|half| u128::from_str_radix(half, 16).ok()).unwrap_or_default()
}
