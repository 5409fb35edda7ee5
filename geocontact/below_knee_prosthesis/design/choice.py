"""Which value or pair of values is best, within which interval, and whether the model can tell.

The values of each draw that are as good as its best, within a hundredth of the outcome, make an interval, for each
response of the person. It is an answer where it is narrower than most of the range; where the value has no effect on
the aim, or the two that are judged call for different values, there is none. Torques kept in hip and knee have a
verdict of their own beside it. What a band cannot tell from nothing is not called a difference.

The best pair and the best value at the present alignment are those whose worse response, in the median over the draws,
is nearest to the aim. What the pair gains is a difference within each draw.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator

from geocontact.below_knee_prosthesis.design.knob import JUDGED, RESPONSES, Response
from geocontact.below_knee_prosthesis.design.outcomes import Sense

FINE = 401
"""Values between which the best is sought."""
FLAT, WIDE = 0.01, 0.6
"""Difference of an outcome over its size that is none; share of the range that is no answer."""
SideVerdict = Literal["identified", "no effect", "not identified"]


@dataclass(frozen=True)
class Side:
    """The best value if the person responds in one way.

    Parameters
    ----------
    best, lower, upper
        Median and interval over the draws.
    """

    best: float
    lower: float
    upper: float
    verdict: SideVerdict


@dataclass(frozen=True)
class FootChoice:
    """The answer.

    Parameters
    ----------
    told
        Whether there is one.
    best, lower, upper
        Over the responses that are judged; the whole range where there is no answer.
    gain
        By response: how much nearer to the aim than the present value the best one is, median and interval, in the
        outcome's unit; empty where there is no answer.
    why
        In words.
    """

    sides: Mapping[Response, Side]
    told: bool
    best: float
    lower: float
    upper: float
    gain: Mapping[Response, tuple[float, float, float]]
    why: str

    @property
    def better(self) -> bool:
        """Whether the best is better than the present value in every response that the value has an effect in."""
        return bool(self.gain) and all(lower > 0.0 for _, lower, _ in self.gain.values())


def choose(
    values: Float[np.ndarray, " n"],
    drawn: Float[np.ndarray, "d responses n"],
    sense: Sense,
    target: float | None,
    present: float,
    level: float,
) -> FootChoice:
    """Choice from draws of one outcome by response and value.

    Parameters
    ----------
    target
        Wanted value of the outcome; None where the least or the most is best.
    present
        Value that the person has now.
    level
        Probability of the intervals.
    """
    sides = {name: _side(values, drawn[:, k], sense, target, level) for k, name in enumerate(RESPONSES)}
    judged = {name: sides[name] for name in JUDGED}
    telling = {name: side for name, side in judged.items() if side.verdict == "identified"}
    whole = float(values[0]), float(values[-1])

    def silent(why: str) -> FootChoice:
        return FootChoice(sides, False, float("nan"), *whole, {}, why)

    if any(side.verdict == "not identified" for side in judged.values()):
        blind = " and ".join(name for name, side in judged.items() if side.verdict == "not identified")
        return silent(f"with {blind} most of the range may be best")
    if not telling:
        return silent("no value has any effect")
    lower, upper = min(side.lower for side in telling.values()), max(side.upper for side in telling.values())
    if upper - lower > WIDE * (whole[1] - whole[0]):
        return silent("what is best hangs on whether the person keeps angles or torque")
    best = float(np.mean([side.best for side in telling.values()]))
    gain = {
        name: _gain(values, drawn[:, k], sense, target, (present, best), level)
        for k, name in enumerate(RESPONSES)
        if name in telling or (name not in judged and sides[name].verdict == "identified")
    }
    idle = [name for name in judged if name not in telling]
    why = f"with {' and '.join(idle)} it has no effect" if idle else "whether angles or torque are kept"
    return FootChoice(sides, True, best, lower, upper, gain, why)


def _side(
    values: Float[np.ndarray, " n"], drawn: Float[np.ndarray, "d n"], sense: Sense, target: float | None, level: float
) -> Side:
    fine = np.linspace(values[0], values[-1], FINE)
    worth = away(PchipInterpolator(values, drawn, axis=1)(fine), sense, target)
    size = float(np.median(np.abs(drawn)))
    near = worth <= worth.min(axis=1, keepdims=True) + FLAT * size
    lower = interval(fine[np.argmax(near, axis=1)], level)[1]
    upper = interval(fine[len(fine) - 1 - np.argmax(near[:, ::-1], axis=1)], level)[2]
    best = float(np.median(fine[np.argmin(worth, axis=1)]))
    span = float(np.median(drawn.max(axis=1) - drawn.min(axis=1)))
    verdict: SideVerdict = "identified"
    if span < FLAT * size:
        verdict = "no effect"
    elif upper - lower > WIDE * (values[-1] - values[0]):
        verdict = "not identified"
    return Side(best, lower, upper, verdict)


def _gain(
    values: Float[np.ndarray, " n"],
    drawn: Float[np.ndarray, "d n"],
    sense: Sense,
    target: float | None,
    ends: tuple[float, float],
    level: float,
) -> tuple[float, float, float]:
    """Gain of the second value over the first, draw by draw."""
    both = away(PchipInterpolator(values, drawn, axis=1)(np.array(ends)), sense, target)
    return interval(both[:, 0] - both[:, 1], level)


def interval(sample: Float[np.ndarray, " d"], level: float) -> tuple[float, float, float]:
    """Median, and the interval of that probability with as much outside on either side, of draws: rather too wide."""
    lower = np.quantile(sample, 0.5 * (1.0 - level), method="lower")
    upper = np.quantile(sample, 0.5 * (1.0 + level), method="higher")
    return float(np.median(sample)), float(lower), float(upper)


def away(outcome: Float[np.ndarray, "*d n"], sense: Sense, target: float | None) -> Float[np.ndarray, "*d n"]:
    """How far an outcome is from what is wanted: the smaller the better. ValueError for the nearest to nothing."""
    if target is not None:
        return np.abs(outcome - target)
    if sense == "nearest":
        raise ValueError("a target is needed")
    return outcome if sense == "least" else -outcome


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
        Least and largest values and alignments whose pairs are not separable from the best, with whatever the other is.
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
    """Choice from draws of one outcome; the present alignment, 0, is among them.

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
