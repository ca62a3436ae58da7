"""Ctrl-C ends every long call with KeyboardInterrupt, in a process of its own; progress is told, and may end a call too."""

import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import hadar_limits as hadar

# What each call takes without an interrupt is minutes.
COMMON = """
import sys
import numpy as np
import hadar_limits as hadar

bands = np.linspace(715.0, 1250.0, 20000)
surroundings = [278.0 + 7 * k for k in range(8)]
light = np.stack([np.interp(bands, [700, 1300], [0.9, 0.3 + 0.05 * k]) for k in range(8)])
scene = hadar.Scene(bands, 310.15, [0.1] * 8, surroundings, environment_emissivity=light,
    unknown=["temperature", "lighting", "gain", "environment-temperature"])
small = hadar.Scene(bands[::100], 310.15, [0.5], [293.15])
random = np.random.default_rng(1)
library = 0.5 + 0.4 * np.cos(np.outer(random.uniform(0.001, 0.02, 3000), bands[::100]))
skin, metal = np.full(bands.size, 0.95), 0.5 + 0.1 * np.sin(bands / 50)
states = np.linspace(290.0, 330.0, 20_000_000 if "states" in NAME else 1)
side = 800 if NAME in ("decompose", "potts", "windows") else 1
cube = np.tile(random.poisson(1000.0, (1, side, 200)).astype("f4"), (side, 1, 1))
print("ready", flush=True)
"""
CALLS = {
    "nearest": "hadar.nearest(skin, metal, scene)",
    "matrix_local": "while True: hadar.matrix(library, small)",
    "matrix": 'hadar.matrix(library, small, by="nearest")',
    "states_local": "hadar.over_states(skin[::100], metal[::100], small, states, np.full(states.size, 0.5))",
    "states": 'hadar.over_states(skin[::100], metal[::100], small, states, np.full(states.size, 0.5), by="nearest")',
    "decompose": "hadar.decompose(cube, library[:300], small.signal(library[0])[None] * 0.1, small.nodes, counts_per_radiance=1e-15, skipping=False)",
    "potts": "hadar.decompose(cube, library[:30], (), small.nodes, counts_per_radiance=1e-15, potts=(1.0, 0.5))",
    "windows": "while True: hadar.window_information(cube)",
    "identify": """hadar.identify({
        "target": {"material": "skin", "temperature": "37 degC"},
        "environment": [{"temperature": "20 degC", "lighting": 0.5}],
        "alternatives": {"materials": ["aluminium"]},
    }, exact=True, trials=10**9, photons=1e4, half_width=1e-7)""",
}


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise there")
@pytest.mark.parametrize("name", CALLS)
def test_an_interrupt_ends_a_call(name):
    child = subprocess.Popen(
        [sys.executable, "-c", f"NAME = {name!r}" + COMMON + CALLS[name]], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        assert child.stdout.readline() == "ready\n", child.stderr.read()
        # It is in the middle of the call then.
        time.sleep(2)
        assert child.poll() is None, child.stderr.read()
        begin = time.monotonic()
        child.send_signal(signal.SIGINT)
        _, said = child.communicate(timeout=30)
    finally:
        child.kill()
    print(f"{name} ended after {time.monotonic() - begin:.2f} s")
    assert "KeyboardInterrupt" in said.strip().split("\n")[-1], said


def test_progress_is_told_and_ends_a_call():
    nu = np.arange(800.0, 1201.0, 10.0)
    counts = np.random.default_rng(1).poisson(1000.0, (300, 300, nu.size)).astype("f4")
    library = 0.5 + 0.4 * np.cos(np.outer(np.linspace(0.001, 0.02, 20), nu))
    asked = dict(counts_per_radiance=1e-15, skipping=False, threads=1)
    seen = []
    hadar.decompose(counts, library, (), nu, progress=lambda *far: seen.append(far), **asked)
    assert seen == sorted(seen) and seen[-1] == (300, 300), seen
    scene = hadar.Scene(nu, 310.15, [0.5], [293.15])
    seen.clear()
    hadar.matrix(library, scene, by="nearest", progress=lambda *far: seen.append(far))
    assert seen[-1] == (20, 20)

    class Enough(Exception):
        pass

    def enough(done, of):
        raise Enough(f"{done} of {of}")

    with pytest.raises(Enough):
        hadar.decompose(counts, library, (), nu, progress=enough, **asked)
    with pytest.raises(TypeError, match="not callable"):
        hadar.decompose(counts, library, (), nu, progress=3, **asked)
