//! A page of headings, paragraphs, lists and tables, every word of which is text: whoever wrote a name, a quote or a title cannot write headings,
//! emphasis or comments with it.
//!
//! In Markdown what has a meaning in CommonMark or in GitHub's dialect stands behind a backslash, and a line break is a space.
//!
//! Source: CommonMark 0.31 (spec.commonmark.org), 2.4 (backslash escapes).

use crate::html::element::{escape, wide};
use hadar::words::visible;
use std::fmt::Write as _;

/// A part of a page.
#[derive(Debug, Clone)]
enum Block {
    Heading(usize, String),
    /// Lines below each other, each with what it is.
    Fields(Vec<(&'static str, String)>),
    Paragraph(String),
    /// What matters most.
    Strong(String),
    Quote(String),
    /// Each behind a code, or without one.
    Items(Vec<(Option<String>, String)>),
    Table(Table),
}

/// A table; cells of some columns are codes.
#[derive(Debug, Clone)]
struct Table {
    head: Vec<String>,
    codes: Vec<usize>,
    rows: Vec<Vec<String>>,
}

/// A page.
#[derive(Debug, Clone, Default)]
pub(crate) struct Document(Vec<Block>);

impl Document {
    /// A heading, 1 the highest.
    pub(crate) fn heading(&mut self, level: usize, text: &str) {
        self.0.push(Block::Heading(level, text.to_owned()));
    }

    /// Lines below each other, each with what it is.
    pub(crate) fn fields(&mut self, fields: impl IntoIterator<Item = (&'static str, String)>) {
        self.0.push(Block::Fields(fields.into_iter().collect()));
    }

    pub(crate) fn paragraph(&mut self, text: &str) {
        self.0.push(Block::Paragraph(text.to_owned()));
    }

    /// What matters most.
    pub(crate) fn strong(&mut self, text: &str) {
        self.0.push(Block::Strong(text.to_owned()));
    }

    pub(crate) fn quote(&mut self, text: &str) {
        self.0.push(Block::Quote(text.to_owned()));
    }

    /// Items, each behind a code or without one.
    pub(crate) fn items(&mut self, items: impl IntoIterator<Item = (Option<String>, String)>) {
        let items: Vec<_> = items.into_iter().collect();
        if !items.is_empty() {
            self.0.push(Block::Items(items));
        }
    }

    /// A table; cells of the columns `codes` are codes.
    pub(crate) fn table<R>(&mut self, head: &[&str], codes: &[usize], rows: impl IntoIterator<Item = R>)
    where
        R: IntoIterator,
        R::Item: Into<String>,
    {
        let head = head.iter().map(|cell| (*cell).to_owned()).collect();
        let rows = rows.into_iter().map(|row| row.into_iter().map(Into::into).collect()).collect();
        self.0.push(Block::Table(Table { head, codes: codes.to_vec(), rows }));
    }

    /// All of it, and then all of another.
    pub(crate) fn followed_by(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    /// The page in Markdown.
    pub(crate) fn to_markdown(&self) -> String {
        let mut out = String::new();
        for block in &self.0 {
            match block {
                Block::Heading(level, text) => {
                    let _ = writeln!(out, "{} {}\n", "#".repeat(*level), escaped(text));
                }
                Block::Fields(fields) => {
                    for (label, value) in fields {
                        let _ = writeln!(out, "{label}: {}  ", escaped(value));
                    }
                    out.push('\n');
                }
                Block::Paragraph(text) => {
                    let _ = writeln!(out, "{}\n", escaped(text));
                }
                Block::Strong(text) => {
                    let _ = writeln!(out, "**{}**\n", escaped(text));
                }
                Block::Quote(text) => {
                    let _ = writeln!(out, "> {}\n", escaped(text));
                }
                Block::Items(items) => {
                    for (code, text) in items {
                        let code =
                            code.as_deref().map_or_else(String::new, |code| format!("{}: ", verbatim(code)));
                        let _ = writeln!(out, "- {code}{}", escaped(text));
                    }
                    out.push('\n');
                }
                Block::Table(table) => out.push_str(&table.to_markdown()),
            }
        }
        out
    }

    /// The same as a part of a page of HTML, headings two levels lower.
    pub(crate) fn to_html(&self) -> String {
        let (mut out, mut below) = (String::new(), "");
        for block in &self.0 {
            let _ = match block {
                Block::Heading(level, text) => {
                    below = text;
                    writeln!(out, "<h{0}>{1}</h{0}>", level + 2, escape(text))
                }
                Block::Fields(fields) => {
                    let rows = fields
                        .iter()
                        .map(|(label, value)| format!("<dt>{label}</dt><dd>{}</dd>\n", escape(value)));
                    writeln!(out, "<dl>\n{}</dl>", rows.collect::<String>())
                }
                Block::Paragraph(text) => writeln!(out, "<p>{}</p>", escape(text)),
                Block::Strong(text) => writeln!(out, "<p><strong>{}</strong></p>", escape(text)),
                Block::Quote(text) => writeln!(out, "<blockquote><p>{}</p></blockquote>", escape(text)),
                Block::Items(items) => {
                    let items = items.iter().map(|(code, text)| {
                        let code = code
                            .as_deref()
                            .map_or_else(String::new, |code| format!("<code>{}</code>: ", escape(code)));
                        format!("<li>{code}{}</li>\n", escape(text))
                    });
                    writeln!(out, "<ul>\n{}</ul>", items.collect::<String>())
                }
                Block::Table(table) => {
                    out.push_str(&table.to_html(below));
                    Ok(())
                }
            };
        }
        out
    }
}

impl Table {
    fn to_markdown(&self) -> String {
        let mut out = format!(
            "| {} |\n|{}\n",
            self.head.iter().map(|head| cell(head, false)).collect::<Vec<_>>().join(" | "),
            "---|".repeat(self.head.len())
        );
        for row in &self.rows {
            let cells = row.iter().enumerate().map(|(column, text)| cell(text, self.codes.contains(&column)));
            let _ = writeln!(out, "| {} |", cells.collect::<Vec<_>>().join(" | "));
        }
        out.push('\n');
        out
    }

    /// Below a heading, which is its caption.
    fn to_html(&self, below: &str) -> String {
        let head: String =
            self.head.iter().map(|head| format!("<th scope=\"col\">{}</th>", escape(head))).collect();
        let row = |row: &Vec<String>| {
            let cells = row.iter().enumerate().map(|(column, text)| match column {
                0 if self.codes.contains(&0) => {
                    format!("<th scope=\"row\"><code>{}</code></th>", escape(text))
                }
                0 => format!("<th scope=\"row\">{}</th>", escape(text)),
                _ if self.codes.contains(&column) => format!("<td><code>{}</code></td>", escape(text)),
                _ => format!("<td>{}</td>", escape(text)),
            });
            format!("<tr>{}</tr>\n", cells.collect::<String>())
        };
        let rows: String = self.rows.iter().map(row).collect();
        let caption = escape(below);
        let table = format!(
            "<table>\n<caption>{caption}</caption>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\n"
        );
        wide(&caption, &table)
    }
}

/// A cell of Markdown, which a stroke would end.
fn cell(text: &str, is_code: bool) -> String {
    let text = if is_code { verbatim(text) } else { escaped(text) };
    text.replace('|', "\\|")
}

/// Text that a reader of Markdown shows as it is.
fn escaped(text: &str) -> String {
    let line = one_line(text);
    let chars: Vec<char> = line.chars().collect();
    let mut out = String::with_capacity(line.len() + 8);
    // Of a number that begins a list the stroke or dot behind its digits.
    let digits = chars.iter().take_while(|char| char.is_ascii_digit()).count();
    for (i, char) in chars.iter().copied().enumerate() {
        let before = i.checked_sub(1).and_then(|i| chars.get(i));
        let after = chars.get(i + 1);
        let in_word = [before, after].iter().all(|one| one.is_some_and(|char| char.is_alphanumeric()));
        // An address that is made a link takes a stroke before a bracket with it.
        let entity = match char {
            '<' => Some("&lt;"),
            '&' if after.is_some_and(|char| char.is_alphanumeric() || *char == '#') => Some("&amp;"),
            _ => None,
        };
        if let Some(entity) = entity {
            out.push_str(entity);
            continue;
        }
        let special = match char {
            '\\' | '`' | '*' | '[' | ']' | '~' | '$' => true,
            '_' => !in_word,
            '#' | '>' | '+' | '-' | '=' => i == 0,
            '.' | ')' => digits > 0 && i == digits && after.is_none_or(|char| *char == ' '),
            _ => false,
        };
        if special {
            out.push('\\');
        }
        out.push(char);
    }
    out
}

/// Text as code.
fn verbatim(text: &str) -> String {
    let line = one_line(text);
    let longest = line.split(|char| char != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest + 1);
    let space = if longest > 0 { " " } else { "" };
    format!("{fence}{space}{line}{space}{fence}")
}

/// Without line breaks, without spaces at the ends, and without what is hidden.
fn one_line(text: &str) -> String {
    let words =
        text.split(|char: char| char.is_whitespace() || char.is_control()).filter(|word| !word.is_empty());
    visible(&words.collect::<Vec<_>>().join(" ")).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_a_meaning_is_shown_as_it_is() {
        for (text, shown) in [
            ("<!-- what the law says", "&lt;!-- what the law says"),
            ("1, **all cameras meet**", "1, \\*\\*all cameras meet\\*\\*"),
            ("# no heading", "\\# no heading"),
            ("- no item\n\n# no heading", "\\- no item # no heading"),
            ("1. no list, 1. here", "1\\. no list, 1. here"),
            ("0.5", "0.5"),
            ("a_b _c_ A_p/F^2 >= 1", "a_b \\_c\\_ A_p/F^2 >= 1"),
            ("&lt;b> & c", "&amp;lt;b> & c"),
            ("[x](http://y) `code` $a$ ~~b~~ \\", "\\[x\\](http://y) \\`code\\` \\$a\\$ \\~\\~b\\~\\~ \\\\"),
            ("===", "\\==="),
            ("> quote", "\\> quote"),
        ] {
            assert_eq!(escaped(text), shown);
        }
        let mut page = Document::default();
        page.table(&["a", "b"], &[1], [["x | y", "`k`|"]]);
        assert_eq!(page.to_markdown(), "| a | b |\n|---|---|\n| x \\| y | `` `k`\\| `` |\n\n");
    }

    /// Read by another program: a paragraph, an item or a cell of anything is that text and nothing else.
    #[test]
    fn whatever_somebody_writes_is_text() {
        use pulldown_cmark::{Event, Options, Parser, Tag};
        const PIECES: [&str; 26] = [
            "*", "_", "`", "~", "#", ">", "<", "[", "]", "(", ")", "!", "|", "\\", "&amp;", "&", "-", "+",
            "1.", "=", "<!--", "-->", "<b>", " ", "a", "$",
        ];
        let mut state = 1u64;
        let mut random = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below
        };
        for _ in 0..4000 {
            let count = 1 + random(8);
            let text: String = (0..count).map(|_| PIECES[random(PIECES.len())]).collect();
            let line = one_line(&text);
            if line.is_empty() {
                continue;
            }
            let mut page = Document::default();
            page.paragraph(&text);
            page.items([(None, text.clone())]);
            page.table(&["head"], &[], [[text.clone()]]);
            page.table(&["head"], &[0], [[text.clone()]]);
            // Some readers make links of addresses, and take a stroke behind them along.
            assert!(!escaped(&text).contains('<'), "{text}");
            let (mut said, mut code) = (Vec::new(), String::new());
            let markdown = page.to_markdown();
            for event in Parser::new_ext(&markdown, Options::all() - Options::ENABLE_SMART_PUNCTUATION) {
                match event {
                    Event::Text(text) => said.push(text.into_string()),
                    Event::Code(text) => code.push_str(&text),
                    Event::Start(
                        Tag::Paragraph
                        | Tag::List(None)
                        | Tag::Item
                        | Tag::Table(_)
                        | Tag::TableHead
                        | Tag::TableRow
                        | Tag::TableCell,
                    )
                    | Event::End(_) => {}
                    other => panic!("{text:?}: {other:?}\n{markdown}"),
                }
            }
            assert_eq!(said.concat(), format!("{line}{line}head{line}head"), "{markdown}");
            assert_eq!(code, line, "{markdown}");
        }
    }
}
