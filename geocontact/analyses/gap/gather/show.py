"""The page of a gathered case: every channel of its trials over time."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted
from geocontact.analyses.gap.case import OTHER, SAMPLES
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.view.page.content import Curve, Curves, Page, Section, Table, Words


def gather_page(title: str, case: GapCase) -> Page:
    """Every channel over time, each trial from its own beginning."""
    trials = [*case.calibration, *case.evaluation]
    longest = max(each.time[-1] - each.time[0] for each in trials)
    time = np.linspace(0.0, float(longest), SAMPLES)
    sections: list[Section] = [*_panels(trials, time), _case_table(case)]
    sections += [INPUTS, OPTIONS, Words("What this is", [NOT_A_DEVICE])]
    return Page(
        title=title,
        subtitle=f"Case for a gap diagnosis of the base model {case.system}",
        time=time,
        time_label="time from the trial's beginning [s]",
        headline=answer(case),
        facts=[
            ("To fit to", ", ".join(each.name for each in case.calibration)),
            ("Held out", ", ".join(each.name for each in case.evaluation) or "none"),
            *((f"Cells of {site}", f"{len(own.ids)}") for site, own in case.cells.items()),
        ][:5],
        sections=tuple(sections),
        plays=False,
    )


def answer(case: GapCase) -> list[str]:
    """How many trials there are with how much in them, and how much of it is missing."""
    trials = [*case.calibration, *case.evaluation]
    channels = trials[0].signals.channels
    seconds = sum(float(each.time[-1] - each.time[0]) for each in trials)
    told = (
        f"{counted(len(trials), 'trial')} with {counted(len(channels), 'channel')} and {seconds:.3g} s in all: "
        f"{len(case.calibration)} to fit to, {len(case.evaluation)} held out."
    )
    gaps = {
        name: share
        for name in channels
        if (share := float(np.mean(np.concatenate([~np.isfinite(each.column(name)) for each in trials])))) > 0.0
    }
    if not gaps:
        return [told, "Every channel is there in every sample."]
    worst = max(gaps, key=lambda name: gaps[name])
    return [told, f"{counted(len(gaps), 'channel')} have gaps; {worst} is missing in {gaps[worst]:.1%} of the samples."]


def _panels(trials: list[Trial], time: Float[np.ndarray, " s"]) -> list[Curves]:
    """A panel for each channel, a curve for each trial; outputs, which come last, first."""
    first = trials[0].signals
    panels = []
    for name, si in reversed(list(zip(first.channels, first.units, strict=True))):
        unit, per = OTHER.get(si, (si, 1.0))
        curves = [Curve(each.name, per * _along(each, name, time)) for each in trials]
        panels.append(Curves(name, unit, curves))
    return panels


def _along(trial: Trial, name: str, time: Float[np.ndarray, " s"]) -> Float[np.ndarray, " s"]:
    """The channel at these times from the trial's beginning; NaN after its end and in its gaps."""
    return np.asarray(np.interp(time, trial.time - trial.time[0], trial.column(name), right=np.nan))


def _case_table(case: GapCase) -> Table:
    rows = [
        (each.name, use, f"{len(each.time)}", f"{each.time[-1] - each.time[0]:.4g}")
        for use, trials in (("to fit to", case.calibration), ("held out", case.evaluation))
        for each in trials
    ]
    return Table("Trials", ("trial", "use", "samples", "seconds"), rows)
