//! Photon radiance of a blackbody by the textbook's formula.
//!
//! B(ν,T) = 2cν²/(eˣ − 1) and ∂B/∂T = B·x eˣ/(T(eˣ − 1)), x = hcν/kT, ν in cm⁻¹, T in K, B in photons s⁻¹ m⁻² sr⁻¹ per
//! cm⁻¹, both polarisations; h, c, k the exact numbers of the SI. Differences are subtracted.
//!
//! eˣ of many wavenumbers at one temperature comes from tables: all are whole multiples Σ nᵢ 2⁸ⁱ of one power of two u,
//! so that eˣ = Π exp(hcu/kT · 2⁸ⁱ)^nᵢ without any rounding of x; each product adds one rounding of 512 bits.
//!
//! Source: SI Brochure, 9th edition (2019); paper S2.

use super::Extended;

/// Wavenumbers beyond which tables are worth their while.
const WORTH_TABLES: usize = 400;
/// Bits of a whole multiple that tables are made for.
const MOST_BITS: u32 = 120;
/// Bits of one table.
const BITS: u32 = 8;

/// Second radiation constant hc/k, cm K: 6.62607015e-34 · 299792458 · 100 ÷ 1.380649e-23.
#[must_use]
pub fn second_radiation_cm_k() -> Extended {
    let [h, c, k] = [662_607_015.0, 299_792_458.0, 1_380_649.0].map(Extended::from);
    // 10⁻⁴²·10² ÷ 10⁻²⁹.
    h * c / (k * Extended::from(1e11))
}

/// 2cν² in photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
fn modes(wavenumber: &Extended) -> Extended {
    // 2 · 29979245800 cm s⁻¹ · 10⁴ cm² m⁻².
    Extended::from(599_584_916_000_000.0) * wavenumber.square()
}

/// Photon radiance B(ν,T), photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹, at wavenumber ν (cm⁻¹) and temperature T (K).
///
/// ```
/// let exact = hadar_evidence::reference::planck::photon_radiance(1000.0, 300.0).to_f64();
/// assert!((hadar::planck::photon_radiance(1000.0, 300.0) / exact - 1.0).abs() < 1e-15);
/// ```
#[must_use]
pub fn photon_radiance(wavenumber_cm1: f64, temperature_k: f64) -> Extended {
    Blackbody::new(&[wavenumber_cm1], &Extended::from(temperature_k)).values.swap_remove(0)
}

/// B of a wavenumber (cm⁻¹) and a temperature (K) that need not be doubles.
#[must_use]
pub fn photon_radiance_at(wavenumber_cm1: &Extended, temperature_k: &Extended) -> Extended {
    let x = second_radiation_cm_k() * wavenumber_cm1 / temperature_k;
    modes(wavenumber_cm1) / (x.exp() - Extended::one())
}

/// ∂B/∂T, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ per K.
#[must_use]
pub fn photon_radiance_slope(wavenumber_cm1: f64, temperature_k: f64) -> Extended {
    Blackbody::new(&[wavenumber_cm1], &Extended::from(temperature_k)).slopes.swap_remove(0)
}

/// B(ν,T) − B(ν,T₀), photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
#[must_use]
pub fn photon_radiance_difference(wavenumber_cm1: f64, temperature_k: f64, base_k: f64) -> Extended {
    photon_radiance(wavenumber_cm1, temperature_k) - photon_radiance(wavenumber_cm1, base_k)
}

/// B and ∂B/∂T of one temperature at many wavenumbers.
#[derive(Debug, Clone)]
pub struct Blackbody {
    /// B at each.
    pub values: Vec<Extended>,
    /// ∂B/∂T at each.
    pub slopes: Vec<Extended>,
}

impl Blackbody {
    /// A blackbody of `temperature_k` (K) at `wavenumbers_cm1` (cm⁻¹).
    #[must_use]
    pub fn new(wavenumbers_cm1: &[f64], temperature_k: &Extended) -> Self {
        let one = Extended::one();
        let scale = second_radiation_cm_k() / temperature_k;
        let powers = exponentials(wavenumbers_cm1, &scale);
        let (mut values, mut slopes) = (Vec::new(), Vec::new());
        for (&wavenumber, power) in wavenumbers_cm1.iter().zip(powers) {
            let wavenumber = Extended::from(wavenumber);
            let less_one = &power - &one;
            let value = modes(&wavenumber) / &less_one;
            let x = &scale * &wavenumber;
            slopes.push(&value * x * power / (temperature_k * less_one));
            values.push(value);
        }
        Self { values, slopes }
    }
}

/// exp(scale · multiple) of each of the multiples.
fn exponentials(multiples: &[f64], scale: &Extended) -> Vec<Extended> {
    let tables = (multiples.len() >= WORTH_TABLES).then(|| Tables::new(multiples, scale)).flatten();
    let direct = |multiple: &f64| (scale * Extended::from(*multiple)).exp();
    match tables {
        Some(mut tables) => multiples.iter().map(|&multiple| tables.power(multiple)).collect(),
        None => multiples.iter().map(direct).collect(),
    }
}

/// Powers of exp(scale · 2^unit), one table for every [`BITS`] bits of the exponent.
struct Tables {
    unit: i32,
    tables: Vec<Vec<Extended>>,
}

/// A double above 0 as an odd whole number times a power of two.
fn whole_and_power(value: f64) -> (u64, i32) {
    let bits = value.to_bits();
    let (exponent, fraction) = ((bits >> 52) as i32, bits & ((1 << 52) - 1));
    let (whole, power) =
        if exponent == 0 { (fraction, -1074) } else { (fraction | (1 << 52), exponent - 1075) };
    let zeros = whole.trailing_zeros().min(63);
    (whole >> zeros, power + zeros as i32)
}

impl Tables {
    /// Tables for these multiples; nothing if they are too far apart to be whole multiples of one number.
    fn new(multiples: &[f64], scale: &Extended) -> Option<Self> {
        let unit = multiples.iter().map(|&multiple| whole_and_power(multiple).1).min()?;
        let bits = multiples
            .iter()
            .map(|&multiple| whole_and_power(multiple))
            .map(|(whole, power)| 64 - whole.leading_zeros() + power.abs_diff(unit))
            .max()?;
        if bits > MOST_BITS {
            return None;
        }
        let bases = (0..bits.div_ceil(BITS)).map(|i| {
            let step = scale.times_power_of_two(unit + (BITS * i) as i32).exp();
            vec![Extended::one(), step]
        });
        Some(Self { unit, tables: bases.collect() })
    }

    fn power(&mut self, multiple: f64) -> Extended {
        let (whole, power) = whole_and_power(multiple);
        let mut left = u128::from(whole) << power.abs_diff(self.unit);
        let mut product = Extended::one();
        for table in &mut self.tables {
            let digit = (left & ((1 << BITS) - 1)) as usize;
            left >>= BITS;
            while table.len() <= digit {
                let next = &table[table.len() - 1] * &table[1];
                table.push(next);
            }
            if digit > 0 {
                product = product * &table[digit];
            }
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The file holds 30 digits for the very doubles that its columns are read as.
    #[test]
    fn thirty_digit_references_are_met() {
        let Some(references) = hadar_testing::reference_rows("planck.csv") else { return };
        let mut rows = 0;
        for cells in references {
            let (nu, t) = (cells[0].parse().unwrap(), cells[1].parse().unwrap());
            for (found, exact) in
                [(photon_radiance(nu, t), &cells[2]), (photon_radiance_slope(nu, t), &cells[3])]
            {
                let error = found.relative_error_to(&Extended::parse(exact));
                assert!(error < 2e-29, "{cells:?}: {error:e}");
            }
            rows += 1;
        }
        assert!(rows > 20);
    }

    /// mpmath 1.3 at 120 digits, arguments the doubles themselves: 2cν²/(exp(x) − 1) at ν = 1234.5 cm⁻¹ and
    /// T = 293.15 K; its slope; its difference from T₀ = 293.15 K + 1 ulp; and B at ν = 10⁵ cm⁻¹, T = 1 K.
    #[test]
    fn named_values_of_another_program() {
        let (nu, t) = (1234.5, 293.15);
        let next = f64::from_bits(293.15_f64.to_bits() + 1);
        for (found, exact) in [
            (photon_radiance(nu, t), B_VALUE),
            (photon_radiance_slope(nu, t), B_SLOPE),
            (photon_radiance_difference(nu, next, t), B_DIFFERENCE),
            (photon_radiance(1e5, 1.0), B_TINY),
        ] {
            let error = found.relative_error_to(&Extended::parse(exact));
            assert!(error < 1e-48, "{exact}: {error:e}");
        }
    }

    const B_VALUE: &str = "2140409866894068149.8481979284112340200878683971689";
    const B_SLOPE: &str = "44342257542444550.242366199796696479154816753849878";
    const B_DIFFERENCE: &str = "2520.5655187190000000377348339356010994059713225869";
    const B_TINY: &str = "3.104500282181287610378531852808398119362357048423e-62461";

    #[test]
    fn tables_give_what_the_exponential_gives() {
        let scale = second_radiation_cm_k() / Extended::from(300.1);
        let uniform: Vec<f64> = (0..500).map(|i| 715.0 + 0.1 * f64::from(i)).collect();
        let wild: Vec<f64> = (0..500).map(|i| 1e-3 * 1.037_f64.powi(i)).collect();
        for nodes in [uniform, wild] {
            let tabled = exponentials(&nodes, &scale);
            for (node, tabled) in nodes.iter().zip(tabled) {
                let direct = (&scale * Extended::from(*node)).exp();
                assert!(tabled.relative_error_to(&direct) < 1e-148, "{node}");
            }
        }
        assert!(Tables::new(&[1e-30, 1e30], &scale).is_none());
    }
}
