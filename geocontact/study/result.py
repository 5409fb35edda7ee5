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

import shutil
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, results_place
from geocontact.analyses.frame.folder import Scratch
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.main_numbers import factor_of
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.several import CONTRADICTS, doubt_columns
from geocontact.analyses.motion.gait_cycles import cutting_of
from geocontact.analyses.motion.styles import Trials, shifts_between
from geocontact.data.errors import InputError
from geocontact.data.trial import mean_and_sd
from geocontact.io.text.units import split_header
from geocontact.study.curves import StudyCurves
from geocontact.study.description import read_study_file
from geocontact.study.graph import StepState, graph_picture, step_states
from geocontact.study.options import CohortOptions
from geocontact.study.plan import LEFT, PLANNED, WITHOUT, StudyPlan
from geocontact.study.selection import MANIFEST, asked_for, known_failures, refuse_odd
from geocontact.study.show import study_curves, study_page
from geocontact.study.steps import runs_of
from geocontact.study.store import RESULTS, Store
from geocontact.study.studied import PlannedStudy, StudiedTrial, checked, looked_at, say_copies, say_plan, studied
from geocontact.study.surface import (
    SurfaceValues,
    surface_difference_table,
    surface_fields,
    surface_table,
)
from geocontact.study.tables import (
    agreement_table,
    difference_table,
    ensemble_table,
    latex,
    outlier_table,
    value_table,
)
from geocontact.study.trial_run import DONE, FAILED, WRONG
from geocontact.view.surfaces.points_vtp import write_points_vtp

if TYPE_CHECKING:
    from geocontact.analyses.frame.table_forms import TableForms
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

TABLES = "tables"
"""Folder of the tables of all trials together, with steps a folder for each below it."""
PRINTED = ("values", "agreement")
"""Tables that are written as LaTeX too."""
WRONG_CODE, FAILED_CODE = 2, 1


def read(o: CohortOptions) -> PlannedStudy:
    """Description and trials; files of the trials are read by whoever evaluates them."""
    study = read_study_file(o.study, o.folder)
    add_input("study", o.study, analysis=study.analysis)
    if study.table:
        add_input("table", o.study.parent / study.table if o.folder is None else o.folder / study.table)
    for name, asked in (("from_step", o.from_step), ("forget", o.forget)):
        if asked is not None and asked not in study.all_steps:
            raise InputError(o.study, f"`{name}`", f"no step is {asked!r}", f"there are {', '.join(study.all_steps)}")
    runs = runs_of(study)
    if o.only:
        refuse_odd(study, o.only)
    return PlannedStudy(study, tuple(runs), cutting_of(o.events, o.cycle_side, o.part))


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class CohortResult(Result):
    """Results of all trials of a study.

    Parameters
    ----------
    planned
        The study as described.
    trials
        Of the analysis, in the order of the description.
    earlier
        Those of the steps before it.
    states
        Every step.
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
    dry
        Nothing was evaluated, and nothing is written.
    before
        State and words of what failed in earlier runs, by step and name.
    """

    planned: PlannedStudy
    trials: tuple[StudiedTrial, ...]
    earlier: tuple[StudiedTrial, ...]
    states: tuple[StepState, ...]
    dry: bool
    store: Store
    ensembles: tuple[StudyCurves, ...]
    surface: SurfaceValues | None
    scratch: Scratch | None
    held: ExitStack
    before: Mapping[tuple[str, str], tuple[str, str]] = field(default_factory=dict)

    @property
    def done(self) -> tuple[StudiedTrial, ...]:
        """Trials with results."""
        return tuple(one for one in self.trials if one.outcome.state == DONE)

    @property
    def every(self) -> tuple[StudiedTrial, ...]:
        """Trials of all steps."""
        return (*self.earlier, *self.trials)

    @property
    def accepted(self) -> bool:
        """False where a trial could not be evaluated."""
        return all(one.outcome.state in (DONE, LEFT, PLANNED) for one in self.every)

    @property
    def exit_code(self) -> int:
        """1 where a trial failed or contradicts its data, 2 where none did but one had a mistake in its input.

        A trial whose inputs contradict each other beside its result has such a mistake.
        """
        states = {one.outcome.state for one in self.every} - {DONE, LEFT, PLANNED, WITHOUT}
        for report in (self.store.report(one.address) for one in self.every if one.outcome.state == DONE):
            if report.get("fit") == CONTRADICTS:
                states.add(WRONG if report.get("inputs contradict") else FAILED)
        return 0 if not states else WRONG_CODE if states == {WRONG} else FAILED_CODE

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
        names += [name for one in self.earlier for name in one.trial.factors if name not in names]
        rows = [
            {
                **({"step": one.step} if self.earlier else {}),
                "name": one.trial.name,
                **{name: one.trial.factors.get(name, "") for name in names},
                "state": state,
                "folder": f"{RESULTS}/{one.address}" if one.outcome.state == DONE else "",
                **doubt_columns(report.get("fit", ""), report.get("warnings", ())),
                "words": words,
            }
            for one in self.every
            for state, words in [one.noted(self.before)]
            for report in [self.store.report(one.address) if one.outcome.state == DONE else {}]
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
        graph = [graph_picture(self.states)] if self.earlier else []
        return {REPORT: study_page(self.title, self.ensembles, self.tables(), graph, self.store.folder.parent)}

    def put(self, draft: Path, forms: TableForms | None = None) -> list[str]:
        """Nothing of a dry run: results of a run before it stay as they are."""
        return [] if self.dry else super().put(draft, forms)

    def write_files(self, folder: Path) -> None:
        """Also the tables of all trials together; then other studies may write into the folder."""
        with self.held:
            self._write_further(folder)
            super().write_files(folder)

    def _write_further(self, folder: Path) -> None:
        if self.scratch is not None:
            for one in (each for each in self.every if each.outcome.state == DONE):
                shutil.copytree(self.store.place(one.address), folder / RESULTS / one.address, dirs_exist_ok=True)
        tables = self.tables()
        for name in (name for name in PRINTED if name in tables):
            (folder / f"{name}.tex").write_text(latex(tables[name]), encoding="utf-8")
        from geocontact.study.collect import collect  # with pyarrow, of the extra

        for step in self.states:
            own = [one for one in self.every if one.step == step.name and one.outcome.state == DONE]
            place = folder / TABLES / step.name if self.earlier else folder / TABLES
            collect([(one.trial, one.address) for one in own], self.store, place)
        if self.surface is not None:
            write_points_vtp(folder / "surface.vtp", self.surface.points, surface_fields(self.surface))


def run(planned: PlannedStudy, o: CohortOptions) -> CohortResult:
    """Results of all trials that can be evaluated; InputError or OSError where none can be."""
    place = results_place()
    scratch = Scratch() if place is None else None
    out = place if place is not None else scratch.folder if scratch is not None else Path()
    store = Store(out.resolve() / RESULTS)
    plan = StudyPlan(planned.file, planned.runs, store, o, asked_for(planned.file, o, out))
    if o.dry_run:
        plan.look()
        say_copies(plan)
        return _dry(planned, plan, store, scratch)
    with ExitStack() as held:  # until the tables are written, unless something goes wrong before
        held.enter_context(store.begun())
        plan.look()
        say_copies(plan)
        plan.evaluate(checked(planned, plan, store))
        trials, curves, surface = looked_at(planned, plan, store, o)
        kept = ExitStack() if scratch is not None else held.pop_all()
    return CohortResult(
        planned=planned,
        trials=trials[1],
        earlier=trials[0],
        states=tuple(step_states(plan.evaluations, store)),
        dry=False,
        store=store,
        ensembles=curves,
        surface=surface,
        scratch=scratch,
        held=kept,
        before=known_failures(planned.file, out),
    )


def _dry(planned: PlannedStudy, plan: StudyPlan, store: Store, scratch: Scratch | None) -> CohortResult:
    """What a run would evaluate, in words and as a table."""
    states = step_states(plan.evaluations, store)
    say_plan(planned, plan, store, states)
    earlier, trials = studied(plan, planned.file.own_name)
    return CohortResult(
        planned=planned,
        trials=trials,
        earlier=earlier,
        states=tuple(states),
        dry=True,
        store=store,
        ensembles=(),
        surface=None,
        scratch=scratch,
        held=ExitStack(),
    )


cohort = Job("cohort", CohortOptions, read, run)
