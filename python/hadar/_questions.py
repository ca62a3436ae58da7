"""The commands: a scenario in, an answer out."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Sequence
from typing import Any

from hadar import _hadar
from hadar._results import Identification, Ranging, Result, RuleAnswer, Simulation, Sizing


class LibraryWarning(UserWarning):
    """Something about spectra that were read, which the command says on stderr."""


def _common(
    library: Any = (),
    only_library: bool = False,
    skip_uncovered: bool = False,
    seed: int = 1,
    skipping: bool = True,
    threads: int | None = None,
    time_limit: str | None = None,
    memory_limit: str | None = None,
) -> dict[str, Any]:
    one = isinstance(library, (str, os.PathLike))
    return {
        "library": [library] if one else list(library),
        "only_library": only_library,
        "skip_uncovered": skip_uncovered,
        "seed": seed,
        "skipping": skipping,
        "threads": threads,
        "time_limit": time_limit,
        "memory_limit": memory_limit,
    }


def _answered(kind: type[Result], answer: Any) -> Any:
    for line in answer.library_warnings:
        warnings.warn(line, LibraryWarning, stacklevel=3)
    return kind(answer)


def size(scenario: Any, *, by: str | None = None, **common: Any) -> Sizing:
    """The verdict on a camera: does it meet the requirement, and what would have to change?

    ``scenario``: a path, TOML text, or a dict of its tables with quantities as strings (``"37 degC"``).
    ``by``: the distance that decides, ``"nearest"``, ``"local"`` or ``"local-unknown-gain"``, instead of the scenario's.

    Every command takes ``library`` (folders or files of spectra of your own), ``only_library``, ``skip_uncovered``, ``seed``,
    ``skipping`` (False computes what proofs would spare; the answer is the same), ``threads`` (default: all cores; the
    answer does not depend on it), ``time_limit`` (``"90 s"``) and ``memory_limit`` (``"2 GB"``, of the whole process; watched on
    Linux): what exceeds one is stopped with a :class:`hadar.HadarError`. So is what Ctrl-C interrupts, with ``KeyboardInterrupt``.

    As ``hadar size --json``: the same keys, the same bits. Raises :class:`hadar.HadarError` with the command's message.
    """
    return _answered(Sizing, _hadar.size(scenario, by, _common(**common)))


def identify(
    scenario: Any,
    *,
    by: str | None = None,
    matrix: bool = False,
    apart: bool = False,
    prove: float | None = None,
    scaling: bool = False,
    bands: int | None = None,
    filters: int | None = None,
    exact: bool = False,
    statistics: str | None = None,
    photons: float | None = None,
    half_width: float = 0.01,
    trials: int = 1_000_000,
    average: bool = False,
    **common: Any,
) -> Identification:
    """Distances from the target to every alternative, and what else is asked for.

    ``matrix``: all materials against all; ``apart``: only which of them are told apart; ``prove``: to this share of a
    distance; ``scaling``: over the size of the library and the number of bands; ``bands``, ``filters``: the best so many;
    ``exact``: simulated decisions, with ``statistics`` (``"poisson"``, ``"gaussian"``, ``"negative-binomial"``), ``photons``,
    ``half_width`` of the 95 % interval and most ``trials``; ``average`` over the priors.

    As ``hadar identify --json``. The rest as :func:`size`.
    """
    if matrix and apart:
        raise _hadar.HadarError("matrix and apart together; take matrix, in whose answer apart is contained")
    more = {
        "matrix": matrix,
        "apart": apart,
        "prove": prove,
        "scaling": scaling,
        "bands": bands,
        "filters": filters,
        "exact": exact,
        "statistics": statistics,
        "photons": photons,
        "half_width": half_width,
        "trials": trials,
        "average": average,
    }
    return _answered(Identification, _hadar.identify(scenario, by, more, _common(**common)))


def rule(rule: Any, *, on: Any = None, **common: Any) -> RuleAnswer:
    """Which cameras meet a rule: a requirement over ranges of scenes.

    ``on``: a day, ``"2029-09-01"`` or a date, whether or not the rule holds on it. As ``hadar rule --json``; the rest as
    :func:`size`.
    """
    on = on.isoformat() if hasattr(on, "isoformat") else on
    return _answered(RuleAnswer, _hadar.rule(rule, on, _common(**common)))


def range_(scenario: Any, *, trials: int = 0, bands: int | None = None, **common: Any) -> Ranging:
    """How well depth can be measured, by two views or by the air on the path (``signal = "air"``).

    ``trials``: match so many noisy views, or fit so many spectra; ``bands``: by air, the best so many of all bands.
    As ``hadar range --json``; the rest as :func:`size`.
    """
    return _answered(Ranging, _hadar.range_(scenario, trials, bands, _common(**common)))


def simulate(
    scenario: Any,
    *,
    classifiers: Sequence[str] = (),
    spectra: int = 5000,
    photons: Iterable[float] | float = (),
    sweep: int | None = None,
    statistics: str = "poisson",
    shot_noise_only: bool = False,
    against: Sequence[str] = (),
    model: Sequence[Any] = (),
    skip_spectra: bool = False,
    thermometry: str | None = None,
    temperatures: int = 16,
    **common: Any,
) -> Simulation:
    """Spectra drawn, classifiers trained and judged, held against the limit; or the temperature read (``thermometry``).

    As ``hadar simulate --json`` with the flags of the same names; the rest as :func:`size`.
    """
    if sweep is not None and photons != ():
        raise _hadar.HadarError("sweep and photons together; take one of them")
    more = {
        "classifiers": [classifiers] if isinstance(classifiers, str) else list(classifiers),
        "spectra": spectra,
        "photons": [photons] if isinstance(photons, (int, float)) else list(photons),
        "sweep": sweep,
        "statistics": statistics,
        "shot_noise_only": shot_noise_only,
        "against": [against] if isinstance(against, str) else list(against),
        "model": [model] if isinstance(model, (str, os.PathLike)) else list(model),
        "skip_spectra": skip_spectra,
        "thermometry": thermometry,
        "temperatures": temperatures,
    }
    return _answered(Simulation, _hadar.simulate(scenario, more, _common(**common)))
