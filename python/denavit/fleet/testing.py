"""Many tests at once: one p-value a robot, and a bound on the false discovery rate of a fleet."""

from __future__ import annotations

import numpy as np

from .._arrays import Array


def combined(values: Array) -> float:
    """One p-value of many, by Simes (1986): that none of them is of a change."""
    if not len(values):
        return 1.0
    ranks = np.arange(1, len(values) + 1)
    return float(min(1.0, np.min(np.sort(values) * len(values) / ranks)))


def adjusted(values: Array) -> Array:
    """p-values adjusted by Benjamini and Hochberg (1995): those of at most q are the discoveries
    among which at most the share q is expected to be false.
    """
    count = len(values)
    order = np.argsort(values, kind="stable")
    scaled = values[order] * count / np.arange(1, count + 1)
    found = np.empty(count)
    found[order] = np.minimum(1.0, np.minimum.accumulate(scaled[::-1])[::-1])
    return found
