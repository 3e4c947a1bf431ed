"""Models and motions that tests share."""

import numpy as np
import pytest

import denavit


@pytest.fixture(scope="session")
def puma() -> denavit.Model:
    return denavit.load("puma560")


@pytest.fixture(scope="session")
def tulip() -> denavit.Model:
    return denavit.load("tulip")


@pytest.fixture(scope="session")
def arm() -> denavit.Model:
    """Without friction and rotors: tau = D qdd + C qd + G exactly."""
    return denavit.load("planar_3r")


@pytest.fixture(params=["puma560", "tulip", "planar_3r"])
def model(request: pytest.FixtureRequest) -> denavit.Model:
    return denavit.load(request.param)


@pytest.fixture
def random() -> np.random.Generator:
    return np.random.default_rng(7)


def fourier(model, seed, duration_s=20.0, step_s=2e-3):
    """A motion of all joints with its exact derivatives."""
    random = np.random.default_rng(seed)
    t = np.arange(0, duration_s, step_s)
    q, qd, qdd = np.zeros((3, len(t), model.dof))
    for harmonic in range(1, 6):
        w = 2 * np.pi * harmonic / 10
        a, b = random.uniform(-0.4, 0.4, (2, model.dof))
        sine, cosine = np.sin(w * t)[:, None], np.cos(w * t)[:, None]
        q += a * sine + b * cosine
        qd += w * (a * cosine - b * sine)
        qdd -= w * w * (a * sine + b * cosine)
    return t, q, qd, qdd


def log(model, seed, extra=None, noise=1e-3):
    """A log in memory: torques of the model, and of what it lacks."""
    t, q, qd, qdd = fourier(model, seed)
    tau = model.inverse_dynamics(q, qd, qdd)
    if extra is not None:
        tau = tau + extra(q, qd)
    tau += noise * np.random.default_rng(seed + 100).standard_normal(tau.shape)
    columns = {"t": t}
    for at, joint in enumerate(model.joints):
        columns |= {f"q_{joint}": q[:, at], f"tau_{joint}": tau[:, at]}
    return columns


@pytest.fixture(scope="session")
def log_of():
    """Makes logs of a model that moves, by a seed."""
    return log
