"""Quantities of other libraries: converted where they mean the same, refused by their name, never stripped."""

import astropy.units as u
import numpy as np
import pandas
import pint
import pytest
import xarray

import hadar_limits as hadar

NU = np.linspace(800.0, 1250.0, 12)
E = np.linspace(0.95, 0.98, 12)
UR = pint.UnitRegistry()


def scene(temperature=310.15, environment=(293.15,), bands=NU, **more):
    return hadar.Scene(bands, temperature, [0.5], environment, **more)


def same(one, other):
    return np.allclose(one.signal(E), other.signal(E), rtol=1e-12, atol=0.0)


@pytest.mark.parametrize(
    "environment",
    [
        np.array([20.0]) * u.deg_C,
        [293.15] * u.K,
        UR.Quantity(np.array([20.0]), "degC"),
        UR.Quantity(np.array([68.0]), "degF"),
        UR.Quantity(np.array([293.15]), "kelvin"),
        xarray.DataArray([20.0], attrs={"units": "degC"}),
        xarray.DataArray([20.0], attrs={"units": "degrees_celsius"}),
        xarray.DataArray([293.15], attrs={"units": "K"}),
        xarray.DataArray([293.15]),
        xarray.DataArray(UR.Quantity(np.array([20.0]), "degC")),
    ],
    ids=repr,
)
def test_temperatures_are_converted(environment):
    assert same(scene(environment=environment), scene())


def test_a_number_has_a_unit_too():
    assert same(scene(37.0 * u.deg_C), scene())
    assert same(scene(UR.Quantity(37.0, "degC")), scene())
    assert same(scene(xarray.DataArray(37.0, attrs={"units": "degC"})), scene())
    ranged = scene(temperature_range=[0.0, 60.0] * u.deg_C)
    assert same(ranged, scene(temperature_range=(273.15, 333.15)))


@pytest.mark.parametrize(
    "bands",
    [
        NU / u.cm,
        (1e4 / NU) * u.um,
        (1e7 / NU) * u.nm,
        (NU * 29.9792458e9) * u.Hz,
        UR.Quantity(NU, "1/cm"),
        UR.Quantity(1e4 / NU, "micrometer"),
        xarray.DataArray(NU, attrs={"units": "cm-1"}),
        xarray.DataArray(1e4 / NU, attrs={"units": "um"}),
    ],
    ids=lambda value: str(getattr(value, "unit", None) or getattr(value, "units", None)),
)
def test_wavenumbers_are_converted(bands):
    assert same(scene(bands=bands), scene())
    assert np.allclose(hadar.planck(bands, 300.0), hadar.planck(NU, 300.0), rtol=1e-12, atol=0.0)
    assert np.allclose(hadar.emissivity("skin", bands), hadar.emissivity("skin", NU), rtol=1e-9, atol=0.0)


@pytest.mark.parametrize(
    ("what", "call"),
    [
        ("temperature", lambda: scene(310.0 * u.m)),
        ("environment", lambda: scene(environment=np.array([20.0]) * u.s)),
        ("environment", lambda: scene(environment=UR.Quantity(np.array([20.0]), "delta_degC"))),
        ("environment", lambda: scene(environment=xarray.DataArray([20.0], attrs={"units": "furlong"}))),
        ("environment", lambda: scene(environment=[UR.Quantity(20.0, "degC")])),
        ("bands", lambda: scene(bands=NU * u.kg)),
        ("nu", lambda: hadar.planck(NU * u.K, 300.0)),
        ("temperature", lambda: hadar.planck(NU, 300.0 / u.cm)),
        ("emissivity", lambda: scene().signal(E * u.m)),
        ("radiance", lambda: hadar.brightness_temperature(NU, np.ones(12) * u.W)),
        ("counts_per_radiance", lambda: scene(counts_per_radiance=xarray.DataArray(1e-12, attrs={"units": "m2"}))),
        ("cube", lambda: hadar.window_information(xarray.DataArray(np.ones((9, 9, 3)), attrs={"units": "W m-2 sr-1 um-1"}))),
        ("lighting", lambda: hadar.Scene(NU, 310.0, np.array([0.5]) * u.K, [293.0])),
    ],
)
def test_what_means_something_else_is_refused(what, call):
    with pytest.raises(hadar.HadarError, match=what):
        call()


@pytest.mark.parametrize(
    ("what", "call"),
    [
        ("temperature: the unit `C`", lambda: scene(37.0 * u.C)),
        ("temperature: the unit `F`", lambda: scene(98.6 * u.F)),
        ("temperature: the unit `coulomb`", lambda: scene(UR.Quantity(37.0, "C"))),
        ("temperature: the unit `farad`", lambda: scene(UR.Quantity(98.6, "F"))),
        ("temperature: the unit `k`", lambda: scene(xarray.DataArray(310.0, attrs={"units": "k"}))),
        ("nu: the unit `Mm`", lambda: hadar.planck(xarray.DataArray(NU, attrs={"units": "Mm"}), 300.0)),
        ("nu: the unit `rad / s`", lambda: hadar.planck(NU * u.rad / u.s, 300.0)),
        ("nu: the unit `radian / second`", lambda: hadar.planck(UR.Quantity(NU, "radian/second"), 300.0)),
        ("nu: the unit `revolutions_per_minute`", lambda: hadar.planck(UR.Quantity(NU, "rpm"), 300.0)),
        ("cube: the unit `cT`", lambda: hadar.window_information(np.ones((9, 9, 3)) * u.cT)),
        ("cube: the unit `Ph`", lambda: hadar.window_information(np.ones((9, 9, 3)) * u.Ph)),
        ("temperature: a list of quantities", lambda: hadar.planck(NU, [300.0] * 11 + [20.0 * u.deg_C])),
        ("lighting_total: the unit `m`", lambda: scene(lighting_total=xarray.DataArray(0.5, attrs={"units": "m"}))),
    ],
)
def test_letters_keep_their_case(what, call):
    with pytest.raises(hadar.HadarError, match=what):
        call()


def test_quantities_are_converted_by_their_own_library():
    assert same(scene(310150.0 * u.mK), scene())
    assert same(scene(np.float32(310.15) * u.K), scene(float(np.float32(310.15))))
    assert same(scene(UR.Quantity(310150, "millikelvin")), scene())
    assert same(scene(lighting_total=xarray.DataArray(50.0, attrs={"units": "percent"})), scene(lighting_total=0.5))
    expected = hadar.planck(NU, 300.0)
    for given in (1e-8 / NU * u.Mm, (1e8 / NU) * u.AA, UR.Quantity(1e8 / NU, "angstrom"), UR.Quantity(0.1 * NU, "1/mm")):
        assert np.allclose(hadar.planck(given, 300.0), expected, rtol=1e-11, atol=0.0)
    with pytest.raises(hadar.HadarError, match="the unit `delta_degree_Celsius`"):
        hadar.planck(NU, UR.Quantity(np.full(12, 20.0), "delta_degC"))
    for pair in (2.0 * u.K, 2000.0 * u.mK, UR.Quantity(2.0, "delta_degC")):
        scene(priors={"temperature": pair})


def test_pairs_of_a_decomposition_have_units():
    light, library = hadar.planck(NU, 290.0), [E, np.linspace(0.9, 0.6, len(NU))]
    cube = 1e-12 * np.gradient(NU) * hadar.planck(NU, np.array([[310.0, 311.0], [312.0, 313.0]])[..., None])

    def apart(**more):
        return hadar.decompose(cube, library, [light], NU, counts_per_radiance=1e-12, **more).p_value

    stated = apart(emissivity_error=(1.0 * u.percent, 50.0 / u.cm))
    assert np.array_equal(stated, apart(emissivity_error=(0.01, 50.0)))
    assert np.array_equal(apart(potts=(1.0, 2.0 * u.K)), apart(potts=(1.0, 2.0)))
    for wrong, message in [
        (dict(emissivity_error=(0.01, 0.5 * u.um)), r"emissivity_error\[1\]: the unit `um`"),
        (dict(emissivity_error=(1.0 * u.K, 50.0)), r"emissivity_error\[0\]: the unit `K`"),
        (dict(emissivity_error=0.01), r"emissivity_error: 0.01; give \(share"),
        (dict(emissivity_error=(0.01,)), "emissivity_error: a value of type tuple; give"),
        (dict(potts=(1.0, 2.0 * u.deg_C)), r"potts\[1\]: the unit `deg_C`"),
        (dict(potts=1.0), r"potts: 1.0; give \(weight"),
        (dict(threads=-1), "threads: -1; give a whole number"),
        (dict(threads="2"), "threads: '2'; give a whole number"),
    ]:
        with pytest.raises(hadar.HadarError, match=message):
            apart(**wrong)


def test_a_prior_is_a_difference():
    plain = scene(priors={"temperature": 2.0})
    pair = [hadar.local(E, E - 0.01, one).distance for one in (plain, scene(priors={"temperature": 2.0 * u.K}))]
    assert pair[0] == pair[1]
    for wrong in (2.0 * u.deg_C, xarray.DataArray(2.0, attrs={"units": "degF"})):
        with pytest.raises(hadar.HadarError, match="priors.temperature"):
            scene(priors={"temperature": wrong})


def test_what_is_missing_stays_missing():
    masked = UR.Quantity(np.ma.masked_array([20.0], [True]), "degC")
    with pytest.raises(hadar.HadarError, match="masked"):
        scene(environment=masked)


def test_what_falls_is_refused_and_not_taken():
    with pytest.raises(hadar.HadarError, match="do not ascend"):
        scene(bands=np.sort(1e4 / NU) * u.um)


def test_shares_and_counts():
    assert same(scene(environment=pandas.Series([293.15])), scene())
    percent = hadar.Scene(NU, 310.15, np.array([50.0]) * u.percent, [293.15])
    assert same(percent, scene())
    cube = np.random.default_rng(1).poisson(500, (9, 9, 3)).astype(float)
    plain = hadar.window_information(cube).full
    for counted in (cube * u.ct, xarray.DataArray(cube, attrs={"units": "photons"}), xarray.DataArray(cube)):
        assert np.array_equal(hadar.window_information(counted).full, plain, equal_nan=True)


def test_a_band_that_is_not_there_is_no_bad_band():
    light = hadar.planck(NU, 290.0)
    with pytest.raises(hadar.HadarError, match="bad_bands: 33 of 12 bands"):
        hadar.decompose(np.ones(12), [E], [light], NU, counts_per_radiance=1e-12, bad_bands=[33])


def backwards(values):
    coordinate = {"wavelength": ("wavelength", 1e4 / NU[::-1], {"units": "um"})}
    dims = ("row", "wavelength")[2 - np.ndim(values) :]
    return xarray.DataArray(np.asarray(values)[..., ::-1], coords=coordinate, dims=dims)


def test_coordinates_say_the_order_in_every_argument():
    tilted = np.linspace(0.9, 0.6, len(NU))
    var = np.linspace(1e4, 9e4, len(NU))
    own = np.linspace(0.7, 0.95, len(NU))[None]

    def with_counts(var, own):
        return scene(counts_per_radiance=1e-12, var_added=var, environment_emissivity=own)

    plain, turned = with_counts(var, own), with_counts(backwards(var), backwards(own))
    assert np.array_equal(turned.signal(backwards(tilted)), plain.signal(tilted))
    for ask in (hadar.local, hadar.nearest):
        assert ask(backwards(E), backwards(tilted), turned).distance == ask(E, tilted, plain).distance
    library = np.stack([E, tilted])
    expected = hadar.matrix(library, plain)
    assert np.array_equal(hadar.matrix(backwards(library), turned), expected)
    assert np.array_equal(hadar.matrix([backwards(one) for one in library], turned), expected)
    light, kappa = hadar.planck(NU, 290.0), np.linspace(1e-12, 3e-12, len(NU))
    cube = kappa * np.gradient(NU) * hadar.planck(NU, 310.0)
    said = {"counts_per_radiance": kappa, "var_added": var}
    found = hadar.decompose(cube, library, [light], NU, **said)
    again = hadar.decompose(
        backwards(cube[None]), backwards(library), backwards(light[None]), NU, **{key: backwards(each) for key, each in said.items()}
    )
    assert np.array_equal(np.ravel(again.temperature_k), np.ravel(found.temperature_k))
    elsewhere = backwards(E).assign_coords(wavelength=("wavelength", 1e4 / NU[::-1] + 1.0, {"units": "um"}))
    with pytest.raises(hadar.HadarError, match="wavelength: band 11 is at"):
        hadar.local(elsewhere, tilted, plain)


def test_bands_are_left_out_by_places_or_a_mask():
    light, library = hadar.planck(NU, 290.0), [E, np.linspace(0.9, 0.6, len(NU))]
    cube = 1e-12 * np.gradient(NU) * hadar.planck(NU, 310.0)
    cube[5] *= 1.5

    def apart(bad):
        return hadar.decompose(cube, library, [light], NU, counts_per_radiance=1e-12, bad_bands=bad)

    expected = apart([5]).temperature_k
    mask = np.arange(len(NU)) == 5
    for bad in (np.array([5]), mask, mask.tolist()):
        assert apart(bad).temperature_k == expected
    assert apart([]).temperature_k == apart(None).temperature_k != expected
    for wrong in ([-1], [True], [0.5], ["5"], [10**30]):
        with pytest.raises(hadar.HadarError, match="bad_bands"):
            apart(wrong)
    with pytest.raises(hadar.HadarError, match="counts_per_radiance: no number but a value of type ndarray"):
        scene(counts_per_radiance=np.full(len(NU), 1e-12))
    with pytest.raises(hadar.HadarError, match="array of bool"):
        hadar.decompose(cube > 0, library, [light], NU, counts_per_radiance=1e-12)


def test_a_scenario_has_quantities_too():
    said = {"target": {"material": "skin", "temperature": "37 degC"}, "alternatives": {"materials": ["aluminium"]}}
    for temperature in (37.0 * u.deg_C, UR.Quantity(37.0, "degC"), 310.15 * u.K):
        other = {**said, "target": {"material": "skin", "temperature": temperature}}
        found = hadar.size(other)
        assert abs(found.pairs[0].distance_nearest / hadar.size(said).pairs[0].distance_nearest - 1) < 1e-9
    with pytest.raises(hadar.HadarError, match="target.temperature"):
        hadar.size({**said, "target": {"material": "skin", "temperature": 37.0 * u.m}})


def test_a_length_is_one_in_any_unit_of_it():
    said = {"target": {"material": "skin", "temperature": "37 degC"}, "alternatives": {"materials": ["aluminium"]}}

    def distance(given):
        scenario = {**said, "target": {**said["target"], "distance": given}, "camera": {"preset": "flir-a325sc"}}
        return hadar.size(scenario).verdict.lower

    expected = distance("30 m")
    assert distance("3 km") != expected
    metres = [30.0 * u.m, 0.03 * u.km, 3000.0 * u.cm, 3e-5 * u.Mm, 3e10 * u.nm]
    metres += [UR.Quantity(*each) for each in ((30, "m"), (0.03, "km"), (3000, "cm"), (30 / 0.3048, "foot"), (3e-5, "Mm"))]
    metres += [xarray.DataArray(30.0, attrs={"units": unit}) for unit in ("m", "meter")]
    for given in metres:
        assert abs(distance(given) / expected - 1) < 1e-9, given
    for wrong in (37.0 * u.C, UR.Quantity(37.0, "C"), UR.Quantity(37.0, "delta_degC"), xarray.DataArray(30.0, attrs={"units": "Mm"})):
        with pytest.raises(hadar.HadarError, match="is not a unit of length"):
            distance(wrong)
