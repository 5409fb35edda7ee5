"""Feet of an OpenSim model: which bodies carry their spheres, how these press, and how they move through the chain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.frame.bodies import read_body_motion
from geocontact.analyses.frame.collector import add_input, reserve, say
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.geometry.shapes import HalfSpace
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_contact import HUNT_CROSSLEY, SMOOTH, read_contact_spheres
from geocontact.io.opensim.osim_contact_law import ContactForces, read_contact_forces
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.recordings.spheres import SphereTable, read_spheres
from geocontact.io.text.tables import read_table
from geocontact.loads.opensim_law import OpenSimLaw
from geocontact.loads.sphere_set import SphereSet

MODEL, COORDINATES = ".osim", (".mot", ".sto")
TOGETHER, BESIDE = "+", ","
"""Between bodies of one foot, and between feet."""


@dataclass(frozen=True, eq=False)
class Carrier:
    """Spheres that are fixed to one body, and its motion.

    Parameters
    ----------
    foot
        Name of the foot: that of its first body.
    sole
        Spheres in the body's frame [m].
    motion
        Poses of the body in the ground.
    """

    foot: str
    sole: SphereSet
    motion: Motion


def bodies_by_foot(o: CopOptions) -> dict[str, tuple[str, ...]]:
    """Bodies of each foot by its first body; one foot without a name where the spheres are a table."""
    if o.spheres.suffix.lower() != MODEL:
        if o.body is not None:
            raise InputError(o.spheres, "`body`", "has no effect: the spheres are not those of a model", "leave it out")
        return {"": ("",)}
    feet = [tuple(name.strip() for name in foot.split(TOGETHER)) for foot in (o.body or "").split(BESIDE)]
    every = [name for foot in feet for name in foot]
    twice = sorted({name for name in every if every.count(name) > 1})
    if twice:
        raise InputError("", "`body`", f"{twice[0] or 'an empty name'} is there twice", "name each body once")
    return {foot[0]: foot for foot in feet}


NUMBERS = ("law", "stiffness", "damping", "exponent", "full_depth", "friction", "threshold_speed")
"""Options that give a number of the foot's own force law."""


def read_tables(o: CopOptions, bodies: Sequence[str]) -> tuple[list[SphereTable], ContactForces | None]:
    """Spheres of each body, and the forces of the model, if it has some and no option gives a number of another law."""
    if o.spheres.suffix.lower() != MODEL:
        return [read_spheres(o.spheres)], None
    if any(getattr(o, name) is not None for name in NUMBERS):
        return [read_contact_spheres(o.spheres, body or None) for body in bodies], None
    tables = [read_contact_spheres(o.spheres, body or None, own_law=True) for body in bodies]
    return tables, read_contact_forces(o.spheres, [name for table in tables for name in table.zone])


def joined(tables: Sequence[SphereTable]) -> SphereTable:
    """Spheres of several bodies in one table, each with its centre in the frame of its own body."""
    if len(tables) == 1:
        return tables[0]
    stiffness = [table.stiffness for table in tables if table.stiffness is not None]
    known = len(stiffness) == len(tables)
    return SphereTable(
        np.concatenate([table.centre for table in tables]),
        np.concatenate([table.radius for table in tables]),
        tuple(name for table in tables for name in table.zone),
        np.concatenate(stiffness) if known else None,
        None,
        tables[0].exponent if known else None,
    )


def law_of_model(forces: ContactForces, radius: Float[np.ndarray, " n"], file: Path) -> OpenSimLaw:
    """The law of the model's own contact forces."""
    law = OpenSimLaw(
        smooth=forces.smooth,
        radius=radius,
        hertz_smoothing=forces.numbers["hertz_smoothing"],
        velocity_smoothing=forces.numbers["hunt_crossley_smoothing"],
        constant=forces.numbers["constant_contact_force"],
        **{key: forces.numbers[key] for key in OF_BOTH},
    )
    kinds = [kind for kind, some in ((SMOOTH, law.smooth), (HUNT_CROSSLEY, ~law.smooth)) if some.any()]
    say(f"forces, dissipation and friction are those of {file.name}: {' and '.join(kinds)}")
    if law.smooth.any():
        reserve("a smooth contact force presses before its sphere touches, and never pulls here")
    return law


OF_BOTH = ("modulus", "dissipation", "transition", "static", "dynamic", "viscous", "share")


def floor_of(forces: ContactForces, o: CopOptions) -> HalfSpace:
    """The plane of the model's half-space; InputError where the spheres do not press on one that rests."""
    if not forces.half_space:
        what = "the spheres' contact forces do not name one half-space that is fixed to the ground"
        raise InputError(o.spheres, "`ground`", what, "give the ground")
    x, y, z = (float(value) + 0.0 for value in forces.normal.round(12))
    p, q, r = (float(value) for value in forces.point)
    return HalfSpace((p, q, r), (x, y, z))


def read_motions(o: CopOptions, bodies: Sequence[str]) -> tuple[list[Motion], float]:
    """Poses of each body in the ground, through the chain of the model's joints, else of the one body.

    The second is the weight of the model through whose chain they go [N], 0 without one.
    """
    chained = o.spheres.suffix.lower() == MODEL and o.motion.suffix.lower() in COORDINATES
    if chained and (o.osim, o.joint, o.map) == (None, None, None):
        return _through_the_chain(o, bodies)
    if len(bodies) > 1:
        what = f"has the poses of one body, `body` names {len(bodies)}"
        raise InputError(o.motion, "", what, "give coordinates of the model (.mot .sto), without `osim`, `map`")
    return [read_body_motion(o.motion, o)], 0.0


def _through_the_chain(o: CopOptions, bodies: Sequence[str]) -> tuple[list[Motion], float]:
    model, table = read_multibody(o.spheres), read_table(o.motion)
    if o.order is not None:
        raise InputError("", "`order`", f"has no effect here: {o.motion} is read without it", "leave it out")
    if table.time_unit != "s":
        what = "time is in per cent of a cycle"
        raise InputError(o.motion, "", what, "write its time in s: rates and loads need it")
    poses = model.poses(motion_of(table, model, o.angles))
    source = f"{o.motion.name} through the joints of {o.spheres.name}"
    add_input("motion", o.motion, frames=len(table.time), source=source)
    motions = [Motion(table.time, poses[body], f"{body}: {source}", table.time_unit) for body in bodies]
    return motions, model.weight


HEAVY = 1.5
"""Times the weight, mean force of the ground: over whole cycles it is 1 for all feet together (their momentum is as at
first), and a part of a stride with a landing in it stays below."""


def doubt_weight(pressing: Float[np.ndarray, " t"], weight: float, o: CopOptions) -> None:
    """A reservation where the ground presses on average with much more than the model's weight [N]."""
    if weight > 0.0 and pressing.mean() > HEAVY * weight:
        what = f"mean force of the ground is {pressing.mean() / weight:.2g} times the weight of {o.spheres.name}"
        reserve(f"{o.motion}: {what}: its feet go too deep, by a floor at another height or by errors of the motion")


def seen_from_first(carriers: Sequence[Carrier]) -> SphereSet:
    """All spheres of one foot in the frame of its first body [m], as they lie in the first frame."""
    if len(carriers) == 1:
        return carriers[0].sole
    home = carriers[0].motion.poses[0].inv()
    centre = [(home * one.motion.poses[0]).apply(one.sole.centre) for one in carriers]
    radius = np.concatenate([one.sole.radius for one in carriers])
    return SphereSet(np.concatenate(centre), radius, tuple(zone for one in carriers for zone in one.sole.zone))


def spheres_by_foot(carriers: Sequence[Carrier]) -> Mapping[str, Bool[np.ndarray, " n"]]:
    """Which of all spheres are of each foot."""
    foot = np.array([one.foot for one in carriers for _ in one.sole.zone])
    return {name: foot == name for name in dict.fromkeys(foot.tolist())}
