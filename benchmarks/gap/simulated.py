"""Trials simulated from a fitted model, all that the fit believes in with them: noise, deviations, noise of the inputs.

Nothing is linearised: parameters deviate inside the simulator, and noise of the inputs is added to what is written down
while the simulator moves without it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from scipy.signal import butter, filtfilt

from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.gap.case.problem import Noise, Problem
from geocontact.gap.case.refit import free
from geocontact.identify.signals.low_pass import BELOW_NYQUIST, LowPass


def same(system: System) -> System:
    """Nothing else loads the sensor."""
    return system


def trial_of(
    problem: Problem,
    noise: Noise,
    moved: Trial,
    system: System,
    values: Mapping[str, float],
    rng: np.random.Generator,
    staged: Callable[[System], System] = same,
) -> Trial:
    """One recording of a movement, by `system` at `values`, as `staged` turns it."""
    own = dict(values)
    movable = free(problem.system)  # placements, which come after these, stay
    for p, sd in zip(movable, noise.varies[: len(movable)], strict=True):
        own[p.name] = float(np.clip(own[p.name] + sd * rng.standard_normal(), p.lower, p.upper))
    outputs = staged(system).simulate(moved, own) + disturbed(noise, moved.time, rng)
    levels = zip(problem.system.inputs, noise.levels.inputs, strict=True)
    inputs = [moved.column(name) + sd * low_passed(problem.passed[name], len(moved), rng) for name, sd in levels]
    names = (*problem.system.inputs, *problem.system.outputs)
    units = tuple(problem.system.unit(name) for name in names)
    return replace(moved, signals=Signals(moved.time, np.column_stack([*inputs, outputs]), names, units))


def disturbed(noise: Noise, time: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """White noise and noise with a memory, of every channel."""
    levels, made = noise.levels, np.zeros((len(time), len(noise.levels.white)))
    for c, white in enumerate(levels.white):
        for coloured, memory in zip(levels.coloured[:, c], levels.memory[:, c], strict=True):
            state = rng.standard_normal()
            kept = np.exp(-np.diff(time, prepend=time[0]) / memory)
            for k, share in enumerate(kept):
                state = share * state + np.sqrt(1.0 - share**2) * rng.standard_normal()
                made[k, c] += coloured * state
        made[:, c] += white * rng.standard_normal(len(time))
    return made


def low_passed(passed: LowPass, count: int, rng: np.random.Generator) -> np.ndarray:
    """Noise of unit variance that came through a filter, if there was one."""
    nyquist = 0.5 / passed.step
    long = rng.standard_normal(count + 400)
    if passed.corner < nyquist:
        long = filtfilt(*butter(2, min(passed.corner, BELOW_NYQUIST * nyquist), fs=1.0 / passed.step), long)
    return np.asarray(long[200:-200] / long.std())


def case_of(
    case: GapCase, problem: Problem, noise: Noise, system: System, values: Mapping[str, float], seed: int
) -> GapCase:
    """The case with its trials recorded anew; samples that were not measured stay so."""
    rng = np.random.default_rng(seed)

    def anew(trial: Trial) -> Trial:
        made = trial_of(problem, noise, trial, system, values, rng)
        for c, name in enumerate((*problem.system.inputs, *problem.system.outputs)):
            made.signals.values[~np.isfinite(trial.column(name)), c] = np.nan
        return made

    calibration, evaluation = (tuple(map(anew, one.trials)) for one in (problem.calibration, problem.evaluation))
    return replace(case, calibration=calibration, evaluation=evaluation)
