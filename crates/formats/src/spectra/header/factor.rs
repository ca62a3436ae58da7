//! Factors that a header states of its numbers, as in `emissivity*100`, `(x100)`, `[1e-2]`, `ppm`: whose name they were, numbers would be a
//! hundred times too large.

/// Words beside a quantity that say of what size its unit is.
const SCALES: &[&str] = &[
    "ppm", "ppt", "permille", "promille", "permil", "mille", "100", "1000", "10000", "1e2", "1e3", "1e4",
    "10e2", "10e3",
];

/// Whether a header states a factor, as in `emissivity*100`, `(x100)`, `[1e-2]`, `ppm`; where it does not say a quantity, one that no name has.
pub(super) fn is_scaled(cell: &str, is_said: bool) -> bool {
    let lower = cell.to_lowercase();
    let digit_after = |sign: char| {
        lower.match_indices(sign).any(|(at, sign)| {
            lower
                .get(at + sign.len()..)
                .is_some_and(|rest| rest.trim_start().starts_with(|c: char| c.is_ascii_digit()))
        })
    };
    if lower.contains('‰') || digit_after('*') || digit_after('×') {
        return true;
    }
    let of_ten = |word: &str| {
        word.strip_prefix('1')
            .is_some_and(|zeros| !zeros.is_empty() && zeros.bytes().all(|byte| byte == b'0'))
    };
    let mut words = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    if words.clone().any(|word| word.strip_prefix('x').or(word.strip_suffix('x')).is_some_and(of_ten)) {
        return true;
    }
    // `1e-2`, `e-2`, `10^-2`.
    let power = |sign: &str| {
        lower.match_indices(sign).any(|(at, sign)| {
            let before = lower.get(..at).and_then(|rest| rest.chars().next_back());
            let after = lower.get(at + sign.len()..).and_then(|rest| rest.chars().next());
            before.is_none_or(|c| !c.is_alphabetic()) && after.is_some_and(|c| c.is_ascii_digit())
        })
    };
    is_said
        && (lower.contains(['*', '×', '^'])
            || words.any(|word| SCALES.contains(&word))
            || power("e-")
            || power("e+"))
}
