"""Whether turning the foot on the socket gains anything beside the best fulcrum or stiffness alone.

The best pair and the best value at the present alignment are those whose worse response, in the median over the draws,
is nearest to the aim. What the pair gains is a difference within each draw.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.choice import FLAT, away, interval
from geocontact.below_knee_prosthesis.design.knob import JUDGED, Response
from geocontact.below_knee_prosthesis.design.outcomes import Sense


@dataclass(frozen=True)
class PairChoice:
    """The answer.

    Parameters
    ----------
    value, alignment
        Of the best pair.
    alone
        The best value at the present alignment.
    gain
        By response: how much nearer to the aim the pair is than `alone`, median and interval, in the outcome's unit.
    as_good, alignments
        Least and largest values and alignments whose pairs cannot be told from the best, with whatever the other is.
    better
        Whether it gains more than a hundredth of the outcome, surely, in every response that is judged.
    """

    value: float
    alignment: float
    alone: float
    gain: Mapping[Response, tuple[float, float, float]]
    as_good: tuple[float, float]
    alignments: tuple[float, float]
    better: bool


def choose_pair(
    values: Float[np.ndarray, " n"],
    alignments: Float[np.ndarray, " m"],
    drawn: Float[np.ndarray, "d m judged n"],
    sense: Sense,
    target: float | None,
    level: float,
) -> PairChoice:
    """Of draws of one outcome; the present alignment, 0, is among them.

    Parameters
    ----------
    target
        Wanted value of the outcome; None where the least or the most is best.
    level
        Probability of the intervals.
    """
    worth = away(drawn, sense, target)
    worse = np.median(worth, axis=0).max(axis=1)
    here = int(np.flatnonzero(alignments == 0.0)[0])
    m, n = (int(k) for k in np.unravel_index(int(np.argmin(worse)), worse.shape))
    alone = int(np.argmin(worse[here]))
    gain = {name: interval(worth[:, here, j, alone] - worth[:, m, j, n], level) for j, name in enumerate(JUDGED)}
    behind = np.quantile(worth - worth[:, m : m + 1, :, n : n + 1], 0.5 * (1.0 - level), axis=0, method="lower")
    as_good = (behind <= 0.0).any(axis=1)
    near = [np.flatnonzero(as_good.any(axis=axis)) for axis in (0, 1)]
    least = FLAT * float(np.median(np.abs(drawn)))
    return PairChoice(
        value=float(values[n]),
        alignment=float(alignments[m]),
        alone=float(values[alone]),
        gain=gain,
        as_good=(float(values[near[0][0]]), float(values[near[0][-1]])),
        alignments=(float(alignments[near[1][0]]), float(alignments[near[1][-1]])),
        better=all(lower > 0.0 and median > least for median, lower, _ in gain.values()),
    )
