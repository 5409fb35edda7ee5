"""Calibration of the sole on one stance, and what the stance tells of each number."""

from __future__ import annotations

from collections import Counter

from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.calibrate.read import FootOnPlate
from geocontact.analyses.prosthesis.calibrate.result import ProsthesisCalibrateResult
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.prosthesis.calibration.calibrate import calibrate
from geocontact.prosthesis.calibration.stance_curves import curve_agreement, stance_curves, stance_span
from geocontact.prosthesis.calibration.zone_parameters import BELIEVED

SHARE_OF_DEPTH = 1.0
"""Of its radius that a sphere may sink before its centre is under the ground."""


def run(given: FootOnPlate, o: ProsthesisCalibrateOptions, record: Record) -> ProsthesisCalibrateResult:
    """Numbers of the zones, their intervals, and the stance with them."""
    foot, stance = given.foot, given.stance
    try:
        with record.listener.stages("calibrating"):
            found = calibrate([stance], foot, starts=o.starts, seed=o.seed, level=o.level)
    except ArithmeticError as error:
        remedy = "check height and pitch of the foot; the sole must press and not sink"
        raise InputError(o.motion, "", str(error), remedy) from error
    keel = found.foot.at(stance.fulcrum)
    motion = stance.solved(keel)
    predicted = stance.predicted(keel, motion)
    span = stance_span(stance.time, stance.force)
    model, measured = (
        stance_curves(stance.time, each[:, :3], each[:, 3], stance.weight, span)
        for each in (predicted, stance.measured)
    )
    result = ProsthesisCalibrateResult(
        record=record,
        options=o,
        stance=stance,
        calibration=found,
        predicted=predicted,
        agreement=curve_agreement(model, measured),
    )
    if (motion.loads.depth > SHARE_OF_DEPTH * foot.sole.spheres.radius).any():
        record.warn("a sphere sinks beyond its radius: the foot is recorded too low, or the sole is too soft")
    _say(result)
    return result


def _say(r: ProsthesisCalibrateResult) -> None:
    record, found, told = r.record, r.calibration, r.agreement
    verdicts = Counter(number.verdict for number in found.knowledge.numbers)
    unknown = [number.name for number in found.knowledge.numbers if number.verdict == "unknown"]
    if unknown:
        record.warn(f"never loaded, so that their usual values say nothing: {', '.join(unknown)}")
    if not found.converged:
        record.warn("the search stopped before it settled; give more `starts`")
    apart = found.knowledge.told_apart
    record.say(
        f"force within {100.0 * told.force_rmse:.1f} % of body weight (R² {told.force_r2:.3f}), centre of pressure "
        f"within {100.0 * told.centre_rmse:.1f} % of the foot (R² {told.centre_r2:.2f})"
    )
    record.say(
        f"{verdicts['known']} of {len(found.knowledge.numbers)} numbers are known, {verdicts['believed']} are little "
        f"better than believed beforehand, {verdicts['unknown']} unknown; {apart.verdict} "
        f"(condition {apart.condition:.3g})"
    )
    factors = ", ".join(f"{kind} a factor {sd:g}" for kind, (sd, _) in BELIEVED.items())
    record.say(f"believed beforehand (invented), as one standard deviation about the usual number: {factors}")
    record.results["calibrate"] = {
        "force_rmse_of_body_weight": told.force_rmse,
        "force_r2": told.force_r2,
        "centre_rmse_of_foot": told.centre_rmse,
        "centre_r2": told.centre_r2,
        "condition": apart.condition,
        "solved": found.solved,
        "numbers": {number.name: number.value for number in found.knowledge.numbers},
    }
