"""Fleets: robots that stop logging are told, with the alarms that they had, and logs that could not
be read are read again.
"""

import json
import shutil

import pytest

from denavit.__main__ import main
from denavit.fleet import Options, judge, sources, write_example

pq = pytest.importorskip("pyarrow.parquet")

ALARMS = Options(diagnose="alarms")
NONE = Options(diagnose="none")
NIGHTS = [f"2026-01-0{night}" for night in (1, 2, 3, 4)]


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    """Twelve arms, one of which acquires an effect in the third of four nights."""
    folder = tmp_path_factory.mktemp("example")
    write_example(folder, robots=12, nights=4, changed=1, seed=5)
    return folder


@pytest.fixture(scope="module")
def changed(example):
    (robot,) = json.loads((example / "answer.json").read_text())
    return robot


def table(out):
    found = pq.read_table(out / "fleet.parquet").to_pylist()
    return {(row["robot"], row["night"]): row for row in found}


def test_a_robot_that_stops_logging_keeps_its_alarm(example, changed, tmp_path, capsys):
    logs, out = tmp_path / "logs", tmp_path / "out"
    shutil.copytree(example / "logs", logs)
    quiet = next(f"arm-{at:02}" for at in range(12) if f"arm-{at:02}" != changed)
    shutil.rmtree(logs / changed / NIGHTS[3])
    for night in NIGHTS[2:]:
        shutil.rmtree(logs / quiet / night)
    model = str(example / "arm.json")
    command = ["fleet", str(logs), "--model-by", model, "-o", str(out), "--diagnose", "alarms"]
    assert main(command) == 1
    said = capsys.readouterr().out
    assert "2026-01-04: 0 alarms, 0 without an answer, 2 without a log, 1 of them with" in said
    assert f"{changed}: no log of 2026-01-04; the last one is of 2026-01-03" in said
    assert f"{quiet}: no log of 2026-01-04; the last one is of 2026-01-02" in said
    hidden = json.loads((example / "answer.json").read_text())[changed]
    named = f"{changed}: {hidden['effect']} at {hidden['at']}, alarm of 2026-01-03, no answer since"
    assert named in said
    rows = table(out)
    assert len(rows) == 12 * 4
    gone = {key for key, row in rows.items() if row["verdict"] == "no_log"}
    assert gone == {(changed, NIGHTS[3]), (quiet, NIGHTS[2]), (quiet, NIGHTS[3])}
    assert all(rows[key]["reason"] and not rows[key]["is_alarm"] for key in gone)
    page = (out / "index.html").read_text()
    assert "2 have no log; 1 has an alarm from before, and no answer since" in page
    first = page.split("<section>")[1]
    assert changed in first and "alarm of 2026-01-03, no log since" in first
    assert hidden["effect"].replace("_", " ") in first
    second = page.split("<section>")[2]
    assert quiet in second and "no log of 2026-01-04" in second


def test_a_corrupt_log_does_not_hide_an_alarm(example, changed, tmp_path, capsys):
    logs, out = tmp_path / "logs", tmp_path / "out"
    shutil.copytree(example / "logs", logs)
    (logs / changed / NIGHTS[3] / "train.csv").write_bytes(b"\x00\xff" * 500)
    model = str(example / "arm.json")
    command = ["fleet", str(logs), "--model-by", model, "-o", str(out), "--diagnose", "alarms"]
    assert main(command) == 1
    assert "alarm of 2026-01-03, no answer since" in capsys.readouterr().out
    assert "alarm of 2026-01-03, no answer since" in (out / "index.html").read_text()


class Broken:
    """A file system that fails for some files."""

    def __init__(self, system, names):
        self.system, self.names = system, names

    def __getattr__(self, name):
        return getattr(self.system, name)

    def open_input_stream(self, path, **more):
        if any(path.endswith(name) for name in self.names):
            raise OSError(5, "Network is unreachable")
        return self.system.open_input_stream(path, **more)


def test_a_store_that_fails_is_asked_again(example, tmp_path, monkeypatch, capsys):
    """A robot whose log cannot be read in one run has the row of an undisturbed fleet later."""
    logs = tmp_path / "logs"
    for robot in ("arm-00", "arm-01"):
        for night in NIGHTS[:3]:
            shutil.copytree(example / "logs" / robot / night, logs / robot / night)
    (logs / "arm-01" / NIGHTS[2] / "train.csv").write_text("t,q_shoulder\n0,0\n")
    model, out = example / "arm.json", tmp_path / "out"
    judge(logs, model, tmp_path / "undisturbed", options=NONE)
    whole = sources._opened

    def failing(root):
        system, base = whole(root)
        return Broken(system, [f"arm-00/{NIGHTS[1]}/validate.csv"]), base

    monkeypatch.setattr(sources, "_opened", failing)
    judge(logs, model, out, options=NONE)
    row = table(out)["arm-00", NIGHTS[1]]
    assert row["verdict"] == "no_answer" and "Network is unreachable" in row["reason"]
    assert "the next run reads it again" in row["reason"] and str(tmp_path) not in row["reason"]
    monkeypatch.setattr(sources, "_opened", whole)
    computed = []

    def counted(study, indices):
        for index in indices:
            computed.append((study.name, index))
            yield study.row(index)

    judge(logs, model, out, options=NONE, runner=counted)
    assert table(out) == table(tmp_path / "undisturbed")
    # the row that was not read, not the other one of its night; and the next night, whose model
    # comes from it
    assert computed == [("identified", 0), ("identified", 0), ("identified", 1)]
    assert table(out)["arm-01", NIGHTS[2]]["verdict"] == "no_answer"


def test_logs_without_permission_are_read_when_they_may_be(example, tmp_path, monkeypatch):
    """The same of the file system of this machine, through which denavit reads tables itself."""
    source = example / "logs" / "arm-00" / NIGHTS[0]
    shutil.copytree(source, tmp_path / "logs" / "arm-00" / NIGHTS[0])
    log = tmp_path / "logs" / "arm-00" / NIGHTS[0] / "train.csv"
    log.rename(log.with_suffix(".away"))
    log.mkdir()  # its name cannot be read as a file
    manifest = tmp_path / "logs" / "manifest.csv"
    place = f"arm-00/{NIGHTS[0]}"
    manifest.write_text(
        f"robot,night,train,validate\narm-00,1,{place}/train.csv,{place}/validate.csv\n"
    )
    judge(manifest, example / "arm.json", tmp_path / "out", options=NONE)
    assert table(tmp_path / "out")["arm-00", "1"]["verdict"] == "no_answer"
    log.rmdir()
    log.with_suffix(".away").rename(log)
    judge(manifest, example / "arm.json", tmp_path / "out", options=NONE)
    assert table(tmp_path / "out")["arm-00", "1"]["reason"] is None


def test_a_shipped_model_is_named(example, tmp_path, capsys):
    from denavit.fleet.models import read_models

    found = read_models("puma560", ["a", "b"])
    assert json.loads(found["a"])["name"] == "puma560" and found["a"] == found["b"]
    command = ["fleet", str(example / "logs"), "--model-by", "puma56", "-o", str(tmp_path / "out")]
    assert main(command) == 2
    assert "a shipped model's name" in capsys.readouterr().err
