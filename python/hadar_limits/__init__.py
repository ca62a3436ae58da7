"""The physical limits of seeing by heat, on NumPy arrays and on scenarios.

Questions about a camera and a scene, as the command ``hadar`` answers them, with the same numbers to the last bit:
:func:`size`, :func:`identify`, :func:`rule`, :func:`range_`, :func:`simulate`. A scenario is a path, TOML text or a dict.

Functions on arrays: :func:`planck`, :func:`local`, :func:`nearest`, :func:`matrix`, :func:`over_states` in a :class:`Scene`, and
:func:`decompose` and :func:`window_information` of heat cubes. Wavenumbers are in cm⁻¹, temperatures in K, radiances in
photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹, cubes ``[row][column][band]`` in counts. Quantities of astropy, pint and unyt are converted by their own
library, and arrays whose attributes name a unit (xarray, pandas) by its name, where they mean the same (temperatures, wavelengths,
frequencies, percent), and else refused by the name of their unit. Masked arrays are refused: nan says what is missing.

>>> import hadar_limits as hadar
>>> answer = hadar.size({
...     "target": {"material": "skin", "temperature": "37 degC"},
...     "alternatives": {"materials": ["aluminium"]},
... })
>>> answer.pairs[0].alternative
'aluminium'

Method: Bao et al., Heat-assisted detection and ranging, Nature 619, 743 (2023), doi:10.1038/s41586-023-06174-6.
"""

from hadar_limits._hadar import (
    HadarError,
    Local,
    Nearest,
    Scene,
    __version__,
    brightness_temperature,
    emissivity,
    local,
    materials,
    matrix,
    nearest,
    over_states,
    planck,
    planck_slope,
)
from hadar_limits._cubes import FLAGS, NO_MATERIAL, Maps, Windows, decompose, window_information
from hadar_limits._questions import LibraryWarning, identify, range_, rule, simulate, size
from hadar_limits._results import Identification, Ranging, Record, Result, RuleAnswer, Simulation, Sizing
from hadar_limits._types import DecomposeOptions, QuestionOptions, WindowOptions

__all__ = [
    "DecomposeOptions",
    "FLAGS",
    "HadarError",
    "Identification",
    "LibraryWarning",
    "Local",
    "Maps",
    "NO_MATERIAL",
    "Nearest",
    "QuestionOptions",
    "Ranging",
    "Record",
    "Result",
    "RuleAnswer",
    "Scene",
    "Simulation",
    "Sizing",
    "WindowOptions",
    "Windows",
    "__version__",
    "brightness_temperature",
    "decompose",
    "emissivity",
    "identify",
    "local",
    "materials",
    "matrix",
    "nearest",
    "over_states",
    "planck",
    "planck_slope",
    "range_",
    "rule",
    "simulate",
    "size",
    "window_information",
]
