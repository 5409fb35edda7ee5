"""Which of several predicted stances is an outlier, and what it shows that its plate does not.

The study calls a trial an outlier where its error exceeds the mean by more than three standard deviations, and could
not name the source of the one it found. Of n trials no error can exceed the mean by more than (n − 1)/√n standard
deviations, so that this rule is silent below eleven trials, and one outlier widens what it is measured by. Beside it
stands the median with three times the median absolute deviation (times 1.4826, as of a normal distribution).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from geocontact.below_knee_prosthesis.evaluation import JudgedStance
from geocontact.below_knee_prosthesis.simulate import GATE

BEYOND = 3.0
NORMAL = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""
FEWEST = 4
"""Trials below which nothing stands out."""
EARLY = 0.25
"""Share of the stance in which a landing overshoots."""
OVERSHOT, LATE = 0.3, 0.02
"""Body weights, and s."""
INSIDE = (0.04, 0.9)
"""Share of the plate's stance within which the foot should not leave the floor."""


@dataclass(frozen=True)
class Oddness:
    """How far one stance's force is from the others', in standard deviations by both rules.

    Parameters
    ----------
    by_study
        Error less the mean over the standard deviation.
    by_median
        Error less the median over the scaled median absolute deviation.
    """

    by_study: float
    by_median: float

    @property
    def outlier(self) -> bool:
        """By either rule."""
        return self.by_study > BEYOND or self.by_median > BEYOND


def oddness(errors: Mapping[str, float]) -> dict[str, Oddness]:
    """By name; NaN with fewer trials than `FEWEST`."""
    values = np.array(list(errors.values()))
    if len(values) < FEWEST:
        return {name: Oddness(float("nan"), float("nan")) for name in errors}
    median = float(np.median(values))
    spread = NORMAL * float(np.median(np.abs(values - median)))
    mean, sd = float(values.mean()), float(values.std(ddof=1))
    return {
        name: Oddness((value - mean) / sd if sd else 0.0, (value - median) / spread if spread else 0.0)
        for name, value in errors.items()
    }


def reasons(one: JudgedStance) -> Sequence[str]:
    """What a stance shows that the plate does not: each in words; empty where nothing of it is seen."""
    s, errors = one.stance, one.errors
    share, spheres = (s.time - errors.start) / errors.stance[1], s.foot.sole.spheres
    inside = (share > INSIDE[0]) & (share < INSIDE[1])
    found = []
    lost = inside & (s.force[:, 1] < GATE)
    if lost.any():
        found.append(
            f"the foot leaves the floor again at {100.0 * share[lost][0]:.0f} % of the stance for "
            f"{1e3 * lost.sum() * (s.time[1] - s.time[0]):.0f} ms: it lands harder than it did"
        )
    model, measured = one.simulated("resultant"), one.measured("resultant")
    early = np.where(np.isfinite(model) & (errors.share < EARLY), model - measured, -np.inf)
    above = float(early.max())
    if above > OVERSHOT:
        at = float(errors.share[np.argmax(early)])
        touching = int((s.loads.pressing[int(np.argmin(np.abs(share - at)))] > 0.0).sum())
        found.append(f"{above:.1f} BW too much at {100.0 * at:.0f} % of the stance, on {touching} {spheres.kinds}")
    late = errors.stance[0] - errors.stance[1]
    if not np.isfinite(late):
        found.append("its simulation ended before toe-off")
    elif abs(late) > LATE:
        found.append(f"the stance lasts {1e3 * late:+.0f} ms")
    if (s.loads.depth > spheres.deepest).any():
        found.append(f"a {spheres.kind} sinks beyond its {spheres.limit}")
    if any(beyond.any() for beyond in s.beyond):
        found.append("the socket is past its limit")
    return found
