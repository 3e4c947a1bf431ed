"""Simulation: robots in motion and on the ground."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from . import _denavit, _options
from ._arrays import Array
from ._options import PathLike, Progress
from ._results import Answer, of, pandas_package, read
from .errors import _argument


@dataclass(frozen=True, kw_only=True)
class JointTracking:
    """How a joint followed its reference; None where it has none, or no limit of torque."""

    joint: str
    unit: str
    """Of positions: rad or m."""
    final_error: float | None
    """Reference less position at the end."""
    largest_error: float | None
    largest_error_s: float | None
    """When that was."""
    torque_limit_share: float | None
    """The share of the time at the limit of torque."""


@dataclass(frozen=True, kw_only=True)
class ExceededLimit:
    """A limit of a joint that was exceeded."""

    joint: str
    quantity: str
    unit: str
    limit: float
    worst: float
    by: float
    at_s: float


@dataclass(frozen=True, kw_only=True)
class Run(Answer):
    """A run of a scenario. ``is_good``: it came to its end, and broke no law of mechanics."""

    scenario: str
    model: str
    scheme: str
    stop: str
    """Why it ended; ``end`` is its end."""
    message: str
    hint: str | None
    end_s: float
    events: int
    """Impacts and other changes of contacts."""
    steps: int
    audit: Mapping[str, Any] = field(repr=False)
    """The worst that each law of mechanics was missed by; units are in the names."""
    joints: tuple[JointTracking, ...] = of(JointTracking, repr=False)
    exceeded: tuple[ExceededLimit, ...] = of(ExceededLimit)
    broken: tuple[str, ...]
    """Laws that were missed by more than is tolerated."""
    columns: tuple[str, ...] = field(repr=False)
    """Names of the columns: t, q_JOINT, qd_JOINT, tau_JOINT, .."""
    values: Array = field(repr=False, compare=False)
    """The log, (rows, columns), in SI units; NaN where a column has no value."""

    def column(self, name: str) -> Array:
        """A column of the log, (rows,): a view, no copy."""
        if name not in self.columns:
            raise _argument(f"the log has no column `{name}`", ", ".join(self.columns))
        return self.values[:, self.columns.index(name)]

    def _columns(self, prefix: str) -> Array:
        places = [at for at, name in enumerate(self.columns) if name.startswith(prefix)]
        if places and places == list(range(places[0], places[-1] + 1)):
            return self.values[:, places[0] : places[-1] + 1]
        return self.values[:, places]

    @cached_property
    def t(self) -> Array:
        """Times (rows,) [s]."""
        return self.column("t")

    @cached_property
    def q(self) -> Array:
        """Positions (rows, n) [rad, m]."""
        return self._columns("q_")

    @cached_property
    def qd(self) -> Array:
        """Velocities (rows, n)."""
        return self._columns("qd_")

    @cached_property
    def tau(self) -> Array:
        """Torques (rows, n) [N m, N]."""
        places = [
            at
            for at, name in enumerate(self.columns)
            if name.startswith("tau_") and not name.startswith("tau_cmd_")
        ]
        return self.values[:, places]

    def to_pandas(self) -> Any:
        """The log as a data frame, with the time as its index. Needs pandas."""
        frame = pandas_package().DataFrame(self.values, columns=list(self.columns))
        return frame.set_index("t")

    def _title(self) -> str:
        return f"{self.scenario}: {self.message} at {self.end_s:.4g} s, {self.events} events"

    def _rows(self) -> list[dict[str, Any]]:
        return [vars(one) for one in self.joints]


def simulate(
    scenario: PathLike | Mapping[str, Any],
    *,
    scheme: Literal["event", "time-stepping"] | None = None,
    step_s: float | None = None,
    log: PathLike | None = None,
    svg: PathLike | None = None,
    window_s: tuple[float, float] | None = None,
    html: PathLike | None = None,
    beside: PathLike | None = None,
    shapes: PathLike | None = None,
    meshes: PathLike | None = None,
    progress: Progress | None = None,
) -> Run:
    """Runs a scenario: a path, a shipped name (:func:`denavit.shipped_scenarios`), or a scenario as
    a dict, whose ``model`` may be a :class:`Model`.

    ``log`` is where the log goes, as CSV or, of that ending, as MCAP; ``svg`` where a picture goes,
    of the part ``window_s`` of the run; ``html`` where a page goes, with the run in motion, and
    with that of the log ``beside`` of the same robot, if there is one. Links look there like the
    URDF ``shapes``, whose meshes lie beside it or in the folder ``meshes``.
    """
    with _options.folder() as inside:
        chosen = _options.flags(
            scheme=scheme, step=step_s, output=log, svg=svg, window=window_s, html=html,
            beside=beside, shapes=shapes, meshes=meshes,
        )
        place = _options.file_of(scenario, "scenario", inside)
        arguments = ["simulate", place, *chosen, "--json"]
        text, is_good, notes, columns, values = _denavit.simulate(arguments, progress)
    given = json.loads(text)
    return read(
        Run,
        given,
        is_good=is_good,
        notes=tuple(notes),
        json=given,
        columns=tuple(columns),
        values=values,
    )
