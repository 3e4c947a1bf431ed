"""How much more values scatter from night to night than their standard errors say.

Standard errors know the noise of one night. Temperature, wear and motions that differ scatter
values beyond it. The excess of a robot's parameter is a variance ratio: 1 where the stated errors
are right. That of one robot is known from few nights. So it is drawn towards that of the fleet, as
Smyth (2004) does with variances of genes: ratios of robots follow an inverse chi-squared
distribution, whose scale and degrees of freedom are fitted to the whole fleet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .._arrays import Array

DEGREES = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64, math.inf)
"""Degrees of freedom that are tried for the fleet; infinite: all robots scatter alike."""
CHANGED = (0.0, 0.02, 0.05, 0.1, 0.2, 0.3)
"""Shares of robots that may have changed: their ratios tell nothing about scatter. Each is half as
probable as the one before: most parameters of most robots do not change in a night."""
STEP, REACH = 0.1, 6.0
"""Grid of the logarithm of the fleet's ratio, about its median."""
DECADES = 4
"""Ratios of robots that changed are alike in each decade above those that scatter."""
MOST = 400
"""Ratios of a fit; of more, so many evenly spaced order statistics stand for all."""


@dataclass(frozen=True)
class Scatter:
    """The excess scatter of a parameter in a fleet, for each of the :data:`DEGREES`."""

    ratios: tuple[float, ...]
    """Variance from night to night over that of the stated errors."""
    weights: tuple[float, ...]
    """How probable so many degrees of freedom are: how alike robots are."""
    pooled: float
    """Degrees of freedom of all that was fitted: no robot has more."""

    def beside(self) -> Scatter:
        """The same for a robot that is none of those that were fitted."""
        return Scatter(self.ratios, self.weights, self.pooled + 1)

    def of_robot(self, own: float, degrees: float) -> list[tuple[float, float, float]]:
        """Weight, ratio and degrees of freedom of a robot with an own estimate."""
        found = []
        for ratio, weight, prior in zip(self.ratios, self.weights, DEGREES):
            both = prior + degrees
            drawn = ratio if math.isinf(prior) else (prior * ratio + degrees * own) / both
            found.append((weight, drawn, min(both, self.pooled - 1)))
        return found


Ratios = tuple[Array, Array]
"""Variance ratios of a parameter, and the degrees of freedom of each."""


def fitted(parameters: Sequence[Ratios], known: Sequence[Ratios] = ()) -> list[Scatter]:
    """The scatter of each parameter, of its variance ratios. How alike robots are is one number for
    all parameters: else a change of some robots in one of them would pass for robots that differ.
    It is known with a probability only, and tests take the mean over it. Some ratios may be those
    of robots that changed: so ``known`` ones, of nights that were accepted, say how alike robots
    are, as soon as they say as much as those of this night.
    """
    profiles = [_profile(ratios, degrees) for ratios, degrees in parameters]
    if not profiles:
        return []
    all_degrees, before = (
        sum(float(degrees.sum()) for _, degrees in each) for each in (parameters, known)
    )
    alike = profiles
    if 0 < before and 2 * before >= all_degrees:
        alike = [_profile(ratios, degrees) for ratios, degrees in known]
    total = np.sum([likelihoods for likelihoods, _ in alike], axis=0)
    weights = np.exp(total - total.max())
    weights /= weights.sum()
    return [
        Scatter(tuple(scales.tolist()), tuple(weights.tolist()), float(degrees.sum()))
        for (_, degrees), (_, scales) in zip(parameters, profiles)
    ]


def _profile(ratios: Array, degrees: Array) -> tuple[Array, Array]:
    """The log likelihood of each of the degrees of freedom of the fleet, over all scales and shares
    of changed robots, and the likeliest scale.
    """
    middle = float(np.median(ratios)) if len(ratios) else 0.0
    if middle <= 0:
        return np.zeros(len(DEGREES)), np.full(len(DEGREES), middle)
    ratios, degrees = _thinned(np.maximum(ratios, 1e-12 * middle), degrees)
    # the median of a chi-squared variable of one degree of freedom is 0.455
    scales = np.exp(np.arange(-REACH, REACH + STEP / 2, STEP)) * middle / 0.455
    x = ratios[None, :] / scales[:, None]
    changed = np.where(x > 1, 1 / (x * DECADES * math.log(10)), 0.0)
    likelihoods, found = np.empty((2, len(DEGREES)))
    for at, prior in enumerate(DEGREES):
        same = np.exp(_log_density(x, degrees[None, :], prior))
        # densities of the ratios themselves, so that scales compare
        totals = [
            np.log(np.maximum((1 - share) * same + share * changed, 1e-300)).sum(axis=1)
            - len(ratios) * np.log(scales)
            - rank * math.log(2)
            for rank, share in enumerate(CHANGED)
        ]
        every = np.logaddexp.reduce(totals, axis=0)
        likelihoods[at] = np.logaddexp.reduce(every)
        found[at] = scales[int(np.argmax(every))]
    return likelihoods, found


def _thinned(ratios: Array, degrees: Array) -> tuple[Array, Array]:
    if len(ratios) <= MOST:
        return ratios, degrees
    order = np.lexsort((ratios, degrees))
    chosen = order[np.linspace(0, len(ratios) - 1, MOST).astype(int)]
    return ratios[chosen], degrees[chosen]


def _log_density(x: Array, d: Array, prior: float) -> Array:
    """Of the F distribution with ``d`` and ``prior`` degrees of freedom."""
    half = d / 2
    own = (half - 1) * np.log(x) - _log_gamma(half)
    if math.isinf(prior):
        found: Array = half * np.log(half) + own - half * x
        return found
    both = half + prior / 2
    front = _log_gamma(both) - math.lgamma(prior / 2) + half * np.log(d / prior)
    found = front + own - both * np.log1p(d * x / prior)
    return found


def _log_gamma(values: Array) -> Array:
    distinct, places = np.unique(values, return_inverse=True)
    logs = np.array([math.lgamma(value) for value in distinct])
    return logs[places].reshape(values.shape)
