"""What a calibration starts from: the foot, and a stance between the plate's touch-down and toe-off."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.io.mocap.force_plates import ForcePlate, plate_named, read_force_plates
from geocontact.io.motion.motion import read_motion
from geocontact.loads.pose_rate import pose_rate
from geocontact.prosthesis.calibration.recorded_stance import Errors, RecordedStance
from geocontact.prosthesis.keel.vsf import fulcrum_of
from geocontact.prosthesis.keel.vsf_foot import VariableStiffnessFoot, vsf_foot
from geocontact.prosthesis.model.leg_tree import GRAVITY
from geocontact.prosthesis.simulate import share_of_foot

UPRIGHT = 0.999
"""Least cosine between the plate's normal and y: 2.6 degrees."""
GATE, AROUND = 20.0, 0.05
"""N of vertical force in stance, and s around it that are taken along."""
FEWEST = 30
"""Frames of a stance: twice the numbers that are sought."""


@dataclass(frozen=True, eq=False)
class FootOnPlate:
    """A foot and its stance."""

    foot: VariableStiffnessFoot
    stance: RecordedStance


def read(o: ProsthesisCalibrateOptions, record: Record) -> FootOnPlate:
    """Everything the options name."""
    motion = read_motion(o.motion)
    if motion.time_unit != "s":
        raise InputError(o.motion, "", "time is in per cent of a cycle", "write its time in s: forces need rates")
    record.add_input("motion", o.motion, frames=len(motion))
    plate = plate_named(read_force_plates(o.plates), o.plate, o.plates, "`plate`")
    record.add_input("`plates`", o.plates, plate=plate.name)
    if plate.normal[1] < UPRIGHT or abs(plate.point[1]) > 1e-3:
        what = "the plate does not lie in y = 0 with y up"
        raise InputError(o.plates, plate.name, what, "turn forces and motion into such a frame")
    fulcrum = fulcrum_of(o.setting or "medium") if o.fulcrum is None else o.fulcrum
    with record.listener.preparing():
        foot = vsf_foot()
    try:
        foot.keel.require_range(fulcrum)
    except ValueError as error:
        raise InputError("", "`fulcrum`", str(error), "give it from the keel's posterior end") from error
    return FootOnPlate(foot, _stance(o, motion, plate, fulcrum, foot))


def _stance(
    o: ProsthesisCalibrateOptions, motion: Motion, plate: ForcePlate, fulcrum: float, foot: VariableStiffnessFoot
) -> RecordedStance:
    wrench = plate.at(motion.time)
    load = np.nan_to_num(wrench.force[:, 1])
    if not (load >= GATE).any():
        what = f"carries no {GATE:g} N at any time of the motion"
        raise InputError(o.plates, plate.name, what, "check that both have one clock, and that this plate is meant")
    on = np.flatnonzero(load >= GATE)
    first, last = motion.time[on[0]] - AROUND, motion.time[on[-1]] + AROUND
    inside = np.isfinite(wrench.force[:, 1]) & (motion.time >= first) & (motion.time <= last)
    if inside.sum() < FEWEST:
        what = f"{int(inside.sum())} frames of the stance are too few for 15 numbers"
        raise InputError(o.motion, "", what, "record at 100 Hz or more")
    rate = pose_rate(motion.time, motion.poses)[inside]
    poses = motion.poses[inside]
    centre = wrench.centre_of_pressure(plate.point, plate.normal, GATE)[inside]
    share = share_of_foot(poses, foot.keel.length, centre)
    known = share[np.isfinite(share)]
    if np.median(np.abs(known - 0.5)) > BESIDE:
        what = f"the centre of pressure lies at {np.median(known):.1f} lengths of the foot from its heel"
        raise InputError(o.plates, plate.name, what, "no plate is under this foot; check frame, side and clock")
    errors = Errors(force=o.force_noise, height=o.height_error, pitch=o.pitch_error, speed=o.speed_error)
    return RecordedStance(
        motion.time[inside], poses, rate, fulcrum, wrench.force[inside], share, o.mass * GRAVITY, errors
    )


BESIDE = 1.0
"""Lengths of the foot from its middle beyond which a centre of pressure is not its."""
