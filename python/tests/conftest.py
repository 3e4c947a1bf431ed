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
