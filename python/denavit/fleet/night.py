"""What a worker computes of a robot in a night: rows of studies."""

from __future__ import annotations

import json
import math
from typing import Any

from ..diagnose import Diagnosis, FoundEffect, diagnose
from ..identify import identify
from ..model import load
from ..studies.cases import Case, Row, rows
from .sources import FleetError, fault, fetched


def _given(case: Case) -> dict[str, Any]:
    """What the driver says of a robot: its logs, and its model."""
    given = json.loads(case.inputs[str(case.index)])
    assert isinstance(given, dict)
    return given


@rows(
    names=list[str],
    units=list[str],
    values=list[float],
    stds=list[float],
    joints=list[str],
    residuals=list[float],
    mismatch=float,
    left=float,
    trusted=bool,
    model=str,
    refused=str,
    remarks=list[str],
    contents=list[str],
)
def identified(case: Case) -> Row:
    """Identifies a robot from the logs of one night alone, and its model from these and from what
    was known before.
    """
    given = _given(case)
    if given["wrong"]:
        raise FleetError([fault(f"{given['robot']}/{given['night']}", given["wrong"])])
    chosen = {"columns": case.options["columns"]} if case.options.get("columns") else {}
    model = load(json.loads(given["model"]))
    with fetched(case.options["root"], given["train"], given["validate"]) as logs:
        found = identify(model, logs.train, logs.validate, **chosen)
        known = found
        if given["is_known"]:
            known = identify(model, logs.train, logs.validate, prior=True, **chosen)
    told = [one for one in found.parameters if one.identifiable and one.std]
    residual = found.residual
    return {
        "names": [one.name for one in told],
        "units": [one.unit for one in told],
        "values": [one.value for one in told],
        "stds": [one.std for one in told],
        "joints": [one.joint for one in residual.per_joint],
        "residuals": [one.train for one in residual.per_joint],
        "mismatch": residual.before,
        "left": residual.validate,
        "trusted": found.is_good,
        "model": None if known.updated is None else known.updated.source,
        "refused": None if known.update_refused is None else logs.bare(known.update_refused),
        "remarks": [logs.bare(one) for one in found.remarks],
        "contents": list(logs.contents),
    }


@rows(
    verdict=str,
    effect=str,
    joint=str,
    parameter=str,
    value=float,
    error=float,
    unit=str,
    log10_odds=float,
    named=list[str],
    rivals=list[str],
    reasons=list[str],
    before=float,
    after=float,
    floor=float,
    completed=str,
    report=str,
)
def diagnosed(case: Case) -> Row:
    """Diagnoses what a robot's last accepted model lacks in the logs of one night."""
    given = _given(case)
    chosen = {"columns": case.options["columns"]} if case.options.get("columns") else {}
    with fetched(case.options["root"], given["train"], given["validate"]) as logs:
        model = load(json.loads(given["model"]))
        found = diagnose(model, logs.train, logs.validate, report=True, **chosen)
    gap = found.gap.validate
    row: dict[str, Any] = {
        "verdict": found.verdict,
        "named": [_told(one) for one in found.effects],
        "reasons": [logs.bare(one) for one in found.reasons],
        "before": gap.before,
        "after": gap.after,
        "floor": gap.floor,
        "report": logs.bare(found.report or "") if given["wants_report"] else None,
    }
    return row | _first(found)


def _first(found: Diagnosis) -> dict[str, Any]:
    """The surest effect, if there is one."""
    if not found.effects:
        return {}
    one = max(found.effects, key=lambda effect: effect.log_odds)
    values = list(one.values.items())
    name, value = values[0] if values else (None, None)
    return {
        "effect": one.effect,
        "joint": one.at,
        "parameter": name,
        "value": None if value is None else value.value,
        "error": None if value is None else value.std,
        "unit": None if value is None else value.unit,
        "log10_odds": one.log_odds / math.log(10),
        "rivals": [f"{other.effect} at {other.at}" for other in one.indistinguishable],
        "completed": None if found.completed is None else found.completed.source,
    }


def _told(one: FoundEffect) -> str:
    values = ", ".join(
        f"{name} = {value.value:.4g}"
        + ("" if value.std is None else f" +- {value.std:.1g}")
        + f" {value.unit}"
        for name, value in one.values.items()
    )
    return f"{one.effect} at {one.at}" + (f": {values}" if values else "")
