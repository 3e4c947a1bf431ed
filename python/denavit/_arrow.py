"""The package pyarrow, and numbers of its tables."""

from __future__ import annotations

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


def columns(table: Any) -> dict[str, Array]:
    """The columns of numbers of a table; times of a clock are seconds since the first one."""
    types, found = arrow().types, {}
    for name, column in zip(table.column_names, table.columns):
        if types.is_floating(column.type) or types.is_integer(column.type):
            found[name.strip()] = column.to_numpy().astype(np.float64)
        elif types.is_timestamp(column.type) and len(column) and not column.null_count:
            nanoseconds = column.cast("timestamp[ns]").cast("int64").to_numpy()
            found[name.strip()] = (nanoseconds - nanoseconds[0]) / 1e9
    return found


def read_table(source: Any, is_parquet: bool) -> Any:
    """The table of a file of Parquet, or of Arrow's own; exceptions are those of pyarrow."""
    pa = arrow()
    if is_parquet:
        return pa.parquet.read_table(source)
    return pa.ipc.open_file(source).read_all()
