"""One trial on a worker: its results go to their place, what goes wrong is written in one line."""

from __future__ import annotations

import errno
import json
import os
import secrets
import shutil
import threading
import traceback
from collections.abc import Mapping
from contextlib import chdir
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from geocontact.analyses.catalogue import job_named
from geocontact.analyses.frame import source_digest
from geocontact.analyses.frame.job import Call, execute
from geocontact.analyses.frame.record import Listener
from geocontact.analyses.frame.result import Part
from geocontact.analyses.frame.table_forms import TableForms
from geocontact.data.errors import InputError
from geocontact.study.address import ONE_THREAD, options_of
from geocontact.study.limits import NO_LIMITS, TrialLimits, kept_within
from geocontact.study.store import MOST_ENDED, REPORT, WORK, Store

DONE, WRONG, FAILED, SET_ASIDE, STOPPED = "done", "input error", "failed", "set aside", "stopped"
"""What becomes of a trial; STOPPED concerns all: nothing can be written, or the worker has other sources."""
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EROFS)
_one_at_a_time = threading.Lock()  # the working folder and what catches warnings are those of the whole process
_sources = cache(source_digest.digest)


@dataclass(frozen=True)
class TrialTask:
    """What a worker is given.

    Parameters
    ----------
    analysis
        As its command is typed.
    options
        As a study says them.
    home
        Folder that paths start from.
    store
        Where results go.
    address
        Of these results.
    sources
        Digest of the package's sources, as where the study was started.
    run
        Marks one run of the study.
    limits
        What the trial may take.
    step
        Name of its step in the study.
    taken
        Folders of earlier results that options name, as paths from `home`.
    without
        What is not written.
    """

    analysis: str
    options: Mapping[str, Any]
    home: Path
    store: Store
    address: str
    sources: str
    run: str
    limits: TrialLimits = NO_LIMITS
    step: str = ""
    taken: tuple[str, ...] = ()
    without: frozenset[Part] = frozenset()

    def given_up(self) -> str:
        """Why the trial is not tried again, in a line; "" where it is."""
        if why := self.limits.exceeded(self.store.log(self.address)):
            return f"{why} (where it was: {self.store.log_named(self.address)})"
        killed = self.store.starts(self.run, self.address) >= MOST_ENDED
        return f"its worker was killed {MOST_ENDED} times: out of memory, or a crash" if killed else ""


@dataclass(frozen=True)
class TrialOutcome:
    """What became of a trial: one of the words above, and a line where it is not done; seconds that it took."""

    state: str
    line: str = ""
    seconds: float = 0.0


def run_trial(task: TrialTask) -> TrialOutcome:
    """Evaluate a trial; results are in their place when this returns `DONE`."""
    import time

    started = time.perf_counter()
    if task.sources != _sources():
        return TrialOutcome(STOPPED, "a worker has other sources of geocontact; install the same version there")
    if why := task.given_up():
        return TrialOutcome(SET_ASIDE, why)
    with _one_at_a_time:
        try:
            ended, log = task.store.starting(task.run, task.address), task.store.log(task.address)
            with kept_within(task.limits, log):
                outcome = _outcome(task)
            if outcome.state != FAILED:
                log.unlink(missing_ok=True)
            ended()
        except OSError as error:
            return TrialOutcome(STOPPED, str(error.strerror or error))
    return TrialOutcome(outcome.state, outcome.line, time.perf_counter() - started)


def _outcome(task: TrialTask) -> TrialOutcome:
    draft = task.store.folder / WORK / secrets.token_hex(8)
    try:
        draft.mkdir()
        with chdir(task.home):
            _evaluate(task, draft / "out")
        task.store.keep(draft / "out", task.address)
    except InputError as error:
        return TrialOutcome(WRONG, str(error))
    except MemoryError:
        return TrialOutcome(FAILED, "not enough memory")
    except Exception as error:
        if isinstance(error, OSError) and error.errno in NO_ROOM:
            raise
        last = traceback.extract_tb(error.__traceback__)[-1]
        log = task.store.write_log(task.address, traceback.format_exc())
        line = f"{type(error).__name__}: {error} ({Path(last.filename).name} {last.lineno}; all of it: {log})"
        return TrialOutcome(FAILED, " ".join(line.split()))
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return TrialOutcome(DONE)


def _evaluate(task: TrialTask, out: Path) -> None:
    job = job_named(task.analysis)
    options = options_of(job.options, task.options)
    if task.limits.cores > 1 and hasattr(options, ONE_THREAD) and ONE_THREAD not in task.options:
        options = replace(options, **{ONE_THREAD: task.limits.cores})  # results are those of one core
    options.refuse_missing_files()
    call = Call(dict(task.options), Listener(), forms=TableForms(parquet=True), without=task.without)
    result, _ = execute(job, options, out, call)
    report = {
        "analysis": task.analysis,
        "step": task.step,
        "from": list(task.taken),
        "tables": [name for name, table in result.tables().items() if len(table.columns)],
        "sentences": list(result.sentences),
        "warnings": list(result.warnings),
        "accepted": result.accepted,
        "fit": result.fit_outcome or "",
        "inputs contradict": bool(result.record.causes),
    }
    draft = out / f"{REPORT}.part"
    draft.write_text(json.dumps(report, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    os.replace(draft, out / REPORT)
