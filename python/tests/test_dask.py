"""Sweeps and cubes on a cluster of several processes give what one process gives, also when a worker is killed."""

import os
import signal

import numpy as np
import pytest

import hadar_limits as hadar

pytest.importorskip("distributed")
pytest.importorskip("xarray")

import astropy.units as u
import dask.array
import dask.array.ma
import pint
import xarray
from astropy.utils.masked import Masked
from distributed import Client, Event, LocalCluster

import hadar_limits.dask
from hadar_limits.dask import Axis

NU = np.arange(800.0, 1201.0, 10.0)
T = (NU - 1000) / 200
LIBRARY = np.stack([0.97 - 0.02 * T**2, 0.6 + 0.2 * T, 0.85 - 0.1 * np.cos(3 * T)])
LIGHT = hadar.planck(NU, [[290.0], [250.0]])
OPTIONS = dict(counts_per_radiance=3e-15)
SCENARIO = {
    "target": {"material": "skin", "temperature": "37 degC"},
    "environment": [{"temperature": "20 degC", "lighting": 0.5}],
    "alternatives": {"materials": ["aluminium"]},
    "bands": {"start": "800 cm^-1", "stop": "1200 cm^-1", "step": "20 cm^-1"},
}
AXES = {
    "temperature": Axis("target.temperature", np.array([300.0, 310.0, 320.0]), "K"),
    "lighting": Axis("environment.0.lighting", [0.2, 0.5, 0.8, 0.9]),
}
READ = {"distance": ("pairs.0.distance_nearest", "photon^-1/2"), "rival": ("limiting", "")}


def cube(rows=40, columns=30):
    random = np.random.default_rng(5)
    e = LIBRARY[random.integers(0, 3, (rows, columns))]
    s = e * hadar.planck(NU, random.uniform(295, 320, (rows, columns, 1))) + (1 - e) * 0.6 * LIGHT[0]
    return random.poisson(3e-15 * 10 * s).astype("f4")


@pytest.fixture(scope="module")
def client():
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            yield client


def test_a_sweep_is_its_questions(client):
    sweep = hadar.dask.sweep(hadar.identify, SCENARIO, AXES, READ, batch=5)
    assert len(sweep.tasks) == 3 and sweep.shape == (3, 4)
    found = sweep.compute()
    assert found.distance.dims == ("temperature", "lighting")
    assert found.distance.units == "photon^-1/2" and found.temperature.units == "K" and found.hadar == hadar.__version__
    scenario = SCENARIO | {
        "target": {"material": "skin", "temperature": "310 K"},
        "environment": [{"temperature": "20 degC", "lighting": 0.8}],
    }
    alone = hadar.identify(scenario)
    assert float(found.distance.sel(temperature=310, lighting=0.8)) == alone.pairs[0].distance_nearest
    assert set(found.rival.values.ravel()) == {"aluminium"}
    points = sweep.to_bag().compute()
    assert [point["distance"] for point in points] == list(found.distance.values.ravel())


def test_a_bad_point_leaves_the_others(client):
    axes = {
        "temperature": Axis("target.temperature", [300.0, -5.0, 310.0], "K"),
        "material": Axis("alternatives.materials.0", ["aluminium", "unobtainium"]),
    }
    for batch in (1, 6):
        sweep = hadar.dask.sweep(hadar.identify, SCENARIO, axes, READ, batch=batch)
        with pytest.warns(UserWarning, match="4 of 6 points have no answer"):
            found = sweep.compute()
        bad = np.array([[False, True], [True, True], [False, True]])
        np.testing.assert_array_equal(found.error != "", bad)
        np.testing.assert_array_equal(np.isnan(found.distance), bad)
        np.testing.assert_array_equal(found.rival == "", bad)
        assert "unobtainium" in str(found.error[0, 1].item()) and "-5" in str(found.error[1, 0].item())
        alone = hadar.identify(SCENARIO | {"target": {"material": "skin", "temperature": "310 K"}})
        assert float(found.distance[2, 0]) == alone.pairs[0].distance_nearest
        assert [bool(point["error"]) for point in sweep.to_bag().compute()] == list(bad.ravel())


def test_mistakes_of_a_sweep_are_told():
    wrong = hadar.dask.sweep(hadar.identify, SCENARIO, AXES, {"distance": ("pairs.0.distanc", "")})
    with pytest.raises(hadar.HadarError, match="none of the 12 points .* pairs.0.distanc: there is no `distanc`"):
        wrong.compute(scheduler="synchronous")
    nowhere = hadar.dask.sweep(hadar.identify, SCENARIO, {"v": Axis("environment.4.lighting", [0.1])}, READ)
    with pytest.raises(hadar.HadarError, match="environment.4.lighting: there is no such place"):
        nowhere.compute(scheduler="synchronous")
    with pytest.raises(hadar.HadarError, match="at least 1"):
        hadar.dask.sweep(hadar.identify, SCENARIO, AXES, READ, batch=0)
    with pytest.raises(hadar.HadarError, match="another name"):
        hadar.dask.sweep(hadar.identify, SCENARIO, AXES, {"error": ("limiting", "")})


def test_a_cube_in_chunks_is_the_whole_cube(client):
    counts = cube()
    expected = hadar.decompose(counts, LIBRARY, LIGHT, NU, **OPTIONS).to_dict()
    chunked = dask.array.from_array(counts, chunks=(16, 11, 20))
    lines = xarray.DataArray(counts, dims=("line", "sample", "wave"), coords={"line": np.arange(40) * 2.0}).chunk(line=10)
    for given, dims in [(chunked, ("y", "x", "band")), (lines, ("line", "sample", "wave")), (counts, ("y", "x", "band"))]:
        maps = hadar.dask.decompose(given, LIBRARY, LIGHT, NU, dims=dims, names=["a", "b", "c"], **OPTIONS)
        assert maps.temperature_k.units == "K" and maps.materials == ["a", "b", "c"]
        maps = maps.compute()
        for name, values in expected.items():
            assert maps[name].dtype == values.dtype
            # Where fits start is laid out for the mean of a chunk.
            tolerance = 2e-6 if values.dtype == np.float32 else 0
            np.testing.assert_allclose(maps[name], values, rtol=tolerance, err_msg=name)
    assert list(maps.lighting.dims) == ["y", "x", "surroundings"]
    with pytest.raises(hadar.HadarError, match="name its rows, columns and bands"):
        hadar.dask.decompose(lines, LIBRARY, LIGHT, NU, **OPTIONS)


def test_priors_over_the_image_see_over_the_edges(client):
    random = np.random.default_rng(3)
    e = LIBRARY[(np.indices((40, 30)).sum(0) // 20) % 3]
    s = e * hadar.planck(NU, 305.0) + (1 - e) * 0.6 * LIGHT[0]
    counts = random.poisson(3e-19 * 10 * s).astype("f4")
    potts = dict(counts_per_radiance=3e-19, potts=(1.0, 0.5))
    expected = hadar.decompose(counts, LIBRARY, LIGHT, NU, **potts)
    chunked = dask.array.from_array(counts, chunks=(20, 15, -1))
    found = hadar.dask.decompose(chunked, LIBRARY, LIGHT, NU, overlap=15, **potts).compute()
    apart = hadar.decompose(counts, LIBRARY, LIGHT, NU, counts_per_radiance=3e-19)
    assert (apart.material != expected.material).mean() > 0.05
    assert (found.material.values != expected.material).mean() < 0.01
    assert found.lighting.shape == (40, 30, 2)
    with pytest.raises(hadar.HadarError, match="without its step"):
        hadar.dask.decompose(chunked, LIBRARY, LIGHT, NU, potts=(1.0, None), **OPTIONS)


@pytest.mark.parametrize("derivative", ["central", "simoncelli", "fourier"])
def test_windows_of_chunks_are_those_of_the_cube(client, derivative):
    counts = 100 + cube().astype(float)
    cells = ["full", "spectral"]
    expected = hadar.window_information(counts, (5, 3), cells=cells, derivative=derivative, var_added=4.0)
    chunked = dask.array.from_array(counts, chunks=(13, 12, 9))
    found = hadar.dask.window_information(chunked, (5, 3), cells=cells, derivative=derivative, var_added=4.0)
    assert found.full.units == "pixel^-2"
    for name in [*cells, "photons"]:
        np.testing.assert_allclose(found[name].values, expected.to_dict()[name], rtol=1e-12, err_msg=name)


def _held(block, block_id=None):
    """A block of which the later ones wait until a worker has been killed."""
    if block_id and block_id[0] >= 4:
        Event("waiting").set()
        Event("killed").wait()
    return block


def test_a_worker_that_is_killed_loses_nothing(client):
    counts = cube()
    chunked = dask.array.from_array(counts, chunks=(4, 15, -1))
    expected = hadar.dask.decompose(chunked, LIBRARY, LIGHT, NU, **OPTIONS).compute(scheduler="synchronous")
    held = chunked.map_blocks(_held, dtype=counts.dtype)
    kept = hadar.dask.decompose(held, LIBRARY, LIGHT, NU, **OPTIONS).persist()
    # Its results are lost, and what it was at.
    Event("waiting").wait()
    workers = client.run(os.getpid)
    os.kill(next(iter(workers.values())), signal.SIGKILL)
    Event("killed").set()
    found = kept.compute()
    np.testing.assert_array_equal(found.material, expected.material)
    np.testing.assert_array_equal(found.temperature_k, expected.temperature_k)
    assert set(client.run(os.getpid).values()) != set(workers.values())


def over(values, name="band", unit=None, **others):
    """The cube with a coordinate over its bands."""
    made = xarray.DataArray(cube(12, 10), dims=("y", "x", "band"), coords={name: ("band", values)} | others)
    if unit:
        made[name].attrs["units"] = unit
    return made


WAVELENGTHS = 1e4 / NU
COORDINATES = {
    "wavenumber": over(NU, "wavenumber", "cm^-1"),
    "band in cm-1": over(NU, "band", "cm-1"),
    "without a unit": over(NU, "band"),
    "wavelength": over(WAVELENGTHS, "wavelength", "um"),
    "rounded": over(np.round(1e3 * WAVELENGTHS), "wavelength", "nm"),
    "counted": over(np.arange(NU.size), "band"),
    "counted from 1": over(np.arange(NU.size) + 1, "band"),
    "both": over(np.arange(NU.size) + 1, "band", wavelength=("band", WAVELENGTHS, {"units": "um"}), fwhm=("band", NU[::-1])),
}


@pytest.mark.parametrize("name", COORDINATES)
def test_coordinates_decide_the_order_of_bands(name):
    given = COORDINATES[name]
    expected = hadar.decompose(given.values, LIBRARY, LIGHT, NU, **OPTIONS).to_dict()
    shuffled = given.isel(band=np.random.default_rng(4).permutation(NU.size))
    for turned in (given, given.isel(band=slice(None, None, -1)), shuffled):
        for asked in (turned, turned.chunk(y=5)):
            maps = hadar.dask.decompose(asked, LIBRARY, LIGHT, NU, **OPTIONS).compute(scheduler="synchronous")
            np.testing.assert_array_equal(maps.material, expected["material"])
            np.testing.assert_allclose(maps.temperature_k, expected["temperature_k"], rtol=2e-6)
        alone = hadar.decompose(turned, LIBRARY, LIGHT, NU, **OPTIONS)
        np.testing.assert_array_equal(alone.temperature_k, expected["temperature_k"])


def test_coordinates_that_contradict_the_bands_are_refused():
    good = over(WAVELENGTHS, "wavelength", "um")
    refusals = [
        (over(NU + 8.0, "band", "cm^-1"), NU, "at 808.000 cm"),
        (over(WAVELENGTHS, "wavelength"), NU, r'write \.attrs\["units"\]'),
        (over(np.arange(NU.size) + 8, "band"), NU, "without a unit"),
        (over(NU, "band", "furlong"), NU, "furlong"),
        (over(np.where(NU == 1000.0, np.nan, NU), "band", "cm^-1"), NU, "NaN"),
        (good, NU[:-1], "bands by cube.wavelength"),
        (good, NU * 1.2, "but at"),
        (good.assign_coords(wavelength=("y", np.arange(12.0))), NU, "one dimension of bands"),
    ]
    for given, bands, message in refusals:
        library, light = LIBRARY[:, : bands.size], LIGHT[:, : bands.size]
        for decompose in (hadar.decompose, hadar.dask.decompose):
            with pytest.raises(hadar.HadarError, match=message):
                decompose(given, library, light, bands, **OPTIONS)


def test_units_of_a_cube_and_of_bands_hold_in_chunks_too():
    given = over(NU, "wavenumber", "cm^-1")
    expected = hadar.decompose(given, LIBRARY, LIGHT, NU, **OPTIONS)
    bands = xarray.DataArray(0.1 * NU, attrs={"units": "mm^-1"})
    with pytest.raises(hadar.HadarError, match="mm\\^-1"):
        hadar.dask.decompose(given, LIBRARY, LIGHT, bands, **OPTIONS)
    metres = xarray.DataArray(100.0 * NU, attrs={"units": "m^-1"})
    percent = xarray.DataArray(100.0 * LIBRARY[:, ::-1], dims=("m", "nu"), coords={"nu": ("nu", NU[::-1], {"units": "cm^-1"})}, attrs={"units": "percent"})
    found = hadar.dask.decompose(given, percent, LIGHT, metres, **OPTIONS).compute()
    np.testing.assert_array_equal(found.material, expected.material)
    np.testing.assert_allclose(found.temperature_k, expected.temperature_k, rtol=2e-6)
    given.attrs["units"] = "W m-2 sr-1 um-1"
    with pytest.raises(hadar.HadarError, match="give counts"):
        hadar.dask.decompose(given, LIBRARY, LIGHT, NU, **OPTIONS)
    with pytest.raises(hadar.HadarError, match="give counts"):
        hadar.dask.window_information(given)


def test_what_a_cube_says_besides_is_not_lost_in_chunks():
    counts = cube()
    for wrong, message in [
        (counts * u.K, "the unit `K`"),
        (xarray.DataArray(pint.UnitRegistry().Quantity(counts, "K"), dims=("y", "x", "band")), "the unit `kelvin`"),
        (Masked(counts, mask=counts > 0), "a masked array"),
        (np.ma.array(counts, mask=counts > 0), "a masked array"),
    ]:
        for ask in (lambda: hadar.dask.decompose(wrong, LIBRARY, LIGHT, NU, **OPTIONS), lambda: hadar.dask.window_information(wrong)):
            with pytest.raises(hadar.HadarError, match=message):
                ask().compute(scheduler="synchronous")
    # In an xarray a mask is nan.
    hidden = np.arange(NU.size) == 3
    chunked = dask.array.ma.masked_array(dask.array.from_array(counts), mask=hidden + 0 * counts > 0)
    found = [hadar.dask.decompose(each, LIBRARY, LIGHT, NU, **OPTIONS) for each in (chunked, np.where(hidden, np.nan, counts))]
    np.testing.assert_array_equal(*(each.compute(scheduler="synchronous").temperature_k for each in found))
    counted = hadar.dask.window_information(counts * u.ct)
    np.testing.assert_array_equal(counted.full, hadar.dask.window_information(counts).full)
