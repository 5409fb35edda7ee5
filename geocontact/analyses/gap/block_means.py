r"""Quick recordings: samples that show nothing but noise beside their neighbours are averaged over blocks of time.

A mean over k samples of white noise has 1/k of its variance, so that nothing is lost, where all channels move evenly
within a block. All of them are averaged alike: what a model does to their means is what it does to them.

Within a block the mean of the second half less that of the first is compared with the slope between the blocks beside
it. Of white noise of standard deviation s that has the variance s²(4 + 1/8)/k. An impact, a step or a burst in an
output is larger than that, and then the recording stays as it is; likewise where

- the movement of an input is not even within a block, by more than its usual noise,
- the spectrum of an output has a narrow line that blocks would take off, the mains' aside,
- an output ends at a level, repeats samples, or comes in steps coarser than its noise,
- noise remembers more than quick noise usually does, or cells of mats belong to the samples.

The longest block whose means show all there is is used, of 40 ms at the most: 25 samples per second, twice the usual
corner of filtered movements, and two blocks in a slip of a clock of 90 ms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.case.noise_sources import at_mains, typical_step, usual_range
from geocontact.gap.inputs.spectrum import even_grid, nuttall, resolution
from geocontact.gap.levels import FEWEST, INPUT_NOISE, SLIGHT, SURE
from geocontact.gap.selection.residual_anomalies import pile
from geocontact.identify.noise.noise_levels import typical_noise

LONGEST = 0.04
"""Duration of a block at the most [s]."""
MEMORY = 10.0
"""Variance of means over that of white noise with the same differences: noise that remembers two samples."""
HALVES = 4.125
"""Variance of what a block's halves differ by beside its neighbours' slope, over that of a mean, of white noise."""
AROUND = 211
"""Differences that local noise is taken from, and bins that a line is compared with: their median is within 10 %."""


def numbers(time: Float[np.ndarray, " t"], step: float) -> Int[np.ndarray, " t"]:
    """Number of each sample on a clock of this step [s]: samples that were lost count, unevenness does not."""
    return np.concatenate([[0], np.cumsum(np.maximum(np.round(np.diff(time) / step), 1.0))]).astype(int)


@dataclass(frozen=True)
class Blocks:
    """Consecutive samples of a trial: where each block begins, the first row behind the last, and which are used."""

    begin: Int[np.ndarray, " b"]
    end: int
    used: Bool[np.ndarray, " b"]

    @classmethod
    def of(cls, time: Float[np.ndarray, " t"], step: float, size: int) -> Blocks:
        """Blocks of `size` samples that lie `step` [s] apart; those that lack half of them are not used."""
        begin = np.flatnonzero(np.diff(numbers(time, step) // size, prepend=-1))
        counts = np.diff(begin, append=len(time))
        return cls(begin, len(time), 2 * counts >= size)

    def means(self, values: Float[np.ndarray, "t ..."]) -> Float[np.ndarray, "b ..."]:
        """Mean of each block; NaN where one of its samples is."""
        counts = np.diff(self.begin, append=self.end).reshape(-1, *[1] * (values.ndim - 1))
        return np.asarray(np.add.reduceat(values, self.begin, axis=0) / counts)


@dataclass(frozen=True)
class Evenness:
    """How evenly one channel of one trial moves within blocks, those with two whole neighbours.

    Parameters
    ----------
    bent
        What the halves of each differ by, beside its neighbours' slope, in the channel's unit.
    noise
        Standard deviation of a sample there, from differences of neighbours.
    within
        Mean variance of the samples of a block about that slope.
    size
        Samples of a block.
    """

    bent: Float[np.ndarray, " b"]
    noise: Float[np.ndarray, " b"]
    within: float
    size: int

    @classmethod
    def of(cls, time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"], step: float, size: int) -> Evenness:
        """From the samples of a channel; `size` is even."""
        from scipy.ndimage import median_filter

        number, blocks = numbers(time, step), Blocks.of(time, step, size)
        whole = np.diff(blocks.begin, append=blocks.end) == size
        rows = blocks.begin[whole][:, None] + np.arange(size)
        rows = rows[np.isfinite(values[rows]).all(axis=1)]
        block = number[rows[:, 0]] // size
        inner = 1 + np.flatnonzero((block[2:] - block[:-2]) == 2)
        if not len(inner):
            return cls(np.zeros(0), np.zeros(0), 0.0, size)
        x, t, half = values[rows], time[rows], size // 2
        mean, at = x.mean(axis=1), t.mean(axis=1)
        slope = (mean[inner + 1] - mean[inner - 1]) / (at[inner + 1] - at[inner - 1])
        x, t, mean, at = x[inner], t[inner], mean[inner], at[inner]
        apart = x[:, half:].mean(axis=1) - x[:, :half].mean(axis=1)
        lasting = t[:, half:].mean(axis=1) - t[:, :half].mean(axis=1)
        straight = x - mean[:, None] - slope[:, None] * (t - at[:, None])
        power = 0.5 * (np.diff(straight, axis=1) ** 2).mean(axis=1)
        about = max(AROUND // (size - 1), FEWEST) // 2 * 2 + 1
        typical = median_filter(power, about, mode="mirror") / (1.0 - 2.0 / (9.0 * (size - 1))) ** 3
        return cls(apart - slope * lasting, np.sqrt(typical), float((straight**2).mean()), size)

    @property
    def of_means(self) -> Float[np.ndarray, " b"]:
        """`bent`, in units of what white noise makes of it."""
        usual = self.noise * np.sqrt(HALVES / self.size)
        return np.asarray(np.abs(np.divide(self.bent, usual, out=np.zeros_like(usual), where=usual > 0.0)))


@dataclass(frozen=True)
class QuickNoise:
    """Variances that a channel's blocks show: within one, and of their means as far as halves of one block show it.

    They are of so many `samples`.
    """

    within: float
    of_means: float
    samples: int

    def remaining(self, stated: float) -> float:
        """Standard deviation of means, of noise with a stated one of samples.

        The variance within blocks is counted at the upper end of its 95 % interval, as of white noise.
        """
        if self.within <= 0.0:
            return stated
        share = self.of_means / (self.of_means + self.within)
        within = self.within * (1.0 + 2.0 * np.sqrt(2.0 / self.samples))
        return float(np.sqrt(max(share * stated**2, stated**2 - within)))


def averaged(case: GapCase, outputs: Sequence[str], inputs: Sequence[str]) -> tuple[GapCase, int]:
    """The case with the means of blocks in place of its samples, and how many are in one: 1 where all stay.

    Of the variance of the stated noise only what is seen within blocks is taken off, so that slow noise, which means
    keep and blocks do not show, stays; at least what the blocks' halves show of means remains.
    """
    step = typical_step(case)
    trials = (*case.calibration, *case.evaluation)
    if case.cells or step <= 0.0 or any(_recorder_shows(trials, name) for name in outputs):
        return case, 1
    size = 2 * int(0.5 * LONGEST / step + 1e-6)
    while size >= 2:
        quick = even(trials, outputs, inputs, step, size)
        if quick is not None:
            first, later = (tuple(_means(one, step, size) for one in s) for s in (case.calibration, case.evaluation))
            noise = {name: quick[name].remaining(sd) if name in quick else sd for name, sd in case.noise.items()}
            return replace(case, calibration=first, evaluation=later, noise=noise), size
        size = 2 * int(0.375 * size)
    return case, 1


def even(
    trials: Sequence[Trial], outputs: Sequence[str], inputs: Sequence[str], step: float, size: int
) -> dict[str, QuickNoise] | None:
    """By channel, what means of blocks take off its noise; None where they lose more than noise."""
    if _gaps_cost(trials, (*outputs, *inputs), step, size):
        return None
    found: dict[str, QuickNoise] = {}
    for name in (*inputs, *outputs):
        own = [Evenness.of(trial.time, trial.column(name), step, size) for trial in trials]
        bent, noise, sizes = (np.concatenate([getattr(e, key) for e in own]) for key in ("bent", "noise", "of_means"))
        if len(bent) < FEWEST:
            return None
        limit = float(np.sqrt(2.0 * (np.log(len(bent)) + SURE)))
        if name in inputs:
            values = np.concatenate([trial.column(name) for trial in trials])
            usual = INPUT_NOISE * 0.5 * float(np.nanmax(values) - np.nanmin(values))
            if (np.abs(bent) > usual + limit * noise * np.sqrt(HALVES / size)).any():
                return None
        else:
            typical = max(typical_noise(sizes), 1.0)
            if typical**2 > MEMORY or sizes.max() > limit * typical or _line(trials, name, size):
                return None
        within = float(np.mean([e.within for e in own]))
        found[name] = QuickNoise(within, float(typical_noise(bent) ** 2 / HALVES), len(bent) * size)
    return found


def _means(trial: Trial, step: float, size: int) -> Trial:
    blocks = Blocks.of(trial.time, step, size)
    time, values = blocks.means(trial.time)[blocks.used], blocks.means(trial.signals.values)[blocks.used]
    return replace(trial, signals=replace(trial.signals, time=time, values=values))


def _gaps_cost(trials: Sequence[Trial], names: Sequence[str], step: float, size: int) -> bool:
    """Whether more than `SLIGHT` of the samples of a channel lie in blocks that are not whole."""
    for name in names:
        kept = there = 0
        for trial in trials:
            blocks, finite = Blocks.of(trial.time, step, size), np.isfinite(trial.column(name))
            edges = [*blocks.begin, blocks.end]
            there += int(finite.sum())
            whole = np.add.reduceat(finite, blocks.begin) == np.diff(edges)
            kept += int(np.diff(edges)[whole & blocks.used].sum())
        if there - kept > SLIGHT * there + size * 2 * len(trials):
            return True
    return False


def _recorder_shows(trials: Sequence[Trial], name: str) -> bool:
    """Whether an output ends at a level, repeats samples more than by chance, or comes in steps beyond its noise."""
    columns = [x[np.isfinite(x)] for x in (trial.column(name) for trial in trials)]
    columns = [x for x in columns if len(x) >= FEWEST]
    if not columns:
        return True
    values, step = np.concatenate(columns), resolution(columns)
    looks, most = np.log(2.0), float(np.abs(values).max())
    for side in (1.0, -1.0):
        level, _, nats = pile(side * values, step)
        if level > 0.5 * most and nats - looks > SURE:
            return True
    low, high = usual_range(values)
    moves = np.concatenate([np.diff(x)[(x[1:] > low) & (x[1:] < high)] for x in columns])
    usual = typical_noise(moves)
    if not usual > np.sqrt(2.0) * step:
        return True
    return bool((moves == 0.0).mean() > 2.0 * step / (np.sqrt(2.0 * np.pi) * usual) + SLIGHT)


def _line(trials: Sequence[Trial], name: str, size: int) -> bool:
    """Whether a narrow line stands out of an output's spectrum above what means of blocks show, in some trial."""
    from scipy.ndimage import median_filter

    for trial in trials:
        there = np.isfinite(trial.column(name))
        if there.sum() < FEWEST:
            continue
        grid = even_grid(trial.time)
        even_values = np.interp(grid, trial.time[there], trial.column(name)[there])
        power = np.abs(np.fft.rfft((even_values - even_values.mean()) * nuttall(len(grid)))) ** 2
        lost = np.arange(len(power)) > 0.5 * len(grid) / size
        lost &= ~at_mains(len(power), len(grid), float(grid[1] - grid[0]))
        lost[-1] = False
        usual = median_filter(power, AROUND, mode="mirror") / np.log(2.0)
        if (power[lost] > (np.log(max(lost.sum() * len(trials), 1)) + SURE) * usual[lost]).any():
            return True
    return False
