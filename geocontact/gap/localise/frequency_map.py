"""How large what a model misses is: in frequency bands over whole trials, and what is fast over the phase.

A mean over a bin does not see what swings inside it, and an energy over a whole trial hardly sees a burst. So there is
a map of energies beside that of means (`gap.localise.gap_map`): in bands, and above `FAST` in each part of the phase.
Both are compared with energies of noise drawn from the fitted levels; the largest over all channels, bands and phases
of each draw makes the p-values hold for the family of all of them. Frequencies are those of the cosine transform, which
has no jump where a trial ends that a slow residual could be taken for fast at; missing samples and uneven steps are
bridged by straight lines, in the residual as in the noise.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.fft import dct, idct

from geocontact.data.gap.cell import BAND, FAST, FAST_PHASE, Cell, shares
from geocontact.gap.case.problem import Problem
from geocontact.gap.levels import PHASES
from geocontact.gap.selection.evidence import Judged
from geocontact.identify.intervals.quantile_intervals import ENDS

FEW_DRAWS = 200  # where each is a simulation or a map
BANDS = (0.0, 1.0, 5.0, np.inf)  # Hz
FINEST = 10  # times as many even steps as samples, where steps differ


def frequency_map(problem: Problem, base: Judged, residuals: list[Float[np.ndarray, "_ c"]]) -> list[Cell]:
    """Energy of every channel's residual in each band, and above `FAST` in each part of the phase, all trials.

    `residuals` are those of `base` without what trials deviate by. `share` is of what exceeds noise along the axis, its
    interval from trials drawn anew.
    """
    trials = problem.calibration.trials + problem.evaluation.trials
    channels = problem.system.outputs
    rng = np.random.default_rng(0)
    observed, drawn = [], np.zeros((FEW_DRAWS, len(channels), len(BANDS) - 1 + PHASES))
    for trial, whitener, residual in zip(trials, base.noise.whiteners, residuals, strict=True):
        rows = np.concatenate(whitener.rows)
        without = ~np.isfinite(base.model.system.simulate(trial, base.model.values))
        observed.append(energies(trial.time, _placed(residual.ravel()[rows], rows, without)))
        for k, noise in enumerate(whitener.coloured(rng.standard_normal((FEW_DRAWS, len(rows))).T).T):
            drawn[k] += energies(trial.time, _placed(noise, rows, without)) / len(trials)
    each = np.array(observed)
    seen = each.mean(axis=0)
    middle, spread = drawn.mean(axis=0), np.maximum(drawn.std(axis=0), 1e-300)
    largest = ((drawn - middle) / spread).max(axis=(1, 2))
    score = (seen - middle) / spread
    again = each[rng.integers(len(trials), size=(FEW_DRAWS, len(trials)))].mean(axis=1)
    bands = list(pairwise(BANDS))
    parts = [(k / PHASES, (k + 1) / PHASES) for k in range(PHASES)]
    cells = []
    for c, name in enumerate(channels):
        for axis, edges, own in ((BAND, bands, slice(len(bands))), (FAST_PHASE, parts, slice(len(bands), None))):
            excess = np.maximum(seen[c, own] - middle[c, own], 0.0)
            some = np.array([shares(np.maximum(one - middle[c, own], 0.0)) for one in again[:, c, own]])
            low, high = np.quantile(some, ENDS, axis=0)
            share = shares(excess)
            floor = 1.0 - float(excess.sum()) / max(float(seen[c, own].sum()), 1e-300)
            for b, (begin, end) in enumerate(edges):
                p = (1.0 + float((largest >= score[c, own][b]).sum())) / (1.0 + FEW_DRAWS)
                size, interval = float(seen[c, own][b] ** 0.5), (float(low[b]), float(high[b]))
                cells.append(Cell(name, axis, begin, end, size, float(share[b]), p, interval, floor))
    return cells


def energies(time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "c m"]:
    """Mean square of every channel in every band, then above `FAST` in every part of the phase.

    Missing samples are NaN; a channel without any has no energy. Of even steps as long as the trial's are in the
    median, so that a pause in the recording makes no others longer.
    """
    span = time[-1] - time[0]
    count = min(round(span / float(np.median(np.diff(time)))), FINEST * len(time)) + 1
    even = np.linspace(time[0], time[-1], count)
    bridged = np.zeros((count, values.shape[1]))
    for c, column in enumerate(values.T):
        there = np.isfinite(column)
        if there.any():
            bridged[:, c] = np.interp(even, time[there], column[there])
    waves = dct(bridged, axis=0, norm="ortho")
    frequency = np.arange(count) / (2.0 * count * (even[1] - even[0]))
    power = waves**2 / count
    bands = [power[(frequency >= low) & (frequency < high)].sum(axis=0) for low, high in pairwise(BANDS)]
    fast = idct(np.where(frequency[:, None] >= FAST, waves, 0.0), axis=0, norm="ortho") ** 2
    part = np.arange(count) * PHASES // count
    number = np.maximum(np.bincount(part, minlength=PHASES), 1)
    over = [np.bincount(part, column, PHASES) / number for column in fast.T]
    return np.concatenate([np.array(bands).T, np.array(over)], axis=1)


def _placed(
    values: Float[np.ndarray, " m"], rows: Int[np.ndarray, " m"], without: Bool[np.ndarray, "t c"]
) -> Float[np.ndarray, "t c"]:
    """Values at their rows of the flattened channels; NaN elsewhere, and where the model is without a value."""
    flat = np.full(without.size, np.nan)
    flat[rows] = values
    return np.where(without, np.nan, flat.reshape(without.shape))
