"""Functions against laws of mechanics, finite differences and numpy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import denavit


def state(model, random):
    return random.uniform(-1, 1, (3, model.dof))


def test_terms_add_up_to_the_torques(arm, random):
    q, qd, qdd = state(arm, random)
    D, C, G = arm.dynamics_terms(q, qd)
    assert_allclose(D @ qdd + C @ qd + G, arm.inverse_dynamics(q, qd, qdd), rtol=1e-12)
    assert_allclose(D, arm.mass_matrix(q))
    assert_allclose(C, arm.coriolis_matrix(q, qd))
    assert_allclose(G, arm.gravity_vector(q))


def test_torques_are_inertia_and_bias(model, random):
    q, qd, qdd = state(model, random)
    tau = model.mass_matrix(q) @ qdd + model.bias(q, qd)
    assert_allclose(tau, model.inverse_dynamics(q, qd, qdd), rtol=1e-10, atol=1e-10)


def test_mass_matrix_is_symmetric_and_positive(model, random):
    D = model.mass_matrix(state(model, random)[0])
    assert_allclose(D, D.T)
    assert np.linalg.eigvalsh(D).min() > 0


def test_mass_matrix_rate_less_twice_coriolis_is_skew(model, random):
    q, qd, _ = state(model, random)
    h = 1e-6
    rate = (model.mass_matrix(q + h * qd) - model.mass_matrix(q - h * qd)) / (2 * h)
    skew = rate - 2 * model.coriolis_matrix(q, qd)
    assert_allclose(skew, -skew.T, atol=1e-6)


def test_energies(model, random):
    q, qd, _ = state(model, random)
    kinetic = model.kinetic_energy(q, qd)
    assert isinstance(kinetic, float)
    assert_allclose(kinetic, qd @ model.mass_matrix(q) @ qd / 2, rtol=1e-12)


def test_gravity_is_the_gradient_of_the_potential(arm, random):
    q = state(arm, random)[0]
    h = 1e-6 * np.eye(arm.dof)
    gradient = (arm.potential_energy(q + h) - arm.potential_energy(q - h)) / 2e-6
    assert_allclose(gradient, arm.gravity_vector(q), rtol=1e-7)


def test_forward_dynamics_inverts(model, random):
    q, qd, qdd = state(model, random)
    tau = model.inverse_dynamics(q, qd, qdd)
    assert_allclose(model.forward_dynamics(q, qd, tau), qdd, rtol=1e-6, atol=1e-8)
    solved = model.mass_matrix_solve(q, tau)
    assert_allclose(model.mass_matrix(q) @ solved, tau, rtol=1e-8, atol=1e-9)


def test_derivatives_are_slopes(model, random):
    q, qd, qdd = state(model, random)
    n, h = model.dof, 1e-6
    steps = h * np.eye(n)
    found = model.inverse_dynamics_derivatives(q, qd, qdd)
    tau = model.inverse_dynamics
    above, below = tau(q + steps, qd, qdd), tau(q - steps, qd, qdd)
    assert_allclose(found.dtau_dq, (above - below).T / (2 * h), atol=2e-5, rtol=1e-6)
    above, below = tau(q, qd + steps, qdd), tau(q, qd - steps, qdd)
    assert_allclose(found.dtau_dqd, (above - below).T / (2 * h), atol=2e-5, rtol=1e-6)
    by_torque = model.forward_dynamics_derivatives(q, qd, model.bias(q, qd)).dqdd_dtau
    assert_allclose(by_torque @ model.mass_matrix(q), np.eye(n), atol=1e-7)


def test_contacts_of_a_walking_robot(tulip, random):
    q, qd, _ = state(tulip, random)
    steps = 1e-6 * np.eye(tulip.dof)
    places = tulip.contact_positions(q)
    assert places.shape == (len(tulip.contacts), 3)
    slopes = (tulip.contact_positions(q + steps) - tulip.contact_positions(q - steps)) / 2e-6
    jacobian = tulip.contact_jacobian(q).reshape(-1, tulip.dof)
    assert_allclose(jacobian, slopes.reshape(tulip.dof, -1).T, atol=1e-7)


def test_momentum_is_mass_times_velocity(tulip, random):
    q, qd, _ = state(tulip, random)
    linear, angular = tulip.momentum(q, qd)
    velocity = tulip.center_of_mass_jacobian(q) @ qd
    masses = linear / velocity
    assert_allclose(masses, masses[0], rtol=1e-9)
    matrix = tulip.centroidal_momentum_matrix(q)
    assert_allclose(matrix @ qd, np.concatenate([linear, angular]), rtol=1e-9, atol=1e-12)


def test_zero_moment_point_at_rest_is_below_the_centre_of_mass(tulip):
    q, rest = np.zeros(tulip.dof), np.zeros(tulip.dof)
    point = tulip.zero_moment_point(q, rest, rest)
    assert_allclose(point[:2], tulip.center_of_mass(q)[:2], atol=1e-9)


def test_links_have_jacobians(puma, random):
    q = state(puma, random)[0]
    last = puma.links[-1]
    steps = 1e-6 * np.eye(6)

    def place(q):
        return puma.link_transforms(q)[..., -1, :, 3]

    slopes = (place(q + steps) - place(q - steps)).T / 2e-6
    assert_allclose(puma.link_jacobian(last, q)[:3], slopes, atol=1e-8)


def test_regressors_are_linear_in_parameters(puma, random):
    q, qd, qdd = random.uniform(-1, 1, (3, 300, 6))
    found = denavit.base_parameters(puma, joint_parameters=["modelled"])
    matrix, known = puma.base_regressor(q, qd, qdd)
    assert not known.any()
    stacked = matrix.reshape(-1, found.rank)
    values = np.linalg.svd(stacked, compute_uv=False)
    assert values[-1] > 1e-6 * values[0]
    tau = puma.inverse_dynamics(q, qd, qdd).ravel()
    theta, *_ = np.linalg.lstsq(stacked, tau, rcond=None)
    assert_allclose(stacked @ theta, tau, atol=1e-9 * np.abs(tau).max())


@pytest.mark.parametrize(("samples", "name"), [(1, "puma560"), (3, "puma560"), (700, "tulip")])
def test_many_samples_have_the_bits_of_one(samples, name, random):
    model = denavit.load(name)
    q, qd, qdd = random.uniform(-1, 1, (3, samples, model.dof))
    many = model.inverse_dynamics(q, qd, qdd)
    assert many.shape == (samples, model.dof)
    for at in range(0, samples, 97):
        assert (many[at] == model.inverse_dynamics(q[at], qd[at], qdd[at])).all()
    D, C, G = model.dynamics_terms(q, qd)
    assert D.shape == C.shape == (samples, model.dof, model.dof)
    assert (G == model.gravity_vector(q)).all()


def test_evaluate_takes_names(puma, tulip):
    q = [0.1] * 6
    assert (puma.evaluate("mass_matrix", q=q) == puma.mass_matrix(q)).all()
    jacobian = puma.evaluate("link_jacobian", link=puma.links[2], q=q)
    assert (jacobian == puma.link_jacobian(puma.links[2], q)).all()
    zeros = np.zeros(18)
    forces = np.zeros(3 * len(tulip.contacts))
    assert len(tulip.evaluate("contact_derivatives", q=zeros, qd=zeros, qdd=zeros, f=forces)) > 1
