//! What stands below the pictures of a sizing.

use hadar::policy::TradeOff;

/// The title of the emissivities of the target and of some of `all` its alternatives.
pub(crate) fn emissivities(target: &str, shown: &[&str], all: usize) -> String {
    match shown {
        [one] => format!("Emissivities of {target} and {one}"),
        some if some.len() < all => {
            format!("Emissivities of {target} and the {} nearest of its {all} alternatives", some.len())
        }
        _ => format!("Emissivities of {target} and its alternatives"),
    }
}

/// Below information over photons.
pub(crate) const INFORMATION: &str =
    "Information log₂ 2P; 1 bit is certainty. The camera's photons grow with its exposure.";

/// Below the distance of an object over its readings.
pub(crate) const OBJECT: &str = "More frames to the right. Errors that pixels, rows, columns and emissivities have in common do not average away with any number of frames.";

/// Below the two spectra that look alike.
pub(crate) fn nearest(alternative: &str, celsius: f64, lighting: &[f64], equal: bool) -> String {
    let lighting: Vec<String> = lighting.iter().map(|v| format!("{v:.3}")).collect();
    let lit =
        if lighting.is_empty() { String::new() } else { format!(" with lighting {}", lighting.join(", ")) };
    let alike = if equal { " The two spectra are equal: no camera distinguishes them." } else { "" };
    format!("The closest confuser, {alternative}, is at {celsius:.2} °C{lit}.{alike}")
}

/// Below the photons over temperature and lighting, with the temperature of equilibrium where that is in the map.
pub(crate) fn photon_map(by: &str, equilibrium_c: Option<f64>) -> String {
    let rest = match equilibrium_c {
        Some(celsius) => {
            format!("In equilibrium (V = 1, T = {celsius:.1} °C) no number of photons suffices.")
        }
        None => "V is that of the first of the surroundings, the others' held.".into(),
    };
    format!("By the {by} distance, shot noise only. {rest}")
}

/// Below one figure of a camera over another.
pub(crate) fn trade_off(curve: &TradeOff, camera: &str) -> String {
    let side = if curve.y.is_least() { "above" } else { "below" };
    let allowed = curve.points.iter().any(|point| point.within_limits.is_some());
    let none = if allowed { "" } else { " No point shown is within all limits." };
    format!(
        "All other figures as of {camera}. The signal suffices {side} the curve. Dotted and grey lines are limits other than noise; \
         that of diffraction, λF, is a warning alone.{none}"
    )
}
