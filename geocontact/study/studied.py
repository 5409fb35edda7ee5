"""Evaluated trials of a study: the requirements of the first, the sentences about all, the results that are kept."""

from __future__ import annotations

import errno
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.analyses.frame.several import judge_several, reserve_of_several
from geocontact.analyses.motion.styles import Cutting
from geocontact.data.errors import InputError
from geocontact.study.clean_up import clear, not_asked_for, note_asked, size_in_words
from geocontact.study.curves import StudyCurves, curves_of, require_summary
from geocontact.study.description import StudyFile
from geocontact.study.graph import StepState, in_words
from geocontact.study.options import CohortOptions
from geocontact.study.plan import LEFT, PLANNED, WITHOUT, Evaluation, StudyPlan
from geocontact.study.steps import StepRun
from geocontact.study.store import Store
from geocontact.study.surface import SurfaceValues, surface_values
from geocontact.study.tables import means_by_condition
from geocontact.study.trial_run import DONE, FAILED, SET_ASIDE, WRONG, TrialOutcome
from geocontact.study.trials import CohortTrial
from geocontact.study.words import say_differences, say_how_many, say_surface

LEAVE_OUT = "their numbers are in tables and means: mend them, or name them in `[[leave_out]]`"


@dataclass(frozen=True)
class PlannedStudy:
    """The description, and the evaluations that it comes to."""

    file: StudyFile
    runs: tuple[StepRun, ...]
    cutting: Cutting | None = None


@dataclass(frozen=True)
class StudiedTrial:
    """A trial of a step, the address of its results, and what became of it."""

    step: str
    trial: CohortTrial
    address: str
    outcome: TrialOutcome

    def called(self, *, step: bool) -> str:
        """Name of the trial, after that of its step where there are several."""
        return f"{self.step} of {self.trial.name}" if step else self.trial.name

    def noted(self, before: Mapping[tuple[str, str], tuple[str, str]]) -> tuple[str, str]:
        """State and words for the table; of one that is left as it is what it failed with in an earlier run."""
        now = self.outcome.state, self.outcome.line
        return before.get((self.step, self.trial.name), now) if self.outcome.state == LEFT else now


def checked(planned: PlannedStudy, plan: StudyPlan, store: Store) -> Callable[[Evaluation], None]:
    """What requires of the first trial with results that it has what the summary is about."""
    own = [one for one in plan.evaluations if one.run.step == planned.file.own_name]
    alike = len({frozenset(one.trial.options) for one in own}) == 1
    seen: list[str] = []

    def check(one: Evaluation) -> None:
        if not seen and one.run.step == planned.file.own_name:
            seen.append(one.address)
            require_summary(planned.file, (one.trial, one.address), store, alike=alike)

    return check


def studied(plan: StudyPlan, own: str) -> tuple[tuple[StudiedTrial, ...], tuple[StudiedTrial, ...]]:
    """Trials of the steps before the analysis, and its own."""
    every = [
        StudiedTrial(one.run.step, one.trial, one.address, one.outcome or TrialOutcome(PLANNED))
        for one in plan.evaluations
    ]
    return tuple(one for one in every if one.step != own), tuple(one for one in every if one.step == own)


def say_copies(plan: StudyPlan) -> None:
    """A warning for each trial whose inputs are a copy of another one's."""
    for words in plan.copies:
        reserve(f"{words}; name the files of each trial's own recording", cause=True)


def say_plan(planned: PlannedStudy, plan: StudyPlan, store: Store, states: Sequence[StepState]) -> None:
    """What a run would evaluate, in words."""
    for one in states:
        say(one.words)
    for each in (each for each in plan.evaluations if each.state in (WRONG, WITHOUT)):
        listener().fail(f"{each.run.step} of {each.trial.name}: {each.outcome.line if each.outcome else ''}")
    for each in (each for each in plan.evaluations if each.run.without):
        listener().fail(f"{each.run.step} of {each.trial.name}: {each.run.without_words}")
    times = [one.seconds for one in states if one.missing]
    if len(times) > 1 and None not in times:
        total = sum(one.missing * (one.seconds or 0.0) for one in states)
        say(f"all of it: about {in_words(total)} of work, shared by the workers")
    known = all(one.state == DONE for one in plan.evaluations)  # else some may still be those of later steps
    if known and (left := not_asked_for(store, planned.file, {one.address for one in plan.evaluations})):
        say(f"no description asks for {size_in_words(left.values())}; `clean_up` removes them")


def looked_at(
    planned: PlannedStudy, plan: StudyPlan, store: Store, o: CohortOptions
) -> tuple[tuple[tuple[StudiedTrial, ...], tuple[StudiedTrial, ...]], tuple[StudyCurves, ...], SurfaceValues | None]:
    """What became of each trial, curves, a surface where there is one; what goes wrong and what differs is said."""
    earlier, trials = studied(plan, planned.file.own_name)
    for one in (*earlier, *trials):
        if one.outcome.state not in (DONE, LEFT, WITHOUT):
            listener().fail(f"{one.called(step=bool(earlier))}: {one.outcome.line}")
    for each in plan.evaluations:
        if each.run.missing(planned.file.home) is not None and each.outcome is not None:
            reserve(f"{each.run.step} of {each.trial.name} is left out: {each.outcome.line}")
        if each.run.without:
            reserve(f"{each.run.step} of {each.trial.name} is evaluated {each.run.without_words}")
    done = [one for one in trials if one.outcome.state == DONE]
    if not any(one.outcome.state == DONE for one in (*earlier, *trials)):
        _refuse_none(o.study, [one.outcome.state for one in (*earlier, *trials)])
    note("trials", {"all": len(trials), "done": len(done)})
    say_how_many(plan.evaluations)
    _clean(planned, plan, store, o)
    entries = [
        (one.called(step=bool(earlier)), store.report(one.address))
        for one in (*earlier, *trials)
        if one.outcome.state == DONE
    ]
    judge_several([(name, each.get("fit", "")) for name, each in entries], LEAVE_OUT)
    reserve_of_several([(name, each["warnings"]) for name, each in entries])
    kept = [(one.trial, one.address) for one in done]
    curves = curves_of(planned.file, kept, store, planned.cutting) if kept else ()
    surface = surface_values(planned.file, kept, store)
    for line in means_by_condition(curves):
        say(line)
    say_differences(curves)
    if surface is not None:
        say_surface(surface)
    return (earlier, trials), curves, surface


def _refuse_none(study: Path, states: Sequence[str]) -> NoReturn:
    """InputError where no trial has results by mistakes in their input; OSError where one failed or was ended."""
    what, remedy = f"none of the {len(states)} trials could be evaluated", "see the lines above"
    if {*states} & {FAILED, SET_ASIDE}:
        raise OSError(errno.EIO, f"{what}; {remedy}", str(study))
    raise InputError(study, "", what, remedy)


def _clean(planned: PlannedStudy, plan: StudyPlan, store: Store, o: CohortOptions) -> None:
    """Keep what the description asks for; remove what none does, where that is asked."""
    addresses = {one.address for one in plan.evaluations}
    note_asked(store, planned.file, addresses)
    if not o.clean_up:
        return
    if any(one.state != DONE for one in plan.evaluations):
        reserve("nothing was removed: evaluations without results may still need what is there")
        return
    removed = clear(store, planned.file, addresses)
    say(f"removed what no description asks for: {size_in_words(removed.values())}")
