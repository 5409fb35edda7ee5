"""What a scaling starts from: markers while standing, joints of a functional trial, the person and the foot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np

from geocontact.analyses.prosthesis.recorded_files import right_markers
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.both_sides.functional import FunctionalJoints
from geocontact.below_knee_prosthesis.both_sides.standing import NO_JOINTS, standing_joints
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot, vsf_foot
from geocontact.below_knee_prosthesis.model.leg import Person
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories

MOVED = 0.02
"""m that a marker may move while standing without a word."""


@dataclass(frozen=True, eq=False)
class Stood:
    """Markers of a person who stands, as of a right prosthesis, and what is known beside them."""

    seen: MarkerTrajectories
    moving: MarkerTrajectories | None
    joints: FunctionalJoints
    person: Person
    foot: VariableStiffnessFoot
    fulcrum: float


def read(o: ProsthesisScaleOptions, record: Record) -> Stood:
    """Everything the options name."""
    seen = right_markers(record, "static", o.static, o.side, o.axes, o.markers_map, o.c3d_unit)
    _warn_of_motion(seen, record)
    moving = None
    if o.functional is not None:
        moving = right_markers(record, "`functional`", o.functional, o.side, o.axes, o.markers_map, o.c3d_unit)
    joints = NO_JOINTS if moving is None else standing_joints(seen, moving)
    foot = vsf_foot()
    keel = foot.keel.posterior_mass + foot.keel.joints * foot.keel.segment_mass
    mass = cast(float, o.mass)
    person = Person(mass, o.sex, o.residual)
    if o.prosthesis_mass is not None:
        if o.prosthesis_mass <= keel:
            what = f"{o.prosthesis_mass:g} kg are less than the keel alone, {keel:.2f} kg"
            raise InputError("", "`prosthesis_mass`", what, "give that of socket, pylon and foot")
        person = Person(mass, o.sex, o.residual, o.prosthesis_mass - keel)
    fulcrum = fulcrum_of(o.setting, "pinned") if o.fulcrum is None else o.fulcrum
    return Stood(seen, moving, joints, person, foot, fulcrum)


def _warn_of_motion(seen: MarkerTrajectories, record: Record) -> None:
    off = np.linalg.norm(seen.positions - np.nanmedian(seen.positions, axis=0), axis=2)
    far = np.nanmax(off, axis=0)
    if np.nanmax(far) > MOVED:
        name = seen.names[int(np.nanargmax(far))]
        what = f"{name} moves {1e3 * np.nanmax(far):.0f} mm away from its median: is this standing still?"
        record.warn(f"{seen.source}: {what}")
