"""Every public object survives pickle, copy and other processes, with the same figures."""

import copy
import multiprocessing
import pickle

import numpy as np
import pytest

import hadar_limits as hadar

NU = np.arange(800.0, 1201.0, 20.0)
SKIN, METAL = np.linspace(0.95, 0.98, NU.size), np.linspace(0.5, 0.4, NU.size)
SCENES = {
    "centres": hadar.Scene(NU, 310.15, [0.5], [293.15]),
    "ranges": hadar.Scene(np.stack([NU, NU + 15.0], 1), 310.15, [0.5, 0.1], [293.15, 250.0]),
    "sky": hadar.Scene(NU, 310.15),
    "all": hadar.Scene(
        NU,
        310.15,
        [0.5, 0.2],
        [293.15, 280.0],
        environment_emissivity=np.stack([SKIN, METAL]),
        unknown=["temperature", "lighting", "gain", "environment-temperature"],
        priors={"gain": 0.01, "environment-temperature": 2.0},
        temperature_range=(250.0, 350.0),
        lighting_range=(0.05, 0.9),
        counts_per_radiance=1e-15,
        var_added=np.linspace(100.0, 200.0, NU.size),
    ),
    "total": hadar.Scene(NU, 310.15, [0.5], [293.15], lighting_total=0.5, unknown=["temperature"]),
}
SCENARIO = {
    "target": {"material": "skin", "temperature": "37 degC"},
    "environment": [{"temperature": "20 degC", "lighting": 0.5}],
    "alternatives": {"materials": ["aluminium", "concrete"]},
    "bands": {"start": "800 cm^-1", "stop": "1200 cm^-1", "step": "20 cm^-1"},
}


def around(thing):
    return pickle.loads(pickle.dumps(thing)), pickle.loads(pickle.dumps(thing, 2)), copy.copy(thing), copy.deepcopy(thing)


def figures(found):
    names = [name for name in dir(found) if not name.startswith("_")]
    return {name: np.asarray(getattr(found, name)).tolist() for name in names}


def distances(scene):
    skin, metal = np.interp(scene.nodes, NU, SKIN), np.interp(scene.nodes, NU, METAL)
    return figures(hadar.nearest(skin, metal, scene)), figures(hadar.local(skin, metal, scene)), scene.signal(skin).tolist()


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_gives_the_same_bits(name):
    expected = distances(SCENES[name])
    for again in around(SCENES[name]):
        assert repr(again) == repr(SCENES[name]) and distances(again) == expected


def test_a_scene_does_not_change_with_what_it_was_made_of():
    bands, lighting = NU.copy(), np.array([0.5])
    scene = hadar.Scene(bands, 310.15, lighting, [293.15])
    expected = distances(scene)
    bands += 50.0
    lighting[:] = 0.1
    assert distances(pickle.loads(pickle.dumps(scene))) == expected


def test_what_is_found_keeps_its_figures():
    for found in (hadar.local(SKIN, METAL, SCENES["all"]), hadar.nearest(SKIN, METAL, SCENES["all"])):
        for again in around(found):
            assert type(again) is type(found) and repr(again) == repr(found) and figures(again) == figures(found)


def test_maps_and_windows_and_errors():
    cube = np.random.default_rng(1).poisson(1000.0, (7, 8, NU.size)).astype(float)
    maps = hadar.decompose(cube, [SKIN, METAL], (), NU, counts_per_radiance=1e-15)
    for found in (maps, hadar.window_information(cube, cells=["full", "total"])):
        for again in around(found):
            assert type(again) is type(found)
            for name, values in found.to_dict().items():
                np.testing.assert_array_equal(getattr(again, name), values)
    with pytest.raises(hadar.HadarError) as error:
        hadar.planck(-1.0, 300.0)
    again = pickle.loads(pickle.dumps(error.value))
    assert type(again) is hadar.HadarError and str(again) == str(error.value)


def test_answers_keep_their_json_text_and_pictures():
    answer = hadar.identify(SCENARIO, matrix=True)
    for again in around(answer):
        assert type(again) is hadar.Identification and again.to_json() == answer.to_json()
        assert again.text == answer.text and again.pictures() == answer.pictures()
    record = answer.pairs[0]
    for again in around(record):
        assert type(again) is hadar.Record and again == record
    ranged = {name: pickle.loads(pickle.dumps(getattr(hadar, name))) for name in hadar.__all__ if not name.startswith("__")}
    assert ranged["identify"] is hadar.identify and ranged["Scene"] is hadar.Scene


def distance_at(scene, metal):
    return hadar.nearest(SKIN, metal, scene)


METALS = [METAL, METAL + 0.1, METAL - 0.1]


@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_processes_of_multiprocessing(method):
    if method not in multiprocessing.get_all_start_methods():
        pytest.skip(f"there is no {method} here")
    expected = [figures(distance_at(SCENES["all"], metal)) for metal in METALS]
    with multiprocessing.get_context(method).Pool(2) as pool:
        found = pool.starmap(distance_at, [(SCENES["all"], metal) for metal in METALS])
        answers = pool.starmap(hadar.identify, [(SCENARIO,), (SCENARIO,)])
    assert [figures(each) for each in found] == expected
    assert {answer.to_json() for answer in answers} == {hadar.identify(SCENARIO).to_json()}


def test_processes_of_joblib():
    joblib = pytest.importorskip("joblib")
    expected = [figures(distance_at(SCENES["all"], metal)) for metal in METALS]
    found = joblib.Parallel(n_jobs=2)(joblib.delayed(hadar.nearest)(SKIN, metal, SCENES["all"]) for metal in METALS)
    assert [figures(each) for each in found] == expected
