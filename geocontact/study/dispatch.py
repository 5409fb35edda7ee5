"""Trials to workers, a few at a time, and what became of them as they come."""

from __future__ import annotations

import errno
import time
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import Any

from geocontact.study.store import MOST_ENDED
from geocontact.study.trial_run import FAILED, SET_ASIDE, TrialOutcome, TrialTask, run_trial

AHEAD = 2
"""Trials that are given out for each thread of the workers: one runs, one waits."""
COUNTED = 1.0  # s; so often the workers are counted, for they come and go on a cluster
GONE = "the scheduler is gone; what is done is kept: run it again"


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
