"""The page `A notebook in Python`: its blocks of Python run in their order, and it is python/examples/notebook.ipynb.

What a block prints is in the block of text after it, where it prints anything; the notebook has the prose and the blocks as cells, and no
outputs. Needs the package, pandas and matplotlib.

    python3 docs/notebook.py             compare; exit code 1 if anything differs
    python3 docs/notebook.py --update    write what is printed into the page, its picture, and the notebook
"""

import contextlib
import io
import json
import os
import re
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).resolve().parent
PAGE = DOCS / "src/tutorials/notebook.md"
NOTEBOOK = DOCS.parent / "python/examples/notebook.ipynb"
PICTURE = "notebook.png"
BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```\n)?", re.M | re.S)


def blocks(text):
    return [(found[1], found[2] or "") for found in BLOCK.finditer(text)]


def printed(text, folder):
    """What each block prints, all in one namespace and in a folder of their own."""
    os.environ.setdefault("MPLBACKEND", "Agg")
    names, outputs = {"__name__": "__main__"}, []
    with contextlib.chdir(folder):
        for found in BLOCK.finditer(text):
            out = io.StringIO()
            # Lines before it, so that a traceback names that of the page.
            code = "\n" * text.count("\n", 0, found.start(1)) + found[1]
            with contextlib.redirect_stdout(out):
                exec(compile(code, str(PAGE), "exec"), names)
            outputs.append(out.getvalue())
    return outputs


def page(text, outputs):
    """The page with what was printed."""
    each = iter(outputs)

    def block(found):
        out = next(each)
        return f"```python\n{found[1]}```\n" + (f"\n```text\n{out}```\n" if out else "")

    return BLOCK.sub(block, text)


def notebook(text):
    """The page as a notebook: links from its folder, no picture, no outputs."""
    text = re.sub(r"\]\((?!\w+:|#)", "](../../docs/src/tutorials/", re.sub(r"^!\[.*\n\n", "", text, flags=re.M))
    parts = re.split(r"^(```python\n.*?^```\n(?:\n```text\n.*?^```\n)?)", text, flags=re.M | re.S)
    cells = []
    for part in parts:
        code = BLOCK.fullmatch(part)
        source = (code[1] if code else part).strip("\n")
        if source:
            cell = {"cell_type": "code" if code else "markdown", "id": f"cell-{len(cells)}", "metadata": {}, "source": source.splitlines(keepends=True)}
            cells.append(cell | ({"execution_count": None, "outputs": []} if code else {}))
    about = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}, "language_info": {"name": "python"}}
    return json.dumps({"cells": cells, "metadata": about, "nbformat": 4, "nbformat_minor": 5}, ensure_ascii=False, indent=1) + "\n"


def main():
    text = PAGE.read_text()
    with tempfile.TemporaryDirectory() as folder:
        new = page(text, printed(text, folder))
        if "--update" in sys.argv:
            PAGE.write_text(new)
            NOTEBOOK.write_text(notebook(new))
            PAGE.with_name(PICTURE).write_bytes(Path(folder, PICTURE).read_bytes())
    same = new == text and NOTEBOOK.exists() and NOTEBOOK.read_text() == notebook(text)
    print(f"{len(blocks(text))} blocks, {'as they are written' if same else 'others than are written'}")
    sys.exit(not same and "--update" not in sys.argv)


if __name__ == "__main__":
    main()
