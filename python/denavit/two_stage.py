"""Identification of series elastic drives: springs and motors first, then the load."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Literal

from . import _logs, _options
from ._logs import Log, Logs
from ._options import PathLike, Progress
from ._results import Answer, answer, of
from .base import JointParameters
from .identify import ConsistentBodies, IdentifiedParameter, answered_with_model, updated_model
from .model import Model, as_place


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """A number that was estimated."""

    value: float
    std: float
    """Its standard error."""
    unit: str


@dataclass(frozen=True, kw_only=True)
class IdentifiedSpring:
    """The spring of a drive, and its motor."""

    joint: str
    stiffness: Estimate = of(Estimate)
    """Of the spring [N/m]."""
    viscous: Estimate = of(Estimate)
    """Viscous friction of the motor [N m s/rad]."""
    coulomb: Estimate = of(Estimate)
    """Coulomb friction of the motor [N m]."""
    preload: Estimate = of(Estimate)
    """The force of the spring where both encoders read 0 [N]."""
    motor_zero: Estimate = of(Estimate)
    """The motor's reading where the spring is relaxed and the joint reads 0 [rad]."""
    residual_rms: float
    """What the motor's equation misses, as a root mean square [N m]."""
    torque_rms: float
    """The motor's torque, as a root mean square [N m]."""


@dataclass(frozen=True, kw_only=True)
class LoadResidual:
    """The residual of the torque on the load of a joint."""

    joint: str
    torque_rms: float
    """[N m, N]"""
    residual_rms: float
    validate: float | None
    """As a share of the torque, in the logs for validation."""


@dataclass(frozen=True, kw_only=True)
class TwoStageIdentification(Answer):
    """What was identified in two stages. ``is_good``: it explains the logs."""

    model: str
    springs: tuple[IdentifiedSpring, ...] = of(IdentifiedSpring)
    parameters: tuple[IdentifiedParameter, ...] = of(IdentifiedParameter, repr=False)
    """Base parameters of the load."""
    residual: tuple[LoadResidual, ...] = of(LoadResidual)
    validate: float | None
    """Residual of the logs for validation over their torques."""
    consistent: ConsistentBodies = of(ConsistentBodies, repr=False)
    remarks: tuple[str, ...] = ()
    updated: Model | None = field(default=None, repr=False)
    """The model with the values that were found."""
    update_refused: str | None = None
    """Why there is no such model, if there is none."""
    report: str | None = field(default=None, repr=False)
    """All of it as a page of HTML, if asked for."""

    def _title(self) -> str:
        return (
            f"{self.model}: {len(self.springs)} springs, "
            f"{len(self.parameters)} base parameters of the load"
        )

    def _rows(self) -> list[dict[str, Any]]:
        quantities = ("stiffness", "viscous", "coulomb", "preload", "motor_zero")
        rows: list[dict[str, Any]] = []
        for spring in self.springs:
            for quantity in quantities:
                one: Estimate = getattr(spring, quantity)
                name, of_spring = f"{quantity} of {spring.joint}", vars(one)
                rows.append({"name": name, **of_spring, "model_value": None, "status": "spring"})
        keys = ("name", "value", "std", "unit", "model_value", "status")
        return rows + [{key: getattr(one, key) for key in keys} for one in self.parameters]


def identify_two_stage(
    model: Model | PathLike,
    train: Log | list[Log],
    validate: Logs = (),
    *,
    joint_parameters: Iterable[JointParameters] = ("modelled",),
    keep: Iterable[str] = (),
    friction: str = "sign",
    skip_slow: str | float = "biasing",
    filter_hz: float | str | None = None,
    decimate: int | None = None,
    average: float | Literal["found"] | None = None,
    derivatives: Literal["differences", "logged"] = "differences",
    columns: PathLike | dict[str, Any] | None = None,
    accept_suspicious: bool = False,
    accept_cut: bool = False,
    update: bool = True,
    report: bool = False,
    svg: PathLike | None = None,
    progress: Progress | None = None,
) -> TwoStageIdentification:
    """Identifies series elastic drives: stiffness and motor friction first, then the load, with
    what the springs pass on.

    ``train`` is one log, with columns ``motor_JOINT`` [rad] and ``tau_cmd_JOINT`` [N m] of the
    drives with springs; ``validate`` are logs of other motions. The first stage takes a tenth of
    the sampling rate, the second ``filter_hz``. The other options are those of :func:`identify`.
    """
    with _options.folder() as inside:
        effects, place = as_place(model, inside)
        logs, memory = _logs.given(train=train, validate=validate)
        arguments = ["identify", place, *effects, *logs, "--two-stage"]
        if columns is not None:
            arguments += ["--columns", _options.file_of(columns, "columns", inside)]
        page = inside / "report.html" if report else None
        arguments += _options.flags(
            keep=keep, friction=friction, skip_slow=skip_slow, filter=filter_hz,
            decimate=decimate, average=average, derivatives=derivatives,
            accept_suspicious=accept_suspicious, accept_cut=accept_cut, html=page, svg=svg,
            **{"with": joint_parameters},
        )  # fmt: skip
        out = inside / "updated.json" if update else None
        found, refused = answered_with_model(arguments, out, progress, memory)
        updated = None if out is None or refused else updated_model(out, model)
        text = page.read_text() if page else None
    return answer(
        TwoStageIdentification, found, updated=updated, update_refused=refused, report=text
    )
