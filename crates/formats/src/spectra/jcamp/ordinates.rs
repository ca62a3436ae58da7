//! Ordinates of `(X++(Y..Y))`: numbers apart (AFFN), numbers with signs (PAC), and the squeezed forms SQZ, DIF and DUP.
//!
//! A line is its x and then ordinates. In the squeezed forms the first digit of a number is a letter that says sign and kind as well: `@`, `A` to `I`
//! are 0 to 9, `a` to `i` are −1 to −9 (SQZ); `%`, `J` to `R`, `j` to `r` the same as differences to the ordinate before (DIF); `S` to `Z`, `s`
//! are 1 to 9, how often the last number stands (DUP). After a line that ends with a difference the first ordinate repeats the last one,
//! as a check.

use hadar::error::{Error, Result};

/// The x that a line begins with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Start {
    pub(super) line: usize,
    pub(super) x: f64,
    /// Place of the line's first ordinate among all.
    pub(super) index: usize,
    /// What the last digit of x stands for.
    pub(super) last_digit: f64,
}

/// What a number does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Value,
    Difference,
    Repeat,
}

/// The first digit that a letter stands for.
fn digit(char: char) -> Option<(Kind, &'static str, char)> {
    let from = |start: char| char::from_digit((u32::from(char) - u32::from(start)) % 10, 10).unwrap_or('0');
    // `A` is 1, as many after it as its place in the alphabet.
    let one = |start: char| char::from_digit(u32::from(char) - u32::from(start) + 1, 10).unwrap_or('0');
    Some(match char {
        '@' => (Kind::Value, "", from('@')),
        'A'..='I' => (Kind::Value, "", one('A')),
        'a'..='i' => (Kind::Value, "-", one('a')),
        '%' => (Kind::Difference, "", '0'),
        'J'..='R' => (Kind::Difference, "", one('J')),
        'j'..='r' => (Kind::Difference, "-", one('j')),
        'S'..='Z' => (Kind::Repeat, "", one('S')),
        's' => (Kind::Repeat, "", '9'),
        _ => return None,
    })
}

/// A number of a line.
struct Token {
    kind: Kind,
    text: String,
}

/// All ordinates, without factors, and the x of every line.
///
/// # Errors
/// A character that is none of a form, a check that fails, a repetition of nothing, more than [`MOST`] ordinates.
pub(super) fn read(data: &[(usize, &str)]) -> Result<(Vec<f64>, Vec<Start>)> {
    // `E` is 5 in squeezed forms and an exponent in plain ones.
    let squeezed = data
        .iter()
        .any(|(_, line)| line.chars().any(|char| !matches!(char, 'E' | 'e') && digit(char).is_some()));
    let (mut values, mut starts): (Vec<f64>, Vec<Start>) = (Vec::new(), Vec::with_capacity(data.len()));
    let mut ends_with_difference = false;
    for &(line, content) in data {
        let at = |error: Error| error.on_line(line);
        let mut tokens = tokens(content, squeezed).map_err(at)?.into_iter();
        let Some(x) = tokens.next() else { continue };
        // What may be repeated: the number before on this line.
        let mut before = None;
        let mut index = values.len();
        let due = values.last().copied().filter(|_| ends_with_difference);
        if let Some(due) = due
            && let Some(check) = tokens.next()
        {
            let found = value(&check).map_err(at)?;
            // A line of the check alone ends the data of some writers, whatever it says.
            if (check.kind != Kind::Value || found != due) && !tokens.as_slice().is_empty() {
                let found = format!(
                    "the check at the begin of the line is {found} where the ordinate before is {due}"
                );
                return Err(at(Error::malformed(found, DAMAGED)));
            }
            (before, index) = (Some((Kind::Value, found)), index - 1);
        }
        starts.push(Start { line, x: value(&x).map_err(at)?, index, last_digit: last_digit(&x.text) });
        for token in tokens {
            let number = value(&token).map_err(at)?;
            let many = if token.kind == Kind::Repeat { number - 1.0 } else { 1.0 };
            if token.kind != Kind::Repeat {
                before = Some((token.kind, number));
            }
            let (Some((kind, number)), true) = (before, many >= 0.0 && many.fract() == 0.0) else {
                let found = format!("`{}` repeats what is not there", token.text);
                return Err(at(Error::malformed(found, DAMAGED)));
            };
            if values.len() as f64 + many > MOST as f64 {
                let found = format!("more than {MOST} ordinates");
                return Err(at(Error::malformed(found, "export the spectrum with fewer points")));
            }
            for _ in 0..many as usize {
                match (kind, values.last()) {
                    (Kind::Difference, Some(last)) => values.push(last + number),
                    (Kind::Difference, None) => {
                        let found = format!("`{}` changes what is not there", token.text);
                        return Err(at(Error::malformed(found, DAMAGED)));
                    }
                    _ => values.push(number),
                }
            }
        }
        ends_with_difference = before.is_some_and(|(kind, _)| kind == Kind::Difference);
    }
    Ok((values, starts))
}

/// More ordinates than a spectrum has.
const MOST: usize = 1 << 22;
const DAMAGED: &str = "fetch the file again: it is damaged";

fn value(token: &Token) -> Result<f64> {
    token.text.parse::<f64>().ok().filter(|value| value.is_finite()).ok_or_else(|| {
        let found = format!("`{}` is not a number", token.text);
        Error::malformed(found, "export the data as plain numbers")
    })
}

/// What the last digit of a number stands for.
fn last_digit(text: &str) -> f64 {
    let mantissa = text.split(['E', 'e']).next().unwrap_or_default();
    mantissa
        .split_once('.')
        .map_or(1.0, |(_, decimals)| 0.1_f64.powi(i32::try_from(decimals.len()).unwrap_or(0)))
}

fn tokens(line: &str, squeezed: bool) -> Result<Vec<Token>> {
    let mut tokens: Vec<Token> = Vec::new();
    let mut chars = line.chars().peekable();
    // Whether the last token is still being written.
    let mut open = false;
    while let Some(char) = chars.next() {
        let exponent = matches!(char, 'E' | 'e')
            && open
            && tokens
                .last()
                .is_some_and(|token| token.text.ends_with(|last: char| last.is_ascii_digit() || last == '.'))
            && chars
                .peek()
                .is_some_and(|next| matches!(next, '+' | '-') || !squeezed && next.is_ascii_digit());
        let append = |tokens: &mut Vec<Token>, char: char| {
            if let Some(token) = tokens.last_mut() {
                token.text.push(char);
            }
        };
        if exponent {
            append(&mut tokens, char);
            if let Some(sign) = chars.next_if(|next| matches!(next, '+' | '-')) {
                append(&mut tokens, sign);
            }
        } else if char.is_ascii_digit() || char == '.' {
            if open {
                append(&mut tokens, char);
            } else {
                tokens.push(Token { kind: Kind::Value, text: char.to_string() });
                open = true;
            }
        } else if matches!(char, '+' | '-') {
            tokens.push(Token { kind: Kind::Value, text: char.to_string() });
            open = true;
        } else if char.is_whitespace() || matches!(char, ',' | ';') {
            open = false;
        } else if let Some((kind, sign, first)) = digit(char) {
            tokens.push(Token { kind, text: format!("{sign}{first}") });
            open = true;
        } else {
            let found = format!("`{char}` among the ordinates");
            let instead = if char == '?' {
                "write a number for every point"
            } else {
                "export the data as plain numbers"
            };
            return Err(Error::malformed(found, instead));
        }
    }
    Ok(tokens)
}
