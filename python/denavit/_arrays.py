"""Arguments that are no arrays of doubles yet."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import _argument

Array = NDArray[np.float64]
"""An array of doubles."""


def as_doubles(name: str, value: Any) -> Array:
    """An array of doubles of what someone gave as ``name``."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise _argument(f"`{name}` has masked values", "fill them, or leave them out")
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise _argument(f"`{name}` is no array: {error}") from None
    if array.dtype.kind not in "fiu":
        raise _argument(
            f"`{name}` holds {array.dtype} instead of real numbers",
            "give an array of floats, or a list of them",
        )
    return np.ascontiguousarray(array, dtype=np.float64) if array.ndim else array.astype(float)
