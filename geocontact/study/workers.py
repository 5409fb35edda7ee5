"""Workers of a study, on this machine or an existing Dask cluster: trials go out, outcomes come as they end.

Whoever reaches the scheduler can run code as the user. Processes on this machine therefore speak TLS with certificates
that are made for the run and held in memory: other users of the machine are refused.
"""

from __future__ import annotations

import errno
import logging
import time
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from itertools import islice
from multiprocessing import current_process
from operator import length_hint
from typing import Any

from geocontact.analyses.frame.collector import listener
from geocontact.analyses.frame.workers import cores, current_folder_closed
from geocontact.data.errors import InputError
from geocontact.study.cluster import THREADS, Jobs
from geocontact.study.limits import NO_LIMITS, TrialLimits
from geocontact.study.options import CohortOptions
from geocontact.study.trial_run import FAILED, SET_ASIDE, TrialOutcome, TrialTask, run_trial

INSTALL = "pip install 'geocontact[cohort]'"
PATIENCE = 30.0  # s; for a scheduler to answer
STARTS = 3
SETTINGS: dict[str, Any] = {
    "distributed.scheduler.allowed-failures": 10,  # a trial counts its workers itself, and only those that were at it
    "distributed.worker.multiprocessing-method": "spawn",  # no server between: `worker_setup` asks for its parent
    "distributed.admin.system-monitor.gil.enabled": False,
    # nobody reads them, and a process that waits took 1.6 % of a core for them: 0.6 to 0.9 % is left
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "1s",
    # pages about the work are shown to nobody: they do not ask who asks
    **{f"distributed.{each}.http.routes": [] for each in ("scheduler", "worker", "nanny")},
}
LOGGERS = tuple(f"distributed{part}" for part in ("", ".client", ".core", ".nanny", ".scheduler", ".worker"))
BACKSTOP = 4
"""Dask's nanny ends a process that holds so many times what a trial may take, whatever code holds it."""
AHEAD = 2
"""Trials that are given out for each thread of the workers: one runs, one waits."""
COUNTED = 1.0  # s; so often the workers are counted, for they come and go on a cluster
FETCHED = 5.0  # s; as long may fetching an outcome take
WORKERLESS = 60.0  # s; as long may a study be without any worker
ALL_GONE = "no worker is left; finished trials stay: run it again"
GONE = "the scheduler is gone; finished trials stay: run it again"


class Workers:
    """A `distributed.Client` of the workers, which are started anew where all of this machine were lost."""

    def __init__(self, o: CohortOptions, distributed: Any, limits: TrialLimits, jobs: Jobs | None = None) -> None:
        self._o, self._distributed, self._held = o, distributed, ExitStack()
        self._limits, self._jobs = limits, jobs
        self.client: Any = None
        self._cluster: Any = None
        self._seen, self._asked, self._threads = 0.0, -1e9, 0
        self._said: set[str] = set()
        self._joined = o.local
        """Whether a worker has been there: those of a cluster may stand in its queue for hours."""

    def start(self) -> None:
        """Connect to the scheduler, start processes of this machine, or submit jobs."""
        if self._o.local:
            self._cluster = self._held.enter_context(_started(self._o, self._distributed, self._limits))
        elif self._jobs is not None:
            self._cluster = self._held.enter_context(self._jobs.started())
        if self._cluster is None:
            found = _existing(self._o, self._distributed)
        else:
            security = self._cluster.security
            found = self._distributed.Client(self._cluster, set_as_default=False, security=security)
        self.client = self._held.enter_context(found)
        self._seen = time.monotonic()

    def end(self) -> None:
        """End what was started."""
        self._held.close()

    def threads(self) -> int:
        """How many threads the workers have; asked for no more often than once a second."""
        if time.monotonic() - self._asked > COUNTED:
            try:
                self._threads, self._asked = sum(self.client.nthreads().values()), time.monotonic()
            except OSError as error:
                raise _lost(self.client) from error
            if self._threads:
                self._seen, self._joined = self._asked, True
            elif self._jobs is not None and self._jobs.refused and not self._joined:
                raise InputError("", "`scheduler`", f"no job was taken: {self._jobs.refused}", "see [cluster]")
            elif time.monotonic() - self._seen > WORKERLESS and self._wait():
                self._seen = float("inf") if self._jobs is None else time.monotonic()
        return self._threads

    def _wait(self) -> bool:
        """Whether a study that has been without workers for a while goes on waiting, which is said once."""
        if self._jobs is not None and self._jobs.queued(self._cluster):
            line = f"jobs wait in the queue of {self._o.scheduler}; the study waits for them"
        elif self._jobs is None and not self._joined:
            line = f"no worker has come to {self._o.scheduler} yet; the study waits for one"
        else:
            return False
        if line not in self._said:
            self._said.add(line)
            listener().fail(line)
        return True

    def missing(self, trials: int) -> None:
        """Say how many trials are without results: there are no more jobs than that."""
        if self._jobs is not None:
            self._jobs.missing = trials

    @property
    def name(self) -> str:
        """What they are, in a message."""
        return "processes of the study" if self._o.local else self._o.scheduler

    @property
    def gone(self) -> bool:
        """Whether all workers have been lost for a while."""
        return not self.threads() and time.monotonic() - self._seen > WORKERLESS

    def renew(self) -> None:
        """New processes in place of those that are lost; OSError where the scheduler is not ours to start."""
        if not self._o.local and self._jobs is None:
            raise OSError(errno.ECHILD, ALL_GONE, self._o.scheduler)
        self.end()
        self.start()


@contextmanager
def workers_of(o: CohortOptions, limits: TrialLimits = NO_LIMITS, jobs: Jobs | None = None) -> Iterator[Workers]:
    """Workers of a study; they are ended with the block where they were started for it."""
    try:
        import dask
        import distributed as library
        import pyarrow as pa  # noqa: F401  each trial writes its tables with it: asked for before any is computed

        if o.local or jobs is not None:
            import cryptography  # noqa: F401  certificates are made with it
    except ModuleNotFoundError as error:  # another ImportError is of the machine: no memory to load a library into
        raise InputError("", "cohort", f"needs {error.name}, which is not installed", INSTALL) from error
    distributed: Any = library  # its annotations do not say how it is called
    for name in LOGGERS:  # what matters of it is said in one line
        logging.getLogger(name).setLevel(logging.CRITICAL)
    found = Workers(o, distributed, limits, jobs)
    # a process that is a daemon can start none, which analyses on several cores do
    with current_folder_closed(), dask.config.set(SETTINGS | {"distributed.worker.daemon": limits.cores == 1}):
        try:
            found.start()
            yield found
        finally:
            found.end()


def _started(o: CohortOptions, distributed: Any, limits: TrialLimits, left: int = STARTS - 1) -> Any:
    """A cluster of this machine; started again, `left` times, where one of its processes was lost at once.

    A process that is started reads the script that started it: a call that stands there unguarded would start more.
    """
    if getattr(current_process(), "_inheriting", False):
        remedy = 'put the call below `if __name__ == "__main__":`'
        raise InputError("", "cohort", "is called anew by each process that it starts", remedy)
    try:
        return distributed.LocalCluster(
            n_workers=o.workers or _fitting(limits),
            threads_per_worker=1,
            processes=True,
            memory_limit="auto" if limits.memory is None else BACKSTOP * limits.memory,
            protocol="tls://",
            security=True,
            dashboard_address="127.0.0.1:0",
            env=dict.fromkeys(THREADS, str(limits.cores)),
            preload=["geocontact.study.worker_setup"],
            silence_logs="CRITICAL",
        )
    except RuntimeError as error:
        if left:
            return _started(o, distributed, limits, left - 1)
        what = f"ended {STARTS} times while they were started; try fewer of them, or more memory"
        raise OSError(errno.ECHILD, what, "processes of the study") from error


def _fitting(limits: TrialLimits) -> int:
    """Processes of this machine: as many as its cores, and where trials have a limit its memory, have room for."""
    import psutil  # type: ignore[import-untyped]

    count = cores() // limits.cores
    if limits.memory is not None:
        count = min(count, psutil.virtual_memory().total // limits.memory)
    return max(1, count)


def _existing(o: CohortOptions, distributed: Any) -> Any:
    remedy = "check the address, and that the scheduler runs the same version of Dask"
    try:
        return distributed.Client(o.scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        what = f"no scheduler answers at {o.scheduler} ({type(error).__name__})"
        raise InputError("", "`scheduler`", what, remedy) from error


def outcomes(workers: Workers, tasks: Iterable[TrialTask]) -> Iterator[tuple[TrialTask, TrialOutcome]]:
    """Every task with its outcome, in the order in which they end; OSError where scheduler or workers are lost.

    The iterator of `tasks` is asked again after each outcome: it may have more to give then. Its length hint is how
    many it has at present.

    What is given out at a time hangs on the number of workers and not on that of tasks. A task that was not at work
    when its worker ended is given out again. Dask does not restart a process that ends while it is starting: where no
    worker is left for a minute, those of this machine are started anew.
    """
    waiting = iter(tasks)
    running: dict[Any, TrialTask] = {}
    renewals = 0
    workers.missing(length_hint(waiting))

    def give_out(some: Iterator[TrialTask]) -> None:
        running.update({workers.client.submit(run_trial, task, pure=False, retries=0): task for task in some})

    give_out(islice(waiting, AHEAD * max(1, workers.threads())))
    while running:
        workers.missing(len(running) + length_hint(waiting))
        for future in _ended(workers.client, list(running)):
            try:
                became = future.exception(FETCHED) or future.result(FETCHED)
            except TimeoutError:  # its worker ended before it handed over what it had: Dask runs it again
                continue
            except OSError as error:  # of the connection: a trial that cannot write says so in its outcome
                raise _lost(workers.client) from error
            task = running.pop(future)
            if _killed(became) and not task.given_up():
                give_out(iter([task]))
            else:
                renewals = 0
                yield task, _outcome(became, task)
        if running and workers.gone:
            renewals += 1
            if renewals > STARTS:
                raise OSError(errno.ECHILD, ALL_GONE, workers.name)
            again = list(running.values())
            running.clear()
            workers.renew()
            give_out(iter(again))
        give_out(islice(waiting, max(0, AHEAD * max(1, workers.threads()) - len(running))))


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


def _killed(error: object) -> bool:
    return type(error).__name__ == "KilledWorker"


def _outcome(became: TrialOutcome | BaseException, task: TrialTask) -> TrialOutcome:
    if isinstance(became, TrialOutcome):
        return became
    if _killed(became):
        return TrialOutcome(SET_ASIDE, task.given_up())
    return TrialOutcome(FAILED, " ".join(f"{type(became).__name__}: {became}".split()))
