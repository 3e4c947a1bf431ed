"""Logs of fleets: what they say of themselves counts in every form, and names stay as they are."""

import io

import numpy as np
import pytest

from denavit.fleet import FleetError, Options, judge, write_example
from denavit.fleet.sources import read_fleet

pa = pytest.importorskip("pyarrow")
pq = pytest.importorskip("pyarrow.parquet")
csv = pytest.importorskip("pyarrow.csv")

NIGHT = "2026-01-01"


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    folder = tmp_path_factory.mktemp("example")
    write_example(folder, robots=1, nights=1, changed=0, seed=4)
    return folder


@pytest.fixture(scope="module")
def table(example):
    """The log of a night, without what it says of itself."""
    (robot,) = (example / "logs").iterdir()
    text = (robot / NIGHT / "train.csv").read_text().splitlines()
    plain = "\n".join(line for line in text if not line.startswith("#"))
    return csv.read_csv(io.BytesIO(plain.encode()))


def outcome(example, folder, out):
    judge(folder, example / "arm.json", out, options=Options(diagnose="none"))
    (row,) = pq.read_table(out / "fleet.parquet").to_pylist()
    return row


def logged(folder, table, kind, said):
    path = folder / "arm" / f"{NIGHT}.{kind}"
    path.parent.mkdir(parents=True)
    if kind == "parquet":
        pq.write_table(table.replace_schema_metadata(said), path)
    else:
        rows = io.BytesIO()
        csv.write_csv(table, rows)
        head = "".join(f"# {key}: {value}\n" for key, value in said.items())
        path.write_bytes(head.encode() + rows.getvalue())
    return folder


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_what_a_log_says_of_itself_counts(example, table, kind, tmp_path):
    arm = outcome(example, logged(tmp_path / "arm", table, kind, {}), tmp_path / "a")
    assert arm["reason"] is None and arm["is_trusted"]
    other = logged(tmp_path / "other", table, kind, {"model": "puma560"})
    reason = outcome(example, other, tmp_path / "b")["reason"]
    assert "puma560" in reason and f"{NIGHT}.{kind}" in reason, reason


def test_times_of_a_clock_are_times(example, table, tmp_path):
    stamps = 1_790_000_000_000_000_000 + np.round(1e9 * table["t"].to_numpy()).astype(np.int64)
    place = table.column_names.index("t")
    timed = table.set_column(place, "t", pa.array(stamps, pa.timestamp("ns")))
    row = outcome(example, logged(tmp_path / "logs", timed, "parquet", {}), tmp_path / "out")
    assert row["reason"] is None and row["is_trusted"]


def test_names_of_a_manifest_are_texts(tmp_path):
    path = tmp_path / "manifest.csv"
    path.write_text("robot,night,train,validate\n007,0001,a.csv,\n7,1,b.csv,c.csv\n")
    _, found = read_fleet(str(path))
    assert [(one.robot, one.night) for one in found] == [("007", "0001"), ("7", "1")]
    assert [len(one.validate) for one in found] == [0, 1]


def test_of_several_logs_one_has_to_judge(example, table, tmp_path):
    for name in "ab":
        csv.write_csv(table, tmp_path / f"{name}.csv")
    path = tmp_path / "manifest.csv"
    path.write_text("robot,night,train\narm,1,a.csv;b.csv\n")
    reason = outcome(example, path, tmp_path / "out")["reason"]
    assert "no log judges" in reason, reason


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_two_columns_of_one_name_are_refused(example, table, kind, tmp_path):
    names = [name if name != "tau_elbow" else "q_elbow" for name in table.column_names]
    twice = logged(tmp_path / "logs", table.rename_columns(names), kind, {})
    reason = outcome(example, twice, tmp_path / "out")["reason"]
    assert "two columns of one name, `q_elbow`" in reason and f"{NIGHT}.{kind}" in reason


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_a_manifest_with_two_columns_of_one_name_is_refused(kind, tmp_path):
    path = tmp_path / f"manifest.{kind}"
    twice = pa.table([["arm"], ["1"], ["a.csv"], ["b.csv"]], ["robot", "night", "train", "train"])
    csv.write_csv(twice, path) if kind == "csv" else pq.write_table(twice, path)
    with pytest.raises(FleetError, match="two columns of one name, `train`"):
        read_fleet(str(path))
