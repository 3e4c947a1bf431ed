"""Walking: gaits, and what each criterion of stability says of them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from . import _denavit, _options
from ._capture import Capturability as Capturability
from ._capture import CapturePush as CapturePush
from ._capture import CaptureSteps as CaptureSteps
from ._comparison import ComparedRun as ComparedRun
from ._comparison import Comparison as Comparison
from ._comparison import Verdict as Verdict
from ._options import PathLike, Progress
from ._results import Answer, answer, of
from ._series import Series as Series
from ._series import read_series
from .model import Model, as_place

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
    angular_momentum_x: tuple[float, float] | None = None
    """The least and the largest, about the centre of mass [kg m^2/s]; of the criterion momentum."""
    angular_momentum_y: tuple[float, float] | None = None
    angular_momentum_z: tuple[float, float] | None = None
    series: Series | None = field(default=None, repr=False, compare=False)
    """All criteria, row by row: ``t``, ``com_x``, ``zmp_x``, ``zmp_margin``, .. [s, m]."""

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
    contradiction: str | None = None
    """Where central differences or other sections say otherwise."""
    travel_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """How far a cycle goes (x, y, z)."""
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
    series: Series | None = field(default=None, repr=False, compare=False)
    """The starts, row by row: deviations from the cycle, ``walks``, ``cycles``, ``distance``."""

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


def _with_series(
    command: str, place: Place, chosen: list[str], progress: Progress | None
) -> tuple[tuple[dict[str, Any], bool, list[str]], Series]:
    with _options.folder() as inside:
        file, out = _options.file_of(place, "scenario", inside), inside / "series.csv"
        arguments = ["walk", command, file, *chosen, "--output", str(out)]
        return _options.answered(arguments, progress), read_series(out)


def design(
    gait: Place,
    *,
    trajectory: PathLike | None = None,
    svg: PathLike | None = None,
    progress: Progress | None = None,
) -> Gait:
    """Designs a gait: from a gait file, a shipped one or a dict to a scenario that walks.

    ``trajectory`` is where the joint references alone go, ``svg`` where a picture of a step goes.
    """
    with _options.folder() as inside:
        place, out = _options.file_of(gait, "gait", inside), inside / "walks.json"
        chosen = _options.flags(output=out, trajectory=trajectory, svg=svg)
        found = _options.answered(["walk", "design", place, *chosen], progress)
        scenario = json.loads(out.read_text())
    return answer(Gait, found, scenario=scenario)


def balance(
    scenario: Place,
    criterion: Literal["zmp", "fri", "capture", "momentum"] = "zmp",
    *,
    model: Model | PathLike | None = None,
    whole: bool = False,
    period_s: float | None = None,
    events: PathLike | None = None,
    svg: PathLike | None = None,
    progress: Progress | None = None,
) -> Balance:
    """What a criterion says along a cycle of a gait, or along the ``whole`` run; or, with the
    ``model`` of its robot, along a log: a CSV file that :func:`denavit.simulate` wrote.

    ``period_s`` is the distance of the instants that are looked at. ``events`` is where impulses
    and velocities around them go, as CSV, and ``svg`` where a picture goes.
    """
    chosen = _options.flags(whole=whole, period=period_s, events=events, svg=svg)
    if model is None:
        found, series = _with_series(criterion, scenario, chosen, progress)
    else:
        with _options.folder() as inside:
            # a log's folder of effects is that beside the file of the model
            _, place = as_place(model, inside)
            chosen += ["--model", place]
            found, series = _with_series(criterion, scenario, chosen, progress)
    return answer(Balance, found, series=series)


def poincare(
    scenario: Place,
    *,
    section: Literal["strike"] | float | None = None,
    approach: int = 4,
    unchecked: bool = False,
    off_rad_s: float = 0.1,
    returns: int = 12,
    map: PathLike | None = None,
    svg: PathLike | None = None,
    progress: Progress | None = None,
) -> Cycle:
    """The cycle of a scenario or of a gait, and its Floquet multipliers.

    ``section`` is where the cycle is looked at: ``"strike"``, or a share of it from 0 to 1.
    ``approach`` steps go before. ``unchecked`` leaves out the comparison with central differences
    and other sections. The way back, from two velocities that are ``off_rad_s`` off, is followed
    for so many ``returns``. ``map`` and ``svg`` are where its picture and that of the multipliers
    go.
    """
    chosen = _options.flags(
        section=section, approach=approach, unchecked=unchecked, off=off_rad_s,
        returns=returns, map=map, svg=svg,
    )  # fmt: skip
    return answer(Cycle, _answered("poincare", scenario, chosen, progress))


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
    svg: PathLike | None = None,
    progress: Progress | None = None,
) -> Basin:
    """Walks from starts around the cycle of a gait: on a grid of two coordinates, or at random with
    ``noise`` [rad/s]. ``svg`` is where the map of a grid goes.
    """
    chosen = _options.flags(
        vary=vary, reach=reach, grid=grid, noise=noise, starts=starts, seed=seed, steps=steps,
        svg=svg,
    )  # fmt: skip
    found, series = _with_series("basin", scenario, chosen, progress)
    return answer(Basin, found, series=series)


def push(
    scenario: Place,
    *,
    link: str | None = None,
    times: int = 12,
    only: int | None = None,
    most_ns: float = 20.0,
    resolution_ns: float | None = None,
    after_s: float = 4.0,
    svg: PathLike | None = None,
    progress: Progress | None = None,
) -> Pushes:
    """The least impulse that fells a robot, over the time in its step and the direction. ``only``
    is the one of the ``times`` that is tried, from 0; ``svg`` is where the map goes.
    """
    chosen = _options.flags(
        link=link, times=times, only=only, most=most_ns, resolution=resolution_ns,
        after=after_s, svg=svg,
    )  # fmt: skip
    return answer(Pushes, _answered("push", scenario, chosen, progress))


def capturability(
    scenario: Place,
    *,
    height_m: float | None = None,
    step_time_s: float | None = None,
    longest_step_m: float | None = None,
    steps: int = 5,
    capture_m: float | None = None,
    svg: PathLike | None = None,
    progress: Progress | None = None,
) -> Capturability:
    """From which capture points no step, one, or more are enough to come to rest.

    A scenario whose controller steps says what it can do; of others the sole and the height of the
    centre of mass at the start count. ``height_m``, ``step_time_s`` (the least time of a step) and
    ``longest_step_m`` replace what it says. ``steps`` is the largest number that is listed,
    ``capture_m`` a capture point that is asked for, forward from the ankle that stands. ``svg`` is
    where a picture goes.
    """
    chosen = _options.flags(
        height=height_m, step_time=step_time_s, longest_step=longest_step_m, steps=steps,
        capture=capture_m, svg=svg,
    )  # fmt: skip
    return answer(Capturability, _answered("capturability", scenario, chosen, progress))


def capture_steps(
    scenario: Place,
    *,
    impulses_ns: Iterable[float] | None = None,
    most_ns: float | None = None,
    pushes: int | None = None,
    after_s: float = 4.0,
    progress: Progress | None = None,
) -> CaptureSteps:
    """Pushes a robot that steps onto its capture point: the steps predicted, and those it makes.

    The impulses are ``impulses_ns`` along x, backward negative, or so many ``pushes`` (15) from
    the strongest backward to the strongest forward, ``most_ns`` (28). Point and time are those of
    the first push of the scenario. The robot has ``after_s`` to come to rest.
    """
    chosen = _options.flags(impulses=impulses_ns, most=most_ns, pushes=pushes, after=after_s)
    return answer(CaptureSteps, _answered("capture-steps", scenario, chosen, progress))


def compare(
    scenarios: Place | list[Place] | tuple[Place, ...] = (),
    *,
    period_s: float = 0.001,
    report: bool = False,
    progress: Progress | None = None,
) -> Comparison:
    """What each criterion of stability says of runs, and what comes out.

    Without ``scenarios`` the examples of the thesis are run. ``period_s`` is the distance of the
    instants that are looked at; ``report`` adds a page of HTML.
    """
    listed = scenarios if isinstance(scenarios, (list, tuple)) else [scenarios]
    with _options.folder() as inside:
        files = [
            _options.file_of(one, f"scenario_{at + 1}", inside) for at, one in enumerate(listed)
        ]
        page = inside / "report.html" if report else None
        chosen = _options.flags(period=period_s, html=page)
        found = _options.answered(["walk", "compare", *files, *chosen], progress)
        text = page.read_text() if page else None
    return answer(Comparison, found, report=text)


def page(scenario: Place, *, period_s: float = 0.001, progress: Progress | None = None) -> str:
    """A scenario or a gait on one page of HTML: joints, snapshots, zero moment point, the way back
    to the cycle, multipliers.
    """
    with _options.folder() as inside:
        file, out = _options.file_of(scenario, "scenario", inside), inside / "page.html"
        chosen = _options.flags(period=period_s, output=out)
        _denavit.run(["walk", "page", file, *chosen], progress)
        return out.read_text()
