"""Options of use cases as arguments of the command, whose answers they share."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from . import _denavit
from ._arrays import Array
from ._arrow import NO_NUMBERS
from .errors import Error, _argument

Progress = Callable[[str, "float | None"], "bool | None"]
"""Hears the stage of a run, and the share of it that is done (0 to 1) where that is known. An
answer of ``False`` stops the run."""

PathLike = str | os.PathLike[str]

Columns = tuple[str, int, str, list[tuple[str, str]], list[tuple[str, Array]]]
"""A log in memory: its option, which of the logs of this it is, its name, what it says of itself,
its columns."""


class HasSource(Protocol):
    """What can be written as a file: a model."""

    @property
    def name(self) -> str: ...

    @property
    def source(self) -> str: ...


def place(value: object, what: str) -> str:
    """The path or the name that someone gave."""
    if not isinstance(value, (str, os.PathLike)):
        raise _argument(f"{what} is a path or a name, and no {type(value).__name__}")
    text = os.fspath(value)
    if not isinstance(text, str) or text in ("", "-"):
        raise _argument(f"{what} is no path: {text!r}")
    return text


def places(values: object, what: str) -> list[str]:
    """Some paths; one alone stands for a list of it."""
    if isinstance(values, (str, os.PathLike)):
        return [place(values, what)]
    if not isinstance(values, Iterable):
        raise _argument(f"{what} are paths, and no {type(values).__name__}")
    return [place(value, what) for value in values]


def flags(**options: object) -> list[str]:
    """Flags of the command: nothing of None and False, a bare flag of True, lists with commas."""
    found: list[str] = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            found.append(flag)
        elif isinstance(value, Mapping):
            found += [flag, ",".join(f"{key}={number}" for key, number in value.items())]
        elif isinstance(value, (str, os.PathLike)):
            found += [flag, os.fspath(value)]
        elif isinstance(value, Iterable):
            listed = ",".join(str(one) for one in value)
            if listed:
                found += [flag, listed]
        else:
            # beside its flag, a negative number would be read as one
            found.append(f"{flag}={value}")
    return found


@contextmanager
def folder() -> Iterator[Path]:
    """A folder for files of one run. Faults do not name it: nobody has seen it."""
    with tempfile.TemporaryDirectory(prefix="denavit-") as path:
        try:
            yield Path(path)
        except Error as error:
            named = error._with("", path + os.sep)
            raise named._with("the folder of the text", path) from None


def file_of(value: object, what: str, inside: Path) -> str:
    """A path of something: itself, or a new file in a folder of a model, or of a dict."""
    if isinstance(value, Mapping):
        path = inside / f"{what}.json"
        path.write_text(json.dumps(_referring(dict(value), inside), default=_plain))
        return str(path)
    source, name = getattr(value, "source", None), getattr(value, "name", None)
    if isinstance(source, str) and isinstance(name, str):
        path = inside / f"{name}.json"
        path.write_text(source)
        return str(path)
    return place(value, what)


def _plain(value: object) -> object:
    """Numbers and arrays of numpy as JSON has them."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise _argument(f"JSON has no {type(value).__name__}")


def _referring(content: dict[str, Any], inside: Path) -> dict[str, Any]:
    """The same, with a model that a file refers to by an absolute path."""
    model = content.get("model")
    if isinstance(model, str) and Path(model).is_file():
        content["model"] = str(Path(model).resolve())
    elif model is not None and not isinstance(model, str):
        content["model"] = file_of(model, "model", inside)
    return content


def answered(
    arguments: list[str],
    progress: Progress | None,
    logs: Iterable[Columns] = (),
) -> tuple[dict[str, Any], bool, list[str]]:
    """The JSON of a command, whether its answer is good, and notes. ``logs`` are in memory."""
    given = list(logs)
    try:
        text, is_good, notes = _denavit.run([*arguments, "--json"], progress, given)
    except Error as error:
        raise _with_types(error, given) from None
    return json.loads(text), is_good, notes


def _with_types(error: Error, logs: Iterable[Columns]) -> Error:
    """The same; of a column that is reported as missing, and is no column of numbers, its type."""
    faults = list(error.faults)
    for _, _, log, header, _ in logs:
        for key, kind in header:
            if not key.startswith(NO_NUMBERS):
                continue
            name = f"`{key.removeprefix(NO_NUMBERS)}`"
            faults = [
                replace(one, cause=f"{one.cause} of numbers: {name} is of type {kind}")
                if one.file == log and f"no column {name}" in one.cause
                else one
                for one in faults
            ]
    return type(error)(faults)
