"""The package pyarrow, and numbers of its tables."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import Any

import numpy as np

from ._arrays import Array
from .errors import Fault, MissingPackage


def arrow() -> Any:
    """The package pyarrow, which is asked for where it is used."""
    try:
        import pyarrow  # type: ignore[import-untyped, unused-ignore]
        import pyarrow.parquet  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        cause, hint = "pyarrow is not installed", "pip install 'denavit[studies]'"
        raise MissingPackage([Fault(None, None, None, cause, hint)]) from None
    return pyarrow


def header_of(schema: Any) -> list[tuple[str, str]]:
    """What a Parquet file says of itself, by its schema in Arrow."""
    said = sorted((schema.metadata or {}).items())
    said = [one for one in said if one[0] not in (b"pandas", b"ARROW:schema")]
    return [(key.decode(errors="replace"), value.decode(errors="replace")) for key, value in said]


NO_NUMBERS = "no numbers in column "
"""What a header says of a column that is left out: this, with its name, and then its type."""


def columns(table: Any) -> dict[str, Array]:
    """The columns of numbers of a table; times of a clock are seconds since the first one. Two
    columns of one name are a ValueError: nothing says which of them is meant.
    """
    refuse_twins(table.column_names)
    found = {}
    for name, column in zip(table.column_names, table.columns):
        values = _numbers(column)
        if values is not None:
            found[name.strip()] = values
    return found


def refuse_twins(names: Iterable[str]) -> None:
    """Sees to it that no two columns have one name, but for such without any."""
    counts = Counter(name.strip() for name in names)
    twins = [f"`{name}`" for name, count in counts.items() if name and count > 1]
    if twins:
        raise ValueError(f"has two columns of one name, {', '.join(twins)}: rename one of them")


def left_out(table: Any) -> list[tuple[str, str]]:
    """What a header says of the columns that are no numbers."""
    named = zip(table.column_names, table.columns)
    others = [(name, one.type) for name, one in named if _numbers(one[:0]) is None]
    return [(NO_NUMBERS + name.strip(), str(kind)) for name, kind in others]


def _numbers(column: Any) -> Array | None:
    """The numbers of a column, NaN where there is none; None of a column of other things."""
    types = arrow().types
    if types.is_dictionary(column.type):
        column = column.cast(column.type.value_type)
    kind = column.type
    if types.is_timestamp(kind) or types.is_duration(kind):
        # as whole numbers, and from the first one: a clock has more digits than a float
        unit = "timestamp[ns]" if types.is_timestamp(kind) else "duration[ns]"
        whole = column.cast(unit).cast("int64")
        is_time = np.asarray(whole.is_valid().to_numpy(), dtype=bool)
        nanoseconds = whole.fill_null(0).to_numpy()
        known = nanoseconds[is_time]
        first = int(known[0]) if len(known) and types.is_timestamp(kind) else 0
        return np.where(is_time, (nanoseconds - first) / 1e9, np.nan)
    if types.is_decimal(kind):
        column = column.cast("double")
    elif not (types.is_floating(kind) or types.is_integer(kind)):
        return None
    numbers: Array = column.to_numpy().astype(np.float64)
    return numbers


def read_table(source: Any, is_parquet: bool) -> Any:
    """The table of a file of Parquet, or of Arrow's own; exceptions are those of pyarrow."""
    pa = arrow()
    if is_parquet:
        with pa.parquet.ParquetFile(source) as file:
            refuse_twins(file.schema_arrow.names)
            return file.read()
    return pa.ipc.open_file(source).read_all()
