"""What type checkers say of a user's file and of mistakes."""

import ast
import importlib.util
import inspect
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

import hadar_limits as hadar
from hadar_limits import _hadar, _questions

TYPED = Path(__file__).parent / "typed"
STUB = Path(hadar.__file__).with_name("_hadar.pyi")


def ran(name, *arguments):
    if importlib.util.find_spec(name) is None:
        print(f"skipped: there is no {name}")
        pytest.skip(f"there is no {name}")
    # From another folder: the installed package, not the sources beside.
    found = subprocess.run([sys.executable, "-m", name, *arguments], capture_output=True, text=True, cwd=TYPED)
    return found.returncode, found.stdout + found.stderr


def mypy(file, tmp_path):
    return ran("mypy", "--strict", f"--cache-dir={tmp_path}", "--no-error-summary", str(TYPED / file))


def pyright(file, tmp_path):
    # What is strict stands in a file, and paths in it are relative.
    (tmp_path / "pyrightconfig.json").write_text(json.dumps({"include": [file], "typeCheckingMode": "strict"}))
    (tmp_path / file).write_text((TYPED / file).read_text())
    code, text = ran("pyright", "--project", str(tmp_path), "--pythonpath", sys.executable)
    if not re.search(r"^\d+ errors?, ", text, re.M):
        print(f"skipped: pyright does not start: {text}")
        pytest.skip("pyright does not start")
    return code, text


@pytest.mark.parametrize("checker", [mypy, pyright])
def test_a_users_file_is_clean(checker, tmp_path):
    code, text = checker("user.py", tmp_path)
    assert code == 0, text


@pytest.mark.parametrize("checker", [mypy, pyright])
def test_each_mistake_is_found(checker, tmp_path):
    body = ast.parse((TYPED / "mistakes.py").read_text()).body
    lines = {node.lineno for node in body if isinstance(node, (ast.Expr, ast.AnnAssign))} - {1}
    assert len(lines) > 30
    _, text = checker("mistakes.py", tmp_path)
    found = {int(line) for line in re.findall(r"mistakes\.py:(\d+).*error", text)}
    assert found == lines, text


def test_the_users_file_has_every_public_name_and_runs():
    names = {node.attr for node in ast.walk(ast.parse((TYPED / "user.py").read_text())) if isinstance(node, ast.Attribute)}
    text = (TYPED / "user.py").read_text()
    assert [name for name in hadar.__all__ if name not in names and f"import {name}" not in text and f", {name}" not in text] == []
    pytest.importorskip("dask")
    pytest.importorskip("xarray")
    subprocess.run([sys.executable, str(TYPED / "user.py")], check=True, stdout=subprocess.DEVNULL)


def test_options_are_those_that_are_taken():
    def taken(function, *positional):
        return set(inspect.signature(function).parameters) - set(positional)

    assert set(hadar.DecomposeOptions.__annotations__) == taken(_hadar.decompose, "cube", "library", "light", "bands")
    assert set(hadar.WindowOptions.__annotations__) == taken(_hadar.window_information, "cube", "window")
    assert set(hadar.QuestionOptions.__annotations__) == taken(_questions._common)
    for name in ("matrix", "over_states", "nearest", "local", "Scene", "planck"):
        stub = next(node for node in ast.walk(ast.parse(STUB.read_text())) if getattr(node, "name", None) == name)
        stub = next(node for node in ast.walk(stub) if isinstance(node, ast.FunctionDef))
        stated = {each.arg for each in stub.args.args + stub.args.kwonlyargs} - {"cls"}
        assert stated == taken(getattr(_hadar, name)), name
