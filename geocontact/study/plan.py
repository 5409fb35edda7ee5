"""What a study evaluates: an address for every evaluation of every step as soon as its inputs are known.

A step whose inputs are results of others gets its address when these are there. Results of equal content therefore lead
to the same results again, however they came about.
"""

from __future__ import annotations

import errno
import os
import secrets
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import chdir
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import Any

from geocontact.analyses.catalogue import job_named
from geocontact.analyses.frame import source_digest
from geocontact.analyses.frame.collector import listener, note
from geocontact.analyses.frame.consent import ALLOWED, foreign, require_consent
from geocontact.analyses.frame.folder import is_kept
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import Options, declared
from geocontact.analyses.frame.result import Part
from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import open_file
from geocontact.study.address import Digests, address_of, contents_of, options_of
from geocontact.study.cluster import Jobs, job_size
from geocontact.study.description import StudyFile
from geocontact.study.limits import LimitSettings, TrialLimits, bytes_of, widest
from geocontact.study.options import CohortOptions
from geocontact.study.steps import StepRun, with_files
from geocontact.study.store import Store
from geocontact.study.trial_run import DONE, FAILED, STOPPED, WRONG, TrialOutcome, TrialTask
from geocontact.study.trials import CohortTrial
from geocontact.study.workers import outcomes, workers_of
from geocontact.trial_checks.twice import FEWEST

WITHOUT = "without input"
"""State of an evaluation that takes from one that has no results."""
LEFT = "not asked for"
"""State of one without results that the call leaves as it is."""
PLANNED = "to evaluate"
"""State of one that a dry run would evaluate."""


@dataclass
class Evaluation:
    """An evaluation of a step and what is known of it.

    Parameters
    ----------
    run
        Of what.
    address
        Of its results, "" while its inputs are not known or where its options cannot be.
    outcome
        None before it has ended.
    kept
        Whether its results were there before.
    """

    run: StepRun
    address: str = ""
    outcome: TrialOutcome | None = None
    kept: bool = False

    @property
    def state(self) -> str:
        """What became of it."""
        return PLANNED if self.outcome is None else self.outcome.state

    @property
    def trial(self) -> CohortTrial:
        """What it is of."""
        return self.run.trial


def _recorded(file: Path) -> bool:
    """Whether a file has so many lines that an equal one is no chance: noise never repeats, settings do."""
    with open_file(file) as lines:
        return sum(1 for _ in islice(lines, FEWEST + 1)) > FEWEST


class StudyPlan:
    """All evaluations of a study, those that are to be made among them.

    Parameters
    ----------
    asked
        Whether an evaluation that has no results is made.
    """

    def __init__(
        self,
        study: StudyFile,
        runs: Sequence[StepRun],
        store: Store,
        o: CohortOptions,
        asked: Callable[[StepRun], bool],
    ) -> None:
        self.study, self.store, self._o, self._asked = study, store, o, asked
        self.evaluations = [Evaluation(run) for run in runs]
        self._digests = Digests()
        self._users: dict[int, list[int]] = {}
        for k, run in enumerate(runs):
            for source in (each for some in run.takes.values() for each in some):
                self._users.setdefault(source, []).append(k)
        self._waiting: deque[TrialTask] = deque()
        self._at: dict[str, list[int]] = {}
        self._became: dict[str, TrialOutcome] = {}
        self._kept: dict[str, list[int]] = {}  # that are there and not asked for, of steps that are evaluated anew
        self._named: list[str] = []
        self._contents: dict[tuple[str, str], tuple[tuple[str, ...], str]] = {}
        self.copies: list[str] = []
        self._ended: list[int] = []
        self._run_id = secrets.token_hex(8)
        wanted: dict[Part, bool] = {"pages": study.pages, "figures": study.figures}
        self._without = frozenset(name for name, is_wanted in wanted.items() if not is_wanted)

    def look(self) -> None:
        """Find what is there and what can be evaluated at once.

        InputError where a file names what the call does not allow to be started.
        """
        analyses = list(dict.fromkeys(one.run.analysis for one in self.evaluations))
        self._consent([f"the module of {each!r}" for each in analyses if foreign(each)], said=False)
        self._leave_out()
        for k, one in enumerate(self.evaluations):
            if one.outcome is None and not one.address:
                self._settle(k)
        self._consent(self._named, said=True)

    def _leave_out(self) -> None:
        """End what needs a file that is not there, and all that takes from it, whatever else that waits for."""
        for k, one in enumerate(self.evaluations):  # each after those that it takes from
            missing = one.run.missing(self.study.home)
            sources = [self.evaluations[j] for some in one.run.takes.values() for j in some]
            lacking = next((each for each in sources if each.state == WITHOUT), None)
            if missing is not None:
                self._end(k, TrialOutcome(WITHOUT, f"needs {missing}, which is not there"))
            elif lacking is not None and one.outcome is None:
                self._end(k, TrialOutcome(WITHOUT, f"needs {lacking.run.step} of {lacking.trial.name}"))

    def _consent(self, named: Sequence[str], *, said: bool) -> None:
        own = [one.run.analysis for one in self.evaluations if foreign(one.run.analysis)] if said else []
        modules = [f"the module of {each!r}" for each in dict.fromkeys(own)]
        line = require_consent([*modules, *named], self._o.run_simulator, self.study.path)
        if line and said:
            listener().fail(line)

    @cached_property
    def _jobs(self) -> dict[str, Job[Any, Any]]:
        return {each: job_named(each) for each in dict.fromkeys(one.run.analysis for one in self.evaluations)}

    @cached_property
    def _anew(self) -> set[str]:
        """Steps that are evaluated although their results are there."""
        found = {self._o.from_step}
        for one in self.evaluations:  # each after those that it takes from
            if {*one.run.takes} & found:
                found.add(one.run.step)
        return {each for each in (*found, self._o.forget) if each is not None}

    def _settle(self, k: int) -> None:
        """Find what becomes of an evaluation whose inputs may be known, and of those that wait for it."""
        one = self.evaluations[k]
        sources = [self.evaluations[j] for some in one.run.takes.values() for j in some]
        if one.outcome is not None or any(each.outcome is None for each in sources):
            return
        lacking = next((each for each in sources if each.state != DONE), None)
        if lacking is not None:
            state = LEFT if lacking.state == LEFT else WITHOUT
            self._end(k, TrialOutcome(state, f"needs {lacking.run.step} of {lacking.trial.name}"))
            return
        try:
            task, programs = self._task(one)
        except InputError as error:
            self._end(k, self._judged(k, TrialOutcome(WRONG, str(error))))
            return
        one.address = task.address
        if task.address in self._became:
            self._end(k, self._became[task.address])
        elif task.address in self._at:
            self._at[task.address].append(k)
        elif (one.run.step not in self._anew or not self._asked(one.run)) and self._holds(task):
            one.kept = True
            if one.run.step in self._anew:
                self._kept.setdefault(task.address, []).append(k)
            self._end(k, TrialOutcome(DONE))
        elif not self._asked(one.run):
            self._end(k, TrialOutcome(LEFT, "has no results, and is left as it is"))
        else:
            self._named += programs
            self._waiting.append(task)
            self._at[task.address] = [k]

    def _judged(self, k: int, outcome: TrialOutcome) -> TrialOutcome:
        """What became of an evaluation: no mistake in its input where results that it takes from have been changed."""
        sources = [self.evaluations[j] for some in self.evaluations[k].run.takes.values() for j in some]
        lost = next((each for each in sources if outcome.state == WRONG and not self.store.whole(each.address)), None)
        if lost is None:
            return outcome
        line = f"results of {lost.run.step} of {lost.trial.name} were changed meanwhile; run it again ({outcome.line})"
        return TrialOutcome(FAILED, line, outcome.seconds)

    def _end(self, k: int, outcome: TrialOutcome) -> None:
        self.evaluations[k].outcome = outcome
        self._ended.append(k)
        for each in self._users.get(k, ()):
            self._settle(each)

    def _end_all(self, address: str, outcome: TrialOutcome) -> None:
        """End evaluations of an address; what was to be kept there is as new as they are."""
        for k in self._kept.pop(address, ()):
            self.evaluations[k].outcome, self.evaluations[k].kept = outcome, False
        for k in self._at.pop(address):
            self._end(k, outcome)

    def _holds(self, task: TrialTask) -> bool:
        return self.store.holds(task.address, self.study.home, self._digests, task.taken)

    def _task(self, one: Evaluation) -> tuple[TrialTask, list[str]]:
        """The task of an evaluation whose inputs are there, and what it would start."""
        job, home = self._jobs[one.run.analysis], self.study.home
        places = {name: [self._folder(j) for j in some] for name, some in one.run.takes.items()}
        options = with_files(one.run, places, self.study)
        if self._o.run_simulator and any(each.name == ALLOWED for each in declared(job.options)):
            options = {**options, ALLOWED: True}
        one.run = replace(one.run, trial=replace(one.trial, options=options))
        with chdir(home):
            read = options_of(job.options, options)
            read.refuse_missing_files()
            programs = list(read.programs())
        taken = tuple(place for some in places.values() for place in some)
        address = address_of(job, read, home, self._digests, taken, self._without)
        if not taken:
            self._notice_copy(one, read)
        task = TrialTask(
            one.run.analysis,
            options,
            home,
            self.store,
            address,
            self._sources,
            self._run_id,
            self._limits[one.run.step],
            one.run.step,
            taken,
            self._without,
        )
        return task, programs

    def _notice_copy(self, one: Evaluation, read: Options) -> None:
        """Keep words about a trial whose files have other names than those of an earlier one, and the same bytes."""
        content, names = contents_of(read, self.study.home, self._digests)
        before, trial = self._contents.setdefault((one.run.step, content), (names, one.trial.name))
        if before != names and all(_recorded(self.study.home / each) for each in {*names} - {*before}):
            own, other = (", ".join(sorted({*some} - {*rest})) for some, rest in ((names, before), (before, names)))
            self.copies.append(f"{one.trial.name}: {own} has the bytes of {other}, of {trial}: it counts twice")

    @cached_property
    def _limits(self) -> dict[str, TrialLimits]:
        steps = dict.fromkeys(one.run.step for one in self.evaluations)
        return {each: limits_of(self.study.limits_of(each), self._o) for each in steps}

    @cached_property
    def _sources(self) -> str:
        return source_digest.digest()

    def _folder(self, k: int) -> str:
        """Results of an evaluation, as a path from the study's folder."""
        place = self.store.place(self.evaluations[k].address)
        try:
            return Path(os.path.relpath(place, self.study.home)).as_posix()
        except ValueError:  # on another drive
            return place.as_posix()

    def __iter__(self) -> Iterator[TrialTask]:
        """Tasks that can be evaluated; more of them come as others end."""
        return self

    def __length_hint__(self) -> int:
        """How many are known at present."""
        return len(self._waiting)

    def __next__(self) -> TrialTask:
        """The next task; StopIteration where none is known at present."""
        if not self._waiting:
            raise StopIteration
        task = self._waiting.popleft()
        self.store.forget(task.address)
        return task

    def evaluate(self, after: Callable[[Evaluation], None]) -> None:
        """Evaluate what is missing; `after` is called with each evaluation that has results, as they come."""
        jobs = jobs_of(self.study, [*self._limits.values()], self.store, self._o)
        for one in (each for each in self.evaluations if each.state == DONE):
            is_kept(self.store.folder)
            after(one)
        missing = sum(one.outcome is None for one in self.evaluations)
        if not missing:
            return
        limits = widest(self._limits.values())
        with workers_of(self._o, limits, jobs) as workers, listener().progress("trials", missing) as step:
            started, spent = time.perf_counter(), 0.0
            for task, outcome in outcomes(workers, self):
                if outcome.state == STOPPED:
                    line = f"{outcome.line}; finished trials stay: run it again when that is mended"
                    raise OSError(errno.EIO, line, str(task.store.folder))
                named = len(self._named)
                self._ended.clear()
                outcome = self._judged(self._at[task.address][0], outcome)
                self._became[task.address] = outcome
                self._end_all(task.address, outcome)
                if self._named[named:]:
                    self._consent(self._named[named:], said=True)
                spent += outcome.seconds
                if outcome.state == DONE:
                    is_kept(task.store.folder)
                for one in (self.evaluations[k] for k in self._ended):
                    step()
                    if one.state == DONE:
                        after(one)
            note("work", {"seconds": round(time.perf_counter() - started, 3), "workers": workers.threads()})
            note("one_by_one", {"seconds": round(spent, 3)})


def limits_of(settings: LimitSettings, o: CohortOptions) -> TrialLimits:
    """What each trial may take: by the call, else by the description."""
    memory = o.memory or settings.memory
    return TrialLimits(
        settings.time if o.limit is None else o.limit,
        None if memory is None else bytes_of(memory),
        o.cores or settings.cores,
    )


def jobs_of(study: StudyFile, limits: Sequence[TrialLimits], store: Store, o: CohortOptions) -> Jobs | None:
    """The jobs that are asked for; InputError where the description has none, or a step does not fit into them."""
    if not o.queueing:
        return None
    if study.cluster is None:
        raise InputError(study.path, "[cluster]", f"is missing, for {o.scheduler}", "add it: [cluster] jobs = 10")
    most = widest(limits)
    for each in limits:
        job_size(study.cluster, replace(each, cores=most.cores), study.path)
    return Jobs(o.scheduler, study.cluster, most, study.path, store.folder.parent)
