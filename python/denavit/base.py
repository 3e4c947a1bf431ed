"""Base parameters: what torques can tell, exactly."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from . import _options
from ._options import PathLike, Progress
from ._results import Answer, Latex, answer, of
from .model import Model, as_place

JointParameters = Literal["friction", "rotor", "offset", "modelled"]
"""Joint parameters: viscous and Coulomb friction, reflected rotor inertia, a constant torque, or
those that the model has."""


@dataclass(frozen=True, kw_only=True)
class BaseParameter:
    """A combination of parameters that the torques depend on."""

    name: str
    expression: str
    """The combination as text, exact."""
    latex: str
    """The same as LaTeX."""
    unit: str
    members: Mapping[str, str]
    """Factors of the parameters, by their names."""
    alone: bool
    """Whether it is one parameter by itself."""
    value: float | None
    """Its value by the model; None where the model gives none."""


@dataclass(frozen=True, kw_only=True)
class BaseParameters(Answer):
    """The base parameters of a model. ``is_good``: a certificate of them was verified."""

    model: str
    rank: int
    """How many there are."""
    basis: str
    columns: tuple[str, ...]
    """All unknown parameters, in order."""
    zero: tuple[str, ...]
    """Those that no torque depends on."""
    alone: tuple[str, ...]
    """Those that are in no relation."""
    parameters: tuple[BaseParameter, ...] = of(BaseParameter)

    def _title(self) -> str:
        return f"{self.model}: {self.rank} base parameters of {len(self.columns)} parameters"

    def _rows(self) -> list[dict[str, Any]]:
        keys = ("name", "expression", "value", "unit")
        return [{key: getattr(one, key) for key in keys} for one in self.parameters]

    def latex(self) -> Latex:
        """The base parameters as formulas, one a line."""
        names = (one.name.replace("_", r"\_") for one in self.parameters)
        lines = r" \\ ".join(
            rf"\mathrm{{{name}}} &= {one.latex}" for name, one in zip(names, self.parameters)
        )
        return Latex(rf"\begin{{aligned}}{lines}\end{{aligned}}")

    def _repr_latex_(self) -> str:
        return self.latex()._repr_latex_()


def base_parameters(
    model: Model | PathLike,
    *,
    joint_parameters: Iterable[JointParameters] = (),
    basis: Literal["kept", "joints"] = "kept",
    terms: Iterable[str] | None = None,
    numeric: bool = False,
    keep: Iterable[str] = (),
    progress: Progress | None = None,
) -> BaseParameters:
    """The base parameters of a model, exactly, with lengths as symbols.

    ``keep`` names parameters to keep before others; ``terms`` are those of the equations in place
    of the model's (inertia, coriolis, gravity, friction, rotor, spring); ``numeric`` takes the
    model's numbers for lengths, angles and gravity.
    """
    with _options.folder() as inside:
        effects, place = as_place(model, inside)
        chosen = _options.flags(
            basis=basis,
            terms=terms,
            numeric=numeric,
            keep=list(keep),
            **{"with": list(joint_parameters)},
        )
        found = _options.answered(["base", place, *effects, *chosen], progress)
    return answer(BaseParameters, found)
