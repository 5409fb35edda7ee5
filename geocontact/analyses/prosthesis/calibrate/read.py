"""What a calibration starts from: the foot, and a stance on a plate along the markers of the socket."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypedDict

import numpy as np

from geocontact.analyses.motion.markers import markers_given, renamed_as_told
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.foot_law import foot_with_law
from geocontact.analyses.prosthesis.plausible_plate import require_one_clock, require_weight
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.calibration.recorded_stance import Errors, RecordedStance
from geocontact.below_knee_prosthesis.calibration.stance_from_markers import recorded_heights, stance_from_markers
from geocontact.below_knee_prosthesis.clocks import clock_offset
from geocontact.below_knee_prosthesis.from_markers.sides import as_right, of_side
from geocontact.below_knee_prosthesis.from_markers.standing import standing_leg
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot, vsf_foot
from geocontact.below_knee_prosthesis.model.leg import Person
from geocontact.below_knee_prosthesis.model.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import GATE
from geocontact.below_knee_prosthesis.stance_errors import PlateStance
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.io.mocap.force_plates import plate_named, read_force_plates

BESIDE = 1.0
"""Lengths of the foot from its middle beyond which a centre of pressure is not its."""


class Filtered(TypedDict):
    """How markers are filtered."""

    cutoff: float | None
    gap_limit: float


@dataclass(frozen=True, eq=False)
class FootOnPlate:
    """A foot and its stance, as of a right leg."""

    foot: VariableStiffnessFoot
    stance: RecordedStance


def read(o: ProsthesisCalibrateOptions, record: Record) -> FootOnPlate:
    """Everything the options name."""
    with record.listener.preparing():
        foot = foot_with_law(record, vsf_foot(), o.law)
    fulcrum = fulcrum_of(o.setting) if o.fulcrum is None else o.fulcrum
    standing = _markers(o, o.static, record, "`static`")
    leg = standing_leg(standing, Person(o.mass), foot.keel, sole_numbers()["below"].value)
    seen = _markers(o, o.markers, record, "markers")
    plate, name = _plate(o, record)
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
    known = stance.centre[np.isfinite(stance.centre)]
    if not len(known) or np.median(np.abs(known - 0.5)) > BESIDE:
        what = f"no plate under the foot: the centre of pressure of {name} is not under it"
        raise InputError(o.plates, "`plate`", what, "check frame, side and clock, and that this plate is meant")
    return FootOnPlate(foot, stance)


def _markers(o: ProsthesisCalibrateOptions, file: Path, record: Record, name: str) -> MarkerTrajectories:
    seen = renamed_as_told(record, markers_given(file, o.axes, None), o.markers_map)
    record.add_input(name, file, frames=len(seen), markers=len(seen.names))
    return as_right(seen, o.side)


def _plate(o: ProsthesisCalibrateOptions, record: Record) -> tuple[PlateStance, str]:
    plate = plate_named(read_force_plates(o.plates), o.plate, o.plates, "`plate`")
    record.add_input("`plates`", o.plates, plate=plate.name)
    force = of_side(np.nan_to_num(plate.wrench.force), o.side)
    require_weight(o.plates, "`plate`", plate.name, force[:, 1], o.mass * GRAVITY)
    return PlateStance(plate.time, force, of_side(plate.centre_of_pressure(GATE), o.side)), plate.name
