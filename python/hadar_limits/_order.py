"""Which dimension of an array is which, and in which order its bands come: as arrays of xarray and pandas say themselves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hadar_limits import _hadar

#: What dimensions are called, in lower case, as those of cubes in files.
_BANDS, _ROWS, _COLUMNS = _hadar.dimension_names()
#: How the names of coordinates begin that say where bands are even without a unit.
_SPECTRAL = ("wavelength", "wavenumber", "frequency")

_Order = NDArray[np.intp] | None


def labelled(given: Any) -> bool:
    """Whether it is an array of xarray or pandas."""
    return hasattr(given, "iloc") or (hasattr(given, "ndim") and bool(getattr(given, "dims", ())))


def _of(name: Any, names: Sequence[str]) -> bool:
    return str(name).lower() in names


def _spectral(name: Any) -> bool:
    return _of(name, _BANDS) or str(name).lower().startswith(_SPECTRAL)


def dimension_of_bands(given: Any) -> Any:
    """The dimension whose name, or that of whose coordinate, is one of bands; else the one that is no other; else the last one."""
    if not labelled(given) or hasattr(given, "iloc"):
        return None
    dims = given.dims
    coordinates = getattr(given, "coords", {}).items()
    named = {dim for dim in dims if _spectral(dim)}
    said = {coordinate.dims[0] for name, coordinate in coordinates if _spectral(name) and len(coordinate.dims) == 1}
    rest = {dim for dim in dims if not _of(dim, _ROWS + _COLUMNS)}
    return next((found.pop() for found in (named, said, rest) if len(found) == 1), dims[-1])


def bands_last(given: Any) -> Any:
    """An array of xarray as rows, columns, bands, as far as the names of its dimensions say; any other as it is."""
    band = dimension_of_bands(given)
    if band is None:
        return given
    others = [dim for dim in given.dims if dim != band]
    if len(others) == 2:
        first, second = (next((names for names in (_ROWS, _COLUMNS) if _of(dim, names)), None) for dim in others)
        if first != second and (first == _COLUMNS or second == _ROWS):
            others.reverse()
    wanted = (*others, band)
    return given if wanted == tuple(given.dims) else given.transpose(*wanted)


def _labels(given: Any, what: str, dim: Any) -> Iterator[tuple[Any, Any, bool, bool]]:
    """Numbers over the bands: name, values, whether they have a unit, whether they have to be those of the bands."""
    if hasattr(given, "iloc"):
        values = _numbers(given.axes[-1])
        # The index that pandas makes where none is given says nothing.
        if values is not None and not np.array_equal(values, np.arange(values.size)):
            yield "columns" if given.ndim > 1 else "index", values, False, True
        return
    for name, coordinate in getattr(given, "coords", {}).items():
        surely = str(name).lower().startswith(_SPECTRAL)
        if surely and coordinate.dims and coordinate.dims != (dim,):
            raise _hadar.HadarError(f"{what}: its bands are over `{dim}`, but {name} is over {coordinate.dims}; name one dimension of bands")
        if coordinate.dims != (dim,):
            continue
        stated = [coordinate.attrs.get(unit) for unit in ("units", "unit")]
        if any(unit not in (None, "", "1") for unit in stated) or hasattr(coordinate.data, "units"):
            yield name, coordinate, True, name == dim or _spectral(name)
        elif name == dim or _spectral(name):
            values = _numbers(coordinate)
            if values is not None:
                yield name, values, False, name == dim or surely


def _numbers(label: Any) -> NDArray[np.float64] | None:
    values = np.asarray(label)
    try:
        return values.astype(float) if values.dtype.kind in "iufOUT" else None
    except (TypeError, ValueError):
        return None


def _counts(values: NDArray[np.float64]) -> bool:
    return np.array_equal(np.sort(values) - (values.min(initial=1) > 0), np.arange(values.size))


def _orders(given: Any, bands: Any, what: str, at_nodes: bool = False, dim: Any = None) -> tuple[_Order, _Order]:
    """Places of the bands in rising wavenumber, as labels say it that are wavenumbers, and as labels do that count; None where none does."""
    if isinstance(given, (list, tuple)):
        each = [_orders(one, bands, f"{what}[{place}]", at_nodes) for place, one in enumerate(given) if _has_labels(one)]
        if any(repr(one) != repr(each[0]) for one in each):
            raise _hadar.HadarError(f"{what}: arrays whose bands come in different orders; give one array of all")
        return each[0] if each else (None, None)
    order: _Order = None
    counted: _Order = None
    for name, label, stated, needed in _labels(given, what, dimension_of_bands(given) if dim is None else dim):
        said = f"{what}.{name}"
        if not stated and _counts(label):
            counted = np.argsort(label)
            continue
        try:
            found = np.array(_hadar.order_of_bands(label, bands, said, at_nodes), dtype=np.intp)
        except _hadar.HadarError as error:
            if not needed:
                continue
            if stated:
                raise
            instead = (
                f"write wavenumbers in cm^-1 to it, or give {what}.to_numpy() if the order is that of the bands"
                if hasattr(given, "iloc")
                else f'write .attrs["units"] = "um" or "cm^-1" to it, or leave it out by .drop_vars("{name}") if the order is that of the bands'
            )
            raise _hadar.HadarError(f"{said}: a coordinate without a unit that is not that of the bands in cm^-1; {instead}") from error
        if order is not None and not np.array_equal(order, found):
            raise _hadar.HadarError(f"{what}: its coordinates put its bands in different orders; leave out {name} or mend it")
        order = found
    return order, counted


def order_of(given: Any, bands: Any, what: str, at_nodes: bool = False, dim: Any = None) -> _Order:
    """Places of its bands in the order of `bands`; None where nothing says it."""
    order, counted = _orders(given, bands, what, at_nodes, dim)
    return counted if order is None else order


def taken(given: Any, order: _Order, dim: Any = None) -> Any:
    """Its bands at these places."""
    if order is None or np.array_equal(order, np.arange(len(order))):
        return given
    if hasattr(given, "iloc"):
        return given.iloc[order] if given.ndim == 1 else given.iloc[:, order]
    return given.isel({dimension_of_bands(given) if dim is None else dim: order})


def _has_labels(given: Any, levels: int = 2) -> bool:
    """Whether it is an array with labels, or a list of such to this depth: rows of a cube, or rows of its pixels."""
    if isinstance(given, (list, tuple)):
        return levels > 0 and any(_has_labels(one, levels - 1) for one in given)
    return labelled(given)


def in_order(given: Any, bands: Any, what: str, at_nodes: bool = False) -> Any:
    """An array of xarray or pandas, or a list of them, with its bands last and in rising wavenumber, as its labels say; any other as it is.

    Labels are a coordinate over the bands (that of their dimension, one called as bands are, or one with a spectral unit), with the
    unit in ``attrs["units"]``, and the index or the columns of pandas, in cm⁻¹. They must be those of ``bands``. Numbers 0, 1, 2 … or
    1, 2, 3 … count the bands.
    """
    if not _has_labels(given):
        return given
    if isinstance(given, (list, tuple)):
        return [in_order(one, bands, f"{what}[{place}]", at_nodes) for place, one in enumerate(given)]
    given = bands_last(given)
    return taken(given, order_of(given, bands, what, at_nodes))


def as_cube_has(given: Any, cube: Any, bands: Any, what: str, dim: Any = None) -> Any:
    """An array over bands in the order in which a cube has them, as the labels of both say, without its own.

    ``bands``: None where only the cube says which bands they are.
    """
    if not labelled(given) or given.size == 1:
        return given
    if bands is None:
        shared = set(getattr(cube, "coords", ())) & set(getattr(given, "coords", ()))
        of_cube = _centres(cube, "cube", shared, dim)
        bands = _centres(given, what, shared) if of_cube is None else of_cube
    (order, counted), (own, own_counted) = _orders(cube, bands, "cube", dim=dim), _orders(given, bands, what)
    by_cube = counted if own is None or order is None else order
    own = own_counted if own is None else own
    if own is not None and by_cube is not None and len(by_cube) == len(own):
        own = own[np.argsort(by_cube)]
    given = taken(given, own)
    return given.reset_index(drop=True) if hasattr(given, "iloc") else getattr(given, "variable", given)


def _centres(given: Any, what: str, shared: set[Any], dim: Any = None) -> NDArray[np.float64] | None:
    """Wavenumbers of its bands in rising order, as its own labels say them, or as do those that another array has too."""
    for name, label, stated, needed in _labels(given, what, dimension_of_bands(given) if dim is None else dim):
        if (needed or name in shared) and (stated or not _counts(label)):
            return np.sort(_hadar.plain(label, f"{what}.{name}", "cm^-1"))
    return None


def left_out(bad: Any, cube: Any, bands: Any, dim: Any = None) -> Any:
    """Places in ``bands`` of those that are left out: numbers count in the cube's own order, a mask has it, or one of its own."""
    if bad is None:
        return None
    if np.asarray(bad).dtype.kind == "b":
        bad = as_cube_has(bad, cube, bands, "bad_bands", dim)
    order = order_of(cube, bands, "cube", dim=dim)
    if order is None:
        return bad
    return np.flatnonzero(np.isin(order, _hadar.left_out(bad, len(order))))
