"""The next experiment as a sheet for the laboratory, protocol.md, and the course of its inputs, protocol.csv."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from geocontact.analyses.frame.words import NOT_A_DEVICE
from geocontact.analyses.gap.case import names, percent
from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.experiment.menu import Experiment, band
from geocontact.gap.experiment.proposal import TRIALS, Proposal
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.io.cases.gap_case_writer import trial_table

FITTED = 2
"""New trials that are to be fitted to; the others are held out."""


def protocol_text(case: GapCase, found: Discriminability) -> str:
    """The sheet: what for, what to do, how fast, how long, what to record, what then."""
    return "\n".join(_lines(case, found)) + "\n"


def protocol_table(found: Discriminability) -> pd.DataFrame | None:
    """Time and inputs of one of its trials, SI units; None where nothing is proposed."""
    return None if found.planned is None else trial_table(found.planned.experiment.trial)


def _lines(case: GapCase, found: Discriminability) -> Iterator[str]:
    yield f"# Next trials of {case.name}"
    yield ""
    if found.planned is None:
        yield from _nothing(found)
        return
    one, system = found.planned, found.found.clean.system
    yield from _purpose(one, found.found.answer.verdict)
    yield ""
    yield "## What to do"
    yield ""
    yield f"- {one.said.change[0].upper()}{one.said.change[1:]}."
    yield "- Leave everything else as it was: sensors, their zeros, straps, subject and device."
    yield "- Take the device off and on between trials if that was done before, else not."
    yield ""
    yield "## How long and how fast"
    yield ""
    yield from _course(one.experiment, system)
    yield ""
    yield "## What to record"
    yield ""
    yield from _channels(case, system)
    yield ""
    yield "## What then"
    yield ""
    yield from _afterwards(case, one, system)
    yield ""
    yield NOT_A_DEVICE


def _nothing(found: Discriminability) -> Iterator[str]:
    if found.found.answer.verdict == "no_gap":
        yield "Nothing is missing, and no change of the trials on the list makes visible what base parameters imitate."
    else:
        yield "No change of the trials on the list separates the remaining explanations clearly enough."
    yield "The list: faster, slower, in steps with holds, half as large, nothing or a known weight on the sensor,"
    yield "sensors exchanged, another setting."


def _purpose(one: Proposal, verdict: str) -> Iterator[str]:
    some = names(one.said.separates)
    if verdict == "no_gap":
        yield f"These trials cannot show {some}: refitted base parameters imitate it. The next ones would,"
        yield f"by {one.said.gain_nats:g} nats more."
        return
    yield f"In question: {some}. The next trials would separate them by {one.said.gain_nats:g} nats more."
    if one.said.share is not None:
        yield f"If it is one of them, that rules out the others in {percent(one.said.share)} of 100 repetitions."


def _course(one: Experiment, system: System) -> Iterator[str]:
    trial = one.trial
    length, step = float(trial.time[-1] - trial.time[0]), float(np.median(np.diff(trial.time)))
    yield f"- {TRIALS} trials of {length:.3g} s, at {1.0 / step:.4g} Hz or more ({len(trial)} samples each)."
    if not _moves(trial, system):
        yield "- At rest throughout: begin to record after the load or the open interface has settled."
        return
    most, low, high = band(system, trial)
    yield f"- {most} sets the pace: nine tenths of its speed lie between {low:.2g} and {high:.2g} Hz."
    movement = recorded(trial.signals, system.inputs, system.motion.reach)
    for name in system.inputs:
        row, unit = movement.row(name), system.unit(name)
        values, speed = movement.position[row], float(np.abs(movement.rate[row]).max())
        fastest = f", fastest {speed:.3g} {unit}/s" if speed > 0.0 else ""
        yield f"- {name}: {values.min():.3g} to {values.max():.3g} {unit}{fastest}."
    yield "- protocol.csv has the course of one trial; a metronome or a line on a screen helps to follow it."


def _moves(trial: Trial, system: System) -> bool:
    return any(float(np.ptp(trial.column(name))) > 0.0 for name in system.inputs)


def _channels(case: GapCase, system: System) -> Iterator[str]:
    inputs, outputs = (", ".join(f"{name} [{system.unit(name)}]" for name in side) for side in _sides(system))
    yield f"- Movement: {inputs}."
    yield f"- Measured: {outputs}."
    for name, sd in case.noise.items():
        if name in system.outputs:
            yield f"- Noise of {name}: {sd:.3g} {system.unit(name)} or less (standard deviation, as in case.toml)."
    yield "- One clock for all of them; write down what went wrong in a trial and keep it."


def _sides(system: System) -> tuple[tuple[str, ...], tuple[str, ...]]:
    return system.inputs, system.outputs


def _afterwards(case: GapCase, one: Proposal, system: System) -> Iterator[str]:
    if one.experiment.staged(system) is not system:
        yield "- These are no trials of the model: they say directly what the sensors show under a known load. Correct"
        yield "  the recordings or fix the parameter by them, then diagnose again."
        return
    held = TRIALS - FITTED
    yield f"- Copy them into trials/; list {FITTED} under calibration and {held} under evaluation in case.toml."
    yield f"- geocontact gap diagnose {case.name}"
