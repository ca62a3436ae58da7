//! What a word means, as a page of its own: terms of the field, keys of the scenario, warnings, keys of the answer.

use hadar_report::explain::{self, ExplainedCode, ExplainedKey};
use std::fmt::Write as _;

/// The page of a word; none where it means nothing.
pub(crate) fn page(word: &str) -> Option<String> {
    let plain = |char: char| char.is_ascii_alphanumeric() || "._-".contains(char);
    if word.is_empty() || word.len() > 100 || !word.chars().all(plain) {
        return None;
    }
    let mut body = String::new();
    let row = |body: &mut String, name: &str, text: &str| {
        let _ = writeln!(body, "<dt>{name}</dt><dd>{}</dd>", escaped(text));
    };
    for term in explain::term(word) {
        let _ = writeln!(body, "<h2>{}</h2>\n<p>{}</p>\n<dl>", escaped(term.name), escaped(term.meaning));
        [("symbol", term.typed_symbol()), ("unit", term.unit.to_owned()), ("also", term.also.join(", "))]
            .iter()
            .filter(|(_, text)| !text.is_empty() && text != "-")
            .for_each(|(name, text)| row(&mut body, name, text));
        body.push_str("</dl>\n");
    }
    for key in explain::key(word).iter().map(ExplainedKey::from) {
        let _ = writeln!(body, "<h2>{}</h2>\n<p>{}</p>\n<dl>", key.paths.join(", "), escaped(key.meaning));
        row(&mut body, "written", &key.value);
        match (key.required, key.default, key.silent) {
            (true, ..) => row(&mut body, "default", "none: it must be stated"),
            (_, Some(text), _) | (_, None, Some(text)) => row(&mut body, "default", text),
            _ => {}
        }
        if let Some(example) = &key.example {
            row(&mut body, "example", example);
            row(&mut body, "used in", key.enters);
        }
        body.push_str("</dl>\n");
    }
    let codes = [
        ("Warning", explain::code(word).map(ExplainedCode::from)),
        ("Condition", explain::called(word, explain::conditions())),
        ("Falls short by", explain::called(word, explain::shortfalls())),
        ("Not passed for", explain::called(word, explain::reasons())),
    ];
    for (what, told) in codes.into_iter().filter_map(|(what, told)| Some((what, told?))) {
        let _ = writeln!(body, "<h2>{what} [{}]</h2>\n<p>{}</p>\n<dl>", told.code, escaped(told.meaning));
        row(&mut body, "do", told.remedy);
        body.push_str("</dl>\n");
    }
    let results = explain::result(word);
    if !results.is_empty() {
        body.push_str("<h2>In the answer</h2>\n<dl>\n");
        for one in &results {
            row(&mut body, &format!("{}, of: {}", one.key, escaped(one.of)), one.meaning);
        }
        body.push_str("</dl>\n");
    }
    (!body.is_empty()).then(|| {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{word}: hadar</title>\n\
             <link rel=\"stylesheet\" href=\"/page.css\">\n</head>\n<body class=\"meaning\">\n<main>\n<h1>{word}</h1>\n{body}\
             <p><a href=\"/\">To the calculator</a></p>\n</main>\n</body>\n</html>\n"
        )
    })
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::page;

    #[test]
    fn words_are_explained_and_nothing_else_is_put_into_a_page() {
        assert!(page("camera.exposure").unwrap().contains("<h1>camera.exposure</h1>"));
        assert!(page("diffraction").unwrap().contains("Warning [diffraction]"));
        assert!(page("camera.gamma_per_band").unwrap().contains("gamma_per_band"));
        assert!(page("NETD").unwrap().contains("<h2>NETD</h2>"));
        for word in ["", "<script>", "nothing-of-the-kind", "../page.css", &"a".repeat(200)] {
            assert!(page(word).is_none(), "{word}");
        }
    }
}
