"""Spheres under a foot that moves as recorded over level ground, in the sagittal plane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, sin

import numpy as np
from jaxtyping import Float, Int

from geocontact.chain.contact_law import contact_force, friction_coefficient
from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.links import Law, LawParameters, Loads, Source, Values
from geocontact.chain.system import (
    ATTEMPTS,
    TOLERANCE,
    next_load,
    nothing_known,
    require_convergence,
    start_over,
)
from geocontact.geometry.kernels.compile import kernel
from geocontact.systems.foot_slopes import BRANCH, ELASTIC, MEMORY, UNKNOWN, B, K, stand_slopes

FOOT_GEOMETRY = LawParameters(
    {
        "series_compliance.compliance": 0.0,
        "series_compliance.exponent": 1.0,
        "series_compliance.reference": 1.0,
    }
)
INPUTS = ("x", "y", "pitch")
PX, PY, RADIUS = range(3)


@kernel
def approach(
    pose: Float[np.ndarray, "three t"], rate: Float[np.ndarray, "three t"], spheres: Float[np.ndarray, "five n"]
) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
    """Depth of every sphere [m], its rate [m/s], and the forward speed of the material point at its bottom [m/s].

    Height of a centre h = y + px sin(pitch) + py cos(pitch), depth = radius - h,
    speed = x' - pitch' (h - radius - y).
    """
    shape = (pose.shape[1], spheres.shape[1])
    depth, closing, speed = np.empty(shape), np.empty(shape), np.empty(shape)
    for i in range(shape[0]):
        s, c = sin(pose[2, i]), cos(pose[2, i])
        for j in range(shape[1]):
            above = spheres[PX, j] * s + spheres[PY, j] * c
            depth[i, j] = spheres[RADIUS, j] - (pose[1, i] + above)
            closing[i, j] = -rate[1, i] - rate[2, i] * (spheres[PX, j] * c - spheres[PY, j] * s)
            speed[i, j] = rate[0, i] - rate[2, i] * (above - spheres[RADIUS, j])
    return depth, closing, speed


@kernel
def press(
    depth: Float[np.ndarray, " n"],
    closing: Float[np.ndarray, " n"],
    h: float,
    spheres: Float[np.ndarray, "five n"],
    law: Float[np.ndarray, " numbers"],
    way: Float[np.ndarray, " two"],
    old: Float[np.ndarray, "n memory"],
    new: Float[np.ndarray, "n memory"],
    normal: Float[np.ndarray, " n"],
) -> float:
    """Sum of the spheres' forces when the foot has given `way`: by how much [m] and how fast [m/s]."""
    total = 0.0
    for j in range(depth.size):
        normal[j], new[j, BRANCH], new[j, ELASTIC] = contact_force(
            depth[j] - way[0],
            closing[j] - way[1],
            h,
            spheres[K, j],
            spheres[B, j],
            law,
            old[j, BRANCH],
            old[j, ELASTIC],
        )
        total += normal[j]
    return total


@kernel
def gives_way(force: float, n: Float[np.ndarray, " three"]) -> float:
    """Height by which a spring in series gives way to `force` [m]."""
    share = force / n[2]
    return float(n[0] * n[2] * (share if n[1] == 1.0 else abs(share) ** n[1]))


@kernel
def stand(
    time: Float[np.ndarray, " t"],
    depth: Float[np.ndarray, "t n"],
    closing: Float[np.ndarray, "t n"],
    spheres: Float[np.ndarray, "five n"],
    law: Float[np.ndarray, " numbers"],
    n: Float[np.ndarray, " three"],
) -> tuple[Float[np.ndarray, "t n"], int]:
    """Normal forces of every sample [N], and how many samples have no solution.

    With a spring in series the foot is y + c F high: one implicit equation per sample, the spring's rate being its
    change over the step (first order in the step).
    """
    normal = np.empty(depth.shape)
    old, new = np.zeros((depth.shape[1], MEMORY)), np.zeros((depth.shape[1], MEMORY))
    way = np.zeros(2)
    search = nothing_known()
    unsolved = 0
    before = last = earlier = 0.0
    for i in range(depth.shape[0]):
        h = time[i] - time[i - 1] if i else 0.0
        if n[0] == 0.0:
            press(depth[i], closing[i], h, spheres, law, way, old, new, normal[i])
        else:
            start_over(search)
            guess = max(2.0 * last - earlier, 0.0)
            earlier = last
            solved = False
            for _ in range(ATTEMPTS):
                way[0] = gives_way(guess, n)
                way[1] = (way[0] - before) / h if i else 0.0
                last = press(depth[i], closing[i], h, spheres, law, way, old, new, normal[i])
                solved = abs(guess - last) <= TOLERANCE * max(last, n[2])
                if solved:
                    break
                guess = max(next_load(guess, guess - last, search), 0.0)
            unsolved += not solved
            before = gives_way(last, n)
        old, new = new, old
    return normal, unsolved


@kernel
def rub(
    normal: Float[np.ndarray, "t n"],
    speed: Float[np.ndarray, "t n"],
    turn: Float[np.ndarray, " t"],
    law: Float[np.ndarray, " numbers"],
    n: Float[np.ndarray, " three"],
) -> Float[np.ndarray, "t n"]:
    """Tangential forces [N], against the speed.

    A spring in series lengthens the lever from the measured origin to the ground: speed = x' - pitch' (h - radius - y)
    with the height h of the centre that has given way and the y that was measured.
    """
    out = np.zeros(normal.shape)
    for i in range(normal.shape[0]):
        further = turn[i] * gives_way(normal[i].sum(), n) if n[0] != 0.0 else 0.0
        for j in range(normal.shape[1]):
            if normal[i, j] > 0.0:
                out[i, j] = -normal[i, j] * friction_coefficient(speed[i, j] - further, law[4], law[2], law[3])
    return out


@dataclass(frozen=True)
class FootSpheres:
    """Geometry link of the foot: inputs x, y, pitch; one deflection, its depth, per sphere.

    Parameters
    ----------
    px, py, radius
        Centres in the foot's frame and radii [m].
    zone
        Of each sphere; its stiffness and damping are the parameters k_<zone>, b_<zone>.
    """

    px: Float[np.ndarray, " n"]
    py: Float[np.ndarray, " n"]
    radius: Float[np.ndarray, " n"]
    zone: tuple[str, ...]
    slots: LawParameters = FOOT_GEOMETRY

    @property
    def yields(self) -> str:
        """Input that gives way to a spring in series."""
        return "y"

    def having(self, sources: Mapping[str, Source]) -> FootSpheres:
        """The same link with more of its numbers coming from somewhere."""
        return replace(self, slots=self.slots.having(sources))

    def spheres(self, values: Values) -> Float[np.ndarray, "five n"]:
        """Places, radii, stiffness and damping of the spheres."""
        of_sphere, stiffness, damping = self._zones
        k, b = (np.array([values[name] for name in names])[of_sphere] for names in (stiffness, damping))
        return np.array([self.px, self.py, self.radius, k, b])

    @cached_property
    def _zones(self) -> tuple[Int[np.ndarray, " n"], list[str], list[str]]:
        """Which zone each sphere is of, and what stiffness and damping of the zones are called."""
        zones = list(dict.fromkeys(self.zone))
        at = np.array([zones.index(zone) for zone in self.zone], int)
        return at, [f"k_{zone}" for zone in zones], [f"b_{zone}" for zone in zones]

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """Depths [m], 0 off the ground, and their rates [m/s] without load."""
        depth, closing, _ = approach(*self.pose(movement), self.spheres(values))
        return np.maximum(depth, 0.0), closing

    def pose(self, movement: DifferentiatedInputs) -> tuple[Float[np.ndarray, "three t"], Float[np.ndarray, "three t"]]:
        """Rows x, y, pitch of position and rate."""
        if movement.inputs == INPUTS:
            return movement.position, movement.rate
        rows = [movement.row(name) for name in INPUTS]
        return movement.position[rows], movement.rate[rows]

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Forces along a movement; each acts at px - radius sin(pitch) in the foot's frame."""
        pose, rate = self.pose(movement)
        spheres, numbers, n = self.spheres(values), law.slots.numbers(values), self.slots.numbers(values)
        depth, closing, speed = approach(pose, rate, spheres)
        normal, unsolved = stand(movement.time, depth, closing, spheres, numbers, n)
        require_convergence(unsolved, len(normal), n[0])
        arm = self.px - np.sin(pose[2])[:, None] * self.radius
        return Loads(normal, rub(normal, speed, rate[2], numbers, n), arm)

    def changes(
        self, movement: DifferentiatedInputs, law: Law, values: Values, others: Sequence[Values]
    ) -> tuple[Loads, list[Loads | None]] | None:
        """Forces along a movement, and how they change towards other values (`chain.system`)."""
        n, numbers, spheres = self.slots.numbers(values), law.slots.numbers(values), self.spheres(values)
        if n[0] != 0.0:
            return None
        pose, rate = self.pose(movement)
        depth, closing, speed = approach(pose, rate, spheres)
        dlaw = law.slots.towards(values, others)
        dspheres = np.array([self.spheres(other) - spheres for other in others]).reshape(-1, *spheres.shape)
        known = ~((self.slots.towards(values, others)[:, 0] != 0.0) | dlaw[:, UNKNOWN].any(axis=1))
        moving = known & (dlaw.any(axis=1) | dspheres.any(axis=(1, 2)))
        normal, slopes = stand_slopes(movement.time, depth, closing, spheres, numbers, dspheres[moving], dlaw[moving])
        tangential = rub(normal, speed, rate[2], numbers, n)
        share = np.divide(tangential, normal, out=np.zeros_like(normal), where=normal > 0.0)
        nothing = np.zeros_like(normal)
        arm = self.px - np.sin(pose[2])[:, None] * self.radius
        changed = iter(slopes)
        found = [next(changed) if there else nothing for there in moving]
        more = [
            Loads(force, force * share, nothing) if there else None for force, there in zip(found, known, strict=True)
        ]
        return Loads(normal, tangential, arm), more
