"""What a command answers, by the names of its JSON."""

from __future__ import annotations

import html
import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    import pandas


def _read(value: Any) -> Any:
    if isinstance(value, dict):
        return Record(value)
    if isinstance(value, list):
        return [_read(item) for item in value]
    return value


class Record(Mapping[str, Any]):
    """An object of the JSON: ``record.key``, or ``record["key"]`` where the key is no name of Python."""

    __slots__ = ("_data",)

    def __init__(self, data: dict[str, Any]):
        object.__setattr__(self, "_data", data)

    def __getitem__(self, key: str) -> Any:
        return _read(self._data[key])

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        for key in (name, name.rstrip("_"), name.replace("_", "-")):
            if key in self._data:
                return self[key]
        known = ", ".join(self._data)
        raise AttributeError(f"there is no `{name}` in this answer; there is {known}")

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("an answer stays as it was found")

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(key for key in self._data if key.isidentifier())]

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._data,)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(self._data)})"

    def to_dict(self) -> dict[str, Any]:
        """The same as dicts, lists and plain values."""
        return json.loads(json.dumps(self._data))


class Result(Record):
    """An answer: the keys of the JSON of the command, its text, its pictures."""

    __slots__ = ("_answer", "_json", "_text", "_pictures")

    #: The lists that :meth:`to_pandas` makes a table of: the first that is there.
    _rows: tuple[str, ...] = ("pairs",)

    def __init__(self, answer: Any):
        super().__init__(json.loads(answer.json))
        object.__setattr__(self, "_answer", answer)
        object.__setattr__(self, "_json", answer.json)
        object.__setattr__(self, "_text", answer.text)
        object.__setattr__(self, "_pictures", None)

    @property
    def text(self) -> str:
        """The answer as the command prints it."""
        return self._text

    @property
    def sentence(self) -> str:
        """The verdict."""
        verdict = self._data.get("verdict", self._data)
        sentence: str | None = verdict.get("sentence")
        return sentence or self._text.strip().split("\n", 1)[0]

    def to_json(self) -> str:
        """The JSON that the command prints with ``--json``, to the last byte."""
        return self._json

    def pictures(self) -> dict[str, str]:
        """Figures as SVG, by name; drawn when they are first asked for."""
        if self._pictures is None:
            object.__setattr__(self, "_pictures", dict(self._answer.pictures()))
        return self._pictures

    def to_pandas(self, rows: str | None = None) -> pandas.DataFrame:
        """A list of the answer as a table, one row each, nested keys joined by dots.

        ``rows`` names the list; silent it is the main one, such as the pairs.
        """
        try:
            import pandas
        except ImportError as error:
            raise ImportError('to_pandas needs pandas: pip install "hadar-limits[pandas]"') from error
        rows = rows or next(name for name in self._rows if name in self)
        return pandas.json_normalize(self.to_dict()[rows])

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"<hadar_limits.{type(self).__name__}: {self.sentence}>"

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, _: Any) -> Self:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self._json, self._text, self.pictures())

    def _repr_html_(self) -> str:
        pictures = "".join(f'<div style="max-width:60em">{svg}</div>' for svg in self.pictures().values())
        rest = html.escape(self._text.strip())
        return (
            f"<div><p><strong>{html.escape(self.sentence)}</strong></p>"
            f"<details><summary>All of the answer</summary><pre>{rest}</pre></details>{pictures}</div>"
        )


class _Kept:
    """An answer that came from another process."""

    def __init__(self, json: str, text: str):
        self.json, self.text = json, text


def _again(kind: type[Result], json: str, text: str, pictures: dict[str, str]) -> Result:
    result = kind(_Kept(json, text))
    object.__setattr__(result, "_pictures", pictures)
    return result


class Sizing(Result):
    """Answer of :func:`hadar_limits.size`."""

    __slots__ = ()
    if TYPE_CHECKING:
        scenario: Record
        verdict: Record
        requirement: Record
        camera: Record | None
        solve_for: Record | None
        sensitivity: Record | None
        trade_offs: list[Record]
        photon_radiance: float
        pairs: list[Record]
        limiting: str
        warnings: list[Record]
        stats: Record


class Identification(Result):
    """Answer of :func:`hadar_limits.identify`; the last five where they were asked for."""

    __slots__ = ()
    if TYPE_CHECKING:
        scenario: Record
        photon_radiance: float
        pairs: list[Record]
        limiting: str
        identifiability: Record
        prior_average: Record | None
        warnings: list[Record]
        stats: Record
        matrix: Record
        apart: Record
        scaling: Record
        bands_that_matter: Record
        exact: Record


class RuleAnswer(Result):
    """Answer of :func:`hadar_limits.rule`."""

    __slots__ = ()
    _rows = ("cameras",)
    if TYPE_CHECKING:
        rule: Record
        stop: Record | None
        requirement: Record
        envelope: Record
        cameras: list[Record]
        not_identifiable: Record | None
        companions: list[Record]
        warnings: list[Record]
        stats: Record
        inputs: list[Record]


class Ranging(Result):
    """Answer of :func:`hadar_limits.range_`: ``objects`` and ``cells`` of two views, ``curve`` and ``bands`` of the air on the path."""

    __slots__ = ()
    _rows = ("curve", "objects")
    if TYPE_CHECKING:
        scenario: Record
        verdict: Record
        objects: list[Record]
        curve: list[Record]
        warnings: list[Record]
        stats: Record


class Simulation(Result):
    """Answer of :func:`hadar_limits.simulate`: ``points`` of classifiers, ``rows`` of thermometry."""

    __slots__ = ()
    _rows = ("points", "rows")
    if TYPE_CHECKING:
        points: list[Record]
        rows: list[Record]
        limit_holds: bool
        warnings: list[Record]
        stats: Record
