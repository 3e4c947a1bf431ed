"""Maps of the columns of logs: what is wrong with one is reported before any robot is read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from .sources import FleetError, fault

SHAPE = '{"q_knee": "joint positions", "tau_knee": {"column": "current", "scale": 12.5}}'


def check_columns(columns: Any, place: str = "columns") -> None:
    """Refuses what is no map of columns; ``place`` is what messages call it."""
    if columns is None:
        return
    if not isinstance(columns, Mapping):
        cause = f"is no map of columns, but a {type(columns).__name__}"
        raise FleetError([fault(place, cause, SHAPE)])
    wrong = {name: said for name, one in columns.items() if (said := _wrong(one))}
    if wrong:
        raise FleetError([fault(place, f"`{name}`: {said}", SHAPE)
                          for name, said in wrong.items()])  # fmt: skip


def _wrong(entry: Any) -> str | None:
    """What is wrong with an entry: a name, an object, or None where a column is left out."""
    if entry is None or isinstance(entry, str):
        return None
    if not isinstance(entry, Mapping):
        return "an entry is the name of a column, an object, or null"
    unknown = sorted(str(key) for key in entry.keys() - {"column", "scale", "offset"})
    if unknown:
        return f"no entry has {', '.join(unknown)}: it has `column`, `scale` and `offset`"
    if not isinstance(entry.get("column") or "", str):
        return "`column` is no name"
    for key in ("scale", "offset"):
        number = entry.get(key)
        is_number = isinstance(number, (int, float)) and not isinstance(number, bool)
        if number is not None and not (is_number and math.isfinite(number)):
            return f"`{key}` is no finite number"
    return "`scale` is 0" if entry.get("scale") == 0 else None
