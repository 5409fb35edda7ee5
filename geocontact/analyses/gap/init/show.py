"""The page of a case that is begun: what was measured beside what the simulator gives, and what is open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted
from geocontact.analyses.gap.case import OTHER, SAMPLES
from geocontact.analyses.gap.init.first_run import UNKNOWN, FirstRun
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.view.curves.declared import INK
from geocontact.view.page.content import Curve, Curves, Page, Section, Table, Words

SHOWN = 4
"""Trials that are drawn, those to fit to first."""


def init_page(
    title: str, case: GapCase, run: FirstRun, questions: Sequence[str], errors: Mapping[str, Mapping[str, float]]
) -> Page:
    """Curves of the first trials, root mean square errors of all, questions."""
    trials = [*case.calibration, *case.evaluation]
    shown = trials[:SHOWN]
    longest = max(float(each.time[-1] - each.time[0]) for each in shown)
    time = np.linspace(0.0, longest, SAMPLES)
    sections: list[Section] = [] if run.unknown else [_panel(one, c, run, time) for one in shown for c in _columns(run)]
    if questions:
        sections.append(Words("Open questions", [f"{each[0].upper()}{each[1:]}." for each in questions]))
    if not run.unknown:
        sections.append(_error_table(trials, run, errors))
    sections += [INPUTS, OPTIONS, Words("What this is", [WORDS, NOT_A_DEVICE])]
    return Page(
        title=title,
        subtitle="Measured beside simulated before anything is fitted or diagnosed",
        time=time,
        time_label="time from the trial's beginning [s]",
        headline=headline(run, questions, errors),
        facts=[
            ("To fit to", ", ".join(each.name for each in case.calibration)),
            ("Held out", ", ".join(each.name for each in case.evaluation)),
            ("Longest call", f"less than {run.seconds:g} s"),
            ("Open questions", str(len(questions))),
        ],
        sections=tuple(sections),
        plays=False,
    )


WORDS = (
    "Simulated curves are those of the start values: a difference shows that start values, units, signs or the model "
    "are wrong, and not which. `geocontact gap diagnose` fits the parameters first."
)


def headline(run: FirstRun, questions: Sequence[str], errors: Mapping[str, Mapping[str, float]]) -> list[str]:
    """How far measured and simulated are apart, and how much is open."""
    still = f"{counted(len(questions), 'question')} open in case.toml."
    if run.unknown:
        names = ", ".join(run.unknown)
        return [f"The simulator runs; {names} {_are(run.unknown)} not known, so no curve is compared.", still]
    worst = max(errors, key=lambda name: sum(errors[name].values()))
    sizes = ", ".join(f"{value:.3g} {run.system.unit(name)} in {name}" for name, value in errors[worst].items())
    return [f"At the start values the simulator misses the trials by up to {sizes} (root mean square, {worst}).", still]


def _are(names: Sequence[str]) -> str:
    return f"{'are' if len(names) > 1 else 'is'} called with {UNKNOWN:g} and"


def _columns(run: FirstRun) -> range:
    return range(len(run.system.outputs))


def _panel(trial: Trial, column: int, run: FirstRun, time: Float[np.ndarray, " s"]) -> Curves:
    """One output of one trial, measured and simulated."""
    name = run.system.outputs[column]
    si = trial.signals.units[trial.signals.channels.index(name)]
    unit, per = OTHER.get(si, (si, 1.0))
    own = trial.time - trial.time[0]
    both = (trial.column(name), run.simulated[trial.name][:, column])
    measured, simulated = (per * np.interp(time, own, each, right=np.nan) for each in both)
    curves = [Curve("measured", measured, stroke=INK), Curve("simulated", simulated, stroke=0)]
    return Curves(f"{name}, {trial.name}", unit, curves)


def _error_table(trials: Sequence[Trial], run: FirstRun, errors: Mapping[str, Mapping[str, float]]) -> Table:
    header = ("trial", *(f"{name} [{run.system.unit(name)}]" for name in run.system.outputs))
    rows = [(one.name, *(f"{errors[one.name][name]:.3g}" for name in run.system.outputs)) for one in trials]
    return Table("Measured minus simulated at the start values, root mean square", header, rows)
