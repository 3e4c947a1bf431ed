"""Simulation, base parameters, excitation, identification, diagnosis and walking."""

import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from numpy.testing import assert_allclose

import denavit


def test_base_parameters_have_the_known_count(puma):
    found = denavit.base_parameters(puma)
    assert found.rank == len(found.parameters) == 36
    assert found.is_good
    assert len(found.to_pandas()) == 36
    assert len(found.columns) == 60
    assert "<table>" in found._repr_html_() and found._repr_latex_().startswith("$")
    kept = denavit.base_parameters(puma, keep=["Izz"])
    assert kept.rank == 36 and any(one.name.startswith("Izz") for one in kept.parameters)


@pytest.mark.parametrize("name", ["planar_2r", "scara", "stanford"])
def test_base_parameters_are_as_many_as_numbers_say(name, random):
    model = denavit.load(name)
    stacked = model.regressor(*random.uniform(-1, 1, (3, 200, model.dof))).matrix
    rank = np.linalg.matrix_rank(stacked.reshape(-1, stacked.shape[-1]), tol=1e-8)
    assert denavit.base_parameters(model, joint_parameters=["modelled"]).rank == rank


def test_a_pendulum_keeps_its_energy():
    run = denavit.simulate("double_pendulum")
    model = denavit.load(run.model)
    energy = model.kinetic_energy(run.q, run.qd) + model.potential_energy(run.q)
    assert_allclose(energy, energy[0], atol=1e-6 * np.abs(energy).max() + 1e-9)
    assert run.stop == "end" and run.is_good and not run.broken
    assert run.values.shape == (len(run.t), len(run.columns))
    assert run.q.base is not None
    assert list(run.to_pandas().columns) == list(run.columns[1:])


def test_a_ball_bounces():
    run = denavit.simulate("bouncing_ball")
    assert run.events > 3
    assert "<p>" in run._repr_html_()


def test_a_scenario_is_a_dict(arm):
    content = {
        "format": "denavit-scenario/1",
        "name": "falls",
        "model": arm,
        "duration_s": 0.05,
        "log_period_s": 0.01,
    }
    run = denavit.simulate(content)
    # from rest: q = q0 + qdd t^2 / 2 at first
    start = arm.forward_dynamics(np.zeros(3), np.zeros(3), np.zeros(3))
    assert_allclose(run.q[1], start * 0.01**2 / 2, rtol=1e-2, atol=1e-6)


def test_scenarios_that_are_wrong():
    with pytest.raises(denavit.SimulateError) as caught:
        denavit.simulate({"format": "denavit-scenario/1", "model": "tulip", "duration_s": -1})
    assert caught.value.line is not None
    with pytest.raises(denavit.SimulateError) as caught:
        denavit.simulate("bouncing_bal")
    assert "bouncing_ball" in caught.value.hint
    with pytest.raises(denavit.ArgumentError, match="scheme"):
        denavit.simulate("bouncing_ball", scheme="euler")  # type: ignore[arg-type]


def test_a_run_is_a_page(tmp_path):
    page, log = tmp_path / "ball.html", tmp_path / "ball.csv"
    run = denavit.simulate("bouncing_ball", html=page, log=log)
    text = page.read_text()
    assert text.startswith("<!DOCTYPE html>") and 'figure class="scene"' in text
    # as many as the page lists: a start is none
    assert run.events > 5 and "touches the ground" in text
    assert "Measured beside simulated" not in text


def test_a_page_has_two_runs_over_each_other(tmp_path):
    page, log = tmp_path / "both.html", tmp_path / "ball.csv"
    denavit.simulate("bouncing_ball", log=log)
    denavit.simulate("bouncing_ball", scheme="time-stepping", html=page, beside=log)
    text = page.read_text()
    assert "Measured beside simulated" in text and "ball.csv" in text
    with pytest.raises(denavit.Error):
        denavit.simulate("tulip_step", html=page, beside=log)


def test_excitation_keeps_limits():
    found = denavit.excite("tulip_leg_table34", harmonics=3, starts=1, evaluations=60)
    assert found.feasible and found.condition > 1
    assert found.trajectory["format"] == "denavit-trajectory/1"
    again = denavit.excite("tulip_leg_table34", check=found.trajectory)
    assert_allclose(again.condition, found.condition, rtol=0.2)
    assert len(found.to_pandas()) == len(denavit.load("tulip_leg_table34").joints)


def test_identification_finds_the_values_of_the_model(arm, log_of):
    stages = []
    found = denavit.identify(
        arm,
        [log_of(arm, 1)],
        [log_of(arm, 2)],
        progress=lambda stage, share: stages.append(stage),
    )
    assert found.is_good, found.remarks
    assert found.rank == found.excited
    for one in found.parameters:
        assert abs(one.value - one.model_value) < 6 * one.std + 1e-2 * abs(one.model_value)
    assert found.residual.validate < 0.01
    assert stages
    assert found.updated.dof == arm.dof
    q = np.ones(3)
    assert_allclose(found.updated.gravity_vector(q), arm.gravity_vector(q), rtol=1e-2)
    assert "<table>" in found._repr_html_() and r"\pm" in found._repr_latex_()


def test_diagnosis_names_what_is_hidden(arm, log_of):
    def hidden(q, qd):
        return np.stack([np.zeros(len(q)), 0.8 * np.tanh(qd[:, 1] / 0.01), np.zeros(len(q))], 1)

    logs = [log_of(arm, seed, hidden, noise=0.01) for seed in (1, 2)]
    found = denavit.diagnose(arm, logs[0], logs[1], most=2)
    assert found.effects, found.verdict
    assert found.effects[0].at == arm.joints[1]
    assert found.gap.validate.after < 0.3 * found.gap.validate.before
    assert found.effects[0].effect in found._repr_html_()


def test_logs_that_are_wrong(arm, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("t,q_link1\n0,0\n")
    with pytest.raises(denavit.IdentifyError) as caught:
        denavit.identify(arm, path)
    assert caught.value.file == str(path)
    with pytest.raises(denavit.IdentifyError, match="no column `t`") as caught:
        denavit.identify(arm, {"q_link1": np.zeros(4)})
    assert caught.value.file == "train"
    with pytest.raises(denavit.IdentifyError):
        denavit.identify(arm, tmp_path / "none.csv")
    with pytest.raises(denavit.ArgumentError, match="method"):
        denavit.identify(arm, path, method="best")  # type: ignore[arg-type]


def test_hints_name_keywords(arm, log_of):
    log = log_of(arm, 1)
    with pytest.raises(denavit.IdentifyError) as caught:
        denavit.identify(arm, [log], prior=True)
    assert "prior" in caught.value.cause and "--" not in str(caught.value)


def test_gaits_are_designed_and_judged():
    gait = denavit.walk.design("planar_biped_primitives")
    assert gait.step_length_m > 0 and len(gait.knots) > 2
    run = denavit.simulate(gait.scenario)
    assert run.stop == "end"
    cycle = denavit.walk.poincare("compass_gait")
    assert cycle.stable and cycle.largest < 1
    assert_allclose(np.hypot(*cycle.multipliers[0]), cycle.largest, rtol=1e-9)
    balance = denavit.walk.balance("planar_biped_zmp_gait")
    assert balance.exact.margin_min_m <= balance.exact.margin_max_m
    assert 0 < sum(balance.shares.values()) < 3


def test_gaits_that_are_wrong():
    with pytest.raises(denavit.WalkError):
        denavit.walk.design({"format": "denavit-gait/1"})


def test_progress_stops_a_run(arm, log_of):
    with pytest.raises(KeyboardInterrupt):
        denavit.identify(arm, log_of(arm, 1), progress=lambda stage, share: False)

    def fails(stage, share):
        raise LookupError("of the caller")

    with pytest.raises(LookupError, match="of the caller"):
        denavit.identify(arm, log_of(arm, 1), progress=fails)


INTERRUPTED = """
import signal
import denavit

# a shell that runs in the background hands down that interrupts are ignored
signal.signal(signal.SIGINT, signal.default_int_handler)
print("ready", flush=True)
try:
    # a search that would take a minute and more
    denavit.walk.push("planar_biped_limit_cycle_gait")
    print("done", flush=True)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def test_an_interrupt_stops_a_run():
    with subprocess.Popen(
        [sys.executable, "-c", INTERRUPTED], stdout=subprocess.PIPE, text=True
    ) as child:
        assert child.stdout is not None and child.stdout.readline() == "ready\n"
        time.sleep(1)
        started = time.monotonic()
        child.send_signal(signal.SIGINT)
        try:
            said, _ = child.communicate(timeout=60)
        finally:
            child.kill()
    assert said == "interrupted\n" and child.returncode == 0
    assert time.monotonic() - started < 20
