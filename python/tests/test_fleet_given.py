"""What a fleet is given: copies of logs, broken uploads, maps and folders that do not fit."""

import json
import shutil

import pytest

from denavit.__main__ import main
from denavit.fleet import FleetError, Options, judge, write_example
from denavit.fleet.engine import run

pq = pytest.importorskip("pyarrow.parquet")

NONE = Options(diagnose="none")
NIGHTS = [f"2026-01-0{night}" for night in (1, 2, 3)]


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    folder = tmp_path_factory.mktemp("example")
    write_example(folder, robots=3, nights=3, changed=0, seed=5)
    return folder


@pytest.fixture
def logs(example, tmp_path):
    shutil.copytree(example / "logs", tmp_path / "logs")
    return tmp_path / "logs"


@pytest.fixture(scope="module")
def undisturbed(example):
    judge(example / "logs", example / "arm.json", example / "found", options=NONE)
    return table(example / "found")


def table(out):
    found = pq.read_table(out / "fleet.parquet").to_pylist()
    return {(row["robot"], row["night"]): row for row in found}


def values(row):
    """What does not depend on other robots."""
    return {key: row[key] for key in row.keys() - {"p", "false_discovery_rate"}}


def copy(logs, source, target):
    """A night of a robot as that of another one."""
    shutil.rmtree(logs / target)
    shutil.copytree(logs / source, logs / target)


def test_a_copy_of_an_earlier_night_is_no_other_night(example, logs, tmp_path, capsys):
    copy(logs, f"arm-0/{NIGHTS[0]}", f"arm-0/{NIGHTS[1]}")
    copy(logs, f"arm-1/{NIGHTS[0]}", f"arm-2/{NIGHTS[2]}")
    command = ["fleet", str(logs), "--model-by", str(example / "arm.json"), "--diagnose", "none"]
    assert main([*command, "-o", str(tmp_path / "out")]) == 1
    assert f"arm-2: stale: its logs are those of arm-1 in {NIGHTS[0]}" in capsys.readouterr().out
    rows = table(tmp_path / "out")
    stale = {key: row["reason"] for key, row in rows.items() if row["reason"]}
    assert stale.keys() == {("arm-0", NIGHTS[1]), ("arm-2", NIGHTS[2])}
    assert f"its logs are those of {NIGHTS[0]}, byte by byte" in stale["arm-0", NIGHTS[1]]
    assert rows["arm-0", NIGHTS[1]]["verdict"] == "no_answer"
    fleet = run(str(logs), example / "arm.json", tmp_path / "out", options=NONE)
    nights = {robot: len(history.nights) for robot, history in fleet.histories.items()}
    assert nights == {"arm-0": 2, "arm-1": 3, "arm-2": 2}


def test_of_two_robots_with_one_log_neither_has_an_answer(example, logs, tmp_path):
    copy(logs, f"arm-0/{NIGHTS[0]}", f"arm-1/{NIGHTS[0]}")
    judge(logs, example / "arm.json", tmp_path / "out", options=NONE)
    rows = table(tmp_path / "out")
    assert f"those of arm-1 in {NIGHTS[0]}" in rows["arm-0", NIGHTS[0]]["reason"]
    assert f"those of arm-0 in {NIGHTS[0]}" in rows["arm-1", NIGHTS[0]]["reason"]
    assert {row["night"] for row in rows.values() if row["reason"]} == {NIGHTS[0]}


@pytest.mark.parametrize("kind", ["missing", "folder", "link", "two"])
def test_an_upload_that_broke_off_is_a_row(example, logs, undisturbed, kind, tmp_path):
    folder = logs / "arm-0" / NIGHTS[2]
    train = folder / "train.csv"
    if kind == "two":
        (folder / "validate.csv").rename(folder / "other.csv")
    else:
        train.unlink()
    if kind == "folder":
        train.mkdir()
    elif kind == "link":
        train.symlink_to("nothing.csv")
    judge(logs, example / "arm.json", tmp_path / "out", options=NONE)
    rows = table(tmp_path / "out")
    row = rows.pop(("arm-0", NIGHTS[2]))
    assert row["verdict"] == "no_answer" and f"arm-0/{NIGHTS[2]}" in row["reason"]
    if kind == "folder":
        assert "train.csv: is no file" in row["reason"]
    else:
        said = "validate" if kind == "two" else "train"
        assert f"no log is called {said}.." in row["reason"]
    for key, one in rows.items():
        assert values(one) == values(undisturbed[key])


def test_an_empty_cell_of_a_manifest_is_a_row(example, logs, tmp_path):
    path = logs / "manifest.csv"
    place = f"arm-0/{NIGHTS[0]}"
    path.write_text(
        f"robot,night,train,validate\na,1,{place}/train.csv,{place}/validate.csv\nb,1,,\n"
    )
    judge(path, example / "arm.json", tmp_path / "out", options=NONE)
    rows = table(tmp_path / "out")
    assert rows["a", "1"]["reason"] is None
    assert "row 2 of the manifest names no log in `train`" in rows["b", "1"]["reason"]


def test_logs_that_are_all_of_another_form_are_refused(logs, example, tmp_path):
    for train in logs.rglob("train.csv"):
        train.unlink()
    with pytest.raises(FleetError, match="no log is called train"):
        judge(logs, example / "arm.json", tmp_path / "out", options=NONE)


def test_a_robot_begins_anew_as_often_as_it_is_said(example, undisturbed, tmp_path):
    model = example / "arm.json"
    assert not undisturbed["arm-0", NIGHTS[2]]["is_first"]
    command = ["fleet", str(example / "logs"), "--model-by", str(model), "--diagnose", "none"]
    command += [f"--restart=arm-0={night}" for night in NIGHTS[1:]]
    assert main([*command, "-o", str(tmp_path / "out")]) == 0
    assert all(table(tmp_path / "out")["arm-0", night]["is_first"] for night in NIGHTS)
    several = Options(diagnose="none", restart={"arm-0": NIGHTS[1:], "arm-1": NIGHTS[1]})
    judge(example / "logs", model, tmp_path / "two", options=several)
    rows = table(tmp_path / "two")
    first = {key for key, row in rows.items() if row["is_first"] and key[1] != NIGHTS[0]}
    assert first == {("arm-0", NIGHTS[1]), ("arm-0", NIGHTS[2]), ("arm-1", NIGHTS[1])}


def test_answers_do_not_stand_among_logs(example, logs, capsys):
    for out in (logs, logs / "found", logs / "arm-0" / "found"):
        command = ["fleet", str(logs), "--model-by", str(example / "arm.json"), "-o", str(out)]
        assert main(command) == 2
        said = capsys.readouterr().err
        assert "is in the folder of the logs" in said and "a folder beside it" in said
    assert not (logs / "found").exists()


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ([1], "is no map of columns, but a list"),
        (None, "null"),
        ({"t": 5}, "`t`: an entry is the name of a column"),
        ({"t": {"colum": "x"}}, "`t`: no entry has colum"),
        ({"t": {"scale": "2"}}, "`t`: `scale` is no finite number"),
        ({"t": {"scale": 0}}, "`t`: `scale` is 0"),
    ],
)
def test_what_is_no_map_of_columns_is_refused_at_the_start(example, given, says, tmp_path, capsys):
    path = tmp_path / "map.json"
    path.write_text(json.dumps(given))
    command = ["fleet", str(example / "logs"), "--model-by", str(example / "arm.json")]
    assert main([*command, "-o", str(tmp_path / "out"), "--columns", str(path)]) == 2
    said = capsys.readouterr().err
    assert says in said and "map.json" in said
    assert not (tmp_path / "out").exists()


def test_a_map_of_columns_counts(example, tmp_path):
    columns = {"tau_{joint}": {"column": "tau_{joint}", "scale": 1}, "t": "t", "qd_{joint}": None}
    options = Options(diagnose="none", columns=columns)
    judge(example / "logs", example / "arm.json", tmp_path / "out", options=options)
    assert all(row["reason"] is None for row in table(tmp_path / "out").values())
