"""How near a calibrated foot comes to its stance, and what speaks against the fit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration
from geocontact.below_knee_prosthesis.calibration.known_numbers import KnownNumber
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WholeCalibration
from geocontact.data.parameter import Parameter
from geocontact.identify.goodness_of_fit import FAR as TOO_LARGE
from geocontact.identify.goodness_of_fit import (
    LARGER,
    SURE,
    Doubt,
    GoodnessOfFit,
    of_bounds,
    of_r2,
    of_range,
    residual_test,
)
from geocontact.identify.signals.agreement import Agreement, agreement

FAR, LARGE = 2.0, 2.0
"""Standard deviations of height and pitch, and residual over noise, root mean square, that are warned of."""
MISSED = 0.04
"""Vertical force that may be missed, root mean square, in body weights: stances that the model made leave 0.01 to 0.02,
a foot that stood 0.57 degrees out of flat left 0.053 with height and pitch held. Their errors are in the residual's
noise, so that it alone hardly says so."""
NOT_MET = 0.12
"""The same from which the model contradicts the stance: the shipped stances, of a finer foot, leave 0.06 to 0.07, the
wrong setting of the foot 0.29."""
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
        Share of the frames in which a sphere sinks beyond its radius, or foam beyond its thickness, along the recorded
        poses.
    """

    predicted: Float[np.ndarray, "t 4"]
    slip: Float[np.ndarray, "t 2"]
    vertical: Agreement
    centre: Agreement
    sunk: float


def stance_fit(found: SoleCalibration, whole: WholeCalibration | None = None, place: int = 0) -> StanceFit:
    """Fit of one stance of a calibration, the first by default; of the one on the whole model where there is one."""
    residuals = found.residuals
    stance = residuals.stances[place]
    motion, slip = residuals.motion(found.at, place)
    predicted = residuals.stance(found.at, place).predicted(found.foot.at(stance.fulcrum), motion)
    if whole is not None:
        one = whole.residuals.whole(whole.at, place)
        predicted, slip = one.channels(one.shown(whole.foot)), 0.0 * slip
    step = float(np.median(np.diff(stance.time)))
    model, measured = predicted / stance.weight, stance.measured / stance.weight
    return StanceFit(
        predicted,
        slip,
        agreement(model[:, 1], measured[:, 1], step, 0.0),
        agreement(predicted[:, 3], stance.centre, step, 0.0),
        float((motion.loads.depth > SHARE_OF_DEPTH * found.foot.sole.spheres.deepest).any(axis=1).mean()),
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


@dataclass(frozen=True, eq=False)
class FittedStance:
    """A stance of a calibration and its fit.

    Parameters
    ----------
    name
        What doubts about it begin with; "" where it is the only one.
    """

    name: str
    stance: RecordedStance
    fit: StanceFit


def goodness_of(found: SoleCalibration | WholeCalibration, fitted: Sequence[FittedStance]) -> GoodnessOfFit:
    """Every stance with the numbers found against its plate, the numbers against their bounds, the foot's own limits.

    Parameters
    ----------
    fitted
        Stances in the order of the calibration.
    """
    doubts = list[Doubt]()
    parts = residuals_by_channel(found)
    for place, each in enumerate(fitted):
        channels = dict(zip(CHANNEL_WORDS, parts[place][: len(CHANNEL_WORDS)], strict=True))
        residual = float(np.sqrt(np.mean(np.concatenate(parts[place]) ** 2)))
        own = [*_doubts_of_stance(found, each, place, residual), *_doubts_of_channels(channels)]
        doubts += [replace(one, what=f"{each.name}: {one.what}") if each.name else one for one in own]
    numbers = [each.name for each in found.knowledge.numbers if each.verdict != "unknown"]
    values = {each.name: each.value for each in found.knowledge.numbers}
    for bounded in found.residuals.zones.parameters():
        if bounded.name in numbers:
            doubts += _on_bound(bounded, values[bounded.name])
    return GoodnessOfFit(tuple(doubts), (*CHANNEL_WORDS, *numbers))


def _doubts_of_stance(
    found: SoleCalibration | WholeCalibration, one: FittedStance, place: int, residual: float
) -> list[Doubt]:
    """Reasons against the fit of one stance, whose residual over its noise has a root mean square."""
    offset, e, fit = found.offsets[found.residuals.standing[place]], one.stance.errors, one.fit
    doubts = doubts_of_fit(offset.height / e.standing, offset.pitch / e.pitch, residual, fit.vertical.rmsd)
    doubts += [*of_r2("vertical force", fit.vertical.r2), *of_r2("centre of pressure", fit.centre.r2)]
    spheres = found.residuals.zones.sole.spheres
    sinks = f"a {spheres.kind} sinks beyond its {spheres.limit}"
    doubts += of_range(f"{sinks}, the foot is too low or the sole too soft, for", fit.sunk)
    return doubts


def _doubts_of_channels(parts: Mapping[str, Float[np.ndarray, " _"]]) -> list[Doubt]:
    """Channels whose residuals are larger than plate and poses leave."""
    doubts = []
    for name, residual in parts.items():
        if not len(residual):
            continue
        test = residual_test(residual, 1.0)
        if test.excess > SURE and test.ratio > LARGER:
            what = f"{name}: the residual is {test.ratio:.3g} times what plate and poses leave"
            doubts.append(Doubt(what, test.ratio > TOO_LARGE, test.ratio))
    return doubts


def _on_bound(each: Parameter, value: float) -> list[Doubt]:
    """A doubt for a number whose logarithm is on a bound of its search."""
    here, lower, upper = (float(np.log(end)) for end in (value, each.lower, each.upper))
    where = f"{each.name} is on a bound of its search, {value:.4g} {each.unit}"
    return [Doubt(where, False) for _ in of_bounds({each.name: (here, lower, upper)})]


CHANNEL_WORDS = ("fore-aft force", "vertical force", "sideways force", "centre of pressure")
"""What a plate measures, in words, in the order of `CHANNELS`."""


def residuals_by_channel(found: SoleCalibration | WholeCalibration) -> list[list[Float[np.ndarray, " _"]]]:
    """Residuals over their noise, by stance and channel: those of `CHANNEL_WORDS`, then of the slip; a channel that
    holds nothing is empty.
    """
    residuals = found.residuals
    _, order = residuals.channel_by_channel()
    counts = [np.isfinite(residuals.measured(k)).sum(axis=0) for k in range(len(residuals.standing))]
    parts = iter(np.split(residuals.of_data(found.at)[order], np.cumsum(np.concatenate(counts))[:-1]))
    return [[next(parts) for _ in own] for own in counts]


def doubts_of_fit(height: float, pitch: float, residual: float, vertical: float) -> list[Doubt]:
    """Reasons against a fit.

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
        reasons.append(Doubt(f"{what}: did the foot stand flat in `static`?", False))
    if residual > LARGE or vertical > MISSED:
        missed = f"the vertical force is missed by {vertical:.1%} of body weight"
        missed += f", the residual is {residual:.1f} times its noise"
        contradicts = residual > TOO_LARGE or vertical > NOT_MET
        reasons.append(Doubt(f"{missed}: check `mass`, `setting`, plate and markers", contradicts, vertical / MISSED))
    return reasons
