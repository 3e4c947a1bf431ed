"""Tails of distributions."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

from ..errors import Fault, MissingPackage


@lru_cache
def _special() -> Any:
    """The functions of scipy, which is asked for where they are used."""
    try:
        from scipy import special  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError:
        cause, hint = "scipy is not installed", "pip install 'denavit[studies]'"
        raise MissingPackage([Fault(None, None, None, cause, hint)]) from None
    return special


def two_sided(t: float, df: float) -> float:
    """The probability that Student's t is at least as far from 0; normal where ``df`` is
    infinite.
    """
    if df <= 0 or math.isnan(t):
        return 1.0
    if math.isinf(df):
        return math.erfc(abs(t) / math.sqrt(2))
    return 2.0 * float(_special().stdtr(df, -abs(t)))
