"""The scale of k and the lengths of an elbow exoskeleton, from how far a free compensation joint slides.

While the joint slides between its ends its displacement is d_tot but for its zero, in metres: over it the law's d_tot
has to rise one for one. Where the device has a second, rotary joint at the cuff that is free as well, as the paper's
had in its unlocked condition, the cuff turns instead of being pushed aside, and the displacement is d_lin. Either is
asked of the lengths alone, beside the locked forces, which so are counted once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.end_stop import FEWEST, BinMeans, RecordedStroke, slope_over
from geocontact.axis_misalignment.law import ElbowLaw

TOTAL = {0: 1.0, 5: 0.0, 6: 0.0, 7: 0.0}
"""k, b, s and c with which the law's force is d_tot: without force the upper arm's fixation does not yield."""
LINEAR = {**TOTAL, 4: 0.0}
"""And z, with which it is d_lin: what a free joint slides by where a rotary joint beside it is free as well."""


@dataclass(frozen=True, eq=False)
class DisplacementScale:
    """Slope of the law's d_tot over the free displacement, and the error with which it is 1.

    Parameters
    ----------
    law
        At the mean angles of the bins over which the joint slides.
    share
        Of each bin's d_tot in the least-squares slope over the displacement [1/m].
    slope
        That is asked of the law: 1, or a draw about it.
    error
        Standard error of the mean displacement's own scale over the free trials.
    trials
        Free trials.
    rest
        Numbers of the law, by place, with which its force is what the free joint slides by.
    """

    law: ElbowLaw
    share: Float[np.ndarray, " b"]
    slope: float
    error: float
    trials: int
    rest: Mapping[int, float] = field(default_factory=lambda: dict(TOTAL))

    def residual(self, theta: Float[np.ndarray, " 8"]) -> float:
        """What the law's slope is too large by, in standard errors."""
        return (float(self.share @ self.law.force(self._at_rest(theta))) - self.slope) / self.error

    def slopes(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " 8"]:
        """Derivative of the residual with respect to each number; k, b, s and c have none."""
        found = self.share @ self.law.slopes(self._at_rest(theta), fixation=False) / self.error
        found[list(self.rest)] = 0.0
        return np.asarray(found)

    def drawn(self, rng: np.random.Generator) -> DisplacementScale:
        """As it could have been measured."""
        return replace(self, slope=float(rng.normal(self.slope, self.error)))

    def _at_rest(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " 8"]:
        rest = theta.copy()
        rest[list(self.rest)] = list(self.rest.values())
        return rest


def displacement_scale(
    trials: Sequence[BinMeans], stroke: RecordedStroke, width: float, *, rotary_free: bool = False
) -> DisplacementScale | None:
    """The scale by the mean displacement of some free trials; None where it has no standard error.

    That is estimated from how each trial's displacement runs over the mean of all, which takes two trials that differ,
    each with three bins over which the joint slides; `width` is that of a bin [rad]. Where a rotary joint of the device
    was free too (`rotary_free`), the displacement is d_lin.
    """
    found = [slope_over(each.beta, each.joint, stroke, width) for each in trials]
    slopes = np.array([slope for slope, bins in found if bins >= FEWEST])
    error = float(slopes.std(ddof=1) / np.sqrt(len(slopes))) if len(slopes) > 1 else 0.0
    if not error > 0.0:
        return None
    beta, joint = stroke.curve.beta[stroke.slides], stroke.curve.joint[stroke.slides]
    off, still = joint - joint.mean(), np.zeros(len(beta))
    law, share = ElbowLaw(beta, still, still), off / (off @ off)
    return DisplacementScale(law, share, 1.0, error, len(slopes), dict(LINEAR if rotary_free else TOTAL))
