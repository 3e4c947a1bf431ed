"""A log that is read piece by piece gives the numbers of one that is held as a whole."""

import dataclasses

import numpy as np
import pytest

import denavit
from denavit._words import by_keyword
from denavit.errors import Error
from denavit.fleet import example
from denavit.long import _Table, identify_long
from denavit.studies.here import in_processes

pyarrow = pytest.importorskip("pyarrow")
parquet = pytest.importorskip("pyarrow.parquet")

STEP_S = 1e-3
HEAD = 150_000
FILTERED = {"filter_hz": 20, "skip_slow": "off"}


def motion(rows):
    """Sums of incommensurable sines, with torques of the equations of motion and noise."""
    t = STEP_S * np.arange(rows)
    q, qd, qdd = (np.zeros((rows, 2)) for _ in range(3))
    for joint, waves in enumerate([(0.31, 0.57, 0.83), (0.41, 0.67, 1.03)]):
        for hz, size in zip(waves, (0.6, 0.3, 0.2)):
            w = 2 * np.pi * hz
            q[:, joint] += size * np.sin(w * t + joint)
            qd[:, joint] += size * w * np.cos(w * t + joint)
            qdd[:, joint] -= size * w * w * np.sin(w * t + joint)
    return t, q, qd, qdd


@pytest.fixture(scope="module")
def columns():
    random = np.random.default_rng(5)
    t, q, qd, qdd = motion(600_000)
    tau = denavit.load(example.NOMINAL).inverse_dynamics(q, qd, qdd)
    found = {"t": t}
    for joint, name in enumerate(example.JOINTS):
        found[f"q_{name}"] = q[:, joint] + 1e-5 * random.standard_normal(len(t))
        found[f"tau_{name}"] = tau[:, joint] + 0.05 * random.standard_normal(len(t))
    return found


@pytest.fixture(scope="module")
def log(columns, tmp_path_factory):
    path = tmp_path_factory.mktemp("long") / "arm.parquet"
    parquet.write_table(pyarrow.table(columns), path, row_group_size=50_000)
    return path


@pytest.fixture(scope="module")
def whole(columns):
    return denavit.identify(example.NOMINAL, columns, **FILTERED)


@pytest.fixture(scope="module")
def pieces(log):
    return identify_long(example.NOMINAL, log, head=HEAD, **FILTERED)


def test_numbers_are_those_of_the_whole(whole, pieces):
    assert pieces.samples == whole.samples
    for one, other in zip(pieces.parameters, whole.parameters):
        assert one.name == other.name
        assert one.value == pytest.approx(other.value, rel=1e-10, abs=1e-12)
        assert one.std == pytest.approx(other.std, rel=0.3)
    for one, other in zip(pieces.residual.per_joint, whole.residual.per_joint):
        assert one.residual_rms == pytest.approx(other.residual_rms, rel=1e-10)
        assert one.torque_rms == pytest.approx(other.torque_rms, rel=1e-10)


def test_true_values_are_within_their_errors(pieces):
    shown = [one for one in pieces.parameters if one.identifiable]
    assert len(shown) == len(pieces.parameters)
    off = [abs(one.value - one.model_value) / one.std for one in shown]
    assert np.sqrt(np.mean(np.square(off))) < 2.0, off


def test_processes_give_the_same_bits(pieces, log, tmp_path):
    part = tmp_path / "rows.parquet"
    options = FILTERED | {"head": HEAD, "part": part}
    again = identify_long(example.NOMINAL, log, runner=in_processes(2), **options)
    assert again.json == pieces.json
    # and from the rows that were kept
    assert identify_long(example.NOMINAL, log, **options).json == pieces.json


def test_default_rows_agree_within_errors(columns, log):
    whole = denavit.identify(example.NOMINAL, columns, filter_hz=20)
    pieces = identify_long(example.NOMINAL, log, head=HEAD, filter_hz=20)
    for one, other in zip(pieces.parameters, whole.parameters):
        assert abs(one.value - other.value) < 0.5 * other.std, one.name


def test_times_of_a_clock_and_mapped_columns(columns, log, pieces, tmp_path):
    """Times as timestamps, positions in degrees under other names."""
    renamed = dict(columns)
    first = 1_790_000_000_000_000_000
    stamps = first + np.round(1e9 * renamed.pop("t")).astype(np.int64)
    table = {"stamp": pyarrow.array(stamps, pyarrow.timestamp("ns"))}
    mapping = {"t": {"column": "stamp"}}
    for name in example.JOINTS:
        table[f"angle {name}"] = np.degrees(renamed[f"q_{name}"])
        table[f"torque {name}"] = renamed[f"tau_{name}"]
        mapping[f"q_{name}"] = {"column": f"angle {name}", "scale": np.pi / 180}
        mapping[f"tau_{name}"] = {"column": f"torque {name}"}
    path = tmp_path / "other.parquet"
    parquet.write_table(pyarrow.table(table), path)
    options = FILTERED | {"head": HEAD, "time": "stamp", "columns": mapping}
    found = identify_long(example.NOMINAL, path, **options)
    for one, other in zip(found.parameters, pieces.parameters):
        assert one.value == pytest.approx(other.value, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("fault", ["gap", "jump", "rest", "nan"])
def test_faults_behind_the_head(columns, fault, tmp_path):
    changed = {name: values.copy() for name, values in columns.items()}
    place = 400_000
    if fault == "gap":
        changed["t"][place:] += 0.01
    elif fault == "jump":
        changed["q_elbow"][place] += 3.0
    elif fault == "nan":
        changed["tau_elbow"][place : place + 20_000] = np.nan
    else:
        # nothing moves for long: these stretches say nothing, and are no fault
        for name in example.JOINTS:
            changed[f"q_{name}"][200_000:] = changed[f"q_{name}"][200_000]
            changed[f"tau_{name}"][200_000:] = changed[f"tau_{name}"][200_000]
    path = tmp_path / "faulty.parquet"
    parquet.write_table(pyarrow.table(changed), path)
    if fault == "rest":
        found = identify_long(example.NOMINAL, path, head=HEAD, **FILTERED)
        assert found.samples < 600_000
        return
    with pytest.raises(Error) as error:
        identify_long(example.NOMINAL, path, head=HEAD, **FILTERED)
    expected = {"gap": "missing", "jump": "jumps", "nan": "tau_elbow"}[fault]
    assert expected in str(error.value), error.value


def test_what_is_no_long_log(columns, log, tmp_path):
    with pytest.raises(Error, match="no more than those of its head"):
        identify_long(example.NOMINAL, log, head=700_000)
    with pytest.raises(Error, match="least squares alone"):
        identify_long(example.NOMINAL, log, head=HEAD, method="huber")
    with pytest.raises(TypeError, match="no option average"):
        identify_long(example.NOMINAL, log, average=2.0)
    for head in (2.5, True, 10):
        with pytest.raises(denavit.ArgumentError, match="`head` is"):
            identify_long(example.NOMINAL, log, head=head)
    for part in (5, "", tmp_path):
        with pytest.raises(Error, match="`part`|no part of a study"):
            identify_long(example.NOMINAL, log, head=HEAD, part=part, **FILTERED)
    twice = pyarrow.table([columns["t"], columns["t"]], names=["t", "t"])
    parquet.write_table(twice, tmp_path / "twice.parquet")
    with pytest.raises(Error, match="two columns of one name"):
        identify_long(example.NOMINAL, tmp_path / "twice.parquet")
    text = tmp_path / "log.csv"
    text.write_text("t,q_elbow\n")
    with pytest.raises(Error, match="Parquet"):
        identify_long(example.NOMINAL, text)


def test_what_a_file_says_of_itself_counts(columns, tmp_path):
    """As in any log: of another model it is refused, and so is a side that there is not."""
    for key, value, says in (("model", "other", "other"), ("torque_side", "left", "left")):
        path = tmp_path / f"{key}.parquet"
        table = pyarrow.table(columns).replace_schema_metadata({key: value})
        parquet.write_table(table, path)
        with pytest.raises(Error, match=says):
            identify_long(example.NOMINAL, path, head=HEAD, **FILTERED)


def test_another_file_at_the_same_path_is_read_anew(columns, tmp_path):
    path = tmp_path / "log.parquet"
    found = []
    for factor in (1.0, 2.0):
        changed = {name: values * (factor if name.startswith("tau") else 1.0)
                   for name, values in columns.items()}  # fmt: skip
        parquet.write_table(pyarrow.table(changed), path)
        options = FILTERED | {"head": HEAD, "part": tmp_path / f"rows-{factor}.parquet"}
        found.append(identify_long(example.NOMINAL, path, **options).parameters)
    for one, twice in zip(*found):
        assert twice.value == pytest.approx(2.0 * one.value, rel=1e-6, abs=1e-9)


def test_what_is_wrong_behind_the_head_is_not_good(columns, tmp_path):
    """A sensor whose sign turns after a third of the log: the head explains itself."""
    changed = {name: values.copy() for name, values in columns.items()}
    changed["tau_shoulder"][200_000:] *= -1
    path = tmp_path / "turned.parquet"
    parquet.write_table(pyarrow.table(changed), path)
    found = identify_long(example.NOMINAL, path, head=HEAD, **FILTERED)
    assert not found.is_good
    assert any("shoulder is not explained" in remark for remark in found.remarks), found.remarks


def test_a_part_of_the_rest_does_not_judge(columns, log, tmp_path):
    """Of 50 s, by a file and in memory, found by processes that read the log elsewhere."""
    part = {name: values[400_000:450_000] for name, values in columns.items()}
    path = tmp_path / "part.parquet"
    parquet.write_table(pyarrow.table(part), path)
    csv = tmp_path / "part.csv"
    names = list(part)
    np.savetxt(csv, np.column_stack(list(part.values())), delimiter=",", header=",".join(names),
               comments="", fmt="%.12g")  # fmt: skip
    for judge, name in ((part, "validate"), (str(csv), "part.csv")):
        found = identify_long(
            example.NOMINAL, log, judge, head=HEAD, runner=in_processes(2), **FILTERED
        )
        assert not found.is_good
        told = [one for one in found.remarks if "arm.parquet, rows" in one]
        assert len(told) == 1 and name in told[0], found.remarks


def test_rows_of_other_judges_are_not_taken(columns, log, tmp_path):
    """A log for validation is replaced by another one, while rows are kept."""
    judge, part = tmp_path / "judge.csv", tmp_path / "rows.parquet"

    def judged(first):
        part_of = [values[first : first + 50_000] for values in columns.values()]
        np.savetxt(judge, np.column_stack(part_of), delimiter=",", header=",".join(columns),
                   comments="", fmt="%.12g")  # fmt: skip
        options = FILTERED | {"head": HEAD, "part": part}
        return identify_long(example.NOMINAL, log, str(judge), **options)

    assert not judged(400_000).is_good
    with pytest.raises(Error, match="study"):
        judged(200_000)


def test_pieces_of_another_log_of_equal_length_are_refused(columns, log, tmp_path):
    """As where a node has another file at the same path, and the pieces go together in numbers."""
    other = {name: values * (1.1 if name.startswith("tau") else 1.0)
             for name, values in columns.items()}  # fmt: skip
    path = tmp_path / "arm.parquet"
    parquet.write_table(pyarrow.table(other), path, row_group_size=50_000)

    def from_other(pieces):
        def mixed(study, indices):
            stamp = [path.stat().st_size, path.stat().st_mtime_ns]
            options = {**study.options, "log": str(path), "stamp": stamp}
            of_other = dataclasses.replace(study, options=options)
            return ((of_other if index in pieces else study).row(index) for index in indices)

        return mixed

    for pieces, said in (
        ({1}, "piece 1 was condensed from another log than the head"),
        ({2}, "piece 2 was condensed from another log than the piece before it"),
        ({0, 1, 2}, "piece 0 was condensed from another log than the head"),
    ):
        with pytest.raises(Error, match=said) as error:
            identify_long(example.NOMINAL, log, head=HEAD, runner=from_other(pieces), **FILTERED)
        assert "condense it again" in (error.value.hint or "")


def test_a_judge_may_be_parquet(columns, tmp_path):
    judge = {name: values[:20_000] for name, values in columns.items()}
    train = {name: values[100_000:150_000] for name, values in columns.items()}
    direct = denavit.identify(example.NOMINAL, train, judge, **FILTERED)
    parquet.write_table(pyarrow.table(judge), tmp_path / "judge.parquet")
    with pyarrow.ipc.new_file(tmp_path / "judge.arrow", pyarrow.table(judge).schema) as file:
        file.write_table(pyarrow.table(judge))
    for name in ("judge.parquet", "judge.arrow"):
        found = denavit.identify(example.NOMINAL, train, tmp_path / name, **FILTERED)
        assert found.parameters == direct.parameters and found.residual == direct.residual
    (tmp_path / "cut.parquet").write_bytes((tmp_path / "judge.parquet").read_bytes()[:5000])
    with pytest.raises(Error, match="cut.parquet: cannot be read"):
        denavit.identify(example.NOMINAL, train, tmp_path / "cut.parquet", **FILTERED)


def test_remarks_name_keywords():
    said = "lower (`conditions.filter`, `options.method=iv`, `options.seed=3`); `logs.accepts_cut`"
    expected = 'lower (`filter_hz`, `method="iv"`, `seed=3`); `accept_cut`'
    assert by_keyword(said) == expected
    assert by_keyword("`a.b` `options` options.x") == "`a.b` `options` options.x"


def test_half_floats_are_numbers_and_other_times_are_named(tmp_path):
    half = pyarrow.array(np.arange(2000.0).astype(np.float16))
    texts = pyarrow.array([str(at) for at in range(2000)])
    path = tmp_path / "half.parquet"
    parquet.write_table(pyarrow.table({"t": texts, "q_elbow": half}), path)
    assert _Table(path).read(1, 3)["q_elbow"].tolist() == [1.0, 2.0]
    with pytest.raises(Error, match="no column of numbers `t`: it is of type string"):
        identify_long(example.NOMINAL, path, head=1000)
