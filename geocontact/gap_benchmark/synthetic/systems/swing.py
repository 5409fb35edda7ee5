"""A hinged arm that an interface drives, the whole trial at once.

I e'' + (c - β) e' = level τ(e) - m g l_c sin e + N s + X + κ (e - e°) - β e°', with e'' and e' central differences, so
that every sample follows from the two before it in closed form (Störmer 1907, Verlet 1967; damping implicit). Without
effects X = κ = β = 0, and one march is the answer. What is hooked in makes a further torque, a functional of the whole
motion: Newton's method takes it at the last motion e° and adds how it follows small oscillations about that.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from geocontact.gap_benchmark.synthetic.compile import loop
from geocontact.gap_benchmark.synthetic.hooks import Values
from geocontact.gap_benchmark.synthetic.systems.interface import NotConvergedError

Torque = Callable[[Values], Values]
"""Further torque over time [N m] that a motion e(t) meets."""

GRAVITY = 9.81
PARTS, SAME_TICK = 20, 1e-6
"""Into how many parts the shortest time between two samples may have to be cut; how exactly these must fit."""
SAME = 1e-7
"""Change of the motion at which it counts as found [rad]."""
ROUNDS, PATIENT = 60, 15
"""Newton steps, and those that are taken whole."""
PROBE = 1e-5
"""Oscillation by which the further torque is probed [rad]."""
STRIDE, WIDER, FARTHEST = 0.01, 1.5, 2.0
"""First stride of the search for equilibrium [rad], how each next one grows, and how far it goes; a Newton step that is
longer than that leads nowhere."""


@dataclass(frozen=True)
class Arm:
    """Inertia [kg m^2], viscous hinge [N m s], m g l_c [N m], stiffness [N/m] and damping [N s/m] of the interface.

    `angle` and `torque` are the support at this trial's level.
    """

    inertia: float
    hinge: float
    weight: float
    k: float
    b: float
    angle: Float[np.ndarray, " k"]
    torque: Float[np.ndarray, " k"]

    @property
    def numbers(self) -> Float[np.ndarray, " five"]:
        """The numbers in the order in which the march reads them."""
        return np.array([self.inertia, self.hinge, self.weight, self.k, self.b])

    def driven(self, e: Values, rate: Values, way: Values) -> tuple[Values, Values]:
        """Torque [N m] on the arm, and force [N] on the sphere, whose place from the hinge and rate are `way`."""
        s, c = np.sin(e), np.cos(e)
        along = way[0] * s - way[1] * c
        pressed = self.k * (way[0] * c + way[1] * s) + self.b * (way[2] * c + way[3] * s - rate * along)
        held = np.interp(e, self.angle, self.torque) - self.weight * s - self.hinge * rate
        return np.asarray(held + pressed * along), np.asarray(-pressed)


@loop
def march(
    h: float,
    w: Float[np.ndarray, "four t"],
    n: Float[np.ndarray, " five"],
    table: Float[np.ndarray, "two k"],
    further: Float[np.ndarray, "five t"],
    rest: float,
) -> Float[np.ndarray, " t"]:
    """Angle e at every sample, from rest; `further` has rows X, κ, β, e°, e°'."""
    count, last = w.shape[1], table.shape[1] - 1
    out = np.empty(count)
    now, before, j = rest, rest, 0
    for i in range(count):
        out[i] = now
        s, c = np.sin(now), np.cos(now)
        along, off = w[0, i] * s - w[1, i] * c, w[0, i] * c + w[1, i] * s
        if now <= table[0, 0]:
            held = table[1, 0]
        elif now >= table[0, last]:
            held = table[1, last]
        else:
            while now < table[0, j]:
                j -= 1
            while now > table[0, j + 1]:
                j += 1
            held = table[1, j] + (table[1, j + 1] - table[1, j]) * (now - table[0, j]) / (table[0, j + 1] - table[0, j])
        pressed = n[3] * off + n[4] * (w[2, i] * c + w[3, i] * s)
        torque = held - n[2] * s + pressed * along
        torque += further[0, i] + further[1, i] * (now - further[3, i]) - further[2, i] * further[4, i]
        drag = n[1] + n[4] * along * along - further[2, i]
        if i == 0:
            new = now + 0.5 * h * h * torque / n[0]
        else:
            lossy = 0.5 * h * drag / n[0]
            new = (torque * h * h / n[0] + 2.0 * now - before * (1.0 - lossy)) / (1.0 + lossy)
        before, now = now, new
    return out


@loop
def follow(
    h: float,
    inertia: float,
    by_angle: Float[np.ndarray, " t"],
    by_rate: Float[np.ndarray, " t"],
    push: Float[np.ndarray, "t q"],
    rest: Float[np.ndarray, " q"],
) -> Float[np.ndarray, "t q"]:
    """Small motions x about a march: I x'' = by_angle x + by_rate x' + push, each column from its own rest."""
    out = np.empty(push.shape)
    out[0] = rest
    for i in range(push.shape[0] - 1):
        lossy = -0.5 * h * by_rate[i] / inertia
        for j in range(push.shape[1]):
            torque = by_angle[i] * out[i, j] + push[i, j]
            if i == 0:
                out[1, j] = out[0, j] + 0.5 * h * h * torque / inertia
            else:
                new = torque * h * h / inertia + 2.0 * out[i, j] - out[i - 1, j] * (1.0 - lossy)
                out[i + 1, j] = new / (1.0 + lossy)
    return out


def swing(h: float, w: Float[np.ndarray, "four t"], arm: Arm, further: Torque | None, rest: float) -> Values:
    """Angle of the arm [rad] along the sphere's way `w` relative to the hinge: x, y [m] and their rates, `h` [s] apart.

    Raises NotConvergedError where Newton's method does not settle.
    """
    table = np.array([arm.angle, arm.torque])
    known = np.zeros((5, w.shape[1]))
    angle = march(h, w, arm.numbers, table, known, rest)
    if further is None:
        return angle
    pace = np.sqrt(arm.k / arm.inertia) * float(np.hypot(w[0], w[1]).mean())
    turn = pace * h * np.arange(w.shape[1])
    s, c = np.sin(turn), np.cos(turn)
    for step in range(ROUNDS):
        known[0] = further(angle)
        by_s, by_c = ((further(angle + PROBE * wave) - known[0]) / PROBE for wave in (s, c))
        known[1], known[2] = by_s * s + by_c * c, (by_s * c - by_c * s) / pace
        # a slope that drives the arm away or feeds an oscillation is no use for the next guess
        known[1] = np.minimum(known[1], arm.k * (w[0] * np.sin(angle) - w[1] * np.cos(angle)) ** 2)
        known[2] = np.minimum(known[2], arm.hinge)
        known[3], known[4] = angle, np.gradient(angle, h, edge_order=2)
        new = march(h, w, arm.numbers, table, known, rest)
        off = float(np.abs(new - angle).max())
        if not off < FARTHEST:  # or laws that remember would take ever smaller steps
            break
        angle = new if step < PATIENT else 0.5 * (new + angle)
        if off < SAME:
            return angle
    raise NotConvergedError(f"the arm's motion was not found, the last change is {off:.2g} rad")


def at_rest(torque: Callable[[float], float], here: float) -> float:
    """First angle of equilibrium from `here` on, the way that the torque turns the arm."""
    first = torque(here)
    side = float(np.sign(first))
    near, far, stride = 0.0, STRIDE, STRIDE
    while side * torque(here + side * far) > 0.0:
        stride *= WIDER
        near, far = far, far + stride
        if far > FARTHEST:
            raise NotConvergedError("the arm finds no rest")
    return float(brentq(torque, here + side * near, here + side * far, xtol=1e-12)) if first else here


def tick(time: Float[np.ndarray, " t"]) -> float:
    """Longest step that leads to every sample [s]: the shortest between two, or a whole part of it."""
    apart = np.diff(time)
    for parts in range(1, PARTS + 1):
        along = apart * parts / apart.min()
        if float(np.abs(along - np.round(along)).max()) < SAME_TICK:
            return float(apart.min() / parts)
    raise NotConvergedError("samples are apart by no whole number of steps")
