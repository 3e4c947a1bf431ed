"""Studies whose functions end their processes, change unseen, or cannot be imported."""

import functools
import importlib
import json
import os

import pytest

from denavit import studies
from denavit.__main__ import main
from denavit.errors import Error
from denavit.studies.content import digest_of_path
from denavit.studies.here import in_process, in_processes

pytest.importorskip("pyarrow")

FAULTS = """
import os
import signal
import sys
import time
from denavit import studies

@studies.rows(value=int)
def kills(case):
    if case.index == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return {"value": case.index}

@studies.rows(value=int)
def exits(case):
    if case.index == 3:
        sys.exit(0)
    return {"value": case.index}
"""


@pytest.fixture
def module(tmp_path, monkeypatch):
    """A module of functions that workers can import, too."""
    name = f"faults_{tmp_path.name}_{os.getpid()}".replace("-", "_")
    (tmp_path / f"{name}.py").write_text(FAULTS)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    return importlib.import_module(name)


def test_what_kills_every_worker_of_ray_has_no_answer(module, tmp_path):
    pytest.importorskip("ray")
    from denavit.studies.on_ray import on_ray

    study, out = studies.Study("kills", module.kills, 6), tmp_path / "rows.parquet"
    studies.run(study, out, runner=on_ray())
    rows = studies.read_part(out).to_pylist()
    assert [row["value"] for row in rows] == [0, 1, 2, None, 4, 5]
    assert "kills: index 3: its worker was killed 4 times" in rows[3]["failure"]
    assert studies.again(out) == [3]


def test_a_killed_process_names_the_indices_it_was_at(module, tmp_path):
    study, out = studies.Study("kills", module.kills, 20), tmp_path / "rows.parquet"
    with pytest.raises(studies.StudyError, match="a worker was killed at .*3") as error:
        studies.run(study, out, runner=in_processes(1))
    named = error.value.cause.rpartition("ind")[2]
    assert 1 <= named.count(",") + 1 <= 2, error.value.cause
    with pytest.raises(studies.StudyError, match="killed at the index 3\n"):
        studies.run(study, tmp_path / "one.parquet", range(3, 4), runner=in_processes(1))


def test_a_function_that_ends_its_process_is_told(module, tmp_path):
    study = studies.Study("exits", module.exits, 6)
    for runner in (in_process, in_processes(2)):
        with pytest.raises(Error, match=r"index 3: .*exits ends its process: SystemExit\(0\)"):
            studies.run(study, tmp_path / "rows.parquet", runner=runner)


def test_a_function_that_ends_its_process_on_ray_is_told(module):
    pytest.importorskip("ray")
    from denavit.studies.on_ray import on_ray

    study = studies.Study("exits", module.exits, 6)
    with pytest.raises(Error, match="index 3: .*exits ends its process"):
        list(on_ray()(study, range(6)))


def closed_over(value, default=1.0):
    """A function that answers what is around it."""

    @studies.rows(value=float)
    def answers(case, more=default):
        return {"value": float(value) + more}

    return answers


def test_values_around_a_function_are_part_of_its_study(tmp_path):
    def key(*given):
        return studies.Study("closed", closed_over(*given), 2).key

    keys = {key(2.0), key(3.0), key(2.0, 2.0), key(2)}
    assert len(keys) == 4 and key(2.0) in keys
    out = tmp_path / "rows.parquet"
    assert studies.run(studies.Study("closed", closed_over(2.0), 2), out) == 2
    with pytest.raises(studies.StudyError, match="the function .*answers` changed|answers changed"):
        studies.run(studies.Study("closed", closed_over(3.0), 2), out)


def wrapped(function):
    @functools.wraps(function)
    def outer(case):
        return function(case)

    return outer


def test_a_decorated_function_is_named_by_what_it_holds():
    keys = {studies.Study("w", wrapped(closed_over(one)), 1).key for one in (1.0, 2.0, 1.0)}
    assert len(keys) == 2


def test_rows_of_a_function_without_text_are_not_kept(tmp_path):
    names = {"studies": studies}
    exec("@studies.rows(value=int)\ndef typed(case):\n    return {'value': 1}", names)
    study = studies.Study("typed", names["typed"], 2)
    assert [row["value"] for row in studies.computed(study)] == [1, 1]
    with pytest.raises(Error, match="cannot be kept: the text of typed is not known") as error:
        studies.run(study, tmp_path / "rows.parquet")
    assert "write it into a module" in (error.value.hint or "")
    open_file = closed_over(open(os.devnull))
    with pytest.raises(Error, match="a value of type TextIOWrapper has no name"):
        studies.run(studies.Study("open", open_file, 1), tmp_path / "rows.parquet")


def test_folders_are_named_through_their_links(tmp_path):
    folder, other = tmp_path / "folder", tmp_path / "other"
    folder.mkdir()
    other.mkdir()
    (other / "a").write_text("1")
    names = [digest_of_path(folder)]
    (folder / "linked").symlink_to(other)
    names.append(digest_of_path(folder))
    (other / "a").write_text("12")
    names.append(digest_of_path(folder))
    assert len(set(names)) == 3
    # one that leads back has no end
    (other / "back").symlink_to(folder)
    assert digest_of_path(folder) == names[-1]


@pytest.mark.parametrize(
    "text", ["raise RuntimeError('boom')", "import sys; sys.exit(0)", "def (", "import no_such"]
)
def test_a_module_that_fails_when_imported_is_named(text, tmp_path, monkeypatch, capsys):
    name = f"broken_{tmp_path.name}_{os.getpid()}".replace("-", "_")
    (tmp_path / f"{name}.py").write_text(text + "\n")
    monkeypatch.syspath_prepend(tmp_path)
    file = tmp_path / "study.json"
    said = {"format": "denavit-study/1", "name": "broken", "count": 3, "function": f"{name}:f"}
    file.write_text(json.dumps(said))
    assert main(["study", "run", str(file), "-o", str(tmp_path / "rows.parquet")]) == 2
    assert f"`function`: the module {name} cannot be imported: " in capsys.readouterr().err
