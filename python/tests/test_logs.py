"""Logs in memory answer as files do, bit by bit, and faults name the argument."""

import json

import numpy as np
import pytest

import denavit

STEP = 2 * np.pi / 4096


def encoded(columns, model):
    """A log whose positions have the steps of encoders."""
    for joint in model.joints:
        columns[f"q_{joint}"] = STEP * np.round(columns[f"q_{joint}"] / STEP)
    return columns


def written(path, columns):
    """The log as CSV, with the shortest digits that give every number back."""
    rows = np.column_stack(list(columns.values())).tolist()
    lines = [",".join(columns)] + [",".join(map(repr, row)) for row in rows]
    path.write_text("\n".join(lines) + "\n")
    return path


def same(found, other, names):
    """The answer, where files are called as the arguments."""
    text = json.dumps(other.json)
    for path, name in names.items():
        text = text.replace(str(path), name)
    return json.loads(text) == found.json


def test_identification_is_that_of_the_same_numbers_as_text(arm, tmp_path, log_of):
    logs = [encoded(log_of(arm, seed), arm) for seed in (1, 2)]
    files = [written(tmp_path / f"{seed}.csv", log) for seed, log in enumerate(logs)]
    found = denavit.identify(arm, [logs[0]], [logs[1]])
    other = denavit.identify(arm, files[0], files[1])
    assert same(found, other, {files[0]: "train[0]", files[1]: "validate[0]"})
    # the steps of the encoders are seen, and are those that were made
    steps = [remark for remark in found.remarks if "step" in remark and "train[0]" in remark]
    assert len(steps) == 1 and "1.534e-3" in steps[0] and f"{STEP:.3e}" == "1.534e-03"


def test_diagnosis_is_that_of_the_same_numbers_as_text(arm, tmp_path, log_of):
    whole = [log_of(arm, seed) for seed in (1, 2)]
    logs = [{name: values[::4] for name, values in log.items()} for log in whole]
    files = [written(tmp_path / f"{seed}.csv", log) for seed, log in enumerate(logs)]
    found = denavit.diagnose(arm, logs[0], logs[1], most=1)
    other = denavit.diagnose(arm, *files, most=1)
    assert same(found, other, {files[0]: "train", files[1]: "validate"})


def test_arrays_of_any_layout(arm, log_of):
    log = log_of(arm, 1)
    expected = denavit.identify(arm, log).json
    block = np.asfortranarray(np.column_stack(list(log.values())))
    strided = {name: block[:, at] for at, name in enumerate(log)}
    wide = np.ascontiguousarray(block)
    rows = {name: wide[:, at] for at, name in enumerate(log)}
    lists = {name: values.tolist() for name, values in log.items()}
    for other in (strided, rows, lists):
        assert denavit.identify(arm, other).json == expected


def test_frames_and_files_beside_each_other(arm, tmp_path, log_of):
    pandas = pytest.importorskip("pandas")
    log, other = log_of(arm, 1), log_of(arm, 2)
    frame = pandas.DataFrame(log)
    expected = denavit.identify(arm, log).json
    assert denavit.identify(arm, frame).json == expected
    # as to_pandas of a run has it
    assert denavit.identify(arm, frame.set_index("t")).json == expected
    path = written(tmp_path / "other.csv", other)
    found = denavit.identify(arm, [path, log])
    assert same(denavit.identify(arm, [other, log]), found, {path: "train[0]"})


def test_columns_are_mapped(arm, log_of):
    log = log_of(arm, 1)
    renamed = {name.replace("q_", "angle_"): values for name, values in log.items()}
    renamed["ms"] = 1000 * renamed.pop("t")
    mapping = {"t": {"column": "ms", "scale": 1e-3}, "q_{joint}": "angle_{joint}"}
    found = denavit.identify(arm, renamed, columns=mapping)
    expected = denavit.identify(arm, log)
    values = [[one.value for one in each.parameters] for each in (found, expected)]
    np.testing.assert_allclose(*values, rtol=1e-6)


def test_faults_name_argument_and_column(arm, log_of):
    log = log_of(arm, 1)
    joint = arm.joints[1]
    q, good = f"q_{joint}", log_of(arm, 2)

    def fault(kind, *train, **more):
        with pytest.raises(kind) as caught:
            denavit.identify(arm, list(train), **more)
        return caught.value

    error = fault(denavit.IdentifyError, good, {name: log[name] for name in log if name != "t"})
    assert error.file == "train[1]" and "`t`" in error.cause
    error = fault(denavit.IdentifyError, log | {q: log[q][:-1]})
    assert error.file == "train[0]" and f"`{q}`" in error.cause and "9999" in error.cause
    hole = log[q].copy()
    hole[100:400] = np.nan
    error = fault(denavit.IdentifyError, log | {q: hole})
    assert error.file == "train[0]" and "row 101" in error.cause and f"`{q}`" in error.cause
    infinite = log[q].copy()
    infinite[7] = np.inf
    error = fault(denavit.IdentifyError, log | {q: infinite})
    assert error.file == "train[0]" and "row 8" in error.cause and f"`{q}`" in error.cause
    error = fault(denavit.IdentifyError, good, validate={})
    assert error.file == "validate"
    error = fault(denavit.IdentifyError, good, good)
    assert "train[0]" in str(error) and "train[1]" in str(error)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (np.zeros((4, 2)), "shape (4, 2)"),
        (["a"] * 4, "instead of real numbers"),
        ([1j] * 4, "instead of real numbers"),
        ([[1], [1, 2], [3], [4]], "no column of numbers"),
        (np.array(["2020-01-01"] * 4, dtype="datetime64[s]"), "instead of real numbers"),
        (0.5, "shape ()"),
    ],
)
def test_columns_that_are_none(arm, values, said, log_of):
    log = log_of(arm, 1) | {"q_link2": values}
    with pytest.raises(denavit.ArgumentError) as caught:
        denavit.identify(arm, [log])
    assert 'train[0]["q_link2"]' in caught.value.cause and said in caught.value.cause


def test_what_is_no_log(arm):
    for train in ([3], 3, None, [""]):
        with pytest.raises(denavit.ArgumentError, match="train"):
            denavit.identify(arm, train)
    with pytest.raises(denavit.ArgumentError, match="train"):
        denavit.identify(arm, [])


def test_two_columns_of_one_name_are_refused(tmp_path):
    """Nothing says which of them is meant; with spaces around it a name is the same."""
    pa = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    values = pa.array(np.arange(10.0))
    for names in (["t", "q_shoulder", "q_shoulder"], ["t", "q_shoulder", " q_shoulder"]):
        table = pa.table([values] * 3, names=names)
        parquet.write_table(table, tmp_path / "log.parquet")
        with pa.ipc.new_file(tmp_path / "log.arrow", table.schema) as file:
            file.write_table(table)
        for kind in ("parquet", "arrow"):
            with pytest.raises(denavit.Error, match="two columns of one name, `q_shoulder`"):
                denavit.identify("planar_2r", tmp_path / f"log.{kind}")


def test_columns_that_are_no_numbers_are_named_with_their_type(tmp_path):
    pa = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    texts = pa.array([f"{at}" for at in range(10)])
    table = pa.table({"t": texts, "q_joint": pa.array(np.arange(10.0))})
    parquet.write_table(table, tmp_path / "log.parquet")
    with pytest.raises(denavit.Error, match="`t` of numbers: `t` is of type string"):
        denavit.identify("planar_2r", tmp_path / "log.parquet")


def test_every_type_of_numbers_is_read():
    pa = pytest.importorskip("pyarrow")
    from denavit._arrow import columns

    whole = pa.array([10, None, 30], pa.int64())
    table = pa.table({
        "decimal": whole.cast(pa.decimal128(25, 2)),
        "dictionary": whole.cast("double").dictionary_encode(),
        "timestamp": whole.cast(pa.timestamp("s")),
        "duration": whole.cast(pa.duration("s")),
        "half": pa.array(np.array([10, np.nan, 30], np.float16)),
        "text": pa.array(["a", "b", "c"]),
    })  # fmt: skip
    found = columns(table)
    assert found.keys() == set(table.column_names) - {"text"}
    for name, values in found.items():
        first = 0 if name == "timestamp" else 10
        assert values[[0, 2]].tolist() == [first, first + 20] and np.isnan(values[1]), name
