"""Tables of numbers that an answer has beside its own table."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ._arrays import Array
from ._results import pandas_package
from .errors import _argument


@dataclass(frozen=True, eq=False)
class Series:
    """Named columns of numbers, row by row."""

    columns: tuple[str, ...]
    values: Array
    """(rows, columns), in SI units; NaN where a column has no value."""

    def column(self, name: str) -> Array:
        """A column, (rows,): a view, no copy."""
        if name not in self.columns:
            raise _argument(f"there is no column `{name}`", ", ".join(self.columns))
        return self.values[:, self.columns.index(name)]

    def to_pandas(self) -> Any:
        """The same as a data frame. Needs pandas."""
        return pandas_package().DataFrame(self.values, columns=list(self.columns))

    def __repr__(self) -> str:
        return f"<{len(self.values)} rows of {', '.join(self.columns[:4])}, ..>"


def read_series(path: Path) -> Series:
    """The table that the command has written: names, then numbers."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    cells = [[float(cell or "nan") for cell in line.split(",")] for line in lines[1:]]
    columns = tuple(lines[0].split(","))
    return Series(columns, np.array(cells, dtype=np.float64).reshape(-1, len(columns)))
