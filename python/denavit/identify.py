"""Identification: parameters from logs, with standard errors."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from . import _logs, _options
from ._logs import Logs
from ._options import Columns, PathLike, Progress
from ._results import Answer, Latex, answer, of
from .base import JointParameters
from .errors import IdentifyError
from .model import Model, as_place


@dataclass(frozen=True, kw_only=True)
class IdentifiedParameter:
    """A base parameter that was looked for."""

    name: str
    expression: str
    latex: str
    value: float
    unit: str
    std: float | None
    """Its standard error; None where the motion does not show it."""
    interval: tuple[float, float] | None
    """Of 95 %."""
    status: str
    """``identified``, or why not."""
    identifiable: bool
    """Whether the motion shows it; if not, the value is the model's."""
    model_value: float | None
    noise_bias: float | None
    """What noise of the positions may have made of it, in standard errors."""


@dataclass(frozen=True, kw_only=True)
class JointResidual:
    """The residual of a joint's torque."""

    joint: str
    train: float
    """As a share of the torque (root mean squares)."""
    validate: float | None
    torque_rms: float
    """[N m, N]"""
    residual_rms: float


@dataclass(frozen=True, kw_only=True)
class Residual:
    """Size of the residual over that of the torque."""

    train: float
    validate: float | None
    before: float | None
    """With the values that the model had, on the logs for validation, or else the others."""
    per_joint: tuple[JointResidual, ...] = of(JointResidual)


@dataclass(frozen=True, kw_only=True)
class StandardParameter:
    """A parameter of the nearest bodies that can exist."""

    name: str
    unit: str
    value: float


@dataclass(frozen=True, kw_only=True)
class ConsistentBodies:
    """The bodies that can exist and are nearest to what was found."""

    distance: float
    """How far they are, in standard errors."""
    parameters: tuple[StandardParameter, ...] = of(StandardParameter, repr=False)


@dataclass(frozen=True, kw_only=True)
class Identification(Answer):
    """What was identified. ``is_good``: it explains the logs, and nothing speaks against it."""

    model: str
    rank: int
    """Number of base parameters."""
    excited: int
    """How many of them the motion shows."""
    samples: int
    condition: float | None
    scaled_condition: float | None
    noise_share: float
    parameters: tuple[IdentifiedParameter, ...] = of(IdentifiedParameter, repr=False)
    residual: Residual = of(Residual)
    consistent: ConsistentBodies = of(ConsistentBodies, repr=False)
    remarks: tuple[str, ...] = ()
    """What speaks against the logs or the estimate."""
    updated: Model | None = field(default=None, repr=False)
    """The model with the values that were found."""
    update_refused: str | None = None
    """Why there is no such model, if there is none."""
    report: str | None = field(default=None, repr=False)
    """All of it as a page of HTML, if asked for."""

    def _title(self) -> str:
        left = self.residual.train if self.residual.validate is None else self.residual.validate
        return (
            f"{self.model}: {self.excited} of {self.rank} base parameters, "
            f"{100 * left:.2f} % of the torques left"
        )

    def _rows(self) -> list[dict[str, Any]]:
        keys = ("name", "expression", "value", "std", "unit", "model_value", "status")
        return [{key: getattr(one, key) for key in keys} for one in self.parameters]

    def _repr_latex_(self) -> str:
        def line(one: IdentifiedParameter) -> str:
            error = "" if one.std is None else rf" \pm {one.std:.2g}"
            return rf"{one.latex} &= {one.value:.5g}{error}"

        lines = r" \\ ".join(line(one) for one in self.parameters)
        return Latex(rf"\begin{{aligned}}{lines}\end{{aligned}}")._repr_latex_()


def identify(
    model: Model | PathLike,
    train: Logs,
    validate: Logs = (),
    *,
    method: Literal["ols", "wls", "huber", "bisquare", "tls", "iv", "ml"] = "wls",
    errors: Literal["correlated", "classical", "bootstrap"] = "correlated",
    seed: int = 1,
    joint_parameters: Iterable[JointParameters] = ("modelled",),
    keep: Iterable[str] = (),
    friction: str = "sign",
    skip_slow: str | float = "biasing",
    filter_hz: float | str | None = None,
    decimate: int | None = None,
    average: float | Literal["found"] | None = None,
    derivatives: Literal["differences", "logged"] = "differences",
    prior: bool = False,
    resolution: float | None = None,
    instruments: Logs = (),
    controller: PathLike | dict[str, Any] | None = None,
    window_s: float | None = None,
    columns: PathLike | dict[str, Any] | None = None,
    accept_suspicious: bool = False,
    accept_cut: bool = False,
    update: bool = True,
    report: bool = False,
    svg: PathLike | None = None,
    motion_svg: PathLike | None = None,
    progress: Progress | None = None,
) -> Identification:
    """Identifies base parameters from logs of motion and torque.

    ``train`` and ``validate`` are logs: files of any format that denavit reads, runs of
    :func:`simulate`, data frames or dicts of columns. The options are those of
    ``denavit identify``: ``filter_hz`` is the cutoff of the zero-phase filter, with its order
    behind a colon perhaps ("20:2"), or "none"; ``columns`` maps columns of the logs to ours.
    ``update`` makes the model with the values that were found, ``report`` a page of HTML. ``svg``
    and ``motion_svg`` are where pictures go: of measured and computed torques, and of measured and
    simulated positions.
    """
    with _options.folder() as inside:
        effects, place = as_place(model, inside)
        logs, memory = _logs.given(train=train, validate=validate, instruments=instruments)
        arguments = ["identify", place, *effects, *logs]
        for flag, file in (("controller", controller), ("columns", columns)):
            if file is not None:
                arguments += [f"--{flag}", _options.file_of(file, flag, inside)]
        arguments += _options.flags(
            method=method, errors=errors, seed=seed, keep=keep, friction=friction,
            skip_slow=skip_slow, filter=filter_hz, decimate=decimate, average=average,
            derivatives=derivatives, prior=prior, resolution=resolution, window=window_s,
            accept_suspicious=accept_suspicious, accept_cut=accept_cut,
            svg=svg, motion_svg=motion_svg,
            html=inside / "report.html" if report else None,
            **{"with": joint_parameters},
        )  # fmt: skip
        out = inside / "updated.json" if update else None
        found, refused = answered_with_model(arguments, out, progress, memory)
        updated = None if out is None or refused else updated_model(out, model)
        page = (inside / "report.html").read_text() if report else None
    return answer(
        Identification, found, updated=updated, update_refused=refused, report=page
    )


def answered_with_model(
    arguments: list[str], out: Path | None, progress: Progress | None, logs: list[Columns]
) -> tuple[tuple[dict[str, Any], bool, list[str]], str | None]:
    """The answer, and why what was found makes no model."""
    if out is None:
        return _options.answered(arguments, progress, logs), None
    try:
        return _options.answered([*arguments, "--output", str(out)], progress, logs), None
    except IdentifyError as error:
        if error.file != "the identified model":
            raise
        # parameters are an answer without a model, too
        return _options.answered(arguments, progress, logs), str(error)


def updated_model(path: Path, model: object) -> Model:
    """The model that was written, with the effects of the one that was given."""
    effects = getattr(model, "_effects", None)
    text = path.read_text()
    return Model._made(path.stem, text, None if effects is None else Path(effects))
