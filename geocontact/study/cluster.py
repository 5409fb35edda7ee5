"""Workers of a study: processes on this machine, or those of an existing Dask cluster."""

from __future__ import annotations

import errno
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import current_process
from typing import Any

from geocontact.analyses.workers import cores
from geocontact.data.errors import InputError
from geocontact.study.options import CohortOptions

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


@contextmanager
def workers_of(o: CohortOptions) -> Iterator[Any]:
    """A `distributed.Client` of the workers; they are ended with the block where they were started for it."""
    try:
        import dask
        import distributed as library
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
