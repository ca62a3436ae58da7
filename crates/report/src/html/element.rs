//! Elements of a page, and text that can stand in them.

use hadar::words::visible;

/// What may be wider than the page, and is then moved by itself, by keys too.
pub(crate) fn wide(name: &str, content: &str) -> String {
    format!("<div class=\"wide\" tabindex=\"0\" role=\"group\" aria-label=\"{name}\">\n{content}</div>\n")
}

/// A table whose first column has the heads of the rows; other cells are as they are in HTML.
pub(super) fn table(
    attributes: &str,
    caption: &str,
    (first, others): (&str, &str),
    rows: impl Iterator<Item = (String, String)>,
) -> String {
    let row = |(first, others): (String, String)| match first.as_str() {
        "" => format!("<tr><td></td>{others}</tr>\n"),
        _ => format!("<tr><th scope=\"row\">{first}</th>{others}</tr>\n"),
    };
    let rows = rows.map(row);
    format!(
        "<table{attributes}>\n<caption>{caption}</caption>\n<thead><tr><th scope=\"col\">{first}</th>{others}</tr></thead>\n<tbody>\n\
         {}</tbody>\n</table>\n",
        rows.collect::<String>()
    )
}

/// Text that can stand anywhere in the page.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for char in visible(text).chars() {
        match char {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            char => out.push(char),
        }
    }
    out
}
