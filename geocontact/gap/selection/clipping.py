"""A recording that reaches the same extreme again and again: an amplifier or a converter at the end of its range.

Many laws bend the top of a curve, but none makes it the same to the last digit, so values are counted: how many lie at
the largest of a channel, and how many at most at one of the next below. Values are all different, unless samples are
held or recorded in steps; of a smooth top the last step holds up to 1/(√2 - 1) = 1 + √2 times what the one below it
does, since the time within a step of the top of a parabola goes with the root of the step. As many or more by chance
have the probability of a Poisson count.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap.case.problem import Problem
from geocontact.gap.case.recorded_steps import measured_columns
from geocontact.gap.inputs.quantisation import resolution
from geocontact.gap.levels import SURE

NEXT = 5  # values below the extreme that it is compared with


@dataclass(frozen=True)
class ClippedChannel:
    """A level [the channel's unit] that is never passed, how many samples lie there, and how sure that is [nats]."""

    channel: str
    level: float
    count: int
    nats: float

    @property
    def words(self) -> str:
        """What is seen."""
        return f"{self.count} samples lie at the same extreme, {self.level:.4g}"


def clipped_channels(problem: Problem) -> tuple[ClippedChannel, ...]:
    """Channels whose recordings end at a level, either way, all trials together."""
    outputs = problem.system.outputs
    looks = np.log(2.0 * len(outputs))
    found = []
    for c, name in enumerate(outputs):
        columns = measured_columns(problem, c)
        if not columns:
            continue
        values, step = np.concatenate(columns), resolution(columns)
        most = float(np.abs(values).max())
        for side in (1.0, -1.0):
            level, count, nats = pile(side * values, step)
            if level > 0.5 * most and nats - looks > SURE:
                found.append(ClippedChannel(name, side * level, count, min(float(nats - looks), 2.0 * SURE)))
    return tuple(found)


def pile(values: Float[np.ndarray, " n"], step: float) -> tuple[float, int, float]:
    """Largest of some values, recorded in steps (0 where there are none); how many share it; nats against chance."""
    from scipy.stats import poisson

    whole = np.round(values / step) * step if step > 0.0 else values
    levels, counts = np.unique(whole, return_counts=True)
    usual = float(counts[-1 - NEXT : -1].max(initial=1)) * (1.0 + np.sqrt(2.0) if step > 0.0 else 1.0)
    return float(levels[-1]), int(counts[-1]), -float(poisson.logsf(counts[-1] - 1, usual))
