"""A recorded walk: what its files hold, leg and motion fitted to it, and the stance simulated along it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.frame.collector import add_input, reserve, say
from geocontact.analyses.ground_words import LEVEL, plane_or_stairs
from geocontact.analyses.motion.marker_tasks import FAR, MOVING
from geocontact.analyses.prosthesis.leg_and_foot import foot_with_law, offset_of_law
from geocontact.analyses.prosthesis.recorded_files import require_one_clock, require_weight, right_markers
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.below_knee_prosthesis.calibration.recorded_stance import keel_poses
from geocontact.below_knee_prosthesis.clocks import clock_offset, lowest_sphere
from geocontact.below_knee_prosthesis.evaluation import PlateStance, at_times, longest_stance
from geocontact.below_knee_prosthesis.from_markers import (
    PELVIS,
    Walked,
    functional_hip,
    of_side,
    pelvis_frame,
    standing_leg,
    walked,
)
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import VariableStiffnessFoot, fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg import FootOffset, Leg, Person
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, LegMotion, recorded_tree
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket, limb_in_socket
from geocontact.below_knee_prosthesis.simulate import GATE, Push, Stance, simulate_stance
from geocontact.contact.bushing import PRINTED, SOCKET, Bushing
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.geometry.shapes import HalfSpace
from geocontact.io.mocap.force_plates import ForcePlate, plate_named, read_force_plates
from geocontact.loads.ground import Stairs

FARTHEST = 0.4
"""m; of the centre of pressure from the heel, seen from above."""
FOOT_CUTOFF = 15.0
"""Hz; of the markers that tell where the foot is, as in a calibration: 6 Hz smooth the touch-down away."""
LATE = 0.02
"""s; least time before touch-down that the recording must begin."""


@dataclass(frozen=True, eq=False)
class RecordedWalk:
    """Contents of the files of a walk, of a right leg.

    Parameters
    ----------
    standing, moving, seen
        Markers while standing, of the functional trial (None without one), and while walking.
    plates
        All of the file, as recorded.
    ground
        That both feet walk on.
    offset
        The foot beside its standing trial.
    """

    standing: MarkerTrajectories
    moving: MarkerTrajectories | None
    seen: MarkerTrajectories
    plates: tuple[ForcePlate, ...]
    ground: HalfSpace | Stairs
    foot: VariableStiffnessFoot
    offset: FootOffset


@dataclass(frozen=True, eq=False)
class SeenFoot:
    """Poses of the keel's frame by the markers on the socket, at their times [s]."""

    time: Float[np.ndarray, " t"]
    poses: RigidTransform


@dataclass(frozen=True, eq=False)
class Walk:
    """A person who walks on a foot, as of a right leg.

    Parameters
    ----------
    walked
        Recorded motion.
    ground
        That both feet walk on.
    push
        Of the other leg.
    plate
        Under the prosthetic foot; None where it is not named.
    cluster
        The foot by the markers on its socket.
    seen
        Markers that the motion was fitted to.
    """

    leg: Leg
    walked: Walked
    ground: HalfSpace | Stairs
    foot: VariableStiffnessFoot
    fulcrum: float
    push: Push
    plate: PlateStance | None
    cluster: SeenFoot
    seen: MarkerTrajectories


def read(o: ProsthesisSimulateOptions) -> RecordedWalk:
    """Everything the options name."""
    given = o.side, o.axes, o.markers_map, o.c3d_unit
    ground = _ground(o)
    foot = foot_with_law(vsf_foot(), o.law)
    standing = right_markers("`static`", cast(Path, o.static), *given)
    moving = None
    if o.functional is None:
        reserve("the hip's centre is that of a regression; a `functional` trial tells it better")
    else:
        moving = right_markers("`functional`", o.functional, *given)
    offset = offset_of_law(o.law, cast(Path, o.static))
    seen = right_markers("markers", o.markers, *given, o.time)
    plates = read_force_plates(cast(Path, o.plates), o.c3d_unit)
    add_input("`plates`", cast(Path, o.plates), plates=len(plates))
    return RecordedWalk(standing, moving, seen, plates, ground, foot, offset)


def fitted_walk(recorded: RecordedWalk, o: ProsthesisSimulateOptions) -> Walk:
    """The leg by the standing trial, its motion by the walking one; InputError where plates and markers do not fit."""
    foot, seen, file = recorded.foot, recorded.seen, cast(Path, o.plates)
    person = Person(cast(float, o.mass), o.sex, o.residual)
    stood = standing_leg(recorded.standing, person, foot.keel, sole_numbers()["below"].value, _hip(recorded))
    leg = stood.with_foot(recorded.offset)
    fit = walked(seen, leg, cutoff=None if o.cutoff == 0.0 else o.cutoff, gap_limit=o.gap_limit)
    other = plate_named(recorded.plates, o.other_plate, file, "`other_plate`")
    _require_fit(seen, fit)
    require_weight(file, "`other_plate`", other.name, other.wrench.force[:, 1], person.mass * GRAVITY)
    push = Push(other.time, of_side(np.nan_to_num(other.wrench.force), o.side))
    _require_clock(o, fit.motion.time, other)
    fulcrum = fulcrum_of(o.setting, "pinned") if o.fulcrum is None else o.fulcrum
    own = _own_plate(o, recorded, fit)
    poses = keel_poses(seen, leg, seen.time, FOOT_CUTOFF, o.gap_limit)
    return Walk(leg, fit, recorded.ground, foot, fulcrum, push, own, SeenFoot(seen.time, poses), seen)


def _hip(recorded: RecordedWalk) -> Float[np.ndarray, " 3"] | None:
    """Centre by the functional trial in the pelvis' frame [m]; None without such a trial."""
    if recorded.moving is None:
        return None
    standing = recorded.standing
    places = np.nanmedian(standing.of(PELVIS), axis=0)
    frame = pelvis_frame(dict(zip(PELVIS, places, strict=True)), standing.source)
    hip = functional_hip(recorded.moving, frame.inv().apply(places))
    say(f"hip centre from the functional trial, {1e3 * hip.rms:.1f} mm off itself")
    return hip.first


def _require_fit(seen: MarkerTrajectories, fit: Walked) -> None:
    off = float(np.nanmedian(fit.off))
    if off > FAR:
        what = f"markers are {1e3 * off:.0f} mm from the standing leg in the median"
        raise InputError(seen.source, "", what, "the same person and markers? are left and right exchanged?")
    if off > MOVING.rms:
        reserve(f"{seen.source}: markers are {1e3 * off:.0f} mm from the standing leg in the median")


def _ground(o: ProsthesisSimulateOptions) -> HalfSpace | Stairs:
    """In the frame of a right leg; InputError for a mesh, which equations cannot hold."""
    ground = plane_or_stairs(LEVEL if o.ground is None else o.ground)
    if ground is None:
        what, remedy = f"{o.ground!r} is neither a plane nor stairs", "write plane:nx,ny,nz,offset or stairs:h0,x1:h1"
        raise InputError("", "`ground`", what, remedy)
    if isinstance(ground, Stairs) or o.side == "right":
        return ground
    point, normal = of_side(np.array([ground.point, ground.normal]), o.side)
    return HalfSpace((point[0], point[1], point[2]), (normal[0], normal[1], normal[2]))


def _own_plate(o: ProsthesisSimulateOptions, recorded: RecordedWalk, fit: Walked) -> PlateStance | None:
    """Force and centre of pressure under the prosthetic foot; InputError where it is not the foot that stands there."""
    if o.plate is None:
        return None
    file = cast(Path, o.plates)
    plate = plate_named(recorded.plates, o.plate, file, "`plate`")
    force = of_side(np.nan_to_num(plate.wrench.force), o.side)
    require_weight(file, "`plate`", plate.name, force[:, 1], fit.motion.leg.person.mass * GRAVITY)
    centre = of_side(plate.centre_of_pressure(GATE), o.side)
    span = longest_stance(plate.time, force[:, 1])
    if span is None:
        raise InputError(
            file, "`plate`", f"{plate.name} carries no whole stance above {GATE:g} N", "give another plate"
        )
    start, stop = fit.motion.time[[0, -1]]
    if span[0] < start + LATE or span[1] > stop:
        what = f"the stance on {plate.name} is from {span[0]:.2f} to {span[1]:.2f} s, the markers from {start:.2f} to"
        raise InputError(
            file, "`plate`", f"{what} {stop:.2f} s", "markers must begin before touch-down and end after it"
        )
    stance = PlateStance(plate.time, force, centre)
    motion, leg = fit.motion, fit.motion.leg
    keel = recorded_tree(leg).poses(motion.values)["shank"] * RigidTransform.from_components(leg.keel, leg.turn)
    height = lowest_sphere(keel, recorded.foot.sole.spheres, recorded.ground)
    require_one_clock(file, "`plate`", plate.name, clock_offset(motion.time, height, stance.time, force[:, 1]))
    _require_under_the_foot(file, plate.name, stance, keel, motion.time)
    return stance


def _require_under_the_foot(
    file: Path, name: str, plate: PlateStance, keel: RigidTransform, time: Float[np.ndarray, " t"]
) -> None:
    centre = at_times(time, plate.time, plate.centre)
    away = float(np.nanmedian(np.linalg.norm((centre - keel.translation)[:, ::2], axis=1)))
    if away > FARTHEST:
        what = f"no plate under the foot: the centre of pressure of {name} is {away:.2f} m from its heel in the median"
        raise InputError(file, "`plate`", what, "name another plate; are plates and markers in the same axes?")


def _require_clock(o: ProsthesisSimulateOptions, time: Float[np.ndarray, " t"], plate: ForcePlate) -> None:
    if plate.time[0] > time[0] + LATE or plate.time[-1] < time[-1] - LATE:
        what = f"plates are from {plate.time[0]:.2f} to {plate.time[-1]:.2f} s, markers from {time[0]:.2f} to"
        raise InputError(cast(Path, o.plates), "", f"{what} {time[-1]:.2f} s", "both need one clock; cut with `time`")


BEFORE, AFTER = 0.12, 0.1
"""s; simulated before the plate's touch-down and after its toe-off, as far as the markers go."""
INSIDE = 2
"""Frames that are left out at both ends: the splines bend there."""


def bushing_of(o: ProsthesisSimulateOptions) -> Bushing:
    """Socket on the residual limb."""
    return SOCKET if o.socket == "as_meant" else PRINTED


def simulated(walk: Walk, o: ProsthesisSimulateOptions) -> LimbInSocket:
    """From before touch-down to after toe-off, with the socket's motion out of its markers; InputError where not."""
    time = walk.walked.motion.time
    span = (float(time[INSIDE]), float(time[-1 - INSIDE]))
    if walk.plate is not None:
        seen = longest_stance(walk.plate.time, walk.plate.force[:, 1])
        if seen is not None:
            span = max(span[0], seen[0] - BEFORE), min(span[1], seen[1] + AFTER)
    bushing = bushing_of(o)
    given = walk.foot, walk.fulcrum, walk.push, span

    def along(motion: LegMotion) -> Stance:
        return simulate_stance(motion, *given, bushing=bushing, ground=walk.ground, machine_code=o.machine_code)

    cutoff = None if o.cutoff == 0.0 else o.cutoff
    try:
        return limb_in_socket(walk.seen, walk.walked, along, cutoff=cutoff, gap_limit=o.gap_limit, turns=o.socket_turns)
    except (ArithmeticError, ValueError) as error:
        remedy = "check `mass`, `side`, `axes` and the names of the markers; as_printed no gait can be walked"
        raise InputError(o.markers, "", str(error), remedy) from error
