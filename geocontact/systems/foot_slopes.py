"""How the forces of spheres on the ground change with their numbers and those of the law, along a motion."""

from __future__ import annotations

import math

import numpy as np
from jaxtyping import Bool, Float

from geocontact.chain.contact_law import CONTACT_LAW
from geocontact.chain.interface_slopes import branch_slope, relaxed
from geocontact.chain.terms import direction_factor
from geocontact.geometry.kernels.compile import kernel, part

UNKNOWN = [place for place, name in enumerate(CONTACT_LAW.neutral) if name in ("mu_s", "mu_k", "v_th")]
"""Places of the numbers whose derivatives are not written out: of friction."""
MEMORY = 2
BRANCH, ELASTIC = range(MEMORY)
K, B = 3, 4
"""Rows of a sphere's numbers (`foot.spheres`)."""
SHALLOWEST = 1e-12
"""Depth that shallower ones count as in a power (`contact.sphere_foot`) [m]."""


@part
def thinning(depth: float, rate: float, cubic: float, n: Float[np.ndarray, " slots"]) -> tuple[float, float, float]:
    """Share of a damper that depth and rate leave, and the logarithms of both over their references."""
    log_deep, log_rate = math.log(depth / n[12]), 0.0
    thinned = cubic * math.pow(depth / n[12], n[11])
    if rate != 0.0:
        log_rate = math.log(abs(rate) / n[16])
        thinned *= math.pow(abs(rate) / n[16], n[15] - 1.0)
    return thinned, log_deep, log_rate


@kernel
def sphere_slopes(
    depth: float,
    rate: float,
    h: float,
    k: float,
    b: float,
    n: Float[np.ndarray, " slots"],
    old: Float[np.ndarray, " two"],
    used: Bool[np.ndarray, " slots"],
    dk: Float[np.ndarray, " q"],
    db: Float[np.ndarray, " q"],
    dn: Float[np.ndarray, "q slots"],
    dold: Float[np.ndarray, "q two"],
    new: Float[np.ndarray, " two"],
    dnew: Float[np.ndarray, "q two"],
    dforce: Float[np.ndarray, " q"],
) -> float:
    """Force of a sphere, and how it and what is remembered change along each direction, as in `contact_force`."""
    inside = depth > 0.0
    branched = n[13] != 0.0 or used[13]
    new[BRANCH] = new[ELASTIC] = 0.0
    if not inside and not branched:
        dnew[:] = 0.0
        dforce[:] = 0.0
        return 0.0
    bent, directed, damped = n[5] != 0.0 or used[5], n[8] != 0.0 or used[8], n[10] != 0.0 or used[10]
    pressed = onset = stepped = log_depth = power = log_share = turn = 0.0
    if inside:
        deep = max(depth, SHALLOWEST)
        pressed, log_depth = math.pow(deep, n[0]), math.log(deep)
        onset = min(depth / n[1], 1.0)
        stepped = -6.0 * onset * (1.0 - onset) * depth / n[1] ** 2  # of the onset's cubic, by the depth of full damping
        if bent:
            power, log_share = math.pow(depth / n[7], n[6]), math.log(depth / n[7])
        if directed:
            turn = (direction_factor(rate, 1.0, n[9]) - 1.0) if n[9] != 0.0 else 0.0
    stiffer, factor, cubic = 1.0 + n[5] * power, 1.0 + n[8] * turn, onset * onset * (3.0 - 2.0 * onset)
    elastic, loading = k * stiffer * factor * pressed, max(rate, 0.0)
    force = elastic + b * loading * cubic
    parts = relaxed(h, n[14]) if branched else (1.0, 0.0, 0.0)
    if branched:
        branch = old[BRANCH] * parts[0] - n[13] * (elastic - old[ELASTIC]) * parts[2] * parts[1]
        new[BRANCH], new[ELASTIC] = branch, elastic
        force += branch
    drag = thinned = log_deep = log_rate = 0.0
    if inside and damped:
        thinned, log_deep, log_rate = thinning(depth, rate, cubic, n)
        drag = n[10] * rate * thinned
        force += drag
    pushes = inside and force > 0.0
    for i in range(dk.size):
        delastic = 0.0
        if inside:
            delastic = stiffer * factor * pressed * (dk[i] + k * log_depth * dn[i, 0])
            if bent:
                by = dn[i, 5] + n[5] * (log_share * dn[i, 6] - n[6] / n[7] * dn[i, 7])
                delastic += k * factor * pressed * power * by
            if directed:
                by = turn * dn[i, 8] - n[8] * (1.0 - turn * turn) * rate / n[9] ** 2 * dn[i, 9]
                delastic += k * stiffer * pressed * by
        dbranch = 0.0
        if branched:
            rise, drise = elastic - old[ELASTIC], delastic - dold[i, ELASTIC]
            dbranch = branch_slope(
                h, n[14], n[13], old[BRANCH], rise, parts, dold[i, BRANCH], drise, dn[i, 13], dn[i, 14]
            )
        dnew[i, BRANCH], dnew[i, ELASTIC] = dbranch, delastic if branched else 0.0
        dforce[i] = 0.0
        if pushes:
            dforce[i] = delastic + dbranch + loading * (cubic * db[i] + b * stepped * dn[i, 1])
            if damped:
                of_depth = log_deep * dn[i, 11] - n[11] / n[12] * dn[i, 12]
                of_rate = log_rate * dn[i, 15] - (n[15] - 1.0) / n[16] * dn[i, 16]
                dforce[i] += rate * thinned * dn[i, 10] + drag * (of_depth + of_rate)
                dforce[i] += drag * stepped / cubic * dn[i, 1]
    return force if pushes else 0.0


@kernel
def stand_slopes(
    time: Float[np.ndarray, " t"],
    depth: Float[np.ndarray, "t n"],
    closing: Float[np.ndarray, "t n"],
    spheres: Float[np.ndarray, "five n"],
    law: Float[np.ndarray, " numbers"],
    dspheres: Float[np.ndarray, "q five n"],
    dlaw: Float[np.ndarray, "q numbers"],
) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "q t n"]]:
    """Normal forces of every sample [N] and how they change along each direction.

    A sphere is followed along those directions only that change its numbers or the law's.
    """
    count = len(dlaw)
    normal, out = np.empty(depth.shape), np.zeros((count, *depth.shape))
    used = np.zeros(law.size, np.bool_)
    for k in range(count):
        used |= dlaw[k] != 0.0
    for j in range(depth.shape[1]):
        acts = np.zeros(count, np.bool_)
        for k in range(count):
            acts[k] = dspheres[k, K, j] != 0.0 or dspheres[k, B, j] != 0.0 or (dlaw[k] != 0.0).any()
        which = np.flatnonzero(acts)
        old, new = np.zeros(MEMORY), np.zeros(MEMORY)
        dold, dnew = np.zeros((which.size, MEMORY)), np.zeros((which.size, MEMORY))
        dk, db, dforce = np.empty(which.size), np.empty(which.size), np.empty(which.size)
        dnumbers = np.empty((which.size, law.size))
        for k in range(which.size):
            dk[k], db[k], dnumbers[k] = dspheres[which[k], K, j], dspheres[which[k], B, j], dlaw[which[k]]
        for i in range(depth.shape[0]):
            normal[i, j] = sphere_slopes(
                depth[i, j],
                closing[i, j],
                time[i] - time[i - 1] if i else 0.0,
                spheres[K, j],
                spheres[B, j],
                law,
                old,
                used,
                dk,
                db,
                dnumbers,
                dold,
                new,
                dnew,
                dforce,
            )
            for k in range(which.size):
                out[which[k], i, j] = dforce[k]
            old, new, dold, dnew = new, old, dnew, dold
    return normal, out
