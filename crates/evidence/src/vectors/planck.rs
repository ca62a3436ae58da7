//! Photon radiance of a blackbody, its slope and differences, from hν ≪ kT to where no double holds it.

use super::answer::{Answer, Vector, reach};
use super::json::Json;
use super::topic::Topic;
use crate::reference::Extended;
use crate::reference::planck::{
    photon_radiance, photon_radiance_difference, photon_radiance_slope, second_radiation_cm_k,
};

/// Below it a double holds nothing, or not all digits of a product.
const DARK: f64 = 1e-290;

/// What is asked: a name, what is hard about it, ν in cm⁻¹, T and T₀ in K.
type Asked = (&'static str, &'static str, f64, f64, Option<f64>);

pub(super) fn topic() -> Topic {
    let last_bit = f64::from_bits(293.15_f64.to_bits() + 1);
    let asked: [Asked; 16] = [
        ("room", "an ordinary value", 1000.0, 300.0, None),
        ("body", "an ordinary value", 1250.0, 310.15, None),
        ("furnace", "hv/kT near 1", 5000.0, 6000.0, None),
        ("radio", "exp(x) - 1 keeps ten digits at x = 5e-6", 1e-3, 300.0, None),
        ("radio-hot", "exp(x) - 1 keeps nine digits at x = 2e-7", 1e-3, 6000.0, None),
        ("liquid-nitrogen", "x = 13", 700.0, 77.0, None),
        ("wien", "x = 599: x itself has to be good to its last bits", 1250.0, 3.0, None),
        ("dark", "x = 1439: exp(x) overflows; nothing of it is a double", 1000.0, 1.0, None),
        ("darkest", "x = 143878: neither may become a NaN", 1e5, 1.0, None),
        ("warmer-by-17-k", "an ordinary difference", 900.0, 310.15, Some(293.15)),
        ("warmer-by-10-mk", "subtraction loses four digits", 1000.0, 293.16, Some(293.15)),
        ("warmer-by-1-nk", "subtraction loses eleven digits", 1000.0, 293.150_000_001, Some(293.15)),
        (
            "warmer-by-a-bit",
            "T and T0 differ in their last bit: subtraction keeps no digit",
            1234.5,
            last_bit,
            Some(293.15),
        ),
        ("cooler-by-1-uk", "a negative difference", 750.0, 293.149_999, Some(293.15)),
        ("before-deep-space", "B(T0) is nothing beside B(T)", 1000.0, 300.0, Some(2.725)),
        ("both-dark", "a difference of what is next to nothing: x = 360", 1000.0, 4.0, Some(3.999)),
    ];
    Topic {
        name: "planck",
        title: "Photon radiance of a blackbody, its slope, and the difference of two",
        catches: "constants that are not the exact ones of the SI, energy instead of photons, m^-1 instead of cm^-1, a factor 2 or \
                  pi; exp(x) - 1 where expm1 is due; overflow; differences by subtraction",
        vectors: asked.into_iter().map(vector).collect(),
        files: Vec::new(),
    }
}

fn vector((id, about, wavenumber_cm1, temperature_k, base_k): Asked) -> Vector {
    let coldest = base_k.map_or(temperature_k, |base_k| base_k.min(temperature_k));
    let x = |kelvin: f64| {
        (second_radiation_cm_k() * Extended::from(wavenumber_cm1) / Extended::from(kelvin)).to_f64()
    };
    let answer = |value: &Extended, x: f64| {
        let answer = Answer::one(value, reach(x));
        if value.abs().to_f64() < DARK { answer.or_within(DARK) } else { answer }
    };
    let mut inputs = vec![
        ("wavenumber_cm1".to_owned(), Json::from(wavenumber_cm1)),
        ("temperature_k".into(), temperature_k.into()),
    ];
    let mut answers = vec![
        (
            "photon_radiance_per_s_m2_sr_cm1",
            answer(&photon_radiance(wavenumber_cm1, temperature_k), x(temperature_k)),
        ),
        (
            "photon_radiance_slope_per_s_m2_sr_cm1_k",
            answer(&photon_radiance_slope(wavenumber_cm1, temperature_k), x(temperature_k)),
        ),
    ];
    if let Some(base_k) = base_k {
        inputs.push(("base_temperature_k".into(), base_k.into()));
        let difference = photon_radiance_difference(wavenumber_cm1, temperature_k, base_k);
        // Far from a dark base the answer is that of the warmer one.
        let x = if coldest < 0.5 * temperature_k { x(temperature_k) } else { x(coldest) };
        answers.push(("photon_radiance_difference_per_s_m2_sr_cm1", answer(&difference, x)));
    }
    let answers = answers.into_iter().map(|(name, answer)| (name.to_owned(), answer)).collect();
    Vector { id, about, inputs: Json::Object(inputs), answers }
}
