"""Scenarios: the same bytes as the command prints, from files, text and dicts."""

import datetime
import os
import pickle
import shutil
import signal
import subprocess
import threading
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import hadar_limits as hadar

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/human_vs_robot.toml"
SMALL = {
    "target": {"material": "skin", "temperature": "37 degC"},
    "environment": [{"temperature": "20 degC", "lighting": 0.5}],
    "alternatives": {"materials": ["aluminium", "concrete"]},
    "bands": {"start": "800 cm^-1", "stop": "1200 cm^-1", "step": "20 cm^-1"},
    "camera": {"preset": "flir-a325sc"},
}


def command():
    named = os.environ.get("HADAR")
    found = [Path(named)] if named else [ROOT / "target/release/hadar", ROOT / "target/debug/hadar"]
    found = next((path for path in found if path.is_file()), None) or shutil.which("hadar")
    if not found:
        pytest.skip("there is no command `hadar`: cargo build --release")
    return str(found)


SAME = [
    ("size", "examples/human_vs_robot.toml", {}, []),
    ("size", "examples/human_vs_robot.toml", dict(by="local"), ["--by", "local"]),
    ("identify", "examples/five_materials.toml", dict(matrix=True, seed=3), ["--matrix", "--seed", "3"]),
    ("identify", "examples/human_vs_robot.toml", dict(bands=3, filters=2), ["--bands", "3", "--filters", "2"]),
    ("rule", "examples/rule_delivery_robots_at_night.toml", {}, []),
    ("range", "examples/air_ranging.toml", {}, []),
    ("simulate", "examples/human_vs_robot.toml", dict(skip_spectra=True, spectra=400), ["--skip-spectra", "--spectra", "400"]),
    (
        "simulate",
        "examples/human_vs_robot.toml",
        dict(thermometry="30 degC..40 degC", temperatures=2, spectra=40),
        ["--thermometry", "30 degC..40 degC", "--temperatures", "2", "--spectra", "40"],
    ),
]


@pytest.mark.parametrize(("name", "scenario", "options", "flags"), SAME)
def test_the_bytes_are_those_of_the_command(name, scenario, options, flags, monkeypatch):
    monkeypatch.chdir(ROOT)
    expected = subprocess.run([command(), name, scenario, "--json", "--quiet", *flags], capture_output=True, check=True)
    found = getattr(hadar, "range_" if name == "range" else name)(scenario, **options)
    assert found.to_json() + "\n" == expected.stdout.decode()


MISTAKES = [
    ("size", EXAMPLE.read_text().replace('temperature = "37 degC"', 'temperature = "37"', 1)),
    ("size", EXAMPLE.read_text().replace('material = "skin"', 'material = "skn"', 1)),
    ("range", EXAMPLE.read_text()),
    ("rule", EXAMPLE.read_text()),
]


@pytest.mark.parametrize(("name", "text"), MISTAKES)
def test_messages_are_those_of_the_command(name, text, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    expected = subprocess.run([command(), name, path], capture_output=True, text=True)
    with pytest.raises(hadar.HadarError) as error:
        getattr(hadar, "range_" if name == "range" else name)(path)
    assert expected.returncode == 1
    assert expected.stderr.strip() == f"error: {error.value}"


def test_a_file_its_text_and_a_dict_ask_the_same(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT / "examples")
    text = EXAMPLE.read_text()
    by_path = hadar.identify(EXAMPLE)
    for other in (text, tomllib.loads(text), str(EXAMPLE)):
        assert hadar.identify(other).to_json() == by_path.to_json()
    odd = dict(SMALL, environment=({"temperature": "20 degC", "lighting": np.float64(0.5)},))
    assert hadar.identify(odd).to_json() == hadar.identify(SMALL).to_json()


def test_mistakes_in_a_dict_name_its_key_and_no_line():
    for change, message in [
        ({"target": {"material": "skin"}}, "target.temperature: the key is missing"),
        ({"target": {"material": "skin", "temperature": 37}}, "target.temperature: `37` is a number without a unit"),
        ({"target": {"material": None}}, "target.material: None; leave the key out"),
        ({"target": {"material": {1, 2}}}, "target.material: a value of type set"),
        ({"targt": {}}, "targt"),
        ({1: 2}, "a key 1 that is no text"),
    ]:
        with pytest.raises(hadar.HadarError) as error:
            hadar.size(SMALL | change)
        assert message in str(error.value) and "line " not in str(error.value), str(error.value)
    with pytest.raises(TypeError, match="a path, TOML text or a dict"):
        hadar.size(3)
    with pytest.raises(hadar.HadarError, match="no such file"):
        hadar.size("nowhere.toml")


def test_a_dict_without_end_is_refused():
    itself, deep = dict(SMALL), 1
    itself["x"] = itself
    for _ in range(100_000):
        deep = [deep]
    for wrong in (itself, dict(SMALL, target=deep), dict(SMALL, target=(deep,))):
        with pytest.raises(hadar.HadarError, match="more than 32 deep; write no dict or list that contains itself"):
            hadar.size(wrong)


def test_mistakes_in_keywords_name_them():
    for ask, wrong, message in [
        (hadar.size, dict(seed=-1), "seed: -1; give a whole number from 0 to"),
        (hadar.size, dict(seed=1.5), "seed: 1.5; give a whole number"),
        (hadar.size, dict(threads=-1), "threads: -1; give a whole number"),
        (hadar.size, dict(threads="2"), "threads: '2'; give a whole number"),
        (hadar.size, dict(time_limit=3), "time_limit: 3; give text"),
        (hadar.identify, dict(bands=-3), "bands: -3; give a whole number"),
        (hadar.identify, dict(prove="no"), "prove: 'no'; give a number, or None"),
        (hadar.range_, dict(trials=-1), "trials: -1; give a whole number"),
        (hadar.simulate, dict(spectra=-1), "spectra: -1; give a whole number"),
    ]:
        with pytest.raises(hadar.HadarError) as error:
            ask(SMALL, **wrong)
        assert message in str(error.value)


def test_an_answer_is_its_json_with_names(tmp_path):
    answer = hadar.size(SMALL)
    data = answer.to_dict()
    assert answer["verdict"] == answer.verdict and answer.verdict.met == data["verdict"]["met"]
    assert answer.verdict.sentence == answer.sentence
    assert [pair.alternative for pair in answer.pairs] == ["aluminium", "concrete"]
    assert answer.hadar == hadar.__version__ and answer.schema == 2
    table = answer.to_pandas()
    assert list(table["distance_nearest"]) == [pair["distance_nearest"] for pair in data["pairs"]]
    with pytest.raises(AttributeError, match="there is no `verdikt`"):
        answer.verdikt
    with pytest.raises(AttributeError, match="stays"):
        answer.verdict.met = True
    again = pickle.loads(pickle.dumps(answer))
    assert type(again) is hadar.Sizing and again.to_json() == answer.to_json()
    page = answer._repr_html_()
    assert answer.sentence in page and page.count("<svg") == len(answer.pictures()) > 2
    assert "scenario" in dir(answer)


def test_threads_and_skipping_change_nothing():
    answers = [hadar.identify(SMALL, threads=threads, matrix=True).to_json() for threads in (1, 2, None)]
    assert len(set(answers)) == 1
    full = hadar.identify(SMALL, skipping=False, matrix=True)
    assert full.matrix == hadar.identify(SMALL, matrix=True).matrix


def test_one_thread_answers_all_who_ask():
    alone = hadar.size(SMALL, threads=2).to_json()
    with ThreadPoolExecutor(4) as asking:
        assert set(asking.map(lambda _: hadar.size(SMALL, threads=1).to_json(), range(8))) == {alone}


def test_own_spectra_are_read_and_warned_about(tmp_path):
    nu = np.arange(700.0, 1301.0, 10.0)
    (tmp_path / "mine.csv").write_text("wavenumber_cm1,emissivity\n" + "".join(f"{n},0.9\n" for n in nu))
    asked = dict(SMALL, alternatives={"materials": ["mine"]})
    assert hadar.identify(asked, library=tmp_path).limiting == "mine"
    np.testing.assert_allclose(hadar.emissivity(tmp_path / "mine.csv", [800.0]), 0.9)
    with pytest.raises(hadar.HadarError, match="the library is empty"):
        hadar.identify(asked, only_library=True)


def test_a_rule_is_asked_about_a_day(monkeypatch):
    monkeypatch.chdir(ROOT)
    path = "rules/fmvss_127_night.toml"
    with pytest.raises(hadar.HadarError, match="no day"):
        hadar.rule(path, on="tomorrow")
    with pytest.raises(TypeError):
        hadar.rule(path, on=datetime.timedelta(1))


HEAVY = {
    "target": {"material": "skin", "temperature": "37 degC"},
    "environment": [
        {"temperature": f"{5 + 7 * k} degC", "lighting": 0.1125, "material": material}
        for k, material in enumerate(
            ["concrete", "asphalt", "grass-dry", "brick-red", "pmma", "steel-rough", "soda-lime-glass", "aluminium"]
        )
    ],
    "alternatives": {"materials": ["pmma", "aluminium"]},
    "bands": {"start": "715 cm^-1", "stop": "1250 cm^-1", "step": "0.1 cm^-1"},
    "unknown": {"nuisances": ["temperature", "lighting", "gain", "environment-temperature"]},
}


def test_a_limit_of_time_ends_a_question_and_the_next_is_answered():
    with pytest.raises(hadar.HadarError, match="stopped after 1 s, the limit of time"):
        hadar.size(HEAVY, time_limit="1 s")
    assert hadar.size(SMALL).pairs
    with pytest.raises(hadar.HadarError, match="time_limit: .*write it as 90 s|time_limit: .*unit"):
        hadar.size(SMALL, time_limit="5")


def test_an_interrupt_ends_a_question_as_python_is_used_to():
    timer = threading.Timer(1, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        hadar.size(HEAVY)
    timer.join()
    assert hadar.size(SMALL).pairs
