"""What a centre of pressure is computed from: sole, law, motion, ground and a plate, as the options name them."""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.analyses.body_motion import read_body_motion
from geocontact.analyses.cop.filters import smoothed_motion, smoothed_plate
from geocontact.analyses.cop.force_plate import chosen_plate
from geocontact.analyses.cop.ground import ground_of
from geocontact.analyses.cop.law import sole_law
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.io.mocap.force_plates import ForcePlate
from geocontact.io.opensim.osim import bodies_at_rest, read_joint
from geocontact.io.opensim.osim_contact_spheres import read_contact_spheres
from geocontact.io.recordings.spheres import SphereTable, read_spheres
from geocontact.loads.ground import Ground
from geocontact.loads.sphere_set import SoleLaw, SphereSet


@dataclass(frozen=True)
class Foot:
    """A sole with its law and its motion over the ground, and a force plate beside it where there is one."""

    name: str
    sole: SphereSet
    law: SoleLaw
    motion: Motion
    ground: Ground
    plate: ForcePlate | None


def read(o: CopOptions, record: Record) -> Foot:
    """Everything the options name."""
    ground = ground_of(record, o)
    table = _spheres(o)
    record.add_input("spheres", o.spheres, spheres=len(table.radius))
    sole = SphereSet(table.centre, table.radius, table.zone)
    law = sole_law(record, table, o)
    _require_ground(o)
    motion = smoothed_motion(read_body_motion(record, o.motion, o), o.motion_cutoff, o.motion)
    plate = chosen_plate(record, o)
    if plate is not None and o.compare is not None:
        plate = smoothed_plate(plate, o.force_cutoff, o.compare)
    return Foot(o.spheres.name, sole, law, motion, ground, plate)


def _require_ground(o: CopOptions) -> None:
    """InputError for a joint whose other body moves: the foot's poses in it are none over the ground."""
    if o.osim is None or o.joint is None:
        return
    joint, at_rest = read_joint(o.osim, o.joint), bodies_at_rest(o.osim)
    foot, other = (joint.parent, joint.child) if o.moving_body == "parent" else (joint.child, joint.parent)
    if other not in at_rest:
        what = f"'{o.joint}' gives {foot} in {other}, which is not the ground"
        remedy = f"give poses of {foot} in the ground (.csv), or a joint of the ground"
        raise InputError(o.osim, "`joint`", what, remedy)


def _spheres(o: CopOptions) -> SphereTable:
    if o.spheres.suffix.lower() == ".osim":
        return read_contact_spheres(o.spheres, o.body)
    if o.body is not None:
        raise InputError(o.spheres, "`body`", "has no effect: the spheres are not those of a model", "leave it out")
    return read_spheres(o.spheres)
