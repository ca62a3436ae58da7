//! What is there of the rows of a sweep: those of this run as they come, then those of others.

use hadar::error::{Error, Result};
use hadar::inputs::{self, Held};
use hadar_report::manifest::Input;
use hadar_report::sweep::{Basis, Gathered, Hashes, Journal, Keys};
use hadar_study::sweep::{Record, asked_of};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// What a row answers, or why it failed.
pub(super) type Outcome = std::result::Result<Record, String>;

/// What is there of the rows.
pub(super) struct There {
    pub(super) gathered: Gathered,
    /// Rows that this run has answered.
    own: Vec<bool>,
    /// What the rows rest on, by where it is in memory.
    bases: BTreeMap<usize, Arc<Basis>>,
    /// Rows that were answered by others: by an earlier run, by another shard, or by whoever wrote into the folder.
    pub(super) of_others: BTreeSet<usize>,
    /// What of the program itself all rest on.
    pub(super) built_in: BTreeMap<String, Input>,
}

impl There {
    pub(super) fn new(gathered: Gathered) -> Self {
        let (own, bases) = (vec![false; gathered.rows()], BTreeMap::new());
        Self { gathered, own, bases, of_others: BTreeSet::new(), built_in: BTreeMap::new() }
    }

    /// Puts what this run has found of rows that ask the same.
    pub(super) fn put(&mut self, rows: &[usize], basis: &Arc<Basis>, outcome: &Outcome) {
        for row in rows {
            self.own[*row] = true;
            self.gathered.put(*row, outcome.clone());
        }
        self.rests_on(basis);
    }

    fn rests_on(&mut self, basis: &Arc<Basis>) {
        self.bases.entry(Arc::as_ptr(basis).addr()).or_insert_with(|| Arc::clone(basis));
    }

    /// Adds the rows of others whose files are as they were; the files of all rows are noted as read.
    ///
    /// # Errors
    /// A file that was changed after this run had read it: its rows are not of one table.
    pub(super) fn gather(&mut self, journal: &Journal, keys: &Keys, columns: &[String]) -> Result<()> {
        // As they are now, not as they were when the work began.
        let hashes = Hashes::default();
        if let Some(path) = self.bases.values().find_map(|basis| basis.changed(&hashes)) {
            let reason = "it was changed while the sweep ran; run it again, and the rows that rest on it are computed anew";
            return Err(Error::file("take as an input of all rows", path, reason));
        }
        let own = std::mem::take(&mut self.own);
        let of_others = |rows: &[usize]| rows.first().is_some_and(|row| !own[*row]);
        journal.read(keys, &of_others, &hashes, &mut |row| {
            if !row.basis.covers(columns) {
                return;
            }
            let outcome = row.outcome.map(|record| asked_of(record, columns));
            for same in row.rows {
                if outcome.is_ok() {
                    self.of_others.insert(*same);
                }
                self.gathered.put(*same, outcome.clone());
            }
            self.rests_on(row.basis);
        })?;
        let mut files: BTreeMap<&Path, &str> = BTreeMap::new();
        for basis in self.bases.values() {
            files.extend(basis.files());
            self.built_in.extend(basis.built_in.iter().map(|input| (input.path.clone(), input.clone())));
        }
        for (path, hash) in files {
            inputs::file(path, Held::Sha256(hash.to_owned()));
        }
        Ok(())
    }
}
