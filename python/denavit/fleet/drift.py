"""Drift of parameters over all nights: their slope, and the night since which they are others."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .changes import Estimate, variance
from .distributions import two_sided
from .testing import adjusted, combined


@dataclass(frozen=True)
class Drift:
    """A parameter of a robot over its nights."""

    robot: str
    name: str
    slope: float
    """Per night."""
    slope_error: float
    since: int | None
    """The place of the first night after the largest step; None with fewer than two nights."""
    before: float | None
    after: float | None
    p: float
    """That there is no step, wherever it may be."""
    is_change: bool = False


def drift(
    robot: str,
    name: str,
    places: Sequence[int],
    values: Sequence[Estimate],
    scatter: Sequence[tuple[float, float, float]],
) -> Drift:
    """The drift of values at places of nights. ``scatter`` is that of the robot: weights, variance
    ratios and degrees of freedom (:mod:`.scatter`).
    """
    weights = np.array([1 / variance(one) for one in values])
    y, x = np.array([one.value for one in values]), np.array(places, dtype=float)
    centre = weights @ x / weights.sum()
    width = float(weights @ (x - centre) ** 2)
    slope = float(weights @ ((x - centre) * y)) / width if width > 0 else 0.0
    expected = sum(weight * ratio for weight, ratio, _ in scatter)
    slope_error = math.sqrt(expected / width) if width > 0 else math.inf
    best: tuple[float, int, float, float] | None = None
    for at in range(1, len(y)):
        (first, second) = (slice(None, at), slice(at, None))
        sums = weights[first].sum(), weights[second].sum()
        means = weights[first] @ y[first] / sums[0], weights[second] @ y[second] / sums[1]
        t = abs(means[1] - means[0]) / math.sqrt(1 / sums[0] + 1 / sums[1])
        if best is None or t > best[0]:
            best = (float(t), at, float(means[0]), float(means[1]))
    if best is None:
        return Drift(robot, name, slope, slope_error, None, None, None, 1.0)
    t, at, before, after = best
    # the largest of so many steps
    p = sum(
        weight * two_sided(t / math.sqrt(ratio) if ratio > 0 else 0.0, degrees)
        for weight, ratio, degrees in scatter
    )
    p = min(1.0, (len(y) - 1) * p)
    return Drift(robot, name, slope, slope_error, places[at], before, after, p)


def changed(drifts: Sequence[Drift], rate: float) -> list[Drift]:
    """The same, with those marked that changed; ``rate`` bounds the false discovery rate of
    robots.
    """
    own: dict[str, list[int]] = {}
    for at, one in enumerate(drifts):
        own.setdefault(one.robot, []).append(at)
    values = {robot: np.array([drifts[at].p for at in places]) for robot, places in own.items()}
    least = adjusted(np.array([combined(each) for each in values.values()]))
    count = int((least <= rate).sum())
    marked: Mapping[int, bool] = {
        at: bool(is_one)
        for (robot, places), level in zip(own.items(), least)
        for at, is_one in zip(places, adjusted(values[robot]) <= rate * count / len(own))
        if level <= rate
    }
    return [
        Drift(**{**vars(one), "is_change": marked.get(at, False)}) for at, one in enumerate(drifts)
    ]
