"""Studies that are ready to be named by a study file."""

from __future__ import annotations

import json
import math
from functools import lru_cache
from typing import Any

import numpy as np

from .. import walk
from ..diagnose import diagnose
from ..identify import identify
from ..model import Model, load
from ..simulate import Run, simulate
from .cases import Case, Row, rows


@lru_cache(maxsize=4)
def _moved(scenario: bytes) -> Run:
    """A run without noise; the same for all indices, and so computed once a process."""
    return simulate(json.loads(scenario))


@lru_cache(maxsize=4)
def _model(scenario: bytes) -> Model:
    return load(json.loads(scenario)["model"])


def _noisy(run: Run, case: Case, random: np.random.Generator) -> dict[str, Any]:
    """The log of a run with white noise of positions and torques."""
    q_std, tau_std = (float(case.options.get(name, 0.0)) for name in ("q_std", "tau_std"))
    found = {}
    for name, column in zip(run.columns, run.values.T):
        std = {"q": q_std, "tau": tau_std}.get(name.split("_")[0], 0.0)
        if name == "t" or name.startswith(("q_", "tau_")):
            found[name] = column + std * random.standard_normal(len(column))
    return found


def _holds(interval: tuple[float, float] | None, value: float) -> bool:
    return interval is not None and interval[0] <= value <= interval[1]


@rows(
    identified=int,
    inside=int,
    largest_deviation=float,
    residual_share=float,
    values=list[float],
    stds=list[float],
    names=list[str],
)
def coverage(case: Case) -> Row:
    """Identifies a robot from logs with noise of this index. Says how many intervals of 95 % hold
    the true values, which are those of the model.

    Inputs: ``train`` and ``validate``, scenarios that name a shipped model. Options: ``q_std`` and
    ``tau_std``, standard deviations of the noise [rad, m; N m, N]; ``method`` and ``errors`` as of
    :func:`denavit.identify`.
    """
    random = case.random()
    logs = [_noisy(_moved(case.inputs[name]), case, random) for name in ("train", "validate")]
    chosen = {name: case.options[name] for name in ("method", "errors") if name in case.options}
    found = identify(_model(case.inputs["train"]), logs[0], logs[1], update=False, **chosen)
    told = [one for one in found.parameters if one.identifiable and one.std]
    off = [abs(one.value - (one.model_value or 0.0)) / (one.std or 1.0) for one in told]
    inside = [_holds(one.interval, one.model_value or 0.0) for one in told]
    return {
        "identified": len(told),
        "inside": sum(inside),
        "largest_deviation": max(off, default=0.0),
        "residual_share": found.residual.validate,
        "values": [one.value for one in told],
        "stds": [one.std for one in told],
        "names": [one.name for one in told],
    }


@rows(
    hidden=str,
    at=str,
    verdict=str,
    named=str,
    named_at=str,
    named_others=int,
    log10_odds=float,
    is_right=bool,
    mismatch=float,
    mismatch_after=float,
)
def battery(case: Case) -> Row:
    """Hides an effect in a simulated arm of two joints, or none in one case of four, and diagnoses
    its identified model from logs of 5 s with the effect. Says whether the surest name is right, or
    that there is none. Values of the arm, effect and noise are drawn by this index.
    """
    from ..fleet import example

    random = case.random()
    number = int(random.integers(len(example.EFFECTS) * 4 // 3))
    effect = example.EFFECTS[number] if number < len(example.EFFECTS) else None
    arm = example.drawn("arm", random, effect)
    before, after = (example.logged(arm, random, has_effect=one) for one in (False, True))
    known = identify(load(example.NOMINAL), *before).updated
    found = diagnose(known or load(example.NOMINAL), *after)
    first = max(found.effects, key=lambda one: one.log_odds, default=None)
    hidden = (None, None) if effect is None else effect[:2]
    named = (None, None) if first is None else (first.effect, first.at)
    gap = found.gap.validate
    return {
        "hidden": hidden[0],
        "at": hidden[1],
        "verdict": found.verdict,
        "named": named[0],
        "named_at": named[1],
        "named_others": max(0, len(found.effects) - 1),
        "log10_odds": None if first is None else first.log_odds / math.log(10),
        "is_right": hidden == named,
        "mismatch": gap.before,
        "mismatch_after": gap.after,
    }


@rows(walks=bool, outcome=str)
def basin(case: Case) -> Row:
    """Walks from a start near the cycle of a gait, drawn by this index.

    Input: ``scenario``, one that walks. Options: ``noise_rad_s`` of the start's velocities, and
    ``steps`` that count as walking on.
    """
    found = walk.basin(
        json.loads(case.inputs["scenario"]),
        noise=float(case.options.get("noise_rad_s", 0.1)),
        starts=1,
        seed=int(case.random().integers(1 << 31)),
        steps=int(case.options.get("steps", 10)),
    )
    outcome = max(found.outcomes, key=lambda name: found.outcomes[name])
    return {"walks": found.walks == 1, "outcome": outcome}


@rows(at_s=float, directions=list[str], felled=list[str], least_ns=list[float])
def push(case: Case) -> Row:
    """The least pushes that fell a robot at the time of this index, of as many times in its step as
    the study has indices: a row of a push map. ``least_ns`` has those of ``felled``; from the other
    ``directions`` the strongest push does not fell it.

    Input: ``scenario``. Options: ``times``, how many there are; ``most_ns``, ``resolution_ns``,
    ``after_s`` and ``link`` as of :func:`denavit.walk.push`.
    """
    names = ("most_ns", "resolution_ns", "after_s", "link")
    chosen = {name: case.options[name] for name in names if name in case.options}
    scenario, times = json.loads(case.inputs["scenario"]), int(case.options["times"])
    found = walk.push(scenario, times=times, only=case.index, **chosen)
    felled = [one for one in found.pushes if one.least_impulse_ns is not None]
    return {
        "at_s": found.pushes[0].at_s,
        "directions": [one.direction for one in found.pushes],
        "felled": [one.direction for one in felled],
        "least_ns": [one.least_impulse_ns for one in felled],
    }
