"""Measurements at rest, against weighted means and robots of known parameters."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import denavit


@pytest.fixture(scope="module")
def planar():
    return denavit.load("planar_2r")


def weighing(mass, std, links=("link1", "link2")):
    return {"links": list(links), "mass_kg": mass, "std_kg": std}


def test_weighings_are_weighted_means(planar):
    found = denavit.identify_statics(
        planar, {"weighings": [weighing(3.5, 0.01), weighing(3.53, 0.03)]}
    )
    assert found.is_good and not found.contradicts
    (sum_of_masses,) = found.combinations
    assert len(sum_of_masses.members) == 2
    assert_allclose(list(sum_of_masses.members.values()), 1.0, rtol=1e-12)
    weights = np.array([1 / 0.01**2, 1 / 0.03**2])
    assert_allclose(sum_of_masses.value, weights @ [3.5, 3.53] / weights.sum())
    assert_allclose(sum_of_masses.std, weights.sum() ** -0.5)
    assert_allclose(found.chi_squared, 0.03**2 / (0.01**2 + 0.03**2), rtol=1e-9)
    assert found.degrees_of_freedom == 1 and found.equations == 2
    assert str(sum_of_masses) in found.to_pandas()["combination"].tolist()
    assert "<table>" in found._repr_html_() and "combinations" in found._repr_html_()


def test_a_link_alone_is_what_the_scale_says(planar):
    found = denavit.identify_statics(planar, {"weighings": [weighing(1.25, 0.02, ["link2"])]})
    (mass,) = [one for one in found.parameters if one.identifiable]
    assert mass.unit == "kg"
    assert_allclose([mass.value, mass.std], [1.25, 0.02])


def test_contradictions_are_no_good_answer(planar):
    found = denavit.identify_statics(
        planar, {"weighings": [weighing(3.5, 0.01), weighing(4.5, 0.01)]}
    )
    assert found.contradicts and not found.is_good


def heavier(model):
    content = model.to_dict()
    for link in content["links"]:
        link["body"]["mass"] *= 1.3
    return denavit.load(content)


def postures(model, random):
    found = []
    for q in random.uniform(-1.5, 1.5, (6, model.dof)):
        torques = zip(model.joints, model.gravity_vector(q))
        found.append(
            {
                "q": dict(zip(model.joints, q)),
                "torques": {joint: {"torque": tau, "std": 1e-4} for joint, tau in torques},
            }
        )
    return found


def true_values(found, truth):
    known = {one.name: one.model_value for one in truth.parameters}
    combinations = [one.members for one in found.combinations]
    return [sum(factor * known[name] for name, factor in one.items()) for one in combinations]


def test_postures_show_the_weight_of_another_robot(planar, random):
    truth = heavier(planar)
    assert not np.allclose(truth.gravity_vector([0.3, 0.2]), planar.gravity_vector([0.3, 0.2]))
    measured = {"postures": postures(truth, random)}
    found = denavit.identify_statics(planar, measured)
    assert found.is_good and found.equations == 12
    # two moments of each link carry all of the gravity of a planar arm
    assert len(found.combinations) == 4 and found.degrees_of_freedom == 12 - 4
    expected = true_values(found, denavit.identify_statics(truth, measured))
    assert_allclose([one.value for one in found.combinations], expected, rtol=1e-3, atol=1e-9)


def test_logs_are_joined(planar, random, log_of):
    measured = {"weighings": [weighing(3.5, 0.01)], "postures": postures(planar, random)}
    alone = denavit.identify_statics(planar, measured)
    joined = denavit.identify_statics(planar, measured, log_of(planar, 1))
    identified = denavit.identify(planar, log_of(planar, 1))
    assert joined.equations == alone.equations + identified.rank
    assert len(joined.combinations) > len(alone.combinations)
    assert len(joined.combinations) >= identified.rank


def test_files_and_faults(planar, tmp_path):
    path = tmp_path / "rest.json"
    path.write_text(
        '{"format": "denavit-statics/1",\n'
        ' "weighings": [{"links": ["link9"], "mass_kg": 1, "std_kg": 0.1}]}'
    )
    with pytest.raises(denavit.IdentifyError, match="link9"):
        denavit.identify_statics(planar, path)
    with pytest.raises(denavit.IdentifyError) as caught:
        denavit.identify_statics(planar, {"weighings": [{"links": ["link1"], "mass_kg": 1.0}]})
    assert caught.value.file == "measurements.json" and "std_kg" in caught.value.cause
    with pytest.raises(denavit.Error, match="measurements"):
        denavit.identify_statics(planar, 3)
    with pytest.raises(denavit.IdentifyError):
        denavit.identify_statics(planar, tmp_path / "none.json")
    with pytest.raises(denavit.ArgumentError) as caught:
        denavit.identify_statics(planar, path, decimate=0)
    assert "decimate" in caught.value.cause and "--" not in str(caught.value)
