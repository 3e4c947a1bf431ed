"""A study: a function, its inputs by content, a seed, and how many indices there are."""

from __future__ import annotations

import hashlib
import importlib
import inspect
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from .._denavit import __version__
from ..errors import Error, Fault
from .cases import Case, Function, Row, columns_of, plain

FORMAT = "denavit-study/1"


@dataclass(frozen=True)
class Study:
    """A function from an index to a row, with all that its rows depend on."""

    name: str
    function: Function
    count: int
    """How many indices there are, from 0."""
    seed: int = 1
    inputs: Mapping[str, bytes] = field(default_factory=dict, repr=False)
    """Content of files: workers on other machines have them, too."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """What else rows depend on; what JSON can say."""

    def __post_init__(self) -> None:
        columns_of(self.function)
        if self.count < 0 or self.seed < 0:
            raise ValueError("count and seed are not below 0")

    @property
    def place(self) -> str:
        """Where the function is: ``module:name``."""
        return f"{self.function.__module__}:{self.function.__qualname__}"

    @cached_property
    def key(self) -> str:
        """Names the study by content: the function (its own text, not that of what it calls),
        inputs, options, seed and version, but not how many indices there are, so that a study may
        be extended.
        """
        try:
            text = inspect.getsource(self.function)
        except (OSError, TypeError):
            text = ""  # it was typed in
        said = {
            "text": digest(text.encode()),
            "format": FORMAT,
            "function": self.place,
            "columns": {name: str(kind) for name, kind in columns_of(self.function).items()},
            "inputs": {name: digest(content) for name, content in self.inputs.items()},
            "options": dict(self.options),
            "seed": self.seed,
            "version": __version__,
        }
        return digest(json.dumps(said, sort_keys=True, allow_nan=False).encode())

    def row(self, index: int) -> Row:
        """The row of an index. Where denavit refuses what the case made, the row says why, in
        ``failure``; any other exception is a fault of the function and is raised.
        """
        case = Case(index, self.seed, self.inputs, self.options)
        columns = columns_of(self.function)
        try:
            given, failure = self.function(case), None
        except Error as error:
            given, failure = {}, str(error)
        unknown = given.keys() - columns.keys()
        if unknown:
            raise TypeError(f"{self.place} has no column {', '.join(sorted(unknown))}")
        values = {name: plain(kind, given.get(name)) for name, kind in columns.items()}
        return {"index": index, **values, "failure": failure}


def digest(content: bytes) -> str:
    """The name of some content."""
    return hashlib.sha256(content).hexdigest()


def read_study(path: str | Path) -> Study:
    """Reads a study file: JSON with ``format``, ``name``, ``function`` (``module:name``), ``count``
    and, if they are wanted, ``seed``, ``inputs`` (files by name, beside the study) and ``options``.
    """
    path = Path(path)

    def wrong(cause: str, hint: str | None = None, at: tuple[int, int] | None = None) -> Error:
        line, column = at or (None, None)
        return Error([Fault(str(path), line, column, cause, hint)])

    try:
        given = json.loads(path.read_bytes())
    except OSError as error:
        raise wrong(f"cannot be read: {error.strerror}", "check the path") from None
    except json.JSONDecodeError as error:
        raise wrong(f"is no JSON: {error.msg}", at=(error.lineno, error.colno)) from None
    except ValueError as error:
        raise wrong(f"is no text: {error}") from None
    kinds = {"format": str, "name": str, "function": str, "count": int}
    more = {"seed": int, "inputs": dict, "options": dict}
    if not isinstance(given, dict):
        raise wrong("is no object", f'{{"format": "{FORMAT}", "name": .., "function": ..}}')
    faults = [f"no key `{key}`" for key in kinds if key not in given]
    faults += [f"no study has a key `{key}`" for key in given if key not in kinds | more]
    for key, kind in (kinds | more).items():
        if key in given and (not isinstance(given[key], kind) or isinstance(given[key], bool)):
            faults.append(f"`{key}` is no {kind.__name__}")
    if "format" in given and given["format"] != FORMAT:
        faults.append(f'`format` is not "{FORMAT}"')
    faults += [f"`{key}` is below 0" for key in ("count", "seed") if _negative(given.get(key))]
    if faults:
        raise Error([Fault(str(path), None, None, fault, None) for fault in faults])
    inputs = {}
    for name, file in given.get("inputs", {}).items():
        try:
            inputs[name] = (path.parent / str(file)).read_bytes()
        except OSError as error:
            raise wrong(f"input `{name}`: {file}: cannot be read: {error.strerror}") from None
    try:
        function = found(given["function"])
        columns_of(function)
    except (ImportError, AttributeError, ValueError, TypeError) as error:
        hint = "module:name of a function that Python can import, with @denavit.studies.rows above"
        raise wrong(f"`function`: {error}", hint) from None
    options = given.get("options", {})
    return Study(given["name"], function, given["count"], given.get("seed", 1), inputs, options)


def _negative(value: object) -> bool:
    return isinstance(value, int) and value < 0


def found(place: str) -> Function:
    """The function at a place, ``module:name``."""
    module, colon, name = place.partition(":")
    if not (module and colon and name):
        raise ValueError(f"{place!r} is not module:name")
    value: Any = importlib.import_module(module)
    for part in name.split("."):
        value = getattr(value, part)
    if not callable(value):
        raise TypeError(f"{place} is no function")
    function: Function = value
    return function
