"""Where the gap lies: over channel and phase and state (each input, its rate, the load).

The residual of the base model, its trial-to-trial part taken off, is summed over blocks inside trials, longer than the
noise remembers. A cell's statistic is its sum over blocks in units of the root of the summed squares. Under no gap each
block's sign is arbitrary: flipping them at random gives the distribution of the largest statistic over the whole map,
so that the p-values hold for the family of all cells (Nichols & Holmes, Hum. Brain Mapp. 15:1, 2002). Of the squared
residual along an axis, what is left when the squared means (their variance taken off) are taken away is the floor: with
it the parts add up to the whole. Intervals of the shares are from blocks drawn anew within each trial.

A mean over a bin does not see what swings inside it, and an energy over a whole trial hardly sees a burst. So there is
a map of energies beside that of means (`gap.localise.gap_map`): in bands, and above `FAST` in each part of the phase.
Both are compared with energies of noise drawn from the fitted levels; the largest over all channels, bands and phases
of each draw makes the p-values hold for the family of all of them. Frequencies are those of the cosine transform, which
has no jump where a trial ends that a slow residual could be taken for fast at; missing samples and uneven steps are
bridged by straight lines, in the residual as in the noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.fft import dct, idct

from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.system import System
from geocontact.data.gap_cells import BAND, FAST, FAST_PHASE, Cell, shares
from geocontact.gap.case.change_amplitude import BLOCKS
from geocontact.gap.case.problem import Problem, noise_variance
from geocontact.gap.data_errors import DataError, put_back
from geocontact.gap.levels import DRAWS, FEW, FEWEST, PHASES
from geocontact.gap.selection.evidence import Judged
from geocontact.identify.intervals.quantile_intervals import CONFIDENCE, ENDS

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
    median, so that a pause in the recording makes no others longer. Where outputs lie in stretches, with `FEW` pauses
    of more than `FEWEST` of their steps, as many steps bridge each, so that what was left out does not outweigh what
    was used.
    """
    step = float(np.median(np.diff(time)))
    own = _without_pauses(time, np.isfinite(values).any(axis=1))
    count = min(round((own[-1] - own[0]) / step), FINEST * len(time)) + 1
    even = np.linspace(own[0], own[-1], count)
    bridged = np.zeros((count, values.shape[1]))
    for c, column in enumerate(values.T):
        there = np.isfinite(column)
        if there.any():
            bridged[:, c] = np.interp(even, own[there], column[there])
    waves = dct(bridged, axis=0, norm="ortho")
    frequency = np.arange(count) / (2.0 * count * (even[1] - even[0]))
    power = waves**2 / count
    bands = [power[(frequency >= low) & (frequency < high)].sum(axis=0) for low, high in pairwise(BANDS)]
    fast = idct(np.where(frequency[:, None] >= FAST, waves, 0.0), axis=0, norm="ortho") ** 2
    if own is time:
        part = np.arange(count) * PHASES // count
    else:
        phase = (np.interp(even, own, time) - time[0]) / (time[-1] - time[0])
        part = np.minimum(phase * PHASES, PHASES - 1).astype(int)
    number = np.maximum(np.bincount(part, minlength=PHASES), 1)
    over = [np.bincount(part, column, PHASES) / number for column in fast.T]
    return np.concatenate([np.array(bands).T, np.array(over)], axis=1)


def _without_pauses(time: Float[np.ndarray, " t"], there: Bool[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """Times with pauses of `FEWEST` steps between stretches of what is there; `time` itself where there are none."""
    if np.count_nonzero(there) < FEWEST:
        return time
    longest = FEWEST * float(np.median(np.diff(time[there])))
    ends = np.unique(np.concatenate([[0], np.flatnonzero(there), [len(time) - 1]]))
    steps = np.diff(time[ends])
    if np.count_nonzero(steps > longest) < FEW:
        return time
    return np.asarray(np.interp(time, time[ends], np.concatenate([[0.0], np.cumsum(np.minimum(steps, longest))])))


def _placed(
    values: Float[np.ndarray, " m"], rows: Int[np.ndarray, " m"], without: Bool[np.ndarray, "t c"]
) -> Float[np.ndarray, "t c"]:
    """Values at their rows of the flattened channels; NaN elsewhere, and where the model is without a value."""
    flat = np.full(without.size, np.nan)
    flat[rows] = values
    return np.where(without, np.nan, flat.reshape(without.shape))


LOADS = ("N", "N m")
BINS = 6
FAMILIES = 2  # of cells, each with its own family-wise p
HOLDS = 0.70  # of the squared gap lies in the window that is reported
GRID = 101
SMOOTHED = 0.025  # of a trial, over which a residual is smoothed


@dataclass(frozen=True)
class Window:
    """Where a channel's gap is over a trial: the shortest stretch that holds 70 % of it."""

    channel: str
    phase: tuple[float, float]
    share: float
    p_value: float


def gap_map(problem: Problem, base: Judged) -> tuple[Cell, ...]:
    """Every cell, all trials."""
    residuals = _deviations_off(problem, base)
    return (*_means(problem, base, residuals), *frequency_map(problem, base, residuals))


def windows(
    problem: Problem,
    clean: Problem,
    base: Judged,
    after: Judged | None,
    data_error: DataError | None,
    cells: tuple[Cell, ...],
) -> tuple[Window, ...]:
    """Channels with a gap on the held-out trials, `in_order`.

    `problem` is the case as it came, `clean` the one with the mistake `data_error` undone. `base`, and `after` where
    something was named, were fitted to the latter.

    With a model that explains the gap it is the difference of the two predictions; without one it is the squared
    residual less the variance of the noise.
    """
    count = len(problem.calibration.trials)
    phase = np.linspace(0.0, 1.0, GRID)
    curves = np.zeros((GRID, len(problem.system.outputs)))
    gaps = missed(problem, after, data_error)
    for i, (trial, there) in enumerate(zip(problem.evaluation.trials, problem.evaluation.present, strict=True)):
        noise = 0.0 if after is not None else noise_variance(clean.layouts[count + i], base.noise.levels)
        square = gaps[i] ** 2 - noise
        own = (trial.time - trial.time[0]) / (trial.time[-1] - trial.time[0])
        for c in range(curves.shape[1]):
            curves[:, c] += np.interp(phase, own, np.where(there[:, c], square[:, c], 0.0))
    curves = np.maximum(curves if after is not None else smoothed(curves), 0.0)
    parts = curves.sum(axis=0) / problem.floor**2
    shares = parts / max(parts.sum(), 1e-300)
    found = [
        Window(name, shortest(curves[:, c]), float(shares[c]), _least(cells, name))
        for c, name in enumerate(problem.system.outputs)
        if parts[c] > 0.0
    ]
    return in_order(found, named=after is not None)


def in_order(found: Sequence[Window], *, named: bool) -> tuple[Window, ...]:
    """Windows with most of the gap first; where nothing is named those that surely have one before those that may not.

    A squared residual may exceed the noise by chance. Sure is what has a p-value of 1 - `CONFIDENCE` at the most.
    """
    return tuple(sorted(found, key=lambda one: (not named and one.p_value > 1.0 - CONFIDENCE, -one.share)))


def missed(problem: Problem, after: Judged | None, data_error: DataError | None) -> list[Float[np.ndarray, "_ c"]]:
    """What the base model misses of each held-out trial: what `after` adds, or without it the whole residual."""
    before = problem.evaluation.residuals(problem.system, problem.plain.values)
    if after is None:
        return before
    count = len(problem.calibration.trials)
    return [
        own - put_back(data_error, trial.name, problem.system.outputs, left)
        for trial, own, left in zip(problem.evaluation.trials, before, after.model.residuals[count:], strict=True)
    ]


def shortest(curve: Float[np.ndarray, " g"]) -> tuple[float, float]:
    """Shortest window of an evenly spaced curve over 0...1 that holds 70 % of its sum."""
    total = np.concatenate([[0.0], np.cumsum(curve)])
    wanted = HOLDS * total[-1]
    ends = np.searchsorted(total, total[:-1] + wanted - 1e-12 * total[-1])
    starts = np.arange(len(curve))
    inside = ends <= len(curve)
    width = np.where(inside, ends - starts, len(curve) + 1)
    best = int(np.argmin(width))
    return float(best / len(curve)), float(min(ends[best], len(curve)) / len(curve))


def smoothed(curves: Float[np.ndarray, "t ..."]) -> Float[np.ndarray, "t ..."]:
    """Curves over a trial, without what is shorter than a part of it."""
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(curves, SMOOTHED * len(curves), axis=0, mode="nearest"))


def _least(cells: tuple[Cell, ...], channel: str) -> float:
    """The p-value of the channel's most significant cell, of two families: means, and what is faster."""
    return min(1.0, FAMILIES * min((cell.p_value for cell in cells if cell.channel == channel), default=1.0))


def _deviations_off(problem: Problem, base: Judged) -> list[Float[np.ndarray, "_ c"]]:
    """Residuals without what trials deviate by."""
    from geocontact.identify.noise.trial_variation import Products, deviations

    left = []
    varied = problem.varied(base.model.jacobian)
    for whitener, residual, design in zip(base.noise.whiteners, base.model.residuals, varied, strict=True):
        products = Products.of(whitener(residual[..., None])[:, 0], whitener(design))
        left.append(residual - design @ deviations(products, base.noise.varies))
    return left


def _means(problem: Problem, base: Judged, residuals: list[Float[np.ndarray, "_ c"]]) -> list[Cell]:
    trials = problem.calibration.trials + problem.evaluation.trials
    present = problem.calibration.present + problem.evaluation.present
    blocks = [np.minimum(np.arange(len(t)) * BLOCKS // len(t), BLOCKS - 1) for t in trials]
    rng = np.random.default_rng(0)
    cells = []
    for axis, values, edges in _axes(problem, base):
        which = [np.clip(np.searchsorted(edges, v, side="right") - 1, 0, len(edges) - 2) for v in values]
        for c, name in enumerate(problem.system.outputs):
            sums, counts = (np.zeros((len(trials), BLOCKS, len(edges) - 1)) for _ in range(2))
            total = 0.0
            for i, (residual, there, own) in enumerate(zip(residuals, present, which, strict=True)):
                rows = np.flatnonzero(there[:, c])
                np.add.at(sums[i], (blocks[i][rows], own[rows]), residual[rows, c])
                np.add.at(counts[i], (blocks[i][rows], own[rows]), 1.0)
                total += float((residual[rows, c] ** 2).sum())
            cells += [_GapSums(name, axis, edges, sums, counts, total)]
    p_values = family_wise([each.sums.reshape(-1, each.sums.shape[-1]) for each in cells])
    return [cell for each, p in zip(cells, p_values, strict=True) for cell in each.cells(p, rng)]


@dataclass(frozen=True)
class _GapSums:
    """Residual of a channel along an axis: sums and counts of the bins, block by block, and its sum of squares."""

    channel: str
    axis: str
    edges: Float[np.ndarray, " e"]
    sums: Float[np.ndarray, "i k b"]
    counts: Float[np.ndarray, "i k b"]
    total: float

    def cells(self, p_values: Float[np.ndarray, " b"], rng: np.random.Generator) -> list[Cell]:
        """Those that were measured in."""
        count = self.counts.sum(axis=(0, 1))
        blocks = len(self.sums) * BLOCKS
        sums, counts = self.sums.reshape(blocks, -1), self.counts.reshape(blocks, -1)
        squares = systematic(sums, counts, np.ones((1, blocks)))[0]
        some = (
            rng.integers(BLOCKS, size=(FEW_DRAWS, *self.sums.shape[:2])) + BLOCKS * np.arange(len(self.sums))[:, None]
        )
        at = some.reshape(FEW_DRAWS, blocks) + blocks * np.arange(FEW_DRAWS)[:, None]
        times = np.bincount(at.ravel(), minlength=FEW_DRAWS * blocks).reshape(FEW_DRAWS, blocks)
        drawn = np.array([shares(each) for each in systematic(sums, counts, times.astype(float))])
        low, high = np.quantile(drawn, ENDS, axis=0)
        share, floor = shares(squares), 1.0 - float(squares.sum()) / max(self.total, 1e-300)
        mean = self.sums.sum(axis=(0, 1)) / np.maximum(count, 1.0)
        return [
            Cell(
                self.channel,
                self.axis,
                float(self.edges[b]),
                float(self.edges[b + 1]),
                float(mean[b]),
                float(share[b]),
                float(p_values[b]),
                (float(low[b]), float(high[b])),
                floor,
            )
            for b in np.flatnonzero(count)
        ]


def systematic(
    sums: Float[np.ndarray, "k b"], counts: Float[np.ndarray, "k b"], times: Float[np.ndarray, "n k"]
) -> Float[np.ndarray, "n b"]:
    """Squared gap of each bin: its mean squared, less the variance of the mean, for every sample.

    Of blocks that are there as many `times` as each row says.
    """
    return np.asarray(np.maximum((times @ sums) ** 2 - times @ sums**2, 0.0) / np.maximum(times @ counts, 1.0))


def family_wise(
    tables: list[Float[np.ndarray, "k _"]], spread: Float[np.ndarray, " _"] | float = 1.0
) -> list[Float[np.ndarray, " _"]]:
    """p of every column of block sums, by flipping the signs of all blocks of a map.

    `spread` is by how much more a column's sum scatters than where its blocks are independent.
    """
    together = np.concatenate(tables, axis=1)
    size = np.sqrt((together**2).sum(axis=0))
    size[size == 0.0] = np.inf
    signs = np.random.default_rng(0).choice([-1.0, 1.0], (DRAWS, len(together)))
    together = together / size
    largest = np.zeros(DRAWS)
    for begin in range(0, together.shape[1], len(together)):  # a part at a time stays in the processor's cache
        flipped = signs @ together[:, begin : begin + len(together)]
        largest = np.maximum(largest, np.maximum(flipped.max(axis=1), -flipped.min(axis=1)))
    statistic = np.abs(together.sum(axis=0)) / spread
    p_values = (1.0 + DRAWS - np.searchsorted(np.sort(largest), statistic)) / (1.0 + DRAWS)
    return np.split(p_values, np.cumsum([table.shape[1] for table in tables])[:-1])


def _axes(problem: Problem, base: Judged) -> list[tuple[str, list[np.ndarray], Float[np.ndarray, " e"]]]:
    """Name, values per trial and bin edges of every axis."""
    trials = problem.calibration.trials + problem.evaluation.trials
    outputs = problem.calibration.outputs + problem.evaluation.outputs
    phase = [(t.time - t.time[0]) / (t.time[-1] - t.time[0]) for t in trials]
    found = [("phase", phase, np.linspace(0.0, 1.0, PHASES + 1))]
    movements = [recorded(t.signals, problem.system.inputs, problem.system.motion.reach) for t in trials]
    for row, name in enumerate(problem.system.inputs):
        position, rate = [m.position[row] for m in movements], [m.rate[row] for m in movements]
        found += [(axis, values, _quantiles(values)) for axis, values in ((name, position), (f"{name}'", rate))]
    rows = load_outputs(problem.system)
    if rows:
        predicted = [(m - r)[:, rows] for m, r in zip(outputs, base.model.residuals, strict=True)]
        load = [p[:, 0] if len(rows) == 1 else np.linalg.norm(p, axis=1) for p in predicted]
        found.append(("load", [np.nan_to_num(v) for v in load], _quantiles(load)))
    return found


def load_outputs(system: System) -> list[int]:
    """Outputs whose predicted values are the load, or whose root of summed squares is: forces, else moments."""
    for unit in LOADS:
        rows = [i for i, name in enumerate(system.outputs) if system.unit(name) == unit]
        if rows:
            return rows
    return []


def _quantiles(values: list[np.ndarray]) -> Float[np.ndarray, " e"]:
    together = np.concatenate(values)
    return np.unique(np.quantile(together[np.isfinite(together)], np.linspace(0.0, 1.0, BINS + 1)))
