"""Geometries with one deflection and one spring, and loads of deflections that no load changes.

With it an own model is a formula; the interface law stands behind it, and every effect of that law with it.

Without a spring in series a deflection is known before its load. Its derivatives are taken along with the law, all at
once (`chain.interface_slopes`); those of the deflection itself, a formula without memory, are read a second time so
little further on that differences show them to five digits or more.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.interface_law import INTERFACE_LAW, MEMORY, interface_force
from geocontact.chain.interface_slopes import UNKNOWN, interface_slopes
from geocontact.chain.links import Geometry, Law, LawParameters, Loads, Source, Values
from geocontact.chain.system import (
    ATTEMPTS,
    TOLERANCE,
    next_load,
    nothing_known,
    require_convergence,
    start_over,
)
from geocontact.geometry.kernels.compile import kernel

SLOTS = len(INTERFACE_LAW.neutral)
GIVES_WAY = "series_compliance.compliance"
"""How the number of a geometry is called, or of a place in it, that makes deflections depend on loads."""


@kernel
def along(
    time: Float[np.ndarray, " t"],
    u: Float[np.ndarray, " t"],
    rate: Float[np.ndarray, " t"],
    law: Float[np.ndarray, " numbers"],
) -> Float[np.ndarray, " t"]:
    """Load of every sample of a deflection that is known beforehand."""
    load = np.empty(u.size)
    old, new = np.zeros(MEMORY), np.zeros(MEMORY)
    for i in range(u.size):
        load[i] = interface_force(u[i], rate[i], time[i] - time[i - 1] if i else 0.0, law, old, new)
        old, new = new, old
    return load


@kernel
def along_slopes(
    time: Float[np.ndarray, " t"],
    u: Float[np.ndarray, " t"],
    rate: Float[np.ndarray, " t"],
    law: Float[np.ndarray, " numbers"],
    du: Float[np.ndarray, "t q"],
    drate: Float[np.ndarray, "t q"],
    dlaw: Float[np.ndarray, "q numbers"],
) -> Float[np.ndarray, "t one_q"]:
    """Load of every sample and, beside it, how it changes along each direction."""
    count = len(dlaw)
    found = np.empty((u.size, 1 + count))
    old, new = np.zeros(MEMORY), np.zeros(MEMORY)
    dold, dnew = np.zeros((count, MEMORY)), np.zeros((count, MEMORY))
    used = np.zeros(law.size, np.bool_)
    for k in range(count):
        used |= dlaw[k] != 0.0
    for i in range(u.size):
        h = time[i] - time[i - 1] if i else 0.0
        found[i, 0] = interface_force(u[i], rate[i], h, law, old, new)
        interface_slopes(u[i], rate[i], h, law, old, used, du[i], drate[i], dlaw, dold, dnew, found[i, 1:])
        old, new = new, old
        dold, dnew = dnew, dold
    return found


@kernel
def all_slopes(
    time: Float[np.ndarray, " t"],
    u: Float[np.ndarray, "t c"],
    rate: Float[np.ndarray, "t c"],
    laws: Float[np.ndarray, "c numbers"],
    du: Float[np.ndarray, "q t c"],
    drate: Float[np.ndarray, "q t c"],
    dlaws: Float[np.ndarray, "q c numbers"],
    known: Bool[np.ndarray, " q"],
) -> tuple[Float[np.ndarray, "t c"], Float[np.ndarray, "q t c"]]:
    """Loads of all deflections, each with a law of its own, and how they change along the directions that are known."""
    samples, count = u.shape
    loads, slopes = np.empty((samples, count)), np.zeros((len(known), samples, count))
    for c in range(count):
        moving = known.copy()
        for k in np.flatnonzero(known):
            moving[k] = np.any(dlaws[k, c] != 0.0) or np.any(du[k, :, c] != 0.0)
        ways = np.flatnonzero(moving)
        own, own_rate = np.empty(samples), np.empty(samples)
        own[:], own_rate[:] = u[:, c], rate[:, c]
        further, faster = np.empty((samples, len(ways))), np.empty((samples, len(ways)))
        dlaw = np.empty((len(ways), laws.shape[1]))
        for j, k in enumerate(ways):
            further[:, j], faster[:, j], dlaw[j] = du[k, :, c], drate[k, :, c], dlaws[k, c]
        found = along_slopes(time, own, own_rate, laws[c], further, faster, dlaw)
        loads[:, c] = found[:, 0]
        for j, k in enumerate(ways):
            slopes[k, :, c] = found[:, 1 + j]
    return loads, slopes


def known_changes(
    geometry: Geometry,
    movement: DifferentiatedInputs,
    law: Law,
    values: Values,
    others: Sequence[Values],
    *,
    by_slots: bool,
) -> tuple[Loads, list[Loads | None]] | None:
    """Loads along a movement, and how they change towards other values (`chain.system`).

    None for others that add a spring in series or slip, and in the place of all where there is one. Deflections of
    `geometry` have the interface law, one for all or each its own; `by_slots` where values move them by the numbers of
    the geometry's slots alone, so that those of others with the same numbers are known.
    """
    numbers, own = law.slots.numbers(values).reshape(-1, SLOTS), geometry.slots.numbers(values)
    gives_way = [place for place, name in enumerate(geometry.slots.neutral) if name.endswith(GIVES_WAY)]
    if own[gives_way].any() or numbers[:, UNKNOWN[0]].any():
        return None
    u, rate = geometry.deflection(movement, values)
    samples, count = u.shape
    numbers = np.broadcast_to(numbers, (count, SLOTS))
    ways = law.slots.towards(values, others).reshape(len(others), len(law.slots.neutral) // SLOTS, SLOTS)
    dlaw = np.broadcast_to(ways, (len(others), count, SLOTS))
    moved = geometry.slots.towards(values, others)
    yielding = moved[:, gives_way].any(axis=1)
    known = ~np.logical_or(yielding, dlaw[..., UNKNOWN].any(axis=(1, 2)))
    du, drate = np.zeros((2, len(others), samples, count))
    for k in np.flatnonzero(known & moved.any(axis=1) if by_slots else known).tolist():
        further = geometry.deflection(movement, others[k])
        du[k], drate[k] = further[0] - u, further[1] - rate
    u, rate, numbers, dlaw = (np.ascontiguousarray(each) for each in (u, rate, numbers, dlaw))
    loads, slopes = all_slopes(movement.time, u, rate, numbers, du, drate, dlaw, known)
    nothing = np.zeros_like(loads)
    return Loads(loads, nothing, nothing), [
        Loads(one, nothing, nothing) if there else None for one, there in zip(slopes, known, strict=True)
    ]


SERIES = LawParameters(
    {
        "series_compliance.compliance": 0.0,
        "series_compliance.exponent": 1.0,
        "series_compliance.reference": 1.0,
    }
)
KNOTS = 2001
"""Knots of the table of the deflection that a spring in series is solved on."""
STEP = 1e-5
"""Step of differences, over the range of the input."""
LEAST_RANGE = 1e-6
"""Range of an input that hardly moves, in its unit or over its magnitude."""

Deflect = Callable[[Float[np.ndarray, " t"], Values], Float[np.ndarray, " t"]]
"""(input, numbers) → deflection, element by element: numbers are parameters, constants and the trial's covariates."""


@kernel
def read_off(x: float, knots: Float[np.ndarray, "three n"]) -> tuple[float, float]:
    """Value and slope at `x` of the cubic Hermite curve through equally spaced knots; straight beyond them."""
    first, step, last = knots[0, 0], knots[0, 1] - knots[0, 0], knots.shape[1] - 1
    if x <= first:
        return knots[1, 0] + (x - first) * knots[2, 0], knots[2, 0]
    if x >= knots[0, last]:
        return knots[1, last] + (x - knots[0, last]) * knots[2, last], knots[2, last]
    i = min(int((x - first) / step), last - 1)
    s = (x - knots[0, i]) / step
    rise, left, right = knots[1, i + 1] - knots[1, i], step * knots[2, i], step * knots[2, i + 1]
    bend, twist = 3.0 * rise - 2.0 * left - right, left + right - 2.0 * rise
    value = knots[1, i] + s * (left + s * (bend + s * twist))
    return value, (left + s * (2.0 * bend + 3.0 * s * twist)) / step


@kernel
def gives_way(load: float, n: Float[np.ndarray, " three"]) -> float:
    """What the input gives way by to `load`."""
    share = load / n[2]
    return float(n[0] * n[2] * (share if n[1] == 1.0 else np.sign(share) * abs(share) ** n[1]))


@kernel
def in_series(
    time: Float[np.ndarray, " t"],
    x: Float[np.ndarray, " t"],
    rate: Float[np.ndarray, " t"],
    knots: Float[np.ndarray, "three n"],
    n: Float[np.ndarray, " three"],
    law: Float[np.ndarray, " numbers"],
) -> tuple[Float[np.ndarray, " t"], int]:
    """Load of every sample behind a spring in series, and how many of them have no solution.

    x - c F is what deflects: one implicit equation per sample, the spring's rate being its change over the step (first
    order in the step, where the law depends on the rate).
    """
    load = np.empty(x.size)
    old, new = np.zeros(MEMORY), np.zeros(MEMORY)
    search = nothing_known()
    unsolved = 0
    before = 0.0
    for i in range(x.size):
        h = time[i] - time[i - 1] if i else 0.0
        u, slope = read_off(x[i], knots)
        found = interface_force(u, slope * rate[i], h, law, old, new)
        start_over(search)
        guess = 2.0 * load[i - 1] - load[i - 2] if i > 1 else found
        solved = False
        for _ in range(ATTEMPTS):
            given = gives_way(guess, n)
            u, slope = read_off(x[i] - given, knots)
            found = interface_force(u, slope * (rate[i] - (given - before) / h if i else rate[i]), h, law, old, new)
            solved = abs(guess - found) <= TOLERANCE * max(abs(found), n[2])
            if solved:
                break
            guess = next_load(guess, guess - found, search)
        unsolved += not solved
        before = gives_way(found, n)
        load[i] = found
        old, new = new, old
    return load, unsolved


def extent(x: Float[np.ndarray, " t"]) -> float:
    """Range of an input, never so small that differences over it would be rounding."""
    return max(float(np.ptp(x)), LEAST_RANGE * max(1.0, float(np.abs(x).max())))


@dataclass(frozen=True)
class SingleDeflection:
    """Geometry link with one deflection, a function of one input.

    Parameters
    ----------
    yields
        The input, which also gives way to a spring in series.
    deflect
        (input, numbers) → deflection, vectorised and without memory. Its slope is found by differences; with a spring
        in series it is read off a table of `KNOTS` values over three times the range of the trial, straight beyond.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> from geocontact.data.motion import Signals
    >>> from geocontact.data.trial import Trial
    >>> angle = np.array([[0.0], [0.1], [0.2], [0.3]])
    >>> trial = Trial("t1", Signals(0.1 * np.arange(4), angle, ("angle",), ("rad",)))
    >>> movement = gc.chain.Motion(("angle",)).seen(trial, {})
    >>> strut = gc.chain.SingleDeflection("angle", lambda angle, numbers: np.sin(angle - numbers["neutral"]))
    >>> law = gc.chain.Law(gc.chain.INTERFACE_LAW, load="N m", deflection="rad").having({"k": "k"})
    >>> strut.loads(movement, law, {"k": 60.0, "neutral": 0.1}).normal.round(2).ravel().tolist()
    [-5.99, 0.0, 5.99, 11.92]
    """

    yields: str
    deflect: Deflect
    slots: LawParameters = SERIES

    def having(self, sources: Mapping[str, Source]) -> SingleDeflection:
        """The same link with more of its numbers coming from somewhere."""
        return replace(self, slots=self.slots.having(sources))

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """Deflection and rate without load."""
        u, slope = self._deflection_and_slope(movement.position[movement.row(self.yields)], values)
        return u[:, None], (slope * movement.rate[movement.row(self.yields)])[:, None]

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Load along a movement; its law is the interface law."""
        n, numbers = self.slots.numbers(values), law.slots.numbers(values)
        if n[0] == 0.0:
            u, rate = self.deflection(movement, values)
            load = along(movement.time, u[:, 0].copy(), rate[:, 0].copy(), numbers)
        else:
            row = movement.row(self.yields)
            x = movement.position[row]
            load, unsolved = in_series(movement.time, x, movement.rate[row], self._knots(x, values), n, numbers)
            require_convergence(unsolved, len(load), n[0])
        nothing = np.zeros((len(load), 1))
        return Loads(load[:, None], nothing, nothing)

    def changes(
        self, movement: DifferentiatedInputs, law: Law, values: Values, others: Sequence[Values]
    ) -> tuple[Loads, list[Loads | None]] | None:
        """Load along a movement, and how it changes towards other values (`chain.system`)."""
        return known_changes(self, movement, law, values, others, by_slots=False)

    def _deflection_and_slope(
        self, x: Float[np.ndarray, " t"], values: Values
    ) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
        """Deflection and slope at `x`."""
        step = STEP * extent(x)
        slope = (self.deflect(x + step, values) - self.deflect(x - step, values)) / (2.0 * step)
        return np.asarray(self.deflect(x, values), float), np.asarray(slope, float)

    def _knots(self, x: Float[np.ndarray, " t"], values: Values) -> Float[np.ndarray, "three n"]:
        """Input, deflection and slope at equally spaced knots over three times the range of `x`."""
        at = np.linspace(x.min() - extent(x), x.max() + extent(x), KNOTS)
        return np.array([at, *self._deflection_and_slope(at, values)])
