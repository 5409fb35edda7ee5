"""One stance of the prosthetic side along a recorded motion: place of the pelvis, socket and keel are found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.on_tree import joint_numbers, rubbing_numbers
from geocontact.below_knee_prosthesis.keel.quasi_static import loads_at
from geocontact.below_knee_prosthesis.leg_tree import LegMotion, driving_inputs
from geocontact.below_knee_prosthesis.stance_model import (
    FLOOR,
    OUTPUTS,
    StanceModel,
    stance_model,
    stance_numbers,
)
from geocontact.contact.bushing import PISTONING, SOCKET, Bushing
from geocontact.dynamics.recorded_inputs import SMOOTH
from geocontact.dynamics.simulate import SimulatedMotion
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.centre_of_pressure import centre_of_pressure
from geocontact.loads.ground import Stairs
from geocontact.loads.sphere_set import SphereLoads

TOLERANCE, FIRST = 3e-5, 1e-4
"""Error allowed in a step [m, rad, m/s, rad/s], plus as much of each one's size, and first step [s]."""
SAMPLING = 500.0
"""Hz; at which the stance is sampled."""
GATE = 20.0
"""N; below it there is no centre of pressure and no stance."""


@dataclass(frozen=True, eq=False)
class Push:
    """Force of the other leg's ground on the body over time, in the ground's frame [N]; zero before and after."""

    time: Float[np.ndarray, " t"]
    force: Float[np.ndarray, "t 3"]

    def at(self, time: Float[np.ndarray, " f"]) -> Float[np.ndarray, "f 3"]:
        """At other times, linear between samples."""
        return np.column_stack([np.interp(time, self.time, column, 0.0, 0.0) for column in self.force.T])


@dataclass(frozen=True, eq=False)
class Stance:
    """A simulated stance, at even times; frames as of a right leg.

    Parameters
    ----------
    motion
        Recorded coordinates that drove it.
    foot, fulcrum, bushing
        What it stood on.
    push
        Of the other leg.
    time, found
        [s], and coordinates and rates of pelvis, socket and keel.
    poses
        `X_GK` of the keel's frame.
    loads
        Of the ground on each sphere.
    socket
        Load of the residual limb on the socket along the bushing's directions [N m, N].
    ground
        That it stood on.
    """

    motion: LegMotion
    foot: VariableStiffnessFoot
    fulcrum: float
    bushing: Bushing
    push: Push
    time: Float[np.ndarray, " t"]
    found: SimulatedMotion
    poses: RigidTransform
    loads: SphereLoads
    socket: Float[np.ndarray, "t 6"]
    ground: HalfSpace | Stairs = FLOOR

    @property
    def force(self) -> Float[np.ndarray, "t 3"]:
        """Force of the ground on the foot [N]."""
        return np.asarray(self.loads.force.sum(axis=1))

    def centre(self, point: str) -> Float[np.ndarray, "t 3"]:
        """Centre of pressure [m] by one of `POINTS`; NaN where less than `GATE` presses."""
        return centre_of_pressure(self.loads, point, GATE).centre

    def along_foot(self, point: str) -> Float[np.ndarray, " t"]:
        """Centre of pressure from the heel towards the toes, share of the keel's length."""
        return share_of_foot(self.poses, self.foot.keel.length, self.centre(point))

    @property
    def on(self) -> Bool[np.ndarray, " t"]:
        """Where the foot is loaded."""
        return np.asarray(self.force[:, 1] >= GATE)

    @property
    def keel_angles(self) -> Float[np.ndarray, "t n"]:
        """Angles of the keel's joints [rad]."""
        return self.found.q[:, 8 + int(self.foot.keel.twists) :]

    @property
    def twist(self) -> Float[np.ndarray, " t"] | None:
        """Turn of the keel about its long axis [rad], lateral side down positive; None without torsion."""
        return self.found.q[:, 8] if self.foot.keel.twists else None

    @property
    def stored(self) -> Float[np.ndarray, " t"]:
        """Energy of the keel's springs [J]."""
        return np.asarray(0.5 * self.found.q[:, 8:] ** 2 @ joint_numbers(self.foot.keel, self.fulcrum)[0])

    @property
    def lost(self) -> Float[np.ndarray, " t"]:
        """Energy that the keel's dampers and friction have taken since the start [J]."""
        power = self.found.u[:, 8:] ** 2 @ joint_numbers(self.foot.keel, self.fulcrum)[1]
        if self.found.z.shape[1]:
            size, held, _ = rubbing_numbers(self.foot.keel, self.fulcrum)
            limit = np.abs(self.found.q[:, 8:]) * size + held
            power = power + (limit * self.found.z * self.found.u[:, 8:]).sum(axis=1)
        return np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(self.time))])

    @property
    def ankle(self) -> Float[np.ndarray, "t 3"]:
        """Place of the ankle, fixed to the socket [m]."""
        leg = self.motion.leg
        return np.asarray(self.poses.apply(leg.turn.inv().apply(leg.ankle - leg.keel)))

    @property
    def ankle_moment(self) -> Float[np.ndarray, " t"]:
        """Moment of the ground's force about the ankle in the foot's sagittal plane [N m].

        Positive where it bends the toes up, as in late stance: what the foot resists as a plantarflexor. Mass and
        weight of the foot are not in it.
        """
        arms = np.where(np.isfinite(self.loads.point), self.loads.point - self.ankle[:, None], 0.0)
        moment = np.cross(arms, self.loads.force).sum(axis=1)
        return np.asarray(np.einsum("ti,ti->t", moment, self.poses.rotation.apply([0.0, 0.0, 1.0])))

    @property
    def pistoning(self) -> Float[np.ndarray, " t"]:
        """Shift of the socket along the residual limb [m]."""
        return self.found.q[:, 6]

    @property
    def beyond(self) -> tuple[Bool[np.ndarray, " t"], Bool[np.ndarray, " t"]]:
        """Where pistoning, and where its speed, is past the study's limit."""
        return PISTONING.beyond(self.pistoning, self.found.u[:, 6])


def share_of_foot(poses: RigidTransform, length: float, point: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, " t"]:
    """Place of points along the keel's straight axis, from its posterior end 0 to its anterior one 1."""
    forward = poses.rotation.apply([1.0, 0.0, 0.0])
    return np.asarray(np.einsum("ti,ti->t", point - poses.translation, forward) / length)


def simulate_stance(
    motion: LegMotion,
    foot: VariableStiffnessFoot,
    fulcrum: float,
    push: Push,
    span: tuple[float, float],
    *,
    bushing: Bushing = SOCKET,
    ground: HalfSpace | Stairs = FLOOR,
    tolerance: float = TOLERANCE,
    steps: int | None = None,
    machine_code: bool = True,
) -> Stance:
    """From the recorded place and speed of the pelvis at the start of the span [s] to its end.

    Parameters
    ----------
    push
        What stands for the other leg: the ground's force on it, as it was measured or is known.
    ground
        In the laboratory, y up: a plane, or stairs along x.
    tolerance, steps, machine_code
        As those of `Stepper`.

    The study starts without speed; a body that stands still at touch-down does not walk, so it starts as recorded here.
    ValueError for a fulcrum out of range; ArithmeticError where the motion cannot go on.
    """
    model = stance_model(foot, ground, machine_code=machine_code)
    p = stance_numbers(motion.leg, foot, fulcrum, bushing, ground)
    inputs = driving_inputs(motion, push.at(motion.time))
    count = round((span[1] - span[0]) * SAMPLING)
    time = span[0] + np.arange(count + 1) / SAMPLING
    found = model.stepper.simulate(
        recorded_start(model, motion, span[0]),
        time,
        inputs=inputs,
        parameters=p,
        tolerance=tolerance,
        first=FIRST,
        steps=steps,
    )
    columns = found.q.T, found.u.T, found.z.T, inputs.at(time).T, np.repeat(p[:, None], len(time), axis=1)
    outputs = outputs_at(model, *columns)
    loads = loads_at(foot.at(fulcrum), found.q[:, 8:], found.u[:, 8:], outputs.poses, outputs.rate, ground)
    return Stance(motion, foot, fulcrum, bushing, push, time, found, outputs.poses, loads, outputs.socket, ground)


def recorded_start(
    model: StanceModel, motion: LegMotion, when: float
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"], Float[np.ndarray, " k"]]:
    """Coordinates, rates and memories at a time [s]: the pelvis as recorded, socket and keel at rest."""
    place = [motion.place(axis, when) for axis in "xy"]
    q, u = np.zeros((2, len(model.equations.names)))
    q[:2], u[:2] = np.transpose(place)
    return q, u, np.zeros(model.equations.z.shape[0])


def recorded_speed(motion: LegMotion) -> Float[np.ndarray, "t 3"]:
    """Speed of the pelvis [m/s]."""
    return np.asarray(make_interp_spline(motion.time, motion.values[:, 3:6], k=SMOOTH)(motion.time, 1))


@dataclass(frozen=True, eq=False)
class StateOutputs:
    """The keel's frame in the ground over some states, its rate, and the load on the socket [N m, N]."""

    poses: RigidTransform
    rate: Float[np.ndarray, "t 4 4"]
    socket: Float[np.ndarray, "t 6"]


def outputs_at(
    model: StanceModel,
    q: Float[np.ndarray, "n t"],
    u: Float[np.ndarray, "n t"],
    z: Float[np.ndarray, "k t"],
    w: Float[np.ndarray, "w t"],
    p: Float[np.ndarray, "p t"],
) -> StateOutputs:
    """Values of states, inputs and parameters, each in a column."""
    values = np.array(model.outputs.map(q.shape[1])(q, u, z, w, p)).T
    ends = np.cumsum([0, *OUTPUTS.values()])
    outputs = {name: values[:, ends[k] : ends[k + 1]] for k, name in enumerate(OUTPUTS)}
    turn = Rotation.from_matrix(outputs["rotation"].reshape(-1, 3, 3))
    return StateOutputs(RigidTransform.from_components(outputs["place"], turn), _rate(outputs), outputs["socket"])


def _rate(outputs: dict[str, Float[np.ndarray, "t _"]]) -> Float[np.ndarray, "t 4 4"]:
    """Time derivative of the pose's matrix."""
    rate = np.zeros((len(outputs["place"]), 4, 4))
    turn = outputs["rotation"].reshape(-1, 3, 3)
    rate[:, :3, :3] = np.cross(outputs["spin"][:, None], turn.swapaxes(1, 2)).swapaxes(1, 2)
    rate[:, :3, 3] = outputs["speed"]
    return rate
