"""The guide's notebook: what its blocks print is what the page says, and the notebook has the same cells."""

import importlib.util
import json
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SPEC = importlib.util.spec_from_file_location("notebook_of_the_guide", ROOT / "docs/notebook.py")
guide = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(guide)
TEXT = guide.PAGE.read_text()


def test_blocks_print_what_the_page_says(tmp_path):
    pytest.importorskip("matplotlib")
    pytest.importorskip("pandas")
    assert guide.printed(TEXT, tmp_path) == [said for _, said in guide.blocks(TEXT)]
    assert (tmp_path / guide.PICTURE).stat().st_size > 10_000


def test_the_notebook_has_the_cells_of_the_page():
    cells = json.loads(guide.NOTEBOOK.read_text())["cells"]
    code = ["".join(cell["source"]) + "\n" for cell in cells if cell["cell_type"] == "code"]
    assert code == [block for block, _ in guide.blocks(TEXT)] and len(code) > 10
    assert not any(cell.get("outputs") for cell in cells)
    assert guide.NOTEBOOK.read_text() == guide.notebook(TEXT)
