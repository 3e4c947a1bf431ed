"""Walking: closed forms of the linear inverted pendulum, and criteria against each other."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import denavit
from denavit import walk


def reach(found, backward):
    """Reaches by steps (Koolen and others, 2012): d_N = t + (l + d_(N-1) - t) e^(-w T)."""
    tip = found.heel_m if backward else found.toe_m
    longest = found.longest_step_m[0 if backward else 1]
    shrinks = np.exp(-np.sqrt(9.81 / found.height_m) * found.step_s)
    reaches = [tip]
    for _ in found.reach[1:]:
        # the other end of the sole is ahead of the next ankle, seen from behind
        reaches.append(tip + (longest + reaches[-1] - tip) * shrinks)
    return reaches, tip + longest * shrinks / (1 - shrinks)


@pytest.mark.parametrize(
    ("scenario", "options"),
    [
        ("planar_biped_capture_step", {}),
        ("planar_biped_zmp_gait", {"height_m": 0.5, "step_time_s": 0.4, "longest_step_m": 0.2}),
    ],
)
def test_capturability_is_that_of_the_pendulum(scenario, options):
    found = walk.capturability(scenario, steps=7, **options)
    assert len(found.reach) == 8 and [one.steps for one in found.reach] == list(range(8))
    assert_allclose(found.omega_per_s, np.sqrt(9.81 / found.height_m))
    forward, limit = reach(found, backward=False)
    assert_allclose([one.forward_m for one in found.reach], forward)
    assert_allclose(found.limit.forward_m, limit)
    backward, limit = reach(found, backward=True)
    assert_allclose([one.backward_m for one in found.reach], backward)
    assert_allclose(found.limit.backward_m, limit)
    if options:
        assert (found.height_m, found.step_s) == (0.5, 0.4)
        assert found.longest_step_m == (0.2, 0.2)
    assert len(found.to_pandas()) == 8 and "<table>" in found._repr_html_()


def test_capture_points_need_the_steps_of_their_reach(tmp_path):
    picture = tmp_path / "reach.svg"
    all_reaches = walk.capturability("planar_biped_capture_step", svg=picture)
    assert picture.read_text().startswith("<svg")
    for steps in range(1, 4):
        below, above = all_reaches.reach[steps - 1].forward_m, all_reaches.reach[steps].forward_m
        middle = (below + above) / 2
        asked = walk.capturability("planar_biped_capture_step", capture_m=middle).capture
        assert asked.steps == steps
        assert asked.region_m[0] <= asked.region_m[1] <= all_reaches.longest_step_m[1]
    beyond = 1.01 * all_reaches.limit.forward_m
    fallen = walk.capturability("planar_biped_capture_step", capture_m=beyond).capture
    assert fallen.steps is None and fallen.region_m is None


def test_pushes_are_predicted_by_capturability():
    found = walk.capture_steps("planar_biped_capture_step", impulses_ns=[-6, 0, 6, 14])
    assert [push.impulse_ns for push in found.pushes] == [-6, 0, 6, 14]
    # mechanics is linear in an impulse, and the capture point in the velocity
    points = [push.capture_m for push in found.pushes]
    assert_allclose((points[2] - points[1]) / 6, (points[3] - points[2]) / 8, rtol=1e-9)
    # backward the sole turns about its heel
    assert_allclose((points[1] - points[0]) / 6, (points[2] - points[1]) / 6, rtol=1e-2)
    for push in found.pushes:
        asked = walk.capturability("planar_biped_capture_step", capture_m=push.capture_m)
        assert asked.capture.steps == push.predicted_steps
        assert push.agrees == (push.steps == push.predicted_steps)
    assert found.agree == sum(push.agrees for push in found.pushes) == 4
    assert found.pushes[1].steps == 0 and found.pushes[1].outcome == "stands"
    assert len(found.to_pandas()) == 4 and "4 of 4" in found._repr_html_()
    graded = walk.capture_steps("planar_biped_capture_step", most_ns=4, pushes=3)
    assert [push.impulse_ns for push in graded.pushes] == [-4, 0, 4]


def test_criteria_are_compared_by_what_comes_out():
    names = ["planar_biped_zmp_gait", "planar_biped_switched_off"]
    found = walk.compare(names, report=True)
    assert [run.scenario for run in found.runs] == names
    walks, falls = found.runs
    assert walks.outcome == "end" and falls.outcome == "fall"
    for run in found.runs:
        simulated = denavit.simulate(run.scenario)
        assert simulated.stop == run.outcome
        assert_allclose(run.end_s, simulated.end_s, rtol=1e-6)
        for one in vars(run.criteria).values():
            fell = run.outcome == "fall"
            wrong = one.verdict == "met" if fell else one.verdict == "missed"
            assert one.wrong == wrong and (one.missed_at_s is None) == (one.verdict != "missed")
    cycle = walk.poincare(names[0], unchecked=True)
    assert_allclose(walks.largest_multiplier, cycle.largest, rtol=1e-6)
    assert_allclose(walks.energy.speed_m_s, cycle.travel_m[0] / cycle.period_s, rtol=1e-3)
    assert falls.energy is None and falls.largest_multiplier is None
    table = found.to_pandas()
    assert list(table["scenario"]) == names and table["poincare"][0].startswith("met")
    assert found.report.startswith("<!DOCTYPE html>") and "2 runs" in found._repr_html_()


def test_a_scenario_may_be_a_dict():
    content = {
        "format": "denavit-scenario/1",
        "name": "stands",
        "model": denavit.load("planar_biped"),
        # numbers of numpy are numbers
        "duration_s": np.float32(0.25),
        "initial": {"on_ground": np.bool_(True)},
    }
    found = walk.capturability(content, step_time_s=np.float64(0.3))
    assert found.scenario == "stands" and found.step_s == 0.3


def test_a_gait_has_a_page():
    page = walk.page("compass_gait")
    assert page.startswith("<!DOCTYPE html>") and page.count("<svg") > 2
    assert "compass" in page


def test_multipliers_do_not_depend_on_the_section(tmp_path):
    pictures = {"map": tmp_path / "map.svg", "svg": tmp_path / "circle.svg"}
    middle = walk.poincare("compass_gait", unchecked=True, **pictures)
    assert all(path.read_text().startswith("<svg") for path in pictures.values())
    strike = walk.poincare("compass_gait", section="strike", unchecked=True)
    assert_allclose(strike.largest, middle.largest, rtol=1e-3)
    assert_allclose(strike.period_s, middle.period_s, rtol=1e-5)
    assert middle.contradiction is None
    few = walk.poincare("compass_gait", unchecked=True, off_rad_s=0.05, returns=3)
    assert_allclose(few.largest, middle.largest, rtol=1e-9)
    assert len(few.json["returns"]["lengths"]) < len(middle.json["returns"]["lengths"])
    with pytest.raises(denavit.WalkError, match="no clock"):
        walk.poincare("compass_gait", section=0.3)


def test_the_margins_are_those_of_the_series(tmp_path):
    found = walk.balance("planar_biped_zmp_gait", events=tmp_path / "events.csv")
    margins = found.series.column("zmp_margin")
    assert found.exact.margin_min_m == np.nanmin(margins)
    assert found.exact.margin_max_m == np.nanmax(margins)
    assert (tmp_path / "events.csv").exists()
    frame = found.series.to_pandas()
    assert list(frame.columns) == list(found.series.columns)
    with pytest.raises(denavit.ArgumentError) as caught:
        found.series.column("zmp")
    assert "zmp_x" in caught.value.hint
    momentum = walk.balance("planar_biped_zmp_gait", "momentum")
    column = momentum.series.column("angular_momentum_y")
    assert_allclose(momentum.angular_momentum_y, [column.min(), column.max()])


def test_a_log_is_judged_with_its_model(tmp_path):
    log = tmp_path / "gait.csv"
    run = denavit.simulate("planar_biped_zmp_gait", log=log)
    found = walk.balance(log, model="planar_biped")
    assert found.over == "run" and len(found.series.values) == len(run.t)
    whole = walk.balance("planar_biped_zmp_gait", whole=True, period_s=0.01)
    assert_allclose(found.exact.margin_min_m, whole.exact.margin_min_m, atol=1e-3)
    with pytest.raises(denavit.WalkError) as caught:
        walk.balance(log)
    assert "model" in caught.value.hint and "--" not in str(caught.value)


def test_starts_of_a_basin_are_counted():
    found = walk.basin("compass_gait", grid=2, steps=2, reach=(0.01, 0.01))
    assert len(found.series.values) == found.starts == 4
    assert found.series.column("walks").sum() == found.walks
    assert np.abs(found.series.column("qd_base_pitch")).max() > 0


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: walk.push("compass_gait", most_ns=-1), "most_ns"),
        (lambda: walk.push("compass_gait", resolution_ns=0), "resolution_ns"),
        (lambda: walk.push("compass_gait", after_s=0), "after_s"),
        (lambda: walk.capturability("compass_gait", height_m=-1), "height_m"),
        (lambda: walk.capturability("compass_gait", step_time_s=0), "step_time_s"),
        (lambda: walk.capturability("compass_gait", longest_step_m=-1), "longest_step_m"),
        (lambda: walk.capturability("compass_gait", capture_m=1e9), "capture_m"),
        (lambda: walk.capturability("compass_gait", steps=-1), "steps"),
        (lambda: walk.capture_steps("compass_gait", impulses_ns=["a"]), "impulses_ns"),
        (lambda: walk.capture_steps("compass_gait", pushes=1), "pushes"),
        (lambda: walk.capture_steps("compass_gait", impulses_ns=[1], most_ns=1), "most_ns"),
        (lambda: walk.compare("compass_gait", period_s=0), "period_s"),
        (lambda: walk.page("compass_gait", period_s=2), "period_s"),
        (lambda: walk.poincare("compass_gait", off_rad_s=0), "off_rad_s"),
        (lambda: walk.poincare("compass_gait", section=2.0), "section"),
        (lambda: walk.basin("compass_gait", vary=("q_a", "q_b")), "vary"),
        (lambda: walk.balance("compass_gait", model="compass", whole=True), "whole"),
        (lambda: walk.compare("compas_gait"), "no such file"),
        (lambda: walk.page("compas_gait"), "no such file"),
        (lambda: walk.capturability({"format": "denavit-scenario/1"}), "model"),
        (lambda: walk.capture_steps("planar_biped_zmp_gait"), "capture_step"),
        (lambda: walk.compare(3), "path"),
    ],
)
def test_faults_are_in_words_of_python(call, said):
    with pytest.raises(denavit.Error) as caught:
        call()
    text = str(caught.value)
    assert said in text
    assert "--" not in text and "<" not in text and "help" not in text and "/tmp" not in text


def test_references_alone_walk_no_limit_cycle(tmp_path):
    alone = tmp_path / "references.json"
    walk.design("planar_biped_primitives", trajectory=alone, svg=tmp_path / "step.svg")
    assert "denavit-trajectory/1" in alone.read_text() and (tmp_path / "step.svg").exists()
    with pytest.raises(denavit.WalkError) as caught:
        walk.design("planar_biped_limit_cycle", trajectory=alone)
    assert "scenario" in caught.value.hint and "-o" not in caught.value.hint
