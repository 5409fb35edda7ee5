"""Equilibrium by Newton's method on the energy, frame after frame of a motion, with a check of the work.

Nocedal & Wright, Numerical Optimization (2006), sec. 3.4: directions of negative curvature are turned over, so that
every step goes downhill, and a step is halved until the energy falls by a share of what its slope promises (Armijo).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Generic, Protocol, TypeVar, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float

from geocontact.geometry.surface import Surface
from geocontact.loads.settling_potential import AXIAL, NAMES, AxialLoad, Bed, Total, placed_at, total_at
from geocontact.loads.start_pose import pressing

HELD = 0.05
"""Share of load over 20 mm: the least stiffness that counts as holding a coordinate. A load that rests in a valley
with a radius of 0.4 m has this much. Pieces of half a millimetre make up to 0.016 where there is none; those of one
millimetre make up to 0.08, so that what nothing holds may pass there."""

SHARE = 0.3
"""Least part of a coordinate in a direction that is not held for it to be named. In a direction of many coordinates,
such as a row of bodies that slides as one, none may have so much: named are then those with half of the largest."""


def least_held(stiffness: Float[np.ndarray, "6 6"], free: Bool[np.ndarray, " 6"]) -> float:
    """Smallest stiffness along any direction of the free coordinates, turns on a lever of 20 mm [N/m]."""
    return float(np.linalg.eigvalsh(_scaled(stiffness, free))[0])


def not_held(
    stiffness: Float[np.ndarray, "n n"], free: Bool[np.ndarray, " n"], load: float, names: Sequence[str] = NAMES
) -> tuple[str, ...]:
    """Names of the free coordinates that neither the contact nor a spring holds; none where all are held."""
    curvature, directions = np.linalg.eigh(_scaled(stiffness, free))
    loose = curvature < HELD * load / ARM
    if not loose.any():
        return ()
    part = np.abs(directions[:, loose])
    largest = part.max(axis=0)
    named = (part >= np.where(largest >= SHARE, SHARE, 0.5 * largest)).any(axis=1)
    return tuple(str(name) for name in np.array(names)[free][named])


def _scaled(stiffness: Float[np.ndarray, "n n"], free: Bool[np.ndarray, " n"]) -> Float[np.ndarray, "k k"]:
    scale = scales(len(free))[free]
    return np.asarray(stiffness[np.ix_(free, free)] * np.outer(scale, scale))


ARM = 0.02
"""m; lever at which a turn counts like a displacement, and a moment like a force."""

LONGEST = 1e-3
"""m; no step moves further."""

EXACT = 1e-6
"""Share of the load that the forces may be off by."""

FACETED = 1e-3
"""Share of the load that they may be off by where no step lowers the energy any more. Slopes of the smooth surface
over the facets do not quite meet where the closest face changes."""

STEPS = 60
HALVINGS = 25
PROMISED = 1e-4
LEAST = 1e-9
"""Share of the largest curvature: smaller ones are taken for this."""


@runtime_checkable
class Energy(Protocol):
    """Energy at some coordinates [m, rad] with its first and second derivative: slope 0 is equilibrium."""

    @property
    def values(self) -> Float[np.ndarray, " n"]:
        """The coordinates, six of each body."""

    @property
    def potential(self) -> float:
        """Stored energy and the load's [J]."""

    @property
    def slope(self) -> Float[np.ndarray, " n"]:
        """First derivative."""

    @property
    def stiffness(self) -> Float[np.ndarray, "n n"]:
        """Second derivative."""


E = TypeVar("E", bound=Energy)


@dataclass(frozen=True, eq=False)
class Rest(Generic[E]):
    """Where the search ended.

    Parameters
    ----------
    total
        Energy and derivatives there.
    residual
        Largest residual force along a free coordinate, moments over 20 mm [N].
    steps
        Newton steps.
    converged
        Whether that is equilibrium.
    """

    total: E
    residual: float
    steps: int
    converged: bool


def scales(count: int = 6) -> Float[np.ndarray, " n"]:
    """Coordinates per metre of the scaled ones, three displacements and three turns of each body."""
    return np.tile([1.0, 1.0, 1.0, 1.0 / ARM, 1.0 / ARM, 1.0 / ARM], count // 6)


def equilibrium(bed: Bed, pull: AxialLoad, start: Float[np.ndarray, " 6"], free: Bool[np.ndarray, " 6"]) -> Rest[Total]:
    """Coordinates at which nothing moves on along the free ones, from `start`; the others stay."""
    return least_energy(lambda values: total_at(bed, pull, values), start, free, pull.load)


def least_energy(
    energy: Callable[[Float[np.ndarray, " n"]], E],
    start: Float[np.ndarray, " n"],
    free: Bool[np.ndarray, " n"],
    load: float,
) -> Rest[E]:
    """The same of any energy; `load` [N] is what residual forces are a share of."""
    now = energy(start)
    for step in range(STEPS):
        left = _left(now, free)
        if left <= EXACT * load:
            return Rest(now, left, step, True)
        following = _lower(energy, now, free)
        if following is None:
            return Rest(now, left, step, left <= FACETED * load)
        now = following
    left = _left(now, free)
    return Rest(now, left, STEPS, left <= FACETED * load)


def _left(now: Energy, free: Bool[np.ndarray, " n"]) -> float:
    return float(np.abs((now.slope * scales(len(free)))[free]).max())


def _lower(energy: Callable[[Float[np.ndarray, " n"]], E], now: E, free: Bool[np.ndarray, " n"]) -> E | None:
    """The next point of the search; None where no step lowers the energy."""
    direction, promised = downhill(now, free)
    share = min(1.0, LONGEST / max(float(np.abs(direction / scales(len(free))).max()), 1e-300))
    for _ in range(HALVINGS):
        tried = energy(now.values + share * direction)
        if tried.potential <= now.potential + PROMISED * share * promised:
            return tried
        share *= 0.5
    return None


def downhill(now: Energy, free: Bool[np.ndarray, " n"]) -> tuple[Float[np.ndarray, " n"], float]:
    """Newton step [m, rad] and the change of energy per share of it [J]."""
    scale = scales(len(free))[free]
    slope = now.slope[free] * scale
    curvature, directions = np.linalg.eigh(now.stiffness[np.ix_(free, free)] * np.outer(scale, scale))
    size = np.maximum(np.abs(curvature), LEAST * max(float(np.abs(curvature).max()), 1.0))
    step = -directions @ ((directions.T @ slope) / size)
    full = np.zeros(len(free))
    full[free] = step * scale
    return full, float(slope @ step)


NODES = 8


@dataclass(frozen=True)
class EnergyBalance:
    """Work of the load while it grows slowly from 0, and the energy stored at its end [J].

    `alone`: on the axial way alone, everything else held where it came to rest under the full load; springs that this
    strains are then in neither.
    """

    work: float
    stored: float
    alone: bool = False

    @property
    def difference(self) -> float:
        """Difference of the work, in shares of it."""
        return abs(self.work - self.stored) / self.work


def energy_balance(bed: Bed, pull: AxialLoad, rest: Rest[Total], free: Bool[np.ndarray, " 6"]) -> EnergyBalance | None:
    """Balance along the equilibria under smaller loads, or else along the axial way alone; None without either.

    The way of the load is y, downwards. By parts its work is F y less the integral of y over the load, taken with
    F = s^3 times the full load at Gauss-Legendre points of s: y goes with about F^(2/3) at first, which is smooth in s.

    With every coordinate free a component slides to where it conforms, and may leave that place under a smaller load:
    there are then no equilibria to follow. What is held does no work, so the same balance holds on the axial way.
    """
    values = rest.total.values
    work = _work(bed, pull, values, free)
    if work is not None:
        return EnergyBalance(work, rest.total.stored)
    only = np.zeros(6, bool)
    only[AXIAL] = True
    work = _work(bed, replace(pull, springs=np.zeros(6)), values, only)
    return None if work is None else EnergyBalance(work, rest.total.foundation.energy, alone=True)


def _work(bed: Bed, pull: AxialLoad, values: Float[np.ndarray, " 6"], free: Bool[np.ndarray, " 6"]) -> float | None:
    """Work of the load up to these coordinates [J]; None where a smaller load has no equilibrium."""
    points, weights = np.polynomial.legendre.leggauss(NODES)
    share, weight = 0.5 * (points + 1.0), 0.5 * weights
    at, ways = values, np.empty(NODES)
    for k in np.argsort(-share):
        lighter = equilibrium(bed, replace(pull, load=pull.load * float(share[k]) ** 3), at, free)
        if not lighter.converged:
            return None
        at = lighter.total.values
        ways[k] = _way(at)
    mean = float(np.sum(weight * 3.0 * share**2 * ways))
    return pull.load * (_way(values) - mean)


def _way(values: Float[np.ndarray, " 6"]) -> float:
    return -float(values[AXIAL])


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame: what was asked for, and where it came to rest; None where the bodies miss each other."""

    pull: AxialLoad
    rest: Rest[Total] | None

    @property
    def converged(self) -> bool:
        """Whether the equilibrium was found."""
        return self.rest is not None and self.rest.converged


def settle_along(
    bed: Bed,
    fixed: Surface,
    wanted: Float[np.ndarray, "t 6"],
    load: Float[np.ndarray, " t"],
    springs: Float[np.ndarray, " 6"],
    free: Bool[np.ndarray, " 6"],
    each: Callable[[Frame], None],
) -> list[Frame]:
    """Equilibrium of each frame.

    Parameters
    ----------
    wanted
        Coordinates of the motion [m, rad]: held ones stay there, springs are at rest there, the search begins there.
    load
        Axial load of each frame [N], > 0.
    springs
        Stiffness of each coordinate [N/m, N m/rad].
    each
        Called with every frame as soon as it is found; what it raises ends the work.
    """
    frames: list[Frame] = []
    off = np.zeros(6)
    for k, values in enumerate(wanted):
        pull = AxialLoad(float(load[k]), springs, values)
        rest = _settled(bed, fixed, pull, values + off, free) if off.any() else None
        if rest is None or not rest.converged:
            at = pressing(bed, values, fixed)
            rest = rest if at is None else _settled(bed, fixed, pull, at, free)
        frames.append(Frame(pull, rest))
        each(frames[-1])
        if rest is not None and rest.converged:
            off = np.where(free, rest.total.values - values, 0.0)
    return frames


def _settled(
    bed: Bed, fixed: Surface, pull: AxialLoad, start: Float[np.ndarray, " 6"], free: Bool[np.ndarray, " 6"]
) -> Rest[Total] | None:
    """Down onto the layer, then to rest under the load with nothing but the axial way free, then to rest."""
    touches = bed.state(placed_at(start, bed.point)).energy > 0.0
    at = start if touches else pressing(bed, start, fixed)
    if at is None:
        return None
    lowered = equilibrium(bed, replace(pull, springs=np.zeros(6)), at, free & _only_axial())
    return equilibrium(bed, pull, lowered.total.values, free)


def _only_axial() -> Bool[np.ndarray, " 6"]:
    only = np.zeros(6, bool)
    only[AXIAL] = True
    return only
