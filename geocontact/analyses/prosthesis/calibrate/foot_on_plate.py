"""A foot and its stance on a plate along the markers of the socket, and the sole's numbers sought in it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypedDict

import numpy as np

from geocontact.analyses.frame.collector import listener, reserve
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.leg_and_foot import counted_twice, foot_with_law
from geocontact.analyses.prosthesis.ranges import TURNS
from geocontact.analyses.prosthesis.recorded_files import (
    plate_under_foot,
    require_one_clock,
    require_under_foot,
    require_weight,
    right_markers,
)
from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration, calibrate
from geocontact.below_knee_prosthesis.calibration.recorded_stance import (
    Errors,
    RecordedStance,
    WalkedStance,
    recorded_heights,
    stance_from_markers,
)
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WholeCalibration, calibrate_whole
from geocontact.below_knee_prosthesis.clocks import clock_offset
from geocontact.below_knee_prosthesis.from_markers import Walked, of_side, standing_leg, walked
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import VariableStiffnessFoot, fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, LegMotion
from geocontact.below_knee_prosthesis.limb_in_socket import limb_in_socket
from geocontact.below_knee_prosthesis.simulate import Push, Stance, simulate_stance
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.force_plates import plate_named, read_force_plates

ANGLES_CUTOFF = 6.0
"""Hz; of the markers that tell the leg's angles, as `prosthesis simulate` has it."""
LATE = 0.02
"""s; by which recordings may be shorter than needed."""


class Filtered(TypedDict):
    """How markers are filtered."""

    cutoff: float | None
    gap_limit: float


@dataclass(frozen=True, eq=False)
class FootOnPlate:
    """A foot and its stance, as of a right leg; for the whole model the markers, their fit and the leg's motion."""

    foot: VariableStiffnessFoot
    stance: RecordedStance
    seen: MarkerTrajectories
    fit: Walked | None
    walked: WalkedStance | None


def read(o: ProsthesisCalibrateOptions) -> FootOnPlate:
    """Everything the options name."""
    with listener().preparing():
        foot = foot_with_law(vsf_foot(), o.law)
    fulcrum = fulcrum_of(o.setting) if o.fulcrum is None else o.fulcrum
    standing = right_markers("`static`", o.static, o.side, o.axes, o.markers_map, o.c3d_unit)
    leg = standing_leg(standing, Person(o.mass), foot.keel, sole_numbers()["below"].value)
    seen = right_markers("markers", o.markers, o.side, o.axes, o.markers_map, o.c3d_unit)
    plate, name = plate_under_foot(o.plates, o.plate, o.side, o.mass, o.c3d_unit)
    filtered: Filtered = {"cutoff": None if o.cutoff == 0.0 else o.cutoff, "gap_limit": o.gap_limit}
    stance = stance_from_markers(
        seen,
        leg,
        plate,
        fulcrum,
        foot.keel.length,
        **filtered,
        errors=Errors(force=o.force_noise, height=o.height_error, pitch=o.pitch_error, speed=o.speed_error),
    )
    time, height = recorded_heights(seen, leg, foot.sole.spheres, **filtered)
    require_one_clock(o.plates, "`plate`", name, clock_offset(time, height, plate.time, plate.force[:, 1]))
    require_under_foot(o.plates, name, stance.centre)
    if not o.full:
        return FootOnPlate(foot, stance, seen, None, None)
    fit = walked(seen, leg, cutoff=ANGLES_CUTOFF, gap_limit=o.gap_limit)
    return FootOnPlate(foot, stance, seen, fit, _walked(o, fit, stance))


def _walked(o: ProsthesisCalibrateOptions, found: Walked, stance: RecordedStance) -> WalkedStance:
    """The stance on the whole model; InputError where the markers, or the other plate, do not cover enough of it."""
    other = plate_named(read_force_plates(o.plates, o.c3d_unit), o.other_plate, o.plates, "`other_plate`")
    require_weight(o.plates, "`other_plate`", other.name, other.wrench.force[:, 1], o.mass * GRAVITY)
    motion, time = found.motion, stance.time
    if motion.time[0] > time[0] - LATE or motion.time[-1] < time[-1]:
        what = f"markers are from {motion.time[0]:.2f} to {motion.time[-1]:.2f} s, the stance from {time[0]:.2f} to"
        raise InputError(
            o.markers, "", f"{what} {time[-1]:.2f} s", "markers must begin before touch-down and end after it"
        )
    if other.time[0] > motion.time[0] + LATE or other.time[-1] < motion.time[-1] - LATE:
        what = f"plates are from {other.time[0]:.2f} to {other.time[-1]:.2f} s, markers from {motion.time[0]:.2f} to"
        raise InputError(o.plates, "", f"{what} {motion.time[-1]:.2f} s", "both need one clock")
    reserve("the hip's centre is that of a regression")
    return WalkedStance(stance, motion, Push(other.time, of_side(np.nan_to_num(other.wrench.force), o.side)))


def along_poses(given: FootOnPlate, o: ProsthesisCalibrateOptions) -> SoleCalibration:
    """The sole's numbers along the recorded poses; InputError where the keel finds no equilibrium."""
    try:
        with listener().stages("calibrating"):
            return calibrate([given.stance], given.foot, starts=o.starts, seed=o.seed, level=o.level)
    except ArithmeticError as error:
        remedy = "check height and pitch of the foot; the sole must press and not sink"
        raise InputError(o.markers, "", str(error), remedy) from error


def on_whole_model(
    given: FootOnPlate, found: SoleCalibration, o: ProsthesisCalibrateOptions
) -> WholeCalibration | None:
    """The numbers sought on with the whole model; None where that is not asked for."""
    if given.walked is None or given.fit is None:
        return None
    stance, offset = given.walked, found.offsets[0]
    fit = replace(given.fit, motion=replace(given.fit.motion, leg=given.fit.motion.leg.with_foot(offset)))
    push, span = stance.push, (stance.begin, float(stance.recorded.time[-1]))

    def along(motion: LegMotion) -> Stance:
        return simulate_stance(motion, found.foot, given.stance.fulcrum, push, span, machine_code=o.machine_code)

    try:
        with listener().stages("calibrating on the whole model"):
            limb = limb_in_socket(given.seen, fit, along, cutoff=ANGLES_CUTOFF, gap_limit=o.gap_limit, turns=TURNS)
            if not limb.settled:
                reserve(counted_twice(limb))
            stances = [replace(stance, motion=replace(limb.walked.motion, leg=given.fit.motion.leg))]
            return calibrate_whole(stances, given.foot, found.at, level=o.level, machine_code=o.machine_code)
    except ArithmeticError as error:
        raise InputError(o.markers, "", str(error), "check `mass`, `side` and `axes`, or leave `full` out") from error
