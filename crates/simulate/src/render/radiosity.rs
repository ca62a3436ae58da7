//! Radiances that leave the surfaces, and the spectra that a pixel is mixed from.
//!
//! S_k⁽⁰⁾ = e_k B(T_k),   S_k⁽ˡ⁾ = e_k B(T_k) + (1 − e_k) Σ_j V̄_kj S_j⁽ˡ⁻¹⁾
//!
//! with factors V̄ and emissivities averaged over each surface. With `bounces` scatterings in all, the last of them
//! at the point that is seen, that point is lit by S⁽ᵇᵒᵘⁿᶜᵉˢ⁻¹⁾. In equilibrium what is missing is (1 − e)^bounces
//! of B at the most. The sky emits e B and scatters nothing.

use super::lighting::Shares;
use super::scene::{SKY, Scene};
use hadar::error::Result;
use hadar::planck;
use hadar::spectrum::Bands;

/// Spectra in the bands that make up the pixels.
#[derive(Debug)]
pub(super) struct Basis {
    pub(super) bands: usize,
    /// Number of surfaces.
    pub(super) sources: usize,
    /// How many temperatures the emission of each surface is mixed from.
    pub(super) temperatures: Vec<usize>,
    /// Of each surface, row after row of `bands` values: for each of its emissivities, e B(T) at these temperatures, then (1 − e) S_k
    /// for every surface k. The sky emits alone.
    pub(super) spectra: Vec<Vec<f64>>,
    /// S_k at the nodes of the bands.
    pub(super) leaving: Vec<Vec<f64>>,
}

impl Basis {
    /// Rows of a surface: what a pixel has coefficients for.
    pub(super) fn rows(&self, surface: usize) -> usize {
        self.spectra.get(surface).map_or(0, |rows| rows.len() / self.bands)
    }

    pub(super) fn new(scene: &Scene, mean: &[Shares], bands: &Bands, bounces: usize) -> Result<Self> {
        let nodes = bands.nodes_cm1();
        let leaving = leaving(scene, mean, nodes, bounces)?;
        let mut spectra = Vec::with_capacity(scene.surfaces.len());
        for (surface, object) in scene.surfaces.iter().enumerate() {
            let mut rows = Vec::new();
            let mut append = |at_nodes: &[f64]| rows.extend(bands.weigh(at_nodes));
            let temperatures = object.nodes_k();
            let kinds = if object.is_mixed() { 2 } else { 1 };
            for emissivity in object.emissivity.iter().take(kinds) {
                let emissivity =
                    emissivity.at_nodes(nodes.len()).map_err(|error| error.for_key(&object.name))?;
                for temperature_k in &temperatures {
                    append(&product(&emissivity, &blackbody(nodes, *temperature_k)));
                }
                if surface == SKY {
                    break;
                }
                for source in &leaving {
                    let scattered: Vec<f64> =
                        emissivity.iter().zip(source).map(|(e, s)| (1.0 - e) * s).collect();
                    append(&scattered);
                }
            }
            spectra.push(rows);
        }
        let temperatures = scene.surfaces.iter().map(|surface| surface.nodes_k().len()).collect();
        Ok(Self { bands: bands.len(), sources: scene.surfaces.len(), temperatures, spectra, leaving })
    }
}

/// Mean radiance that leaves each surface towards the point that is seen, at the nodes; nothing if that scatters
/// nothing.
fn leaving(scene: &Scene, mean: &[Shares], nodes_cm1: &[f64], bounces: usize) -> Result<Vec<Vec<f64>>> {
    if bounces == 0 {
        return Ok(vec![vec![0.0; nodes_cm1.len()]; scene.surfaces.len()]);
    }
    let mut emissivities = Vec::with_capacity(scene.surfaces.len());
    let mut emitted = Vec::with_capacity(scene.surfaces.len());
    for surface in &scene.surfaces {
        let [first, second] = &surface.emissivity;
        let [first, second] = [first.at_nodes(nodes_cm1.len())?, second.at_nodes(nodes_cm1.len())?];
        let tau = if surface.is_mixed() { surface.texture.mean() } else { 0.0 };
        let mixed: Vec<f64> = first.iter().zip(&second).map(|(a, b)| (1.0 - tau) * a + tau * b).collect();
        let mut radiance = vec![0.0; nodes_cm1.len()];
        for (temperature_k, weight) in surface.nodes_k().iter().zip(surface.mean_weights()) {
            let at = blackbody(nodes_cm1, *temperature_k);
            radiance.iter_mut().zip(at).for_each(|(sum, b)| *sum += weight * b);
        }
        emitted.push(product(&mixed, &radiance));
        emissivities.push(mixed);
    }
    let mut leaving = emitted.clone();
    for _ in 1..bounces {
        let next = (0..scene.surfaces.len()).map(|k| {
            let mut signal = emitted[k].clone();
            if k != SKY {
                for (share, source) in mean[k].iter().zip(&leaving) {
                    for ((signal, source), e) in signal.iter_mut().zip(source).zip(&emissivities[k]) {
                        *signal += (1.0 - e) * share * source;
                    }
                }
            }
            signal
        });
        leaving = next.collect();
    }
    Ok(leaving)
}

fn blackbody(nodes_cm1: &[f64], temperature_k: f64) -> Vec<f64> {
    let mut radiance = vec![0.0; nodes_cm1.len()];
    planck::photon_radiance_into(nodes_cm1, temperature_k, &mut radiance);
    radiance
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}
