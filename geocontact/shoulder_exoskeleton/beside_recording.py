"""A simulated arm beside logger and mat: errors of each channel over the whole trial, over the work and by phase."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from jaxtyping import Bool, Float

from geocontact.identify.signals.agreement import Agreement, agreement, over_stretches
from geocontact.identify.signals.filters import at_times, even_times
from geocontact.shoulder_exoskeleton.device import JOINTS
from geocontact.shoulder_exoskeleton.work_phases import PHASES

ELEVATION, FORCE = "elevation", "force"
PASSIVE = JOINTS[:2]
"""Channels of the passive joints' angles."""
NORMAL, SHEAR, ALONG, AROUND = "normal", "shear", "shear_along", "shear_around"
TANGENTIAL = (SHEAR, ALONG, AROUND)
"""Channels of a two-axis mat or of load cells in a strap: size of the shear on the arm, its part along the cuff,
positive towards the hand, and around it, positive from medial towards raising."""
FORCES = (FORCE, NORMAL, *TANGENTIAL)
RECORDED = (ELEVATION, FORCE, *PASSIVE, NORMAL, *TANGENTIAL)
"""Channels that are recorded: elevation of the exoskeleton's arm, force of a mat in its cuff, angles of the passive
joints, sum of the pressures on the cuff's wall, shear."""
ALL, WORK = "all", "work"
"""The whole trial; from the beginning of lifting to the end of lowering, as the study of the exoskeleton takes it."""
FEWEST = 2
"""Samples that must have been recorded."""


@dataclass(frozen=True, eq=False)
class Channels:
    """Channels over a clock of their own [rad, N]."""

    time: Float[np.ndarray, " t"]
    curves: Mapping[str, Float[np.ndarray, " t"]]


def phase_errors(
    model: Float[np.ndarray, " t"],
    measured: Float[np.ndarray, " t"],
    step: float,
    phase: np.ndarray,
    inside: Bool[np.ndarray, " t"],
) -> dict[str, Agreement]:
    """Agreement by part: `ALL`, `WORK`, and each phase that there is.

    Parameters
    ----------
    step
        Between samples [s].
    phase
        Word of each sample, of `PHASES`.
    inside
        Samples that were recorded.
    """
    parts = {ALL: inside, WORK: inside & (phase != PHASES[0])} | {name: inside & (phase == name) for name in PHASES[1:]}
    return {name: _agreement(model, measured, step, part) for name, part in parts.items() if part.any()}


def _agreement(model: np.ndarray, measured: np.ndarray, step: float, part: Bool[np.ndarray, " t"]) -> Agreement:
    if part.all():
        return agreement(model, measured, step)
    runs = [[i for i, _ in group] for inside, group in groupby(enumerate(part), lambda pair: bool(pair[1])) if inside]
    return over_stretches(model, measured, step, [(run[0], run[-1] + 1) for run in runs])


@dataclass(frozen=True, eq=False)
class ComparedChannel:
    """One channel at the simulation's even times [s; rad or N], and errors by phase.

    Parameters
    ----------
    measured
        NaN where nothing was recorded.
    errors
        By part of the trial (`phase_errors`).
    """

    channel: str
    time: Float[np.ndarray, " t"]
    model: Float[np.ndarray, " t"]
    measured: Float[np.ndarray, " t"]
    errors: Mapping[str, Agreement]


@dataclass(frozen=True, eq=False)
class BesideRecording:
    """Channels by the names of the models, and the share of the simulated time that was recorded.

    No channels where fewer than `FEWEST` samples were recorded.
    """

    channels: Mapping[str, ComparedChannel]
    share: float


def beside_recording(
    time: Float[np.ndarray, " s"],
    models: Mapping[str, tuple[str, Float[np.ndarray, " s"]]],
    phase: Sequence[str],
    recorded: Channels,
) -> BesideRecording:
    """Models beside what was recorded, at even times of the simulation; those whose channel was recorded.

    Parameters
    ----------
    time
        Of the simulation [s].
    models
        By name the recorded channel that a simulated curve is compared with, and the curve [rad or N].
    phase
        Word of each sample of the simulation, of `PHASES`.
    """
    even, step = even_times(time)
    inside = (even >= recorded.time[0] - 1e-9) & (even <= recorded.time[-1] + 1e-9)
    share = float(inside.mean())
    if inside.sum() < FEWEST:
        return BesideRecording({}, share)
    words = np.array(phase)
    if even is not time:
        words = words[np.searchsorted(0.5 * (time[1:] + time[:-1]), even)]
    _, recorded_step = even_times(recorded.time)
    channels = {}
    for name, (channel, curve) in models.items():
        if channel in recorded.curves:
            measured = at_times(recorded.time, recorded.curves[channel], even, recorded_step)
            model = at_times(time, curve, even, step)
            errors = phase_errors(model, measured, step, words, inside)
            channels[name] = ComparedChannel(channel, even, model, np.where(inside, measured, np.nan), errors)
    return BesideRecording(channels, share)
