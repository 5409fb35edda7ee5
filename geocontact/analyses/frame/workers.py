"""Independent pieces of work in processes of their own, as many at a time as there are cores."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from typing import TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")


def cores() -> int:
    """Cores that this process may use."""
    usable: Callable[[int], set[int]] | None = getattr(os, "sched_getaffinity", None)
    return len(usable(0)) if usable is not None else os.cpu_count() or 1


def each(
    work: Callable[[Task], Result], tasks: Sequence[Task], jobs: int | None
) -> Iterator[tuple[Task, Result | BaseException]]:
    """Tasks and what became of them, as they come: a result, or why there is none, such as a process that was killed.

    `jobs` processes at most, as many as there are cores for None; with one the work is done here.
    """
    count = min(jobs or cores(), len(tasks))
    if count <= 1:
        yield from ((task, work(task)) for task in tasks)
        return
    with current_folder_closed():  # its locks have a process too
        pool = ProcessPoolExecutor(count, get_context("spawn"), _begin)
    try:
        with current_folder_closed():
            futures = {pool.submit(work, task): task for task in tasks}
        for future in as_completed(futures):
            error = future.exception()
            yield futures[future], future.result() if error is None else error
    finally:
        pool.shutdown(cancel_futures=True)


SAFE_PATH = "PYTHONSAFEPATH"
"""The variable that keeps the current folder out of those that Python searches for modules (3.11, -P)."""
OURS = "geocontact"
"""The value of `SAFE_PATH` where this program has set it, and not who started it."""


@contextmanager
def current_folder_closed() -> Iterator[None]:
    """Python processes that begin meanwhile run no module of the current folder: a signal.py beside the data.

    A process of `multiprocessing` else searches that folder until it has the paths of the one that started it.
    """
    if os.environ.get(SAFE_PATH):
        yield
        return
    os.environ[SAFE_PATH] = OURS
    try:
        yield
    finally:
        os.environ.pop(SAFE_PATH, None)


def leave_programs_their_folder() -> None:
    """Programs that a process which began so starts find modules beside them, as they do elsewhere."""
    if os.environ.get(SAFE_PATH) == OURS:
        del os.environ[SAFE_PATH]


def _begin() -> None:
    """A worker ends at once with Ctrl-C, and with the process that started it."""
    leave_programs_their_folder()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
