"""Trials of a person in an exoskeleton that share no equations with the package: for `standing_strap_intervals`.

Own Lagrangian of both chains (straps by a potential and Rayleigh's function, contacts by Jacobians), a feedback
controller at every joint instead of least jerk, LSODA. Feet are two spheres by OpenSim's law with other numbers, or
two cushions on a floor on which they creep, by no law that the package has. Everything is invented.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from geocontact.standing_up.trials import StandingTrial

SEGMENTS = {
    "foot": (2 * 0.0137, 0.1482, 0.20, 0.245),
    "shank": (2 * 0.0433, 0.2529, 1.0 - 0.4459, 0.249),
    "thigh": (2 * 0.1416, 0.2425, 1.0 - 0.4095, 0.329),
    "trunk": (1.0 - 2 * (0.0137 + 0.0433 + 0.1416), 0.3465, 0.53, 0.44),
}
"""de Leva's, as fractions of mass, height, length and length."""
EXOSKELETON, PLATE, MODULE, HIGHER = (3.0, 4.0, 5.0), 2.0, 0.25, 0.01
RATE = 100.0
STARTS = (np.radians([30.0, 61.0, 50.0]), np.radians([29.0, 65.0, 56.0]), np.radians([32.0, 55.0, 43.0]))
ENDS = np.radians([7.0, 6.0, 5.0])
SECONDS, BEFORE, AFTER = (1.4, 1.7, 1.2), 0.8, 0.25
SHARE = 0.25
"""Of the person's torque at ankle and knee, that the exoskeleton gives."""
BALANCED, RIGHTING, SLOWING = 0.035, 2500.0, 500.0
"""Where ahead of the ankle the mass centre is wanted [m], and what the ankle does about it [N], [N s]."""


@dataclass(frozen=True)
class World:
    """Numbers of a person, straps and feet; `cushions` for feet by another law."""

    mass: float = 55.0
    height: float = 1.60
    modulus: float = 15e6
    heel: float = -0.035
    toe: float = 0.12
    bottom: float = 0.085
    radius: float = 0.034
    dissipation: float = 1.2
    friction: float = 0.85
    normal: float = 6000.0
    tangential: float = 2500.0
    turning: float = 40.0
    place: float = 0.18
    cushions: bool = False

    @property
    def strap(self) -> tuple[float, float, float, float]:
        """Planted, in the order of the package's parameters."""
        return self.normal, self.tangential, self.turning, self.place


def up(turn: Any) -> Any:
    """Of a segment that stands at 0."""
    from casadi import cos, sin, vertcat

    return vertcat(-sin(turn), cos(turn))


def ahead(turn: Any) -> Any:
    """Across it, forwards."""
    from casadi import cos, sin, vertcat

    return vertcat(cos(turn), sin(turn))


class Chains:
    """Equations of motion, and what encoders, plates and a mat see.

    q: foot_x, foot_y, foot_turn, ankle, knee, hip, then the exoskeleton's ankle, knee and hip.
    """

    def __init__(self, world: World) -> None:
        from casadi import SX, Function, dot, gradient, jacobian, jtimes, mtimes, solve, vertcat

        self.world = world
        q, u, torque = SX.sym("q", 9), SX.sym("u", 9), SX.sym("torque", 6)
        turns, joints, bodies = self._bodies(q)
        kinetic, potential = SX(0), SX(0)
        for mass, centre, turn, inertia in bodies:
            speed, spin = jtimes(centre, q, u), jtimes(turn, q, u)
            kinetic += 0.5 * mass * dot(speed, speed) + 0.5 * inertia * spin**2
            potential += mass * 9.81 * centre[1]
        stored, lost, normal = self._strap(q, u, turns, joints)
        forces = vertcat(SX(3, 1), torque) - gradient(potential + stored, q) - gradient(lost, u)
        force, about = SX(2, 1), SX(0)
        for place in (world.heel, world.toe):
            push, point = self._contact(q, u, place)
            fixed = vertcat(dot(point - q[:2], ahead(q[2])), dot(point - q[:2], up(q[2])))
            own = SX.sym("own", 2)
            moved = jacobian(q[:2] + own[0] * ahead(q[2]) + own[1] * up(q[2]), q)
            forces += mtimes(Function("moved", [q, own], [moved])(q, fixed).T, push)
            force += push
            about += point[0] * push[1] - point[1] * push[0]
        momentum = gradient(kinetic, u)
        right = forces - jtimes(momentum, q, u) + gradient(kinetic, q)
        self.acceleration = Function("acceleration", [q, u, torque], [solve(jacobian(momentum, u), right)])
        self.seen = Function("seen", [q, u], [force, about / force[1], normal])
        middle = sum(mass * centre[0] for mass, centre, *_ in bodies) / sum(mass for mass, *_ in bodies) - q[0]
        self.middle = Function("middle", [q, u], [middle, jtimes(middle, q, u)])

    def _bodies(self, q: Any) -> tuple[list[Any], list[Any], list[Any]]:
        w = self.world
        turns = [q[2]]
        for k in (3, 4, 5):
            turns.append(turns[-1] + q[k])
        device = [q[2] + q[6], q[2] + q[6] + q[7], q[2] + q[6] + q[7] + q[8]]
        of = {k: (m * w.mass, s * w.height, c * s * w.height, r * s * w.height) for k, (m, s, c, r) in SEGMENTS.items()}
        joints, bodies = [q[:2]], []
        mass, _, centre, radius = of["foot"]
        place = q[:2] + centre * ahead(q[2]) - 0.05 * up(q[2])
        bodies.append((mass + PLATE, place, q[2], mass * radius**2))
        for name, turn in zip(("shank", "thigh", "trunk"), turns[1:], strict=True):
            mass, length, centre, radius = of[name]
            bodies.append((mass, joints[-1] + centre * up(turn), turn, mass * radius**2))
            joints.append(joints[-1] + length * up(turn))
        lengths, at = (of["shank"][1] + HIGHER, of["thigh"][1] - HIGHER, MODULE), q[:2]
        hinges = []
        for mass, length, turn in zip(EXOSKELETON, lengths, device, strict=True):
            bodies.append((mass, at + 0.5 * length * up(turn), turn, mass * length**2 / 12.0))
            at = at + length * up(turn)
            hinges.append(at)
        return [*turns, *device], [joints[1], hinges[0]], bodies

    def _strap(self, q: Any, u: Any, turns: Any, joints: Any) -> tuple[Any, Any, Any]:
        """Energy and Rayleigh's function of two straps, and the normal force of one."""
        from casadi import dot, jtimes

        w, thigh, device = self.world, turns[2], turns[5]
        gap = joints[1] + (w.place - HIGHER) * up(device) - joints[0] - w.place * up(thigh)
        off = [dot(ahead(thigh), gap), dot(up(thigh), gap), (q[6] + q[7]) - (q[3] + q[4])]
        rates = [jtimes(each, q, u) for each in off]
        springs, dampers = (w.normal, w.tangential, w.turning), (10.0, 10.0, 0.1)
        stored = sum(k * x**2 for k, x in zip(springs, off, strict=True))
        lost = sum(c * v**2 for c, v in zip(dampers, rates, strict=True))
        return stored, lost, w.normal * off[0] + 10.0 * rates[0]

    def _contact(self, q: Any, u: Any, place: float) -> tuple[Any, Any]:
        from casadi import fmax, fmin, jtimes, sqrt, tanh, vertcat

        w = self.world
        if w.cushions:
            corner = q[:2] + place * ahead(q[2]) - w.bottom * up(q[2])
            speed = jtimes(corner, q, u)
            depth = 0.5 * (sqrt(corner[1] ** 2 + 1e-8) - corner[1])
            pressing = fmax(3e7 * depth**2 * (1.0 - 2.0 * speed[1]), 0.0)
            return vertcat(-0.6 * pressing * tanh(speed[0] / 0.02), pressing), corner
        centre = q[:2] + place * ahead(q[2]) + (w.radius - w.bottom) * up(q[2])
        depth = w.radius - centre[1]
        point = vertcat(centre[0], -0.5 * depth)
        speed = jtimes(centre, q, u)
        sliding, closing = speed[0] - u[2] * (point[1] - centre[1]), -speed[1]
        hertz = 4.0 / 3.0 * 0.5**1.5 * w.modulus * sqrt(w.radius) * (depth**2 + 1e-5) ** 0.75
        hertz = hertz * (0.5 + 0.5 * tanh(300.0 * depth)) * (1.0 + 1.5 * w.dissipation * closing)
        pressing = hertz * (0.5 + 0.5 * tanh(50.0 * (closing + 2.0 / (3.0 * w.dissipation))))
        fast = sqrt(sliding**2 + 1e-5)
        static, kinetic = 0.9 * w.friction, 0.7 * w.friction
        share = fast / 0.2
        rubbing = fmin(share, 1.0) * (kinetic + 2.0 * (static - kinetic) / (1.0 + share**2)) + 0.4 * fast
        return vertcat(-pressing * rubbing * sliding / fast, pressing), point


def wanted(k: int, seconds: np.ndarray) -> np.ndarray:
    """Angles of the person's joints of a trial over the time since the rise began: not of least jerk."""
    s = np.clip(seconds / SECONDS[k], 0.0, 1.0)[:, None]
    way = s - np.sin(2.0 * np.pi * s) / (2.0 * np.pi)
    shank, thigh, trunk = (STARTS[k] + (ENDS - STARTS[k]) * way).T
    return np.column_stack([-shank, shank + thigh, -thigh - trunk])


def torques(chains: Chains, k: int, time: float, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Springs and dampers towards the wanted angles at the person's joints, a share of them at the exoskeleton's."""
    h = 1e-4
    before, at, after = (wanted(k, np.array([time + by]))[0] for by in (-h, 0.0, h))
    stiff, damped = np.array([1500.0, 1200.0, 900.0]), np.array([110.0, 90.0, 70.0])
    person = stiff * (at - q[3:6]) + damped * ((after - before) / (2.0 * h) - u[3:6])
    place, speed = (float(each) for each in chains.middle(q, u))
    person[0] += RIGHTING * (place - BALANCED) + SLOWING * speed
    lean = (q[6] + q[7] + q[8]) - (q[3] + q[4] + q[5])
    hip = -40.0 * lean - 6.0 * (u[6:9].sum() - u[3:6].sum())
    return np.r_[person * np.r_[1.0 - SHARE, 1.0 - SHARE, 1.0], SHARE * person[:2], hip]


def own_trials(world: World, which: Sequence[int] = range(3)) -> list[StandingTrial]:
    """As perfect encoders, plates and mats see them."""
    from scipy.integrate import solve_ivp

    chains, found = Chains(world), []
    for k in which:

        def rate(time: float, state: np.ndarray, k: int = k) -> np.ndarray:
            q, u = state[:9], state[9:]
            return np.r_[u, chains.acceleration(q, u, torques(chains, k, time - BEFORE, q, u)).full().ravel()]

        person = wanted(k, np.zeros(1))[0]
        start = np.r_[0.0, world.bottom - 2e-3, 0.0, person, person]
        last = BEFORE + SECONDS[k] + AFTER
        time = BEFORE + np.arange(round(RATE * (SECONDS[k] + AFTER)) + 1) / RATE
        run = solve_ivp(rate, (0.0, last), np.r_[start, np.zeros(9)], "LSODA", t_eval=time, rtol=1e-8, atol=1e-10)
        if not run.success:
            raise ArithmeticError(run.message)
        q, u = run.y[:9].T, run.y[9:].T
        force, centre, strap = (each.full() for each in chains.seen.map(len(time))(q.T, u.T))
        torque = np.array([torques(chains, k, t - BEFORE, *both) for t, *both in zip(time, q, u, strict=True)])
        found.append(
            StandingTrial(time - BEFORE, q, u, force.T, centre[0], f"T{k + 1}", torque, strap[0], elsewhere={})
        )
    return found
