//! What a word means, as a page of its own: keys of the scenario, warnings, keys of the answer.

use hadar_study::explain;
use hadar_study::scenario::keys::Silent;
use std::fmt::Write as _;

/// The page of a word; none where it means nothing.
pub(crate) fn page(word: &str) -> Option<String> {
    let plain = |char: char| char.is_ascii_alphanumeric() || "._-".contains(char);
    if word.is_empty() || word.len() > 100 || !word.chars().all(plain) {
        return None;
    }
    let (keys, code, results) = (explain::key(word), explain::code(word), explain::result(word));
    let mut body = String::new();
    let row = |body: &mut String, name: &str, text: &str| {
        let _ = writeln!(body, "<dt>{name}</dt><dd>{}</dd>", escaped(text));
    };
    for place in &keys {
        let key = &place.key;
        let _ = writeln!(body, "<h2>{}</h2>\n<p>{}</p>\n<dl>", place.paths.join(", "), escaped(key.meaning));
        row(&mut body, "written", &key.value.words());
        let silent = match key.silent {
            Silent::Refused => "refused: it must be there".to_owned(),
            Silent::Is(value) => format!("{} = {value}", key.name),
            Silent::Means(words) => words.to_owned(),
        };
        row(&mut body, "silent", &silent);
        if key.value.table().is_none() {
            row(&mut body, "example", &format!("{} = {}", key.name, key.example));
            row(&mut body, "enters", key.enters);
        }
        body.push_str("</dl>\n");
    }
    if let Some(code) = code {
        let _ =
            writeln!(body, "<h2>Warning [{}]</h2>\n<p>{}</p>\n<dl>", code.name(), escaped(code.meaning()));
        row(&mut body, "do", code.remedy());
        body.push_str("</dl>\n");
    }
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
        for word in ["", "<script>", "nothing-of-the-kind", "../page.css", &"a".repeat(200)] {
            assert!(page(word).is_none(), "{word}");
        }
    }
}
