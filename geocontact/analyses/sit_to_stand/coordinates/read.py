"""Files of a whole body's motion: its legs in the plane, and plates that are added up and turned into it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.analyses.motion.markers import turn_of
from geocontact.analyses.sit_to_stand.coordinates.options import StandingCoordinatesOptions
from geocontact.analyses.sit_to_stand.coordinates.plates import chosen_plates
from geocontact.analyses.sit_to_stand.recorded_beside import ANGLES, UPRIGHT, doubt_bending, doubt_hinges
from geocontact.analyses.sit_to_stand.trial_recordings import FEWEST, site_force
from geocontact.analyses.sit_to_stand.worn_trials import torques_at
from geocontact.data.errors import InputError
from geocontact.data.multibody.force_plate import ForcePlate, sum_of
from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.model import Multibody
from geocontact.identify.signals.filters import UNEVEN
from geocontact.io.opensim.coordinates import columns_of, coordinates_of, motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import listed, read_table
from geocontact.standing_up.chain import JOINTS, Subject, leg_chain
from geocontact.standing_up.exoskeleton import EXO_JOINTS, two_chains
from geocontact.standing_up.movements import hip_height
from geocontact.standing_up.planar_coordinates import LEG_JOINTS, BodyLeg, PlanarMotion, body_sites, planar_motion
from geocontact.standing_up.plate_places import PlatePlace
from geocontact.trial_checks.recorded import FootPlate, MovedModel, TrialInputs

SIDES = ("right", "left")
Columns = Float[np.ndarray, "t 6"]
Times = Float[np.ndarray, " t"]


@dataclass(frozen=True, eq=False)
class PlanarRecording:
    """A motion in the plane, and the loads of feet and chair in it.

    Parameters
    ----------
    mass
        Of the model [kg].
    clock, feet, chair
        Times of the plates [s]; force and moment about the origin [N, N m], x forwards, y up, z right. None where they
        were not recorded.
    places
        What each plate of the file carries.
    hinges
        Angles of an exoskeleton's hinges, `EXO_JOINTS` [rad]; None where none was worn.
    """

    time: Float[np.ndarray, " t"]
    moved: PlanarMotion
    mass: float
    clock: Float[np.ndarray, " s"] | None = None
    feet: Columns | None = None
    chair: Columns | None = None
    places: tuple[PlatePlace, ...] = ()
    hinges: Float[np.ndarray, "t 3"] | None = None


def read(o: StandingCoordinatesOptions) -> PlanarRecording:
    """Everything the options name."""
    model = read_multibody(o.model)
    add_input("`model`", o.model, bodies=len(model.bodies))
    if model.up[1] < 1.0 - 1e-6:
        raise InputError(o.model, "gravity", "is not along -y", "the plane is upright along y: turn the model")
    time, values = _motion(model, o)
    legs = _legs(model, o)
    try:
        moved = planar_motion(model, values, legs, SIDES if o.leg == "both" else (o.leg,))
    except ValueError as error:
        raise InputError(o.model, "", str(error), "are `joints` those of hip, knee and ankle?") from error
    moved = replace(moved, q=moved.q + np.outer(o.belt * time, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]))
    whole = MovedModel(model, time, values, str(o.motion))
    subject = Subject()  # where the hip is lowest does not depend on lengths
    doubt_bending(o.motion, leg_chain(subject), moved.q, hip_height(subject, moved.q))
    if o.plates is None:
        check_trial(TrialInputs(height=o.height, moved=whole))
        return PlanarRecording(time, moved, model.mass)
    turn = turn_of(o.axes)
    hinges = _hinges(o, time, moved)
    mass = model.mass if hinges is None else two_chains(Subject(model.mass)).mass
    body = body_sites(model, time, values, legs)
    under, seat, places = chosen_plates(o.plates, body, turn, mass, o)
    plates = tuple(FootPlate(each, str(o.plates)) for each in (*under, *seat))
    check_trial(
        TrialInputs(
            plates=plates,
            mass=mass,
            height=o.height,
            mass_option="the model's mass" + ("" if hinges is None else " with the exoskeleton's"),
            stands_at=_stands_at(time, moved) if o.leg == "both" else None,
            turn=turn,
            moved=whole if hinges is None else None,  # its mass centre is that of the person alone
        )
    )
    clock, feet, chair = _loads(under, seat, time, moved, o)
    return PlanarRecording(time, moved, model.mass, clock, feet, chair, places, hinges)


def _hinges(o: StandingCoordinatesOptions, time: Times, moved: PlanarMotion) -> Float[np.ndarray, "t 3"] | None:
    """Angles of an exoskeleton's hinges at the times of the motion [rad]; None where none was worn."""
    if o.worn is None:
        return None
    if o.leg != "both":
        raise InputError("", "`worn`", "has no effect on stances of one leg", "leave it out, or take both legs")
    table = read_table(o.worn)
    add_input("`worn`", o.worn, frames=len(table.time))
    joints = [joint for joint in two_chains(Subject()).joints if joint.name in EXO_JOINTS]
    columns = columns_of(table, joints)
    lacking = [name for name in EXO_JOINTS if name not in columns]
    if lacking:
        remedy = f"its hinges are {', '.join(EXO_JOINTS)}: were all recorded?"
        raise InputError(o.worn, "", f"no column for {', '.join(lacking)}", remedy)
    step = float(np.ptp(time)) / (len(time) - 1)
    begin, end = table.time[[0, -1]]
    if begin > time[0] + step or end < time[-1] - step:
        what = f"runs from {begin:g} to {end:g} s, the motion from {time[0]:g} to {time[-1]:g} s"
        raise InputError(o.worn, "", what, "put both on one clock, or cut the motion by `time`")
    found = coordinates_of(table, joints, columns, None)
    hinges = np.column_stack([np.interp(time, table.time, found[name]) for name in EXO_JOINTS])
    doubt_hinges(o.worn, moved.q[:, ANGLES], hinges)
    inside = time[1:-1]  # files that end a sample before the motion cover its trials, as hinges do
    if o.torques is not None:
        torques_at(o.torques, JOINTS, "`torques`", inside)
    if o.strap is not None:
        site_force((o.strap,), "`strap`", "thigh", inside)
    return hinges


def _stands_at(time: Times, moved: PlanarMotion) -> float | None:
    """When the person stands upright, at the end or at the beginning [s]; None where neither is so."""
    upright = [k for k in (-1, 0) if np.abs(moved.q[k, ANGLES]).max() < UPRIGHT]
    return float(time[upright[0]]) if upright else None


def _motion(model: Multibody, o: StandingCoordinatesOptions) -> tuple[Times, Float[np.ndarray, "t n"]]:
    """Times and coordinates of the model; InputError for few or uneven frames, and for gaps."""
    table = read_table(o.motion)
    add_input("motion", o.motion, frames=len(table.time))
    time, values = table.time, motion_of(table, model)
    if o.time is not None:
        kept = (time >= o.time[0]) & (time <= o.time[1])
        time, values = time[kept], values[kept]
    if len(time) < FEWEST:
        raise InputError(o.motion, "", f"{len(time)} frames are too few", f"{FEWEST} are needed")
    step = float(np.ptp(time)) / (len(time) - 1)
    if np.abs(np.diff(time) - step).max() > UNEVEN * step or not np.isfinite(values).all():
        raise InputError(o.motion, "", f"frames are not {step:g} s apart everywhere, or empty", "fill the gaps")
    return time, values


def _loads(
    under: Sequence[ForcePlate],
    seat: Sequence[ForcePlate],
    time: Times,
    moved: PlanarMotion,
    o: StandingCoordinatesOptions,
) -> tuple[Times, Columns, Columns | None]:
    """Times of the plates, loads of feet and chair there; InputError for samples that are lost during the motion.

    Those lost before and after it are left out.
    """
    clock = under[0].time
    feet = _load(under, clock, moved, o.belt)
    chair = _load(seat, clock, moved, o.belt) if seat else None
    lost = ~np.isfinite(feet if chair is None else np.hstack([feet, chair])).all(axis=1)
    step = float(np.ptp(time)) / (len(time) - 1)
    gaps = clock[lost & (clock >= time[0] + step) & (clock <= time[-1] - step)]
    if len(gaps):
        what = f"{len(gaps)} samples from {gaps[0]:g} to {gaps[-1]:g} s have no force or no moment"
        raise InputError(o.plates or "", "", what, "fill the gaps, or cut the motion by `time`")
    return clock[~lost], feet[~lost], None if chair is None else chair[~lost]


def _load(plates: Sequence[ForcePlate], clock: Times, moved: PlanarMotion, belt: float) -> Columns:
    """Sum over plates in the plane, about its origin, which goes with the belt; NaN where a sample is lost."""
    force, moment = map(moved.turn.apply, sum_of([plate.at(clock) for plate in plates]))
    return np.hstack([force, moment + np.cross(np.outer(belt * clock, [1.0, 0.0, 0.0]), force)])


def _legs(model: Multibody, o: StandingCoordinatesOptions) -> dict[str, BodyLeg]:
    """Joints of both legs by the names of their coordinates."""
    stems = [name.strip() for name in o.joints.split(",")]
    if len(stems) != len(LEG_JOINTS):
        raise InputError("", "`joints`", f"{o.joints!r} is not three names", "write hip_flexion,knee_angle,ankle_angle")
    of = {c.name: joint for joint in model.joints for c in joint.coordinates}
    for side in SIDES:
        for stem in stems:
            if f"{stem}_{side[0]}" not in of:
                what = f"no coordinate {stem}_{side[0]}; there are {listed(tuple(of))}"
                raise InputError(o.model, "", what, "name those of hip, knee and ankle as `joints`")
    found = {side: BodyLeg(*(of[f"{stem}_{side[0]}"] for stem in stems)) for side in SIDES}
    for leg in found.values():
        down = (leg.hip, leg.knee, leg.ankle)
        for upper, lower in pairwise(down):
            if upper is lower or upper.child not in _above(model, lower):
                what = f"{lower.name} does not lie below {upper.name}"
                raise InputError("", "`joints`", what, "name hip, knee and ankle, in this order")
    return found


def _above(model: Multibody, joint: JointModel) -> set[str]:
    """Bodies from a joint's parent up to the ground."""
    parents = {each.child: each.parent for each in model.joints}
    found, body = set(), joint.parent
    while body not in found:
        found.add(body)
        body = parents.get(body, body)
    return found
