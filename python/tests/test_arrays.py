"""Functions on arrays, held against the same equations in NumPy."""

import astropy.units as u
import dask.array.ma
import numpy as np
import pandas
import pytest
import xarray
from astropy.utils.masked import Masked

import hadar_limits as hadar

C2 = 1.438776877503933  # hc/k, cm K
C = 299792458.0
NU = np.arange(715.0, 1251.0)
SKIN = np.full(NU.size, 0.95)
SLOPE = (NU - 985) / 265
METAL = 0.49287 - 0.0782 * SLOPE + 0.00892 * SLOPE**2
SCENE = hadar.Scene(NU, 310.15, [0.5], [293.15])


def planck(nu, t):
    return 2 * C * 100 * nu**2 / np.expm1(C2 * nu / t) * 1e4


def planck_slope(nu, t):
    x = C2 * nu / t
    return planck(nu, t) * x / t / -np.expm1(-x)


def signal(e, t, v, t0=293.15):
    return e * planck(NU, t) + (1 - e) * v * planck(NU, t0)


def test_planck_is_planck_over_any_shape():
    temperatures = np.array([[280.0], [300.0], [320.0]])
    found = hadar.planck(NU, temperatures)
    assert found.shape == (3, NU.size)
    np.testing.assert_allclose(found, planck(NU, temperatures), rtol=1e-13)
    np.testing.assert_allclose(hadar.planck_slope(NU, temperatures), planck_slope(NU, temperatures), rtol=1e-13)
    image = np.linspace(250.0, 350.0, 12).reshape(3, 4)
    np.testing.assert_allclose(hadar.planck(1000.0, image), planck(1000.0, image), rtol=1e-13)
    np.testing.assert_allclose(hadar.brightness_temperature(1000.0, hadar.planck(1000.0, image)), image, rtol=1e-13)
    assert isinstance(hadar.planck(1000.0, 300.0), float)


def test_arrays_of_any_strides_and_kind_give_the_same_bits():
    wide = np.repeat(NU, 3)
    records = np.zeros(NU.size, dtype=[("a", "i1"), ("nu", "f8")])
    records["nu"] = NU
    expected = hadar.planck(NU, 300.0)
    for other in [wide[::3], NU[::-1][::-1], records["nu"], NU.astype(">f8"), NU.astype(int), list(NU), NU.astype("f4")]:
        assert np.array_equal(hadar.planck(other, 300.0), expected)
    assert np.array_equal(hadar.planck(NU[::-1], 300.0), expected[::-1])


def test_what_would_be_taken_wrongly_is_refused():
    refusals = [
        (lambda: hadar.planck(np.ma.masked_less(NU, 800), 300.0), "masked"),
        (lambda: hadar.planck(NU + 1j, 300.0), "complex"),
        (lambda: hadar.planck(["a"], 300.0), "array of <U1"),
        (lambda: hadar.planck(NU, -3.0), "temperature is -3 K"),
        (lambda: hadar.planck(-NU, 300.0), "wavenumber"),
        (lambda: hadar.Scene(NU[::-1], 310.15), "do not ascend"),
        (lambda: hadar.Scene(NU, 310.15, [0.5]), "thermal lighting factors"),
        (lambda: hadar.Scene(NU, 310.15, [1.5], [293.15]), "at most 1"),
        (lambda: hadar.Scene(NU, 310.15, [0.5], [293.15], unknown=["temprature"]), "temperature"),
        (lambda: hadar.Scene(NU, 310.15, [0.5], [293.15], var_added=3.0), "counts_per_radiance"),
        (lambda: hadar.local(SKIN[:-1], METAL, SCENE), "target: emissivity: 535 values where 536"),
        (lambda: hadar.local(SKIN, 2 * METAL, SCENE), "alternative: emissivity is"),
        (lambda: hadar.local(SKIN, np.where(NU > 800, METAL, np.nan), SCENE), "alternative: emissivity is NaN"),
        (lambda: hadar.matrix([SKIN, METAL], SCENE, by="nearby"), "distance `nearby`"),
        (lambda: hadar.matrix([SKIN, METAL], SCENE, threads=5000), "at most 1024"),
        (lambda: hadar.nearest(SKIN, METAL, SCENE, prove=2.0), "prove"),
        (lambda: hadar.emissivity("skn", NU), "nearest are `skin`"),
    ]
    for refused, message in refusals:
        with pytest.raises(hadar.HadarError, match=None) as error:
            refused()
        assert message in str(error.value), str(error.value)
    assert np.isnan(hadar.planck(1000.0, [np.nan, 300.0])).tolist() == [True, False]


def test_a_mask_is_never_dropped():
    hidden = np.arange(NU.size) == 3
    masked = np.ma.array(METAL, mask=hidden)
    nullable = pandas.array(METAL, dtype="Float64")
    nullable[3] = pandas.NA
    behind = dask.array.ma.masked_array(METAL, mask=hidden)
    for wrong in (masked, Masked(METAL, mask=hidden), Masked(METAL * u.one, mask=hidden), nullable, pandas.Series(nullable), behind):
        # What pandas calls missing may come as nan, which no emissivity is.
        for ask in (lambda: hadar.local(SKIN, wrong, SCENE), lambda: hadar.matrix([SKIN, wrong], SCENE)):
            with pytest.raises(hadar.HadarError, match="masked|nan|NaN"):
                ask()
    cube = np.full((5, 5, 3), 100.0)
    for wrong in (Masked(cube, mask=cube > 0), Masked(cube * u.ct, mask=cube > 0), [np.ma.array(row, mask=row > 0) for row in cube]):
        with pytest.raises(hadar.HadarError, match="cube: a masked array"):
            hadar.window_information(wrong)
    for wrong in (np.ma.masked, Masked(310.0, mask=True), Masked(310.0 * u.K, mask=True)):
        with pytest.raises(hadar.HadarError, match="masked"):
            hadar.Scene(NU, wrong)
    light = hadar.planck(NU, 290.0)
    with pytest.raises(hadar.HadarError, match="bad_bands: a masked array"):
        hadar.decompose(light, [SKIN], [light], NU, counts_per_radiance=1.0, bad_bands=np.ma.array([1, 2], mask=[0, 1]))


def test_what_numpy_makes_no_array_of_is_refused_by_its_name():
    for wrong in ([[1.0], [1.0, 2.0]], [1.0, {}], xarray.Dataset({"a": 3.0})):
        with pytest.raises(hadar.HadarError, match="nu: "):
            hadar.planck(wrong, 300.0)


def test_lists_without_end_are_refused():
    endless, deep = [1.0], 1.0
    endless.append(endless)
    for _ in range(100_000):
        deep = [deep]
    for wrong in (endless, deep):
        with pytest.raises(hadar.HadarError, match="nu: lists in lists without end"):
            hadar.planck(wrong, 300.0)
        with pytest.raises(hadar.HadarError, match="lists in lists without end"):
            hadar.local(wrong, SKIN, SCENE)


def test_local_distance_is_that_of_a_qr_decomposition():
    s = signal(SKIN, 310.15, 0.5)
    weight = 1 / np.sqrt(s * s.sum())
    nuisances = np.stack([SKIN * planck_slope(NU, 310.15), (1 - SKIN) * planck(NU, 293.15)], 1) * weight[:, None]
    score = (METAL - SKIN) * (planck(NU, 310.15) - 0.5 * planck(NU, 293.15)) * weight
    q, _ = np.linalg.qr(nuisances)
    expected = 0.5 * np.linalg.norm(score - q @ (q.T @ score))
    found = hadar.local(SKIN, METAL, SCENE)
    assert found.distance == pytest.approx(expected, rel=1e-10)
    assert found.distance_no_nuisance == pytest.approx(0.5 * np.linalg.norm(score), rel=1e-12)
    assert found.per_photon and found.status == "ok" and found.probability is None
    np.testing.assert_allclose(SCENE.signal(SKIN), s, rtol=1e-13)
    np.testing.assert_array_equal(SCENE.nodes, NU)


def test_nearest_distance_is_the_least_over_a_grid():
    root = np.sqrt(signal(SKIN, 310.15, 0.5))
    low, high = np.array([300.0, 0.0]), np.array([420.0, 1.0])
    for _ in range(12):
        t, v = np.linspace(low[0], high[0], 41), np.linspace(low[1], high[1], 41)
        other = METAL * planck(NU, t[:, None])
        other = other[:, None] + (1 - METAL) * v[:, None] * planck(NU, 293.15)
        d = np.linalg.norm(root - np.sqrt(other), axis=-1) / np.linalg.norm(root)
        i, j = np.unravel_index(d.argmin(), d.shape)
        step = (high - low) / 16
        low = np.maximum([t[i] - step[0], v[j] - step[1]], [1.0, 0.0])
        high = np.minimum([t[i] + step[0], v[j] + step[1]], [1e4, 1.0])
    found = hadar.nearest(SKIN, METAL, SCENE)
    assert found.distance == pytest.approx(d.min(), rel=1e-5)
    assert found.temperature == pytest.approx(t[i], abs=1e-2)
    assert found.lighting[0] == pytest.approx(v[j], abs=1e-3)
    assert d.min() * (1 + 1e-9) >= found.lower >= (1 - 1e-6) * found.distance


def test_a_matrix_is_its_pairs():
    library = np.stack([SKIN, METAL, np.clip(SKIN - 1e-4 * (NU - 715), 0, 1)])
    local, near = hadar.matrix(library, SCENE), hadar.matrix(library, SCENE, by="nearest", prove=1e-6)
    for i in range(3):
        for j in range(3):
            if i != j:
                assert local[i, j] == pytest.approx(hadar.local(library[i], library[j], SCENE).distance, rel=1e-9)
                assert near[i, j] == pytest.approx(hadar.nearest(library[i], library[j], SCENE).distance, rel=1e-6)
    assert np.array_equal(local, hadar.matrix(np.asfortranarray(library), SCENE, threads=1))


def test_a_map_of_states_is_its_pairs():
    t, v = np.meshgrid([290.0, 310.15, 330.0], [0.1, 0.5], indexing="ij")
    for by, one in [("local", hadar.local), ("nearest", hadar.nearest)]:
        found = hadar.over_states(SKIN, METAL, SCENE, t, v, by=by, prove=1e-6)
        assert found.shape == (3, 2)
        for i, j in np.ndindex(3, 2):
            alone = one(SKIN, METAL, hadar.Scene(NU, t[i, j], [v[i, j]], [293.15]))
            assert found[i, j] == pytest.approx(alone.distance, rel=1e-6)
    two = hadar.Scene(NU, 310.15, [0.5, 0.2], [293.15, 250.0])
    found = hadar.over_states(SKIN, METAL, two, [310.15], [[0.5, 0.2]])
    assert found[0] == pytest.approx(hadar.local(SKIN, METAL, two).distance, rel=1e-12)
    with pytest.raises(hadar.HadarError, match="broadcast both to one shape"):
        hadar.over_states(SKIN, METAL, SCENE, t[:, :1], v)


def test_counts_make_statistical_distances():
    s = signal(SKIN, 310.15, 0.5)
    scene = hadar.Scene(NU, 310.15, [0.5], [293.15], counts_per_radiance=1e6 / s.sum())
    found, bound = hadar.nearest(SKIN, METAL, scene), hadar.nearest(SKIN, METAL, SCENE)
    assert found.distance == pytest.approx(1e3 * bound.distance, rel=1e-9)
    assert 0.5 < found.probability < 1
    noisy = hadar.Scene(NU, 310.15, [0.5], [293.15], counts_per_radiance=1e6 / s.sum(), var_added=1e4)
    assert hadar.nearest(SKIN, METAL, noisy).distance < found.distance
