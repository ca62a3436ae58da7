"""Names of types in signatures. Keyword options are dicts with these keys, so that a type checker finds one that is misspelt."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, Protocol, Required, TypeAlias, TypedDict, Union

import numpy as np
from numpy.typing import NDArray

#: One number.
Number: TypeAlias = float | np.floating[Any] | np.integer[Any]


class HasArray(Protocol):
    """What NumPy makes an array of: its own, those of astropy, pandas, xarray."""

    def __array__(self) -> NDArray[Any]: ...


class HasUnits(Protocol):
    """A quantity of pint."""

    @property
    def units(self) -> Any: ...


# Not to any depth: text is a sequence of texts, and so on.
_Row: TypeAlias = Sequence[Number | HasArray]
Array: TypeAlias = Union[HasArray, HasUnits, _Row, Sequence[_Row], Sequence[Sequence[_Row]]]
#: Numbers of any shape, bare or with a unit that is converted.
Numbers: TypeAlias = Union[Number, Array]

#: A path, TOML text, or a dict of its tables.
Scenario: TypeAlias = Union[str, PathLike[str], dict[str, Any]]
Paths: TypeAlias = Union[str, PathLike[str], Sequence[str | PathLike[str]]]
#: Called with how much of a step is done, and of how much; what it raises ends the call.
Progress: TypeAlias = Callable[[int, int], object]

By: TypeAlias = Literal["local", "nearest"]
ByOfCommands: TypeAlias = Literal["nearest", "local", "local-unknown-gain"]
Cell: TypeAlias = Literal["full", "spatial", "spectral", "total"]
Derivative: TypeAlias = Literal["central", "simoncelli", "cubic-spline", "fourier"]
Unknown: TypeAlias = Literal["temperature", "lighting", "gain", "environment-temperature"]


class QuestionOptions(TypedDict, total=False):
    """What every question takes: see :func:`hadar_limits.size`."""

    library: Paths
    only_library: bool
    skip_uncovered: bool
    seed: int
    skipping: bool
    threads: int | None
    time_limit: str | None
    memory_limit: str | None
    progress: Progress | None


class DecomposeOptions(TypedDict, total=False):
    """What :func:`hadar_limits.decompose` takes besides."""

    counts_per_radiance: Required[Numbers]
    var_added: Numbers | None
    units_per_count: Numbers
    temperature_range: Numbers | None
    lighting_total: Numbers | None
    gain: bool
    bad_bands: Sequence[int] | Sequence[bool] | HasArray | None
    light_in_counts: bool
    prior: Numbers | None
    emissivity_error: tuple[Numbers, Numbers] | None
    method: Literal["ml", "te", "analytic-inverse", "grey-body"]
    potts: tuple[Numbers, Numbers | None] | None
    tex_sgd: Numbers | None
    skipping: bool
    threads: int | None
    progress: Progress | None


class NoiseOptions(TypedDict, total=False):
    """Noise and threads of :func:`hadar_limits.window_information`."""

    var_added: Numbers | None
    joined: Literal["sum-of-readings", "one-reading"]
    threads: int | None


class WindowOptions(NoiseOptions, total=False):
    """What :func:`hadar_limits.window_information` takes besides."""

    cells: Sequence[Cell] | None
    derivative: Derivative


#: Deviations of what is unknown, K or dimensionless.
Priors: TypeAlias = Mapping[str, Numbers]
