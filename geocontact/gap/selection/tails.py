"""Samples and stretches that no model accounts for weigh less, for every model alike.

What the best model and the surrogate on top of it leave is noise. Where its samples have heavy tails, as a recorder
that jumps or a sensor that is struck makes them, it is a mixture of scales (`identify.noise.student`): the noise of a
sample is divided by the root of its weight. Weights are of the case and not of a model: a smooth effect that is missing
is no tail, since the best model leaves nothing of it, and every model is fitted and judged with them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.gap.case.problem import Problem
from geocontact.gap.selection.evidence import Judged
from geocontact.identify.noise.covariance import Layout
from geocontact.identify.noise.noise_levels import NoiseLevels
from geocontact.identify.noise.student import StudentNoise, student_noise

SURE = 12.0
"""Nats that heavy tails must gain over normal noise in a channel."""
ROUNDS = 4
"""Times that weights are found anew: a sample that is off misleads about those next to it."""


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
    found: dict[int, StudentNoise] = {}
    for _ in range(ROUNDS):
        layouts = [layout.louder(times) for layout, times in zip(problem.layouts, louder, strict=True)]
        parts = zip(layouts, left, varied, louder, strict=True)
        off = [standing_out(layout, one.noise.levels, r, v) * times for layout, r, v, times in parts]
        found = {}
        for c in range(len(problem.system.outputs)):
            there = (layout.rows[layout.rows % off[0].shape[1] == c] for layout in layouts)
            own = student_noise(np.concatenate([each.ravel()[rows] for each, rows in zip(off, there, strict=True)]))
            if own.gain > SURE:
                found[c] = own
        louder = [_louder(layout, each, found) for layout, each in zip(layouts, off, strict=True)]
        if not found:
            break
    return Tails(tuple(louder), {problem.system.outputs[c]: own for c, own in found.items()})


def _louder(
    layout: Layout, off: Float[np.ndarray, "t c"], channels: dict[int, StudentNoise]
) -> Float[np.ndarray, "t c"]:
    """One over the root of each sample's weight; stretches are the layout's blocks, channel by channel."""
    flat, out = off.ravel(), np.ones(off.size)
    for block in layout.blocks:
        for c, own in channels.items():
            rows = block.rows[block.channel == c]
            (weights,) = own.weights_of_stretches([flat[rows]])
            out[rows] = 1.0 / np.sqrt(weights)
    return out.reshape(off.shape)


def standing_out(
    layout: Layout, levels: NoiseLevels, residual: Float[np.ndarray, "t c"], varied: Float[np.ndarray, "t c q"]
) -> Float[np.ndarray, "t c"]:
    """How far each sample is from what all others of its block make of it, in standard deviations of that.

    With the covariance K of a block it is (K⁻¹ r)_i / sqrt((K⁻¹)_ii), after what the trial differs by is taken out.
    """
    whitener = layout.whitener(levels)
    white, design = whitener(residual[..., None])[:, 0], whitener(varied)
    own = np.linalg.solve(np.eye(design.shape[1]) + design.T @ design, design.T @ white)
    white = white - design @ own
    out, at = np.zeros(residual.size), 0
    for rows, factor in zip(whitener.rows, whitener.factors, strict=True):
        out[rows] = factor.T @ white[at : at + len(rows)] / np.sqrt((factor**2).sum(axis=0))
        at += len(rows)
    return out.reshape(residual.shape)
