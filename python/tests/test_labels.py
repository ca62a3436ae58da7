"""The order in which bands and dimensions come with their labels never changes an answer."""

import numpy as np
import pandas
import pytest
import xarray

import hadar_limits as hadar
import hadar_limits.dask

NU = np.linspace(800.0, 1250.0, 12)
TILTED = np.linspace(0.9, 0.6, NU.size)
LIBRARY = np.stack([np.linspace(0.95, 0.98, NU.size), TILTED])
LIGHT = hadar.planck(NU, [[290.0]])
KAPPA = 1e-12
TEMPERATURES = np.linspace(295.0, 325.0, 54).reshape(6, 9)
SIGNAL = LIBRARY[0] * hadar.planck(NU, TEMPERATURES[..., None]) + (1 - LIBRARY[0]) * 0.5 * LIGHT[0]
CUBE = KAPPA * np.gradient(NU) * SIGNAL
VAR = np.linspace(1.0, 5e4, NU.size)
SCENE = hadar.Scene(NU, 310.15, [0.5], [293.15])

LABELS = {
    "band": (NU, "cm-1"),
    "nu": (NU, "cm^-1"),
    "wl": (1e4 / NU, "um"),
    "lambda": (1e7 / NU, "nm"),
    "channel": (NU * 0.0299792458, "THz"),
    "wavelength": (1e4 / NU, "um"),
    "centre": (NU, "cm^-1"),
}


def named(values, name, dims=("y", "x", "band"), places=slice(None)):
    at, unit = LABELS[name]
    dims = dims[-np.ndim(values) :]
    whole = xarray.DataArray(values, dims=dims, coords={name: ("band", at, {"units": unit})})
    return whole.isel(band=places)


def framed(values, places):
    labels = NU[places]
    values = np.asarray(values)[..., places]
    return pandas.Series(values, index=labels) if values.ndim == 1 else pandas.DataFrame(values, columns=labels)


FALLING = np.arange(NU.size)[::-1]
SHUFFLED = np.random.default_rng(4).permutation(NU.size)


def decompose(cube=CUBE, library=LIBRARY, light=LIGHT, **options):
    return hadar.decompose(cube, library, light, NU, counts_per_radiance=KAPPA, **options)


def same(one, other):
    for name, values in other.to_dict().items():
        np.testing.assert_array_equal(one.to_dict()[name], values, err_msg=name)


@pytest.mark.parametrize("places", [FALLING, SHUFFLED], ids=["falling", "shuffled"])
@pytest.mark.parametrize("name", LABELS)
def test_coordinates_by_any_name_of_bands_decide(name, places):
    same(decompose(named(CUBE, name, places=places), named(LIBRARY, name, places=places)), decompose())
    turned = [named(one, name, places=places) for one in LIBRARY]
    assert hadar.local(*turned, SCENE).distance == hadar.local(*LIBRARY, SCENE).distance
    plain = hadar.window_information(CUBE, (3, 3), var_added=VAR).full
    # What is called as nobody's bands are told by is known by what it shares with something else.
    for cube in (named(CUBE, name), named(CUBE, name, places=places), *([] if name == "centre" else [CUBE])):
        found = hadar.window_information(cube, (3, 3), var_added=named(VAR, name, places=places)).full
        np.testing.assert_allclose(found, plain, rtol=1e-12)
    of_its_own = hadar.window_information(named(CUBE, name, places=places), (3, 3), var_added=VAR[places]).full
    np.testing.assert_allclose(of_its_own, plain, rtol=1e-12)


def test_windows_of_other_bands_are_refused():
    elsewhere = named(VAR, "nu").assign_coords(nu=("band", NU + 100.0, {"units": "cm^-1"}))
    with pytest.raises(hadar.HadarError, match="var_added.nu: band 0 is at"):
        hadar.window_information(named(CUBE, "nu"), (3, 3), var_added=elsewhere)


@pytest.mark.parametrize("places", [FALLING, SHUFFLED], ids=["falling", "shuffled"])
def test_pandas_labels_decide_as_coordinates_do(places):
    pixels = CUBE.reshape(-1, NU.size)
    same(decompose(framed(pixels, places), framed(LIBRARY, places), framed(LIGHT, places)), decompose(pixels))
    written = framed(pixels, places)
    written.columns = [f"{nu!r}" for nu in NU[places].tolist()]
    same(decompose(written), decompose(pixels))
    turned = [framed(one, places) for one in LIBRARY]
    assert hadar.local(*turned, SCENE).distance == hadar.local(*LIBRARY, SCENE).distance
    assert np.array_equal(hadar.matrix(turned, SCENE), hadar.matrix(LIBRARY, SCENE))
    plain = hadar.window_information(CUBE, (3, 3), var_added=VAR).full
    for cube in (CUBE, named(CUBE, "wl", places=places)):
        found = hadar.window_information(cube, (3, 3), var_added=framed(VAR, places)).full
        np.testing.assert_allclose(found, plain, rtol=1e-12)


def test_an_index_that_pandas_made_is_none_and_one_of_other_numbers_is_refused():
    for index in (None, [f"b{i}" for i in range(NU.size)], NU, np.round(NU)):
        given = pandas.Series(TILTED, index=index)
        assert hadar.local(LIBRARY[0], given, SCENE).distance == hadar.local(*LIBRARY, SCENE).distance
    with pytest.raises(hadar.HadarError, match=r"alternative.index: .*give alternative.to_numpy\(\)"):
        hadar.local(LIBRARY[0], pandas.Series(TILTED, index=1e4 / NU), SCENE)


def test_spectra_at_the_nodes_of_ranges_have_labels_too():
    scene = hadar.Scene(np.stack([NU - 20.0, NU + 20.0], 1), 310.15, [0.5], [293.15])
    one, other = (np.interp(scene.nodes, NU, each) for each in LIBRARY)
    turned = pandas.Series(other, index=scene.nodes)[::-1]
    assert hadar.local(one, turned, scene).distance == hadar.local(one, other, scene).distance


@pytest.mark.parametrize("places", [FALLING, SHUFFLED], ids=["falling", "shuffled"])
def test_bands_that_are_left_out_are_those_of_the_cube(places):
    spoilt = np.where(np.arange(NU.size) == 2, 3 * CUBE, CUBE)
    expected, mask = decompose(spoilt, bad_bands=[2]), np.arange(NU.size) == 2
    turned = named(spoilt, "band", places=places)
    place = int(np.flatnonzero(places == 2)[0])
    other = SHUFFLED[::-1]
    for bad in ([place], mask[places], mask[places].tolist(), xarray.DataArray(mask[places]), pandas.Series(mask[places])):
        same(decompose(turned, bad_bands=bad), expected)
    for bad in (named(mask, "band", places=other), named(mask, "wl", places=other), framed(mask, other)):
        same(decompose(turned, bad_bands=bad), expected)
        same(decompose(spoilt, bad_bands=bad), expected)
    for bad in ([place], named(mask, "wl", places=other)):
        chunked = hadar.dask.decompose(turned.chunk(y=6), LIBRARY, LIGHT, NU, counts_per_radiance=KAPPA, bad_bands=bad).compute()
        np.testing.assert_array_equal(chunked.temperature_k, expected.temperature_k)
    with pytest.raises(hadar.HadarError, match="bad_bands: 12 of 12 bands"):
        decompose(turned, bad_bands=[12])
    rows = [turned[row] for row in range(6)]
    same(decompose(rows, bad_bands=[place]), expected)
    with pytest.raises(hadar.HadarError, match="in different orders"):
        decompose([rows[0], *(named(spoilt, "band")[1:])], bad_bands=[place])


def test_counted_labels_agree_among_themselves():
    count = np.arange(NU.size) + 1
    both = {"band": ("band", count), "nu": ("band", NU, {"units": "cm^-1"})}
    turned = xarray.DataArray(CUBE, dims=("y", "x", "band"), coords=both).isel(band=SHUFFLED)
    var = xarray.DataArray(VAR, dims="band", coords={"band": count}).isel(band=FALLING)
    plain = hadar.window_information(CUBE, (3, 3), var_added=VAR).full
    for cube in (CUBE, turned, turned.drop_vars("nu")):
        np.testing.assert_allclose(hadar.window_information(cube, (3, 3), var_added=var).full, plain, rtol=1e-12)
    chunked = hadar.dask.window_information(turned.chunk(y=3), (3, 3), var_added=var).compute()
    np.testing.assert_allclose(chunked.full, plain, rtol=1e-12)


@pytest.mark.parametrize("band", ["band", "wavelength", "nu", "Channel", "spectral"])
def test_dimensions_are_told_by_their_names_whatever_the_sizes(band):
    square, counts = CUBE[:, :6], np.random.default_rng(0).uniform(1e3, 1e4, (12, 12, 12))
    plain = hadar.window_information(counts, (3, 5)).full
    for dims in [(band, "y", "x"), ("y", band, "x"), ("x", band, "y"), ("x", "y", band), ("lines", "samples", band)]:
        rows = next(dim for dim in dims if dim in ("y", "lines"))
        columns = next(dim for dim in dims if dim in ("x", "samples"))
        whole = xarray.DataArray(square, dims=(rows, columns, band)).transpose(*dims)
        same(decompose(whole), decompose(square))
        turned = xarray.DataArray(counts, dims=(rows, columns, band)).transpose(*dims)
        np.testing.assert_array_equal(hadar.window_information(turned, (3, 5)).full, plain)
    library = xarray.DataArray(LIBRARY, dims=("material", band)).transpose()
    same(decompose(library=library), decompose())
    for dims in [("a", "b", "c"), ("y", "x", "other")]:
        same(decompose(xarray.DataArray(CUBE, dims=dims)), decompose())
