"""Calibration of the sole on one stance, and what the stance tells of each number."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np

from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.calibrate.read import ANGLES_CUTOFF, FootOnPlate
from geocontact.analyses.prosthesis.calibrate.result import ProsthesisCalibrateResult
from geocontact.analyses.prosthesis.ranges import TURNS
from geocontact.analyses.prosthesis.socket_words import counted_twice
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration, calibrate
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WholeCalibration, calibrate_whole
from geocontact.below_knee_prosthesis.calibration.zone_parameters import PRIOR
from geocontact.below_knee_prosthesis.limb_in_socket import limb_in_socket
from geocontact.below_knee_prosthesis.model.leg_motion import LegMotion
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import agreement

FAR, LARGE = 2.0, 2.0
"""Standard deviations of height and pitch, and residual over noise, root mean square, that are warned of."""
MISSED = 0.04
"""Vertical force that may be missed, root mean square, in body weights: stances that the model made leave 0.01 to 0.02,
a foot that stood 0.57 degrees out of flat left 0.053 with height and pitch held. Their errors are in the residual's
noise, so that it alone hardly says so."""
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
        raise InputError(o.markers, "", str(error), remedy) from error
    whole = _whole(given, found, o, record)
    motion, slip = found.residuals.motion(found.at, 0)
    predicted = found.residuals.stance(found.at, 0).predicted(found.foot.at(stance.fulcrum), motion)
    if whole is not None:
        one = whole.residuals.whole(whole.at, 0)
        predicted, slip = one.channels(one.shown(whole.foot)), 0.0 * slip
    step = float(np.median(np.diff(stance.time)))
    model, measured = predicted / stance.weight, stance.measured / stance.weight
    result = ProsthesisCalibrateResult(
        record=record,
        options=o,
        stance=stance,
        calibration=found,
        whole=whole,
        predicted=predicted,
        slip=slip,
        vertical=agreement(model[:, 1], measured[:, 1], step, 0.0),
        centre=agreement(predicted[:, 3], stance.centre, step, 0.0),
    )
    if (motion.loads.depth > SHARE_OF_DEPTH * foot.sole.spheres.radius).any():
        record.warn("a sphere sinks beyond its radius: the foot is recorded too low, or the sole is too soft")
    _say(result)
    return result


def _whole(
    given: FootOnPlate, found: SoleCalibration, o: ProsthesisCalibrateOptions, record: Record
) -> WholeCalibration | None:
    """On the whole model, where that is asked for."""
    if given.walked is None or given.fit is None:
        return None
    stance, offset = given.walked, found.offsets[0]
    fit = replace(given.fit, motion=replace(given.fit.motion, leg=given.fit.motion.leg.with_foot(offset)))
    push, span = stance.push, (stance.begin, float(stance.recorded.time[-1]))

    def along(motion: LegMotion) -> Stance:
        return simulate_stance(motion, found.foot, given.stance.fulcrum, push, span, machine_code=o.machine_code)

    try:
        with record.listener.stages("calibrating on the whole model"):
            limb = limb_in_socket(given.seen, fit, along, cutoff=ANGLES_CUTOFF, gap_limit=o.gap_limit, turns=TURNS)
            if not limb.settled:
                record.warn(counted_twice(limb))
            stances = [replace(stance, motion=replace(limb.walked.motion, leg=given.fit.motion.leg))]
            return calibrate_whole(stances, given.foot, found.at, level=o.level, machine_code=o.machine_code)
    except ArithmeticError as error:
        raise InputError(o.markers, "", str(error), "check `mass`, `side` and `axes`, or leave `full` out") from error


def _say_how_well(r: ProsthesisCalibrateResult) -> None:
    """How the foot stood, and what speaks against the fit."""
    record, e = r.record, r.stance.errors
    offset = r.last.offsets[0]
    record.say(
        f"the foot is {offset.words} beside where its standing trial has it; prior {1e3 * e.standing:.1f} mm and "
        f"{np.degrees(e.pitch):.2f} degrees"
    )
    for words in doubts(offset.height / e.standing, offset.pitch / e.pitch, r.residual, r.vertical.rmsd):
        record.warn(words)


def doubts(height: float, pitch: float, residual: float, vertical: float) -> list[str]:
    """What speaks against a fit.

    Parameters
    ----------
    height, pitch
        Of the foot beside its standing trial, in standard deviations of their errors.
    residual
        Root mean square over what plate, height and pitch leave.
    vertical
        Root mean square difference of the vertical force, in body weights.
    """
    found = []
    if max(abs(height), abs(pitch)) > FAR:
        what = "height or pitch of the foot is more than two standard deviations beside the standing trial"
        found.append(f"{what}: did the foot stand flat in `static`?")
    if residual > LARGE or vertical > MISSED:
        found.append(
            f"the vertical force is missed by {vertical:.1%} of body weight, the residual is {residual:.1f} times its "
            "noise: the model does not fit this stance, its numbers and their intervals are not to be trusted; check "
            "`mass`, `setting`, plate and markers"
        )
    return found


def _say(r: ProsthesisCalibrateResult) -> None:
    record, found = r.record, r.last
    verdicts = Counter(number.verdict for number in found.knowledge.numbers)
    unknown = [number.name for number in found.knowledge.numbers if number.verdict == "unknown"]
    if unknown:
        record.warn(f"never loaded, so that their usual values say nothing: {', '.join(unknown)}")
    if not found.converged:
        record.warn("the search stopped before it settled; give more `starts`")
    apart = found.knowledge.told_apart
    along = f"is met by slips of {1e3 * float(np.sqrt(np.mean(r.slip**2))):.0f} mm/s beside the recorded speed"
    if r.whole is not None:
        off = (r.predicted - r.stance.measured)[:, 0] / r.stance.weight
        along = f"fore and aft within {100.0 * float(np.sqrt(np.mean(off**2))):.1f} % of body weight"
    record.say(
        f"vertical force within {100.0 * r.vertical.rmsd:.1f} % of body weight (R² {r.vertical.r2:.3f}), centre of "
        f"pressure within {100.0 * r.centre.rmsd:.1f} % of the foot (R² {r.centre.r2:.2f}); the force along the floor "
        f"{along}"
    )
    _say_how_well(r)
    if r.whole is not None:
        record.say(
            f"on the whole model the cost falls from {r.whole.begun:.0f}, at the numbers along the recorded poses, to "
            f"{r.whole.cost:.0f}"
        )
    record.say(
        f"{verdicts['known']} of {len(found.knowledge.numbers)} numbers are known, {verdicts['not identified']} not "
        f"identified, {verdicts['unknown']} unknown; {apart.verdict} (condition {apart.condition:.3g})"
    )
    factors = ", ".join(f"{kind} a factor {sd:g}" for kind, (sd, _) in PRIOR.items())
    record.say(f"prior (invented), as one standard deviation about the usual number: {factors}")
    offset = found.offsets[0]
    record.results["calibrate"] = {
        "height_m": offset.height,
        "height_sd_m": offset.height_sd,
        "pitch_rad": offset.pitch,
        "pitch_sd_rad": offset.pitch_sd,
        "residual_over_noise": r.residual,
        "vertical_rmse_of_body_weight": r.vertical.rmsd,
        "vertical_r2": r.vertical.r2,
        "centre_rmse_of_foot": r.centre.rmsd,
        "centre_r2": r.centre.r2,
        "condition": apart.condition,
        "solved": found.residuals.solved,
        "numbers": {number.name: number.value for number in found.knowledge.numbers},
    }
