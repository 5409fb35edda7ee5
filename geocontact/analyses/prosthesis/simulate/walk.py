"""A recorded walk: what its files hold, leg and motion fitted to it, and the stance simulated along it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import numpy as np

from geocontact.analyses.frame.collector import add_input, collecting, reserve, say
from geocontact.analyses.frame.record import Record
from geocontact.analyses.ground_words import LEVEL, plane_or_stairs
from geocontact.analyses.motion.marker_tasks import MOVING
from geocontact.analyses.person import person_segments
from geocontact.analyses.prosthesis.foot_file import foot_of, fulcrum_at, read_schedule
from geocontact.analyses.prosthesis.recorded_files import LaboratoryFiles, foot_with_law, offset_of_law, residual_of
from geocontact.analyses.prosthesis.scores import ROOM, SCORES
from geocontact.analyses.prosthesis.simulate.coordinates import compared_markers, mass_of, moved_model
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.from_markers import of_side
from geocontact.below_knee_prosthesis.from_model import ModelLeg
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import FootOffset, Person
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket
from geocontact.below_knee_prosthesis.marker_draws import MarkerBand, marker_band, with_errors
from geocontact.below_knee_prosthesis.plate_checks import covered_stances
from geocontact.below_knee_prosthesis.recorded_walk import Walk, fitted_walk, simulated_walk
from geocontact.below_knee_prosthesis.schedule import FulcrumSchedule
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.contact.bushing import PRINTED, SOCKET, Bushing
from geocontact.data.body_segments import BodySegments
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.geometry.shapes import HalfSpace
from geocontact.io.mocap.force_plates import plate_named
from geocontact.io.recordings.socket_description import SocketDescription, read_socket
from geocontact.loads.ground import Stairs


@dataclass(frozen=True, eq=False)
class RecordedWalk:
    """Contents of the files of a walk, of a right leg.

    Parameters
    ----------
    standing, moving, seen
        Markers while standing, of the functional trial (None without one), and while walking: recorded, or those of a
        model along its coordinates.
    mass, segments
        Of the person [kg], and of the body.
    joints
        Hip and knee of that model; None without one.
    other, plate
        Plates under the other foot, and under the prosthetic one; None where it is not named.
    ground
        That both feet walk on.
    fulcrum
        [m].
    offset
        The foot beside its standing trial.
    schedule
        Of the fulcrum over strides; None where it stays.
    """

    standing: MarkerTrajectories
    moving: MarkerTrajectories | None
    seen: MarkerTrajectories
    mass: float
    segments: BodySegments
    joints: ModelLeg | None
    other: PlateStance
    plate: PlateStance | None
    ground: HalfSpace | Stairs
    foot: VariableStiffnessFoot
    fulcrum: float
    offset: FootOffset
    schedule: FulcrumSchedule | None = None


def read(o: ProsthesisSimulateOptions, segments: BodySegments | None = None) -> RecordedWalk:
    """Everything the options name; segments of the person by sex and age, unless they are given."""
    lab = LaboratoryFiles(o.side, o.axes, o.markers_map, o.c3d_unit)
    ground = _ground(o)
    foot = foot_of(o.foot)
    schedule = None if o.schedule is None else read_schedule(o.schedule, foot)
    fulcrum = schedule.places[0].fulcrum if schedule else fulcrum_at(foot, o.setting, o.fulcrum)
    foot = foot_with_law(foot, o.law)
    if o.socket_numbers is not None:
        bushing_of(o)
        add_input("`socket_numbers`", o.socket_numbers)
    standing = lab.markers("`static`", cast(Path, o.static))
    model = None if o.coordinates is None else moved_model(o)
    mass, moving = mass_of(o, model), None
    if model is None and o.functional is None:
        reserve("the hip's centre comes from a regression; a `functional` trial determines it better")
    elif o.functional is not None:
        moving = lab.right(lab.markers("`functional`", o.functional))
    offset = offset_of_law(o.law, cast(Path, o.static))
    seen = lab.markers("markers", cast(Path, o.markers), o.time) if model is None else model.seen
    checked = seen if model is None else compared_markers(o, lab, model, standing)
    file = cast(Path, o.plates)
    plates = lab.plates(file)
    add_input("`plates`", file, plates=len(plates))
    other = plate_named(plates, o.other_plate, file, "`other_plate`")
    own = None if o.plate is None else plate_named(plates, o.plate, file, "`plate`")
    lab.check(standing, checked, mass, file, own, other, 0.0 if o.ground is None else None, age=o.age)
    plate = None if own is None else lab.stance(own, file)
    return RecordedWalk(
        standing=lab.right(standing),
        moving=moving,
        seen=lab.right(seen),
        mass=mass,
        segments=segments or person_segments(o.sex, o.age, mass, None, {}, ("", "")),
        joints=None if model is None else model.leg(lab.right(standing), o),
        other=lab.stance(other, file),
        plate=plate,
        ground=ground,
        foot=foot,
        fulcrum=fulcrum,
        offset=offset,
        schedule=schedule,
    )


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


def walk_of(recorded: RecordedWalk, o: ProsthesisSimulateOptions) -> Walk:
    """The leg by the standing trial, its motion by the walking one; InputError where plates and markers do not fit.

    With a schedule the plate is tested by the longest stance that the markers cover.
    """
    covered = []
    if recorded.plate is not None and recorded.schedule is not None:
        covered = covered_stances(recorded.plate, *recorded.seen.time[[0, -1]].tolist())
    walk = fitted_walk(
        recorded.standing,
        recorded.seen,
        Person(recorded.mass, recorded.segments, o.residual),
        recorded.foot,
        recorded.fulcrum,
        recorded.other,
        plate=recorded.plate,
        stance=max(covered, key=lambda each: each[1] - each[0], default=None),
        moving=recorded.moving,
        joints=recorded.joints,
        ground=recorded.ground,
        offset=recorded.offset,
        cutoff=None if o.cutoff == 0.0 else o.cutoff,
        gap_limit=o.gap_limit,
        residual=residual_of(recorded.standing, o.residual_length, o.residual_markers, o.side),
        around=SCORES[o.score].around + ROOM,
    )
    if walk.hip is not None:
        say(f"hip centre from the functional trial: residual {1e3 * walk.hip.rms:.1f} mm (root mean square)")
    if walk.off > MOVING.rms:
        reserve(f"{walk.seen.source}: markers are {1e3 * walk.off:.0f} mm (median) away from the standing leg")
    return walk


MARKER_ERROR = 0.5e-3
"""m; standard deviation of a marker's coordinate by default, as `prosthesis design` has it (invented)."""


def band_of(
    recorded: RecordedWalk,
    found: Stance,
    o: ProsthesisSimulateOptions,
    step: Callable[[], None] = lambda: None,
) -> MarkerBand | None:
    """How far errors of the markers move a stance; None where that is not asked for, InputError where it cannot be.

    Every draw goes the whole way: leg by the standing trial, motion by the walking one, simulation. The functional
    trial has no errors.
    """
    if o.walks is None:
        return None
    sd = MARKER_ERROR if o.marker_error is None else o.marker_error

    def again(rng: np.random.Generator) -> Stance:
        standing, seen = (with_errors(each, sd, rng) for each in (recorded.standing, recorded.seen))
        try:
            with collecting(Record("prosthesis simulate", {})):
                walk = walk_of(replace(recorded, standing=standing, seen=seen), o)
                return simulated(walk, o).stance
        except InputError as error:
            raise ArithmeticError(error.what) from error

    try:
        return marker_band(found, again, o.walks, seed=o.seed or 0, step=step)
    except ArithmeticError as error:
        raise InputError(o.motion, "`walks`", str(error), "give a smaller `marker_error`") from error


def bushing_of(o: ProsthesisSimulateOptions) -> Bushing:
    """Socket on the residual limb; InputError for a file that describes none."""
    if o.socket_numbers is not None:
        return _bushing(read_socket(o.socket_numbers))
    return SOCKET if o.socket == "as_meant" else PRINTED


def _bushing(of: SocketDescription) -> Bushing:
    """Six directions of a described socket, turns first; y is along the limb."""
    k, c, m, d = of.turn_stiffness, of.turn_damping, of.shift_stiffness, of.shift_damping
    along = m if of.piston_stiffness is None else of.piston_stiffness
    damped = d if of.piston_damping is None else of.piston_damping
    return Bushing((k, k, k, m, along, m), (c, c, c, d, damped, d))


def simulated(walk: Walk, o: ProsthesisSimulateOptions) -> LimbInSocket:
    """From before touch-down to after toe-off, with the socket's motion out of its markers; InputError where not."""
    try:
        return simulated_walk(walk, turns=o.socket_turns, bushing=bushing_of(o), machine_code=o.machine_code)
    except (ArithmeticError, ValueError) as error:
        remedy = "check `mass`, `side`, `axes` and the names of the markers; as_printed no gait can be walked"
        raise InputError(o.motion, "", str(error), remedy) from error
