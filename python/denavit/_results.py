"""What results have in common: read from answers of the command, shown as tables."""

from __future__ import annotations

import html
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

from ._words import by_keyword
from .errors import Fault, MissingPackage

T = TypeVar("T")


def of(kind: type[Any], **more: Any) -> Any:
    """A field that is a dataclass, or a tuple of them."""
    return field(metadata={"of": kind}, **more)


def named(name: str, **more: Any) -> Any:
    """A field that answers call otherwise."""
    return field(metadata={"name": name}, **more)


def read(kind: type[T], given: Mapping[str, Any], **more: Any) -> T:
    """A dataclass of the keys of an answer that its fields are named after."""
    values = dict(more)
    for one in fields(kind):  # type: ignore[arg-type]
        name = one.metadata.get("name", one.name)
        if one.name not in values and name in given:
            values[one.name] = _value(given[name], one.metadata.get("of"))
    return kind(**values)


def _value(given: Any, kind: type[Any] | None) -> Any:
    if isinstance(given, list):
        return tuple(_value(one, kind) for one in given)
    if kind is not None and isinstance(given, dict):
        return read(kind, given)
    return by_keyword(given) if isinstance(given, str) else given


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What a use case answers."""

    is_good: bool
    """Whether the answer is good: the command would exit with 0."""
    notes: tuple[str, ...] = field(default=(), repr=False)
    """What was noted on the way: faults of files that pass."""
    json: Mapping[str, Any] = field(default_factory=dict, repr=False, compare=False)
    """The whole answer, as ``denavit .. --json`` prints it."""

    def _title(self) -> str:
        return type(self).__name__

    def _rows(self) -> list[dict[str, Any]]:
        """The rows of the answer's table."""
        return []

    def to_pandas(self) -> Any:
        """The answer's table as a data frame. Needs pandas."""
        return frame(self._rows())

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(self._title())}</p>{html_table(self._rows())}"


def answer(kind: type[T], found: tuple[dict[str, Any], bool, list[str]], **more: Any) -> T:
    """A result of what the command answered."""
    given, is_good, notes = found
    said = tuple(by_keyword(note) for note in notes)
    return read(kind, given, is_good=is_good, notes=said, json=given, **more)


def frame(rows: Sequence[Mapping[str, Any]]) -> Any:
    """A data frame of rows."""
    return pandas_package().DataFrame(list(rows))


def pandas_package() -> Any:
    """The package pandas, which is asked for where it is used."""
    try:
        import pandas  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        cause, hint = "pandas is not installed", "pip install 'denavit[pandas]'"
        raise MissingPackage([Fault(None, None, None, cause, hint)]) from None
    return pandas


def shown(value: object) -> str:
    """A cell as text."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.5g}"
    if isinstance(value, (tuple, list)):
        return ", ".join(shown(one) for one in value)
    return str(value)


def html_table(rows: Iterable[Mapping[str, object]]) -> str:
    """A table of HTML, one column for each key of the first row."""
    rows = list(rows)
    if not rows:
        return ""
    head = "".join(f"<th>{html.escape(key)}</th>" for key in rows[0])
    body = "".join(
        "<tr>" + "".join(f"<td>{html.escape(shown(cell))}</td>" for cell in row.values()) + "</tr>"
        for row in rows
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


class Latex(str):
    """A formula, which notebooks set."""

    def _repr_latex_(self) -> str:
        return f"$\\displaystyle {self}$"
