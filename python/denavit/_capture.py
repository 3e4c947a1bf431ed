"""Results on capture points: how many steps a robot needs to come to rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ._results import Answer, of


@dataclass(frozen=True, kw_only=True)
class Reach:
    """How far the capture point may be from the ankle that stands [m]."""

    steps: int
    """With so many steps, at most."""
    backward_m: float
    forward_m: float


@dataclass(frozen=True, kw_only=True)
class ReachLimit:
    """The reach of ever more steps [m]."""

    backward_m: float
    forward_m: float


@dataclass(frozen=True, kw_only=True)
class CapturePoint:
    """A capture point that was asked for."""

    capture_m: float
    """Forward from the ankle that stands [m]."""
    steps: int | None
    """How many steps it needs; None: the robot falls."""
    region_m: tuple[float, float] | None
    """Where the foot may land at the least time of a step, from the ankle that stands [m]."""


@dataclass(frozen=True, kw_only=True)
class Capturability(Answer):
    """From which capture points no step, one, or more are enough, by the linear inverted pendulum
    with a sole. Places are forward from the ankle that stands.
    """

    scenario: str
    height_m: float
    """Of the centre of mass above the ground."""
    omega_per_s: float
    """sqrt(g / height)."""
    heel_m: float
    """Length of the sole behind the ankle."""
    toe_m: float
    """Length of the sole before the ankle."""
    step_s: float
    """The least time of a step."""
    longest_step_m: tuple[float, float]
    """From ankle to ankle, backward and forward."""
    reach: tuple[Reach, ...] = of(Reach)
    limit: ReachLimit = of(ReachLimit)
    capture: CapturePoint | None = of(CapturePoint, default=None)

    def _title(self) -> str:
        limit = self.limit
        return f"{self.scenario}: falls beyond -{limit.backward_m:.4g} and {limit.forward_m:.4g} m"

    def _rows(self) -> list[dict[str, Any]]:
        return [vars(one) for one in self.reach]


@dataclass(frozen=True, kw_only=True)
class CapturePush:
    """A push, the steps that are predicted, and those that were made."""

    impulse_ns: float
    """Along x; backward negative [N s]."""
    capture_m: float
    """The capture point just after the push, forward from the nearest ankle [m]."""
    predicted_steps: int | None
    """None: a fall is predicted, or nothing."""
    steps: int
    outcome: str
    """``stands``, ``moves``, or how the run ended."""
    agrees: bool
    """Whether the prediction was right."""


@dataclass(frozen=True, kw_only=True)
class CaptureSteps(Answer):
    """Pushes of a robot that steps onto its capture point."""

    scenario: str
    agree: int
    """How many pushes were as predicted."""
    pushes: tuple[CapturePush, ...] = of(CapturePush)

    def _title(self) -> str:
        return f"{self.scenario}: {self.agree} of {len(self.pushes)} pushes as predicted"

    def _rows(self) -> list[dict[str, Any]]:
        return [vars(one) for one in self.pushes]
