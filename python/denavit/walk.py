"""Walking: gaits, and what each criterion of stability says of them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from . import _options
from ._options import PathLike, Progress
from ._results import Answer, answer, of

Place = PathLike | Mapping[str, Any]
"""A file, a shipped name, or its content as a dict."""


@dataclass(frozen=True, kw_only=True)
class Knot:
    """A posture of a gait."""

    t_s: float
    name: str
    solved: bool
    """Whether inverse kinematics was solved here, not only checked."""
    residual: float
    static_margin_m: float | None
    zmp_margin_m: float | None
    q: Mapping[str, float] = field(repr=False)
    """Joint positions by name [rad, m]."""


@dataclass(frozen=True, kw_only=True)
class Gait(Answer):
    """A gait that was designed."""

    gait: str
    kind: str
    model: str
    step_length_m: float
    step_s: float
    steps: float
    speed_m_s: float
    largest_multiplier: float | None = None
    """Of a limit cycle."""
    knots: tuple[Knot, ...] = of(Knot, repr=False)
    scenario: Mapping[str, Any] = field(repr=False, default_factory=dict)
    """The scenario that walks: for :func:`denavit.simulate`."""

    def save(self, path: PathLike) -> None:
        """Writes the scenario."""
        Path(path).write_text(json.dumps(self.scenario, indent=2) + "\n")

    def _title(self) -> str:
        return f"{self.gait}: {self.kind} for {self.model}, {self.speed_m_s:.3f} m/s"

    def _rows(self) -> list[dict[str, Any]]:
        keys = ("t_s", "name", "residual", "static_margin_m", "zmp_margin_m")
        return [{key: getattr(one, key) for key in keys} for one in self.knots]


@dataclass(frozen=True, kw_only=True)
class Margin:
    """Distances of a point of the ground to the edges of the support polygon, along a run."""

    margin_min_m: float
    """The least; below 0 outside."""
    margin_min_at_s: float
    margin_max_m: float
    outside_share: float
    """The share of the time outside."""


@dataclass(frozen=True, kw_only=True)
class Balance(Answer):
    """What a criterion says along a run; points that it does not have are None."""

    name: str = field(metadata={"name": "of"})
    model: str
    over: str
    """``stride``, ``step`` or ``run``."""
    duration_s: float
    shares: Mapping[str, float]
    """Shares of the time on a flat foot, a toe, both feet, in flight, on one point."""
    exact: Margin | None = of(Margin, default=None)
    cart_table: Margin | None = of(Margin, default=None)
    fri: Margin | None = of(Margin, default=None)
    capture: Margin | None = of(Margin, default=None)

    def _title(self) -> str:
        return f"{self.name}: over one {self.over}"

    def _rows(self) -> list[dict[str, Any]]:
        points = ("exact", "cart_table", "fri", "capture")
        found = [(point, getattr(self, point)) for point in points]
        return [{"point": point, **vars(one)} for point, one in found if one is not None]


@dataclass(frozen=True, kw_only=True)
class Cycle(Answer):
    """The cycle of a gait. ``is_good``: it is stable."""

    scenario: str
    model: str
    period_s: float
    cycle: str
    """``step`` or ``stride``."""
    largest: float
    """The largest modulus of a Floquet multiplier; below 1 deviations die."""
    stable: bool
    multipliers: tuple[tuple[float, float], ...]
    """Real and imaginary parts, the largest first."""
    fixed_point: Mapping[str, Any] = field(repr=False)

    def _title(self) -> str:
        word = "stable" if self.stable else "not stable"
        return f"{self.scenario}: {word}, largest multiplier {self.largest:.4g}"

    def _rows(self) -> list[dict[str, Any]]:
        return [{"real": one[0], "imaginary": one[1]} for one in self.multipliers]


@dataclass(frozen=True, kw_only=True)
class Basin(Answer):
    """From which starts a gait goes on."""

    scenario: str
    starts: int
    walks: int
    """How many still walk at the end."""
    cycles: int
    outcomes: Mapping[str, int]
    falls_are_seen: bool

    def _rows(self) -> list[dict[str, Any]]:
        return [{"outcome": name, "starts": count} for name, count in self.outcomes.items()]


@dataclass(frozen=True, kw_only=True)
class LeastPush:
    """The least impulse that fells a robot; None where the strongest does not."""

    at_s: float
    direction: str
    least_impulse_ns: float | None
    outcome: str


@dataclass(frozen=True, kw_only=True)
class Pushes(Answer):
    """Which push fells a robot."""

    scenario: str
    link: str
    resolution_ns: float
    falls_are_seen: bool
    pushes: tuple[LeastPush, ...] = of(LeastPush)

    def _rows(self) -> list[dict[str, Any]]:
        return [vars(one) for one in self.pushes]


def _answered(
    command: str, place: Place, chosen: list[str], progress: Progress | None
) -> tuple[dict[str, Any], bool, list[str]]:
    with _options.folder() as inside:
        file = _options.file_of(place, "scenario", inside)
        return _options.answered(["walk", command, file, *chosen], progress)


def design(gait: Place, *, progress: Progress | None = None) -> Gait:
    """Designs a gait: from a gait file, a shipped one or a dict to a scenario that walks."""
    with _options.folder() as inside:
        place, out = _options.file_of(gait, "gait", inside), inside / "walks.json"
        found = _options.answered(["walk", "design", place, "--output", str(out)], progress)
        scenario = json.loads(out.read_text())
    return answer(Gait, found, scenario=scenario)


def balance(
    scenario: Place,
    criterion: Literal["zmp", "fri", "capture", "momentum"] = "zmp",
    *,
    whole: bool = False,
    period_s: float | None = None,
    progress: Progress | None = None,
) -> Balance:
    """What a criterion says along a cycle of a gait, or along the ``whole`` run."""
    chosen = _options.flags(whole=whole, period=period_s)
    return answer(Balance, _answered(criterion, scenario, chosen, progress))


def poincare(scenario: Place, *, progress: Progress | None = None) -> Cycle:
    """The cycle of a scenario or of a gait, and its Floquet multipliers."""
    return answer(Cycle, _answered("poincare", scenario, [], progress))


def basin(
    scenario: Place,
    *,
    vary: tuple[str, str] | None = None,
    reach: tuple[float, float] | None = None,
    grid: int | None = None,
    noise: float | None = None,
    starts: int | None = None,
    seed: int | None = None,
    steps: int = 10,
    progress: Progress | None = None,
) -> Basin:
    """Walks from starts around the cycle of a gait: on a grid of two coordinates, or at random with
    ``noise`` [rad/s].
    """
    chosen = _options.flags(
        vary=vary, reach=reach, grid=grid, noise=noise, starts=starts, seed=seed, steps=steps
    )
    return answer(Basin, _answered("basin", scenario, chosen, progress))


def push(
    scenario: Place,
    *,
    link: str | None = None,
    times: int = 12,
    most_ns: float = 20.0,
    resolution_ns: float | None = None,
    after_s: float = 4.0,
    progress: Progress | None = None,
) -> Pushes:
    """The least impulse that fells a robot, over the time in its step and the direction."""
    chosen = _options.flags(
        link=link, times=times, most=most_ns, resolution=resolution_ns, after=after_s
    )
    return answer(Pushes, _answered("push", scenario, chosen, progress))
