r"""Studies: `geocontact cohort`, `gc.cohort`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> text = 'analysis = "fit"\noptions = { shape = "sphere", unit = "mm" }\n'
>>> text += 'sweep = { mesh = ["meshes/sphere_r18.stl", "meshes/sphere_r20.stl"] }\n'
>>> _ = Path("study.toml").write_text(text)
>>> print(gc.cohort("study.toml", workers=1))
2 of 2 trials of fit have results, 2 of them new
"""

from __future__ import annotations

import errno
import secrets
import shutil
import time
from collections.abc import Generator, Mapping
from contextlib import ExitStack, chdir, closing
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.catalogue import job_named
from geocontact.analyses.frame import source_digest
from geocontact.analyses.frame.collector import add_input, listener, note, reserve, results_place, say
from geocontact.analyses.frame.consent import ALLOWED, foreign, require_consent
from geocontact.analyses.frame.folder import Scratch, is_kept
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.main_numbers import factor_of
from geocontact.analyses.frame.options import declared
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.several import CONTRADICTS, doubt_columns, judge_several, reserve_of_several
from geocontact.analyses.frame.words import counted
from geocontact.analyses.motion.gait_cycles import cutting_of
from geocontact.analyses.motion.styles import Cutting, Trials, shifts_between
from geocontact.data.errors import InputError
from geocontact.data.trial import mean_and_sd
from geocontact.io.text.units import split_header
from geocontact.study.address import Digests, address_of, options_of
from geocontact.study.cluster import Jobs
from geocontact.study.curves import STEPS, StudyCurves, curves_of, require_summary
from geocontact.study.description import StudyFile, read_study_file
from geocontact.study.limits import Limits, LimitSettings, bytes_of
from geocontact.study.options import CohortOptions
from geocontact.study.show import study_curves, study_page
from geocontact.study.store import RESULTS, Store
from geocontact.study.surface import (
    SurfaceValues,
    surface_difference_table,
    surface_differences,
    surface_fields,
    surface_table,
    surface_values,
)
from geocontact.study.tables import (
    agreement_table,
    difference_table,
    differences_of,
    ensemble_table,
    latex,
    means_by_condition,
    outlier_table,
    value_table,
)
from geocontact.study.trial_run import DONE, FAILED, STOPPED, WRONG, TrialOutcome, TrialTask
from geocontact.study.trials import CohortTrial, trials_of
from geocontact.study.workers import outcomes, workers_of
from geocontact.view.surfaces.points_vtp import write_points_vtp

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

MANIFEST = "trials"
PRINTED = ("values", "agreement")
"""Tables that are written as LaTeX too."""
WRONG_CODE, FAILED_CODE = 2, 1
LEVEL = 0.05
LEAVE_OUT = "their numbers are in tables and means: mend them, or name them in `[[leave_out]]`"


@dataclass(frozen=True)
class PlannedStudy:
    """The description, and the trials that it comes to."""

    file: StudyFile
    trials: tuple[CohortTrial, ...]
    cutting: Cutting | None = None


def read(o: CohortOptions) -> PlannedStudy:
    """Description and trials; files of the trials are read by whoever evaluates them."""
    study = read_study_file(o.study)
    add_input("study", o.study, analysis=study.analysis)
    if study.table:
        add_input("table", o.study.parent / study.table)
    return PlannedStudy(study, tuple(trials_of(study)), cutting_of(o.events, o.cycle_side, o.part))


@dataclass(frozen=True)
class StudiedTrial:
    """A trial, the address of its results, and what became of it."""

    trial: CohortTrial
    address: str
    outcome: TrialOutcome


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class CohortResult(Result):
    """Results of all trials of a study.

    Parameters
    ----------
    planned
        The study as described.
    trials
        In the order of the description.
    store
        Where their results are.
    ensembles
        Of the columns that the summary is about.
    surface
        Distances at points that correspond, None where the study asks for none.
    scratch
        Holds the store where no folder was named.
    held
        Keeps other studies out of the folder until the tables are written.
    """

    planned: PlannedStudy
    trials: tuple[StudiedTrial, ...]
    store: Store
    ensembles: tuple[StudyCurves, ...]
    surface: SurfaceValues | None
    scratch: Scratch | None
    held: ExitStack

    @property
    def done(self) -> tuple[StudiedTrial, ...]:
        """Trials with results."""
        return tuple(one for one in self.trials if one.outcome.state == DONE)

    @property
    def accepted(self) -> bool:
        """False where a trial could not be evaluated."""
        return len(self.done) == len(self.trials)

    @property
    def exit_code(self) -> int:
        """1 where a trial failed or contradicts its data, 2 where none did but one had a mistake in its input.

        A trial whose inputs contradict each other beside its result has such a mistake.
        """
        states = {one.outcome.state for one in self.trials}
        for told in (self.store.told(one.address) for one in self.done):
            if told.get("fit") == CONTRADICTS:
                states.add(WRONG if told.get("inputs contradict") else FAILED)
        return 0 if states == {DONE} else WRONG_CODE if states <= {DONE, WRONG} else FAILED_CODE

    @property
    def means(self) -> dict[tuple[str, str], Float[np.ndarray, " 101"]]:
        """Mean over subjects at 0, 1, … 100 % of each curve, by quantity and condition [SI unit of the quantity]."""
        named = ((*split_header(one.column), one.groups) for one in self.ensembles)
        return {
            (name, condition): mean_and_sd(values)[0] * factor_of(unit)
            for name, unit, groups in named
            for condition, values in groups.items()
        }

    def tables(self) -> dict[str, pd.DataFrame]:
        """`trials`, a row for each with what became of it, then `ensemble` and other tables about all of them.

        The tables of all trials together are files: they may be larger than memory.
        """
        return dict(self._tables)

    @property
    def _trials(self) -> Trials:
        """Curves by quantity and condition, a row for each subject that has a whole one."""
        groups = {one.column: one.groups for one in self.ensembles}
        whole = {
            name: {each: rows[np.isfinite(rows).all(axis=1)] for each, rows in conditions.items()}
            for name, conditions in groups.items()
        }
        return {name: {each: rows for each, rows in own.items() if len(rows)} for name, own in whole.items()}

    @cached_property
    def _tables(self) -> dict[str, pd.DataFrame]:
        """The same, made once: tests of differences take their time."""
        found = {
            MANIFEST: self._manifest(),
            "ensemble": ensemble_table(self.ensembles),
            "values": value_table(self.ensembles),
            "differences": difference_table(self.ensembles),
            "agreement": agreement_table(self.ensembles),
            "outliers": outlier_table(self.ensembles),
        }
        if self.planned.cutting is not None:
            found["shifts"] = shifts_between(self._trials)
        if self.surface is not None:
            found["surface"] = surface_table(self.surface)
            found["surface_differences"] = surface_difference_table(self.surface)
        return {name: table for name, table in found.items() if name == MANIFEST or len(table)}

    def _manifest(self) -> pd.DataFrame:
        names = list(dict.fromkeys(name for one in self.trials for name in one.trial.factors))
        rows = [
            {
                "name": one.trial.name,
                **{name: one.trial.factors.get(name, "") for name in names},
                "state": one.outcome.state,
                "folder": f"{RESULTS}/{one.address}" if one.outcome.state == DONE else "",
                **doubt_columns(told.get("fit", ""), told.get("warnings", ())),
                "words": one.outcome.line,
            }
            for one in self.trials
            for told in [self.store.told(one.address) if one.outcome.state == DONE else {}]
        ]
        return pd.DataFrame(rows)

    @property
    def title(self) -> str:
        """Heading that the description has."""
        return self.planned.file.heading

    def curves(self) -> dict[str, CurveSheet]:
        """`ensemble`: mean curves, where a trial has a whole one."""
        drawn = study_curves(self.ensembles)
        return {"ensemble": drawn} if drawn.panels else {}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Mean curves, statistics, and all trials with a link to the page of each."""
        return {REPORT: study_page(self.title, self.ensembles, self.tables())}

    def write_files(self, folder: Path) -> None:
        """Also the tables of all trials together; then other studies may write into the folder."""
        with self.held:
            self._write_further(folder)
            super().write_files(folder)

    def _write_further(self, folder: Path) -> None:
        if self.scratch is not None:
            for one in self.done:
                shutil.copytree(self.store.place(one.address), folder / RESULTS / one.address, dirs_exist_ok=True)
        tables = self.tables()
        for name in (name for name in PRINTED if name in tables):
            (folder / f"{name}.tex").write_text(latex(tables[name]), encoding="utf-8")
        from geocontact.study.collect import collect  # with pyarrow, of the extra

        collect([(one.trial, one.address) for one in self.done], self.store, folder)
        if self.surface is not None:
            write_points_vtp(folder / "surface.vtp", self.surface.points, surface_fields(self.surface))


@dataclass(frozen=True)
class _Planned:
    """A trial, its address, "" where its options cannot be, and what is known of it before it runs."""

    trial: CohortTrial
    address: str
    known: TrialOutcome | None


def run(planned: PlannedStudy, o: CohortOptions) -> CohortResult:
    """Results of all trials that can be evaluated; InputError where none can be."""
    place = results_place()
    scratch = Scratch() if place is None else None
    out = place if place is not None else scratch.folder if scratch is not None else Path()
    store = Store(out.resolve() / RESULTS)
    with ExitStack() as held:  # until the tables are written, unless something goes wrong before
        held.enter_context(store.begun())
        plan = _plan(planned, store, o)
        if any(one.known is not None and one.known.state == DONE for one in plan):
            is_kept(store.folder)
        became = _evaluated(planned, plan, store, o)
        trials, curves, surface = _looked_at(planned, plan, became, store, o)
        kept = ExitStack() if scratch is not None else held.pop_all()
    return CohortResult(
        planned=planned,
        trials=trials,
        store=store,
        ensembles=curves,
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
) -> tuple[tuple[StudiedTrial, ...], tuple[StudyCurves, ...], SurfaceValues | None]:
    """What became of each trial, curves, a surface where there is one; what goes wrong and what differs is said."""
    trials = tuple(StudiedTrial(one.trial, one.address, became[k]) for k, one in enumerate(plan))
    for one in trials:
        if one.outcome.state != DONE:
            listener().fail(f"{one.trial.name}: {one.outcome.line}")
    done = [one for one in trials if one.outcome.state == DONE]
    if not done:
        raise InputError(o.study, "", f"none of the {len(trials)} trials could be evaluated", "see the lines above")
    new = len({one.address for one in trials if one.outcome.state == DONE} - {one.address for one in plan if one.known})
    note("trials", {"all": len(trials), "done": len(done)})
    all_of_them = f"{len(done)} of {counted(len(trials), 'trial')} of {planned.file.analysis}"
    say(f"{all_of_them} have results, {new} of them new")
    told = [(one.trial.name, store.told(one.address)) for one in done]
    judge_several([(name, each.get("fit", "")) for name, each in told], LEAVE_OUT)
    reserve_of_several([(name, each["warnings"]) for name, each in told])
    curves = curves_of(planned.file, [(one.trial, one.address) for one in done], store, planned.cutting)
    surface = surface_values(planned.file, [(one.trial, one.address) for one in done], store)
    for line in means_by_condition(curves):
        say(line)
    _report_conditions(curves)
    if surface is not None:
        _report_surface(surface)
    return trials, curves, surface


def _report_conditions(curves: tuple[StudyCurves, ...]) -> None:
    """What conditions differ in, and which trials lie apart."""
    for one, first, second, found in differences_of(curves):
        name = f"{split_header(one.column)[0]}, {first} against {second}"
        where = STEPS[found.p <= LEVEL]
        subjects = counted(found.subjects, "subject")
        if found.smallest > LEVEL:
            say(f"{name}: {subjects} cannot show a difference, the smallest p is {found.smallest:.2g}")
        elif len(where):
            say(f"{name}: p is at most 5 % at {len(where)} of 101 places, {where[0]:g} to {where[-1]:g} %")
        else:
            say(f"{name}: no difference shown by {subjects}, the smallest p is {found.p.min():.2g}")
    apart = outlier_table(curves)
    for name in dict.fromkeys(apart["name"]):
        reserve(f"{name} lies apart from the other trials of its condition")


def _report_surface(surface: SurfaceValues) -> None:
    """On how many points conditions differ."""
    for first, second, there, found in surface_differences(surface):
        name = f"distance at {len(surface.points)} particles, {first} against {second}"
        subjects = counted(found.subjects, "subject")
        if found.smallest > LEVEL:
            say(f"{name}: {subjects} cannot show a difference, the smallest p is {found.smallest:.2g}")
            continue
        shown = np.zeros(there.shape, bool)
        shown[there] = found.p <= LEVEL
        say(f"{name}: p is at most 5 % at {shown.any(axis=0).sum()} of them, by {subjects}")


def _plan(planned: PlannedStudy, store: Store, o: CohortOptions) -> list[_Planned]:
    """Every trial with its address; InputError where a file names what the call does not allow to be started."""
    analysis, home, file = planned.file.analysis, planned.file.home, planned.file.path
    own = [f"the module of {analysis!r}"] if foreign(analysis) else []
    require_consent(own, o.run_simulator, file)
    job, digests = job_named(analysis), Digests()
    allows = o.run_simulator and any(one.name == ALLOWED for one in declared(job.options))
    found, named = [], own
    for one in planned.trials:
        trial = replace(one, options={**one.options, ALLOWED: True}) if allows else one
        try:
            with chdir(home):
                options = options_of(job.options, trial.options)
                options.refuse_missing_files()
                named += options.programs()
            address = address_of(job.command, options, home, digests)
        except InputError as error:
            found.append(_Planned(trial, "", TrialOutcome(WRONG, str(error))))
            continue
        found.append(_Planned(trial, address, TrialOutcome(DONE) if store.holds(address, home, digests) else None))
    if line := require_consent(named, o.run_simulator, file):
        listener().fail(line)
    for each in found:
        if each.known is None:
            store.forget(each.address)
    return found


def _evaluated(planned: PlannedStudy, plan: list[_Planned], store: Store, o: CohortOptions) -> list[TrialOutcome]:
    """What became of each trial of the plan; only what is missing is evaluated."""
    limits = limits_of(planned.file.limits, o)
    jobs = _jobs(planned.file, limits, store, o)
    run_id, sources = secrets.token_hex(8), source_digest.digest()
    missing = {one.address: one.trial for one in plan if one.known is None}
    tasks = [
        TrialTask(planned.file.analysis, trial.options, planned.file.home, store, address, sources, run_id, limits)
        for address, trial in missing.items()
    ]
    alike = len({frozenset(one.trial.options) for one in plan}) == 1
    known = [(one.trial, one.address) for one in plan if one.known is not None and one.known.state == DONE]
    for one in known[:1]:
        require_summary(planned.file, one, store, alike=alike)
    became: dict[str, TrialOutcome] = {}
    with closing(_outcomes(tasks, o, limits, jobs)) as ended:
        for address, outcome in ended:
            became[address] = outcome
            if outcome.state == DONE and not known:
                known.append((missing[address], address))
                require_summary(planned.file, known[0], store, alike=alike)
    return [one.known or became[one.address] for one in plan]


def limits_of(settings: LimitSettings, o: CohortOptions) -> Limits:
    """What each trial may take: by the call, else by the description."""
    memory = o.memory or settings.memory
    return Limits(
        settings.time if o.limit is None else o.limit,
        None if memory is None else bytes_of(memory),
        o.cores or settings.cores,
    )


def _jobs(study: StudyFile, limits: Limits, store: Store, o: CohortOptions) -> Jobs | None:
    """The jobs that are asked for; InputError where the description has none."""
    if not o.queueing:
        return None
    if study.cluster is None:
        raise InputError(study.path, "[cluster]", f"is missing, for {o.scheduler}", "add it: [cluster] jobs = 10")
    return Jobs(o.scheduler, study.cluster, limits, study.path, store.folder.parent)


def _outcomes(
    tasks: list[TrialTask], o: CohortOptions, limits: Limits, jobs: Jobs | None
) -> Generator[tuple[str, TrialOutcome]]:
    if not tasks:
        return
    with workers_of(o, limits, jobs) as workers, listener().progress("trials", len(tasks)) as step:
        started, spent = time.perf_counter(), 0.0
        for task, outcome in outcomes(workers, tasks):
            if outcome.state == STOPPED:
                line = f"{outcome.line}; finished trials stay: run it again when that is mended"
                raise OSError(errno.EIO, line, str(task.store.folder))
            yield task.address, outcome
            spent += outcome.seconds
            if outcome.state == DONE:
                is_kept(task.store.folder)
            step()
        note("work", {"seconds": round(time.perf_counter() - started, 3), "workers": workers.threads()})
        note("one_by_one", {"seconds": round(spent, 3)})


cohort = Job("cohort", CohortOptions, read, run)
