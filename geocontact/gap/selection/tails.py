"""Samples and stretches that no model accounts for weigh less, for every model alike.

What the best model and the surrogate on top of it leave is noise. Where its samples have heavy tails, as a recorder
that jumps or a sensor that is struck makes them, it is a mixture of scales (`identify.noise.student`): the noise of a
sample is divided by the root of its weight. Weights are of the case and not of a model: a smooth effect that is missing
is no tail, since the best model leaves nothing of it, and every model is fitted and judged with them. What even that
model misses is smooth, or returns at the same place of every trial: neither is a tail.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.gap.case.problem import Problem
from geocontact.gap.levels import DEVIATIONS, PHASES, SURE, TURNS
from geocontact.gap.selection.evidence import Judged
from geocontact.identify.noise.covariance import Layout
from geocontact.identify.noise.noise_levels import NoiseLevels
from geocontact.identify.noise.student import StudentNoise, student_noise


@dataclass(frozen=True)
class Tails:
    """How many times its level the noise of each sample is, per trial; channels with tails, and their distribution."""

    louder: tuple[Float[np.ndarray, "_ c"], ...]
    channels: dict[str, StudentNoise]

    @classmethod
    def none(cls, problem: Problem) -> Tails:
        """Every sample weighs the same."""
        return cls(tuple(np.ones(layout.shape) for layout in problem.layouts), {})

    def weighed(self, problem: Problem) -> Problem:
        """The problem with these weights."""
        layouts = (layout.louder(times) for layout, times in zip(problem.layouts, self.louder, strict=True))
        return replace(problem, layouts=tuple(layouts))


def tails(problem: Problem, one: Judged, explained: Sequence[Float[np.ndarray, "_ c"]]) -> Tails:
    """Tails of what a model and something without a name leave.

    Parameters
    ----------
    one
        The best model.
    explained
        What a surrogate on top of it predicts, per trial.
    """
    left = [r - e for r, e in zip(one.model.residuals, explained, strict=True)]
    varied = [v * one.noise.varies for v in problem.varied(one.model.jacobian)]
    louder = [np.ones(part.shape) for part in left]
    normal = most_by_normal(problem.layouts, one.noise.levels, varied)
    found: dict[int, StudentNoise] = {}
    for _ in range(TURNS):
        layouts = [layout.louder(times) for layout, times in zip(problem.layouts, louder, strict=True)]
        parts = zip(layouts, left, varied, louder, strict=True)
        off = [standing_out(layout, one.noise.levels, r, v) * times for layout, r, v, times in parts]
        found = {}
        for c in range(len(problem.system.outputs)):
            columns = [sharp(each[:, c]) for each in off]
            own = student_noise(np.concatenate([each[np.isfinite(each)] for each in columns]))
            alike = returning([own.weights(each) for each in columns])
            if own.gain > normal[c] and alike < by_chance(len(columns)):
                found[c] = own
        louder = [_louder(layout, each, found) for layout, each in zip(layouts, off, strict=True)]
        if not found:
            break
    return Tails(tuple(louder), {problem.system.outputs[c]: own for c, own in found.items()})


def most_by_normal(
    layouts: Sequence[Layout], levels: NoiseLevels, varied: Sequence[Float[np.ndarray, "_ c q"]]
) -> list[float]:
    """What Student's distribution hardly gains in each channel where noise is normal, of the covariance that it is
    taken for [nats].

    Not nothing: of two normal numbers the smaller, which `sharp` takes, is not normal, and the gain grows with the
    number of samples, its spread with the root of it: a dozen nats for a few thousand. One draw, always the same, which
    has that spread itself; twice `SURE` beyond it at the least.
    """
    rng = np.random.default_rng(0)
    off = []
    for layout, own in zip(layouts, varied, strict=True):
        whitener, noise = layout.whitener(levels), np.full(layout.shape, np.nan).ravel()
        for rows, factor in zip(whitener.rows, whitener.factors, strict=True):
            noise[rows] = np.linalg.solve(factor, rng.standard_normal(len(rows)))
        off.append(standing_out(layout, levels, np.nan_to_num(noise.reshape(layout.shape)), own))
    columns = [[sharp(each[:, c]) for each in off] for c in range(layouts[0].shape[1])]
    drawn = [student_noise(np.concatenate([x[np.isfinite(x)] for x in each])) for each in columns]
    return [one.gain + max(2.0 * SURE, DEVIATIONS * float(np.sqrt(2.0)) * one.spread) for one in drawn]


def sharp(off: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """The part of each sample that its neighbours in time do not share; NaN where nothing was measured.

    What a model leaves of an effect is smooth. Of a sample and its distance from the mean of its neighbours, in
    standard deviations of independent noise, it is the smaller.
    """
    beside = np.concatenate([off[1:2], 0.5 * (off[:-2] + off[2:]), off[-2:-1]])
    apart = (off - np.where(np.isfinite(beside), beside, 0.0)) / np.sqrt(1.0 + 0.5)
    return np.asarray(np.where(np.abs(apart) < np.abs(off), apart, off))


def by_chance(trials: int) -> float:
    """Correlation that `returning` has by chance: beyond it noise depends on the movement, or there is a gap."""
    return DEVIATIONS / float(np.sqrt(PHASES * trials))


def returning(weights: Sequence[Float[np.ndarray, " _"]]) -> float:
    """How alike the places in a trial are where samples weigh little: correlation with the mean of the other trials."""
    profiles = np.full((len(weights), PHASES), np.nan)
    for profile, own in zip(profiles, weights, strict=True):
        for k, part in enumerate(np.array_split(np.log(own), PHASES)):
            if np.isfinite(part).any():
                profile[k] = np.nanmean(part)
    profiles = profiles[:, np.isfinite(profiles).all(axis=0)]
    if min(profiles.shape) < 2:
        return 0.0
    others = (profiles.sum(axis=0) - profiles) / (len(profiles) - 1)
    both = [(a - a.mean(), b - b.mean()) for a, b in zip(profiles, others, strict=True)]
    return float(np.mean([a @ b / max(np.sqrt((a @ a) * (b @ b)), 1e-300) for a, b in both]))


def _louder(
    layout: Layout, off: Float[np.ndarray, "t c"], channels: dict[int, StudentNoise]
) -> Float[np.ndarray, "t c"]:
    """One over the root of each sample's weight; stretches are the layout's blocks, channel by channel."""
    flat, out = np.column_stack([sharp(column) for column in off.T]).ravel(), np.ones(off.size)
    for block in layout.blocks:
        for c, own in channels.items():
            rows = block.rows[block.channel == c]
            (weights,) = own.weights_of_stretches([flat[rows]])
            out[rows] = 1.0 / np.sqrt(weights)
    return out.reshape(off.shape)


def standing_out(
    layout: Layout, levels: NoiseLevels, residual: Float[np.ndarray, "t c"], varied: Float[np.ndarray, "t c q"]
) -> Float[np.ndarray, "t c"]:
    """How far each sample is from what all others of its block make of it, in standard deviations of that; NaN where
    nothing was measured.

    With the covariance K of a block it is (K⁻¹ r)_i / sqrt((K⁻¹)_ii), after what the trial differs by is taken out.
    """
    whitener = layout.whitener(levels)
    white, design = whitener(residual[..., None])[:, 0], whitener(varied)
    own = np.linalg.solve(np.eye(design.shape[1]) + design.T @ design, design.T @ white)
    white = white - design @ own
    out, at = np.full(residual.size, np.nan), 0
    for rows, factor in zip(whitener.rows, whitener.factors, strict=True):
        out[rows] = factor.T @ white[at : at + len(rows)] / np.sqrt((factor**2).sum(axis=0))
        at += len(rows)
    return out.reshape(residual.shape)
