"""Tables of a fleet, as Parquet: robots in nights, their parameters, and drift."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

from .._arrow import arrow
from ..studies.parts import write_table
from .changes import of_robot
from .drift import Drift, changed, drift
from .engine import Fleet, Outcome

LEFT = {"verdict", "effect", "joint", "parameter", "value", "error", "unit", "log10_odds"}


def report_name(outcome: Outcome) -> str | None:
    """Where the page of a diagnosis stands, below the folder of the fleet."""
    if outcome.diagnosed is None or outcome.diagnosed["report"] is None:
        return None
    names = (quote(one, safe="") for one in (outcome.robot, outcome.night))
    # quoted names have no @
    return f"reports/{'@'.join(names)}.html"


def sorted_outcomes(fleet: Fleet) -> list[Outcome]:
    """By robot, then by night."""
    return sorted(fleet.outcomes, key=lambda one: (one.robot, one.night))


def nights_table(fleet: Fleet) -> Any:
    """A row for each robot and night."""
    pa = arrow()
    text, number = pa.string(), pa.float64()
    texts = pa.list_(pa.field("element", text))
    fields = [
        ("robot", text), ("night", text), ("is_first", pa.bool_()), ("is_alarm", pa.bool_()),
        ("p", number), ("false_discovery_rate", number), ("changed", texts),
        ("verdict", text), ("effect", text), ("joint", text), ("parameter", text),
        ("value", number), ("error", number), ("unit", text), ("log10_odds", number),
        ("named", texts), ("rivals", texts), ("mismatch", number), ("mismatch_after", number),
        ("noise_floor", number), ("is_trusted", pa.bool_()), ("remarks", texts),
        ("reason", text), ("report", text),
    ]  # fmt: skip
    rows = [_row(one) for one in sorted_outcomes(fleet)]
    return pa.Table.from_pylist(rows, schema=pa.schema(fields))


def _row(one: Outcome) -> dict[str, Any]:
    found, judged = one.diagnosed or {}, one.judged
    row = {
        "robot": one.robot,
        "night": one.night,
        "is_first": one.is_first,
        "is_alarm": one.is_alarm,
        "p": None if judged is None else judged.p,
        "false_discovery_rate": None if judged is None else judged.adjusted,
        "changed": [] if judged is None else list(judged.changed),
        "named": found.get("named") or [],
        "rivals": found.get("rivals") or [],
        "mismatch": one.identified["mismatch"] if not found else found["before"],
        "mismatch_after": found.get("after"),
        "noise_floor": found.get("floor"),
        "is_trusted": one.identified["trusted"],
        "remarks": one.identified["remarks"] or [],
        "reason": one.reason,
        "report": report_name(one),
    }
    told = {name: found.get(name) for name in LEFT}
    if told["verdict"] is None:
        silent = "no_answer" if one.has_log else "no_log"
        told["verdict"] = silent if one.reason else "not_diagnosed"
    return row | told


def parameters_table(fleet: Fleet) -> Any:
    """A row for each parameter, robot and night."""
    pa = arrow()
    text, number = pa.string(), pa.float64()
    fields = [
        ("robot", text), ("night", text), ("parameter", text), ("unit", text), ("value", number),
        ("std", number), ("common", number), ("change", number), ("change_error", number),
        ("p", number), ("is_changed", pa.bool_()),
    ]  # fmt: skip
    rows = [row for one in sorted_outcomes(fleet) for row in _parameters(one)]
    return pa.Table.from_pylist(rows, schema=pa.schema(fields))


def _parameters(one: Outcome) -> Iterator[dict[str, Any]]:
    changes = {} if one.judged is None else {each.name: each for each in one.judged.changes}
    marked = () if one.judged is None else one.judged.changed
    for name, estimate in one.values.items():
        change = changes.get(name)
        yield {
            "robot": one.robot,
            "night": one.night,
            "parameter": name,
            "unit": one.units.get(name, "logarithm of a share"),
            "value": estimate.value,
            "std": estimate.std,
            "common": one.common.get(name, 0.0),
            "change": None if change is None else change.change,
            "change_error": None if change is None else change.error,
            "p": None if change is None else change.p,
            "is_changed": name in marked,
        }


def drifts(fleet: Fleet) -> list[Drift]:
    """The drift of every parameter of every robot over all of its nights."""
    places = {night: at for at, night in enumerate(fleet.nights)}
    series: dict[str, dict[str, list[tuple[int, Any]]]] = {}
    for one in sorted_outcomes(fleet):
        own = series.setdefault(one.robot, {})
        for name, estimate in one.values.items():
            less = estimate.value - one.common.get(name, 0.0)
            value = type(estimate)(less, estimate.std)
            own.setdefault(name, []).append((places[one.night], value))
    found = []
    for robot, names in series.items():
        history = fleet.histories[robot]
        for name, points in names.items():
            key = history.group, name
            fits = [each.scatter[key] for each in fleet.verdicts.values() if key in each.scatter]
            if not fits:
                continue
            _, _, ratio, degrees = history.mean(name)
            is_stated = points[0][1].std is not None
            scatter = of_robot(fits[-1], ratio, max(0, degrees), is_stated)
            each = [place for place, _ in points], [value for _, value in points]
            found.append(drift(robot, name, *each, scatter))
    return changed(found, fleet.rate)


def drift_table(fleet: Fleet, found: list[Drift]) -> Any:
    """A row for each parameter and robot."""
    pa = arrow()
    text, number = pa.string(), pa.float64()
    fields = [
        ("robot", text), ("parameter", text), ("slope_per_night", number), ("slope_error", number),
        ("since", text), ("before", number), ("after", number), ("p", number),
        ("is_change", pa.bool_()),
    ]  # fmt: skip
    rows = [
        {
            "robot": one.robot,
            "parameter": one.name,
            "slope_per_night": one.slope,
            "slope_error": one.slope_error if math.isfinite(one.slope_error) else None,
            "since": None if one.since is None else fleet.nights[one.since],
            "before": one.before,
            "after": one.after,
            "p": one.p,
            "is_change": one.is_change,
        }
        for one in found
    ]
    return pa.Table.from_pylist(rows, schema=pa.schema(fields))


def write_tables(fleet: Fleet, found: list[Drift], out: Path) -> None:
    """Writes ``fleet.parquet``, ``parameters.parquet`` and ``drift.parquet``."""
    tables = {"fleet": nights_table(fleet), "parameters": parameters_table(fleet)}
    for name, table in (tables | {"drift": drift_table(fleet, found)}).items():
        write_table(out / f"{name}.parquet", table)
