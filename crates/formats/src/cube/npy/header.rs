//! The text of an NPY header: a Python dictionary of three entries, `{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), }`.
//!
//! Source: NumPy, `numpy.lib.format`. A value is what stands up to the next comma outside of brackets and quotes.

/// What it says.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// Type of the samples as it stands: an array-protocol string in quotes, or the list of a structured one.
    pub(super) descr: String,
    pub(super) fortran_order: bool,
    pub(super) sides: Vec<usize>,
}

/// `None` where it is anything else.
pub(super) fn parse(text: &str) -> Option<Header> {
    let mut rest = text.trim().strip_prefix('{')?.strip_suffix('}')?.trim_start();
    let (mut descr, mut order, mut shape) = (None, None, None);
    while !rest.is_empty() {
        let (key, after) = split(rest, ':')?;
        let (value, after) = split(after, ',').unwrap_or((after.trim(), ""));
        let entry = match quoted(key)? {
            "descr" => &mut descr,
            "fortran_order" => &mut order,
            "shape" => &mut shape,
            _ => return None,
        };
        if entry.replace(value).is_some() {
            return None;
        }
        rest = after.trim_start();
    }
    let descr = descr.filter(|descr| descr.starts_with('[') || quoted(descr).is_some())?;
    let fortran_order = match order? {
        "True" => true,
        "False" => false,
        _ => return None,
    };
    let inside = shape?.strip_prefix('(')?.strip_suffix(')')?.trim();
    // One number in brackets is no tuple.
    let inside = match inside.strip_suffix(',') {
        Some(all) => all,
        None if inside.is_empty() || inside.contains(',') => inside,
        None => return None,
    };
    let sides = match inside {
        "" => Vec::new(),
        all => all.split(',').map(side).collect::<Option<_>>()?,
    };
    Some(Header { descr: descr.to_owned(), fortran_order, sides })
}

/// A number without a sign; Python 2 wrote an L behind it.
fn side(text: &str) -> Option<usize> {
    let digits = text.trim().trim_end_matches('L');
    digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| digits.parse().ok())?
}

/// What stands between quotes of one kind.
pub(super) fn quoted(text: &str) -> Option<&str> {
    let mark = text.chars().next().filter(|mark| matches!(mark, '\'' | '"'))?;
    text.strip_prefix(mark)?.strip_suffix(mark).filter(|inside| !inside.contains([mark, '\\']))
}

/// What stands before the first such mark outside of brackets and quotes, and after it; `None` without one.
fn split(text: &str, mark: char) -> Option<(&str, &str)> {
    let (mut open, mut quote) = (0_usize, None);
    for (place, c) in text.char_indices() {
        match (quote, c) {
            (Some(own), _) => quote = quote.filter(|_| c != own),
            (None, '\'' | '"') => quote = Some(c),
            (None, '(' | '[' | '{') => open += 1,
            (None, ')' | ']' | '}') => open = open.checked_sub(1)?,
            (None, _) if open == 0 && c == mark => {
                return Some((text[..place].trim(), &text[place + c.len_utf8()..]));
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{Header, parse};
    use proptest::prelude::*;

    fn header(descr: &str, fortran_order: bool, sides: &[usize]) -> Option<Header> {
        Some(Header { descr: descr.to_owned(), fortran_order, sides: sides.to_vec() })
    }

    #[test]
    fn headers_are_read_as_python_writes_them() {
        for (text, expected) in [
            (
                "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), }    \n",
                header("'<f4'", false, &[2, 3, 4]),
            ),
            ("{\"shape\":(5,),\"descr\":\">u2\",\"fortran_order\":True}", header("\">u2\"", true, &[5])),
            ("{'descr': '|b1', 'fortran_order': False, 'shape': ()}", header("'|b1'", false, &[])),
            ("{'descr': '<i8', 'fortran_order': False, 'shape': (2L, 3L)}", header("'<i8'", false, &[2, 3])),
            (
                "{'descr': [('a, b', '<f4'), ('c', '<f4', (2,))], 'fortran_order': False, 'shape': (1,), }",
                header("[('a, b', '<f4'), ('c', '<f4', (2,))]", false, &[1]),
            ),
        ] {
            assert_eq!(parse(text), expected, "{text}");
        }
    }

    #[test]
    fn anything_else_is_refused() {
        for text in [
            "",
            "{}",
            "[1]",
            "{'descr': '<f4', 'fortran_order': False}",
            "{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (1,)}",
            "{'descr': '<f4', 'fortran_order': 0, 'shape': (1,)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (1)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (1, -2)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (1, , 2)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999,)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (1,), 'more': 1}",
            "{'descr': '<f4, 'fortran_order': False, 'shape': (1,)}",
            "{'descr': ((((((((((((((((((((((((((((((, 'fortran_order': False, 'shape': (1,)}",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }

    proptest! {
        /// No text makes it panic.
        #[test]
        fn any_text_is_read_or_refused(text in "[{}()\\[\\]'\":,. a-zß0-9<>|]{0,60}") {
            let _ = parse(&text);
        }
    }
}
