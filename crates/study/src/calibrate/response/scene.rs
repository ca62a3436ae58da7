//! Radiances of a scene behind the filters, less a reference of known temperature.
//!
//! S = S_q(T⁰) + p_q (C − C⁰)/η, p_q the radiance of a count behind filter q. Common to all pixels are the errors of the response, of the
//! centre's η and of the reference's temperature T⁰; the first two have their value at the end of the scene where it is the largest.
//!
//! Units: photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ for S; counts for C; K for T⁰.

use super::{FilterRadiances, ResponseStudy};
use crate::calibrate::whole::{at, samples};
use hadar::calibration::filter_wheel::FilterWheel;
use hadar::cube::Cube;
use hadar::error::Result;
use hadar::planck;
use hadar_estimate::calibrate::response::{FilterRadiance, Response};
use hadar_estimate::calibrate::vignette::{Vignette, subtracted};

impl ResponseStudy {
    pub(super) fn radiances(
        &self,
        wheel: &FilterWheel,
        [found, kinked]: [&Response; 2],
        eta: Option<&Vignette>,
        [scene, reference]: [&Cube; 2],
    ) -> Result<FilterRadiances> {
        let (source, filters) = (&self.scenario.source, self.names.len());
        let reference_k = self.scenario.scene.as_ref().map_or(f64::NAN, |spec| spec.reference_k);
        let shape = scene.shape();
        let scene = samples(scene).map_err(at(source, "scene.data"))?;
        let reference = samples(reference).map_err(at(source, "scene.reference"))?;
        let pixels = shape.rows() * shape.columns();
        let ones = vec![1.0; pixels];
        let (values, sigma_eta, sigma_centre) = match eta {
            Some(eta) => (&eta.values, eta.sigma, eta.sigma_centre),
            None => (&ones, 0.0, 0.0),
        };
        let counts = subtracted(&scene, &reference, values, filters).map_err(at(source, "scene"))?;
        let lines: Vec<FilterRadiance> =
            (0..filters).map(|q| found.radiance(wheel, q, 0.0, reference_k)).collect();
        let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; filters];
        for pixel in counts.chunks(filters) {
            for (end, count) in ends.iter_mut().zip(pixel) {
                *end = [end[0].min(*count), end[1].max(*count)];
            }
        }
        // Errors that grow with what is above the reference are largest at an end of the scene: each filter has the largest.
        let most: Vec<f64> = ends.iter().map(|[low, high]| low.abs().max(high.abs())).collect();
        let radiance = counts
            .iter()
            .enumerate()
            .map(|(i, count)| (lines[i % filters].radiance + lines[i % filters].per_count * count) as f32);
        let noise = std::f64::consts::SQRT_2 * self.scenario.noise;
        let centres = wheel.centres_cm1();
        let mut slope = vec![0.0; centres.len()];
        let mut base = slope.clone();
        planck::photon_radiance_and_slope_into(centres, reference_k, &mut base, &mut slope);
        let error_k = self.scenario.scene.as_ref().map_or(0.0, |spec| spec.reference_error_k);
        let common = |found: &Response, q: usize| {
            let at = |count: f64| found.radiance(wheel, q, count, reference_k).sigma_common;
            let by_response = at(ends[q][0]).max(at(ends[q][1]));
            let by_centre = lines[q].per_count * most[q] * sigma_centre;
            let by_reference = lines[q].per_count * wheel.counts(q, &found.values, &slope) * error_k;
            by_response.hypot(by_centre).hypot(by_reference)
        };
        let own = |q: usize| lines[q].per_count * noise.hypot(most[q] * sigma_eta);
        Ok(FilterRadiances {
            shape,
            radiance: radiance.collect(),
            sigma_noise: (0..filters).map(own).collect(),
            sigma_common: (0..filters).map(|q| common(found, q)).collect(),
            sigma_common_kinked: (0..filters).map(|q| common(kinked, q)).collect(),
        })
    }
}
