//! What is said of files of spectra beside what they say themselves: columns without a header, and noise to be cut off.

use super::checked::MOST_CLIP;
use hadar::error::{Error, Result};

/// How files of spectra are read.
///
/// ```
/// use hadar_formats::spectra::Reading;
/// let folder = std::env::temp_dir().join(format!("hadar-reading-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder).unwrap();
/// let file = folder.join("noisy.csv");
/// std::fs::write(&file, "700,1.004\n1000,0.9\n1300,0.8\n").unwrap();
/// let reading = Reading::default().columns(["wavenumber_cm1", "emissivity"]);
/// assert!(reading.file(&file).unwrap_err().to_string().contains("--clip"));
/// let noisy = reading.clipping(0.02)?.file(&file)?;
/// assert_eq!(noisy[0].emissivity(&[700.0])?, [1.0]);
/// assert!(noisy[0].warnings()[0].starts_with("1 row outside 0 to 1 clipped, the worst by 0.0040 at 700.0 cm^-1"));
/// # std::fs::remove_dir_all(&folder).unwrap();
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Reading {
    columns: Vec<String>,
    clip: Option<f64>,
}

impl Reading {
    /// The same, of files whose columns have no header; `columns` are what it would say, as in `wavelength_um`, `emissivity`. None is
    /// as if nothing were said.
    #[must_use]
    pub fn columns(self, columns: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { columns: columns.into_iter().map(Into::into).collect(), ..self }
    }

    /// The same, emissivities outside [0, 1] by at most `by` set to 0 or 1, and rows without a number left
    /// out where the gap is narrow.
    ///
    /// # Errors
    /// A number below 0, or more than noise.
    pub fn clipping(self, by: f64) -> Result<Self> {
        if !(0.0..=MOST_CLIP).contains(&by) {
            let expected = format!("between 0 and {MOST_CLIP}: noise, not another quantity or percent");
            return Err(Error::out_of_range("clip", by, "", expected));
        }
        Ok(Self { clip: Some(by), ..self })
    }

    /// What the columns are said to be.
    pub(super) fn columns_said(&self) -> Option<&[String]> {
        Some(self.columns.as_slice()).filter(|columns| !columns.is_empty())
    }

    /// By how much emissivities may be outside [0, 1].
    pub(super) const fn clip(&self) -> Option<f64> {
        self.clip
    }
}
