"""Results of a comparison: what each criterion of stability says of runs, and what comes out."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ._results import Answer, of


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What a criterion says of a run."""

    verdict: str
    """``met``, ``missed`` or ``silent``."""
    missed_at_s: float | None
    wrong: bool
    """Met, and the robot fell; or missed, and it did not."""

    def __str__(self) -> str:
        time = f" at {self.missed_at_s:.2f} s" if self.missed_at_s else ""
        return f"{self.verdict}{time}{' (!)' if self.wrong else ''}"


@dataclass(frozen=True, kw_only=True)
class Verdicts:
    """What the criteria say of a run."""

    zmp: Verdict = of(Verdict)
    """Zero moment point, exact."""
    cart_table: Verdict = of(Verdict)
    """Zero moment point of the cart-table model."""
    fri: Verdict = of(Verdict)
    """Foot rotation indicator."""
    capture: Verdict = of(Verdict)
    """Capture point."""
    momentum: Verdict = of(Verdict)
    """Angular momentum about the centre of mass."""
    poincare: Verdict = of(Verdict)
    """Floquet multipliers of the cycle."""


@dataclass(frozen=True, kw_only=True)
class WalkingEnergy:
    """What a gait costs."""

    speed_m_s: float
    cost_of_transport: float
    """Absolute power of the joints, integrated, over weight times distance."""
    torque_squared: float
    """Integral of the squared torques over the distance [N^2 m s]."""


@dataclass(frozen=True, kw_only=True)
class ComparedRun:
    """A run, and what each criterion says of it."""

    scenario: str
    outcome: str
    """``fall``, ``end``, or why else the run ended."""
    end_s: float
    falls_are_seen: bool
    """Whether anything of the model counts as a fall."""
    criteria: Verdicts = of(Verdicts, repr=False)
    largest_angular_momentum: float
    """About the lateral axes [kg m^2/s]."""
    largest_multiplier: float | None
    """Of the cycle, if there is one."""
    energy: WalkingEnergy | None = of(WalkingEnergy, default=None)


@dataclass(frozen=True, kw_only=True)
class Comparison(Answer):
    """Criteria of stability compared on runs. (!) marks a verdict that is wrong."""

    runs: tuple[ComparedRun, ...] = of(ComparedRun)
    report: str | None = field(default=None, repr=False)
    """All of it as a page of HTML, if asked for."""

    def _title(self) -> str:
        return f"Criteria of stability on {len(self.runs)} runs"

    def _rows(self) -> list[dict[str, Any]]:
        def row(run: ComparedRun) -> dict[str, Any]:
            verdicts = {name: str(verdict) for name, verdict in vars(run.criteria).items()}
            return {"scenario": run.scenario, "outcome": run.outcome, "end_s": run.end_s} | verdicts

        return [row(run) for run in self.runs]
