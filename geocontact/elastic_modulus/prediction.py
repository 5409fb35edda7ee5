"""Force of a trial that was not used, from its area and what was identified; and the frames that two clocks share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.elastic_modulus.area_force import ThresholdAreas
from geocontact.elastic_modulus.identify import Identification, agreement
from geocontact.identify.signals.filters import gaps, in_gaps


@dataclass(frozen=True, eq=False)
class Prediction:
    """Predicted and, where it is known, measured force of one side [N]; `measured` is NaN outside its recording."""

    side: str
    time: Float[np.ndarray, " t"]
    predicted: Float[np.ndarray, " t"]
    measured: Float[np.ndarray, " t"] | None

    @property
    def rmse(self) -> float:
        """Root mean square error [N] where both are known."""
        return self._agreement()[0]

    @property
    def r2(self) -> float:
        """R^2 about the mean of what was measured."""
        return self._agreement()[1]

    def _agreement(self) -> tuple[float, float]:
        if self.measured is None:
            return float("nan"), float("nan")
        there = np.isfinite(self.measured)
        return agreement(self.measured[there], self.predicted[there])


def predicted_force(areas: ThresholdAreas, each: Identification, threshold: float) -> Float[np.ndarray, " t"]:
    """Force [N] that areas within `threshold` [m] carry by the law, reading and adhesion that were identified."""
    unit, sticks = areas.per_modulus(each.model.reading, threshold), each.model.sticking(each.fit.values)
    if sticks is None:
        return np.asarray(each.modulus * unit)
    return sticks.force(unit, sticks.pull(areas.within(threshold), areas.radius), each.modulus)


def shared_frames(
    time: Float[np.ndarray, " t"],
    clock: Float[np.ndarray, " s"],
    lag: float,
    bounds: tuple[float, float],
) -> Bool[np.ndarray, " t"]:
    """Frames of the area that have a force at `lag`, and an area at every lag within `bounds`.

    Parameters
    ----------
    time
        Of the frames [s].
    clock
        Of the force's samples [s]; frames that fall into a gap of it are left out.
    lag, bounds
        Of the force's clock behind the area's [s].
    """
    low, high = bounds
    inside = (time + lag >= clock[0]) & (time + lag <= clock[-1])
    inside &= (time + lag - high >= time[0] - 1e-12) & (time + lag - low <= time[-1] + 1e-12)
    return np.asarray(inside & ~in_gaps(time + lag, gaps(clock)))
