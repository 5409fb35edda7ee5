"""Both chains of a `numbers.csv` in complex numbers: x forwards is real, y up is imaginary.

Nothing of the package and no number of its own: Newton and Euler from the feet upwards, OpenSim's spheres, springs and
dashpots in the frame of the person's segment, and the terms of the costs. A number that the table lacks is a KeyError.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

Table = Mapping[str, float]
PARENTS = {"shank": "foot", "thigh": "shank", "trunk": "thigh"}
WORN = PARENTS | {"exo_shank": "foot", "exo_thigh": "exo_shank", "exo_module": "exo_thigh"}
HINGES = dict(zip(WORN, ("ankle", "knee", "hip", "exo_ankle", "exo_knee", "exo_hip"), strict=True))
ENDS = {"thigh": ("thigh", "exo_thigh"), "shank": ("shank", "exo_shank"), "pelvis": ("trunk", "exo_module")}
"""Bodies that a strap joins."""


def read(folder: Path) -> tuple[dict[str, float], dict[tuple[str, str], np.ndarray]]:
    """`numbers.csv`, and the ends of the intervals in `mesh.csv` by phase and trial."""
    with (folder / "numbers.csv").open(encoding="utf-8") as file:
        told = {row["number"]: float(row["value"]) for row in csv.DictReader(file)}
    ends: dict[tuple[str, str], list[float]] = {}
    with (folder / "mesh.csv").open(encoding="utf-8") as file:
        for of, trial, at in list(csv.reader(file))[1:]:
            ends.setdefault((of, trial), []).append(float(at))
    return told, {key: np.array(each) for key, each in ends.items()}


@dataclass
class Frame:
    """Place, velocity and acceleration of a body's origin, its turn and the turn's derivatives, over time."""

    place: np.ndarray
    speed: np.ndarray
    change: np.ndarray
    turn: np.ndarray
    spin: np.ndarray
    spun: np.ndarray

    def at(self, x: float, y: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A point of the body: place, velocity, acceleration."""
        arm = (x + 1j * y) * np.exp(1j * self.turn)
        speed, change = self.speed + 1j * self.spin * arm, self.change + (1j * self.spun - self.spin**2) * arm
        return self.place + arm, speed, change


@dataclass
class Strap:
    """Of one: forces on the person [N], moment [N m], energy of its springs by what a mat sees [J], and where it is."""

    normal: np.ndarray
    shear: np.ndarray
    moment: np.ndarray
    unseen: np.ndarray
    seen: np.ndarray
    place: np.ndarray
    turn: np.ndarray


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """About z."""
    return np.asarray(a.real * b.imag - a.imag * b.real)


class Chains:
    """Along coordinates, rates and accelerations, (t, 6) or (t, 9).

    Parameters
    ----------
    prefix
        Of the rows with the parameters of feet and straps.
    """

    def __init__(self, told: Table, prefix: str, q: np.ndarray, u: np.ndarray, a: np.ndarray | None = None) -> None:
        self.told, self.prefix = told, prefix
        a = np.zeros_like(q) if a is None else a
        self.frames = {"foot": Frame(*(of[:, 0] + 1j * of[:, 1] for of in (q, u, a)), q[:, 2], u[:, 2], a[:, 2])}
        self.parents = WORN if q.shape[1] > 6 else PARENTS
        for k, (name, parent) in enumerate(self.parents.items()):
            below, hinge = self.frames[parent], f"joint {HINGES[name]}"
            place = below.at(told[f"{hinge} x"], told[f"{hinge} y"])
            turns = (of[:, 3 + k] + more for of, more in ((q, below.turn), (u, below.spin), (a, below.spun)))
            self.frames[name] = Frame(*place, *turns)

    def of(self, name: str) -> float:
        return self.told[self.prefix + name]

    def sphere(self, ahead: float) -> tuple[np.ndarray, np.ndarray]:
        """Force on the foot and its moment about the origin: halfway between the lowest point and the ground."""
        told, foot, radius, c = self.told, self.frames["foot"], self.of("radius"), self.of("dissipation")
        centre, _, _ = foot.at(ahead, radius - self.of("bottom"))
        depth = radius - centre.imag
        point = centre.real - 0.5j * depth
        velocity = foot.speed + 1j * foot.spin * (point - foot.place)
        rate, flat = -velocity.imag, told["ground constant"]
        k = 0.5 * self.of("stiffness") ** (2.0 / 3.0)
        hertz = 4.0 / 3.0 * k * np.sqrt(radius * k) * (depth**2 + flat) ** 0.75
        up = hertz * (0.5 + 0.5 * np.tanh(told["ground hertz_smoothing"] * depth)) * (1.0 + 1.5 * c * rate)
        up = up * (0.5 + 0.5 * np.tanh(told["ground hunt_crossley_smoothing"] * (rate + 2.0 / (3.0 * c))))
        static, dynamic = (self.of("friction") * told[f"ground {name}"] for name in ("static", "dynamic"))
        speed = np.sqrt(velocity.real**2 + flat)
        part = speed / told["ground transition_speed"]
        mu = np.minimum(part, 1.0) * (dynamic + 2.0 * (static - dynamic) / (1.0 + part**2))
        force = -(mu + told["ground viscous"] * speed) * up * velocity.real / speed + 1j * up
        return force, cross(point, force)

    def ground(self) -> tuple[np.ndarray, np.ndarray]:
        """Of both spheres."""
        both = [self.sphere(self.of(name)) for name in ("heel", "toe")]
        return both[0][0] + both[1][0], both[0][1] + both[1][1]

    @property
    def sites(self) -> tuple[str, ...]:
        """Where the table has straps."""
        return tuple(site for site in ENDS if f"strap at the {site} count" in self.told)

    def strap(self, site: str) -> Strap:
        """Springs and dashpots of one."""
        person, device = (self.frames[name] for name in ENDS[site])
        own, at = f"strap at the {site}", self.of(f"{'' if site == 'thigh' else site + ' '}strap place")
        (place, speed, _), (other, others, _) = person.at(0.0, at), device.at(0.0, at - self.told[f"{own} above"])
        back, gap = np.exp(-1j * person.turn), other - place
        off = gap * back
        rate = (others - speed - 1j * person.spin * gap) * back
        turn, turning = device.turn - person.turn, device.spin - person.spin
        names = ("normal", "tangential", "turning")
        k_n, k_t, k_r = (self.of(f"{'' if site == 'thigh' else site + ' '}strap {name}") for name in names)
        b, b_r = self.told[f"{own} damping"], self.told[f"{own} turning_damping"]
        normal, shear = k_n * off.real + b * rate.real, k_t * off.imag + b * rate.imag
        unseen = 0.5 * (k_t * off.imag**2 + k_r * turn**2)
        return Strap(normal, shear, k_r * turn + b_r * turning, unseen, 0.5 * k_n * off.real**2, other, person.turn)

    def energies(self) -> tuple[np.ndarray, np.ndarray]:
        """Of all straps: of what no mat sees, and of what one does."""
        each = [(self.told[f"strap at the {site} count"], self.strap(site)) for site in self.sites]
        return sum(n * one.unseen for n, one in each), sum(n * one.seen for n, one in each)  # type: ignore[return-value]

    def torques(self) -> np.ndarray:
        """What is left for the foot's forces and turn, then the torque at each hinge, (t, n)."""
        told, gravity = self.told, self.told["gravity_x"] + 1j * self.told["gravity_y"]
        force, moment = {}, {}
        for name, frame in self.frames.items():
            centre, _, change = frame.at(told[f"body {name} centre_x"], told[f"body {name} centre_y"])
            force[name] = told[f"body {name} mass"] * (change - gravity)
            moment[name] = cross(centre, force[name]) + told[f"body {name} inertia"] * frame.spun
        on, about = self.ground()
        force["foot"], moment["foot"] = force["foot"] - on, moment["foot"] - about
        for site in self.sites:
            one, count = self.strap(site), told[f"strap at the {site} count"]
            on = count * (one.normal + 1j * one.shear) * np.exp(1j * one.turn)
            about = cross(one.place, on) + count * one.moment
            for name, sign in zip(ENDS[site], (1.0, -1.0), strict=True):
                force[name], moment[name] = force[name] - sign * on, moment[name] - sign * about
        for name, parent in reversed(self.parents.items()):
            force[parent], moment[parent] = force[parent] + force[name], moment[parent] + moment[name]
        hinges = [moment[name] - cross(self.frames[name].place, force[name]) for name in self.frames]
        return np.column_stack([force["foot"].real, force["foot"].imag, *hinges])


def radau(degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Points in 0 … 1, the last of them 1, and weights that are exact for all polynomials of lower degree."""
    legendre = np.polynomial.legendre
    points = 0.5 + 0.5 * np.sort(legendre.legroots(np.r_[np.zeros(degree - 1), 1.0, -1.0]).real)
    powers = np.arange(degree)
    return points, np.linalg.solve(points[None] ** powers[:, None], 1.0 / (powers + 1.0))


def over(ends: np.ndarray, degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Times of all points of a motion, and their weights in an integral over it."""
    points, weights = radau(degree)
    lengths = np.diff(ends)[:, None]
    return (ends[:-1, None] + lengths * points).ravel(), (lengths * weights).ravel()


def belief(told: Table, prefix: str) -> float:
    """Of all parameters that are sought: squares of what they are off in parts of what is believed."""
    return sum(_beliefs(told, prefix)) / told[f"{prefix}rate"]


def _beliefs(told: Table, prefix: str) -> Iterator[float]:
    lengths = ("heel", "toe", "bottom", "radius", "place")
    for row in told:
        if row.startswith(prefix) and row.endswith(" usual"):
            name = row.removesuffix(" usual")
            value, usual = told[name], told[row]
            off = value - usual if name.endswith(lengths) else np.log(value / usual)
            yield float(off / told[f"{name} sd"]) ** 2


def squares(off: np.ndarray, size: float | Sequence[float] | np.ndarray) -> np.ndarray:
    """Sum over the columns, of parts of their sizes."""
    return np.asarray(np.sum((off / np.asarray(size)) ** 2, axis=-1))
