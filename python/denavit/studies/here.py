"""Runs studies: in this process, in processes of this machine, or on Ray."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Protocol

from .._options import place
from ..errors import Fault, _argument
from .cases import Row
from .parts import Part, StudyError, journal, noted, wrong
from .study import Study

Progress = Callable[[int, int], object]
"""Hears how many rows are done, and of how many."""


class Runner(Protocol):
    """Computes rows of a study, in any order."""

    def __call__(self, study: Study, indices: Iterable[int]) -> Iterator[Row]: ...


def in_process(study: Study, indices: Iterable[int]) -> Iterator[Row]:
    """Computes rows one after the other, in this process."""
    return (study.row(index) for index in indices)


def in_processes(workers: int) -> Runner:
    """Computes rows in processes of this machine."""

    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise _argument(f"`workers` is {workers!r}", "a number of processes, 1 or more")

    def computed(study: Study, indices: Iterable[int]) -> Iterator[Row]:
        # named here, so that workers are held to it
        assert study.key
        # a fresh interpreter: threads of this one do not outlive a fork
        context = multiprocessing.get_context("spawn")
        pool = ProcessPoolExecutor(workers, context, initializer=_take, initargs=(study,))
        try:
            yield from windowed(indices, 2 * workers, lambda index: pool.submit(_row, index))
        except WorkerKilled as error:
            hint = "perhaps memory ran out. The same call goes on with the rows that are kept"
            raise StudyError([Fault(study.name, None, None, str(error), hint)]) from None
        finally:
            pool.shutdown(cancel_futures=True)

    return computed


class WorkerKilled(Exception):
    """A process ended, and with it what all of them were at."""

    def __init__(self, indices: Iterable[int]) -> None:
        one, *more = sorted(indices)
        at = "the index" if not more else "one of the indices"
        super().__init__(f"a worker was killed at {at} {', '.join(map(str, (one, *more)))}")


def windowed(
    indices: Iterable[int], most: int, submit: Callable[[int], Future[Row]]
) -> Iterator[Row]:
    """Keeps so many rows under way, and gives each as it is done."""
    under_way: dict[Future[Row], int] = {}
    for index in indices:
        try:
            under_way[submit(index)] = index
        except BrokenProcessPool:
            raise WorkerKilled(under_way.values()) from None
        if len(under_way) >= most:
            yield from _finished(under_way)
    while under_way:
        yield from _finished(under_way)


def _finished(under_way: dict[Future[Row], int]) -> Iterator[Row]:
    """Takes what is done, one at least. Rows that are whole come before a process that is not."""
    done, _ = wait(under_way, return_when=FIRST_COMPLETED)
    broken = {one for one in done if isinstance(one.exception(), BrokenProcessPool)}
    for one in done - broken:
        del under_way[one]
        yield one.result()
    if broken:
        raise WorkerKilled(under_way.values())


_STUDY: list[Study] = []


def _take(study: Study) -> None:
    _STUDY[:] = [study]
    # where someone presses Ctrl-C, the process that waits for this one says what there is to say
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """Ends this process as soon as the one that started it is gone, killed perhaps."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _row(index: int) -> Row:
    return _STUDY[0].row(index)


def computed(study: Study, indices: Iterable[int] | None = None) -> list[Row]:
    """Rows in the order of their indices, computed here and kept nowhere."""
    return list(in_process(study, range(study.count) if indices is None else indices))


def run(
    study: Study,
    out: str | Path,
    indices: range | None = None,
    *,
    runner: Runner = in_process,
    progress: Progress | None = None,
) -> int:
    """Computes the rows of a range of indices (all without one) and writes them to ``out`` as
    Parquet. What an earlier run has left of them is not computed again, but for rows that could not
    be read then. Answers how many rows were computed.
    """
    study.check_is_named()
    chosen = range(study.count) if indices is None else indices
    if chosen.step != 1 or chosen.start < 0 or chosen.stop > study.count:
        raise ValueError(f"indices of this study are a range from 0 to {study.count}")
    part = Part(study, chosen.start, chosen.stop, Path(place(out, "`out`")))
    try:
        part.path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        cause = f"its folder cannot be made: {error.strerror}"
        raise wrong(part.path, cause, "name a file in a folder that can be written to") from None
    if part.is_whole():
        return 0
    earlier = part.kept()
    with journal(part) as (of_journal, file):
        done = {**earlier, **of_journal}
        left = [index for index in chosen if index not in done]
        for row in runner(study, left):
            noted(file, row)
            done[row["index"]] = row
            if progress is not None:
                progress(len(done), len(chosen))
        part.write(done.values())
    return len(left)
