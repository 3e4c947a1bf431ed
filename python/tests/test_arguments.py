"""Arrays of any kind, and arguments that do not fit."""

import pickle
import threading

import numpy as np
import pytest

import denavit


def test_arrays_of_any_order_and_type(puma, random):
    q = random.uniform(-1, 1, (40, 6))
    expected = puma.gravity_vector(q)
    wide = np.zeros((80, 12))
    wide[::2, ::2] = q
    for given in (np.asfortranarray(q), wide[::2, ::2], q[::-1][::-1], q.tolist()):
        assert (puma.gravity_vector(given) == expected).all()
    assert (puma.gravity_vector(q[::-1]) == expected[::-1]).all()
    whole = np.ones((5, 6), dtype=np.int32)
    assert (puma.gravity_vector(whole) == puma.gravity_vector(whole.astype(float))).all()
    q.flags.writeable = False
    assert (puma.gravity_vector(q) == expected).all()
    assert (puma.gravity_vector(q[3][::-1]) == puma.gravity_vector(q[3][::-1].copy())).all()


def test_one_vector_stands_for_all_samples(puma, random):
    q = random.uniform(-1, 1, (9, 6))
    rest = np.zeros(6)
    at_rest = puma.inverse_dynamics(q, rest, rest)
    assert (at_rest == puma.inverse_dynamics(q, np.zeros((9, 6)), np.zeros((9, 6)))).all()


def test_no_samples_are_no_fault(puma):
    assert puma.mass_matrix(np.zeros((0, 6))).shape == (0, 6, 6)


@pytest.mark.parametrize(
    ("q", "said"),
    [
        ([0.0] * 5, "shape (5,)"),
        (np.zeros((3, 7)), "shape (3, 7)"),
        (np.zeros((2, 2, 6)), "3 dimensions"),
        (0.5, "0 dimensions"),
        ([0, 0, np.nan, 0, 0, 0], "`q[2]` is NaN"),
        (np.full((4, 6), np.inf), "`q[0, 0]` is inf"),
        (["a"] * 6, "instead of real numbers"),
        ([1j] * 6, "instead of real numbers"),
        (None, "instead of real numbers"),
        ([[1, 2], [3]], "no array"),
        (np.ma.array([0.0] * 6, mask=[1, 0, 0, 0, 0, 0]), "masked"),
    ],
)
def test_arguments_that_do_not_fit(puma, q, said):
    with pytest.raises(denavit.ArgumentError) as caught:
        puma.gravity_vector(q)
    assert said in caught.value.cause
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, denavit.Error)


def test_numbers_of_samples_must_agree(puma):
    with pytest.raises(denavit.ArgumentError, match="samples"):
        puma.inverse_dynamics(np.zeros((3, 6)), np.zeros((4, 6)), np.zeros(6))


def test_a_number_that_is_not_finite_is_found_among_many(puma, random):
    q = random.uniform(-1, 1, (5000, 6))
    q[4321, 5] = np.nan
    with pytest.raises(denavit.ArgumentError, match=r"`q\[4321, 5\]` is NaN"):
        puma.gravity_vector(q)


def test_names_that_are_not_there(puma):
    with pytest.raises(denavit.ArgumentError, match="no function"):
        puma.evaluate("mass", q=np.zeros(6))
    with pytest.raises(denavit.ArgumentError, match="no argument `p`"):
        puma.evaluate("mass_matrix", p=np.zeros(6))
    with pytest.raises(denavit.ArgumentError, match="needs `q`"):
        puma.evaluate("mass_matrix")
    with pytest.raises(denavit.ArgumentError) as caught:
        puma.link_jacobian("hand", np.zeros(6))
    assert puma.links[0] in caught.value.hint
    with pytest.raises(denavit.FunctionMissing) as missing:
        puma.contact_positions(np.zeros(6))
    assert "contact" in missing.value.hint


def test_threads_share_a_model(tulip, random):
    q = random.uniform(-1, 1, (2000, 18))
    expected = tulip.mass_matrix(q)
    found = [None] * 4

    def work(at):
        found[at] = tulip.mass_matrix(q)

    threads = [threading.Thread(target=work, args=(at,)) for at in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all((one == expected).all() for one in found)


def test_a_model_is_pickled(puma):
    again = pickle.loads(pickle.dumps(puma))
    q = np.ones(6)
    assert (again.mass_matrix(q) == puma.mass_matrix(q)).all()
