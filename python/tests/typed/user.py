"""What a user writes: every public name. Type checkers have nothing to say of it (test_types.py), and it runs."""

from collections.abc import Sequence
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hadar_limits as hadar
from hadar_limits import DecomposeOptions, QuestionOptions, WindowOptions

Spectrum = NDArray[np.float64]


def planck() -> None:
    one: float = hadar.planck(1000.0, 300)
    slope: float = hadar.planck_slope(np.float32(1000), 300.0)
    back: float = hadar.brightness_temperature(1000.0, one)
    many: Spectrum = hadar.planck([900.0, 1000.0], 300.0)
    image: Spectrum = hadar.planck_slope(1000.0, np.full((2, 3), 300.0))
    again: Spectrum = hadar.brightness_temperature(np.arange(900, 1001, 100), many)
    assert abs(back - 300) < 1e-9 and slope > 0 and image.shape == (2, 3) and abs(again - 300).max() < 1e-9


def distances() -> None:
    nu = np.arange(800.0, 1200.0, 20.0)
    names: list[str] = hadar.materials()
    scene: hadar.Scene = hadar.Scene(nu, 310.15, [0.5], [293.15], unknown=["temperature", "lighting"], priors={"temperature": 2.0})
    skin, metal = hadar.emissivity("skin", scene.nodes), hadar.emissivity(names[0], nu)
    near: hadar.Nearest = hadar.nearest(skin, metal, scene, prove=None)
    tangent: hadar.Local = hadar.local(skin, metal, scene)
    if near.probability is not None:
        print(near.probability + tangent.distance)
    state: tuple[float, Spectrum, float] = (near.temperature, near.lighting, near.gain)
    all_pairs: Spectrum = hadar.matrix([skin, metal], scene, by="nearest", threads=1, progress=lambda done, of: None)
    states: Spectrum = hadar.over_states(skin, metal, scene, np.array([300.0, 310.0]), np.array([0.1, 0.2]), threads=1)
    print(tangent.status.upper(), near.converged, state, all_pairs.shape, states.shape, scene.signal(skin).sum())


def cubes() -> None:
    nu = np.arange(800.0, 1200.0, 20.0)
    cube: NDArray[np.float32] = np.full((6, 7, nu.size), 1000.0, dtype=np.float32)
    options: DecomposeOptions = {"counts_per_radiance": 1e-15, "threads": 1, "method": "ml"}
    maps: hadar.Maps = hadar.decompose(cube, np.full((1, nu.size), 0.9), (), nu, **options)
    kept: NDArray[np.bool_] = (maps.material != hadar.NO_MATERIAL) & (maps.flags & hadar.FLAGS["no-fit"] == 0)
    windowed: WindowOptions = {"cells": ["full", "total"], "derivative": "central", "var_added": 4.0}
    windows: hadar.Windows = hadar.window_information(cube, (3, 3), **windowed)
    arrays: dict[str, NDArray[Any]] = windows.to_dict()
    print(kept.sum(), maps.temperature_k.mean(), windows.photons.shape, sorted(arrays))


def told(done: int, of: int) -> None:
    print(done, of)


def questions(scenario: dict[str, Any], files: Sequence[Path]) -> None:
    common: QuestionOptions = {"threads": 1, "seed": 3, "time_limit": "90 s", "progress": told}
    sized: hadar.Sizing = hadar.size(scenario, by="local", **common)
    print(sized.verdict.met, sized.pairs[0]["alternative"], sized.sentence, len(sized.to_json()), list(sized.pictures()))
    found: hadar.Identification = hadar.identify(scenario, matrix=True, library=files, progress=print)
    record: hadar.Record = found.identifiability
    result: hadar.Result = found
    drawn: hadar.Simulation = hadar.simulate(scenario, spectra=50, skip_spectra=True, **common)
    print(record.to_dict(), result.text, drawn.points)
    try:
        ranged: hadar.Ranging = hadar.range_(scenario, trials=2, threads=1)
        ruled: hadar.RuleAnswer = hadar.rule("nowhere.toml", on=date(2029, 9, 1))
        print(ranged.curve, ruled.cameras)
    except hadar.HadarError as error:
        print(hadar.__version__, error, hadar.LibraryWarning)


def cluster(scenario: dict[str, Any]) -> None:
    import hadar_limits.dask
    from hadar_limits.dask import Axis, Sweep

    sweep: Sweep = hadar_limits.dask.sweep(
        hadar.identify,
        scenario,
        {"temperature": Axis("target.temperature", np.array([300.0, 310.0]), "K")},
        {"distance": ("pairs.0.distance_nearest", "photon^-1/2")},
        batch=2,
        seed=3,
    )
    table = sweep.compute(scheduler="synchronous")
    nu = np.arange(800.0, 1200.0, 20.0)
    cube = np.full((6, 7, nu.size), 1000.0)
    maps = hadar_limits.dask.decompose(cube, np.full((1, nu.size), 0.9), (), nu, counts_per_radiance=1e-15)
    windows = hadar_limits.dask.window_information(cube, (3, 3), cells=["full"], var_added=4.0)
    print(table, maps, windows, sweep.shape)


if __name__ == "__main__":
    SCENARIO: dict[str, Any] = {
        "target": {"material": "skin", "temperature": "37 degC"},
        "environment": [{"temperature": "20 degC", "lighting": 0.5}],
        "alternatives": {"materials": ["aluminium", "concrete"]},
        "bands": {"start": "800 cm^-1", "stop": "1200 cm^-1", "step": "20 cm^-1"},
        "camera": {"preset": "flir-a325sc"},
    }
    planck()
    distances()
    cubes()
    questions(SCENARIO, [])
    cluster(SCENARIO)
