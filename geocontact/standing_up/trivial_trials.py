"""Predictors without a model: what other trials did over the parts of their movement, all of them or the nearest."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.trials import StandingTrial

PLACES = 2
"""Coordinates before the angles."""


def mean_trial(others: Sequence[StandingTrial], time: Float[np.ndarray, " t"]) -> StandingTrial:
    """Mean of others over parts of the movement, which knows nothing of the trial but how long it is.

    Torques, straps and shear are None where one of them has none; straps that were not recorded do not count.
    """
    part = (time - time[0]) / np.ptp(time)

    def mean(of: Callable[[StandingTrial], Float[np.ndarray, "t ..."] | None]) -> Float[np.ndarray, "t ..."] | None:
        found = []
        for other in others:
            values = of(other)
            if values is None:
                return None
            if np.isnan(values).all():
                continue
            own = (other.time - other.time[0]) / np.ptp(other.time)
            columns = [np.interp(part, own, column) for column in values.reshape(len(own), -1).T]
            found.append(np.stack(columns, axis=1).reshape(len(part), *values.shape[1:]))
        return np.asarray(np.mean(found, axis=0)) if found else None

    q, u, force, centre = (mean(of) for of in (lambda t: t.q, lambda t: t.u, lambda t: t.force, lambda t: t.centre))
    if q is None or u is None or force is None or centre is None:
        raise ValueError("a trial has no coordinates")
    torque, strap, shear = mean(lambda t: t.torque), mean(lambda t: t.strap), mean(lambda t: t.shear)
    elsewhere = {}
    for site in others[0].elsewhere:
        pressed = mean(partial(_at, site))
        if pressed is not None:
            elsewhere[site] = pressed
    return StandingTrial(time, q, u, force, centre, "mean of others", torque, strap, elsewhere=elsewhere, shear=shear)


def _at(site: str, trial: StandingTrial) -> Float[np.ndarray, " t"] | None:
    return trial.elsewhere.get(site)


def nearest_trial(others: Sequence[StandingTrial], trial: StandingTrial) -> StandingTrial:
    """The one of others whose first and last angles are nearest, which are given of the trial too."""

    def away(other: StandingTrial) -> float:
        return float(np.sum((other.q[[0, -1]] - trial.q[[0, -1]])[:, PLACES:] ** 2))

    return min(others, key=away)
