//! Tail of the normal law, and the exact error of the best test between two Poisson laws, in extended precision.
//!
//! * Φ(−d) = ½ − (2π)^{-½} e^{−d²/2} Σ d^{2n+1}/(2n+1)!! below d = 6 (what the subtraction loses, 26 bits, is there to
//!   lose), and above it (2π)^{-½} e^{−d²/2}/(d + 1/(d + 2/(d + 3/(d + …)))), of which 800 partial fractions give all digits at
//!   d = 6, and fewer beyond;
//! * error = ½Σₙ min(p(n), q(n)) over the counts of up to three bands, p and q products of Poisson laws: in the last
//!   band the smaller of the two is one law below a count and the other above it, where cumulative sums serve.
//!
//! Source: Abramowitz and Stegun, 'Handbook of Mathematical Functions', 26.2.11 and 26.2.14.

use super::Extended;

/// Partial fractions at d = [`FAR`], and at least: the relative error after n of them is about e^{−2d√(2n)}, below 1e-150 for as many
/// as 1/d² of these.
const FRACTIONS: f64 = 800.0;
const FEWEST_FRACTIONS: f64 = 30.0;
/// Distance from which the continued fraction is used.
const FAR: f64 = 6.0;
/// Share of a law that counts left out may have.
const NEGLECTED: i32 = -140;

/// Φ(−d): the probability that a normal deviate of deviation 1 lies beyond d.
///
/// ```
/// let tail = hadar_evidence::reference::probability::normal_tail(37.0).to_f64();
/// assert!((tail / 5.725571222524577e-300 - 1.0).abs() < 1e-14);
/// ```
#[must_use]
pub fn normal_tail(distance: f64) -> Extended {
    let tail = if distance.abs() < FAR {
        Extended::from(0.5) - near(distance.abs())
    } else {
        let d = Extended::from(distance.abs());
        let mut below = d.clone();
        let fractions = FRACTIONS * (FAR / distance).powi(2) + FEWEST_FRACTIONS;
        for n in (1..fractions as u32).rev() {
            below = &d + Extended::from(f64::from(n)) / below;
        }
        density(&d) / below
    };
    if distance < 0.0 { Extended::one() - tail } else { tail }
}

/// (2π)^{-½} e^{−d²/2}.
fn density(d: &Extended) -> Extended {
    (-(d.square() * Extended::from(0.5))).exp() / (Extended::pi().times_power_of_two(1)).sqrt()
}

/// Φ(d) − ½ by its series.
fn near(distance: f64) -> Extended {
    let d = Extended::from(distance);
    let (mut term, mut sum, mut n) = (d.clone(), d.clone(), 1.0);
    let little = Extended::from(1e-170);
    while term > &sum * &little {
        n += 2.0;
        term = term * d.square() / Extended::from(n);
        sum = sum + &term;
    }
    density(&d) * sum
}

/// 2Φ(d) − 1 for d ≥ 0, all digits also where it is far below 1.
fn excess(distance: f64) -> Extended {
    let half = if distance < FAR { near(distance) } else { Extended::from(0.5) - normal_tail(distance) };
    half.times_power_of_two(1)
}

/// Information log₂ 2Φ(d), bits; d ≥ 0.
#[must_use]
pub fn information_bits(distance: f64) -> Extended {
    excess(distance).ln_1p() / Extended::from(2.0).ln()
}

/// Mutual information of the binary decision, 1 − H₂(Φ(d)) = [(1+δ)ln(1+δ) + (1−δ)ln(1−δ)]/(2 ln2), δ = 2Φ(d) − 1, bits;
/// d ≥ 0.
#[must_use]
pub fn mutual_information_bits(distance: f64) -> Extended {
    let excess = excess(distance);
    let ln2 = Extended::from(2.0).ln();
    if excess.to_f64() < 1e-15 {
        // δ²/2 + δ⁴/12 + δ⁶/30 + δ⁸/56, of which the next term is below 10⁻¹²⁰.
        let square = excess.square();
        let terms = [56.0, 30.0, 12.0, 2.0].into_iter();
        return terms.fold(Extended::zero(), |sum, n| (Extended::one() / Extended::from(n) + sum) * &square)
            / ln2;
    }
    let one = Extended::one();
    // 1 − δ = 2Φ(−d) with all its digits.
    let less = normal_tail(distance).times_power_of_two(1);
    let sides = (&one + &excess) * excess.ln_1p() + &less * less.ln();
    sides.times_power_of_two(-1) / ln2
}

/// Probabilities of the counts 0, 1, 2 … of a Poisson law, up to where less than 1e-140 is left.
fn poisson(mean: f64) -> Vec<Extended> {
    let mean_extended = Extended::from(mean);
    let mut law = vec![(-&mean_extended).exp()];
    let smallest = Extended::from(10.0f64.powi(NEGLECTED));
    while (law.len() as f64) < mean + 2.0 || law[law.len() - 1] > smallest {
        let n = law.len();
        law.push(&law[n - 1] * &mean_extended / Extended::from(n as f64));
    }
    law
}

/// Two laws over the same counts, and Σ of each from count n on.
struct Two {
    first: Vec<Extended>,
    second: Vec<Extended>,
}

impl Two {
    fn new(mean: f64, other: f64) -> Self {
        let (mut first, mut second) = (poisson(mean), poisson(other));
        let count = first.len().max(second.len());
        for (law, mean) in [(&mut first, mean), (&mut second, other)] {
            while law.len() < count {
                let n = law.len();
                let next = &law[n - 1] * Extended::from(mean) / Extended::from(n as f64);
                law.push(next);
            }
        }
        Self { first, second }
    }

    fn ascending_second(&self) -> bool {
        // Poisson laws: q/p rises with n where the second mean is the larger.
        self.second[0] < self.first[0]
    }
}

/// Sums of a law from its beginning up to before n, and from n on.
struct Cumulative {
    below: Vec<Extended>,
    from: Vec<Extended>,
}

impl Cumulative {
    fn of(law: &[Extended]) -> Self {
        let mut below = vec![Extended::zero()];
        for p in law {
            below.push(&below[below.len() - 1] + p);
        }
        let mut from = vec![Extended::zero()];
        for p in law.iter().rev() {
            from.push(&from[from.len() - 1] + p);
        }
        from.reverse();
        Self { below, from }
    }
}

/// The error of the best test between two equally likely product laws of Poisson counts with `means` and `others`:
/// ½Σ min(p, q), by summation over all counts. Work grows with the product of the ranges of all bands but one: up to
/// three bands of means up to a few hundred.
///
/// ```
/// // One count more or less: the threshold is between 2 and 3 photons.
/// let exact = 0.5 * (1.0 - 5.0 * (-2.0_f64).exp() + 8.5 * (-3.0_f64).exp());
/// let found = hadar_evidence::reference::probability::poisson_error(&[2.0], &[3.0]).to_f64();
/// assert!((found / exact - 1.0).abs() < 1e-14);
/// ```
#[must_use]
pub fn poisson_error(means: &[f64], others: &[f64]) -> Extended {
    // Bands that do not differ tell nothing: they sum to 1.
    let mut bands: Vec<Two> =
        means.iter().zip(others).filter(|(a, b)| a != b).map(|(&a, &b)| Two::new(a, b)).collect();
    bands.sort_by_key(|band| band.first.len());
    let Some(last) = bands.pop() else { return Extended::from(0.5) };
    let sums = [Cumulative::of(&last.first), Cumulative::of(&last.second)];
    let mut total = Extended::zero();
    let one = Extended::one();
    add_up(&bands, &one, &one, &mut |p, q| {
        let count = last.first.len();
        // The first count at which the law that gains with n is the larger.
        let rising = last.ascending_second();
        let beyond = |n: &usize| {
            let (p, q) = (p * &last.first[*n], q * &last.second[*n]);
            if rising { q >= p } else { p >= q }
        };
        let indices: Vec<usize> = (0..count).collect();
        let turn = indices.partition_point(|n| !beyond(n));
        let (low, high) = if rising { (1, 0) } else { (0, 1) };
        let factor = [p, q];
        total = &total + factor[low] * &sums[low].below[turn] + factor[high] * &sums[high].from[turn];
    });
    total * Extended::from(0.5)
}

/// Calls `each` with the two probabilities of every combination of counts.
fn add_up(bands: &[Two], p: &Extended, q: &Extended, each: &mut impl FnMut(&Extended, &Extended)) {
    let Some((band, rest)) = bands.split_first() else {
        each(p, q);
        return;
    };
    for (first, second) in band.first.iter().zip(&band.second) {
        add_up(rest, &(p * first), &(q * second), each);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// mpmath 1.3 at 30 digits, ½Σ min(p, q) over all counts up to 329 of both bands, means the doubles themselves.
    #[test]
    fn two_bands_of_another_program() {
        let found = poisson_error(&[150.3, 121.7], &[171.9, 108.2]);
        let exact = Extended::parse("0.144823835968958175291553516439");
        assert!(found.relative_error_to(&exact) < 1e-26);
    }

    #[test]
    fn thirty_digit_references_are_met() {
        let Some(references) = hadar_testing::reference_rows("detection.csv") else { return };
        for cells in references {
            let d: f64 = cells[0].parse().unwrap();
            for (found, exact) in
                [(normal_tail(-d), &cells[1]), (normal_tail(d), &cells[2]), (information_bits(d), &cells[3])]
            {
                let error = found.relative_error_to(&Extended::parse(exact));
                // The arguments of the file are its decimal digits; the doubles are 1e-16 of d from them.
                let bound = if d.fract() == 0.0 || d == 0.5 { 1e-27 } else { 1e-16 };
                assert!(error < bound, "{cells:?}: {error:e}");
            }
        }
    }

    /// mpmath 1.3 at 80 digits: erfc(d/√2)/2 at d = 0.1 (the double), 5.75, 6.25, 38.5 and 40; both formulas near where
    /// they meet.
    #[test]
    fn named_values_of_another_program() {
        for (d, exact) in [
            (0.1, "0.46017216272297101633106609229787264718876340257014"),
            (5.75, "0.0000000044621724539016118730692225884162352285161990365718"),
            (6.25, "0.00000000020522634252189388816227635957916383914621199490805"),
            (38.5, "1.4081824631705174617700996302451983873539843539124e-324"),
            (40.0, "3.6558935409150297037489858026882836650539446199774e-350"),
        ] {
            let error = normal_tail(d).relative_error_to(&Extended::parse(exact));
            assert!(error < 1e-48, "{d}: {error:e}");
        }
    }

    /// mpmath 1.3 at 400 digits: log₂(1 + erf(d/√2)) and 1 − H₂ at d = 1e-120, 1e-8 (the doubles), 1.5 and 9.
    #[test]
    fn information_of_another_program() {
        for (d, bits, mutual) in [
            (
                1e-120,
                "1.1511040990721624199412776530416192584743578832744e-120",
                "4.5922409426328515159565707256338515479933434464505e-241",
            ),
            (
                1e-08,
                "0.000000011511040944799215312602603550487461000069045627316",
                "4.5922409426328518002543600888325553658261028546138e-17",
            ),
            (
                1.5,
                "0.90024707947830386751884147554295009931589289147105",
                "0.64610582868310467269471513202082976609428896327263",
            ),
            (
                9.0,
                "0.99999999999999999983717911035256138336060929499972",
                "0.99999999999999999273360505804871607786916051832805",
            ),
        ] {
            for (found, exact) in [(information_bits(d), bits), (mutual_information_bits(d), mutual)] {
                let error = found.relative_error_to(&Extended::parse(exact));
                assert!(error < 1e-48, "{d}: {error:e}");
            }
        }
    }

    /// mpmath 1.3 at 60 digits: ½Σ min(p, q) by brute force over all counts up to 120 of (3, 7.5) against (4.25, 6), and
    /// up to 900 of 300 against 350.5.
    #[test]
    fn errors_between_poisson_laws_of_another_program() {
        for (means, others, exact) in [
            (&[3.0, 7.5][..], &[4.25, 6.0][..], "0.331207937682571004692509149697634434925137972817"),
            (&[300.0], &[350.5], "0.0805449821185195813245584080211576887570826375259"),
            (&[0.5, 1.5, 2.5], &[2.0, 0.25, 2.75], "0.16192795939382646601164102228719723520338511524"),
        ] {
            for (a, b) in [(means, others), (others, means)] {
                let error = poisson_error(a, b).relative_error_to(&Extended::parse(exact));
                assert!(error < 1e-45, "{means:?}: {error:e}");
            }
        }
        assert_eq!(poisson_error(&[3.0, 2.0], &[3.0, 2.0]).to_f64(), 0.5);
        // A dark band: the best test is wrong half the time where it stays dark.
        let exact = (-Extended::from(2.0)).exp() * Extended::from(0.5);
        assert!(poisson_error(&[0.0], &[2.0]).relative_error_to(&exact) < 1e-130);
    }
}
