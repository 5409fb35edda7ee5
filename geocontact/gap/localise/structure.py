"""Cells of phase, state and rate in which a base model misses what calibration and held-out trials have alike.

Every channel is cut into cells: parts of the trial, quarters of the range of the input that the channel follows most
closely, on the way up and on the way down. With S the sum over a cell of whitened residuals (noise as stated,
trial-to-trial variation) and n its samples, of the calibration trials and of those that were left out,

    z = S / (λ √n),   λ² = mean over cells of (S_c/n_c - S_o/n_o)² / (1/n_c + 1/n_o),

where λ, of each channel, is pure error: what both sets of trials have alike drops out of the differences, slow noise
and what trials differ by do not (lack of fit against pure error, Fisher 1922). A cell has *structure* where both z have
one sign and are large. Where nothing is missing both are at least T in the same sense with

    p = 2 P(t > T)²,   T = min(|z_c|, |z_o|),

t of Student's distribution with as many degrees of freedom as cells: one set of trials alone makes no structure.

A base model that is fitted to everything spreads what a part of the movement misses over other parts, and so does the
variation between trials that residuals are whitened by; cells beside a strong effect are then found in vain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.stats import t

from geocontact.gap.case.problem import Noise, Problem
from geocontact.gap.case.refit import Refit
from geocontact.gap.levels import FEW, PHASES
from geocontact.gap.reduction.repeats import axes_of
from geocontact.gap.selection.evidence import Judged
from geocontact.gap.selection.held_out_rules import whitened_samples

SHAPE = (FEW, FEW, 2)
"""Cells of a channel: parts of the phase, quarters of a state, down and up."""
Cells = Bool[np.ndarray, "c k"]


@dataclass(frozen=True, eq=False)
class StateCells:
    """Cell of each sample of each trial by channel, calibration trials first.

    Parameters
    ----------
    which
        Number of the cell, -1 where nothing was measured or the cell has too few samples.
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
            which.append(np.where(there, place, -1))
        fitted = len(problem.calibration.trials)
        counts = np.array([counts_of(which[:fitted]), counts_of(which[fitted:])])
        enough: Cells = np.all(counts >= FEW, axis=0)
        channels = np.arange(len(inputs))
        kept = tuple(np.where((w >= 0) & enough[channels, np.maximum(w, 0)], w, -1) for w in which)
        return cls(kept, inputs, fitted)

    @property
    def tested(self) -> Cells:
        """Cells with enough samples."""
        return np.asarray(counts_of(self.which) > 0)

    def inside(self, cells: Cells) -> list[Bool[np.ndarray, "_ c"]]:
        """Samples that lie in some cells, per trial."""
        channels = np.arange(len(cells))
        return [(w >= 0) & cells[channels, np.maximum(w, 0)] for w in self.which]

    def p_values(self, white: Sequence[Float[np.ndarray, "_ c"]]) -> Float[np.ndarray, "c k"]:
        """p of structure in each cell, of whitened residuals in their place; 1 where it is not tested."""
        sets = (slice(self.fitted), slice(self.fitted, None))
        sums = np.array([self.sums(white[some], self.which[some]) for some in sets])
        counts = np.array([counts_of(self.which[some]) for some in sets])
        found, tested = np.ones(counts.shape[1:]), self.tested
        for c, there in enumerate(tested):
            s, n = sums[:, c, there], counts[:, c, there]
            off = (s[0] / n[0] - s[1] / n[1]) ** 2 / (1.0 / n).sum(axis=0)
            if there.sum() < 2 or not off.sum() > 0.0:
                continue
            z = s / np.sqrt(n * off.mean())
            least = np.where(z[0] * z[1] > 0.0, np.abs(z).min(axis=0), 0.0)
            found[c, there] = np.minimum(1.0, 2.0 * t.sf(least, there.sum()) ** 2)
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
    def of(cls, problem: Problem, base: Judged) -> Structure:
        """What a base model leaves, under noise no higher than stated."""
        grid, noise = StateCells.of(problem, base.model), problem.with_lower_noise(base.noise)
        return cls(grid, base.model, structure(problem, grid, base.model, noise))

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


def structure(problem: Problem, grid: StateCells, model: Refit, noise: Noise) -> Float[np.ndarray, "c k"]:
    """p of structure that a base model, evaluated on all trials, leaves in each cell, whitened by a noise."""
    return grid.p_values(whitened_samples(problem.whitenings(noise, model), noise, model.residuals))
