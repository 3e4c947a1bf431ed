"""Runs studies on Ray: on the machines of a cluster, or on the cores of this one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from ..errors import Fault, MissingPackage
from .cases import Row
from .here import Runner
from .study import Study


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
        ray.init(address=address, include_dashboard=False, log_to_driver=False)
    try:
        yield
    finally:
        if is_ours:
            ray.shutdown()


def on_ray(address: str | None = None, *, tasks_a_core: int = 2) -> Runner:
    """Computes rows on Ray. ``address`` is that of a cluster (``"auto"`` for the one that runs
    here); without one Ray starts on this machine. Rows of a worker or a node that dies are computed
    again elsewhere.
    """

    def computed(study: Study, indices: Iterable[int]) -> Iterator[Row]:
        with connected(address):
            yield from _rows(ray_package(), study, indices, tasks_a_core)

    return computed


def _rows(ray: Any, study: Study, indices: Iterable[int], tasks_a_core: int) -> Iterator[Row]:
    # a row depends on its index alone: it may be computed again, as often as workers die
    task = ray.remote(num_cpus=1, max_retries=-1)(_row)
    shared = ray.put(study)
    most = max(1, int(ray.cluster_resources().get("CPU", 1)) * tasks_a_core)
    under_way: list[Any] = []
    for index in indices:
        under_way.append(task.remote(shared, index))
        if len(under_way) >= most:
            done, under_way = ray.wait(under_way)
            yield from ray.get(done)
    while under_way:
        done, under_way = ray.wait(under_way)
        yield from ray.get(done)


def _row(study: Study, index: int) -> Row:
    return study.row(index)
