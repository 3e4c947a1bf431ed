"""What a study computes for one index, and the columns of its rows."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from ..errors import Error

Row = Mapping[str, Any]
"""The values of one index by column; None where there is none."""

Function = Callable[["Case"], Row]
F = TypeVar("F", bound=Function)

COLUMN_TYPES: dict[Any, str] = {
    float: "double",
    int: "int64",
    bool: "bool",
    str: "string",
    list[float]: "list<double>",
    list[str]: "list<string>",
}
"""Types of columns, and what Arrow calls them."""

AGAIN = "again"
"""What a row has that has no answer for now: it is computed again when its part is run again."""


class PassingError(Error):
    """What a row depends on cannot be read now: the network, or a disk. A function raises it where
    its row is to be computed again, at the next run.
    """


@dataclass(frozen=True)
class Case:
    """One index of a study, and all that its row may depend on."""

    index: int
    seed: int
    """Of the study, the same for all of its indices."""
    inputs: Mapping[str, bytes] = field(repr=False)
    """The content of the study's files."""
    options: Mapping[str, Any] = field(repr=False)
    files: Mapping[str, str] = field(default_factory=dict, repr=False)
    """Paths of what is too large to be carried."""

    def random(self) -> np.random.Generator:
        """Random numbers of this index: the same ones wherever and whenever it is computed."""
        return np.random.default_rng(np.random.SeedSequence([self.seed, self.index]))


def rows(**columns: Any) -> Callable[[F], F]:
    """Says which columns a function's rows have: names and types (``float``, ``int``, ``bool``,
    ``str``, ``list[float]``, ``list[str]``).
    """
    unknown = [name for name, kind in columns.items() if kind not in COLUMN_TYPES]
    if unknown:
        raise TypeError(f"columns of a type that no row has: {', '.join(unknown)}")
    taken = {"index", "failure", AGAIN} & columns.keys()
    if taken:
        raise TypeError(f"every row has a column of that name: {', '.join(sorted(taken))}")

    def marked(function: F) -> F:
        function.__dict__["study_columns"] = dict(columns)
        return function

    return marked


def columns_of(function: Function) -> dict[str, Any]:
    """The columns that a function said its rows have."""
    found = getattr(function, "study_columns", None)
    if found is None:
        name = getattr(function, "__qualname__", str(function))
        raise TypeError(f"{name} says no columns: put @denavit.studies.rows(..) above it")
    assert isinstance(found, dict)
    return found


def plain(kind: Any, value: Any) -> Any:
    """A value of a column as one of Python's own, whatever numpy calls it."""
    if value is None:
        return None
    if kind == list[float] or kind == list[str]:
        own = str if kind == list[str] else float
        return [plain(own, one) for one in value]
    if kind is float:
        return float(value)
    if kind is int:
        whole = operator.index(value)
        if not -(1 << 63) <= whole < 1 << 63:
            raise OverflowError(f"{whole} has no place in 64 bits")
        return whole
    if not isinstance(value, (bool, np.bool_) if kind is bool else str):
        raise TypeError(f"{value!r} is no {kind.__name__}")
    if isinstance(value, str):
        value.encode()  # halves of characters have no bytes
    return kind(value)
