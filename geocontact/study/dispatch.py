"""Trials to workers, a few at a time, and what became of them as they come."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module
from typing import Any

from geocontact.study.store import MOST_ENDED
from geocontact.study.trial_run import FAILED, SET_ASIDE, Outcome, Task, run_trial

AHEAD = 2
"""Trials that are given out for each thread of the workers: one runs, one waits."""


def outcomes(client: Any, tasks: Sequence[Task]) -> Iterator[tuple[Task, Outcome]]:
    """Every task with its outcome, in the order in which they end.

    What is given out at a time does not depend on the number of tasks. A task that was not at work when its worker
    ended is given out again.
    """
    waiting = iter(tasks)
    running = {}
    completed = import_module("distributed").as_completed(with_results=False, loop=client.loop)

    def give_out(task: Task) -> None:
        future = client.submit(run_trial, task, pure=False, retries=0)
        running[future.key] = task
        completed.add(future)

    for task in _first(waiting, AHEAD * max(1, sum(client.nthreads().values()))):
        give_out(task)
    for future in completed:
        task = running.pop(future.key)
        error = future.exception()
        if _killed(error) and task.store.starts(task.run, task.address) < MOST_ENDED:
            give_out(task)
            continue
        yield task, _outcome(future.result() if error is None else error)
        future.release()
        for another in _first(waiting, 1):
            give_out(another)


def _killed(error: object) -> bool:
    return type(error).__name__ == "KilledWorker"


def _first(tasks: Iterator[Task], count: int) -> Iterator[Task]:
    for _, task in zip(range(count), tasks, strict=False):
        yield task


def _outcome(became: Outcome | BaseException) -> Outcome:
    if isinstance(became, Outcome):
        return became
    if _killed(became):
        return Outcome(SET_ASIDE, f"its worker was killed {MOST_ENDED} times: out of memory, or a crash")
    return Outcome(FAILED, " ".join(f"{type(became).__name__}: {became}".split()))
