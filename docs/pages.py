"""Preprocessor of the book: what the pages do not say themselves.

* `$...$` and `$$...$$` become MathML, which browsers show without fonts, scripts or network; `\\tag{S27}` is the number in the paper.
* Pictures of the repository, `../../reports/...`, are put into the page.
* `<!-- made: ledger -->`, `symbols`, `terms`, `equations`, `keys`, `warnings` and `results` are replaced by tables of reports/ledger.csv and of what `hadar explain --all` says,
  `accuracy` by the table of reports/accuracy; `rows`, `compared`, `reproduced`, `chosen`, `missed` and `wrong` by numbers of rows of the ledger.
* A link to a file that is not there fails the build.

mdBook hands over `[context, book]` as JSON and takes the book back. `pages.py check` does the same to all pages without mdBook. Needs Python 3.11 and latex2mathml.
"""

import base64
import csv
import html
import json
import os
import re
import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
REPORTS = ROOT / "reports"

# Code is left as it is: a block between fences, or a word between backticks.
PARTS = re.compile(r"(^```.*?^```[^\S\n]*$|`[^`\n]+`)|\$\$(.+?)\$\$|\$((?:[^$\n]|\n(?!\n))+)\$|(\$)", re.S | re.M)
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```(\w+) file=(\S+)$", re.M)
# What Markdown and HTML would take for their own signs.
SIGNS = re.compile(r"[*_`~|<>&\[\]]")
MADE = re.compile(r"<!-- made: (\w+) -->")

# Worst first: what does not come out again is what a reader looks for.
VERDICTS = [
    ("error in the paper", "Errors in the paper"),
    ("not reproduced", "What does not come out again"),
    ("reproduced under a stated choice", "What comes out again under a choice that the paper does not state"),
    ("reproduced", "What comes out again"),
    ("no value printed", "Where the paper prints no value to compare with"),
    ("not in the paper", "What the paper does not ask"),
]


def mathml(tex, display):
    from latex2mathml.converter import convert

    number = ""
    if tag := re.search(r"\\tag\{([^}]*)\}", tex):
        tex = tex.replace(tag.group(0), "")
        number = f'<span class="number">({html.escape(tag.group(1))})</span>'
    made = convert(tex.strip(), display="block" if display else "inline")
    if "<merror" in made or "\\" in re.sub(r"<[^>]*>", "", made):
        raise ValueError(f"not understood as an equation: {tex}")
    # A prime is a part of its letter: as an exponent it stands too high wherever there is no mathematical font.
    made = re.sub(r"<msup><mi>([^<]*)</mi><mi>&#x02032;</mi></msup>", r"<mi>\1</mi><mtext>&#x02032;</mtext>", made)
    made = re.sub(r"<msubsup><mi>([^<]*)</mi>(<mi>[^<]*</mi>)<mi>&#x02032;</mi></msubsup>", r"<msub><mrow><mi>\1</mi><mtext>&#x02032;</mtext></mrow>\2</msub>", made)
    # What Markdown would take for its own signs.
    made = re.sub(r">([^<]*)<", lambda text: ">" + re.sub(r"[*_\[\]`|~]", lambda c: f"&#{ord(c[0])};", text[1]) + "<", made)
    return f'\n<div class="equation">{made}{number}</div>\n' if display else made


def equations(text):
    def part(found):
        code, display, inline, alone = found.groups()
        if alone:
            raise ValueError(f"a dollar without its other one: {text[found.start() :][:60]}")
        return code if code is not None else mathml(display or inline, display is not None)

    return PARTS.sub(part, text)


def links(text, folder):
    """Pictures put into the page; a link must have its file."""

    def link(found):
        picture, words, target = found.groups()
        if re.match(r"[a-z]+:|#", target):
            return found[0]
        path = (folder / target.split("#")[0]).resolve()
        if not path.exists():
            raise FileNotFoundError(f"{folder}: no file for the link {target}")
        if picture and path.is_relative_to(REPORTS):
            data = base64.b64encode(path.read_bytes()).decode()
            return f'<img alt="{html.escape(words)}" src="data:image/png;base64,{data}">'
        return found[0]

    return LINK.sub(link, text)


def cell(text):
    return html.escape(text, quote=False).replace("|", "&#124;").replace("\n", " ") or "-"


def code(text):
    """Code in a cell, as it is written, with what Markdown would take for its own signs."""
    escaped = SIGNS.sub(lambda sign: f"&#{ord(sign[0])};", text or "")
    return f"<code>{escaped}</code>" if escaped else "-"


def table(head, rows):
    lines = ['<div class="made">\n', "| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows] + ["\n</div>"])


def verdicts():
    with (REPORTS / "ledger.csv").open(newline="") as file:
        return [row["verdict"] for row in csv.DictReader(file)]


def count(*chosen):
    """The number of rows of the ledger with one of these verdicts."""
    return lambda: str(sum(verdict in chosen for verdict in verdicts()))


def ledger():
    """The ledger by verdict, each row with the command that makes it again."""
    folders = {}
    for path in sorted(REPORTS.glob("*/ledger.csv")):
        with path.open(newline="") as file:
            for row in csv.DictReader(file):
                folders[row["place"], row["quantity"]] = path.parent.name
    with (REPORTS / "ledger.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    known = {verdict for verdict, _ in VERDICTS}
    if strange := {row["verdict"] for row in rows} - known:
        raise ValueError(f"reports/ledger.csv: verdicts without a place in the page: {strange}")
    counts = [(title, sum(row["verdict"] == verdict for row in rows)) for verdict, title in VERDICTS]
    parts = [table(["verdict", "rows"], [(title, str(number)) for title, number in counts])]
    for verdict, title in VERDICTS:
        chosen = [
            (
                cell(row["place"]),
                cell(row["quantity"]),
                cell(row["paper"]),
                cell(row["ours"] + (f" (within {row['tolerance']})" if row["tolerance"] and verdict == "reproduced" else "")),
                cell(row["why"]),
                code(folders.get((row["place"], row["quantity"]), "")),
            )
            for row in rows
            if row["verdict"] == verdict
        ]
        parts += [f"### {title}", table(["place", "quantity", "paper", "ours", "why", "made by `hadar reproduce`"], chosen)]
    return "\n\n".join(parts)


def explained():
    program = os.environ.get("HADAR") or str(ROOT / "target/release/hadar")
    return json.loads(subprocess.run([program, "explain", "--all", "--json"], stdout=subprocess.PIPE, text=True, check=True).stdout)


def keys():
    """Keys of files, a table for each table of a file, under its own meaning."""
    said = explained()["keys"]
    meanings = {path: key["meaning"] for key in said if key["inside"] for path in key["paths"]}
    groups = {}
    for key in said:
        if key["inside"]:
            continue
        first, *others = key["paths"]
        place, _, name = first.rpartition(".")
        row = (
            code(name),
            cell(key["meaning"]) + (f" Also {', '.join(map(code, others))}." if others else ""),
            cell(key["value"]),
            "none: it must be stated" if key["required"] else cell(key["default"] or key["silent"] or ""),
            code(key["example"]),
            cell(key["enters"]),
            cell(", ".join(key["commands"])),
        )
        groups.setdefault(place, []).append(row)
    head = ["key", "means", "what may be written", "default", "example", "used in", "read by"]
    parts = []
    for place, rows in groups.items():
        title = f"`[{place}]`" if place else "Above all tables"
        parts += [f"## {title}", meanings.get(place, ""), table(head, rows)]
    return "\n\n".join(parts)


def of_terms(chosen, head, row):
    return table(head, [row(term) for term in explained()["terms"] if chosen(term)])


def more(term):
    return f"[{Path(term['see']).stem}]({term['see']})"


def symbols():
    head = ["symbol", "term", "key of a file or of JSON", "means", "unit", "more"]
    row = lambda term: (mathml(term["symbol"], False), cell(term["name"]), ", ".join(map(code, term["keys"])) or "-", cell(term["meaning"]), cell(term["unit"]), more(term))
    return of_terms(lambda term: term["symbol"], head, row)


def terms():
    head = ["term", "means", "unit", "key", "also called", "more"]
    row = lambda term: (cell(term["name"]), cell(term["meaning"]), cell(term["unit"]), ", ".join(map(code, term["keys"])) or "-", cell(", ".join(term["also"])), more(term))
    return of_terms(lambda term: not term["symbol"] and not term["is_equation"], head, row)


def numbered():
    return of_terms(lambda term: term["is_equation"], ["equation", "states", "more"], lambda term: (term["name"], cell(term["meaning"]), more(term)))


def warnings():
    rows = [(code(one["code"]), cell(one["meaning"]), cell(one["remedy"])) for one in explained()["warnings"]]
    return table(["code", "means", "what to do"], rows)


def results():
    """Keys of the JSON by their first letter; one that several objects have is named once."""
    letters, before = {}, None
    for one in explained()["results"]:
        key = one["key"]
        row = ("" if key == before else code(key), cell(one["of"]), cell(one["meaning"]))
        letters.setdefault(key[:1].upper(), []).append(row)
        before = key
    return "\n\n".join(f"## {letter}\n\n{table(['key', 'part of', 'means'], rows)}" for letter, rows in letters.items())


def accuracy():
    """The first table of the report: a row for each computation, by its default method."""
    text = (REPORTS / "accuracy/README.md").read_text()
    return re.search(r"(^\|.*\n)+", text, re.M)[0]


COMPARED = {"reproduced": "reproduced", "chosen": "reproduced under a stated choice", "missed": "not reproduced", "wrong": "error in the paper"}
COUNTS = {name: count(verdict) for name, verdict in COMPARED.items()} | {"compared": count(*COMPARED.values()), "rows": lambda: str(len(verdicts()))}
TABLES = {"accuracy": accuracy, "ledger": ledger, "symbols": symbols, "terms": terms, "equations": numbered, "keys": keys, "warnings": warnings, "results": results} | COUNTS


def page(text, folder):
    text = equations(links(text, folder))
    text = FENCE.sub(lambda found: f'<p class="file">{html.escape(found[2])}</p>\n\n```{found[1]}', text)
    # Last: what others wrote is no mathematics.
    return MADE.sub(lambda found: TABLES[found[1]](), text)


def walk(items):
    for item in items:
        if chapter := isinstance(item, dict) and item.get("Chapter"):
            if chapter.get("path"):
                chapter["content"] = page(chapter["content"], (DOCS / "src" / chapter["path"]).parent)
            walk(chapter["sub_items"])


def main():
    if sys.argv[1:2] == ["supports"]:
        sys.exit(0)
    if sys.argv[1:2] == ["check"]:
        sources = sorted((DOCS / "src").rglob("*.md"))
        for path in sources:
            page(path.read_text(), path.parent)
        print(f"{len(sources)} pages: equations are understood, links have their files")
        return
    _, book = json.load(sys.stdin)
    walk(book.get("items") or book.get("sections"))
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()
