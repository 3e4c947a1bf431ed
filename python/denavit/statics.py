"""What weighings and held postures say of parameters, alone or joined with logs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from . import _logs, _options
from ._logs import Logs
from ._options import PathLike, Progress
from ._results import Answer, answer, of
from .base import JointParameters
from .model import Model, as_place


@dataclass(frozen=True, kw_only=True)
class StaticParameter:
    """A parameter of the model, and what follows of it."""

    name: str
    unit: str
    value: float | None
    """None where it does not follow alone."""
    std: float | None
    """Its standard error."""
    model_value: float | None
    identifiable: bool
    """Whether it follows alone."""


@dataclass(frozen=True, kw_only=True)
class Combination:
    """A sum of parameters that follows."""

    members: Mapping[str, float]
    """Factors of the parameters, by their names."""
    value: float
    std: float
    """Its standard error."""

    def __str__(self) -> str:
        text = " + ".join(
            name if abs(factor - 1) < 1e-12 else f"{factor:.5g} {name}"
            for name, factor in self.members.items()
        )
        return text.replace("+ -", "- ")


@dataclass(frozen=True, kw_only=True)
class Statics(Answer):
    """What follows from measurements at rest. ``is_good``: something, and no contradiction."""

    model: str
    equations: int
    """How many the measurements are, and the logs."""
    combinations: tuple[Combination, ...] = of(Combination)
    parameters: tuple[StaticParameter, ...] = of(StaticParameter, repr=False)
    chi_squared: float
    """What the equations miss each other by, in squares of their deviations."""
    degrees_of_freedom: int
    """Equations that are more than needed; about as large as ``chi_squared`` if all is well."""
    contradicts: bool
    """Whether they cannot all be true."""
    remarks: tuple[str, ...] = field(default=())

    def _title(self) -> str:
        alone = sum(one.identifiable for one in self.parameters)
        return (
            f"{self.model}: {self.equations} equations determine {len(self.combinations)} "
            f"combinations of {len(self.parameters)} parameters, of which {alone} stand alone"
        )

    def _rows(self) -> list[dict[str, Any]]:
        known = {one.name: one for one in self.parameters}

        def row(one: Combination) -> dict[str, Any]:
            values = [(factor, known[name].model_value) for name, factor in one.members.items()]
            numbers = [factor * value for factor, value in values if value is not None]
            return {
                "combination": str(one),
                "value": one.value,
                "std": one.std,
                "unit": next((known[name].unit for name in one.members), ""),
                "model_value": sum(numbers) if len(numbers) == len(values) else None,
            }

        return [row(one) for one in self.combinations]


def identify_statics(
    model: Model | PathLike,
    measurements: PathLike | Mapping[str, Any],
    train: Logs = (),
    *,
    method: Literal["ols", "wls", "huber", "bisquare", "tls", "ml"] = "wls",
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
    columns: PathLike | dict[str, Any] | None = None,
    accept_suspicious: bool = False,
    accept_cut: bool = False,
    progress: Progress | None = None,
) -> Statics:
    """Which parameters, or sums of them, follow from measurements at rest.

    ``measurements`` is a file of the format ``denavit-statics/1``, or a dict of ``weighings`` and
    ``postures``: ``{"links": ["link1"], "mass_kg": 2.0, "std_kg": 0.01}``, and ``{"q": {"link1":
    0.5}, "torques": {"link1": {"torque": 14.3, "std": 0.02}}}`` with the positions of all joints
    [rad, m] and torques [N m, N]. Logs of ``train`` are joined with them, with the options of
    :func:`identify`.
    """
    if isinstance(measurements, Mapping):
        measurements = {"format": "denavit-statics/1", **measurements}
    with _options.folder() as inside:
        effects, place = as_place(model, inside)
        logs, memory = _logs.given(train=train)
        file = _options.file_of(measurements, "measurements", inside)
        arguments = ["identify", place, *effects, *logs, "--static", file]
        if columns is not None:
            arguments += ["--columns", _options.file_of(columns, "columns", inside)]
        arguments += _options.flags(
            method=method, errors=errors, seed=seed, keep=keep, friction=friction,
            skip_slow=skip_slow, filter=filter_hz, decimate=decimate, average=average,
            derivatives=derivatives, prior=prior, resolution=resolution,
            accept_suspicious=accept_suspicious, accept_cut=accept_cut,
            **{"with": joint_parameters},
        )  # fmt: skip
        found = _options.answered(arguments, progress, memory)
    return answer(Statics, found)
