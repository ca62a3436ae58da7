//! Labels beside the ends of the curves, at the right of the panel they are in.
//!
//! Each is as high as the last point of its curve in view; those that would overlap are moved apart as little as that takes. Where a
//! label had to move from a curve that ends at the frame, a thin line joins the two. Where they are too many for their panel, none is
//! placed: a legend lists them.

use super::colour::GREY;
use super::legend::{Entry, Key, LINE, broken, draw_entry, entry_width};
use super::scene::{Point, Rect, Scene};

/// Widest text of a label.
const WIDEST: f64 = 170.0;
const MOST_LINES: usize = 8;
/// From the frame to the labels.
pub(super) const APART: f64 = 16.0;
/// A curve ends at the frame where it ends at this share of its width or beyond it.
const AT_FRAME: f64 = 0.97;
/// Labels that moved by less belong to their curves without a line, in pixels.
const MOVED: f64 = 5.0;

/// What is labelled, before it has a place: its panel, and the last point as fractions of the width and of the height.
#[derive(Clone)]
pub(super) struct End {
    pub(super) panel: usize,
    pub(super) at: Option<(f64, f64)>,
    pub(super) entry: Entry,
}

/// Labels with their lines broken.
pub(super) struct Direct(Vec<Label>);

struct Label {
    panel: usize,
    at: Option<(f64, f64)>,
    key: Key,
    lines: Vec<String>,
}

impl Direct {
    /// Labels of panels of these heights; none where there is nothing to tell apart, or no room.
    pub(super) fn new(ends: Vec<End>, heights: &[f64]) -> Option<Self> {
        if ends.len() < 2 {
            return None;
        }
        let label = |End { panel, at, entry }: End| {
            let lines = broken(&entry.label, WIDEST, MOST_LINES);
            Label { panel, at, key: entry.key, lines }
        };
        let labels: Vec<Label> = ends.into_iter().map(label).collect();
        let needed =
            |panel: usize| labels.iter().filter(|l| l.panel == panel).map(Label::height).sum::<f64>();
        let fit = heights.iter().enumerate().all(|(panel, height)| needed(panel) <= *height);
        let whole = labels.iter().all(|label| label.lines.iter().all(|line| !line.ends_with('…')));
        (fit && whole).then_some(Self(labels))
    }

    /// Width that the labels take at the right of the plot, with what separates them from it.
    pub(super) fn width(&self) -> f64 {
        APART + self.0.iter().map(|label| entry_width(&label.lines)).fold(0.0, f64::max)
    }

    /// Draws the labels of a panel, `beside` its frame; lines to the curves where nothing else is there.
    pub(super) fn draw(&self, scene: &mut Scene, panel: usize, frame: &Rect, beside: f64) {
        let mut labels: Vec<(&Label, f64)> = self
            .0
            .iter()
            .filter(|label| label.panel == panel)
            .map(|label| (label, frame.at(1.0, label.at.map_or(0.0, |at| at.1.clamp(0.0, 1.0))).1))
            .collect();
        labels.sort_by(|a, b| a.1.total_cmp(&b.1));
        let boxes: Vec<(f64, f64)> = labels.iter().map(|(label, y)| (*y, label.height())).collect();
        let left = frame.right + beside + APART;
        for ((label, y), top) in labels.iter().zip(apart(&boxes, frame.top, frame.bottom)) {
            draw_entry(scene, &label.key, &label.lines, (left, top));
            let middle = top + 0.5 * LINE;
            let is_line = !matches!(label.key, Key::Symbol { .. } | Key::Area { .. });
            let ends_there = is_line && label.at.is_some_and(|at| at.0 >= AT_FRAME) && beside == 0.0;
            if ends_there && (middle - y).abs() > MOVED {
                let to: Point = (left - 2.0, middle);
                scene.line((frame.right + 2.0, *y), to, 0.8, GREY);
            }
        }
    }
}

impl Label {
    fn height(&self) -> f64 {
        LINE * self.lines.len().max(1) as f64
    }
}

/// Upper ends of boxes of these (first middles, heights), rising, which fit between two heights: moved apart as little as that takes,
/// in the sense of least squares (pool adjacent violators).
fn apart(boxes: &[(f64, f64)], top: f64, bottom: f64) -> Vec<f64> {
    // Pools: sum of wanted upper ends of the pool, how many, height.
    let mut pools: Vec<(f64, f64, f64)> = Vec::new();
    let start = |&(sum, count, height): &(f64, f64, f64)| (sum / count).min(bottom - height).max(top);
    for (middle, height) in boxes {
        pools.push((middle - 0.5 * LINE, 1.0, *height));
        while let [.., before, last] = pools.as_slice() {
            if start(before) + before.2 <= start(last) {
                break;
            }
            let merged = (before.0 + last.0 - last.1 * before.2, before.1 + last.1, before.2 + last.2);
            pools.truncate(pools.len() - 2);
            pools.push(merged);
        }
    }
    let mut heights = boxes.iter().map(|(_, height)| *height);
    let mut tops = Vec::with_capacity(boxes.len());
    for pool in &pools {
        let mut y = start(pool);
        for height in heights.by_ref().take(pool.1 as usize) {
            tops.push(y);
            y += height;
        }
    }
    tops
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn labels_that_would_overlap_move_apart_evenly() {
        assert_eq!(apart(&[(50.0, LINE), (50.0, LINE)], 0.0, 100.0), [50.0 - LINE, 50.0]);
        assert_eq!(apart(&[(0.0, LINE), (100.0, LINE)], 0.0, 100.0), [0.0, 100.0 - LINE]);
    }

    proptest! {
        #![proptest_config(hadar_testing::seeded(7, 300))]

        #[test]
        fn no_two_labels_overlap_and_none_leaves_the_panel(
            boxes in prop::collection::vec((-50.0..400.0f64, 1usize..4), 0..9),
        ) {
            let mut boxes: Vec<(f64, f64)> = boxes.iter().map(|(y, lines)| (*y, LINE * *lines as f64)).collect();
            boxes.sort_by(|a, b| a.0.total_cmp(&b.0));
            let all: f64 = boxes.iter().map(|b| b.1).sum();
            let bottom = all.max(345.0);
            let tops = apart(&boxes, 0.0, bottom);
            prop_assert_eq!(tops.len(), boxes.len());
            let mut free_from = 0.0;
            for (top, (_, height)) in tops.iter().zip(&boxes) {
                prop_assert!(*top >= free_from - 1e-9);
                free_from = top + height;
            }
            prop_assert!(free_from <= bottom + 1e-9);
        }
    }
}
