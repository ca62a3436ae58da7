//! A page of HTML read strictly: every element closed where it must be, every attribute quoted.

use std::collections::BTreeMap;

/// Elements that have no end.
const VOID: [&str; 3] = ["meta", "wbr", "br"];

/// An element with its attributes, and the text directly after its beginning.
#[derive(Debug)]
pub(crate) struct Element {
    pub name: String,
    pub attributes: BTreeMap<String, String>,
    pub text: String,
}

/// All elements, in order of their beginnings.
#[track_caller]
pub(crate) fn elements(page: &str) -> Vec<Element> {
    let body = page.strip_prefix("<!DOCTYPE html>\n").expect("it says that it is HTML");
    let (mut found, mut open): (Vec<Element>, Vec<String>) = (Vec::new(), Vec::new());
    for part in body.split('<').skip(1) {
        let (tag, text) = part.split_once('>').unwrap_or_else(|| panic!("`<{part}` is not closed"));
        if open.last().is_none_or(|last| last != "style") {
            assert!(!text.contains('>'), "a bare `>` in {text}");
        }
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name), "`</{name}>` closes another element");
            continue;
        }
        let (tag, closed) = tag.strip_suffix('/').map_or((tag, false), |tag| (tag, true));
        let (name, mut rest) = tag.split_once([' ', '\n']).unwrap_or((tag, ""));
        let mut attributes = BTreeMap::new();
        while !rest.trim().is_empty() {
            let (key, value) =
                rest.trim_start().split_once("=\"").unwrap_or_else(|| panic!("`{rest}` of `{tag}`"));
            let (value, after) = value.split_once('"').expect("a quoted value ends");
            assert!(
                attributes.insert(key.to_owned(), value.to_owned()).is_none(),
                "`{key}` twice in `{tag}`"
            );
            rest = after;
        }
        if !closed && !VOID.contains(&name) {
            open.push(name.to_owned());
        }
        found.push(Element { name: name.to_owned(), attributes, text: text.trim().to_owned() });
    }
    assert!(open.is_empty(), "not closed: {open:?}");
    found
}
