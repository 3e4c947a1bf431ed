"""A fleet of simulated arms, some of which acquire an effect: an example, and a bench.

Every arm differs from the model by a few per cent. Friction differs from night to night, much more
than the standard errors of a night, and the whole hall is colder in some nights than in others. In
a night, effects begin in some arms; the file ``answer.json`` says which, and the fleet is not told.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import Error, Fault
from ..excite import Excitation, excite
from ..model import load
from ..simulate import Run, simulate

JOINTS = ("shoulder", "elbow")
DURATION_S = 5.0
GAINS = {"shoulder": {"kp": 800, "kd": 60}, "elbow": {"kp": 300, "kd": 20}}

EFFECTS: tuple[tuple[str, str, Mapping[str, float]], ...] = (
    ("coulomb", "elbow", {"fc": 0.25}),
    ("spring", "elbow", {"k": 0.5, "q_0": 0.0}),
    ("quadratic_drag", "shoulder", {"c": 0.3}),
    ("torque_offset", "elbow", {"c": 0.3}),
    ("stribeck", "shoulder", {"fs": 0.8, "vs": 0.1}),
    ("cogging", "shoulder", {"a": 0.5, "b": 0.0, "n": 12}),
)
"""Effects that arms acquire, in turn."""

FRICTION_SCATTER = 0.01
"""Friction of an arm from night to night, as a share."""
HALL_SCATTER = 0.02
"""Friction of all arms from night to night, as a share."""


@dataclass(frozen=True)
class Arm:
    """A robot of the example, as it is."""

    name: str
    masses: tuple[float, float]
    friction: Mapping[str, tuple[float, float]]
    """Viscous and Coulomb friction of each joint."""
    effect: tuple[str, str, Mapping[str, float]] | None


def model(
    masses: tuple[float, float], friction: Mapping[str, tuple[float, float]]
) -> dict[str, Any]:
    """A planar arm of two joints."""
    limits = (
        {"position": [-1.5, 1.5], "velocity": 3, "acceleration": 12, "torque": 60},
        {"position": [-2, 2], "velocity": 4, "acceleration": 20, "torque": 20},
    )
    bodies = ((-0.22, 0.04), (-0.17, 0.03))
    links = [
        {
            "name": joint,
            "joint": {"type": "revolute", "a": length},
            "limits": limit,
            "body": {"mass": mass, "com": [com, 0, 0], "inertia": {"zz": zz}, "about": "com"},
        }
        for joint, length, limit, mass, (com, zz) in zip(
            JOINTS, ("l1", "l2"), limits, masses, bodies
        )
    ]
    constants = {"l1": (0.5, "m"), "l2": (0.4, "m"), "g": (9.81, "m/s^2")}
    return {
        "format": "denavit-model/1",
        "name": "arm",
        "convention": "standard",
        "gravity": [0, "-g", 0],
        "constants": {
            name: {"value": value, "unit": unit} for name, (value, unit) in constants.items()
        },
        "links": links,
        "drives": {
            joint: {"viscous": viscous, "coulomb": coulomb}
            for joint, (viscous, coulomb) in friction.items()
        },
    }


NOMINAL = model((2.0, 1.5), {"shoulder": (0.5, 0.8), "elbow": (0.2, 0.3)})


def drawn(
    name: str, random: np.random.Generator, effect: tuple[str, str, Mapping[str, float]] | None
) -> Arm:
    """An arm that differs from the model by a few per cent, and in friction by more."""
    masses = tuple(float(mass * random.normal(1, 0.03)) for mass in (2.0, 1.5))
    friction = {
        joint: (float(viscous * random.normal(1, 0.1)), float(coulomb * random.normal(1, 0.1)))
        for joint, (viscous, coulomb) in {"shoulder": (0.5, 0.8), "elbow": (0.2, 0.3)}.items()
    }
    return Arm(name, (masses[0], masses[1]), friction, effect)


def _arm(number: int, count: int, changed: Mapping[int, int], seed: int) -> Arm:
    effect = EFFECTS[changed[number] % len(EFFECTS)] if number in changed else None
    name = f"arm-{number:0{len(str(count - 1))}}"
    return drawn(name, np.random.default_rng([seed, number]), effect)


@lru_cache(maxsize=1)
def _motions() -> tuple[Excitation, ...]:
    """The motions of the logs, the same for all arms."""
    return tuple(
        excite(load(NOMINAL), duration_s=DURATION_S, starts=2, evaluations=60, reach=0.9, seed=seed)
        for seed in (1, 2)
    )


def logged(arm: Arm, random: np.random.Generator, *, has_effect: bool) -> list[Run]:
    """Two runs of an arm, with its effect or without."""
    truth = model(arm.masses, arm.friction)
    if has_effect and arm.effect is not None:
        truth["effects"] = [_effect(arm.effect)]
    runs = []
    with tempfile.TemporaryDirectory() as inside:
        for at, motion in enumerate(_motions()):
            path = Path(inside) / f"motion_{at}.json"
            motion.save(path)
            runs.append(simulate(_scenario(truth, path, int(random.integers(1 << 31)))))
    return runs


def _refuse_others(logs: Path, names: set[str]) -> None:
    """Sees to it that robots of another fleet are not mixed with these."""
    others = sorted(one.name for one in logs.glob("*") if one.name not in names)
    if others:
        cause = f"has robots of another fleet: {', '.join(others[:3])}"
        raise Error([Fault(str(logs), None, None, cause, "give another folder")])


def write_example(
    out: str | Path,
    *,
    robots: int = 12,
    nights: int = 4,
    changed: int = 2,
    since: int = 3,
    seed: int = 1,
    progress: Callable[[int, int], object] | None = None,
) -> None:
    """Writes ``OUT/logs/ROBOT/NIGHT/train.csv`` and ``validate.csv``, the model ``OUT/arm.json``,
    and ``OUT/answer.json``. ``changed`` robots have an effect from the night ``since`` on, from 1.
    """
    if not (0 <= changed <= robots and robots > 0 and nights > 0 and 0 < since and seed >= 0):
        raise ValueError("robots and nights are positive, and no more robots change than there are")
    out = Path(out)
    order = np.random.default_rng([seed]).permutation(robots)[:changed]
    numbers = {int(number): at for at, number in enumerate(order)}
    arms = [_arm(number, robots, numbers, seed) for number in range(robots)]
    _refuse_others(out / "logs", {arm.name for arm in arms})
    out.mkdir(parents=True, exist_ok=True)
    (out / "arm.json").write_text(json.dumps(NOMINAL, indent=2) + "\n")
    motions = {name: (out / f"{name}_motion.json").resolve() for name in LOGS}
    for path, motion in zip(motions.values(), _motions()):
        motion.save(path)
    answer = {
        arm.name: {"effect": arm.effect[0], "at": arm.effect[1], "since": _date(since)}
        for arm in arms
        if arm.effect is not None and since <= nights
    }
    (out / "answer.json").write_text(json.dumps(answer, indent=2) + "\n")
    for number, arm in enumerate(arms):
        for night in range(1, nights + 1):
            truth = _tonight(arm, number, night, night >= since, seed)
            folder = out / "logs" / arm.name / _date(night)
            folder.mkdir(parents=True, exist_ok=True)
            for at, (name, path) in enumerate(motions.items()):
                own = len(LOGS) * (nights * number + night - 1) + at
                simulate(_scenario(truth, path, own), log=folder / f"{name}.csv")
        if progress is not None:
            progress(number + 1, robots)


LOGS = ("train", "validate")


def _date(night: int) -> str:
    return f"2026-01-{night:02}" if night < 32 else f"night-{night:04}"


def _effect(effect: tuple[str, str, Mapping[str, float]]) -> dict[str, Any]:
    name, joint, parameters = effect
    return {"effect": name, "at": {"link": joint}, "parameters": dict(parameters)}


def _tonight(arm: Arm, number: int, night: int, has_effect: bool, seed: int) -> dict[str, Any]:
    """The model of an arm as it is in a night."""
    hall = np.random.default_rng([seed, 1 << 20, night]).normal(1, HALL_SCATTER, (2, 2))
    own = np.random.default_rng([seed, number, night]).normal(1, FRICTION_SCATTER, (2, 2))
    friction = {
        joint: (viscous * float(each[0]), coulomb * float(each[1]))
        for (joint, (viscous, coulomb)), each in zip(arm.friction.items(), hall * own)
    }
    truth = model(arm.masses, friction)
    if has_effect and arm.effect is not None:
        truth["effects"] = [_effect(arm.effect)]
    return truth


def _scenario(truth: Mapping[str, Any], motion: Path, seed: int) -> dict[str, Any]:
    return {
        "format": "denavit-scenario/1",
        "model": load(truth),
        "duration_s": DURATION_S,
        "initial": {"on_reference": True},
        "drives": "model",
        "stiction_rate": 0.0005,
        "control": {"period_s": 0.002, "trajectory": str(motion), "joints": GAINS},
        "measurement": {"resolution": 0.0001, "logged": True, "torque_noise": 0.02},
        "seed": seed,
        "integrator": {"relative": 1e-6, "absolute": 1e-7},
        "tolerances": {"energy_j": 0.001},
        "log_period_s": 0.002,
    }
