"""Recipes of the guide, and descriptions of packages."""

import importlib.util
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import hadar_limits as hadar

ROOT = Path(__file__).resolve().parents[2]
RECIPES = dict(re.findall(r"^```python file=with_(\w+)\.py\n(.*?)^```$", (ROOT / "docs/src/reference/clusters.md").read_text(), re.M | re.S))


@pytest.mark.parametrize("name", ["joblib", "dask", "ray"])
def test_a_recipe_gives_what_one_process_gives(name, tmp_path):
    needs = {"dask": ["distributed", "xarray"]}.get(name, [name])
    if missing := [need for need in needs if importlib.util.find_spec(need) is None]:
        print(f"skipped: there is no {missing[0]}")
        pytest.skip(f"there is no {missing[0]}")
    script = tmp_path / "recipe.py"
    script.write_text(RECIPES[name])
    found = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=True)
    scenario = {"environment": [{"temperature": "20 degC", "lighting": 0.5}], "alternatives": {"materials": ["aluminium"]}}
    asked = [scenario | {"target": {"material": "skin", "temperature": f"{kelvin} K"}} for kelvin in (290, 300, 310)]
    expected = [hadar.identify(each).pairs[0].distance_nearest for each in asked]
    # Ray says more on its own.
    assert [float(line) for line in found.stdout.split() if re.fullmatch(r"[\d.e-]+", line)] == expected


def test_descriptions_name_the_version_and_what_is_needed():
    yaml = pytest.importorskip("yaml")
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]
    project = tomllib.loads((ROOT / "python/pyproject.toml").read_text())
    recipe = (ROOT / "python/conda/meta.yaml").read_text()
    assert f'version = "{workspace["version"]}"' in recipe
    # As conda-build sees it, each expression a word.
    read = yaml.safe_load(re.sub(r"\{\{.*?\}\}", "word", re.sub(r"\{%.*?%\}", "", recipe)))
    bare = [need.replace(" ", "") for need in read["requirements"]["run"] + read["requirements"]["host"]]
    assert read["package"]["name"] == project["project"]["name"]
    assert f"python{project['project']['requires-python']}" in bare
    assert set(project["project"]["dependencies"] + project["build-system"]["requires"]) <= set(bare)
    wheels = yaml.safe_load((ROOT / ".github/workflows/wheels.yml").read_text())["jobs"]
    systems = {(each["os"].split("-")[0], each["target"]) for each in wheels["wheel"]["strategy"]["matrix"]["include"]}
    assert systems >= {("ubuntu", "x86_64"), ("ubuntu", "aarch64"), ("macos", "aarch64"), ("windows", "x64")}
    assert any(step.get("with", {}).get("rust-toolchain") == workspace["rust-version"] for step in wheels["wheel"]["steps"])
