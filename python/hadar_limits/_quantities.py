"""Quantities of astropy, pint and unyt, converted by their own libraries: how a unit is spelt is theirs to know."""

from __future__ import annotations

from typing import Any

import numpy as np

#: Units that scenarios know, the ones that others are converted to last.
_OF_SCENARIOS = "um nm mm cm km ms us ns min h km/h kHz MHz GHz mK m^-1 degC K m s m/s m/s^2 Hz cm^-1".split()


def _to(quantity: Any, values: Any, unit: str, spectral: bool = False, absolute: bool = False) -> Any:
    """Values, bare numbers in the unit of the quantity, in another unit; as wavenumbers, or as points of a scale of temperatures."""
    own = quantity.unit if hasattr(quantity, "unit") else quantity.units
    package = type(own).__module__.partition(".")[0]
    said = str(quantity.to_base_units().units) if package == "pint" else str(own)
    # A radian is no number of cycles, and a difference no point of a scale, which pint and unyt take for such.
    if "rad" in said or (absolute and any(delta in str(own) for delta in ("delta", "Δ"))):
        raise ValueError(own)
    values = np.asarray(values, dtype=float)
    if package == "astropy":
        from astropy import units

        allowed = (units.spectral() if spectral else []) + (units.temperature() if absolute else [])
        return units.Quantity(values, own).to_value({"degC": "deg_C"}.get(unit, unit), equivalencies=allowed)
    if package == "unyt":
        return type(quantity)(values, own).to(unit.replace("^", "**"), "spectral" if spectral else None).value
    made = type(quantity)(values, own)
    return (made.to(unit, "spectroscopy") if spectral else made.to(unit)).magnitude


def _is_scale(quantity: Any) -> bool:
    """Whether its unit is one of a scale whose zero is not that of kelvins."""
    try:
        return bool(_to(quantity, 0.0, "K", absolute=True) != 0.0)
    except Exception:
        return False


def converted(quantity: Any, values: Any, wanted: str) -> Any:
    """Values in `wanted`: K of absolute temperatures, delta_K and delta_cm^-1 of differences, cm^-1; None of what means something else."""
    try:
        if wanted == "delta_K" and _is_scale(quantity):
            return None
        return _to(quantity, values, wanted.removeprefix("delta_"), spectral=wanted == "cm^-1", absolute=wanted == "K")
    except Exception:
        return None


def written(quantity: Any, value: float) -> tuple[float, str] | None:
    """A number and its unit as scenarios write them; None of a unit that none of theirs means."""
    scale = _is_scale(quantity)
    last = None
    for unit in _OF_SCENARIOS:
        if scale != (unit == "degC"):
            continue
        try:
            found = float(_to(quantity, value, unit, absolute=True))
            if not scale and float(_to(quantity, 1.0, unit, absolute=True)) == 1.0:
                return value, unit
        except Exception:
            continue
        last = found, unit
    return last
