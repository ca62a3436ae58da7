//! Files that appear together or not at all.
//!
//! Everything is written into a fresh folder beside the destination first and moved into place only when
//! the last file is complete, so that a full disk or a missing permission leaves nothing half-written. Figures are drawn
//! only as they are written.

use super::figures::Plot;
use super::plot::{Figure, render_png, render_svg};
use hadar::error::{Error, Result};
use rayon::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};

/// Files of a report, by name.
#[derive(Debug, Clone, Default)]
pub struct Bundle {
    files: Vec<(String, Content)>,
    figures: Vec<Figure>,
}

/// What a file holds.
#[derive(Debug, Clone)]
enum Content {
    Bytes(Vec<u8>),
    /// Of a figure.
    Svg(usize),
    Png(usize),
}

impl Bundle {
    /// Adds a file.
    pub fn add(&mut self, name: impl Into<String>, content: impl Into<Vec<u8>>) {
        self.files.push((name.into(), Content::Bytes(content.into())));
    }

    /// Adds SVG, PNG and CSV of every plot.
    ///
    /// # Errors
    /// A table that cannot be written.
    pub fn add_plots(&mut self, plots: &[Plot]) -> Result<()> {
        for plot in plots {
            let figure = self.figures.len();
            self.files.push((format!("{}.svg", plot.name), Content::Svg(figure)));
            self.files.push((format!("{}.png", plot.name), Content::Png(figure)));
            self.add(format!("{}.csv", plot.name), plot.table.to_csv()?);
            self.figures.push(plot.figure.clone());
        }
        Ok(())
    }

    /// How many figures there are to draw.
    #[must_use]
    pub fn figures(&self) -> usize {
        self.figures.len()
    }

    /// Names of the files, in the order they were added.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|(name, _)| name.as_str())
    }

    /// Makes sure that a folder can be made or written to, before any work is done for it.
    ///
    /// # Errors
    /// A path that is a file, or where nothing may be written.
    pub fn check_destination(directory: &Path) -> Result<()> {
        let staging = stage(directory)?;
        fs::remove_dir_all(&staging).map_err(|error| refused(directory, &error))
    }

    /// Writes all files into `directory`, which is made if it is not there.
    ///
    /// # Errors
    /// A figure that cannot be drawn; the folder cannot be made or written to. Then none of the files is there.
    pub fn write(&self, directory: &Path) -> Result<()> {
        let drawn: Result<Vec<(Vec<u8>, Vec<u8>)>> = self
            .figures
            .par_iter()
            .map(|figure| Ok((render_svg(figure)?.into_bytes(), render_png(figure)?)))
            .collect();
        let drawn = drawn?;
        let staging = stage(directory)?;
        let result = self.fill(&staging, &drawn).and_then(|()| self.publish(&staging, directory));
        // What is left of the staging folder is of no use to anyone, whether or not it can be removed.
        let _ = fs::remove_dir_all(&staging);
        result.map_err(|error| refused(directory, &error))
    }

    /// Writes every file; `drawn` are the figures as SVG and PNG.
    fn fill(&self, staging: &Path, drawn: &[(Vec<u8>, Vec<u8>)]) -> std::io::Result<()> {
        self.files.iter().try_for_each(|(name, content)| {
            let content = match content {
                Content::Bytes(bytes) => bytes,
                Content::Svg(figure) => &drawn[*figure].0,
                Content::Png(figure) => &drawn[*figure].1,
            };
            fs::write(staging.join(name), content)
        })
    }

    fn publish(&self, staging: &Path, directory: &Path) -> std::io::Result<()> {
        fs::create_dir_all(directory)?;
        // A file cannot take the place of a folder: found out before the first one is moved.
        if let Some(name) = self.names().find(|name| directory.join(name).is_dir()) {
            return Err(std::io::Error::other(format!(
                "its `{name}` is a folder, which no file may replace"
            )));
        }
        self.files.iter().try_for_each(|(name, _)| fs::rename(staging.join(name), directory.join(name)))
    }
}

/// A fresh folder on the same file system as `directory`.
fn stage(directory: &Path) -> Result<PathBuf> {
    if directory.is_file() {
        return Err(Error::file("write the report", directory, "this is a file; name a folder"));
    }
    // The part of the path that is there already; a relative path ends in an empty one, the current folder.
    let home = match directory.ancestors().find(|part| part.exists()) {
        Some(part) if part.is_dir() => part.to_owned(),
        Some(_) => return Err(refused(directory, &std::io::ErrorKind::NotADirectory.into())),
        None => PathBuf::from("."),
    };
    let staging = home.join(format!(".hadar-{}.tmp", std::process::id()));
    fs::create_dir_all(&staging).map_err(|error| refused(directory, &error))?;
    Ok(staging)
}

fn refused(directory: &Path, error: &std::io::Error) -> Error {
    let reason = match error.kind() {
        std::io::ErrorKind::PermissionDenied => "no permission; name a folder you may write to".to_owned(),
        std::io::ErrorKind::ReadOnlyFilesystem => "read-only; name a folder you may write to".to_owned(),
        std::io::ErrorKind::NotADirectory => "part of the path is a file; name a folder".to_owned(),
        _ => format!("{error}; name a folder you may write to"),
    };
    Error::file("write the report", directory, reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_files_appear_and_no_staging_stays() {
        let home = tempfile::tempdir().unwrap();
        let target = home.path().join("a/b");
        let mut bundle = Bundle::default();
        bundle.add("x.csv", "1\n");
        bundle.add("y.csv", "2\n");
        Bundle::check_destination(&target).unwrap();
        assert!(!target.exists());
        bundle.write(&target).unwrap();
        bundle.write(&target).unwrap();
        assert_eq!(fs::read_to_string(target.join("y.csv")).unwrap(), "2\n");
        assert_eq!(fs::read_dir(home.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_is_no_folder_and_a_failed_write_leaves_nothing() {
        let home = tempfile::tempdir().unwrap();
        let file = home.path().join("file");
        fs::write(&file, "").unwrap();
        assert!(Bundle::check_destination(&file).unwrap_err().to_string().contains("this is a file"));
        assert!(Bundle::check_destination(&file.join("below")).is_err());
        let mut bundle = Bundle::default();
        bundle.add("good.csv", "1\n");
        bundle.add("no/such/folder.csv", "2\n");
        let target = home.path().join("out");
        assert!(bundle.write(&target).is_err());
        assert!(!target.exists());
        let mut bundle = Bundle::default();
        bundle.add("a.csv", "1\n");
        bundle.add("b.csv", "2\n");
        fs::create_dir_all(target.join("b.csv")).unwrap();
        assert!(bundle.write(&target).unwrap_err().to_string().contains("`b.csv` is a folder"));
        assert!(!target.join("a.csv").exists());
    }
}
