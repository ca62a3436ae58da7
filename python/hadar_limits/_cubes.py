"""Heat cubes: taken apart, and what their windows tell of depth."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from hadar_limits import _hadar
from hadar_limits._order import as_cube_has, bands_last, in_order, left_out
from hadar_limits._types import DecomposeOptions, Numbers, WindowOptions

#: The material of a pixel that has none.
NO_MATERIAL = 65535

#: Bits of :attr:`Maps.flags`.
FLAGS = {
    "temperature-at-limit": 1,
    "lighting-at-limit": 2,
    "no-information": 4,
    "lighting-unknown": 8,
    "no-fit": 16,
    "undecided": 32,
    "skipped": 64,
    "temperature-unknown": 128,
}


class _Arrays:
    """Arrays by name."""

    def to_dict(self) -> dict[str, NDArray[Any]]:
        """The arrays by their names."""
        return {field.name: getattr(self, field.name) for field in fields(self) if getattr(self, field.name) is not None}

    def __repr__(self) -> str:
        each = ", ".join(f"{name} {value.dtype}{list(value.shape)}" for name, value in self.to_dict().items())
        return f"{type(self).__name__}({each})"


@dataclass(frozen=True, repr=False, eq=False)
class Maps(_Arrays):
    """What is found of every pixel; each array has the shape of the cube without its bands."""

    #: Place in the library of the most probable material, u16; :data:`NO_MATERIAL` where nothing tells.
    material: NDArray[np.uint16]
    #: Its temperature, K, f32; NaN where the pixel was left out or emits nothing.
    temperature_k: NDArray[np.float32]
    #: Deviation of it, K, were the material certain and right.
    temperature_sigma_k: NDArray[np.float32]
    #: Thermal lighting factors, with a last axis of the surroundings; NaN where they are unknown (:data:`FLAGS`).
    lighting: NDArray[np.float32]
    #: Probability of a larger residual, were the material right.
    p_value: NDArray[np.float32]
    #: Posterior probability of the material.
    posterior: NDArray[np.float32]
    #: Materials that 95 % of the posterior leave, u16.
    candidates: NDArray[np.uint16]
    #: What is said of the pixel, u8; bits of :data:`FLAGS`.
    flags: NDArray[np.uint8]


@dataclass(frozen=True, repr=False, eq=False)
class Windows(_Arrays):
    """Fisher information about x of every window, pixel⁻², at its centre; NaN where no window fits. None where not asked for."""

    #: Photons of the window.
    photons: NDArray[np.float64]
    #: Pixels and bands apart: a heat cube.
    full: NDArray[np.float64] | None = None
    #: Pixels apart, bands together: a thermal image.
    spatial: NDArray[np.float64] | None = None
    #: Bands apart, pixels together.
    spectral: NDArray[np.float64] | None = None
    #: All photons counted together.
    total: NDArray[np.float64] | None = None


def decompose(cube: Numbers, library: Numbers, light: Numbers, bands: Numbers, **options: Unpack[DecomposeOptions]) -> Maps:
    """Material, temperature and lighting of every pixel of a heat cube, by maximum likelihood.

    A pixel sends S = e·B(T) + (1 − e)·Σ V S_k: material of the library, temperature T, and how much V of each of its
    surroundings' spectra S_k it scatters.

    Parameters
    ----------
    cube : (rows, columns, bands) or (pixels, bands) or (bands,), f32 or f64
        Counts; NaN is missing. Read where it lies, whatever its strides.
    library : (materials, nodes)
        Emissivities at the nodes of the bands: at their centres if ``bands`` are centres.
    light : (surroundings, nodes)
        Spectra of the surroundings, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹, at most seven; ``()`` is deep space. With
        ``light_in_counts=True`` (surroundings, bands): counts of a pixel that sees nothing else.
    bands : (bands,) or (bands, 2)
        Ascending centres, or lower and upper ends, cm⁻¹.
    counts_per_radiance : number or (bands,)
        Counts for each unit of a band's signal, m² sr s: étendue × efficiency × time.
    var_added : number or (bands,)
        Variance of electronic noise, counts²; none where silent.
    units_per_count : number
        What one count is in the unit of the cube; 1 where samples are counts.
    temperature_range : (low, high)
        Temperatures that a target may have, K; 200 to 400 where silent.
    lighting_total : number
        ΣV where it is known; else it is at most 1.
    gain : bool
        Whether the overall scale is unknown.
    bad_bands : list of int, or truth values (bands,)
        Bands that are left out, counted from 0 as the cube has them, or a mask of them.
    prior : (materials,)
        Prior probabilities of the materials, in any scale; equal where silent.
    emissivity_error : (relative, correlation)
        Root mean square error of the library as a share of the emissivity, and its correlation length, cm⁻¹.
    method : {"ml", "te", "analytic-inverse", "grey-body"}
    potts : (weight, step in K or None), tex_sgd : weight
        A prior over the image; pixels are each for themselves where silent.
    skipping : bool
        Whether materials that a bound excludes are left out; the answer is the same.
    threads : int
        All cores where silent; the answer does not depend on it.
    progress : callable
        Called with (rows done, rows) now and then; what it raises ends the call.

    Arrays of xarray and pandas may have their dimensions and bands in any order. Which dimension is which is said by its name (``y``,
    ``x``, ``band`` and what else they are called), else the bands are last. Where bands are is said by a coordinate over them (that of
    their dimension, or another with a spectral unit in ``attrs["units"]``), or by an index or columns in cm⁻¹; it must be that of
    ``bands``, each within half its width. Values without such labels are in the order of ``bands``.

    Source: paper S44, S48; as ``hadar decompose``.
    """
    cube = bands_last(cube)
    if "bad_bands" in options:
        options["bad_bands"] = left_out(options["bad_bands"], cube, bands)
    cube = in_order(cube, bands, "cube")
    library = in_order(library, bands, "library", at_nodes=True)
    light = in_order(light, bands, "light", at_nodes=not options.get("light_in_counts"))
    for name in ("counts_per_radiance", "var_added"):
        if name in options:
            options[name] = in_order(options[name], bands, name)
    return Maps(**_hadar.decompose(cube, library, light, bands, **options))


def window_information(cube: Numbers, window: tuple[int, int] = (5, 5), **options: Unpack[WindowOptions]) -> Windows:
    """Fisher information about the x position of every window of a heat cube, pixel⁻² (paper S37–S40, Tables S4, S5).

    Parameters
    ----------
    cube : (rows, columns, bands), f32 or f64
        Expected counts; noise in them adds texture that is not there.
    window : (rows, columns)
        Odd numbers of pixels.
    cells : list of {"full", "spatial", "spectral", "total"}
        What is computed; ``["full"]`` where silent.
    derivative : {"central", "simoncelli", "cubic-spline", "fourier"}
    var_added : number or (bands,)
        Variance of electronic noise of a sample, counts².
    joined : {"sum-of-readings", "one-reading"}
        What the electronic noise of joined samples is.
    threads : int

    Dimensions and bands of arrays of xarray and pandas are told by their labels, as of :func:`decompose`.
    """
    cube = bands_last(cube)
    if "var_added" in options:
        options["var_added"] = as_cube_has(options["var_added"], cube, None, "var_added")
    return Windows(**_hadar.window_information(cube, window, **options))
