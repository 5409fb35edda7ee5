"""How loud what a model misses is: in frequency bands over whole trials, and what is fast over the phase.

A mean over a bin does not see what swings inside it, and an energy over a whole trial hardly sees a burst. So there is
a map of energies beside that of means (`gap.locate`): in bands, and above `FAST` in each part of the phase. Both are
compared with energies of noise drawn from the fitted levels; the largest over all channels, bands and phases of each
draw makes the p-values hold for the family of all of them.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from jaxtyping import Float

from geocontact.gap.evidence import Judged
from geocontact.gap.map_cell import Cell, shares
from geocontact.gap.problem import Problem

DRAWS = 200
BANDS = (0.0, 1.0, 5.0, np.inf)  # Hz
FAST = 5.0  # Hz, above which the map over the phase looks
PHASES = 20
BAND, FAST_PHASE = "band", "fast phase"
"""Axes of its cells: frequency [Hz], and the phase of the trial for what is faster than `FAST`."""


def frequency_map(problem: Problem, base: Judged, residuals: list[Float[np.ndarray, "_ c"]]) -> list[Cell]:
    """Energy of every channel's residual in each band, and above `FAST` in each part of the phase, all trials.

    `residuals` are those of `base` without what trials deviate by. `share` is of what exceeds noise along the axis, its
    interval from trials drawn anew.
    """
    trials = problem.calibration.trials + problem.evaluation.trials
    channels = problem.system.outputs
    each = np.array([energies(t.time, r) for t, r in zip(trials, residuals, strict=True)])
    seen = each.mean(axis=0)
    rng = np.random.default_rng(0)
    drawn = np.zeros((DRAWS, *seen.shape))
    for trial, whitener, residual in zip(trials, base.noise.whiteners, residuals, strict=True):
        rows = np.concatenate(whitener.rows)
        for k in range(DRAWS):
            flat = np.zeros(residual.size)
            flat[rows] = whitener.coloured(rng.standard_normal(len(rows)))
            drawn[k] += energies(trial.time, flat.reshape(residual.shape)) / len(trials)
    middle, spread = drawn.mean(axis=0), np.maximum(drawn.std(axis=0), 1e-300)
    largest = ((drawn - middle) / spread).max(axis=(1, 2))
    score = (seen - middle) / spread
    again = each[rng.integers(len(trials), size=(DRAWS, len(trials)))].mean(axis=1)
    bands = list(pairwise(BANDS))
    parts = [(k / PHASES, (k + 1) / PHASES) for k in range(PHASES)]
    cells = []
    for c, name in enumerate(channels):
        for axis, edges, own in ((BAND, bands, slice(len(bands))), (FAST_PHASE, parts, slice(len(bands), None))):
            excess = np.maximum(seen[c, own] - middle[c, own], 0.0)
            some = np.array([shares(np.maximum(one - middle[c, own], 0.0)) for one in again[:, c, own]])
            low, high = np.quantile(some, [0.025, 0.975], axis=0)
            share = shares(excess)
            floor = 1.0 - float(excess.sum()) / max(float(seen[c, own].sum()), 1e-300)
            for b, (begin, end) in enumerate(edges):
                p = (1.0 + float((largest >= score[c, own][b]).sum())) / (1.0 + DRAWS)
                size, interval = float(seen[c, own][b] ** 0.5), (float(low[b]), float(high[b]))
                cells.append(Cell(name, axis, begin, end, size, float(share[b]), p, interval, floor))
    return cells


def energies(time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "c m"]:
    """Mean square of every channel in every band, then above `FAST` in every part of the phase.

    Missing samples count as 0.
    """
    step = (time[-1] - time[0]) / (len(time) - 1)
    spectrum = np.fft.rfft(np.nan_to_num(values), axis=0)
    frequency = np.fft.rfftfreq(len(time), step)
    power = np.abs(spectrum) ** 2 / len(time) ** 2
    power[1:] *= 2.0
    bands = [power[(frequency >= low) & (frequency < high)].sum(axis=0) for low, high in pairwise(BANDS)]
    fast = np.fft.irfft(np.where(frequency[:, None] >= FAST, spectrum, 0.0), len(time), axis=0) ** 2
    part = np.minimum(((time - time[0]) / (time[-1] - time[0]) * PHASES).astype(int), PHASES - 1)
    number = np.maximum(np.bincount(part, minlength=PHASES), 1)
    over = [np.bincount(part, column, PHASES) / number for column in fast.T]
    return np.concatenate([np.array(bands).T, np.array(over)], axis=1)
