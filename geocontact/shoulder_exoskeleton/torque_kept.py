"""The other bound of a person's answer to support: the shoulder keeps the torque of the unsupported arm, and the arm
moves.

Along the recorded motion the shoulder needs a torque τ(t) that raises the arm, without a device. Here it goes on giving
that torque while the cuff pushes: the arm leaves its recorded motion by an angle δ about the axis n of raising, through
the shoulder that moves as recorded; plane of raising and elbow stay as recorded. With S the first moment and I the
moment of inertia about n of the arm with its tool at their recorded place, R the turn by δ about n, b gravity less the
shoulder's acceleration, h the hand, F its push on the work and M the cuff's moment about the shoulder

    I δ'' + I' δ' = n·((R - 1) S x b) - n·((R - 1) h x F) + n·M

which is exact where n does not turn; `unexplained` compares with all of the equations in three dimensions. The device's
own equations (`arm_model`) are stepped along with it: its cuff sees the arm where it is. Nothing of the person resists
but the arm's weight and inertia, so that this is a bound, and usually the arm leaves its range: then it ends there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline

from geocontact.data.body_segments import BodySegments
from geocontact.dynamics.simulate import SimulatedMotion
from geocontact.shoulder_exoskeleton.arm_model import ArmModel, arm_model, output_slices
from geocontact.shoulder_exoskeleton.arm_numbers import SIZES, adjusted_numbers, slices
from geocontact.shoulder_exoskeleton.arms_from_markers import elevation
from geocontact.shoulder_exoskeleton.cuff_contact import MIRROR
from geocontact.shoulder_exoskeleton.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.human_arm import ArmTrack, HandLoad, second_derivative
from geocontact.shoulder_exoskeleton.joint_loads import Load, PersonNumbers, arm_needs, raising_torque
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, MovedArm

if TYPE_CHECKING:
    from casadi import SX, Function

LOWEST, HIGHEST = np.radians(-30.0), np.radians(180.0)
"""Elevations at which an arm that keeps its torque has left the range of a shoulder [rad]; ours."""
SPLINE = 5
FEWEST = SPLINE + 1
"""Frames in which an arm must stay in its range, for the derivatives of its motion."""
TOLERANCE = 1e-5, 1e-7
"""Relative and absolute, of coordinates, rates and force."""
LONGEST = 0.01
"""s; longest step, so that none passes over a contact."""
PARTS = {
    "shoulder": 3,
    "reach": 3,
    "axis": 3,
    "moment": 3,
    "falls": 3,
    "hand": 3,
    "push": 3,
    "gravity": 3,
    "inertia": 1,
}
"""Columns of the person's side over time: see `ArmBeyondCuff`."""


@dataclass(frozen=True, eq=False)
class ArmBeyondCuff:
    """The person's arm as one body about the axis of raising, in the device's frame.

    Parameters
    ----------
    shoulder, reach
        Shoulder, and from it to the sphere in the cuff [m].
    axis
        n, unit vectors.
    moment
        S, of arm and tool about the shoulder [kg m].
    falls
        b, gravity less the shoulder's acceleration [m/s²].
    hand
        h, from the shoulder to the grip [m].
    push
        F, of the hand on the work [N].
    gravity
        As the device has it [m/s²].
    inertia
        I, of arm and tool about n [kg m²].
    """

    shoulder: Float[np.ndarray, "t 3"]
    reach: Float[np.ndarray, "t 3"]
    axis: Float[np.ndarray, "t 3"]
    moment: Float[np.ndarray, "t 3"]
    falls: Float[np.ndarray, "t 3"]
    hand: Float[np.ndarray, "t 3"]
    push: Float[np.ndarray, "t 3"]
    gravity: Float[np.ndarray, "t 3"]
    inertia: Float[np.ndarray, " t"]

    def columns(self) -> Float[np.ndarray, "t c"]:
        """In the order of `PARTS`."""
        return np.column_stack([getattr(self, name) for name in PARTS])

    def mirrored(self) -> ArmBeyondCuff:
        """A left arm as a right one: places and forces are mirrored, an axis of turning the other way as well."""
        own = {name: getattr(self, name) * MIRROR for name, size in PARTS.items() if size > 1}
        return replace(self, **own | {"axis": -self.axis * MIRROR})


def arm_beyond_cuff(
    track: ArmTrack,
    hand: HandLoad,
    simulation: ArmSimulation,
    frame: DeviceFrame,
    *,
    mass: float,
    segments: BodySegments,
    gravity: Float[np.ndarray, " 3"],
) -> ArmBeyondCuff:
    """Numbers of a recorded arm; arguments as those of `arm_needs`, at the times of the simulation."""
    axis = track.raising()
    ends = {
        "upper_arm": (track.shoulder, track.elbow),
        "forearm": (track.elbow, track.wrist),
        "hand": (track.wrist, track.hand),
    }
    moment, inertia = np.zeros_like(axis), np.zeros(len(axis))

    def about(arm: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, " t"]:
        return np.asarray(np.sum(arm**2, axis=1) - np.einsum("ti,ti->t", arm, axis) ** 2)

    for name, (near, far) in ends.items():
        own = segments[name]
        along = far - near
        length = np.linalg.norm(along, axis=1)
        arm = near + own.centre * along - track.shoulder
        sagittal, transverse, _ = own.moments(own.mass * mass, float(length.mean()))
        across = 1.0 - np.einsum("ti,ti->t", along / length[:, None], axis) ** 2
        moment += own.mass * mass * arm
        inertia += own.mass * mass * about(arm) + 0.5 * (sagittal + transverse) * across
    reach = track.hand - track.shoulder
    moment, inertia = moment + hand.mass * reach, inertia + hand.mass * about(reach)
    falls = gravity - second_derivative(track.time, track.shoulder)
    motion = simulation.motion
    found = ArmBeyondCuff(
        shoulder=motion.shoulder,
        reach=motion.interface - motion.shoulder,
        axis=frame.vectors(axis),
        moment=frame.vectors(moment),
        falls=frame.vectors(falls),
        hand=frame.vectors(reach),
        push=frame.vectors(np.broadcast_to(hand.force, reach.shape)),
        gravity=motion.gravity_at_frames(),
        inertia=np.asarray(inertia),
    )
    return found.mirrored() if motion.side == "left" else found


@dataclass(frozen=True, eq=False)
class TorqueKept:
    """Motion of arm and device while the shoulder keeps its torque.

    Parameters
    ----------
    simulation
        The device's arm along the human one, up to `until`.
    track
        Joints of the human arm at the same times, in the laboratory.
    departure
        δ [rad].
    kept
        Torque of the shoulder that raises the arm [N m].
    left_range
        Whether it ends because the arm leaves its range.
    unexplained
        Root mean square of what the three-dimensional equations miss [N m].
    """

    simulation: ArmSimulation
    track: ArmTrack
    departure: Float[np.ndarray, " t"]
    kept: Float[np.ndarray, " t"]
    left_range: bool
    unexplained: float


class LeavesAtOnceError(ArithmeticError):
    """The arm is in its range for too few frames."""


def torque_kept(
    track: ArmTrack,
    hand: HandLoad,
    simulation: ArmSimulation,
    frame: DeviceFrame,
    *,
    mass: float,
    segments: BodySegments,
    gravity: Float[np.ndarray, " 3"],
    factor: Float[np.ndarray, " t"] | None = None,
) -> TorqueKept:
    """The arm with the device, from the start of the simulation along the recorded motion.

    Parameters
    ----------
    track
        In the laboratory, at the times of the simulation, low-passed as that was.
    factor
        Of the support at each frame, as in the simulation; 1 by default.

    ValueError for a cuff that is no point; ArithmeticError where the motion cannot be stepped, `LeavesAtOnceError`
    where fewer than `FEWEST` frames are.
    """
    if simulation.cuff != "point":
        raise ValueError("the torque is kept in a cuff that holds at a point")
    given = PersonNumbers(mass=mass, segments=segments, gravity=gravity)
    arm = arm_beyond_cuff(track, hand, simulation, frame, mass=mass, segments=segments, gravity=gravity)
    time = simulation.motion.time
    run = _Coupled(simulation, arm, np.ones(len(time)) if factor is None else factor)
    found = run.stepped()
    count = len(found)
    if count < FEWEST:
        raise LeavesAtOnceError(f"an arm that keeps its torque leaves its range after {count} frames")
    turn = found[:, 7]
    after = _turned_track(track, turn)
    kept = raising_torque(track, arm_needs(track, hand, **given))[:count]
    made = run.simulation(found)
    cuff = cuff_load(made, DeviceFrame(frame.origin[:count], frame.rotation[:count]))
    load = HandLoad(hand.mass, np.broadcast_to(hand.force, track.hand.shape)[:count])
    off = raising_torque(after, arm_needs(after, load, **given), cuff) - kept
    inner = off[3:-3] if count > 6 else off  # splines are poor at their ends
    return TorqueKept(made, after, turn, kept, count < len(time), float(np.sqrt(np.mean(inner**2))))


def cuff_load(s: ArmSimulation, frame: DeviceFrame) -> Load:
    """What the cuff does to the upper arm, in the laboratory."""
    back = np.swapaxes(frame.rotation, 1, 2)
    force, place, moment = (
        np.asarray(np.einsum("tij,tj->ti", back, each))
        for each in (s.outputs["force"], s.motion.interface, s.outputs["moment"])
    )
    return Load(force, frame.origin + place, moment)


def _turned_track(track: ArmTrack, turn: Float[np.ndarray, " t"]) -> ArmTrack:
    """Turned about the axis of raising through the shoulder by an angle over time, as long as that is."""
    count = len(turn)
    axis, shoulder = track.raising()[:count], track.shoulder[:count]
    elbow, wrist, hand = (
        shoulder + turned(axis, turn, getattr(track, name)[:count] - shoulder) for name in ("elbow", "wrist", "hand")
    )
    return ArmTrack(track.side, track.time[:count], shoulder, elbow, wrist, hand, track.down[:count])


def turned(
    axis: Float[np.ndarray, "*t 3"], angle: Float[np.ndarray, "*t"] | float, vector: Float[np.ndarray, "*t 3"]
) -> Float[np.ndarray, "*t 3"]:
    """v cos δ + n x v sin δ + n (n·v)(1 - cos δ)."""
    cos, sin = np.cos(angle)[..., None], np.sin(angle)[..., None]
    along = np.sum(axis * vector, axis=-1, keepdims=True)
    return np.asarray(vector * cos + np.cross(axis, vector) * sin + axis * along * (1.0 - cos))


class _Coupled:
    """Equations of device and arm together: state q, u, force of the cylinder, δ, δ'."""

    def __init__(self, s: ArmSimulation, body: ArmBeyondCuff, factor: Float[np.ndarray, " t"]) -> None:
        self.s, self.factor = s, factor
        self.model = arm_model(s.device, cuff=s.cuff)
        self.p = adjusted_numbers(s.device, s.wearer, s.level)
        self.course = make_interp_spline(s.motion.time, body.columns(), SPLINE)
        self.slope = self.course.derivative()
        self.raised = elevation(s.motion.shoulder, s.motion.interface)
        self.rates_of, self.jacobian_of, self.recorded_of = _functions(self.model)

    def given(self, t: float) -> tuple[Float[np.ndarray, " c"], Float[np.ndarray, " c"], float]:
        """The person's side at a time, its rate, and the support's factor, held from frame to frame."""
        at = int(np.searchsorted(self.s.motion.time, t + 1e-12)) - 1
        return self.course(t), self.slope(t), float(self.factor[min(max(at, 0), len(self.factor) - 1)])

    def rates(self, t: float, x: Float[np.ndarray, " x"]) -> Float[np.ndarray, " x"]:
        """Derivative of the state."""
        return np.asarray(self.rates_of(x, *self.given(t), self.p).full()[:, 0])

    def jacobian(self, t: float, x: Float[np.ndarray, " x"]) -> Float[np.ndarray, "x x"]:
        """Derivative of `rates` by the state."""
        return np.asarray(self.jacobian_of(x, *self.given(t), self.p).full())

    def stepped(self) -> Float[np.ndarray, "t x"]:
        """States at the frames until the arm leaves its range; ArithmeticError where they cannot be stepped."""
        from scipy.integrate import solve_ivp  # late: only this bound steps by it

        s, time = self.s, self.s.motion.time
        start = np.concatenate([s.angles[0], s.rates[0], s.cylinder[:1], [0.0, 0.0]])

        def inside(t: float, x: Float[np.ndarray, " x"]) -> float:
            now = float(np.interp(t, time, self.raised)) + float(x[7])
            return float(min(now - LOWEST, HIGHEST - now))

        inside.terminal = True  # type: ignore[attr-defined]
        relative, absolute = TOLERANCE
        found = solve_ivp(
            self.rates,
            (float(time[0]), float(time[-1])),
            start,
            "BDF",
            time,
            events=inside,
            jac=self.jacobian,
            rtol=relative,
            atol=absolute,
            max_step=LONGEST,
        )
        if found.status < 0:
            raise ArithmeticError(f"an arm that keeps its torque cannot be stepped: {found.message}")
        return np.asarray(found.y.T)

    def simulation(self, found: Float[np.ndarray, "t x"]) -> ArmSimulation:
        """The device's arm with its forces along the human one as it moves now."""
        s, count = self.s, len(found)
        time = s.motion.time[:count]
        rows = [self.recorded_of(x, *self.given(float(t))).full()[:, 0] for t, x in zip(time, found, strict=True)]
        w = np.array(rows)
        back = MIRROR if s.motion.side == "left" else np.ones(3)
        interface, shoulder = w[:, :3] * back, s.motion.shoulder[:count]
        motion = replace(
            s.motion,
            time=time,
            interface=interface,
            shoulder=shoulder,
            elevation=elevation(shoulder, interface),
            gravity=s.motion.gravity_at_frames()[:count],
        )
        none, names = np.zeros(0), tuple(self.model.equations.names)
        states = SimulatedMotion(
            time,
            names,
            found[:, :3],
            found[:, 3:6],
            found[:, 6:7],
            time[1:],
            0,
            none,
            np.zeros((count, found.shape[1], 0)),
        )
        moved = MovedArm(motion, s.device, s.wearer, s.level, s.cuff, self.model, self.p, w, states)
        return moved.simulation(most_lost=1.0)


@lru_cache(maxsize=8)
def _functions(model: ArmModel) -> tuple[Function, Function, Function]:
    """Derivative of the state of `_Coupled` and its Jacobian, of (x, person's side, its rate, factor, numbers), and the
    inputs of the device's equations, of the first four.
    """
    from casadi import SX, Function, cos, cross, densify, dot, jacobian, sin, vertcat

    width = sum(PARTS.values())
    x, now, then, factor = SX.sym("x", 9), SX.sym("now", width), SX.sym("then", width), SX.sym("factor")
    p = SX.sym("numbers", sum(SIZES.values()))
    ends = np.cumsum([0, *PARTS.values()])
    v, d = (
        {name: of[int(a) : int(b), :] for name, a, b in zip(PARTS, ends[:-1], ends[1:], strict=True)}
        for of in (now, then)
    )
    n, turn, rate = v["axis"], x[7], x[8]

    def around(vector: SX) -> SX:
        return vector * cos(turn) + cross(n, vector) * sin(turn) + n * dot(n, vector) * (1.0 - cos(turn))

    reach = around(v["reach"])
    speed = around(d["reach"]) + cross(d["axis"], v["reach"]) * sin(turn) + rate * cross(n, reach)
    speed += (d["axis"] * dot(n, v["reach"]) + n * dot(d["axis"], v["reach"])) * (1.0 - cos(turn))
    w = vertcat(v["shoulder"] + reach, d["shoulder"] + speed, v["gravity"], factor, 0.0)
    state = (x[:3], x[3:6], x[6], w, p)
    cuff = model.outputs(*state)[output_slices()["force"], :]
    torque = dot(n, cross(around(v["moment"]) - v["moment"], v["falls"])) + dot(n, cross(reach, cuff))
    torque -= dot(n, cross(around(v["hand"]) - v["hand"], v["push"]))
    turning = (torque - d["inertia"] * rate) / v["inertia"]
    of = slices()
    force = (p[of["push"], :] * factor - x[6]) / p[of["lag"], :]
    rates = densify(vertcat(x[3:6], model.equations.accelerations()(*state), force, rate, turning))
    given = [x, now, then, factor, p]
    slope = Function("slope", given, [densify(jacobian(rates, x))])
    return Function("rates", given, [rates]), slope, Function("recorded", given[:4], [densify(w)])
