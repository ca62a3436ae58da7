//! A map of materials as a map of categories: what a pixel is a part of, and the objects that are there.
//!
//! A category is made of materials: a car of paint, glass, rubber and some aluminium. A material that is in one category alone says
//! what its pixel is; for one that is in several (aluminium: a robot, or the emblem of a car) the neighbours have to say it, and
//! whether it is *enclosed* where it is a part of a category.
//!
//! * [`Categories`]: which material is where; [`Rule`], [`segment`]: a map of materials to a map of categories;
//! * [`claims`], [`groups`]: the categories that pixels are told to be, where they are, and objects of what pixels may be;
//! * [`Agreement`]: a map against the truth, category by category; [`ByBrightness`]: what brightness alone could say;
//! * [`objects`]: the connected parts of each category.
//!
//! Nothing here knows temperatures or photons: what a pixel's material is worth is said by [`crate::decompose`].
//!
//! Source: paper, supplement SIII E, Algorithm 4; what that leaves open is said at [`Rule`].

mod agreement;
mod brightness;
mod categories;
mod claims;
mod components;
mod groups;
mod object;
mod own;
mod raster;
mod rectangle;
mod regions;
mod rule;
mod smoothing;

pub use agreement::Agreement;
pub use brightness::ByBrightness;
pub use categories::{Categories, MOST_CATEGORIES, NO_CATEGORY, Part};
pub use claims::{Claims, Told, claims};
pub use groups::{Group, Groups, groups};
pub use object::{Object, Objects, objects};
pub use rule::Rule;
pub use smoothing::smoothed;

use hadar::error::Result;
use rectangle::rectangle;

/// Categories of a map of materials `[row][column]`, not yet smoothed ([`smoothed`]). The materials are taken for true: of materials that are only
/// the likeliest these are the likeliest categories, and no finding ([`claims`]).
///
/// # Errors
/// A map that is no rectangle of so many columns.
///
/// ```
/// use hadar_estimate::segmentation::{Categories, NO_CATEGORY, Part, Rule, segment};
/// // 0 paint, 1 aluminium: a car of both, a robot of the latter, which is enclosed in the car.
/// let (paint, metal) = (Part::open(0), Part::open(1));
/// let categories = Categories::new(2, &[vec![paint, Part::enclosed(1)], vec![metal]])?;
/// let material = [
///     0, 0, 0, 9, 1, //
///     0, 1, 0, 9, 1, //
///     0, 0, 0, 9, 1,
/// ];
/// let found = segment(&material, 5, &categories, Rule::Regions)?;
/// assert_eq!(found[6], 0);
/// assert_eq!((found[3], found[4]), (NO_CATEGORY, 1));
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn segment(material: &[u16], columns: usize, categories: &Categories, rule: Rule) -> Result<Vec<u8>> {
    rectangle(material.len(), columns)?;
    Ok(match rule {
        Rule::Raster => raster::segment(material, columns, categories),
        Rule::Regions => regions::segment(material, columns, categories),
    })
}
