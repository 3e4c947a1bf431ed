"""The compiled part of the package."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from ._arrays import Array

__version__: str

def run(
    arguments: list[str],
    progress: Callable[[str, float | None], bool | None] | None = None,
    logs: list[tuple[str, int, str, list[tuple[str, str]], list[tuple[str, Array]]]] = ...,
) -> tuple[str, bool, list[str]]: ...
def simulate(
    arguments: list[str], progress: Callable[[str, float | None], bool | None] | None = None
) -> tuple[str, bool, list[str], list[str], Array]: ...
def shipped_models() -> list[str]:
    """Names of the models that are part of the package."""

def shipped_scenarios() -> list[str]:
    """Names of the scenarios that are part of the package."""

def shipped_gaits() -> list[str]:
    """Names of the gaits that are part of the package."""

class Model:
    def __new__(cls, place: str, text: str | None = None, effects: Path | None = None) -> Model: ...
    @property
    def name(self) -> str:
        """The name of the model."""
    @property
    def description(self) -> str:
        """What the robot is."""
    @property
    def source(self) -> str:
        """The text of the model file."""
    @property
    def notes(self) -> list[str]:
        """What was noted when the model was read."""
    @property
    def dof(self) -> int:
        """Number of degrees of freedom n: entries of q, qd, qdd and tau."""
    @property
    def joints(self) -> list[str]:
        """Names of the joints that move, in the order of q."""
    @property
    def links(self) -> list[str]:
        """Names of the links, in the order of the model file."""
    @property
    def contacts(self) -> list[str]:
        """Names of the contact points, in the order of `contact_positions`."""
    @property
    def _effects(self) -> Path | None: ...
    def _latex(self, name: str) -> str: ...
    def _signature(
        self, name: str
    ) -> tuple[list[tuple[str, int]], list[tuple[str, list[int], str]]]: ...
    def _evaluate(
        self, name: str, link: str | None, arguments: list[tuple[str, ArrayLike]]
    ) -> Any: ...
    def inverse_dynamics(self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> Array:
        """tau = D(q) qdd + C(q, qd) qd + G(q) + drives: (n,) [N m, N]."""
    def mass_matrix(self, q: ArrayLike) -> Array:
        """D(q): (n, n), symmetric [kg m^2, kg m, kg]."""
    def coriolis_matrix(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """C(q, qd) of the Christoffel symbols: (n, n); dD/dt - 2 C is skew."""
    def gravity_vector(self, q: ArrayLike) -> Array:
        """G(q): (n,) [N m, N]."""
    def bias(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """C qd + G + drives, the torque at qdd = 0: (n,) [N m, N]."""
    def _dynamics_terms(self, q: ArrayLike, qd: ArrayLike) -> tuple[Array, Array, Array]: ...
    def forward_dynamics(self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike) -> Array:
        """qdd of given torques: (n,) [rad/s^2, m/s^2]."""
    def mass_matrix_solve(self, q: ArrayLike, b: ArrayLike) -> Array:
        """D^-1 b: (n,)."""
    def _inverse_dynamics_derivatives(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike
    ) -> tuple[Array, Array]: ...
    def _forward_dynamics_derivatives(
        self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike
    ) -> tuple[Array, Array, Array]: ...
    def link_transforms(self, q: ArrayLike) -> Array:
        """The upper three rows of the homogeneous transforms of all links: (links, 3, 4) [m]."""
    def contact_positions(self, q: ArrayLike) -> Array:
        """World positions of the contact points: (contacts, 3) [m]."""
    def contact_jacobian(self, q: ArrayLike) -> Array:
        """W^T, the derivatives of the contact points by q: (3 contacts, n)."""
    def contact_bias(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """(d/dt W^T) qd of the contact points [m/s^2]."""
    def center_of_mass(self, q: ArrayLike) -> Array:
        """World position of the centre of mass: (3,) [m]."""
    def center_of_mass_jacobian(self, q: ArrayLike) -> Array:
        """Derivatives of the centre of mass by q: (3, n)."""
    def _momentum(self, q: ArrayLike, qd: ArrayLike) -> tuple[Array, Array]: ...
    def kinetic_energy(self, q: ArrayLike, qd: ArrayLike) -> Any:
        """Kinetic energy [J]."""
    def potential_energy(self, q: ArrayLike) -> Any:
        """Potential energy of gravity and springs [J]."""
    def center_of_mass_bias(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """(d/dt J) qd, J the Jacobian of the centre of mass: (3,) [m/s^2]."""
    def centroidal_momentum_matrix(self, q: ArrayLike) -> Array:
        """A of momentum = A qd: (6, n), linear rows first."""
    def centroidal_momentum_bias(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """(d/dt A) qd: (6,) [N, N m]."""
    def angular_momenta(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """Angular momentum of the body on each joint about the common centre of mass: (n, 3)."""
    def zero_moment_point(self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> Array:
        """The zero-moment point: (3,) [m]."""
    def cart_table_zmp(self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> Array:
        """The zero-moment point of the cart-table model: (3,) [m]."""
    def capture_point(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """The capture point of the linear inverted pendulum: (3,) [m]."""
    def _regressor(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike
    ) -> Array | tuple[Array, Array]: ...
    def _base_regressor(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike
    ) -> Array | tuple[Array, Array]: ...
    def link_jacobian(self, link: str, q: ArrayLike) -> Array:
        """Geometric Jacobian of the frame of a link: (6, n), linear rows first."""
    def foot_rotation_indicator(
        self, link: str, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike
    ) -> Array:
        """The foot rotation indicator of a link that carries contact points: (3,) [m]."""
