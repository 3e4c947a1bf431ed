"""Fleets: robots that change are found, others are left alone, and broken logs harm nobody else."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import denavit
from denavit import studies
from denavit.__main__ import main
from denavit.fleet import FleetError, Options, judge, write_example
from denavit.fleet.changes import Estimate, History, judged, less_common
from denavit.fleet.distributions import two_sided
from denavit.fleet.drift import changed, drift
from denavit.fleet.models import kind_of, read_models
from denavit.fleet.sources import fetched, read_fleet
from denavit.fleet.testing import adjusted, combined
from denavit.studies.here import in_processes

pq = pytest.importorskip("pyarrow.parquet")

ALARMS = Options(diagnose="alarms")
NONE = Options(diagnose="none")


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    """Twelve arms, one of which acquires an effect in the third of three nights."""
    folder = tmp_path_factory.mktemp("example")
    write_example(folder, robots=12, nights=3, changed=1, seed=5)
    return folder


@pytest.fixture(scope="module")
def found(example):
    """The fleet, judged in this process."""
    out = example / "found"
    judge(example / "logs", example / "arm.json", out, options=ALARMS)
    return out


def rows(out):
    return pq.read_table(out / "fleet.parquet").to_pylist()


def contents(out):
    names = ["fleet.parquet", "parameters.parquet", "drift.parquet", "index.html"]
    pages = sorted((out / "reports").glob("*"))
    return {one.name: one.read_bytes() for one in [*(out / name for name in names), *pages]}


def test_the_robot_that_changed_is_named_with_its_joint(example, found):
    answer = json.loads((example / "answer.json").read_text())
    assert len(answer) == 1
    (robot, hidden), table = next(iter(answer.items())), rows(found)
    assert len(table) == 12 * 3
    alarms = [row for row in table if row["is_alarm"]]
    assert [(row["robot"], row["night"]) for row in alarms] == [(robot, hidden["since"])]
    assert (alarms[0]["effect"], alarms[0]["joint"]) == (hidden["effect"], hidden["at"])
    assert alarms[0]["false_discovery_rate"] <= 0.05 and alarms[0]["log10_odds"] > 2
    assert all(row["is_first"] == (row["night"] == "2026-01-01") for row in table)
    page = (found / "index.html").read_text()
    assert "1 alarm among" in page and "(odds 10<sup>" in page
    assert hidden["effect"].replace("_", " ") in page
    for raw in ("10^", "nothing_missing", "cannot_tell", "1 alarms"):
        assert raw not in page
    report = (found / alarms[0]["report"]).read_text()
    assert hidden["effect"] in report.lower()
    steps = pq.read_table(found / "drift.parquet").to_pylist()
    assert {one["robot"] for one in steps if one["is_change"]} <= {robot}


def test_the_page_is_offline_and_links_the_report(found):
    text = (found / "index.html").read_text()
    assert "default-src 'none'" in text and "unsafe-inline" not in text
    assert "<script" not in text and "style=" not in text.split("</style>")[1]
    assert "http" not in text.replace("http-equiv", "")
    first = text.split("<section>")[1]
    assert "alarm" in first and "reports/" in first and "<svg" in first


def test_processes_and_broken_off_runs_have_the_same_bytes(example, found, tmp_path):
    place = example / "logs", example / "arm.json"
    judge(*place, tmp_path / "two", runner=in_processes(2), options=ALARMS)
    assert contents(tmp_path / "two") == contents(found)
    # what an earlier run left is not computed again
    shutil.copytree(found / "rows", tmp_path / "again" / "rows")

    def never(study, indices):
        assert list(indices) == []
        return iter(())

    judge(*place, tmp_path / "again", runner=never, options=ALARMS)
    assert contents(tmp_path / "again") == contents(found)


def copied(example, folder, robots, nights=2):
    """Some robots and nights of the example."""
    for robot in robots:
        for night in range(1, nights + 1):
            source = example / "logs" / robot / f"2026-01-0{night}"
            shutil.copytree(source, folder / robot / source.name)
    return folder


def test_broken_logs_are_rows_that_say_so(example, tmp_path):
    names = ["arm-00", "arm-01", "arm-02", "arm-03", "arm-04"]
    good = copied(example, tmp_path / "good", names)
    bad = copied(example, tmp_path / "bad", names)
    night = "2026-01-02"
    (bad / "arm-00" / night / "train.csv").write_bytes(b"\x00\xff" * 500)
    cut = bad / "arm-01" / night / "train.csv"
    cut.write_bytes(cut.read_bytes()[: cut.stat().st_size // 2])
    (bad / "arm-02" / night / "validate.csv").write_text("")
    (bad / "arm-03" / night / "train.csv").write_text("t,q_shoulder\n0,0\n1,nan\n")
    found = {}
    for name, place in (("good", good), ("bad", bad)):
        judge(place, example / "arm.json", tmp_path / f"{name}-out", options=NONE)
        found[name] = {(row["robot"], row["night"]): row for row in rows(tmp_path / f"{name}-out")}
    for robot in ("arm-00", "arm-02", "arm-03"):
        row = found["bad"][robot, night]
        assert row["verdict"] == "no_answer" and not row["is_alarm"]
        assert f"{robot}/{night}" in row["reason"] and str(tmp_path) not in row["reason"]
    # others are untouched, but for p-values, which the fleet shares
    shared = {"p", "false_discovery_rate"}
    for key, row in found["good"].items():
        if key[0] == "arm-04" or key[1] == "2026-01-01":
            other = found["bad"][key]
            assert all(row[name] == other[name] for name in row.keys() - shared)
    page = (tmp_path / "bad-out" / "index.html").read_text()
    assert "no answer" in page and "arm-00/2026-01-02" in page


def test_logs_of_every_format_and_names_that_want_care(example, tmp_path):
    import denavit
    import pyarrow.csv
    from denavit.fleet import example as parts

    folder = copied(example, tmp_path / "logs", ["arm-00", "arm-01"], nights=1)
    night = "2026-01-01"
    for name in ("train", "validate"):
        csv = folder / "arm-01" / night / f"{name}.csv"
        text = [line for line in csv.read_text().splitlines() if not line.startswith("#")]
        csv.write_text("\n".join(text) + "\n")
        pq.write_table(pyarrow.csv.read_csv(csv), csv.with_suffix(".parquet"))
        csv.unlink()
    scenario = parts._scenario(parts.NOMINAL, example / "train_motion.json", 1)
    denavit.simulate(scenario, log=folder / "a.mcap")
    csv = f"arm-00/{night}/train.csv"
    manifest = {
        "robot": ["<b>&'\"../x", "cut in two", "mixed", "gone", "one mcap"],
        "night": ["../../1"] * 5,
        "train": [f"arm-01/{night}/train.parquet", csv, "a.mcap", "none.mcap", "a.mcap"],
        "validate": [f"arm-01/{night}/validate.parquet", None, csv, "none.csv", None],
    }
    import pyarrow as pa

    pq.write_table(pa.table(manifest), folder / "manifest.parquet")
    out = tmp_path / "out"
    options = Options(reports="all")
    judge(folder / "manifest.parquet", example / "arm.json", out, options=options)
    table = {row["robot"]: row for row in rows(out)}
    assert table["gone"]["reason"].startswith("none.mcap")
    assert "only tables can be cut" in table["one mcap"]["reason"]
    for robot in ("<b>&'\"../x", "cut in two", "mixed"):
        # the mixed one has logs of two robots
        assert table[robot]["reason"] is None and table[robot]["is_trusted"] == (robot != "mixed")
    text = (out / "index.html").read_text()
    assert "&lt;b&gt;" in text and "<b>&'" not in text
    pages = {one.name for one in (out / "reports").iterdir()}
    named = [row["report"] for row in table.values() if row["report"]]
    assert len(pages) == len(named) == 3 and all((out / name).is_file() for name in named)
    model = denavit.load(example / "arm.json")
    direct = denavit.identify(model, folder / "arm-00" / night / "train.csv")
    assert direct.is_good


def test_a_fleet_in_object_storage(example, found, tmp_path):
    moto = pytest.importorskip("moto.server")
    from pyarrow import fs

    keys = {"AWS_ACCESS_KEY_ID": "test", "AWS_SECRET_ACCESS_KEY": "test"}
    server = moto.ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    before = {name: os.environ.get(name) for name in keys}
    os.environ.update(keys)
    try:
        _, port = server.get_host_and_port()
        query = f"endpoint_override=127.0.0.1:{port}&scheme=http&region=us-east-1"
        query += "&allow_bucket_creation=true"
        store, _ = fs.FileSystem.from_uri(f"s3://fleet?{query}")
        store.create_dir("fleet")
        own = copied(example, tmp_path / "logs", ["arm-00", "arm-01"])
        fs.copy_files(str(own), "fleet/logs", destination_filesystem=store)
        place = f"s3://fleet/logs?{query}"
        judge(place, example / "arm.json", tmp_path / "s3", options=NONE)
        judge(own, example / "arm.json", tmp_path / "here", options=NONE)
        assert contents(tmp_path / "s3") == contents(tmp_path / "here")
        with pytest.raises(FleetError, match="is not there"):
            read_fleet(f"s3://fleet/nowhere?{query}")
        # no copy of a log leaves its folder
        for outside in ("../x.csv", "a/../../x.csv", "/x.csv"):
            with pytest.raises(FleetError, match="leads out"), fetched(place, [outside], []):
                pass
    finally:
        server.stop()
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


def test_what_is_wrong_is_said_at_once(example, tmp_path, capsys):
    logs = str(example / "logs")
    out = str(tmp_path / "out")

    def said(*arguments):
        assert main(["fleet", *arguments, "-o", out]) == 2
        return capsys.readouterr().err

    assert "is not there" in said(str(tmp_path / "none"), "--model-by", str(example / "arm.json"))
    (tmp_path / "empty").mkdir()
    assert "has no logs" in said(str(tmp_path / "empty"), "--model-by", str(example / "arm.json"))
    by = tmp_path / "by.json"
    by.write_text(json.dumps({"arm-00": "none.json", "arm-01": 3}))
    text = said(logs, "--model-by", str(by))
    assert "none.json" in text and "`arm-01`" in text
    assert "no pattern fits the robot `arm-02`" in text
    right = ["--model-by", str(example / "arm.json")]
    assert "ROBOT=NIGHT" in said(logs, *right, "--restart", "arm-00")
    assert "begins anew" in said(logs, *right, "--restart", "arm-00=never")
    assert "no share" in said(logs, *right, "--false-alarms", "2")
    assert "no place of logs" in said("gopher://x/y", *right)
    manifest = tmp_path / "manifest.csv"
    manifest.write_text("robot,night,train\na,1,x.csv\na,1,y.csv\n,2,z.csv\n")
    text = said(str(manifest), *right)
    assert "row 2" in text and "row 3" in text
    manifest.write_text("robot,log\na,1\n")
    text = said(str(manifest), *right)
    assert "`night`" in text and "`train`" in text
    assert not Path(out).exists()
    by.write_text(json.dumps({"arm-0*": str(example / "arm.json"), "*": "planar_2r"}))
    models = read_models(by, ["arm-00", "other"])
    assert json.loads(models["arm-00"])["name"] == "arm"
    assert json.loads(models["other"])["name"] == "planar_2r"


def test_a_history_begins_anew(example, tmp_path):
    robot = next(iter(json.loads((example / "answer.json").read_text())))
    logs = copied(example, tmp_path / "logs", [robot, "arm-00"], nights=3)
    options = Options(diagnose="none", restart={robot: "2026-01-03"})
    judge(logs, example / "arm.json", tmp_path / "out", options=options)
    last = [row for row in rows(tmp_path / "out") if row["robot"] == robot][-1]
    assert last["is_first"] and not last["is_alarm"] and last["p"] is None


def simulated(seed, robots=50, names=8, ratio=4.0, alike=8, size=0.0, moved=0):
    """Alarms of three nights after the first, of a fleet of numbers."""
    random = np.random.default_rng(seed)
    true, stds = random.normal(size=(robots, names)), random.uniform(0.5, 2, (robots, names))
    wide = stds * np.sqrt(ratio * alike / random.chisquare(alike, (robots, names)))
    histories = {f"r{robot:03}": History("arm") for robot in range(robots)}
    found = []
    for night in range(4):
        values = true + wide * random.normal(size=true.shape) + 3.0 * night
        if night >= 2:
            values[:moved, 0] += size * wide[:moved, 0]
        tonight = {
            robot: {f"p{at}": Estimate(v, s) for at, (v, s) in enumerate(zip(*own))}
            for robot, own in zip(histories, zip(values, stds))
        }
        verdicts = judged(tonight, histories, 0.05)
        alarms = [robot for robot, one in verdicts.robots.items() if one.is_alarm]
        found.append(alarms)
        for robot in tonight.keys() - set(alarms):
            night_less = less_common(tonight[robot], "arm", verdicts.common)
            histories[robot].nights.append(night_less)
    return found[1:]


def test_alarms_are_as_often_false_as_is_stated():
    """Scatter is twice the stated errors, robots differ, and the hall moves all of them."""
    nights = [night for seed in range(15) for night in simulated(seed)]
    # where nothing changed, any alarm is false: a share of nights of 5 %, by chance up to 7 of 45
    assert sum(bool(alarms) for alarms in nights) <= 7
    false, true, count = 0, 0, 0
    for seed in range(6):
        for alarms in simulated(seed, size=15.0, moved=5)[1:]:
            own = {f"r{robot:03}" for robot in range(5)}
            true += len(own & set(alarms))
            false += len(set(alarms) - own)
            count += 5
    assert true >= 0.9 * count and false <= 0.15 * true


def test_a_fleet_too_small_to_know_its_scatter_has_no_alarm():
    histories = {"one": History("arm", [{"p": Estimate(1.0, 0.1)}])}
    found = judged({"one": {"p": Estimate(9.0, 0.1)}}, histories, 0.05)
    assert not found.robots["one"].is_alarm and found.robots["one"].p == 1.0


def test_what_one_of_few_robots_does_does_not_pass_for_its_scatter():
    random = np.random.default_rng(3)
    for robots in (1, 2, 4):
        histories = {
            f"r{robot}": History(
                "arm", [{"p": Estimate(random.normal(robot, 0.1), 0.1)} for _ in range(4)]
            )
            for robot in range(robots)
        }
        for size, is_found in ((0.0, False), (3.0, True)):
            tonight = {robot: {"p": Estimate(float(robot[1:]), 0.1)} for robot in histories}
            tonight["r0"] = {"p": Estimate(size, 0.1)}
            found = judged(tonight, histories, 0.05).robots
            assert [one.is_alarm for one in found.values()] == [is_found] + [False] * (robots - 1)
            # nor does it widen what the diagnosis believes
            assert found["r0"].changes[0].ratio < 5


def test_robots_with_values_of_their_own_are_of_one_kind():
    model = denavit.load("puma560").to_dict()
    other = json.loads(json.dumps(model))
    other["name"], other["constants"]["a2"]["value"] = "mine", 0.44
    kinds = [kind_of(json.dumps(one)) for one in (model, other)]
    assert kinds[0] == kinds[1]
    assert kind_of(json.dumps(denavit.load("panda").to_dict())) != kinds[0]


def test_statistics_are_those_of_the_books():
    known = (2.0, 5.0, 0.101939479), (12.0, 1.0, 0.0529293521), (40.0, 10.0, 2.28085774e-12)
    for t, df, p in known:
        assert two_sided(t, df) == pytest.approx(p, rel=1e-7)
    assert two_sided(1.959964, float("inf")) == pytest.approx(0.05, rel=1e-5)
    assert adjusted(np.array([0.01, 0.04, 0.03, 0.5])).tolist() == pytest.approx(
        [0.04, 0.04 * 4 / 3, 0.04 * 4 / 3, 0.5]
    )
    assert combined(np.array([0.02, 0.04, 0.9])) == pytest.approx(0.06)
    values = [Estimate(v, 0.1) for v in (1.0, 1.1, 0.9, 3.0, 3.1)]
    alike = [(1.0, 1.0, float("inf"))]
    step = drift("one", "p", range(5), values, alike)
    assert step.since == 3 and step.before == pytest.approx(1.0) and step.p < 1e-9
    calm = drift("two", "p", range(5), [Estimate(1.0, 0.1)] * 5, alike)
    assert calm.slope == pytest.approx(0.0) and calm.p == 1.0
    assert [one.is_change for one in changed([step, calm], 0.05)] == [True, False]
    single = drift("three", "p", [0], values[:1], alike)
    assert single.since is None and single.p == 1.0


def test_a_fleet_on_ray_has_the_same_bytes(example, tmp_path):
    pytest.importorskip("ray")
    from denavit.studies.on_ray import on_ray

    logs = copied(example, tmp_path / "logs", ["arm-00", "arm-01"], nights=1)
    judge(logs, example / "arm.json", tmp_path / "ray", runner=on_ray(), options=NONE)
    judge(logs, example / "arm.json", tmp_path / "here", options=NONE)
    assert contents(tmp_path / "ray") == contents(tmp_path / "here")


def test_the_command_makes_and_judges_an_example(tmp_path, capsys):
    arguments = ["--robots", "2", "--nights", "2", "--changed", "0", "--diagnose", "none"]
    assert main(["fleet-example", str(tmp_path / "a"), *arguments, "--run"]) == 0
    said = capsys.readouterr().out
    assert "2 robots, 2 nights" in said and "index.html" in said
    assert (tmp_path / "a" / "found" / "index.html").is_file()
    assert main(["fleet-example", str(tmp_path / "b"), *arguments]) == 0
    for one in (tmp_path / "a" / "logs").rglob("*.csv"):
        other = tmp_path / "b" / one.relative_to(tmp_path / "a")
        assert one.read_bytes() == other.read_bytes()
    assert main(["fleet-example", str(tmp_path / "c"), "--robots", "0"]) == 2


def test_an_example_is_not_mixed_with_another(tmp_path, capsys):
    for robots, code in ((11, 0), (2, 2)):
        arguments = [f"--robots={robots}", "--nights=1", "--changed=0"]
        assert main(["fleet-example", str(tmp_path), *arguments]) == code
    assert "robots of another fleet: arm-00" in capsys.readouterr().err
    assert len(list((tmp_path / "logs").iterdir())) == 11


def test_the_page_of_an_example_is_opened_in_the_browser(tmp_path):
    """As `BROWSER` names it: here a script that copies the page it is sent to."""
    copied_page, browser = tmp_path / "opened.html", tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\ncp "${{1#file://}}" "{copied_page}"\n')
    browser.chmod(0o755)
    command = [sys.executable, "-m", "denavit", "fleet-example", str(tmp_path / "out")]
    command += ["--robots=2", "--nights=2", "--changed=0", "--diagnose=none", "--run", "--open"]
    environment = {**os.environ, "BROWSER": str(browser)}
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
    page = (tmp_path / "out" / "found" / "index.html").read_bytes()
    assert copied_page.read_bytes() == page and b"arm-" in page
