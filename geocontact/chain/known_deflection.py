"""Loads of deflections that no load changes, and how they change with the numbers of law and geometry.

Without a spring in series a deflection is known before its load. Its derivatives are taken along with the law, all at
once (`chain.interface_slopes`); those of the deflection itself, a formula without memory, are read a second time so
little further on that differences show them to five digits or more.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.interface_law import INTERFACE_LAW, MEMORY, interface_force
from geocontact.chain.interface_slopes import UNKNOWN, interface_slopes
from geocontact.chain.links import Geometry, Law, Loads, Values
from geocontact.chain.tangents import towards
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


def known_changes(
    geometry: Geometry,
    movement: DifferentiatedInputs,
    law: Law,
    values: Values,
    others: Sequence[Values],
) -> tuple[Loads, list[Loads | None]] | None:
    """Loads along a movement, and how they change towards other values (`chain.tangents`).

    None for others that add a spring in series or slip, and in the place of all where there is one. Deflections of
    `geometry` have the interface law, one for all or each its own.
    """
    numbers, own = law.slots.numbers(values).reshape(-1, SLOTS), geometry.slots.numbers(values)
    gives_way = [place for place, name in enumerate(geometry.slots.neutral) if name.endswith(GIVES_WAY)]
    if own[gives_way].any() or numbers[:, UNKNOWN[0]].any():
        return None
    u, rate = geometry.deflection(movement, values)
    samples, count = u.shape
    numbers = np.broadcast_to(numbers, (count, SLOTS))
    ways = towards(law.slots, values, others).reshape(len(others), len(law.slots.neutral) // SLOTS, SLOTS)
    dlaw = np.broadcast_to(ways, (len(others), count, SLOTS))
    yielding = towards(geometry.slots, values, others)[:, gives_way].any(axis=1)
    known = ~np.logical_or(yielding, dlaw[..., UNKNOWN].any(axis=(1, 2)))
    du, drate = np.zeros((2, len(others), samples, count))
    for k, other in enumerate(others):
        if known[k]:
            further = geometry.deflection(movement, other)
            du[k], drate[k] = further[0] - u, further[1] - rate
    loads, slopes = np.empty_like(u), np.zeros((len(others), samples, count))
    for c in range(count):
        moving = known & (du[..., c].any(axis=1) | dlaw[:, c].any(axis=1))
        found = along_slopes(
            movement.time,
            np.ascontiguousarray(u[:, c]),
            np.ascontiguousarray(rate[:, c]),
            numbers[c].copy(),
            np.ascontiguousarray(du[moving, :, c].T),
            np.ascontiguousarray(drate[moving, :, c].T),
            np.ascontiguousarray(dlaw[moving, c]),
        )
        loads[:, c], slopes[moving, :, c] = found[:, 0], found[:, 1:].T
    nothing = np.zeros_like(loads)
    return Loads(loads, nothing, nothing), [
        Loads(one, nothing, nothing) if there else None for one, there in zip(slopes, known, strict=True)
    ]
