"""Trajectories that excite what is to be identified."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from . import _options
from ._options import PathLike, Progress
from ._results import Answer, answer, of
from .base import JointParameters
from .errors import _argument
from .model import Model, as_place


@dataclass(frozen=True, kw_only=True)
class LimitUse:
    """How a limit is used."""

    range: tuple[float, float]
    """The least and the largest value."""
    limits: tuple[float, float]
    use: float
    """1 where a limit is reached."""


@dataclass(frozen=True, kw_only=True)
class JointUse:
    """What a trajectory asks of a joint; None where the joint has no such limit."""

    name: str
    position: LimitUse | None = of(LimitUse)
    velocity: LimitUse | None = of(LimitUse)
    acceleration: LimitUse | None = of(LimitUse)
    torque: LimitUse | None = of(LimitUse)


@dataclass(frozen=True, kw_only=True)
class Excitation(Answer):
    """A trajectory that was found or checked. ``is_good``: it keeps all limits and excites all
    base parameters.
    """

    model: str
    feasible: bool
    condition: float | None
    """Condition number of the stacked regressor; None where it is infinite."""
    condition_scaled: float | None
    """The same of columns of length 1."""
    worst_use: float | None
    columns: tuple[str, ...] = field(repr=False)
    not_excited: tuple[str, ...] = ()
    joints: tuple[JointUse, ...] = of(JointUse, repr=False)
    trajectory: Mapping[str, Any] | None = field(default=None, repr=False)
    """The trajectory file; None where none keeps the limits."""

    def save(self, path: PathLike) -> None:
        """Writes the trajectory file."""
        if self.trajectory is None:
            raise _argument("there is no trajectory that keeps all limits")
        Path(path).write_text(json.dumps(self.trajectory, indent=2) + "\n")

    def _title(self) -> str:
        fits = "within all limits" if self.feasible else "outside of a limit"
        return f"{self.model}: condition {self.condition}, {fits}"

    def _rows(self) -> list[dict[str, Any]]:
        def row(joint: JointUse) -> dict[str, Any]:
            cells: dict[str, Any] = {"joint": joint.name}
            for name in ("position", "velocity", "acceleration", "torque"):
                use: LimitUse | None = getattr(joint, name)
                cells[name] = None if use is None else use.range
                cells[f"{name} use"] = None if use is None else use.use
            return cells

        return [row(joint) for joint in self.joints]


def excite(
    model: Model | PathLike,
    *,
    basis: Literal["fourier", "free-fourier", "polynomial", "samples"] = "fourier",
    harmonics: int = 5,
    degree: int = 12,
    samples: int = 15,
    duration_s: float = 10.0,
    ends: Iterable[Literal["rest", "unaccelerated", "closed", "free"]] = (
        "rest",
        "unaccelerated",
        "closed",
    ),
    objective: Literal["condition", "d-optimal", "both"] = "condition",
    scaled: bool = False,
    joint_parameters: Iterable[JointParameters] = ("modelled",),
    parameters: Literal["joints", "kept"] = "joints",
    keep: Iterable[str] = (),
    hold: Mapping[str, float] | None = None,
    weights: Mapping[str, float] | None = None,
    clearance_m: float | None = 0.01,
    seed: int = 1,
    starts: int = 4,
    reach: float = 1.0,
    evaluations: int = 400,
    grid: int | None = None,
    threads: int | None = None,
    check: PathLike | Mapping[str, Any] | None = None,
    svg: PathLike | None = None,
    progress: Progress | None = None,
) -> Excitation:
    """Looks for a motion within the limits of the model that shows the parameters, or judges the
    trajectory ``check``. The options are those of ``denavit excite``; ``svg`` is where a picture of
    the motion that was found goes.
    """
    with _options.folder() as inside:
        effects, place = as_place(model, inside)
        chosen = _options.flags(
            basis=basis, harmonics=harmonics, degree=degree, samples=samples,
            duration_s=duration_s, ends=ends, objective=objective, scaled=scaled,
            parameters=parameters, keep=keep, hold=hold, weights=weights,
            clearance_m="none" if clearance_m is None else clearance_m, seed=seed,
            starts=starts, reach=reach, evaluations=evaluations, grid=grid, threads=threads,
            svg=svg,
            **{"with": joint_parameters},
        )  # fmt: skip
        out = inside / "trajectory.json"
        if check is None:
            chosen += ["--output", str(out)]
        else:
            chosen += ["--check", _options.file_of(check, "trajectory", inside)]
        found = _options.answered(["excite", place, *effects, *chosen], progress)
        trajectory = json.loads(out.read_text()) if out.exists() else None
    return answer(Excitation, found, trajectory=trajectory)
