//! Stripes of a push-broom cube: lines whose gain and offset are off, found and taken out.
//!
//! A line (a row or a column) of a band reads y = g·x + o of what it should read, x. Each line is looked at in segments, whose means are
//! little noisy; the lines beside it say what it should read. A line is striped where it is off from the clean lines on both sides of it,
//! and from where two of them on a side lead, the same way: a true edge is off from one side only, a slope from both but not the same way,
//! a ridge not from where its sides lead. It must be so along the whole line, as one gain and one offset would have it. Gain and offset are
//! then fitted to its segments with weights that leave out those of another kind (bisquare), the clean lines on both sides interpolated as
//! reference, or the nearer one where an edge lies between them. A prior of the gain holds it where the line has no contrast. Lines that
//! are not striped are left as they are.
//!
//! What the bands beside are off by too, as median of up to six of them over their levels, is the scene's and stays in the line. Where they
//! show nothing, two lines beside each other are stripes too, and no ridge. A line that is off in most bands, alike in neighbouring ones,
//! as a thin object along it would be, is left as it is: `left` names it. Both only of four bands or more, and not where stripes in all
//! bands are asked for. Where a third of the lines of a band are striped, nothing tells the scene from the stripes, and nothing is made.
//!
//! What may be the scene's is left and named (`kept`): a line of which a part, an end or a sixteenth, is nearer to its neighbours than to
//! its gain and offset; one that is off the same way in the band beside, as a feature of a material is; what lies within three lines of a
//! step that its band alone has, as lines striped side by side or the edge of a material make it. A line of one value, but for noise, where
//! the lines beside vary, is dead: it stands for no other and stays as it is. Lines that were set apart until none was left to compare with
//! are refused. Where all bands are off, lines side by side or at the ends of the image are not told from the scene and are not seen.
//!
//! An edge is where the straight lines through the two clean lines of each side do not meet; a slope is none, and both sides count.
//!
//! Errors: of the fit, not below those of the same fit to clean lines, which truly differ from their neighbours too, and a quarter more,
//! for lines beside may be striped by less than is seen. An error of a line is common to all its pixels: σ(x)² = (σ_p² + σ_g²(x − x₀)²)/g²
//! at a level x, least at the level x₀ of the line.
//!
//! Source: paper, supplement SV A, where streaks are detected and taken out by a linear transform; how is our own.

mod apart;
mod apply;
mod common;
mod filled;
mod fit;
mod found;
mod keep;
mod scan;
mod segments;
mod steps;

pub use found::{Apart, Axis, Destriped, Kept, Sought, Stripe, Why};

use self::common::{Told, overlooked, told};
use self::scan::{Band, striped};
use self::segments::Segments;
use hadar::cube::{Rows, Sample};
use hadar::error::{Error, Result};
use hadar::parallel;
use hadar::words::significant;
use rayon::prelude::*;

/// Fewest lines, and pixels of a line.
const FEWEST: [usize; 2] = [8, 16];
/// Share of striped lines of a band from which on they are the rule.
const MOST: f64 = 1.0 / 3.0;
/// Bands that are needed to tell a thin object.
const TELLING: usize = 4;
/// Looks for stripes that have others beside them.
const LOOKS: usize = 3;
/// Likeness of neighbouring bands above which a line that is off in most bands is an object.
const ALIKE: f64 = 0.5;

/// Finds the stripes of a cube.
///
/// # Errors
/// A cube of too few lines or of lines that are too short, one that is constant or empty, stripes that fill a band.
pub fn find_stripes<S: Sample>(cube: &dyn Rows<S>, sought: &Sought) -> Result<Destriped> {
    let shape = cube.shape();
    let (lines, pixels) = match sought.axis {
        Axis::Rows => (shape.rows(), shape.columns()),
        Axis::Columns => (shape.columns(), shape.rows()),
    };
    let name = sought.axis.name();
    if lines < FEWEST[0] || pixels < FEWEST[1] {
        let found = format!("{lines} {name} of {pixels} pixels");
        let instead = format!(
            "stripes are seen in {} {name} or more of {} pixels or more; is it the other axis?",
            FEWEST[0], FEWEST[1]
        );
        return Err(Error::malformed(found, instead));
    }
    let segments = Segments::of(cube, sought.axis)?;
    if segments.is_constant() {
        let found = "all samples of the cube are the same, or none is a number";
        return Err(Error::malformed(found, "give a cube as it was measured"));
    }
    let bands = shape.bands();
    let mut looked: Vec<Band> = parallel::map(bands, |band| striped(&segments, band, sought.gain_deviation));
    if looked.iter().all(|band| band.usable == 0) {
        return Err(Error::malformed(
            "no line has samples that are numbers",
            "give a cube that was measured",
        ));
    }
    let levels: Vec<f64> = looked.iter().map(|seen| seen.level).collect();
    if let Some((band, step)) = filled::filled(&segments, &levels) {
        let found = format!(
            "{name} of band {band} (counted from 0) that differ from one to the next by {} % of their level, as those of the bands beside do \
             not: stripes, too many to distinguish them from the scene",
            significant(100.0 * step, 2)
        );
        let instead = "correct the cube by a uniform source first, or leave the band out";
        return Err(Error::malformed(found, instead));
    }
    let shared = !sought.in_all_bands && bands >= TELLING;
    if shared {
        for _ in 0..LOOKS {
            let more: Vec<Vec<usize>> = parallel::map(bands, |band| overlooked(&looked, band));
            if more.iter().all(Vec::is_empty) {
                break;
            }
            looked.par_iter_mut().zip(&more).for_each(|(band, more)| band.again(more));
        }
    }
    let told: Vec<Told> =
        parallel::map(bands, |band| told(&looked, band, shared)).into_iter().flatten().collect();
    for (band, (seen, told)) in looked.iter().zip(&told).enumerate() {
        if told.at_first_sight as f64 > MOST * seen.usable as f64
            || seen.without_reference as f64 > MOST * seen.usable as f64
        {
            let found = format!(
                "stripes in {} of {} {name} of band {band} (counted from 0), too many to distinguish them from the scene",
                told.at_first_sight.max(seen.without_reference),
                seen.usable
            );
            let instead = "correct the cube by a uniform source first, or leave the band out";
            return Err(Error::malformed(found, instead));
        }
    }
    let left: Vec<usize> = match shared {
        true => {
            let striped = |line| told.iter().any(|told| told.stripes.iter().any(|one| one.line == line));
            (0..lines).filter(|line| is_object(&looked, *line, striped(*line))).collect()
        }
        false => Vec::new(),
    };
    let apart = apart::apart(&looked, lines);
    // What a line must be off by to be told from the others, and to be set apart in the first place.
    let seen_from: Vec<f64> = parallel::map(bands, |band| looked[band].seen_from());
    let detectable: Vec<f64> =
        told.iter().zip(seen_from).map(|(told, from)| told.detectable.max(from)).collect();
    let detectable_gain = detectable.iter().zip(&levels).map(|(off, level)| off / level.abs()).collect();
    let mut stripes: Vec<Stripe> = told
        .into_iter()
        .flat_map(|told| told.stripes)
        .filter(|stripe| !left.contains(&stripe.line))
        .collect();
    stripes.sort_by_key(|stripe| (stripe.line, stripe.band));
    let mut kept = keep::without_scene(&looked, lines);
    keep::in_part(&looked, &mut stripes, &mut kept);
    if shared {
        keep::of_neighbouring_bands(&mut stripes, &mut kept);
        keep::beside_steps(&looked, lines, &left, &mut stripes, &mut kept);
    }
    kept.sort_by_key(|kept| (kept.line, kept.band));
    Ok(Destriped {
        axis: sought.axis,
        lines,
        bands,
        stripes,
        left,
        kept,
        detectable,
        detectable_gain,
        apart,
        levels,
    })
}

/// Whether a line is off in most bands, and alike in neighbouring ones; of a striped one, whatever it is off by counts.
fn is_object(bands: &[Band], line: usize, striped: bool) -> bool {
    let off: Vec<f64> = bands.iter().map(|band| band.offset(line, striped)).collect();
    let count = off.iter().filter(|off| **off != 0.0).count();
    if 2 * count <= bands.len() {
        return false;
    }
    let relative: Vec<f64> = off.iter().zip(bands).map(|(off, band)| off / band.level.abs()).collect();
    let squares: f64 = relative.iter().map(|x| x * x).sum();
    let products: f64 = relative.windows(2).map(|pair| pair[0] * pair[1]).sum();
    products > ALIKE * squares
}
