//! A segmented cube in words: categories and objects.

use crate::text::columns::{Columns, left, right};
use crate::text::numbers::{degrees, listed};
use crate::words::safety::article;
use hadar::words::{share, significant, whole};
use hadar_estimate::segmentation::{Agreement, Rule};
use hadar_study::decompose::{ObjectRow, SafetyRow, Segmented};
use std::fmt::Write as _;

/// Objects that are listed.
const LISTED: usize = 12;

/// Categories of which an object may be that are named.
const NAMED: usize = 3;

/// Where categories that matter for safety cannot be excluded, in words; nothing without them.
pub(super) fn safety(found: &Segmented, is_rejected: bool) -> String {
    let mut out = String::new();
    for row in &found.safety {
        let (article, name) = (article(&row.category), &row.category);
        let _ = match (row.pixels, row.objects.len()) {
            _ if is_rejected => writeln!(
                out,
                "{article} {name} cannot be excluded anywhere while the cube does not follow its model; if it did, in {} of the pixels.",
                share(row.share_if_model_holds)
            ),
            (0, _) => writeln!(
                out,
                "{article} {name} is excluded in every pixel, if the library holds{}.",
                if_constant(row)
            ),
            (_, objects) => writeln!(
                out,
                "{article} {name} cannot be excluded in {} of the pixels ({objects} {}).",
                share(row.share),
                if objects == 1 { "object" } else { "objects" }
            ),
        };
        let _ = writeln!(
            out,
            "  If the model and the library hold{}, at most {} of the pixels that {} {name} fills are excluded: of pixels, not of objects.",
            if_constant(row),
            share(row.bound_missed),
            article.to_lowercase()
        );
    }
    out
}

/// What the exclusion of a category rests on besides.
fn if_constant(row: &SafetyRow) -> String {
    match row.constants.len() {
        0 => String::new(),
        _ => format!(", and real surfaces are as the one number of {}", listed(&row.constants)),
    }
}

/// The names of what an object is or may be, not too many of them.
fn named(row: &ObjectRow) -> String {
    match row.possible.len().checked_sub(NAMED).filter(|more| *more > 1) {
        None => row.category.clone(),
        Some(more) => {
            let names: Vec<&str> = row.possible.iter().take(NAMED).map(|one| one.category.as_str()).collect();
            format!("{} or {more} more", names.join(" or "))
        }
    }
}

/// Categories and objects, in words.
pub(super) fn text(found: &Segmented, is_rejected: bool) -> String {
    let shown = || found.objects.iter().take(LISTED);
    let names = || found.categories.iter().map(|row| row.category.clone()).chain(shown().map(named));
    let width = names().map(|name| name.chars().count()).max().unwrap_or(0).max(9);
    let mut table =
        Columns::new([left("", width), right("pixels", 9), right("decided", 9), right("objects", 7)]);
    for row in &found.categories {
        let counts = [row.pixels, row.decided].map(|count| whole(count as u64));
        table.row(std::iter::once(row.category.clone()).chain(counts).chain([row.objects.to_string()]));
    }
    for (name, pixels) in [("none", found.none), ("undecided", found.undecided)] {
        if pixels > 0 {
            table.row([name, &whole(pixels as u64)]);
        }
    }
    let held = if is_rejected { ", if the model held" } else { "" };
    let mut out = format!("Categories{held}\n{}", table.text());
    let _ = writeln!(
        out,
        "\nObjects: all of {} pixels or more, and all with a decided pixel{}{}",
        found.smallest_object,
        match found.objects_not_listed {
            0 => String::new(),
            left_out => format!("; {} smaller ones without are not listed", whole(left_out as u64)),
        },
        if found.objects.is_empty() { ": none" } else { "" },
    );
    let mut table = Columns::new([
        left("", width),
        right("pixels", 9),
        right("decided", 9),
        right("rows", 13),
        right("columns", 13),
        right("median (degC)", 14),
        right("sigma (K)", 10),
    ]);
    let span = |[first, after]: [usize; 2]| format!("{first} to {}", after - 1);
    let known = |k: f64, shown: &dyn Fn(f64) -> String| if k.is_finite() { shown(k) } else { "-".to_owned() };
    for row in shown() {
        let how = match (row.possible.is_empty(), 2 * row.decided < row.pixels) {
            (false, _) => "  undecided",
            (true, true) => "  by its neighbours",
            (true, false) => "",
        };
        table.row([
            named(row),
            whole(row.pixels as u64),
            whole(row.decided as u64),
            span(row.rows),
            span(row.columns),
            known(row.temperature_median_k, &degrees),
            format!("{:>10}{how}", known(row.temperature_sigma_median_k, &|k| significant(k, 2))),
        ]);
    }
    out.push_str(&table.text());
    if let Some(more) = found.objects.len().checked_sub(LISTED).filter(|more| *more > 0) {
        let _ = writeln!(out, "  and {more} more: objects.csv");
    }
    let said = |agreement: &Agreement| match (agreement.mean_iou, agreement.right) {
        (Some(iou), Some(right)) => {
            format!("mIoU {}, {} of the pixels right", significant(iou, 3), share(right))
        }
        (None, Some(right)) => format!("no pixel is of a category or was given one, {} right", share(right)),
        _ => "the truth of no pixel is known".to_owned(),
    };
    if let Some(agreement) = &found.agreement {
        let undecided = agreement.undecided.filter(|share| *share > 0.0);
        let undecided = undecided.map_or_else(String::new, |of| format!(", {} undecided", share(of)));
        let _ = writeln!(out, "  against what is there: {}{undecided}", said(agreement));
    }
    if let Some(agreement) = &found.agreement_of_likeliest {
        let _ = writeln!(out, "  the likeliest category of each pixel, no finding: {}", said(agreement));
    }
    if let Some(agreement) = &found.agreement_by_brightness {
        let _ = writeln!(
            out,
            "  the most that the brightness of a pixel in all bands together could say, laid out with what is there: {}",
            said(agreement)
        );
    }
    let rule = match found.rule {
        Rule::Raster => "the decided neighbours before say it (Algorithm 4 of the paper)",
        Rule::Regions => "what is decided around its region, unless something unknown could change it",
    };
    let _ = writeln!(
        out,
        "  decided: all materials that 95 % leave are of this category alone; objects may join where they touch, and what is not in the library \
         may be taken for what is\n  sigma: of one pixel, its material certain; undecided: of several categories, or nothing fits or tells\n  \
         a material in several categories: {rule}\n  likeliest_category.npy: the likeliest category of each pixel, no finding{}\n",
        if found.smoothing { "; the commonest of 5 x 5 pixels" } else { "" }
    );
    out
}
