"""Models of robots and their functions."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike

from . import _denavit, _options
from ._arrays import Array
from ._options import PathLike
from ._results import Latex, frame, html_table
from .errors import _argument


class ModelWarning(UserWarning):
    """What is reported of a model that is read as it stands."""


class DynamicsTerms(NamedTuple):
    """D, C and G of tau = D qdd + C qd + G + drives; with a first axis of samples for many."""

    D: Array
    """Mass matrix (n, n)."""
    C: Array
    """Coriolis matrix (n, n): dD/dt - 2 C is skew."""
    G: Array
    """Gravity vector (n,)."""


class InverseDynamicsDerivatives(NamedTuple):
    """Derivatives of tau; row: torque, column: joint. That by qdd is D."""

    dtau_dq: Array
    """(n, n) [N m/rad]."""
    dtau_dqd: Array
    """(n, n) [N m s/rad]."""


class ForwardDynamicsDerivatives(NamedTuple):
    """Derivatives of qdd; row: acceleration."""

    dqdd_dq: Array
    """(n, n) [1/s^2]."""
    dqdd_dqd: Array
    """(n, n) [1/s]."""
    dqdd_dtau: Array
    """(n, n): the inverse of D."""


class Momentum(NamedTuple):
    """Momentum of all that moves, in the world frame."""

    linear: Array
    """(3,) [kg m/s]."""
    angular: Array
    """(3,) about the centre of mass [kg m^2/s]."""


class Regressor(NamedTuple):
    """Torques as a linear function of parameters: tau = matrix @ theta + known."""

    matrix: Array
    """(n, parameters); the columns are those of :func:`denavit.base_parameters`: all unknown
    parameters, or the base parameters on the joint axes (``basis="joints"``)."""
    known: Array
    """(n,): what matter and joint parameters that are known add [N m, N]."""

    @classmethod
    def _of(cls, found: Array | tuple[Array, Array]) -> Regressor:
        if isinstance(found, tuple):
            return cls(*found)
        return cls(found, np.zeros(found.shape[:-1]))


class Model(_denavit.Model):
    """A robot: its model, and its functions as numbers.

    ``model`` is the path of a model file, of a URDF or of an MJCF; the name of a shipped model
    (:func:`denavit.shipped_models`); or a model file as a dict. ``effects`` is a folder with
    definitions of effects.

    Functions take one sample, ``q`` of shape (n,), or many, (samples, n), which are shared out to
    all cores; a vector beside a matrix stands for all samples. They are derived and compiled when
    they are called first. Units are SI, angles in rad, the frame is that of the world.
    """

    def __new__(
        cls,
        model: PathLike | Mapping[str, Any],
        *,
        effects: PathLike | None = None,
    ) -> Model:
        folder = None if effects is None else Path(effects)
        if isinstance(model, Mapping):
            name = str(model.get("name", "model"))
            try:
                text = json.dumps(model)
            except (TypeError, ValueError, RecursionError) as error:
                raise _argument(f"`model` is no JSON: {error}") from None
            return cls._made(name, text, folder)
        return cls._made(_options.place(model, "a model"), None, folder)

    @classmethod
    def _made(cls, place: str, text: str | None, effects: Path | None) -> Model:
        made = cast(Model, super().__new__(cls, place, text, effects))
        for note in made.notes:
            warnings.warn(note, ModelWarning, stacklevel=3)
        return made

    @classmethod
    def from_urdf(
        cls,
        robot: PathLike,
        *,
        base: Literal["fixed", "floating"] | None = None,
        tip: str | None = None,
        contacts: tuple[str, ...] | list[str] = (),
        meshes: PathLike | None = None,
        mimic: Literal["refuse", "lock", "free"] = "refuse",
    ) -> Model:
        """The model of a URDF or MJCF: of a path, or of its text.

        ``base`` is what the first link stands on, ``tip`` the link at the end of the chain that is
        wanted, ``contacts`` are links whose collision shapes become contact points, ``meshes`` is
        the folder of their meshes, or of the package of ``package://`` (by default that of the
        file), and ``mimic`` says what becomes of joints that follow others.
        """
        with _options.folder() as inside:
            arguments = ["import", _described(robot, "a robot", inside)]
            arguments += _options.flags(base=base, tip=tip, meshes=meshes, mimic=mimic)
            for contact in contacts:
                arguments += ["--contacts", contact]
            out = inside / "model.json"
            _, _, notes = _denavit.run([*arguments, "-o", str(out)], None)
            for note in notes:
                warnings.warn(note, ModelWarning, stacklevel=2)
            text = out.read_text()
        return cls._made(str(json.loads(text)["name"]), text, None)

    def to_dict(self) -> dict[str, Any]:
        """The model file. A changed copy makes another model."""
        return cast("dict[str, Any]", json.loads(self.source))

    def save(self, path: PathLike) -> None:
        """Writes the model file."""
        Path(path).write_text(self.source)

    def to_urdf(self, *, into: PathLike | None = None) -> str:
        """The robot as URDF; or, ``into`` the URDF that it was made of (a path, or its text), its
        masses, centres of mass, inertias and joint friction: every other byte stays.
        """
        if into is None:
            return self._exported("exported.urdf", "urdf", None)
        return self._exported("exported.urdf", None, into)

    def to_mjcf(self) -> str:
        """The robot as MJCF."""
        return self._exported("exported.xml", "mjcf", None)

    def _exported(self, name: str, format: str | None, into: PathLike | None) -> str:
        with _options.folder() as inside:
            effects, place = as_place(self, inside)
            out = inside / name
            arguments = ["export", place, *effects]
            if into is not None:
                arguments += ["--into", _described(into, "into", inside)]
            arguments += _options.flags(format=format, out=out)
            _, _, notes = _denavit.run(arguments, None)
            for note in notes:
                warnings.warn(note, ModelWarning, stacklevel=3)
            return out.read_bytes().decode()

    def evaluate(self, function: str, *, link: str | None = None, **arguments: ArrayLike) -> Any:
        """Any function by its name in ``denavit evaluate``, with arguments by theirs: ``q``,
        ``qd``, ``qdd``, ``tau``, ``b``, ``f``, ``t``, ``states``. Several results are a tuple.
        """
        return self._evaluate(function, link, list(arguments.items()))

    def dynamics_terms(self, q: ArrayLike, qd: ArrayLike) -> DynamicsTerms:
        """D, C and G at once."""
        return DynamicsTerms(*self._dynamics_terms(q, qd))

    def inverse_dynamics_derivatives(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike
    ) -> InverseDynamicsDerivatives:
        """Derivatives of the torques by q and by qd."""
        return InverseDynamicsDerivatives(*self._inverse_dynamics_derivatives(q, qd, qdd))

    def forward_dynamics_derivatives(
        self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike
    ) -> ForwardDynamicsDerivatives:
        """Derivatives of the accelerations by q, by qd and by tau."""
        return ForwardDynamicsDerivatives(*self._forward_dynamics_derivatives(q, qd, tau))

    def regressor(self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> Regressor:
        """The regressor of all unknown parameters."""
        return Regressor._of(self._regressor(q, qd, qdd))

    def base_regressor(self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> Regressor:
        """The regressor of the base parameters."""
        return Regressor._of(self._base_regressor(q, qd, qdd))

    def momentum(self, q: ArrayLike, qd: ArrayLike) -> Momentum:
        """Linear momentum, and angular momentum about the centre of mass."""
        return Momentum(*self._momentum(q, qd))

    def latex(self, function: str = "mass_matrix") -> Latex:
        """A function as a formula, with the model's parameters as symbols. Of large ones the
        intermediates are named first.
        """
        return Latex(self._latex(function))

    def inspect(self) -> dict[str, Any]:
        """What the model says, as ``denavit inspect --json``: rows, bodies, drives, limits."""
        with _options.folder() as inside:
            effects, place = as_place(self, inside)
            arguments = ["inspect", place, *effects]
            return _options.answered(arguments, None)[0]

    def _rows(self) -> list[dict[str, Any]]:
        keys = ("name", "parent", "joint", "a", "alpha", "d", "theta")

        def row(link: dict[str, Any]) -> dict[str, Any]:
            mass = (link["body"] or {}).get("mass")
            return {key: link[key] for key in keys} | {"mass [kg]": mass}

        return [row(link) for link in self.inspect()["links"]]

    def to_pandas(self) -> Any:
        """The links, one a row, as a data frame. Needs pandas."""
        return frame(self._rows())

    def _repr_html_(self) -> str:
        return f"<p>{self}</p>{html_table(self._rows())}"

    def _repr_latex_(self) -> str | None:
        # what is larger than a page is no formula
        return self.latex()._repr_latex_() if self.dof <= 3 else None

    def __repr__(self) -> str:
        return f"<denavit.Model {self.name}: {self.dof} degrees of freedom>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (_unpickled, (self.name, self.source, self._effects))


def _unpickled(name: str, source: str, effects: str | None) -> Model:
    return Model._made(name, source, None if effects is None else Path(effects))


def load(model: PathLike | Mapping[str, Any], *, effects: PathLike | None = None) -> Model:
    """A model: of a path, a shipped name or a dict. See :class:`Model`."""
    return Model(model, effects=effects)


def _described(robot: PathLike, what: str, inside: Path) -> str:
    """The path of a URDF or MJCF: itself, or a new file of its text."""
    if isinstance(robot, str) and robot.lstrip().startswith("<"):
        path = inside / "robot.urdf"
        # its ends of lines are its own
        path.write_bytes(robot.encode())
        return str(path)
    return _options.place(robot, what)


def as_place(model: object, inside: Path) -> tuple[list[str], str]:
    """Flags for the effects of a model, and its path or name."""
    effects = getattr(model, "_effects", None)
    own = [] if effects is None else ["--effects", os.fspath(effects)]
    return own, _options.file_of(model, "model", inside)
