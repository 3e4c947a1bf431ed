"""What is wrong, with its place and a way out.

Every exception of the package is an :class:`Error`. Its fields are those of the first fault;
``faults`` has all of them, since a file is answered with everything that is wrong with it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong."""

    file: str | None
    """The file, or the name of a model or scenario, that is to blame."""
    line: int | None
    """Line, from 1."""
    column: int | None
    """Column in characters, from 1."""
    cause: str
    """What is wrong."""
    hint: str | None
    """What to do about it."""

    def __str__(self) -> str:
        place = [str(part) for part in (self.file, self.line, self.column) if part is not None]
        text = f"{':'.join(place)}: {self.cause}" if place else self.cause
        return f"{text}\n  hint: {self.hint}" if self.hint else text


class Error(Exception):
    """Something is wrong with what was given."""

    def __init__(self, faults: list[Fault]) -> None:
        super().__init__("\n".join(str(fault) for fault in faults))
        self.faults = tuple(faults)

    def __reduce__(self) -> tuple[type[Error], tuple[list[Fault]]]:
        """As other processes raise it: from its faults, and not from their text."""
        return type(self), (list(self.faults),)

    def _with(self, name: str, folder: str) -> Error:
        """The same, where a folder is called otherwise."""

        def bare(text: str) -> str:
            return text.replace(folder, name)

        def renamed(fault: Fault) -> Fault:
            file, hint = (text and bare(text) for text in (fault.file, fault.hint))
            return replace(fault, file=file, cause=bare(fault.cause), hint=hint)

        return type(self)([renamed(fault) for fault in self.faults])

    @property
    def file(self) -> str | None:
        """The file, or the name of a model or scenario, that is to blame."""
        return self.faults[0].file

    @property
    def line(self) -> int | None:
        """Line, from 1."""
        return self.faults[0].line

    @property
    def column(self) -> int | None:
        """Column in characters, from 1."""
        return self.faults[0].column

    @property
    def cause(self) -> str:
        """What is wrong."""
        return self.faults[0].cause

    @property
    def hint(self) -> str | None:
        """What to do about it."""
        return self.faults[0].hint


class ArgumentError(Error, ValueError):
    """An argument does not fit: its shape, its type, a number that is not finite, a name."""


class ModelError(Error, ValueError):
    """A model, a URDF or an MJCF is not there or is wrong."""


class FunctionMissing(Error, LookupError):
    """The model has no such function."""


class SimulateError(Error):
    """A scenario is wrong."""


class WalkError(Error):
    """A gait is wrong, or has no answer."""


class ExciteError(Error):
    """No exciting trajectory can be looked for."""


class IdentifyError(Error):
    """Nothing is identified: logs or options are wrong."""


class DiagnoseError(Error):
    """Nothing is diagnosed: logs or options are wrong."""


class MissingPackage(Error, ImportError):
    """An optional package is not installed."""


def _made(
    kind: str,
    faults: list[tuple[str | None, int | None, int | None, str, str | None]],
) -> Error:
    """The exception of a class, from the compiled part."""
    made = globals()[kind]([Fault(*fault) for fault in faults])
    assert isinstance(made, Error)
    return made


def _argument(cause: str, hint: str | None = None) -> ArgumentError:
    return ArgumentError([Fault(None, None, None, cause, hint)])
