"""Heat cubes made and worked on in NumPy, against the same in the library."""

import os
import signal
import sys
import threading

import numpy as np
import pytest

import hadar_limits as hadar

NU = np.arange(800.0, 1201.0, 10.0)
T = (NU - 1000) / 200
LIBRARY = np.stack([0.97 - 0.02 * T**2, 0.6 + 0.2 * T, 0.85 - 0.1 * np.cos(3 * T)])
LIGHT = hadar.planck(NU, [[290.0]])
KAPPA = 3e-15


def cube(rows=6, columns=8, seed=1):
    random = np.random.default_rng(seed)
    material = random.integers(0, 3, (rows, columns))
    temperature = random.uniform(295.0, 320.0, (rows, columns))
    lighting = random.uniform(0.2, 0.9, (rows, columns))
    e = LIBRARY[material]
    s = e * hadar.planck(NU, temperature[..., None]) + (1 - e) * lighting[..., None] * LIGHT[0]
    return random.poisson(KAPPA * 10.0 * s).astype(float), material, temperature, lighting


OPTIONS = dict(counts_per_radiance=KAPPA)


def test_pixels_are_found_again_within_their_deviation():
    counts, material, temperature, lighting = cube(30, 40)
    maps = hadar.decompose(counts, LIBRARY, LIGHT, NU, **OPTIONS)
    sure = maps.candidates == 1
    assert sure.mean() > 0.9
    assert (maps.material == material)[sure].mean() > 0.99
    off = ((maps.temperature_k - temperature) / maps.temperature_sigma_k)[sure & (maps.flags == 0)]
    assert 0.8 < off.std() < 1.2 and abs(off.mean()) < 0.2
    assert maps.lighting.shape == (30, 40, 1)
    assert np.nanmedian(abs(maps.lighting[..., 0] - lighting)) < 0.1


def test_arrays_of_any_strides_give_the_same_bits():
    counts = cube()[0]
    expected = hadar.decompose(counts, LIBRARY, LIGHT, NU, **OPTIONS).to_dict()
    bands_first = np.ascontiguousarray(counts.transpose(2, 0, 1)).transpose(1, 2, 0)
    every_second = np.repeat(counts, 2, axis=1)[:, ::2]
    for other in [bands_first, every_second, np.asfortranarray(counts), counts.astype("f4"), counts.astype("u4")]:
        found = hadar.decompose(other, LIBRARY, LIGHT, NU, threads=1, **OPTIONS).to_dict()
        for name, values in expected.items():
            np.testing.assert_array_equal(found[name], values, err_msg=name)
    pixels = hadar.decompose(counts.reshape(-1, NU.size), LIBRARY, LIGHT, NU, **OPTIONS)
    assert pixels.material.shape == (48,)
    np.testing.assert_array_equal(pixels.material.reshape(6, 8), expected["material"])
    one = hadar.decompose(counts[0, 0], LIBRARY, LIGHT, NU, **OPTIONS)
    assert one.material.shape == () and one.material == expected["material"][0, 0]


def test_what_cannot_be_is_refused():
    counts = cube()[0]
    refusals = [
        (dict(cube=counts[..., :-1]), "bands of the cube: 40 values where 41"),
        (dict(cube=counts - 1e9), "is no number of counts"),
        (dict(cube=counts[None]), "a cube of 4 dimensions"),
        (dict(library=LIBRARY + 1), "emissivity"),
        (dict(method="mle"), "method `mle`"),
        (dict(potts=(1.0, None), tex_sgd=1.0), "two priors"),
        (dict(light=LIGHT[:, :-1]), "spectrum of the surroundings"),
    ]
    for change, message in refusals:
        asked = dict(cube=counts, library=LIBRARY, light=LIGHT, bands=NU, **OPTIONS) | change
        with pytest.raises(hadar.HadarError) as error:
            hadar.decompose(**asked)
        assert message in str(error.value), str(error.value)


def test_information_of_windows_is_that_of_its_equation():
    counts = 1000 + 50 * np.random.default_rng(2).random((12, 15, 7))
    slope = (counts[:, 2:] - counts[:, :-2]) / 2
    each = (slope**2 / (counts[:, 1:-1] + 9.0)).sum(-1)
    windows = np.lib.stride_tricks.sliding_window_view(each, (5, 3)).sum((-1, -2))
    found = hadar.window_information(counts, (5, 3), var_added=9.0, cells=["full", "total"])
    assert found.full.shape == (12, 15) and found.spatial is None
    np.testing.assert_allclose(found.full[2:-2, 2:-2], windows, rtol=1e-12)
    assert np.isnan(found.full[:2]).all() and np.isnan(found.full[:, :2]).all() and np.isnan(found.full[:, -2:]).all()
    narrow = hadar.window_information(counts.astype("f4")[:, ::1], (5, 3), var_added=9.0, threads=1)
    np.testing.assert_allclose(narrow.full[2:-2, 2:-2], windows, rtol=1e-5)
    with pytest.raises(hadar.HadarError, match="window of 4 x 3"):
        hadar.window_information(counts, (4, 3))


def test_the_interpreter_is_free_meanwhile():
    counts = np.tile(cube(40, 40)[0], (4, 4, 1))
    begun, ran = threading.Event(), threading.Event()

    def other_work():
        begun.wait()
        ran.set()

    other = threading.Thread(target=other_work)
    other.start()
    interval = sys.getswitchinterval()
    # The interpreter goes to the other thread only where it is given away.
    sys.setswitchinterval(1e6)
    try:
        begun.set()
        hadar.decompose(counts, LIBRARY, LIGHT, NU, threads=1, skipping=False, **OPTIONS)
        meanwhile = ran.is_set()
    finally:
        sys.setswitchinterval(interval)
    other.join()
    assert meanwhile


def test_a_forked_child_has_threads_of_its_own():
    if not hasattr(os, "fork"):
        pytest.skip("there is no fork here")
    counts = cube()[0]
    expected = hadar.decompose(counts, LIBRARY, LIGHT, NU, **OPTIONS).temperature_k
    child = os.fork()
    if child == 0:
        # Only ends one that hangs.
        signal.alarm(600)
        same = np.array_equal(hadar.decompose(counts, LIBRARY, LIGHT, NU, **OPTIONS).temperature_k, expected)
        os._exit(0 if same else 1)
    assert os.waitpid(child, 0)[1] == 0
