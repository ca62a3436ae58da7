"""The commands: a scenario in, an answer out."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Sequence
from datetime import date
from typing import Any, Literal, TypeVar, Unpack

from hadar_limits import _hadar
from hadar_limits._results import Identification, Ranging, Result, RuleAnswer, Simulation, Sizing
from hadar_limits._types import ByOfCommands, Paths, Progress, QuestionOptions, Scenario

_Kind = TypeVar("_Kind", bound=Result)


class LibraryWarning(UserWarning):
    """Something about spectra that were read, which the command says on stderr."""


def _common(
    library: Paths = (),
    only_library: bool = False,
    skip_uncovered: bool = False,
    seed: int = 1,
    skipping: bool = True,
    threads: int | None = None,
    time_limit: str | None = None,
    memory_limit: str | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    return {
        "library": _list(library),
        "only_library": only_library,
        "skip_uncovered": skip_uncovered,
        "seed": seed,
        "skipping": skipping,
        "threads": threads,
        "time_limit": time_limit,
        "memory_limit": memory_limit,
        "progress": progress,
    }


def _list(given: Paths) -> list[str | os.PathLike[str]]:
    return [given] if isinstance(given, (str, os.PathLike)) else list(given)


def _answered(kind: type[_Kind], answer: _hadar.Answer) -> _Kind:
    for line in answer.library_warnings:
        warnings.warn(line, LibraryWarning, stacklevel=3)
    return kind(answer)


def size(scenario: Scenario, *, by: ByOfCommands | None = None, **common: Unpack[QuestionOptions]) -> Sizing:
    """The verdict on a camera: does it meet the requirement, and what would have to change?

    ``scenario``: a path, TOML text, or a dict of its tables with quantities as strings (``"37 degC"``).
    ``by``: the distance that decides, ``"nearest"``, ``"local"`` or ``"local-unknown-gain"``, instead of the scenario's.

    Every command takes ``library`` (folders or files of spectra of your own), ``only_library``, ``skip_uncovered``, ``seed``,
    ``skipping`` (False computes what proofs would spare; the answer is the same), ``threads`` (default: all cores; the
    answer does not depend on it), ``time_limit`` (``"90 s"``) and ``memory_limit`` (``"2 GB"``, of the whole process; watched on
    Linux): what exceeds one is stopped with a :class:`hadar_limits.HadarError`. So is what Ctrl-C interrupts, with ``KeyboardInterrupt``.
    ``progress(done, of)`` is called with how far the step is that is at work, where its work is counted; what it raises ends the call.

    As ``hadar size --json``: the same keys, the same bits. Raises :class:`hadar_limits.HadarError` with the command's message.
    """
    return _answered(Sizing, _hadar.size(scenario, by, _common(**common)))


def identify(
    scenario: Scenario,
    *,
    by: ByOfCommands | None = None,
    matrix: bool = False,
    apart: bool = False,
    prove: float | None = None,
    scaling: bool = False,
    bands: int | None = None,
    filters: int | None = None,
    exact: bool = False,
    statistics: Literal["poisson", "gaussian", "negative-binomial"] | None = None,
    photons: float | None = None,
    half_width: float = 0.01,
    trials: int = 1_000_000,
    average: bool = False,
    **common: Unpack[QuestionOptions],
) -> Identification:
    """Distances from the target to every alternative, and what else is asked for.

    ``matrix``: all materials against all; ``apart``: only which of them are distinguished; ``prove``: to this share of a
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


def rule(rule: Scenario, *, on: str | date | None = None, **common: Unpack[QuestionOptions]) -> RuleAnswer:
    """Which cameras meet a rule: a requirement over ranges of scenes.

    ``on``: a day, ``"2029-09-01"`` or a date, whether or not the rule holds on it. As ``hadar rule --json``; the rest as
    :func:`size`.
    """
    on = on.isoformat() if isinstance(on, date) else on
    return _answered(RuleAnswer, _hadar.rule(rule, on, _common(**common)))


def range_(scenario: Scenario, *, trials: int = 0, bands: int | None = None, **common: Unpack[QuestionOptions]) -> Ranging:
    """How well depth can be measured, by two views or by the air on the path (``signal = "air"``).

    ``trials``: match so many noisy views, or fit so many spectra; ``bands``: by air, the best so many of all bands.
    As ``hadar range --json``; the rest as :func:`size`.
    """
    return _answered(Ranging, _hadar.range_(scenario, {"trials": trials, "bands": bands}, _common(**common)))


def simulate(
    scenario: Scenario,
    *,
    classifiers: Sequence[str] = (),
    spectra: int = 5000,
    photons: Iterable[float] | float = (),
    sweep: int | None = None,
    statistics: Literal["poisson", "negative-binomial", "fixed-total"] = "poisson",
    shot_noise_only: bool = False,
    against: Sequence[str] = (),
    model: Paths = (),
    skip_spectra: bool = False,
    thermometry: str | None = None,
    temperatures: int = 16,
    **common: Unpack[QuestionOptions],
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
        "model": _list(model),
        "skip_spectra": skip_spectra,
        "thermometry": thermometry,
        "temperatures": temperatures,
    }
    return _answered(Simulation, _hadar.simulate(scenario, more, _common(**common)))
