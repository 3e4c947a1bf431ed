"""Studies: the same rows however they are run, and none lost where a run is broken off."""

import importlib
import json
import math
import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from denavit import studies, walk
from denavit.__main__ import main
from denavit.errors import ArgumentError, Error, Fault
from denavit.studies.cases import plain
from denavit.studies.content import digest_of_path
from denavit.studies.here import in_process, in_processes
from denavit.studies.parts import Part, journal, noted

pytest.importorskip("pyarrow")

OWN = """
import time
import denavit
from denavit import studies

@studies.rows(square=int, angle=float, parts=list[float], word=str, whole=bool)
def squares(case):
    time.sleep(case.options.get("wait_s", 0.0))
    if case.index == 5:
        denavit.load("no such model")
    drawn = case.random().uniform(-1.0, 1.0, 2)
    return {"square": case.index**2, "angle": drawn[0], "parts": drawn, "word": "so",
            "whole": drawn[0] > 0}
"""


@pytest.fixture
def study_file(tmp_path, monkeypatch):
    """A study of ten rows, of a function beside it."""
    name = f"own_study_{os.getpid()}"
    (tmp_path / f"{name}.py").write_text(OWN)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    content = {"format": "denavit-study/1", "name": "squares", "count": 10, "seed": 4}
    content |= {"function": f"{name}:squares", "options": {}}
    file = tmp_path / "squares.json"
    file.write_text(json.dumps(content))
    return file


def changed(study_file, **more):
    content = json.loads(study_file.read_text()) | more
    study_file.write_text(json.dumps(content))
    return studies.read_study(study_file)


def test_rows_are_those_of_their_indices(study_file):
    rows = studies.computed(studies.read_study(study_file))
    assert [row["square"] for row in rows if row["failure"] is None] == [
        0, 1, 4, 9, 16, 36, 49, 64, 81,
    ]  # fmt: skip
    assert "no such model" in rows[5]["failure"] and rows[5]["angle"] is None
    assert len({row["angle"] for row in rows}) == 10
    # of any order and number, and not of another seed
    study = studies.read_study(study_file)
    assert studies.computed(study, [7, 2]) == [rows[7], rows[2]]
    other = studies.computed(changed(study_file, seed=5))
    assert all(one["angle"] != two["angle"] for one, two in zip(rows, other) if one["angle"])


def test_parts_of_any_size_merge_to_the_same_bytes(study_file, tmp_path, capsys):
    study = studies.read_study(study_file)
    studies.run(study, tmp_path / "whole.parquet")
    place = str(study_file)
    for part in range(3):
        out = str(tmp_path / f"part-{part}.parquet")
        assert main(["study", "run", place, "--part", f"{part}/3", "-o", out]) == 0
    parts = [str(tmp_path / f"part-{part}.parquet") for part in (2, 0, 1)]
    assert main(["study", "missing", place, parts[0], parts[1]]) == 1
    assert "3:6" in capsys.readouterr().out
    assert main(["study", "merge", parts[1], "-o", str(tmp_path / "first.parquet")]) == 0
    assert "no part has the rows 3 to 9 of the study's 10" in capsys.readouterr().err
    assert main(["study", "merge", *parts, "-o", str(tmp_path / "merged.parquet")]) == 0
    told = capsys.readouterr().err
    assert "no part has" not in told and "without an answer" in told
    studies.run(study, tmp_path / "two.parquet", runner=in_processes(2))
    contents = {(tmp_path / f"{name}.parquet").read_bytes() for name in ("whole", "merged", "two")}
    assert len(contents) == 1
    table = studies.read_part(tmp_path / "merged.parquet")
    assert table.column("index").to_pylist() == list(range(10))
    assert table.to_pylist() == studies.computed(study)


def test_a_killed_run_repeats_only_the_row_it_was_at(study_file, tmp_path):
    study = changed(study_file, options={"wait_s": 0.2})
    out = tmp_path / "rows.parquet"
    command = [sys.executable, "-m", "denavit", "study", "run", str(study_file), "-o", str(out)]
    process = subprocess.Popen(command)
    part = Part(study, 0, 10, out)
    until = time.monotonic() + 60
    while not (part.journal.exists() and part.journal.read_text().count("\n") > 3):
        assert time.monotonic() < until and process.poll() is None
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert not out.exists()
    done = part.journal.read_text().count("\n") - 1
    assert studies.run(study, out) == 10 - done < 8
    assert studies.read_part(out).to_pylist() == studies.computed(study)
    assert not part.journal.exists() and studies.run(study, out) == 0


def test_a_cut_line_of_a_journal_is_computed_again(study_file, tmp_path):
    study = studies.read_study(study_file)
    part = Part(study, 0, 10, tmp_path / "rows.parquet")
    rows = studies.computed(study)
    with journal(part) as (done, file):
        assert done == {}
        for row in rows[:4]:
            noted(file, row)
        with pytest.raises(studies.StudyError, match="another process"), journal(part):
            pass
    text = part.journal.read_text()
    part.journal.write_text(text[:-7])
    assert studies.run(study, part.path) == 7
    assert studies.read_part(part.path).to_pylist() == rows


def test_what_does_not_fit_is_refused(study_file, tmp_path, capsys):
    study = studies.read_study(study_file)
    out = tmp_path / "rows.parquet"
    studies.run(study, out, range(0, 4))
    with pytest.raises(studies.StudyError, match="another study"):
        studies.run(changed(study_file, seed=9), out, range(0, 4))
    other = tmp_path / "other.parquet"
    studies.run(studies.read_study(study_file), other, range(4, 10))
    with pytest.raises(studies.StudyError, match="another study"):
        studies.merge([out, other], tmp_path / "merged.parquet")
    with pytest.raises(studies.StudyError, match="no part of a study"):
        studies.read_part(study_file)
    with pytest.raises(studies.StudyError, match="no part of the study"):
        studies.missing([out], studies.read_study(study_file))
    with pytest.raises(studies.StudyError, match="one of the parts"):
        studies.merge([other], other)
    part = Part(studies.read_study(study_file), 0, 10, tmp_path / "new.parquet")
    head = json.dumps({"study": part.study.key, "start": 0, "stop": 10})
    for line in ("[1]", '{"index": 99}', "{no", '{"index": 0}'):
        part.journal.write_text(f"{head}\n{line}\n")
        with pytest.raises(studies.StudyError, match="rows"):
            studies.run(part.study, part.path)
    content = json.loads(study_file.read_text())
    study_file.write_text(json.dumps(content | {"count": -1, "sed": 2, "function": "os:nothing"}))
    assert main(["study", "run", str(study_file), "-o", str(out)]) == 2
    said = capsys.readouterr().err
    assert "`sed`" in said and "below 0" in said
    study_file.write_text(json.dumps(content | {"function": "os:getcwd"}))
    assert main(["study", "run", str(study_file), "-o", str(out)]) == 2
    assert "says no columns" in capsys.readouterr().err
    for kind, value in ((int, 2.9), (bool, "False"), (str, 3), (int, 1 << 70), (str, "\ud800")):
        with pytest.raises((TypeError, OverflowError, UnicodeEncodeError)):
            plain(kind, value)
    with pytest.raises(TypeError, match="type that no row has"):
        studies.rows(value=complex)


def test_intervals_of_an_identification_hold_as_often_as_they_say(tmp_path):
    """The count of intervals that hold is binomial, whatever the estimator."""

    def sines(first, second):
        def reference(amplitude, frequency):
            terms = {"sines": [amplitude, 0.2], "cosines": [0.1, 0.2]}
            return {"fourier": {"frequency_rad_s": frequency} | terms}

        joints = {
            "link1": {"kp": 300, "kd": 30, "reference": reference(first, 2)},
            "link2": {"kp": 300, "kd": 30, "reference": reference(second, 3)},
        }
        scenario = {"format": "denavit-scenario/1", "model": "planar_2r", "duration_s": 8}
        return json.dumps(scenario | {"control": {"joints": joints}, "log_period_s": 0.004})

    inputs = {"train": sines(0.4, 0.5).encode(), "validate": sines(0.3, -0.6).encode()}
    options = {"tau_std": 0.05, "q_std": 0.0}
    study = studies.Study("coverage", studies.ready.coverage, 20, inputs=inputs, options=options)
    rows = studies.computed(study)
    told = sum(row["identified"] for row in rows)
    inside = sum(row["inside"] for row in rows)
    assert all(row["failure"] is None for row in rows) and told >= 60
    deviation = math.sqrt(0.95 * 0.05 / told)
    # parameters of a row are correlated: twice the deviation of independent ones, three of these
    assert abs(inside / told - 0.95) < 6 * deviation, (inside, told)


def test_an_effect_that_is_hidden_in_an_arm_is_found():
    study = studies.Study("battery", studies.ready.battery, 100, seed=1)
    (row,) = studies.computed(study, [0])
    assert row["is_right"] and (row["hidden"], row["at"]) == ("torque_offset", "elbow")
    assert row["mismatch_after"] < 0.3 * row["mismatch"]


def test_starts_near_the_cycle_of_a_gait_walk_on():
    scenario = (Path(__file__).parents[2] / "models/scenarios/compass_gait.json").read_bytes()
    options = {"noise_rad_s": 1e-3, "steps": 3}
    study = studies.Study(
        "basin", studies.ready.basin, 2, inputs={"scenario": scenario}, options=options
    )
    assert [row["walks"] for row in studies.computed(study)] == [True, True]


def test_a_study_of_ray_has_the_same_rows(study_file, tmp_path):
    pytest.importorskip("ray")
    from denavit.studies.on_ray import on_ray

    study = studies.read_study(study_file)
    studies.run(study, tmp_path / "ray.parquet", runner=on_ray())
    studies.run(study, tmp_path / "here.parquet")
    assert Path(tmp_path / "ray.parquet").read_bytes() == (tmp_path / "here.parquet").read_bytes()


def test_a_push_map_is_a_study_of_its_times():
    name = "planar_biped_limit_cycle_gait"
    scenario = (Path(__file__).parents[2] / f"models/scenarios/{name}.json").read_bytes()
    options = {"times": 2, "most_ns": 20.0, "resolution_ns": 2.0, "after_s": 1.0}
    whole = walk.push(json.loads(scenario), **options)
    inputs = {"scenario": scenario}
    study = studies.Study("push", studies.ready.push, 2, inputs=inputs, options=options)
    rows = studies.computed(study)
    assert [row["failure"] for row in rows] == [None, None]
    for row in rows:
        own = [one for one in whole.pushes if one.at_s == row["at_s"]]
        assert [one.direction for one in own] == row["directions"]
        least = {one.direction: one.least_impulse_ns for one in own if one.least_impulse_ns}
        assert dict(zip(row["felled"], row["least_ns"])) == least


def test_rows_without_an_answer_are_told(study_file, tmp_path, capsys):
    out = tmp_path / "p.parquet"
    assert main(["study", "run", str(study_file), "-o", str(out)]) == 0
    assert "1 without an answer; the first, of index 5: no such model" in capsys.readouterr().err
    # all of them: nothing was computed
    assert main(["study", "run", str(study_file), "--range", "5:6", "-o", str(tmp_path / "q")]) == 1



UNREAD = """
from pathlib import Path
from denavit import studies
from denavit.errors import Fault

@studies.rows(value=int)
def read(case):
    place = Path(case.options["folder"]) / str(case.index)
    if not place.is_file():
        fault = Fault(str(place), None, None, "cannot be read: no route to host", None)
        raise studies.PassingError([fault])
    return {"value": int(place.read_text())}
"""


def own_module(tmp_path, monkeypatch, text):
    """A module of functions that workers can import, too."""
    name = f"own_{tmp_path.name}_{os.getpid()}".replace("-", "_")
    (tmp_path / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    return name


def test_what_cannot_be_read_now_is_read_by_the_next_run(tmp_path, monkeypatch, capsys):
    module = own_module(tmp_path, monkeypatch, UNREAD)
    for index in (0, 2):
        (tmp_path / str(index)).write_text(f"{10 * index}\n")
    file, out = tmp_path / "study.json", tmp_path / "rows.parquet"
    said = {"format": "denavit-study/1", "name": "read", "count": 3, "function": f"{module}:read"}
    file.write_text(json.dumps(said | {"options": {"folder": str(tmp_path)}}))
    assert main(["study", "run", str(file), "-o", str(out)]) == 0
    assert "1 could not be read or computed; the same command" in capsys.readouterr().err
    rows = studies.read_part(out).to_pylist()
    assert [row["value"] for row in rows] == [0, None, 20]
    assert "no route to host" in rows[1]["failure"] and studies.again(out) == [1]
    study = studies.read_study(file)
    assert studies.missing([out], study) == [(0, 3)]
    with pytest.raises(studies.StudyError, match="could not be read"):
        studies.merge([out], tmp_path / "merged.parquet")
    (tmp_path / "1").write_text("10")
    (tmp_path / "0").unlink()  # what has an answer is not read again
    assert studies.run(study, out) == 1 and studies.again(out) == []
    assert [row["value"] for row in studies.read_part(out).to_pylist()] == [0, 10, 20]
    # the same bytes as of a run that read all at once
    (tmp_path / "0").write_text("0")
    studies.run(study, tmp_path / "other.parquet")
    assert out.read_bytes() == (tmp_path / "other.parquet").read_bytes()


BUILDS = """
import subprocess
from denavit import studies

@studies.rows(said=str)
def asked(case):
    return {"said": subprocess.check_output(["sh", case.files["program"]], text=True).strip()}
"""


def test_rows_of_two_builds_of_a_program_are_not_mixed(tmp_path, monkeypatch, capsys):
    module = own_module(tmp_path, monkeypatch, BUILDS)
    program, out = tmp_path / "program", tmp_path / "rows.parquet"
    program.write_text("echo first")
    file = tmp_path / "study.json"
    said = {"format": "denavit-study/1", "name": "builds", "count": 4}
    said |= {"function": f"{module}:asked", "files": {"program": "program"}}
    file.write_text(json.dumps(said))
    study = studies.read_study(file)
    rows = studies.computed(study, [0, 1])
    with journal(Part(study, 0, 4, out)) as (_, journalled):
        for row in rows:
            noted(journalled, row)
    # the program is built anew: neither the journal nor a part of before is gone on with
    program.write_text("echo other")
    assert main(["study", "run", str(file), "-o", str(out)]) == 2
    text = capsys.readouterr().err
    assert "the file `program` changed" in text and "hint: name another file" in text
    # nor does a study that runs take the new one
    with pytest.raises(Error, match="the file `program` changed since"):
        studies.run(study, out)
    program.write_text("echo first")
    assert studies.run(study, out) == 2
    program.write_text("echo other")
    assert main(["study", "run", str(file), "-o", str(out)]) == 2
    assert "the file `program` changed" in capsys.readouterr().err
    for runner in (in_process, in_processes(2)):
        with pytest.raises(Error, match="the file `program` changed since"):
            list(runner(study, range(2)))
    program.unlink()
    assert main(["study", "run", str(file), "-o", str(out)]) == 2
    assert "program: cannot be read" in capsys.readouterr().err


def test_folders_are_named_by_all_that_they_hold(tmp_path):
    folder = tmp_path / "folder"
    (folder / "in").mkdir(parents=True)
    (folder / "in" / "a").write_text("1")
    names = [digest_of_path(folder)]
    (folder / "in" / "a").write_text("12")
    names.append(digest_of_path(folder))
    (folder / "in" / "a").rename(folder / "b")
    names.append(digest_of_path(folder))
    assert len(set(names)) == 3
    (folder / "__pycache__").mkdir()
    (folder / "__pycache__" / "a.pyc").write_text("made")
    assert digest_of_path(folder) == names[-1]


def test_workers_end_with_the_process_that_started_them(study_file, tmp_path):
    """And not at the end of rows that nobody waits for."""
    changed(study_file, options={"wait_s": 30.0})
    command = [sys.executable, "-m", "denavit", "study", "run", str(study_file), "--workers", "2"]
    process = subprocess.Popen([*command, "-o", str(tmp_path / "rows.parquet")])

    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")

    def is_worker(pid):
        try:
            return b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes()
        except OSError:
            return False

    until, workers = time.monotonic() + 60, []
    while len(workers) < 2:
        assert time.monotonic() < until and process.poll() is None
        time.sleep(0.05)
        workers = [pid for pid in children.read_text().split() if is_worker(pid)]
    time.sleep(1.0)
    process.send_signal(signal.SIGKILL)
    process.wait()
    until = time.monotonic() + 10
    while any(is_worker(pid) for pid in workers):
        assert time.monotonic() < until, "workers outlive their driver"
        time.sleep(0.05)


def test_ctrl_c_says_one_sentence(study_file, tmp_path):
    changed(study_file, options={"wait_s": 20.0})
    command = [sys.executable, "-m", "denavit", "study", "run", str(study_file), "--workers", "2"]
    process = subprocess.Popen(
        [*command, "-o", str(tmp_path / "rows.parquet")], stderr=subprocess.PIPE, text=True,
        start_new_session=True,
        # a job in the background would have it ignored
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    until = time.monotonic() + 60
    while not (tmp_path / "rows.parquet.rows").exists():
        assert time.monotonic() < until and process.poll() is None
        time.sleep(0.05)
    time.sleep(3.0)
    os.killpg(process.pid, signal.SIGINT)
    _, text = process.communicate(timeout=15)
    assert process.returncode == 130 and "Traceback" not in text, text
    assert "the same command goes on" in text


def test_odd_arguments_of_studies_are_refused(study_file, tmp_path, capsys):
    study = studies.read_study(study_file)
    out = str(tmp_path / "rows.parquet")
    for workers in ("0", "-1", "two"):
        with pytest.raises(SystemExit):
            main(["study", "run", str(study_file), "--workers", workers, "-o", out])
        assert "1 or more" in capsys.readouterr().err
    for number in (0, 1.5, True):
        with pytest.raises(ArgumentError, match="`workers` is"):
            in_processes(number)
    with pytest.raises(ArgumentError, match=r"`options\['wait_s'\]`"):
        studies.Study("squares", study.function, 3, options={"wait_s": math.nan})
    text = study_file.read_text()
    study_file.write_text(text.replace('"options": {}', '"options": {"wait_s": NaN}'))
    assert main(["study", "run", str(study_file), "-o", out]) == 2
    assert "squares.json: is no JSON: NaN" in capsys.readouterr().err
    with pytest.raises(ArgumentError, match="`out`"):
        studies.run(study, 5)
    (tmp_path / "file").write_text("")
    with pytest.raises(studies.StudyError, match="folder cannot be made"):
        studies.run(study, tmp_path / "file" / "rows.parquet")
    with pytest.raises(studies.StudyError, match="no part of a study"):
        studies.run(study, tmp_path)


def test_errors_are_themselves_in_other_processes():
    fault = Fault("a.csv", 3, None, "is cut", "write it again")
    for kind in (Error, studies.StudyError, studies.PassingError):
        again = pickle.loads(pickle.dumps(kind([fault, fault])))
        assert type(again) is kind and again.faults == (fault, fault)


def test_no_cluster_of_ray_is_said():
    pytest.importorskip("ray")
    from denavit.studies.on_ray import on_ray

    study = studies.Study("push", studies.ready.push, 1)
    with pytest.raises(Error, match="no cluster of Ray answers") as error:
        list(on_ray("127.0.0.1:1")(study, range(1)))
    assert "ray start --head" in (error.value.hint or "")


def test_a_function_that_nodes_cannot_import_is_said(tmp_path, monkeypatch):
    pytest.importorskip("ray")
    from denavit.studies.on_ray import on_ray

    module = own_module(tmp_path, monkeypatch, BUILDS)
    monkeypatch.delenv("PYTHONPATH")
    study = studies.Study("asked", importlib.import_module(module).asked, 1)
    with pytest.raises(Error, match="a node cannot import") as error:
        list(on_ray()(study, range(1)))
    assert "PYTHONPATH" in (error.value.hint or "")
