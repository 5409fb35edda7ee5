"""Force and centre of pressure of a stance as the study compares them: filtered, over its length, in 101 points.

Forces of a quarter of a second before and after are in it where they were recorded, the centre of the stance only.
Filters are zero-lag Butterworth of the fourth order, 40 Hz for forces and 6 Hz for the centre (sec. 2.4 and 2.5).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline

from geocontact.identify.signals.agreement import agreement
from geocontact.identify.signals.zero_lag import zero_lag

GATE, AROUND, POINTS = 20.0, 0.25, 101
"""N of vertical force in stance, s around it, and samples."""
FORCE_CUTOFF, CENTRE_CUTOFF = 40.0, 6.0
"""Hz."""


@dataclass(frozen=True, eq=False)
class StanceCurves:
    """Of one stance.

    Parameters
    ----------
    force
        Over body weight.
    centre
        From the heel, share of the foot's length.
    window
        What the force's points span [s].
    stance
        How long the foot is loaded [s].
    """

    force: Float[np.ndarray, "n 3"]
    centre: Float[np.ndarray, " n"]
    window: float
    stance: float

    @property
    def resultant(self) -> Float[np.ndarray, " n"]:
        """Size of the force over body weight."""
        return np.linalg.norm(self.force, axis=1)

    @property
    def impulse(self) -> Float[np.ndarray, " n"]:
        """Of the resultant since the window's start over body weight [s]."""
        r = self.resultant
        step = self.window / (len(r) - 1)
        return np.concatenate([[0.0], np.cumsum(0.5 * (r[1:] + r[:-1]))]) * step


@dataclass(frozen=True)
class CurveAgreement:
    """Of a model with what was measured; R² about the measured mean, RMSE over body weight or the foot's length.

    Parameters
    ----------
    stance
        Model's less measured [s].
    """

    force_r2: float
    force_rmse: float
    forward_rmse: float
    upward_rmse: float
    sideways_rmse: float
    impulse_r2: float
    impulse_rmse: float
    centre_r2: float
    centre_rmse: float
    stance: float


def stance_span(time: Float[np.ndarray, " t"], force: Float[np.ndarray, "t 3"]) -> tuple[float, float]:
    """First and last time at which the foot is loaded [s]; ValueError where it never is."""
    on = np.flatnonzero(force[:, 1] >= GATE)
    if not len(on):
        raise ValueError(f"the vertical force stays below {GATE:g} N")
    return float(time[on[0]]), float(time[on[-1]])


def stance_curves(
    time: Float[np.ndarray, " t"],
    force: Float[np.ndarray, "t 3"],
    centre: Float[np.ndarray, " t"],
    weight: float,
    span: tuple[float, float],
) -> StanceCurves:
    """Of forces [N] and centres at even times over the measured stance, `span` of `stance_span`."""
    step = float(time[1] - time[0])
    smooth = zero_lag(force, step, FORCE_CUTOFF) / weight
    ends = max(span[0] - AROUND, float(time[0])), min(span[1] + AROUND, float(time[-1]))
    at = np.linspace(*ends, POINTS)
    on = np.isfinite(centre) & (force[:, 1] >= GATE) & (time >= span[0]) & (time <= span[1])
    share = np.full(POINTS, np.nan)
    if on.sum() > 1:
        inside = (time >= time[on][0]) & (time <= time[on][-1])
        whole = np.interp(time[inside], time[on], centre[on])
        if len(whole) > MOST_SHORT:
            whole = zero_lag(whole, step, CENTRE_CUTOFF)
        share = np.interp(np.linspace(*span, POINTS), time[inside], whole, np.nan, np.nan)
    own = np.flatnonzero(force[:, 1] >= GATE)
    lasting = float(time[own[-1]] - time[own[0]]) if len(own) else 0.0
    return StanceCurves(make_interp_spline(time, smooth, k=3)(at), share, ends[1] - ends[0], lasting)


MOST_SHORT = 15
"""Samples that are not filtered."""


def curve_agreement(model: StanceCurves, measured: StanceCurves) -> CurveAgreement:
    """Point by point."""
    force = agreement(model.resultant, measured.resultant, 1.0, 0.0)
    parts = np.sqrt(np.mean((model.force - measured.force) ** 2, axis=0))
    impulse = agreement(model.impulse, measured.impulse, 1.0, 0.0)
    centre = agreement(model.centre, measured.centre, 1.0, 0.0)
    return CurveAgreement(
        force.r2,
        force.rmsd,
        *map(float, parts),
        impulse.r2,
        impulse.rmsd,
        centre.r2,
        centre.rmsd,
        model.stance - measured.stance,
    )


def mean_curves(others: Sequence[StanceCurves]) -> StanceCurves:
    """The mean of other stances point by point: what predicts a trial without any model."""
    return StanceCurves(
        np.mean([each.force for each in others], axis=0),
        np.mean([each.centre for each in others], axis=0),
        float(np.mean([each.window for each in others])),
        float(np.mean([each.stance for each in others])),
    )
