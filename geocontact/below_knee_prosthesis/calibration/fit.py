"""How near a calibrated foot comes to its stance, and what speaks against the fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration
from geocontact.below_knee_prosthesis.calibration.known_numbers import KnownNumber
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WholeCalibration
from geocontact.identify.signals.agreement import Agreement, agreement

FAR, LARGE = 2.0, 2.0
"""Standard deviations of height and pitch, and residual over noise, root mean square, that are warned of."""
MISSED = 0.04
"""Vertical force that may be missed, root mean square, in body weights: stances that the model made leave 0.01 to 0.02,
a foot that stood 0.57 degrees out of flat left 0.053 with height and pitch held. Their errors are in the residual's
noise, so that it alone hardly says so."""
SHARE_OF_DEPTH = 1.0
"""Share of its radius that a sphere may sink before its centre is under the ground."""


@dataclass(frozen=True, eq=False)
class StanceFit:
    """A stance with the numbers found, by the model that found them last.

    Parameters
    ----------
    predicted
        By `CHANNELS`: force in the ground's frame [N], centre of pressure from the heel (share of the foot).
    slip
        Along the floor, beside the recorded speed [m/s]; nothing on the whole model.
    vertical, centre
        Agreement of the vertical force over body weight, and of the centre, with the plate's.
    sunk
        Whether a sphere sinks beyond its radius along the recorded poses.
    """

    predicted: Float[np.ndarray, "t 4"]
    slip: Float[np.ndarray, "t 2"]
    vertical: Agreement
    centre: Agreement
    sunk: bool


def stance_fit(found: SoleCalibration, whole: WholeCalibration | None = None) -> StanceFit:
    """Fit of the first stance of a calibration; of the one on the whole model where there is one."""
    residuals = found.residuals
    stance = residuals.stances[0]
    motion, slip = residuals.motion(found.at, 0)
    predicted = residuals.stance(found.at, 0).predicted(found.foot.at(stance.fulcrum), motion)
    if whole is not None:
        one = whole.residuals.whole(whole.at, 0)
        predicted, slip = one.channels(one.shown(whole.foot)), 0.0 * slip
    step = float(np.median(np.diff(stance.time)))
    model, measured = predicted / stance.weight, stance.measured / stance.weight
    return StanceFit(
        predicted,
        slip,
        agreement(model[:, 1], measured[:, 1], step, 0.0),
        agreement(predicted[:, 3], stance.centre, step, 0.0),
        bool((motion.loads.depth > SHARE_OF_DEPTH * found.foot.sole.spheres.radius).any()),
    )


def residual_over_noise(found: SoleCalibration | WholeCalibration) -> float:
    """Residual of the data at the numbers found, over their noise, root mean square."""
    return float(np.sqrt(np.mean(found.residuals.of_data(found.at) ** 2)))


def fore_aft_error(predicted: Float[np.ndarray, "t 4"], stance: RecordedStance) -> float:
    """Root mean square difference of the force along the walk, in body weights."""
    off = (predicted - stance.measured)[:, 0] / stance.weight
    return float(np.sqrt(np.mean(off**2)))


def known_of(found: SoleCalibration | WholeCalibration) -> tuple[KnownNumber, ...]:
    """Numbers of the zones, then height and pitch of the foot relative to its standing trial."""
    return *found.knowledge.numbers, *found.knowledge.beside


def doubts_of_fit(height: float, pitch: float, residual: float, vertical: float) -> list[str]:
    """Reasons against a fit, each in a sentence.

    Parameters
    ----------
    height, pitch
        Of the foot beside its standing trial, in standard deviations of their errors.
    residual
        Root mean square over what plate, height and pitch leave.
    vertical
        Root mean square difference of the vertical force, in body weights.
    """
    reasons = []
    if max(abs(height), abs(pitch)) > FAR:
        what = "height or pitch of the foot is more than two standard deviations off the standing trial"
        reasons.append(f"{what}: did the foot stand flat in `static`?")
    if residual > LARGE or vertical > MISSED:
        reasons.append(
            f"the vertical force is missed by {vertical:.1%} of body weight, the residual is {residual:.1f} times its "
            "noise: the model does not fit this stance, its numbers and their intervals are not to be trusted; check "
            "`mass`, `setting`, plate and markers"
        )
    return reasons
