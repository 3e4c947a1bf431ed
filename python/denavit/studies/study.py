"""A study: a function, its inputs by content, a seed, and how many indices there are."""

from __future__ import annotations

import importlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from .._denavit import __version__
from ..errors import Error, Fault, _argument
from .cases import AGAIN, Case, Function, PassingError, Row, columns_of, plain
from .content import UnnamedError, build, digest, digest_of_path, of_function

FORMAT = "denavit-study/1"

MOST_NAMED = 64
"""Inputs that have a name each in messages."""


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
    files: Mapping[str, str] = field(default_factory=dict)
    """Paths of files and folders that are too large to be carried, as programs are. Workers find
    them by these paths, with the content that they had when the study was named."""

    def __post_init__(self) -> None:
        columns_of(self.function)
        if self.count < 0 or self.seed < 0:
            raise ValueError("count and seed are not below 0")
        for name, value in self.options.items():
            try:
                _text(value)
            except (TypeError, ValueError) as error:
                hint = "options are what JSON can say: finite numbers, texts, lists"
                raise _argument(f"`options[{name!r}]`: {error}", hint) from None

    @property
    def place(self) -> str:
        """Where the function is: ``module:name``."""
        return f"{self.function.__module__}:{self.function.__qualname__}"

    @cached_property
    def content(self) -> dict[str, str]:
        """What the rows depend on, by name: the function (its own text with its defaults and the
        values it closes over, not the text of what it calls), inputs, files, options, seed, and the
        build of this package. How many indices there are is no part of it, so that a study may be
        extended.
        """
        try:
            text = of_function(self.function)
        except UnnamedError:
            text = ""  # its rows are not kept
        columns = {name: str(kind) for name, kind in columns_of(self.function).items()}
        said = {
            "the format of studies": FORMAT,
            f"the function {self.place}": text,
            "its columns": _text(columns),
            "the seed": str(self.seed),
        }
        said |= {f"the option `{name}`": _text(one) for name, one in self.options.items()}
        inputs = {f"the input `{name}`": digest(one) for name, one in self.inputs.items()}
        if len(inputs) > MOST_NAMED:
            # of as many as a fleet has robots, one name is enough
            inputs = {"an input": digest(_text(inputs).encode())}
        return said | inputs | self._surroundings()

    def check_is_named(self) -> None:
        """Refuses a function that cannot be told from another one: its rows cannot be kept."""
        try:
            of_function(self.function)
        except UnnamedError as error:
            hint = "write it into a module; `denavit.studies.computed` keeps nothing"
            cause = f"rows of {self.place} cannot be kept: {error}"
            raise Error([Fault(self.name, None, None, cause, hint)]) from None

    def _surroundings(self) -> dict[str, str]:
        """What is not carried to workers, as it is where this is asked."""
        files = {f"the file `{name}`": digest_of_path(one) for name, one in self.files.items()}
        return files | {"the build of denavit": f"{__version__} {build()[:16]}"}

    @cached_property
    def key(self) -> str:
        """Names the study by its content."""
        return digest(_text(self.content).encode())

    def row(self, index: int) -> Row:
        """The row of an index. Where denavit refuses what the case made, the row says why, in
        ``failure``; any other exception is a fault of the function and is raised.
        """
        self._check()
        case = Case(index, self.seed, self.inputs, self.options, self.files)
        columns = columns_of(self.function)
        more: dict[str, Any] = {}
        try:
            given, failure = self.function(case), None
        except PassingError as error:
            given, failure, more = {}, str(error), {AGAIN: True}
        except Error as error:
            given, failure = {}, str(error)
        except SystemExit as error:
            cause = f"index {index}: {self.place} ends its process: SystemExit({error.code!r})"
            hint = "a function answers its row, or raises an exception"
            raise Error([Fault(self.name, None, None, cause, hint)]) from None
        unknown = given.keys() - columns.keys()
        if unknown:
            raise TypeError(f"{self.place} has no column {', '.join(sorted(unknown))}")
        values = {name: plain(kind, given.get(name)) for name, kind in columns.items()}
        return {"index": index, **values, "failure": failure, **more}

    def silent(self, index: int, failure: str) -> Row:
        """The row of an index that could not be computed now."""
        nothing = dict.fromkeys(columns_of(self.function))
        return {"index": index, **nothing, "failure": failure, AGAIN: True}

    def _check(self) -> None:
        """Sees to it that this process has the build and the files that the study is named by: rows
        of two builds do not stand side by side.
        """
        here = self._surroundings().items()
        other = [name for name, content in here if self.content[name] != content]
        if other:
            cause = f"{' and '.join(other)} changed since the study began, or is another one here"
            hint = "all machines need the same wheel and files, for as long as the study runs"
            raise ContentError([Fault(self.name, None, None, cause, hint)])


class ContentError(Error):
    """A worker has another build, or other files, than those the study is named by."""


def _text(value: Any) -> str:
    """A value as text, the same for equal ones."""
    return json.dumps(value, sort_keys=True, allow_nan=False)


def read_study(path: str | Path) -> Study:
    """Reads a study file: JSON with ``format``, ``name``, ``function`` (``module:name``), ``count``
    and, if they are wanted, ``seed``, ``options``, ``inputs`` (files by name, beside the study,
    which are carried to workers) and ``files`` (the same, but workers find them by their paths).
    """
    path = Path(path)

    def wrong(cause: str, hint: str | None = None, at: tuple[int, int] | None = None) -> Error:
        line, column = at or (None, None)
        return Error([Fault(str(path), line, column, cause, hint)])

    try:
        given = json.loads(path.read_bytes(), parse_constant=_no_number)
    except OSError as error:
        raise wrong(f"cannot be read: {error.strerror}", "check the path") from None
    except json.JSONDecodeError as error:
        raise wrong(f"is no JSON: {error.msg}", at=(error.lineno, error.colno)) from None
    except ValueError as error:
        raise wrong(f"is no JSON: {error}") from None
    kinds = {"format": str, "name": str, "function": str, "count": int}
    more = {"seed": int, "inputs": dict, "options": dict, "files": dict}
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
    files = {
        name: str((path.parent / str(file)).resolve())
        for name, file in given.get("files", {}).items()
    }
    seed, options = given.get("seed", 1), given.get("options", {})
    return Study(given["name"], function, given["count"], seed, inputs, options, files)


def _no_number(name: str) -> float:
    raise ValueError(f"{name} is no number that is finite")


def _negative(value: object) -> bool:
    return isinstance(value, int) and value < 0


def found(place: str) -> Function:
    """The function at a place, ``module:name``."""
    module, colon, name = place.partition(":")
    if not (module and colon and name):
        raise ValueError(f"{place!r} is not module:name")
    try:
        value: Any = importlib.import_module(module)
    except (Exception, SystemExit) as error:
        # whatever stands in it runs now
        cause = f"the module {module} cannot be imported: {type(error).__name__}: {error}"
        raise ImportError(cause) from error
    for part in name.split("."):
        value = getattr(value, part)
    if not callable(value):
        raise TypeError(f"{place} is no function")
    function: Function = value
    return function
