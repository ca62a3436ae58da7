"""The distribution has a name of its own, which is the one that every hint and document names."""

import importlib
import importlib.metadata
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NAME = "hadar-limits"


def run(code, **options):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, **options)


def test_the_distribution_and_its_extras():
    found = importlib.metadata.metadata(NAME)
    assert set(found.get_all("Provides-Extra")) == {"pandas", "dask", "test"}
    assert importlib.metadata.packages_distributions()["hadar_limits"] == [NAME]
    # The older name is a module beside the package, which no other package's folder of that name overwrites.
    files = [str(file) for file in importlib.metadata.files(NAME)]
    assert "hadar.py" in files and not any(file.startswith("hadar/") for file in files)
    assert importlib.import_module("hadar") is importlib.import_module("hadar_limits")


def test_every_hint_names_it():
    files = [path for end in ("md", "py", "rs", "toml", "yml", "yaml") for path in ROOT.rglob(f"*.{end}")]
    files = [path for path in files if not {"target", ".git", "node_modules"} & set(path.relative_to(ROOT).parts)]
    hints = [(path, hint) for path in files for hint in re.findall(r"pip install[^`'\n]*", path.read_text(encoding="utf-8"))]
    assert len(hints) > 5
    # PyPI's `hadar` is another's.
    assert [hint for hint in hints if re.search(r"(^|[\s\"])hadar($|[\s\"\[=<>])", hint[1])] == []


def test_the_other_package_of_that_name_is_no_hindrance(tmp_path):
    (tmp_path / "hadar").mkdir()
    (tmp_path / "hadar/__init__.py").write_text("class Study: pass\n")
    code = "import hadar_limits, hadar; hadar.Study(); print(hadar_limits.planck(1000.0, 300.0) > 0)"
    found = run(code, cwd=tmp_path)
    assert found.stdout == "True\n", found.stderr


@pytest.mark.parametrize(("missing", "extra"), [("dask", "dask"), ("xarray", "dask"), ("pandas", "pandas")])
def test_what_is_missing_is_named_with_its_extra(missing, extra):
    use = "import hadar_limits.dask" if extra == "dask" else "hadar_limits.Record({'pairs': []}); R = hadar_limits._results.Result; R.to_pandas(R.__new__(R))"
    found = run(f"import sys; sys.modules[{missing!r}] = None; import hadar_limits; {use}")
    last = found.stderr.strip().split("\n")[-1]
    assert last.startswith("ImportError") and f'pip install "{NAME}[{extra}]"' in last, found.stderr
