"""Beyond one machine: sweeps of scenarios and large heat cubes on the workers of Dask.

Every task takes one thread, so that a worker needs one: ``LocalCluster(threads_per_worker=1)`` on a machine, the like on many.
Tasks know nothing of each other, and the same task gives the same bits wherever it runs: a worker that is lost loses what it
was at, which Dask has done again, and nothing else.

* :func:`sweep`: a question over a grid of scenarios, as delayed tasks, a bag, or an xarray dataset;
* :func:`decompose`: material, temperature and lighting of a cube in chunks;
* :func:`window_information`: what its windows tell of depth.

Needs ``pip install "hadar-limits[dask]"``.
"""

from __future__ import annotations

import copy
import itertools
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

try:
    import dask
    import dask.array
    import dask.array.overlap
    import dask.bag
    import xarray
except ImportError as error:
    raise ImportError(f'hadar_limits.dask needs {error.name}: pip install "hadar-limits[dask]"') from error

import hadar_limits as hadar
from hadar_limits import _hadar
from hadar_limits._order import as_cube_has, in_order, left_out, order_of, taken
from hadar_limits._types import Cell, DecomposeOptions, Derivative, NoiseOptions, Numbers

#: Fields of a decomposition: type, unit, what it is.
_MAPS = {
    "material": ("u2", "", "place in the library of the most probable material"),
    "temperature_k": ("f4", "K", "temperature"),
    "temperature_sigma_k": ("f4", "K", "deviation of the temperature"),
    "p_value": ("f4", "", "probability of a larger residual"),
    "posterior": ("f4", "", "posterior probability of the material"),
    "candidates": ("u2", "", "materials that 95 % of the posterior leave"),
    "flags": ("u1", "", "bits of hadar.FLAGS"),
    "lighting": ("f4", "", "thermal lighting factor"),
}


def _described(values: xarray.DataArray, unit: str, meaning: str) -> xarray.DataArray:
    values.attrs = {"long_name": meaning} | ({"units": unit} if unit else {})
    return values


#: Columns at either end without a derivative, of those that do not take whole rows.
_MARGINS = {"central": 1, "simoncelli": 2}


# Sweeps


@dataclass(frozen=True)
class Axis:
    """A key of the scenario and the values that it takes.

    ``key``: ``"target.temperature"``, ``"environment.0.lighting"``. ``unit``: written behind each number
    (``"degC"``); none for shares and names.
    """

    key: str
    values: Sequence[Any] | NDArray[Any]
    unit: str = ""

    def written(self, index: int) -> Any:
        value = self.values[index]
        value = value.item() if hasattr(value, "item") else value
        return f"{value!r} {self.unit}" if self.unit else value


@dataclass(frozen=True)
class Sweep:
    """A question at every point of a grid, not yet asked."""

    axes: dict[str, Axis]
    read: dict[str, tuple[str, str]]
    tasks: list[Any]

    @property
    def shape(self) -> tuple[int, ...]:
        """Points along each axis."""
        return tuple(len(axis.values) for axis in self.axes.values())

    def to_bag(self) -> dask.bag.Bag:
        """One dict for each point, in the order of the grid."""
        return dask.bag.from_delayed(self.tasks)

    def compute(self, **options: Any) -> xarray.Dataset:
        """Asks, on the client that is there or by ``scheduler=``: numbers over the axes, with their units.

        What an answer does not have is NaN. ``error`` is the message of a point that has no answer, else empty; if there is none that
        has, the first message is raised.
        """
        points = list(itertools.chain.from_iterable(dask.compute(*self.tasks, **options)))
        errors = [point["error"] for point in points if point["error"]]
        if errors and len(errors) == len(points):
            raise hadar.HadarError(f"none of the {len(points)} points has an answer; the first: {errors[0]}")
        if errors:
            told = f"{len(errors)} of {len(points)} points have no answer, why is in `error`; the first: {errors[0]}"
            warnings.warn(told, stacklevel=2)
        coordinates = {
            name: xarray.Variable(name, np.asarray(axis.values), {"key": axis.key} | ({"units": axis.unit} if axis.unit else {}))
            for name, axis in self.axes.items()
        }
        found = {}
        for name, (path, unit) in self.read.items():
            values = [point[name] for point in points]
            if any(isinstance(value, str) for value in values):
                values = np.array(["" if value is None else value for value in values], dtype=object)
            else:
                values = np.array([np.nan if value is None else value for value in values], dtype=float)
            attributes = {"key": path} | ({"units": unit} if unit else {})
            found[name] = xarray.Variable(tuple(self.axes), values.reshape(self.shape), attributes)
        errors = np.array([point["error"] for point in points], dtype=object)
        found["error"] = xarray.Variable(tuple(self.axes), errors.reshape(self.shape), {"long_name": "why a point has no answer"})
        return xarray.Dataset(found, coordinates, {"hadar": hadar.__version__})


def sweep(
    question: Callable[..., hadar.Result],
    scenario: Mapping[str, Any],
    axes: Mapping[str, Axis],
    read: Mapping[str, tuple[str, str]],
    *,
    batch: int = 1,
    **options: Any,
) -> Sweep:
    """A question over a grid of scenarios.

    Parameters
    ----------
    question : hadar.size, hadar.identify, ...
    scenario : dict
        What all points share; relative paths in it start from the folder of the worker: write full ones.
    axes : {name: Axis}
        What varies, by the names of the dimensions.
    read : {name: (path, unit)}
        What is kept of an answer: ``"pairs.0.distance_nearest"``, a path in its JSON. Nothing else is moved. Beside it is ``error``:
        a point that cannot be answered leaves the others as they are.
    batch : int
        Points of a task: enough that a task takes longer than the scheduler, some milliseconds.
    options
        Those of the question; every task has one thread.

    >>> sweep = hadar.dask.sweep(
    ...     hadar.identify, scenario,
    ...     {"temperature": Axis("target.temperature", np.arange(300.0, 320.0), "K")},
    ...     {"distance": ("pairs.0.distance_nearest", "photon^-1/2")},
    ... )
    >>> sweep.compute().distance.plot()
    """
    axes, read = dict(axes), dict(read)
    places = list(itertools.product(*(range(len(axis.values)) for axis in axes.values())))
    if "error" in read or "error" in axes:
        raise hadar.HadarError("`error` in a sweep is why a point has no answer; take another name")
    if batch < 1:
        raise hadar.HadarError(f"batch is {batch}; it must be at least 1")
    ask = dask.delayed(_ask, pure=True, traverse=False)
    tasks = []
    for first in range(0, len(places), batch):
        written = [
            [(axis.key, axis.written(i)) for axis, i in zip(axes.values(), place, strict=True)]
            for place in places[first : first + batch]
        ]
        tasks.append(ask(question, dict(scenario), written, read, options))
    return Sweep(axes, read, tasks)


def _ask(question, scenario, points, read, options):
    found = []
    for point in points:
        try:
            asked = copy.deepcopy(scenario)
            for key, value in point:
                _put(asked, key, value)
            answer = question(asked, **({"threads": 1} | options)).to_dict()
            row = {name: _at(answer, path) for name, (path, _) in read.items()}
        except Exception as error:
            # One point must not take the others with it.
            message = str(error) if isinstance(error, hadar.HadarError) else f"{type(error).__name__}: {error}"
            found.append(dict.fromkeys(read) | {"error": message})
        else:
            found.append(row | {"error": ""})
    return found


def _put(table: Any, key: str, value: Any) -> None:
    *above, last = key.split(".")
    try:
        for name in above:
            table = table[int(name)] if isinstance(table, list) else table.setdefault(name, {})
        table[int(last) if isinstance(table, list) else last] = value
    except (AttributeError, IndexError, TypeError, ValueError):
        raise hadar.HadarError(f"{key}: there is no such place in the scenario") from None


def _at(answer: Any, path: str) -> Any:
    for name in path.split("."):
        if answer is None:
            return None
        try:
            answer = answer[int(name)] if isinstance(answer, list) else answer[name]
        except (KeyError, IndexError, ValueError):
            known = f"{len(answer)} entries" if isinstance(answer, list) else ", ".join(answer)
            raise hadar.HadarError(f"{path}: there is no `{name}` in the answer; there is {known}") from None
    return answer


# Cubes


def _array(cube: Any, dims: tuple[str, str, str]) -> xarray.DataArray:
    if isinstance(cube, xarray.DataArray):
        missing = [dim for dim in dims if dim not in cube.dims]
        if missing or cube.ndim != 3:
            raise hadar.HadarError(f"a cube over {cube.dims}; name its rows, columns and bands with dims={dims}")
        # Blocks know no unit.
        _hadar.plain(xarray.DataArray(0.0, attrs=cube.attrs) if cube.chunks else cube[:1, :1, :1], "cube", "counts")
        return cube.transpose(*dims)
    # What has a unit or a mask would lose it here.
    if type(cube) not in (np.ndarray, np.memmap, dask.array.Array):
        cube = _hadar.plain(cube, "cube", "counts")
    return xarray.DataArray(cube, dims=dims)


def _over_edges(function, data, depth, channels, **fixed):
    """A function of chunks that see so many rows and columns of their neighbours; a last axis of other channels."""
    depth = {0: min(depth[0], data.shape[0]), 1: min(depth[1], data.shape[1]), 2: 0}
    wide = dask.array.overlap.overlap(data, depth=depth, boundary="none")
    chunks, nothing = (*wide.chunks[:2], (channels,)), np.empty((0, 0, 0))
    found = wide.map_blocks(function, dtype="f8", chunks=chunks, meta=nothing, **fixed)
    return dask.array.overlap.trim_internal(found, depth, boundary="none")


def decompose(
    cube: Any,
    library: Numbers,
    light: Numbers,
    bands: Numbers,
    *,
    dims: tuple[str, str, str] = ("y", "x", "band"),
    names: Sequence[str] | None = None,
    overlap: int = 32,
    **options: Unpack[DecomposeOptions],
) -> xarray.Dataset:
    """:func:`hadar_limits.decompose` of a cube in chunks, lazily.

    Parameters
    ----------
    cube : xarray.DataArray, dask array or array of (rows, columns, bands)
        All bands of a pixel are put into one chunk.
    library, light, bands, options
        As :func:`hadar_limits.decompose`, whose rules of labels hold here too; every task has one thread.
    dims : names of rows, columns and bands
    names : names of the library's materials, kept with the answer
    overlap : int
        Pixels around each chunk that a prior over the image (``potts``, ``tex_sgd``) sees too. It is one of the whole image: what
        lies further away than this is not seen, and near the edges of chunks a few pixels may differ from the answer in one piece.
        A ``potts`` step is not estimated, chunk by chunk another one, but must be given.

    Returns
    -------
    xarray.Dataset
        The maps of :class:`hadar_limits.Maps` with their units; ``lighting`` also over ``surroundings``. Without a prior over the image
        those of the whole cube, but for rounding: where fits start is laid out for the mean of a chunk. The same chunks give the
        same bits.
    """
    bands = _hadar.plain(bands, "bands", "cm^-1")
    data = _array(cube, dims)
    if "bad_bands" in options:
        options["bad_bands"] = left_out(options["bad_bands"], data, bands, dims[2])
    data = taken(data, order_of(data, bands, "cube", dim=dims[2]), dims[2])
    in_counts = bool(options.get("light_in_counts"))
    library = _hadar.plain(in_order(library, bands, "library", at_nodes=True), "library", "1")
    light = _hadar.plain(in_order(light, bands, "light", at_nodes=not in_counts), "light", "counts" if in_counts else "radiance")
    surroundings = np.atleast_2d(light).shape[0] if light.size else 0
    rows, columns, band = dims
    spatial = options.get("potts") is not None or options.get("tex_sgd") is not None
    potts = options.get("potts")
    if potts is not None and (len(potts) < 2 or potts[1] is None):
        raise hadar.HadarError("a potts prior without its step over chunks; give potts=(weight, step in K), one for all of them")
    fixed = (library, light, bands, {"threads": 1} | options)
    if data.chunks is not None:
        data = data.chunk({band: -1})
    if spatial and data.chunks is not None:
        packed = _over_edges(_packed, data.data, (overlap, overlap), len(_MAPS) - 1 + surroundings, fixed=fixed)
        coordinates = {name: data.coords[name] for name in (rows, columns) if name in data.coords}
        fields = list(_MAPS)[:-1]
        maps = {name: xarray.DataArray(packed[..., i].astype(_MAPS[name][0]), coordinates, (rows, columns)) for i, name in enumerate(fields)}
        lit = packed[..., len(fields) :].astype("f4")
        maps["lighting"] = xarray.DataArray(lit, coordinates, (rows, columns, "surroundings"))
    else:
        found = xarray.apply_ufunc(
            _apart,
            data,
            kwargs={"fixed": fixed},
            input_core_dims=[[band]],
            output_core_dims=[["surroundings"] if name == "lighting" else [] for name in _MAPS],
            dask="parallelized",
            output_dtypes=[kind for kind, _, _ in _MAPS.values()],
            dask_gufunc_kwargs={"output_sizes": {"surroundings": surroundings}},
        )
        maps = dict(zip(_MAPS, found, strict=True))
    for name, (_, unit, meaning) in _MAPS.items():
        _described(maps[name], unit, meaning)
    attributes = {"hadar": hadar.__version__} | ({"materials": list(names)} if names is not None else {})
    return xarray.Dataset(maps, attrs=attributes)


def _apart(block, fixed):
    *asked, options = fixed
    maps = hadar.decompose(block, *asked, **options).to_dict()
    return tuple(maps[name] for name in _MAPS)


def _packed(block, fixed):
    maps = _apart(block, fixed)
    return np.concatenate([*(values[..., None] for values in maps[:-1]), maps[-1]], axis=-1, dtype="f8")


def window_information(
    cube: Any,
    window: tuple[int, int] = (5, 5),
    *,
    dims: tuple[str, str, str] = ("y", "x", "band"),
    cells: Sequence[Cell] = ("full",),
    derivative: Derivative = "central",
    **options: Unpack[NoiseOptions],
) -> xarray.Dataset:
    """:func:`hadar_limits.window_information` of a cube in chunks, lazily: the same as of the whole cube.

    Each chunk is given the pixels around it that windows and derivative reach; derivatives that take whole rows
    (``"cubic-spline"``, ``"fourier"``) get whole rows.
    """
    data = _array(cube, dims)
    rows, columns, band = dims
    options = {"threads": 1, "derivative": derivative} | options
    options["var_added"] = as_cube_has(options.get("var_added"), data, None, "var_added", band)
    names = [*cells, "photons"]
    margin = _MARGINS.get(derivative, 0)
    if data.sizes[rows] < window[0] or data.sizes[columns] < window[1] + 2 * margin:
        # The message of the image that is too small.
        hadar.window_information(np.ones((data.sizes[rows], data.sizes[columns], 1)), window, derivative=derivative)
    if data.chunks is None:
        packed = _information(data.values, window, names, options)
    else:
        data = data.chunk({band: -1} if margin else {band: -1, columns: -1})
        depth = (window[0] // 2, (window[1] // 2 + margin) if margin else 0)
        packed = _over_edges(_information, data.data, depth, len(names), window=window, names=names, options=options)
    coordinates = {name: data.coords[name] for name in (rows, columns) if name in data.coords}
    found = {}
    for i, name in enumerate(names):
        values = xarray.DataArray(packed[..., i], coordinates, (rows, columns))
        unit, meaning = ("count", "photons of the window") if name == "photons" else ("pixel^-2", f"Fisher information about x, {name}")
        found[name] = _described(values, unit, meaning)
    return xarray.Dataset(found, attrs={"hadar": hadar.__version__})


def _information(block, window, names, options):
    if block.shape[0] < window[0] or block.shape[1] < window[1] + 2 * _MARGINS.get(options["derivative"], 0):
        # A chunk at the edge whose pixels are the centre of no window.
        return np.full((*block.shape[:2], len(names)), np.nan)
    found = hadar.window_information(block, window, cells=names[:-1], **options).to_dict()
    return np.stack([found[name] for name in names], axis=-1)
