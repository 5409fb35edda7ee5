"""A foot and its stance on a plate along the markers of the socket, and the sole's numbers sought in it."""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.analyses.frame.collector import listener, reserve
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.foot_file import foot_of, fulcrum_at
from geocontact.analyses.prosthesis.ranges import TURNS
from geocontact.analyses.prosthesis.recorded_files import LaboratoryFiles, foot_with_law
from geocontact.analyses.prosthesis.stance_files import counted_twice
from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration, calibrate
from geocontact.below_knee_prosthesis.calibration.recorded_stance import (
    Errors,
    RecordedStance,
    WalkedStance,
    stance_on_plate,
    walked_stance,
)
from geocontact.below_knee_prosthesis.calibration.whole_calibration import (
    WholeCalibration,
    along_limb,
    calibrate_whole,
    limb_on_sole,
)
from geocontact.below_knee_prosthesis.from_markers import Walked, standing_leg, walked
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.force_plates import plate_named

ANGLES_CUTOFF = 6.0
"""Hz; of the markers that tell the leg's angles, as `prosthesis simulate` has it."""


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
        foot = foot_of(o.foot)
        fulcrum = fulcrum_at(foot, o.setting, o.fulcrum)
        foot = foot_with_law(foot, o.law)
    lab = LaboratoryFiles(o.side, o.axes, o.markers_map, o.c3d_unit)
    still, walking = lab.markers("`static`", o.static), lab.markers("markers", o.markers)
    own = lab.plate_under_foot(o.plates, o.plate, o.mass)
    there = plate_named(lab.plates(o.plates), o.other_plate, o.plates, "`other_plate`") if o.full else None
    lab.check(still, walking, o.mass, o.plates, own, there)
    standing, seen, plate = lab.right(still), lab.right(walking), lab.stance(own, o.plates)
    leg = standing_leg(standing, Person(o.mass), foot.keel, foot.record.below)
    errors = Errors(force=o.force_noise, height=o.height_error, pitch=o.pitch_error, speed=o.speed_error)
    cutoff = None if o.cutoff == 0.0 else o.cutoff
    given = seen, leg, plate, foot, fulcrum
    stance = stance_on_plate(*given, cutoff=cutoff, gap_limit=o.gap_limit, errors=errors)
    if there is None:
        return FootOnPlate(foot, stance, seen, None, None)
    fit = walked(seen, leg, cutoff=ANGLES_CUTOFF, gap_limit=o.gap_limit)
    on_model = walked_stance(stance, fit, lab.stance(there, o.plates), seen.source)
    reserve("the hip's centre comes from a regression")
    return FootOnPlate(foot, stance, seen, fit, on_model)


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
    stance, machine_code = given.walked, o.machine_code
    try:
        with listener().stages("calibrating on the whole model"):
            limb = limb_on_sole(
                found,
                stance,
                given.seen,
                given.fit,
                cutoff=ANGLES_CUTOFF,
                gap_limit=o.gap_limit,
                turns=TURNS,
                machine_code=machine_code,
            )
            if not limb.settled:
                reserve(counted_twice(limb))
            stances = [along_limb(stance, limb)]
            return calibrate_whole(stances, given.foot, found.at, level=o.level, machine_code=machine_code)
    except ArithmeticError as error:
        raise InputError(o.markers, "", str(error), "check `mass`, `side` and `axes`, or leave `full` out") from error
