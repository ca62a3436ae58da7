"""Runs every command of the guide and compares what it prints with what the guide says it does.

A block ```` ```console ```` has commands after `$ ` and what they print. `...` alone on a line stands for any lines, `[...]`
for the rest of one (seconds, commits). A block ```` ```toml file=NAME ```` writes that file. The blocks of a page run one after
the other in an empty folder of its own, `hadar` on the path; stdout and stderr are one. `<!-- picture: FILE -->` before a picture: it is
that file of this folder. Figures in the prose of a tutorial must be in what its commands print: figures.py.

    python3 docs/commands.py HADAR             compare; exit code 1 if anything differs
    python3 docs/commands.py HADAR --update    write what is printed into the pages, dots kept
"""

import difflib
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import figures

SRC = Path(__file__).resolve().parent / "src"
BLOCK = re.compile(r"^```(?:(console)|\w+ file=(\S+))\n(.*?)^```$", re.M | re.S)
PICTURE = re.compile(r"^<!-- picture: (\S+) -->\n!\[[^\]]*\]\(([^)]+)\)", re.M)
DOTS = "..."
SECONDS = 300
# Pages whose figures in the prose are held against what is printed, or against a table of the reports.
TUTORIALS = ["index.md", "tutorials/*.md"]
OF_REPORTS = {"ledger.md": SRC.parents[1] / "reports/ledger.csv"}


def matches(expected, printed):
    pattern = ""
    for line in expected.splitlines():
        pattern += r"(?:.*\n)*?" if line == DOTS else ".*".join(map(re.escape, line.split("[...]"))) + "\n"
    return re.fullmatch(pattern, printed) is not None


def likeness(said, line):
    if said == DOTS:
        return 0.0
    if matches(said + "\n", line + "\n"):
        return 1.0
    ratio = difflib.SequenceMatcher(None, said, line, autojunk=False).ratio()
    return ratio if ratio > 0.5 else 0.0


def updated(expected, printed):
    """What was printed, shortened where `expected` is: lines are paired in their order, as like each other as may be."""
    old, new = expected.splitlines(), printed.splitlines()
    alike = [[likeness(said, line) for line in new] for said in old]
    best = [[0.0] * (len(new) + 1) for _ in range(len(old) + 1)]
    for i, row in enumerate(alike):
        for j, value in enumerate(row):
            best[i + 1][j + 1] = max(best[i][j + 1], best[i + 1][j], best[i][j] + value)
    pairs, i, j = [(len(old), len(new))], len(old), len(new)
    while i and j:
        if best[i][j] == best[i - 1][j]:
            i -= 1
        elif best[i][j] == best[i][j - 1]:
            j -= 1
        else:
            i, j = i - 1, j - 1
            pairs.append((i, j))
    kept, i, j = [], 0, 0
    for said, line in reversed(pairs):
        # Between two pairs: dots where there were some, else every line.
        kept += [DOTS] if DOTS in old[i:said] else new[j:line]
        if line < len(new):
            kept.append(old[said] if alike[said][line] == 1.0 else new[line])
        i, j = said + 1, line + 1
    return "".join(line + "\n" for line in kept)


def commands(block):
    """Pairs of a command as it is written, over several lines where one ends in a backslash, and what it is said to print."""
    pairs = []
    for line in block.splitlines(keepends=True):
        if line.startswith("$ "):
            pairs.append([line, ""])
        elif pairs and pairs[-1][0].endswith("\\\n") and line.startswith("> "):
            pairs[-1][0] += line
        elif pairs:
            pairs[-1][1] += line
        else:
            raise ValueError(f"a block begins without a command: {line}")
    return pairs


def run_page(path, program, update):
    """Runs a page; returns how many commands ran, and what differs."""
    text, done, differs, everything = path.read_text(), [], [], []
    with tempfile.TemporaryDirectory() as scratch:
        tools, folder = Path(scratch, "bin"), Path(scratch, "page")
        tools.mkdir()
        folder.mkdir()
        (tools / "hadar").symlink_to(program)
        environment = os.environ | {"PATH": f"{tools}:{os.environ['PATH']}", "LC_ALL": "C.UTF-8"}
        streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
        alone = {"cwd": folder, "env": environment, "text": True} | streams

        def run(found):
            console, name, content = found.groups()
            if not console:
                Path(folder, name).write_text(content)
                return found[0]
            for written, expected in commands(content):
                command = re.sub("^[$>] ", "", written, flags=re.M)
                ran = subprocess.run(["bash", "-c", command], timeout=SECONDS, **alone)
                printed = ran.stdout if not ran.stdout or ran.stdout.endswith("\n") else ran.stdout + "\n"
                done.append(command)
                everything.append(printed)
                if not matches(expected, printed):
                    difference = difflib.unified_diff(expected.splitlines(), printed.splitlines(), "guide", "program", lineterm="")
                    differs.append(f"{path.name}: {written}" + "\n".join(difference))
                    content = content.replace(written + expected, written + updated(expected, printed), 1)
            return f"```console\n{content}```"

        new = BLOCK.sub(run, text)
        for made, shown in PICTURE.findall(text):
            drawn, kept = Path(folder, made).read_bytes(), Path(path.parent, shown)
            if not kept.exists() or kept.read_bytes() != drawn:
                differs.append(f"{path.name}: the picture {shown} is another than {made}")
                if update:
                    kept.write_bytes(drawn)
    if update and new != text:
        path.write_text(new)
    if path.name in OF_REPORTS:
        everything.append(OF_REPORTS[path.name].read_text())
    if path.name in OF_REPORTS or any(path.relative_to(SRC).match(pattern) for pattern in TUTORIALS):
        unfounded = figures.unfounded(new if update else text, "".join(everything))
        differs += [f"{path.name}:{sentence}" for sentence in unfounded]
    return len(done), differs


def main():
    program, update = Path(sys.argv[1]).resolve(), "--update" in sys.argv[2:]
    only = [word for word in sys.argv[2:] if not word.startswith("-")]
    pages = [path for path in sorted(SRC.rglob("*.md")) if not only or path.stem in only]
    with ThreadPoolExecutor(2) as workers:
        results = list(workers.map(lambda path: run_page(path, program, update), pages))
    differs = [text for _, texts in results for text in texts]
    print("\n\n".join(differs) + "\n" * bool(differs) + f"{sum(n for n, _ in results)} commands of {len(pages)} pages, {len(differs)} differ")
    sys.exit(1 if differs and not update else 0)


if __name__ == "__main__":
    main()
