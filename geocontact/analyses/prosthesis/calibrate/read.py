"""What a calibration starts from: the foot, and a stance on a plate along the markers of the socket."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict

from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.foot_law import foot_with_law
from geocontact.analyses.prosthesis.plausible_plate import require_one_clock, require_under_foot
from geocontact.analyses.prosthesis.recorded_files import plate_under_foot, right_markers
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.calibration.recorded_stance import Errors, RecordedStance
from geocontact.below_knee_prosthesis.calibration.stance_from_markers import recorded_heights, stance_from_markers
from geocontact.below_knee_prosthesis.clocks import clock_offset
from geocontact.below_knee_prosthesis.from_markers.standing import standing_leg
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot, vsf_foot
from geocontact.below_knee_prosthesis.model.leg import Person


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
    standing = right_markers(record, "`static`", o.static, o.side, o.axes, o.markers_map)
    leg = standing_leg(standing, Person(o.mass), foot.keel, sole_numbers()["below"].value)
    seen = right_markers(record, "markers", o.markers, o.side, o.axes, o.markers_map)
    plate, name = plate_under_foot(record, o.plates, o.plate, o.side, o.mass)
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
    return FootOnPlate(foot, stance)
