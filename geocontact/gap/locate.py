"""Where the gap lies: over channel and phase, state (each input, its rate, the load), and frequency band.

The residual of the base model, its trial-to-trial part taken off, is summed over blocks inside trials, longer than the
noise remembers. A cell's statistic is its sum over blocks in units of the root of the summed squares. Under no gap each
block's sign is arbitrary: flipping them at random gives the distribution of the largest statistic over the whole map,
so that the p-values hold for the family of all cells (Nichols & Holmes, Hum. Brain Mapp. 15:1, 2002). The energy in
each frequency band is compared with that of noise drawn from the fitted levels, all bands and channels one family.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from geocontact.chain.movement import recorded
from geocontact.gap.evidence import Judged
from geocontact.gap.faults import Fault
from geocontact.gap.mending import put_back
from geocontact.gap.problem import Problem, noise_variance

PHASES = 20
BINS = 6
BLOCKS = 16  # per trial
FLIPS = 2000
DRAWS = 200
BANDS = (0.0, 1.0, 5.0, np.inf)  # Hz
HOLDS = 0.70  # of the squared gap lies in the window that is reported
GRID = 101
SMOOTHED = 0.025  # of a trial, over which a residual is smoothed


@dataclass(frozen=True)
class Cell:
    """One cell of the map.

    Parameters
    ----------
    channel, axis, low, high
        Of an output, over "phase", an input, its rate, "load", or "band" [Hz], between these values, SI.
    gap
        Mean residual there [the channel's unit]; for a band the root mean square.
    share
        Of the channel's squared gap along this axis, noise taken off.
    p_value
        Family-wise.
    """

    channel: str
    axis: str
    low: float
    high: float
    gap: float
    share: float
    p_value: float


@dataclass(frozen=True)
class Window:
    """Where a channel's gap is over a trial: the shortest stretch that holds 70 % of it."""

    channel: str
    phase: tuple[float, float]
    share: float
    p_value: float


def gap_map(problem: Problem, base: Judged) -> tuple[Cell, ...]:
    """Every cell, all trials."""
    return (*_means(problem, base), *_bands(problem, base))


def windows(
    problem: Problem,
    clean: Problem,
    base: Judged,
    after: Judged | None,
    fault: Fault | None,
    cells: tuple[Cell, ...],
) -> tuple[Window, ...]:
    """Channels with a gap, the one with most of it first, on the held-out trials.

    `problem` is the case as it came, `clean` the one with the mistake `fault` undone. `base`, and `after` where
    something was named, were fitted to the latter.

    With a model that explains the gap it is the difference of the two predictions; without one it is the squared
    residual less the variance of the noise.
    """
    count = len(problem.calibration.trials)
    phase = np.linspace(0.0, 1.0, GRID)
    curves = np.zeros((GRID, len(problem.system.outputs)))
    gaps = missed(problem, after, fault)
    for i, (trial, there) in enumerate(zip(problem.evaluation.trials, problem.evaluation.present, strict=True)):
        noise = 0.0 if after is not None else noise_variance(clean.layouts[count + i], base.noise.levels)
        square = gaps[i] ** 2 - noise
        own = (trial.time - trial.time[0]) / (trial.time[-1] - trial.time[0])
        for c in range(curves.shape[1]):
            if there[:, c].any():
                curves[:, c] += np.interp(phase, own[there[:, c]], square[there[:, c], c])
    curves = np.maximum(curves if after is not None else smoothed(curves), 0.0)
    parts = curves.sum(axis=0) / problem.floor**2
    shares = parts / max(parts.sum(), 1e-300)
    found = [
        Window(name, shortest(curves[:, c]), float(shares[c]), _least(cells, name))
        for c, name in enumerate(problem.system.outputs)
        if parts[c] > 0.0
    ]
    return tuple(sorted(found, key=lambda window: -window.share))


def missed(problem: Problem, after: Judged | None, fault: Fault | None) -> list[Float[np.ndarray, "_ c"]]:
    """What the base model misses of each held-out trial: what `after` adds, or without it the whole residual."""
    before = problem.evaluation.residuals(problem.system, problem.plain.values)
    if after is None:
        return before
    count = len(problem.calibration.trials)
    return [
        own - put_back(fault, trial.name, problem.system.outputs, left)
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
    return min((cell.p_value for cell in cells if cell.channel == channel), default=1.0)


def _deviations_off(problem: Problem, base: Judged) -> list[Float[np.ndarray, "_ c"]]:
    """Residuals without what trials deviate by."""
    from geocontact.identify.trial_variation import Products, deviations

    left = []
    for whitener, residual, jacobian in zip(
        base.noise.whiteners, base.model.residuals, base.model.jacobian, strict=True
    ):
        design = jacobian[..., : len(problem.usual)]
        products = Products.of(whitener(residual[..., None])[:, 0], whitener(design))
        left.append(residual - design @ deviations(products, base.noise.varies))
    return left


def _means(problem: Problem, base: Judged) -> list[Cell]:
    trials = problem.calibration.trials + problem.evaluation.trials
    present = problem.calibration.present + problem.evaluation.present
    residuals = _deviations_off(problem, base)
    axes = _axes(problem, base)
    columns, where = [], []
    for c, name in enumerate(problem.system.outputs):
        for axis, values, edges in axes:
            which = [np.clip(np.searchsorted(edges, v, side="right") - 1, 0, len(edges) - 2) for v in values]
            for b in range(len(edges) - 1):
                sums = []
                inside_count, total = 0, 0.0
                for trial, residual, there, own in zip(trials, residuals, present, which, strict=True):
                    inside = there[:, c] & (own == b)
                    block = np.minimum(np.arange(len(trial)) * BLOCKS // len(trial), BLOCKS - 1)
                    sums.append(np.bincount(block[inside], residual[inside, c], BLOCKS))
                    inside_count += int(inside.sum())
                    total += float(residual[inside, c].sum())
                if inside_count:
                    columns.append(np.concatenate(sums))
                    where.append((name, axis, float(edges[b]), float(edges[b + 1]), total / inside_count, inside_count))
    table = np.array(columns).T
    size = np.sqrt((table**2).sum(axis=0))
    size[size == 0.0] = np.inf
    signs = np.random.default_rng(0).choice([-1.0, 1.0], (FLIPS, len(table)))
    largest = np.abs(signs @ (table / size)).max(axis=1)
    statistic = np.abs((table / size).sum(axis=0))
    p_values = (1.0 + (largest[:, None] >= statistic).sum(axis=0)) / (1.0 + FLIPS)
    variance = size**2 / np.array([w[5] for w in where]) ** 2
    squares = np.maximum(np.array([w[4] for w in where]) ** 2 - np.where(np.isfinite(variance), variance, 0.0), 0.0)
    weights = squares * np.array([w[5] for w in where])
    cells = []
    for i, (name, axis, low, high, gap, _) in enumerate(where):
        family = sum(weights[k] for k, w in enumerate(where) if w[0] == name and w[1] == axis)
        share = float(weights[i] / family) if family > 0.0 else 0.0
        cells.append(Cell(name, axis, low, high, gap, share, float(p_values[i])))
    return cells


def _axes(problem: Problem, base: Judged) -> list[tuple[str, list[np.ndarray], Float[np.ndarray, " e"]]]:
    """Name, values per trial and bin edges of every axis."""
    trials = problem.calibration.trials + problem.evaluation.trials
    outputs = problem.calibration.outputs + problem.evaluation.outputs
    phase = [(t.time - t.time[0]) / (t.time[-1] - t.time[0]) for t in trials]
    found = [("phase", phase, np.linspace(0.0, 1.0, PHASES + 1))]
    movements = [recorded(t.signals, problem.system.inputs) for t in trials]
    for row, name in enumerate(problem.system.inputs):
        position, rate = [m.position[row] for m in movements], [m.rate[row] for m in movements]
        found += [(axis, values, _quantiles(values)) for axis, values in ((name, position), (f"{name}'", rate))]
    load = [m[:, 0] - r[:, 0] for m, r in zip(outputs, base.model.residuals, strict=True)]
    found.append(("load", [np.nan_to_num(v) for v in load], _quantiles(load)))
    return found


def _quantiles(values: list[np.ndarray]) -> Float[np.ndarray, " e"]:
    together = np.concatenate(values)
    return np.unique(np.quantile(together[np.isfinite(together)], np.linspace(0.0, 1.0, BINS + 1)))


def _bands(problem: Problem, base: Judged) -> list[Cell]:
    trials = problem.calibration.trials + problem.evaluation.trials
    channels = problem.system.outputs
    seen = np.array([_energies(t.time, r) for t, r in zip(trials, _deviations_off(problem, base), strict=True)])
    rng = np.random.default_rng(0)
    drawn = np.zeros((DRAWS, len(trials), len(channels), len(BANDS) - 1))
    for i, (trial, whitener, residual) in enumerate(
        zip(trials, base.noise.whiteners, base.model.residuals, strict=True)
    ):
        rows = np.concatenate(whitener.rows)
        for k in range(DRAWS):
            flat = np.zeros(residual.size)
            flat[rows] = whitener.coloured(rng.standard_normal(len(rows)))
            drawn[k, i] = _energies(trial.time, flat.reshape(residual.shape))
    energy, null = seen.mean(axis=0), drawn.mean(axis=1)
    middle, spread = null.mean(axis=0), np.maximum(null.std(axis=0), 1e-300)
    largest = ((null - middle) / spread).max(axis=(1, 2))
    cells = []
    excess = np.maximum(energy - middle, 0.0)
    for c, name in enumerate(channels):
        total = float(excess[c].sum())
        for b in range(len(BANDS) - 1):
            p = (1.0 + float((largest >= (energy[c, b] - middle[c, b]) / spread[c, b]).sum())) / (1.0 + DRAWS)
            share = float(excess[c, b] / total) if total > 0.0 else 0.0
            cells.append(Cell(name, "band", BANDS[b], BANDS[b + 1], float(energy[c, b] ** 0.5), share, p))
    return cells


def _energies(time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "c b"]:
    """Mean square of every channel in every band; missing samples count as 0."""
    step = (time[-1] - time[0]) / (len(time) - 1)
    power = np.abs(np.fft.rfft(np.nan_to_num(values), axis=0)) ** 2 / len(time) ** 2
    power[1:] *= 2.0
    frequency = np.fft.rfftfreq(len(time), step)
    bands = [power[(frequency >= low) & (frequency < high)].sum(axis=0) for low, high in pairwise(BANDS)]
    return np.array(bands).T
