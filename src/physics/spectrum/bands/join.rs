//! Bands made of bands: some of them, or neighbours joined.

use super::{Band, Bands, Shape};
use std::ops::Range;

impl Bands {
    /// Every `stride`-th band, and where its nodes stand among those of the whole.
    pub(crate) fn every(&self, stride: usize) -> (Self, Vec<usize>) {
        let places: Vec<Range<usize>> = (0..self.len()).step_by(stride.max(1)).map(|q| q..q + 1).collect();
        self.chosen(&places)
    }

    /// Runs of neighbouring bands (rising, within the whole), each joined to one, and where their nodes stand among
    /// those of the whole.
    pub fn chosen(&self, runs: &[Range<usize>]) -> (Self, Vec<usize>) {
        let mut kept = Self {
            bands: Vec::new(),
            shapes: Vec::new(),
            nodes_cm1: Vec::new(),
            weights_cm1: Vec::new(),
            first_node: vec![0],
        };
        let mut places = Vec::new();
        for run in runs {
            let (band, shape) = match (&self.bands[run.clone()], &self.shapes[run.clone()]) {
                ([band], [shape]) => (band.clone(), shape.clone()),
                (bands, _) => (joined(bands), Shape::TopHat),
            };
            let nodes = self.first_node[run.start]..self.first_node[run.end];
            kept.bands.push(band);
            kept.shapes.push(shape);
            kept.nodes_cm1.extend_from_slice(&self.nodes_cm1[nodes.clone()]);
            kept.weights_cm1.extend_from_slice(&self.weights_cm1[nodes.clone()]);
            kept.first_node.push(kept.nodes_cm1.len());
            places.extend(nodes);
        }
        (kept, places)
    }

    /// Every `group` neighbouring bands joined to one, the last one of what is left.
    pub fn merged(&self, group: usize) -> Self {
        let group = group.max(1);
        if group == 1 {
            return self.clone();
        }
        let bands: Vec<Band> = self.bands.chunks(group).map(joined).collect();
        let mut first_node: Vec<usize> = self.first_node.iter().copied().step_by(group).collect();
        if first_node.len() == bands.len() {
            first_node.push(self.nodes_cm1.len());
        }
        Self {
            shapes: vec![Shape::TopHat; bands.len()],
            bands,
            nodes_cm1: self.nodes_cm1.clone(),
            weights_cm1: self.weights_cm1.clone(),
            first_node,
        }
    }
}

/// What spans some bands.
fn joined(parts: &[Band]) -> Band {
    let low_cm1 = parts.iter().map(|band| band.low_cm1).fold(f64::INFINITY, f64::min);
    let high_cm1 = parts.iter().map(|band| band.high_cm1).fold(0.0, f64::max);
    Band { center_cm1: 0.5 * (low_cm1 + high_cm1), low_cm1, high_cm1, name: None }
}
