"""Cells of phase, state and rate in which a base model misses what calibration and held-out trials have alike.

Every channel is cut into cells: parts of the trial, quarters of the range of the input that the channel follows most
closely, on the way up and on the way down. With m_i the mean residual of trial i in a cell, of n trials that reach it,
m their mean and s their standard deviation,

    p = 2 P(t > √n |m| / s),

t of Student's distribution with n - 1 degrees of freedom: trials are independent, samples of one are not, so that slow
noise, offsets and what trials differ by are in s. A cell has *structure* only where the means of the calibration trials
and of those that were left out have the sign of m and half of its size at least; elsewhere p = 1, so that p is only
raised. Parameters fitted to calibration trials centre what these vary by; what the others then have alike does not
count, since the calibration trials lack it.

Few trials show little: in one of 32 cells |m| / s must be 29 of three trials, 9 of four, 3 of six.

A base model that is fitted to everything spreads what a part of the movement misses over other parts: cells beside a
strong effect are then found in vain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.special import stdtr

from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import Refit
from geocontact.gap.levels import FEW, PHASES, TWOFOLD
from geocontact.gap.reduction.repeats import axes_of

SHAPE = (FEW, FEW, 2)
"""Cells of a channel: parts of the phase, quarters of a state, down and up."""
Cells = Bool[np.ndarray, "c k"]


@dataclass(frozen=True, eq=False)
class StateCells:
    """Cell of each sample of each trial by channel, calibration trials first.

    Parameters
    ----------
    which
        Number of the cell, -1 where nothing was measured or the trial has too few samples in it, and where one set of
        trials has none of these.
    inputs
        Input that each channel follows, "" where it follows none.
    fitted
        How many of the trials are calibration trials.
    """

    which: tuple[Int[np.ndarray, "_ c"], ...]
    inputs: tuple[str, ...]
    fitted: int

    @classmethod
    def of(cls, problem: Problem, base: Refit) -> StateCells:
        """Cells of a case; `base` is the base model on all trials."""
        trials, system, present = problem.recorded.trials, problem.system, problem.recorded.present
        axes = axes_of(trials, system)
        part = [p * FEW // PHASES for p in axes.pop("phase")]
        predicted = [y - r for y, r in zip(problem.recorded.outputs, base.residuals, strict=True)]
        inputs = tuple(followed([y[:, c] for y in predicted], axes) for c in range(len(system.outputs)))
        which = []
        for i, (own, there) in enumerate(zip(part, present, strict=True)):
            state = [axes[name][i] if name else np.zeros(len(own), int) for name in inputs]
            place = own[:, None] * SHAPE[1] * SHAPE[2] + np.stack(state, axis=1)
            own_place = np.where(there, place, -1)
            which.append(_where(counts_of([own_place]) >= FEW, own_place))
        fitted = len(problem.calibration.trials)
        both: Cells = np.all([counts_of(some) > 0.0 for some in (which[:fitted], which[fitted:])], axis=0)
        kept = tuple(_where(both, own) for own in which)
        return cls(kept, inputs, fitted)

    @property
    def tested(self) -> Cells:
        """Cells with enough samples."""
        return np.asarray(counts_of(self.which) > 0)

    def inside(self, cells: Cells) -> list[Bool[np.ndarray, "_ c"]]:
        """Samples that lie in some cells, per trial."""
        return [_where(cells, own) >= 0 for own in self.which]

    def p_values(self, residuals: Sequence[Float[np.ndarray, "_ c"]]) -> Float[np.ndarray, "c k"]:
        """p of structure in each cell, of residuals in the channels' units; 1 where it is not tested."""
        counts = np.array([counts_of([own]) for own in self.which])
        sums = np.array([self.sums([r], [own]) for r, own in zip(residuals, self.which, strict=True)])
        there, means = counts > 0.0, sums / np.maximum(counts, 1.0)
        trials = there.sum(axis=0)
        mean = means.sum(axis=0) / np.maximum(trials, 1)
        square = np.where(there, (means - mean) ** 2, 0.0).sum(axis=0)
        off = np.sqrt(square / (np.maximum(trials, 1) * np.maximum(trials - 1, 1)))
        able = (trials > 1) & (mean != 0.0)
        for some in (slice(self.fitted), slice(self.fitted, None)):
            own = means[some].sum(axis=0) / np.maximum(there[some].sum(axis=0), 1)
            able &= own * np.sign(mean) >= np.exp(-TWOFOLD) * np.abs(mean)
        deviations = np.abs(mean[able]) / np.maximum(off[able], 1e-300)
        found = np.ones(mean.shape)
        found[able] = 2.0 * stdtr(trials[able] - 1, -deviations)
        return found

    @staticmethod
    def sums(
        values: Sequence[Float[np.ndarray, "_ c"]], which: Sequence[Int[np.ndarray, "_ c"]]
    ) -> Float[np.ndarray, "c k"]:
        """Sums of values over cells."""
        found = np.zeros((which[0].shape[1], int(np.prod(SHAPE))))
        for own, cells in zip(values, which, strict=True):
            for c, (column, cell) in enumerate(zip(own.T, cells.T, strict=True)):
                found[c] += np.bincount(cell[cell >= 0], column[cell >= 0], found.shape[1])
        return found


def _where(cells: Cells, which: Int[np.ndarray, "_ c"]) -> Int[np.ndarray, "_ c"]:
    """Numbers of cells, -1 outside of some."""
    return np.where((which >= 0) & cells[np.arange(len(cells)), np.maximum(which, 0)], which, -1)


def counts_of(which: Sequence[Int[np.ndarray, "_ c"]]) -> Float[np.ndarray, "c k"]:
    """Samples in each cell."""
    return StateCells.sums([np.ones(w.shape) for w in which], which)


def followed(predicted: Sequence[Float[np.ndarray, " _"]], axes: Mapping[str, Sequence[Int[np.ndarray, " _"]]]) -> str:
    """The input whose quarters, up and down, leave least of a prediction's variance within them; "" without inputs."""
    values = np.concatenate(predicted)
    there = np.isfinite(values)
    left = {}
    for name, which in axes.items():
        bins, own = np.concatenate(which)[there], values[there]
        mean = np.bincount(bins, own) / np.maximum(np.bincount(bins), 1)
        left[name] = float(((own - mean[bins]) ** 2).sum())
    return min(left, key=lambda name: left[name], default="")


@dataclass(frozen=True, eq=False)
class Structure:
    """A base model on all trials, and p of structure that it leaves in each cell."""

    grid: StateCells
    model: Refit
    p_values: Float[np.ndarray, "c k"]

    @classmethod
    def of(cls, problem: Problem, model: Refit) -> Structure:
        """What a base model, evaluated on all trials, leaves."""
        return cls.within(StateCells.of(problem, model), model)

    @classmethod
    def within(cls, grid: StateCells, model: Refit) -> Structure:
        """The same in given cells."""
        return cls(grid, model, grid.p_values(model.residuals))

    @property
    def q_values(self) -> Float[np.ndarray, "c k"]:
        """Least false-discovery rate at which each cell is found; 1 where it is not tested."""
        found, tested = np.ones(self.p_values.shape), self.grid.tested
        found[tested] = benjamini_yekutieli(self.p_values[tested])
        return found


def benjamini_yekutieli(p: Float[np.ndarray, " m"]) -> Float[np.ndarray, " m"]:
    """q-values under any dependence: least over k ≥ j of p_(k) m (1 + 1/2 + … + 1/m) / k.

    Source: Benjamini & Yekutieli 2001, Ann. Stat. 29:1165.
    """
    rank = np.arange(1, len(p) + 1)
    order = np.argsort(p)
    scaled = p[order] * len(p) * (1.0 / rank).sum() / rank
    q = np.empty(len(p))
    q[order] = np.minimum(1.0, np.minimum.accumulate(scaled[::-1])[::-1])
    return q
