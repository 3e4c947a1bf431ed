"""Runs studies: in this process, in processes of this machine, or on Ray."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from pathlib import Path
from typing import Protocol

from .cases import Row
from .parts import Part, journal, noted
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

    def computed(study: Study, indices: Iterable[int]) -> Iterator[Row]:
        # a fresh interpreter: threads of this one do not outlive a fork
        context = multiprocessing.get_context("spawn")
        pool = ProcessPoolExecutor(workers, context, initializer=_take, initargs=(study,))
        with pool:
            yield from windowed(indices, 2 * workers, lambda index: pool.submit(_row, index))

    return computed


def windowed(
    indices: Iterable[int], most: int, submit: Callable[[int], Future[Row]]
) -> Iterator[Row]:
    """Keeps so many rows under way, and gives each as it is done."""
    under_way: set[Future[Row]] = set()
    for index in indices:
        under_way.add(submit(index))
        if len(under_way) >= most:
            done, under_way = wait(under_way, return_when=FIRST_COMPLETED)
            yield from (one.result() for one in done)
    while under_way:
        done, under_way = wait(under_way, return_when=FIRST_COMPLETED)
        yield from (one.result() for one in done)


_STUDY: list[Study] = []


def _take(study: Study) -> None:
    _STUDY[:] = [study]


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
    Parquet. What an earlier run has left of them is not computed again. Answers how many rows were.
    """
    chosen = range(study.count) if indices is None else indices
    if chosen.step != 1 or chosen.start < 0 or chosen.stop > study.count:
        raise ValueError(f"indices of this study are a range from 0 to {study.count}")
    part = Part(study, chosen.start, chosen.stop, Path(out))
    part.path.parent.mkdir(parents=True, exist_ok=True)
    if part.is_whole():
        return 0
    with journal(part) as (done, file):
        left = [index for index in chosen if index not in done]
        for row in runner(study, left):
            noted(file, row)
            done[row["index"]] = row
            if progress is not None:
                progress(len(done), len(chosen))
        part.write(done.values())
    return len(left)
