"""Runs studies on Ray: on the machines of a cluster, or on the cores of this one."""

from __future__ import annotations

import socket
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from ..errors import Error, Fault, MissingPackage
from .cases import Row
from .here import Runner
from .study import Study

WAIT_S = 10.0
"""Seconds in which the head of a cluster answers, at most."""


MOST_RETRIES = 3
"""How often a row is computed again whose worker was killed."""


def ray_package() -> Any:
    """The package ray, which is asked for where it is used."""
    try:
        import ray  # type: ignore[import-not-found, unused-ignore]
    except ImportError:
        cause, hint = "ray is not installed", "pip install 'denavit[ray]'"
        raise MissingPackage([Fault(None, None, None, cause, hint)]) from None
    return ray


@contextmanager
def connected(address: str | None = None) -> Iterator[None]:
    """A connection to Ray that several studies share. ``address`` is that of :func:`on_ray`."""
    ray = ray_package()
    is_ours = not ray.is_initialized()
    if is_ours:
        _reach(address)
        try:
            # without an address Ray would take whatever cluster runs here, of others perhaps
            chosen = "local" if address is None else address
            # Ray counts no retries where memory runs out, and would go on without an end; a cluster
            # that runs has its own setting, RAY_task_oom_retries of its head
            more = {"_system_config": {"task_oom_retries": MOST_RETRIES}} if address is None else {}
            ray.init(address=chosen, include_dashboard=False, log_to_driver=False, **more)
        except (ConnectionError, RuntimeError, ValueError) as error:
            raise _unreachable(address, error) from None
    try:
        yield
    finally:
        if is_ours:
            ray.shutdown()


def _reach(address: str | None) -> None:
    """Asks whether anything answers at an address: Ray would wait for it for minutes."""
    host, colon, port = (address or "").rpartition("://")[2].rpartition(":")
    if not colon:
        return  # Ray finds it itself
    try:
        socket.create_connection((host.strip("[]"), int(port)), WAIT_S).close()
    except (OSError, ValueError, OverflowError) as error:
        raise _unreachable(address, error) from None


def _unreachable(address: str | None, error: Exception) -> Error:
    first = (str(error).strip().splitlines() or [type(error).__name__])[0]
    cause = f"no cluster of Ray answers: {first}"
    hint = "`ray start --head` starts one and says its address; `auto` finds it on its own machine"
    if address is None:
        cause, hint = f"Ray does not start here: {first}", "`ray stop` ends an old one"
    return Error([Fault(address, None, None, cause, hint)])


def on_ray(address: str | None = None, *, tasks_a_core: int = 2) -> Runner:
    """Computes rows on Ray. ``address`` is that of a cluster (``"auto"`` for the one that runs
    here); without one Ray starts on this machine. Rows of a worker or a node that dies are computed
    again elsewhere, at most :data:`MOST_RETRIES` times: what kills every worker has no answer.
    """

    def computed(study: Study, indices: Iterable[int]) -> Iterator[Row]:
        with connected(address):
            yield from _rows(ray_package(), study, indices, tasks_a_core)

    return computed


def _rows(ray: Any, study: Study, indices: Iterable[int], tasks_a_core: int) -> Iterator[Row]:
    # a row depends on its index alone, and may be computed again; but one that kills its worker, as
    # where memory is short, would kill all that come after
    task = ray.remote(num_cpus=1, max_retries=MOST_RETRIES)(_row)
    # named here, so that workers are held to it
    assert study.key
    shared = ray.put(study)
    most = max(1, int(ray.cluster_resources().get("CPU", 1)) * tasks_a_core)
    under_way: dict[Any, int] = {}
    for index in indices:
        under_way[task.remote(shared, index)] = index
        if len(under_way) >= most:
            yield from _finished(ray, study, under_way)
    while under_way:
        yield from _finished(ray, study, under_way)


def _finished(ray: Any, study: Study, under_way: dict[Any, int]) -> Iterator[Row]:
    """Takes what is done, one at least."""
    done, _ = ray.wait(list(under_way))
    for one in done:
        yield _got(ray, study, under_way.pop(one), one)


def _got(ray: Any, study: Study, index: int, done: Any) -> Row:
    """A row that is done. What denavit raised in a worker is raised here, as it was."""
    said = ray.exceptions
    killed = (
        said.WorkerCrashedError, said.NodeDiedError, said.OutOfMemoryError, said.ObjectLostError,
    )  # fmt: skip
    try:
        row: Row = ray.get(done)
    except said.RayTaskError as error:
        if isinstance(error.cause, Error):
            raise error.cause from None
        # a study that cannot be unpacked in a worker is a fault of Ray's system, with this text
        last = str(error.cause).strip().rpartition("\n")[2]
        if isinstance(error.cause, ImportError) or last.startswith("ModuleNotFoundError"):
            cause = f"a node cannot import {study.place}: {last}"
            hint = "its module has to be on PYTHONPATH of every node before `ray start`"
            raise Error([Fault(study.name, None, None, cause, hint)]) from None
        raise
    except killed as error:
        cause = f"index {index}: its worker was killed {MOST_RETRIES + 1} times"
        hint = f"perhaps memory runs out ({type(error).__name__}); the next run computes it again"
        return study.silent(index, str(Fault(study.name, None, None, cause, hint)))
    return row


def _row(study: Study, index: int) -> Row:
    return study.row(index)
