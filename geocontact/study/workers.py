"""Workers of a study, on this machine or an existing Dask cluster: trials go out, outcomes come as they end."""

from __future__ import annotations

import errno
import logging
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from multiprocessing import current_process
from typing import Any

from geocontact.analyses.frame.workers import cores
from geocontact.data.errors import InputError
from geocontact.study.options import CohortOptions
from geocontact.study.store import MOST_ENDED
from geocontact.study.trial_run import FAILED, SET_ASIDE, TrialOutcome, TrialTask, run_trial

INSTALL = "pip install 'geocontact[cohort]'"
PATIENCE = 30.0  # s; for a scheduler to answer
STARTS = 3
SETTINGS: dict[str, Any] = {
    "distributed.scheduler.allowed-failures": 10,  # a trial counts its workers itself, and only those that were at it
    "distributed.worker.multiprocessing-method": "spawn",  # no server between: `worker_setup` asks for its parent
    "distributed.worker.daemon": True,  # workers end with this process, however it ends
    "distributed.admin.system-monitor.gil.enabled": False,
}
LOGGERS = tuple(f"distributed{part}" for part in ("", ".client", ".core", ".nanny", ".scheduler", ".worker"))
ONE_THREAD = {"OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
AHEAD = 2
"""Trials that are given out for each thread of the workers: one runs, one waits."""
COUNTED = 1.0  # s; so often the workers are counted, for they come and go on a cluster
GONE = "the scheduler is gone; finished trials stay: run it again"


@contextmanager
def workers_of(o: CohortOptions) -> Iterator[Any]:
    """A `distributed.Client` of the workers; they are ended with the block where they were started for it."""
    try:
        import dask
        import distributed as library
        import pyarrow as pa  # noqa: F401  each trial writes its tables with it: asked for before any is computed
    except ImportError as error:
        raise InputError("", "cohort", f"needs {error.name}, which is not installed", INSTALL) from error
    distributed: Any = library  # its annotations do not say how it is called
    for name in LOGGERS:  # what matters of it is told in one line
        logging.getLogger(name).setLevel(logging.CRITICAL)
    with dask.config.set(SETTINGS):
        if not o.local:
            with _existing(o, distributed) as client:
                yield client
            return
        with (
            _started(o, distributed) as cluster,
            distributed.Client(cluster, set_as_default=False) as client,
        ):
            yield client


def _started(o: CohortOptions, distributed: Any, left: int = STARTS - 1) -> Any:
    """A cluster of this machine; started again, `left` times, where one of its processes was lost at once.

    A process that is started reads the script that started it: a call that stands there unguarded would start more.
    """
    if getattr(current_process(), "_inheriting", False):
        remedy = 'put the call below `if __name__ == "__main__":`'
        raise InputError("", "cohort", "is called anew by each process that it starts", remedy)
    try:
        return distributed.LocalCluster(
            n_workers=o.workers or cores(),
            threads_per_worker=1,
            processes=True,
            memory_limit=o.memory or "auto",
            dashboard_address="127.0.0.1:0",
            env=ONE_THREAD,
            preload=["geocontact.study.worker_setup"],
            silence_logs="CRITICAL",
        )
    except RuntimeError as error:
        if left:
            return _started(o, distributed, left - 1)
        what = f"ended {STARTS} times while they were started; try fewer of them, or more memory"
        raise OSError(errno.ECHILD, what, "processes of the study") from error


def _existing(o: CohortOptions, distributed: Any) -> Any:
    remedy = "check the address, and that the scheduler runs the same version of Dask"
    try:
        return distributed.Client(o.scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        what = f"no scheduler answers at {o.scheduler} ({type(error).__name__})"
        raise InputError("", "`scheduler`", what, remedy) from error


def outcomes(client: Any, tasks: Sequence[TrialTask]) -> Iterator[tuple[TrialTask, TrialOutcome]]:
    """Every task with its outcome, in the order in which they end; OSError where the scheduler is lost.

    What is given out at a time hangs on the number of workers and not on that of tasks. A task that was not at work
    when its worker ended is given out again.
    """
    threads, waiting = _threads(client), iter(tasks)
    running: dict[Any, TrialTask] = {}

    def give_out(some: Iterator[TrialTask]) -> None:
        running.update({client.submit(run_trial, task, pure=False, retries=0): task for task in some})

    give_out(islice(waiting, AHEAD * threads()))
    while running:
        for future in _ended(client, list(running)):
            task = running.pop(future)
            try:
                became = future.exception() or future.result()
            except OSError as error:  # of the connection: a trial that cannot write says so in its outcome
                raise _lost(client) from error
            if _killed(became) and task.store.starts(task.run, task.address) < MOST_ENDED:
                give_out(iter([task]))
            else:
                yield task, _outcome(became)
        give_out(islice(waiting, max(0, AHEAD * threads() - len(running))))


def _ended(client: Any, futures: list[Any]) -> list[Any]:
    """Those that have ended, none after a while without any."""
    from distributed import wait as untyped

    wait: Any = untyped
    try:
        with client.as_current():
            done = wait(futures, timeout=COUNTED, return_when="FIRST_COMPLETED").done
    except TimeoutError:
        done = set()
    except Exception as error:
        if "Cancelled" not in type(error).__name__ and not isinstance(error, OSError):
            raise
        raise _lost(client) from error
    return [future for future in futures if future in done]


def _lost(client: Any) -> OSError:
    return OSError(errno.ECONNABORTED, GONE, str(client.scheduler.address) if client.scheduler else "scheduler")


def _threads(client: Any) -> Callable[[], int]:
    """How many threads the workers have, at least one; asked for no more often than once a second."""
    known, asked = 1, -1e9

    def threads() -> int:
        nonlocal known, asked
        if time.monotonic() - asked > COUNTED:
            try:
                known, asked = max(1, sum(client.nthreads().values())), time.monotonic()
            except OSError as error:
                raise _lost(client) from error
        return known

    return threads


def _killed(error: object) -> bool:
    return type(error).__name__ == "KilledWorker"


def _outcome(became: TrialOutcome | BaseException) -> TrialOutcome:
    if isinstance(became, TrialOutcome):
        return became
    if _killed(became):
        return TrialOutcome(SET_ASIDE, f"its worker was killed {MOST_ENDED} times: out of memory, or a crash")
    return TrialOutcome(FAILED, " ".join(f"{type(became).__name__}: {became}".split()))
