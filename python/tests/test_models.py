"""Models of files, dicts and URDF, and what is wrong with them."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import denavit

PENDULUM = """<robot name="pendulum">
  <link name="world"/>
  <link name="rod">
    <inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
      <inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="swing" type="revolute">
    <parent link="world"/><child link="rod"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="10" velocity="5"/>
  </joint>
</robot>
"""


def test_a_urdf_is_a_pendulum(tmp_path):
    path = tmp_path / "pendulum.urdf"
    path.write_text(PENDULUM)
    of_text = denavit.Model.from_urdf(PENDULUM)
    for model in (denavit.Model.from_urdf(path), of_text, denavit.load(path)):
        assert model.dof == 1
        # m g c sin q, and I + m c^2, of textbooks
        g = -model.gravity_vector([np.pi / 2])[0] / (2 * 0.5)
        assert_allclose(abs(g), 9.81, rtol=1e-3)
        assert_allclose(model.mass_matrix([0.3]), [[0.1 + 2 * 0.25]], rtol=1e-12)


def test_a_urdf_that_floats():
    model = denavit.Model.from_urdf(PENDULUM, base="floating")
    assert model.dof == 7


def test_a_dict_is_a_model(puma):
    content = puma.to_dict()
    again = denavit.load(content)
    q = np.linspace(-1, 1, 6)
    assert (again.mass_matrix(q) == puma.mass_matrix(q)).all()
    assert again.name == "puma560"


def test_a_model_is_saved(puma, tmp_path):
    puma.save(tmp_path / "mine.json")
    assert denavit.load(tmp_path / "mine.json").joints == puma.joints


def test_names_and_tables(tulip):
    assert "tulip" in denavit.shipped_models()
    assert tulip.dof == len(tulip.joints) == 18
    assert repr(tulip) == "<denavit.Model tulip: 18 degrees of freedom>"
    assert "<table>" in tulip._repr_html_()
    assert len(tulip.to_pandas()) == len(tulip.links)


def test_formulas():
    text = denavit.load("double_pendulum").latex("mass_matrix")
    assert text.startswith(r"\begin{aligned}") and r"\cos" in text and "bmatrix" in text
    assert denavit.load("double_pendulum")._repr_latex_().startswith("$")
    assert denavit.load("puma560").latex("gravity_vector").count("&=") >= 1


def test_faults_have_places_and_hints(tmp_path):
    path = tmp_path / "broken.json"
    path.write_text(
        '{"format": "denavit-model/1", "name": "arm", "convention": "standart",\n'
        ' "gravity": [0, 0, "-g"],'
        ' "links": [{"name": "shoulder", "joint": {"type": "revolute", "a": "l1"}}]}'
    )
    with pytest.raises(denavit.ModelError) as caught:
        denavit.load(path)
    error = caught.value
    assert (error.file, error.line, error.column) == (str(path), 1, 60)
    assert "unknown convention `standart`" in error.cause
    assert error.hint == 'did you mean "standard"?'
    assert [fault.line for fault in error.faults] == [1, 2, 2]
    assert "hint: did you mean" in str(error)


def test_what_is_not_there(tmp_path):
    with pytest.raises(denavit.ModelError) as caught:
        denavit.load("puma650")
    assert caught.value.hint == "`puma560` is a shipped model"
    with pytest.raises(denavit.ModelError, match="no such file"):
        denavit.load(tmp_path / "none.json")
    with pytest.raises(denavit.ModelError):
        denavit.load(tmp_path)
    with pytest.raises(denavit.ArgumentError):
        denavit.load(3)
    with pytest.raises(denavit.ArgumentError):
        denavit.load("-")
    with pytest.raises(denavit.ModelError):
        denavit.load({"format": "denavit-model/1"})
    with pytest.raises(denavit.ModelError):
        denavit.load(json.loads("{}"))


def test_a_urdf_that_is_wrong():
    with pytest.raises(denavit.ModelError) as caught:
        denavit.Model.from_urdf(PENDULUM.replace('type="revolute"', 'type="rotary"'))
    assert caught.value.line is not None
    with pytest.raises(denavit.ModelError):
        denavit.Model.from_urdf("<robot")


def test_values_go_into_the_urdf_that_a_model_was_made_of():
    model = denavit.Model.from_urdf(PENDULUM)
    content = model.to_dict()
    assert model.to_urdf(into=PENDULUM) == PENDULUM
    bodies = [link["body"] for link in content["links"] if "body" in link]
    heavy = next(body for body in bodies if body.get("mass"))
    heavy["mass"] = 3
    updated = denavit.load(content).to_urdf(into=PENDULUM)
    assert updated == PENDULUM.replace('<mass value="2"/>', '<mass value="3"/>')
    again = denavit.Model.from_urdf(updated)
    # I + m c^2
    assert_allclose(again.mass_matrix([0.3]), [[0.1 + 3 * 0.25]], rtol=1e-12)


@pytest.mark.filterwarnings("ignore::denavit.ModelWarning")
def test_robots_are_exported(tmp_path):
    model = denavit.load("panda")
    q, qd, qdd = np.random.default_rng(3).uniform(-0.5, 0.5, (3, model.dof))
    expected = model.inverse_dynamics(q, qd, qdd)
    for text in (model.to_urdf(), model.to_mjcf()):
        again = denavit.Model.from_urdf(text)
        assert again.dof == model.dof
        assert_allclose(again.mass_matrix(q), model.mass_matrix(q), rtol=1e-9, atol=1e-12)
        assert_allclose(again.gravity_vector(q), model.gravity_vector(q), rtol=1e-9, atol=1e-9)
        assert_allclose(again.inverse_dynamics(q, qd, qdd), expected, rtol=1e-9, atol=1e-9)
    with pytest.raises(denavit.ModelError, match="no such file"):
        model.to_urdf(into=tmp_path / "none.urdf")
    with pytest.raises(denavit.ModelError):
        model.to_urdf(into="<robot name='other'/>")


def test_contact_points_of_a_mesh_in_another_folder(tmp_path: Path) -> None:
    text = (
        '<robot name="r"><link name="base"/><link name="foot"><inertial><mass value="1"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial><collision>'
        '<geometry><mesh filename="package://feet/sole.obj"/></geometry></collision></link>'
        '<joint name="hip" type="continuous"><axis xyz="0 1 0"/><parent link="base"/>'
        '<child link="foot"/></joint></robot>'
    )
    corners = [(0.1, 0, 0), (0, 0.2, 0), (-0.1, 0, 0), (0, -0.2, 0), (0, 0, 1)]
    (tmp_path / "sole.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners))
    with pytest.raises(denavit.ModelError, match="say where the meshes are") as refused:
        denavit.Model.from_urdf(text, contacts=["foot"])
    assert "the folder of the text has no such file" in str(refused.value)
    with pytest.warns(denavit.ModelWarning, match="4 corners"):
        model = denavit.Model.from_urdf(text, contacts=["foot"], meshes=tmp_path)
    found = model.contact_positions(np.zeros(1))
    assert sorted(map(tuple, found)) == sorted(corners[:4])
