//! What a Rust source uses of other files: its `use` lines, and paths anywhere in it, macros included.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::BTreeMap;

/// Words of a source, without comments and literals.
fn words(stream: TokenStream, found: &mut Vec<String>) {
    for token in stream {
        match token {
            TokenTree::Literal(_) => found.push("0".into()),
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Brace => ("{", "}"),
                    Delimiter::Bracket => ("[", "]"),
                    Delimiter::Parenthesis | Delimiter::None => ("(", ")"),
                };
                found.push(open.into());
                words(group.stream(), found);
                found.push(close.into());
            }
            TokenTree::Ident(_) | TokenTree::Punct(_) => found.push(token.to_string()),
        }
    }
}

/// The single paths of `use a::{b, c as d};`, each with the name that it has here.
fn expand(before: &str, tree: &str, found: &mut Vec<(String, String)>) {
    let mut depth = 0;
    let between = |letter| {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        letter == ',' && depth == 0
    };
    for part in tree.split(between).map(str::trim).filter(|part| !part.is_empty()) {
        if let Some((path, inner)) = part.split_once('{') {
            expand(&(before.to_owned() + path), inner.strip_suffix('}').unwrap_or(inner), found);
        } else {
            let (path, own) = part.split_once(" as ").map_or((part, None), |(path, own)| (path, Some(own)));
            let path = before.to_owned() + path;
            let path = path.strip_suffix("::self").unwrap_or(&path);
            let own = own.unwrap_or_else(|| path.rsplit("::").next().unwrap_or(path));
            found.push((path.to_owned(), own.to_owned()));
        }
    }
}

/// What a file uses: from which module in it, by which path, and whether it is handed on; and names handed on.
#[derive(Default)]
pub(crate) struct File {
    pub used: Vec<(String, String, bool)>,
    pub exported: BTreeMap<String, String>,
}

impl File {
    pub(crate) fn read(module: &str, source: &str) -> Self {
        let mut found = Vec::new();
        words(source.parse().unwrap_or_else(|error| panic!("{module}: {error}")), &mut found);
        // Paths become one word each: `a::b::c`, in a `use` line also `a::{`.
        let text = found.join(" ").replace(": :", "::").replace(" :: ", "::");
        let words: Vec<&str> = text.split(' ').collect();
        let (mut file, mut at, mut depth, mut place) = (Self::default(), 0, 0, vec![(-1, module.to_owned())]);
        while at < words.len() {
            let here = place[place.len() - 1].1.clone();
            match words[at] {
                "#" if words[at..].starts_with(&["#", "[", "cfg", "(", "test", ")", "]"]) => {
                    let mut depth = 0;
                    let end = words[at..].iter().position(|word| {
                        depth += i32::from(word.ends_with('{')) - i32::from(*word == "}");
                        depth == 0 && [";", "}"].contains(word)
                    });
                    at += end.unwrap_or(words.len());
                }
                "use" if words[at + 1] != "<" => {
                    let end = at + words[at..].iter().position(|word| *word == ";").unwrap_or(0);
                    let before = words[..at].iter().rev().take_while(|word| ![";", "{", "}"].contains(word));
                    let public = before.into_iter().any(|word| *word == "pub");
                    let mut paths = Vec::new();
                    expand("", &words[at + 1..end].join(" "), &mut paths);
                    file.used.extend(paths.iter().map(|(path, _)| (here.clone(), path.clone(), public)));
                    if public {
                        file.exported.extend(paths.into_iter().map(|(path, own)| (own, path)));
                    }
                    at = end;
                }
                "mod" if words.get(at + 2) == Some(&"{") => place.push((depth, join(&here, words[at + 1]))),
                "{" => depth += 1,
                "}" => {
                    depth -= 1;
                    place.pop_if(|(outer, _)| *outer == depth);
                }
                // `pub(in path)` says who sees it, and uses nothing.
                path if path.contains("::") && !words[..at].ends_with(&["(", "in"]) => {
                    file.used.push((here, path.trim_end_matches("::<").to_owned(), false));
                }
                _ => {}
            }
            at += 1;
        }
        file
    }
}

pub(crate) fn join(module: &str, name: &str) -> String {
    if module.is_empty() { name.to_owned() } else { format!("{module}::{name}") }
}

pub(crate) fn above(module: &str) -> &str {
    module.rsplit_once("::").map_or("", |(above, _)| above)
}
