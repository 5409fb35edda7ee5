"""Evaluate what is missing of a study, and tell what became of every trial."""

from __future__ import annotations

import errno
import secrets
import time
from collections.abc import Iterator
from contextlib import ExitStack, chdir
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geocontact.analyses import source_digest
from geocontact.analyses.catalogue import job_named
from geocontact.analyses.page_words import counted
from geocontact.analyses.results_folder import Scratch, is_kept
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.io.text.units import split_header
from geocontact.study.address import Digests, address_of, options_of
from geocontact.study.cluster import workers_of
from geocontact.study.curves import STEPS, StudyCurves, curves_of
from geocontact.study.description.trials import CohortTrial
from geocontact.study.dispatch import outcomes
from geocontact.study.options import CohortOptions
from geocontact.study.read import PlannedStudy
from geocontact.study.result import CohortResult, StudiedTrial
from geocontact.study.store import RESULTS, Store
from geocontact.study.surface.tables import surface_differences
from geocontact.study.surface.values import SurfaceValues, surface_values
from geocontact.study.tables import differences_of, outlier_table
from geocontact.study.trial_run import DONE, STOPPED, WRONG, TrialOutcome, TrialTask

LEVEL = 0.05


@dataclass(frozen=True)
class _Planned:
    """A trial, its address, "" where its options cannot be, and what is known of it before it runs."""

    trial: CohortTrial
    address: str
    known: TrialOutcome | None


def run(planned: PlannedStudy, o: CohortOptions, record: Record) -> CohortResult:
    """Results of all trials that can be evaluated; InputError where none can be."""
    scratch = None if record.out is not None else Scratch()
    out = record.out if record.out is not None else scratch.folder if scratch is not None else Path()
    store = Store(out.resolve() / RESULTS)
    with ExitStack() as held:  # until the tables are written, unless something goes wrong before
        held.enter_context(store.begun())
        plan = _plan(planned, store)
        if any(one.known is not None and one.known.state == DONE for one in plan):
            is_kept(store.folder)
        became = _evaluated(planned, plan, store, o, record)
        trials, curves, surface = _looked_at(planned, plan, became, store, o, record)
        kept = ExitStack() if scratch is not None else held.pop_all()
    return CohortResult(
        record=record,
        planned=planned,
        trials=trials,
        store=store,
        curves=curves,
        surface=surface,
        scratch=scratch,
        held=kept,
    )


def _looked_at(
    planned: PlannedStudy,
    plan: list[_Planned],
    became: list[TrialOutcome],
    store: Store,
    o: CohortOptions,
    record: Record,
) -> tuple[tuple[StudiedTrial, ...], tuple[StudyCurves, ...], SurfaceValues | None]:
    """What became of each trial, curves, a surface where there is one; what goes wrong and what differs is said."""
    trials = tuple(StudiedTrial(one.trial, one.address, became[k]) for k, one in enumerate(plan))
    for one in trials:
        if one.outcome.state != DONE:
            record.listener.fail(f"{one.trial.name}: {one.outcome.line}")
    done = [one for one in trials if one.outcome.state == DONE]
    if not done:
        raise InputError(o.study, "", f"none of the {len(trials)} trials could be evaluated", "see the lines above")
    new = sum(one.known is None for one in plan)
    record.results["trials"] = {"all": len(trials), "done": len(done)}
    all_of_them = f"{len(done)} of {counted(len(trials), 'trial')} of {planned.file.analysis}"
    record.say(f"{all_of_them} have results, {new} of them new")
    curves = curves_of(planned.file, [(one.trial, one.address) for one in done], store)
    surface = surface_values(planned.file, [(one.trial, one.address) for one in done], store)
    _say(curves, record)
    if surface is not None:
        _say_surface(surface, record)
    return trials, curves, surface


def _say(curves: tuple[StudyCurves, ...], record: Record) -> None:
    """What conditions differ in, and which trials lie apart."""
    for one, first, second, found in differences_of(curves):
        name = f"{split_header(one.column)[0]}, {first} against {second}"
        where = STEPS[found.p <= LEVEL]
        subjects = counted(found.subjects, "subject")
        if found.smallest > LEVEL:
            record.say(f"{name}: {subjects} cannot show a difference, the smallest p is {found.smallest:.2g}")
        elif len(where):
            record.say(f"{name}: p is at most 5 % at {len(where)} of 101 places, {where[0]:g} to {where[-1]:g} %")
        else:
            record.say(f"{name}: no difference shown by {subjects}, the smallest p is {found.p.min():.2g}")
    apart = outlier_table(curves)
    for name in dict.fromkeys(apart["name"]):
        record.warn(f"{name} lies apart from the other trials of its condition")


def _say_surface(surface: SurfaceValues, record: Record) -> None:
    """On how many points conditions differ."""
    for first, second, there, found in surface_differences(surface):
        name = f"distance at {len(surface.points)} particles, {first} against {second}"
        subjects = counted(found.subjects, "subject")
        if found.smallest > LEVEL:
            record.say(f"{name}: {subjects} cannot show a difference, the smallest p is {found.smallest:.2g}")
            continue
        shown = np.zeros(there.shape, bool)
        shown[there] = found.p <= LEVEL
        record.say(f"{name}: p is at most 5 % at {shown.any(axis=0).sum()} of them, by {subjects}")


def _plan(planned: PlannedStudy, store: Store) -> list[_Planned]:
    job, digests, home = job_named(planned.file.analysis), Digests(), planned.file.home
    found = []
    for trial in planned.trials:
        try:
            with chdir(home):
                options = options_of(job.options, trial.options)
                options.refuse_missing_files()
            address = address_of(job.command, options, home, digests)
        except InputError as error:
            found.append(_Planned(trial, "", TrialOutcome(WRONG, str(error))))
            continue
        there = store.holds(address, home, digests)
        if not there:
            store.forget(address)
        found.append(_Planned(trial, address, TrialOutcome(DONE) if there else None))
    return found


def _evaluated(
    planned: PlannedStudy, plan: list[_Planned], store: Store, o: CohortOptions, record: Record
) -> list[TrialOutcome]:
    """What became of each trial of the plan; only what is missing is evaluated."""
    run_id, sources = secrets.token_hex(8), source_digest.digest()
    missing = {one.address: one.trial for one in plan if one.known is None}
    tasks = [
        TrialTask(planned.file.analysis, trial.options, planned.file.home, store, address, sources, run_id)
        for address, trial in missing.items()
    ]
    became = dict(_outcomes(tasks, o, record))
    return [one.known or became[one.address] for one in plan]


def _outcomes(tasks: list[TrialTask], o: CohortOptions, record: Record) -> Iterator[tuple[str, TrialOutcome]]:
    if not tasks:
        return
    with workers_of(o) as client, record.listener.progress("trials", len(tasks)) as step:
        started, spent = time.perf_counter(), 0.0
        for task, outcome in outcomes(client, tasks):
            if outcome.state == STOPPED:
                line = f"{outcome.line}; what is done is kept: run it again when that is mended"
                raise OSError(errno.EIO, line, str(task.store.folder))
            yield task.address, outcome
            spent += outcome.seconds
            if outcome.state == DONE:
                is_kept(task.store.folder)
            step()
        record.results["work"] = {"seconds": round(time.perf_counter() - started, 3), "workers": _count(client)}
        record.results["one_by_one"] = {"seconds": round(spent, 3)}


def _count(client: Any) -> int:
    """Threads of all workers."""
    return int(sum(client.nthreads().values()))
