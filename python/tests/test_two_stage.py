"""Springs and motors of a simulated leg, whose values are known."""

import pytest
from numpy.testing import assert_allclose

import denavit


@pytest.fixture(scope="module")
def moved():
    return denavit.simulate("tulip_leg_elastic_identification")


@pytest.fixture(scope="module")
def leg():
    return denavit.load("tulip_leg")


@pytest.fixture(scope="module")
def found(leg, moved):
    """What is found from a model whose springs are wrong by half."""
    content = leg.to_dict()
    for joint in ("hip_y", "knee", "ankle_y"):
        content["drives"][joint]["series_elastic"]["stiffness"] = 40000
        content["drives"][joint]["coulomb"] = 0.001
    return denavit.identify_two_stage(
        denavit.load(content),
        moved,
        filter_hz=40,
        friction="tanh",
        accept_suspicious=True,
        report=True,
    )


def test_springs_are_those_of_the_simulated_leg(leg, found):
    assert [spring.joint for spring in found.springs] == ["hip_y", "knee", "ankle_y"]
    drives = leg.to_dict()["drives"]
    for spring in found.springs:
        drive = drives[spring.joint]
        stiffness = drive["series_elastic"]["stiffness"]
        assert_allclose(spring.stiffness.value, stiffness, rtol=0.01)
        assert_allclose(spring.coulomb.value, drive["coulomb"], rtol=0.02)
        assert_allclose(spring.viscous.value, drive["viscous"], rtol=0.05)
        assert abs(spring.stiffness.value - stiffness) < 10 * spring.stiffness.std
        assert spring.residual_rms < 0.1 * spring.torque_rms
    assert found.is_good and found.validate is None


def test_the_updated_model_has_the_springs(found):
    assert found.update_refused is None
    drives = found.updated.to_dict()["drives"]
    for spring in found.springs:
        written = drives[spring.joint]["series_elastic"]["stiffness"]["value"]
        assert_allclose(written, spring.stiffness.value, rtol=1e-9)


def test_tables_and_page(found):
    table = found.to_pandas().set_index("name")
    assert len(table) == 5 * len(found.springs) + len(found.parameters)
    assert table.loc["stiffness of knee", "value"] == found.springs[1].stiffness.value
    assert "<table>" in found._repr_html_() and "3 springs" in found._repr_html_()
    assert found.report.startswith("<!") and "train" in found.report


def test_another_log_judges(leg, moved):
    # the first stage is of one log, and a log that is searched judges nothing
    again = denavit.identify_two_stage(
        leg, moved, moved, accept_suspicious=True, friction="tanh", update=False
    )
    assert not again.is_good and again.updated is None
    assert any("train" in remark for remark in again.remarks)
    assert 0 < again.validate < 0.2


def test_what_has_no_springs(arm, leg, moved, log_of):
    with pytest.raises(denavit.IdentifyError) as caught:
        denavit.identify_two_stage(arm, log_of(arm, 1))
    assert "--" not in str(caught.value)
    with pytest.raises(denavit.IdentifyError):
        denavit.identify_two_stage(leg, [moved, moved])
    # within the limits of the model
    first = {name: moved.column(name)[:1000] for name in moved.columns}
    # as one regression it is refused, and the hint is the call
    with pytest.raises(denavit.IdentifyError) as caught:
        denavit.identify(leg, first)
    said = str(caught.value)
    assert "identify_two_stage" in said and "--" not in said and "LOG" not in said
