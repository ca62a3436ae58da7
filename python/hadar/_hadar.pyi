"""The compiled part of the package; docstrings are with the functions themselves."""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class HadarError(ValueError): ...

@final
class Scene:
    def __new__(
        cls,
        bands: ArrayLike,
        temperature: ArrayLike,
        lighting: ArrayLike | None = None,
        environment: ArrayLike | None = None,
        *,
        environment_emissivity: ArrayLike | None = None,
        unknown: Sequence[Literal["temperature", "lighting", "gain", "environment-temperature"]] | None = None,
        priors: Mapping[str, float] | None = None,
        lighting_total: float | None = None,
        temperature_range: ArrayLike | None = None,
        lighting_range: tuple[float, float] | None = None,
        counts_per_radiance: ArrayLike | None = None,
        var_added: ArrayLike | None = None,
    ) -> Scene: ...
    @property
    def nodes(self) -> NDArray[np.float64]: ...
    def signal(self, emissivity: ArrayLike) -> NDArray[np.float64]: ...

@final
class Local:
    @property
    def distance(self) -> float: ...
    @property
    def distance_no_nuisance(self) -> float: ...
    @property
    def relative_error(self) -> float: ...
    @property
    def status(self) -> Literal["ok", "equilibrium", "blind", "identical"]: ...
    @property
    def per_photon(self) -> bool: ...
    @property
    def probability(self) -> float | None: ...

@final
class Nearest:
    @property
    def distance(self) -> float: ...
    @property
    def lower(self) -> float: ...
    @property
    def relative_error(self) -> float: ...
    @property
    def converged(self) -> bool: ...
    @property
    def per_photon(self) -> bool: ...
    @property
    def temperature(self) -> float: ...
    @property
    def lighting(self) -> NDArray[np.float64]: ...
    @property
    def gain(self) -> float: ...
    @property
    def probability(self) -> float | None: ...

@final
class Answer:
    @property
    def json(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def library_warnings(self) -> list[str]: ...
    def pictures(self) -> list[tuple[str, str]]: ...

def planck(nu: ArrayLike, temperature: ArrayLike) -> NDArray[np.float64]: ...
def planck_slope(nu: ArrayLike, temperature: ArrayLike) -> NDArray[np.float64]: ...
def brightness_temperature(nu: ArrayLike, radiance: ArrayLike) -> NDArray[np.float64]: ...
def local(target: ArrayLike, alternative: ArrayLike, scene: Scene) -> Local: ...
def nearest(target: ArrayLike, alternative: ArrayLike, scene: Scene, *, prove: float | None = 1e-6) -> Nearest: ...
def matrix(
    emissivities: ArrayLike,
    scene: Scene,
    *,
    by: Literal["local", "nearest"] = "local",
    prove: float | None = None,
    threads: int | None = None,
) -> NDArray[np.float64]: ...
def over_states(
    target: ArrayLike,
    alternative: ArrayLike,
    scene: Scene,
    temperature: ArrayLike,
    lighting: ArrayLike,
    *,
    by: Literal["local", "nearest"] = "local",
    prove: float | None = None,
    threads: int | None = None,
) -> NDArray[np.float64]: ...
def materials() -> list[str]: ...
def emissivity(material: str | PathLike[str], nu: ArrayLike) -> NDArray[np.float64]: ...
def decompose(
    cube: ArrayLike,
    library: ArrayLike,
    light: ArrayLike,
    bands: ArrayLike,
    *,
    counts_per_radiance: ArrayLike,
    var_added: ArrayLike | None = None,
    units_per_count: float = 1.0,
    temperature_range: tuple[float, float] | None = None,
    lighting_total: float | None = None,
    gain: bool = False,
    bad_bands: Sequence[int] | None = None,
    light_in_counts: bool = False,
    prior: ArrayLike | None = None,
    emissivity_error: tuple[float, float] | None = None,
    method: Literal["ml", "te", "analytic-inverse", "grey-body"] = "ml",
    potts: tuple[float, float | None] | None = None,
    tex_sgd: float | None = None,
    skipping: bool = True,
    threads: int | None = None,
) -> dict[str, NDArray[Any]]: ...
def window_information(
    cube: ArrayLike,
    window: tuple[int, int] = (5, 5),
    *,
    cells: Sequence[Literal["full", "spatial", "spectral", "total"]] | None = None,
    derivative: Literal["central", "simoncelli", "cubic-spline", "fourier"] = "central",
    var_added: ArrayLike | None = None,
    joined: Literal["sum-of-readings", "one-reading"] = "sum-of-readings",
    threads: int | None = None,
) -> dict[str, NDArray[np.float64]]: ...
def size(scenario: Any, by: str | None, common: Mapping[str, Any]) -> Answer: ...
def identify(scenario: Any, by: str | None, more: Mapping[str, Any], common: Mapping[str, Any]) -> Answer: ...
def rule(rule: Any, on: str | None, common: Mapping[str, Any]) -> Answer: ...
def range_(scenario: Any, trials: int, bands: int | None, common: Mapping[str, Any]) -> Answer: ...
def simulate(scenario: Any, more: Mapping[str, Any], common: Mapping[str, Any]) -> Answer: ...
