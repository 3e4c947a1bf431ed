"""Diagnosis: which physics a model lacks, where, and how sure that is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import _logs, _options
from ._logs import Logs
from ._options import PathLike, Progress
from ._results import Answer, answer, of
from .model import Model, as_place


@dataclass(frozen=True, kw_only=True)
class EffectValue:
    """The value of a parameter of an effect."""

    value: float
    std: float | None
    unit: str


@dataclass(frozen=True, kw_only=True)
class OtherName:
    """An effect that would do as well."""

    effect: str
    at: str
    log_odds: float
    """Of the effect that was found against it."""
    exact: bool
    """Whether no motion tells the two apart."""


@dataclass(frozen=True, kw_only=True)
class FoundEffect:
    """An effect that the model lacks."""

    effect: str
    at: str
    """Its joint, or its joints."""
    log_odds: float
    """The logarithm of the odds that it is there."""
    size: float
    """What it does, as a share of the torque of its joint."""
    share: float
    parameters: Mapping[str, Mapping[str, Any]]
    indistinguishable: tuple[OtherName, ...] = of(OtherName)
    finer: tuple[OtherName, ...] = of(OtherName, default=())
    """Finer forms of the same law that the logs do not ask for."""
    exact_alias: tuple[str, ...] = ()
    """Parameters of the model that do exactly the same, whatever the motion."""
    separating_experiment: Mapping[str, Any] | None = field(default=None, repr=False)
    """A motion that would tell these apart."""

    @property
    def values(self) -> dict[str, EffectValue]:
        """The values of its parameters."""
        return {name: EffectValue(**value) for name, value in self.parameters.items()}


@dataclass(frozen=True, kw_only=True)
class Mismatch:
    """Torque mismatch: size of the residual over that of the torque."""

    before: float
    after: float
    floor: float
    """What noise leaves."""


@dataclass(frozen=True, kw_only=True)
class Mismatches:
    """The same on the logs that were searched, and on those that judge."""

    train: Mismatch = of(Mismatch)
    validate: Mismatch = of(Mismatch)


@dataclass(frozen=True, kw_only=True)
class Diagnosis(Answer):
    """What a model lacks. ``is_good``: nothing, or what was named explains the logs."""

    model: str
    verdict: str
    reasons: tuple[str, ...]
    effects: tuple[FoundEffect, ...] = of(FoundEffect)
    nearest: tuple[FoundEffect, ...] = of(FoundEffect, default=())
    """Effects that are only near to what has no name."""
    gap: Mismatches = of(Mismatches)
    share_closed: float | None = None
    """How much of the mismatch was explained, of what noise does not leave."""
    filter_hz: float
    remarks: tuple[str, ...] = ()
    completed: Model | None = field(default=None, repr=False)
    """The model with the effects that were named."""
    report: str | None = field(default=None, repr=False)
    """All of it as a page of HTML, if asked for."""

    def _title(self) -> str:
        return f"{self.model}: {self.verdict}"

    def _rows(self) -> list[dict[str, Any]]:
        def row(one: FoundEffect) -> dict[str, Any]:
            values = ", ".join(
                f"{name} = {value.value:.4g} {value.unit}" for name, value in one.values.items()
            )
            others = ", ".join(f"{other.effect} at {other.at}" for other in one.indistinguishable)
            return {
                "effect": one.effect,
                "at": one.at,
                "values": values,
                "log odds": one.log_odds,
                "size": one.size,
                "or": others,
            }

        return [row(one) for one in self.effects]


def diagnose(
    model: Model | PathLike,
    train: Logs,
    validate: Logs,
    *,
    most: int = 6,
    seed: int = 1,
    filter_hz: float | None = None,
    time_limit_s: float | None = None,
    columns: PathLike | dict[str, Any] | None = None,
    accept_suspicious: bool = False,
    accept_cut: bool = False,
    report: bool = False,
    progress: Progress | None = None,
) -> Diagnosis:
    """Looks for effects of the catalogue that explain what the model leaves of the torques.

    ``train`` are logs to search, ``validate`` logs of another motion to judge with. ``report`` also
    looks for motions that separate names, completes the model, and makes a page of HTML; it takes
    longer. With ``time_limit_s`` the answer is the best until then.
    """
    with _options.folder() as inside:
        effects, place = as_place(model, inside)
        logs, memory = _logs.given(train=train, validate=validate)
        arguments = ["diagnose", place, *effects, *logs]
        if columns is not None:
            arguments += ["--columns", _options.file_of(columns, "columns", inside)]
        out = inside / "found"
        arguments += _options.flags(
            most=most, seed=seed, filter=filter_hz, time_limit=time_limit_s,
            accept_suspicious=accept_suspicious, accept_cut=accept_cut,
            out=out if report else None,
        )  # fmt: skip
        found = _options.answered(arguments, progress, memory)
        page = (out / "report.html").read_text() if report else None
        completed = _completed(out)
    return answer(Diagnosis, found, completed=completed, report=page)


def _completed(out: Path) -> Model | None:
    path = out / "model.json"
    if not path.exists():
        return None
    effects = out / "effects"
    return Model._made("model", path.read_text(), effects if effects.is_dir() else None)
