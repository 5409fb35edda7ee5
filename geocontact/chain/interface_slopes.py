"""Derivatives of the interface law along with it, for any number of directions at once.

A direction says how fast deflection, rate, every number of the law and everything that it remembers change; forward
mode (Griewank & Walther, Evaluating Derivatives, 2008, ch. 3) with the derivatives of each term written out. At a kink
it is the derivative of the side that the law itself takes. Slip is left out.
"""

from __future__ import annotations

import math

import numpy as np
from jaxtyping import Bool, Float

from geocontact.chain.interface_law import BRANCH, DEFLECTION, ELASTIC, FRICTION, INTERFACE_LAW, SLIP
from geocontact.chain.terms import beyond_play
from geocontact.geometry.kernels.compile import kernel, part

UNKNOWN = [place for place, name in enumerate(INTERFACE_LAW.neutral) if name.startswith("slip.")]
"""Places of the numbers whose derivatives are not written out; the mobility comes first."""


@kernel
def stop_slopes(
    u: float, n: Float[np.ndarray, " slots"], place: int, side: float
) -> tuple[float, float, float, float, float]:
    """Force of the stop whose numbers begin at `place`, and its derivatives by deflection, stiffness, power and
    reference.
    """
    beyond = side * (u - n[place + 1])
    if beyond <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    power, reference = n[25], n[26]
    share = beyond / reference
    if power == 1.0:
        return side * n[place] * beyond, n[place], side * beyond, side * n[place] * beyond * math.log(share), 0.0
    pressed = reference * math.pow(share, power)
    slope = power * math.pow(share, power - 1.0)
    return (
        side * n[place] * pressed,
        n[place] * slope,
        side * pressed,
        side * n[place] * pressed * math.log(share),
        side * n[place] * (pressed / reference - slope * share),
    )


@part
def relaxed(h: float, time: float) -> tuple[float, float, float]:
    """exp(-h / time), expm1(-h / time) and time / h of a step of a Maxwell branch; 1, 0 and 0 without a step."""
    if h > 0.0:
        return math.exp(-h / time), math.expm1(-h / time), time / h
    return 1.0, 0.0, 0.0


@part
def branch_slope(
    h: float,
    time: float,
    stiffness: float,
    old: float,
    rise: float,
    parts: tuple[float, float, float],
    dold: float,
    drise: float,
    dstiffness: float,
    dtime: float,
) -> float:
    """Derivative of the force of a Maxwell branch after a step, whose elastic force rises by `rise` in it.

    `parts` are those of `relaxed`.
    """
    fades, eased, over = parts
    slope = dold * fades - (stiffness * drise + rise * dstiffness) * over * eased
    if h > 0.0:
        slope += old * fades * h / time**2 * dtime
        slope -= stiffness * rise * (eased / h + fades / time) * dtime
    return slope


@part
def _elastic(
    taut: float, speed: float, n: Float[np.ndarray, " slots"], bent: bool, directed: bool
) -> tuple[float, float, float, float, float, float, float]:
    """Elastic force and its derivatives by deflection and speed; power and logarithm of the stiffening, turn, side."""
    power = log_share = turn = 0.0
    if bent and taut != 0.0:
        power, log_share = math.pow(abs(taut) / n[7], n[6]), math.log(abs(taut) / n[7])
    side = 1.0 if taut >= 0.0 else -1.0
    if directed:
        turn = math.tanh(side * speed / n[24])
    stiffer, factor = 1.0 + n[5] * power, 1.0 + n[23] * turn
    by_taut = n[0] * factor * (1.0 + n[5] * (1.0 + n[6]) * power)
    by_speed = n[0] * taut * stiffer * n[23] * (1.0 - turn * turn) * side / n[24] if directed else 0.0
    return n[0] * taut * stiffer * factor, by_taut, by_speed, power, log_share, turn, side


@part
def _elastic_slope(
    state: tuple[float, float, float, float, float, float, float],
    taut: float,
    speed: float,
    dtaut: float,
    dspeed: float,
    n: Float[np.ndarray, " slots"],
    dn: Float[np.ndarray, "q slots"],
    k: int,
    bent: bool,
    directed: bool,
) -> float:
    """Derivative of the elastic force along direction `k`, from what `_elastic` found."""
    _, by_taut, by_speed, power, log_share, turn, side = state
    stiffer, factor, flat = 1.0 + n[5] * power, 1.0 + n[23] * turn, 1.0 - turn * turn
    slope = by_taut * dtaut + by_speed * dspeed + taut * stiffer * factor * dn[k, 0]
    if bent:
        slope += n[0] * taut * factor * power * (dn[k, 5] + n[5] * (log_share * dn[k, 6] - n[6] / n[7] * dn[k, 7]))
    if directed:
        of_turn = turn * dn[k, 23] - n[23] * flat * side * speed / n[24] ** 2 * dn[k, 24]
        slope += n[0] * taut * stiffer * of_turn
    return float(slope)


@part
def _beyond_play(
    taut: float, held: bool, du: float, n: Float[np.ndarray, " slots"], dplay: float, dplace: float
) -> float:
    """Derivative of the deflection beyond the play."""
    if taut > 0.0:
        return float(du - (n[4] * dplay + n[3] * dplace))
    if taut < 0.0:
        return float(du + ((1.0 - n[4]) * dplay - n[3] * dplace))
    return 0.0 if held else du


@part
def _damper(speed: float, n: Float[np.ndarray, " slots"], damped: bool) -> tuple[float, float]:
    """Power of the speed that thins a damper, and its logarithm."""
    if not damped:
        return 0.0, 0.0
    return math.pow(abs(speed / n[16]), n[15] - 1.0), math.log(abs(speed / n[16]))


@part
def _friction(
    step: float, reach: float, towards: float, left: float, old: float, moved: float, dold: float, dreach: float
) -> float:
    """Derivative of the share of friction after a step of the deflection."""
    slope = dold * left
    if step != 0.0:
        slope += (old - towards) * left * (abs(step) / reach * dreach - towards * moved) / reach
    return slope


@part
def _opening(force: float, n: Float[np.ndarray, " slots"]) -> tuple[float, float]:
    """Derivatives of what passes an interface that opens, by the force and by how far it is rounded."""
    x = n[30] * force - n[28]
    if n[29] > 0.0:
        return 0.5 * (1.0 + x / math.hypot(x, n[29])), 0.5 * n[29] / math.hypot(x, n[29])
    return 1.0 if x > 0.0 else 0.0, 0.0


@kernel
def interface_slopes(
    u: float,
    rate: float,
    h: float,
    n: Float[np.ndarray, " slots"],
    old: Float[np.ndarray, " memory"],
    used: Bool[np.ndarray, " slots"],
    du: Float[np.ndarray, " q"],
    drate: Float[np.ndarray, " q"],
    dn: Float[np.ndarray, "q slots"],
    dold: Float[np.ndarray, "q memory"],
    dnew: Float[np.ndarray, "q memory"],
    dforce: Float[np.ndarray, " q"],
) -> None:
    """How force and memory change along each direction, where `interface_force` is given the same.

    `used` are the numbers that change along any direction.
    """
    taut = beyond_play(u, n[3], n[4])
    held = n[3] > 0.0 and taut == 0.0
    speed = 0.0 if held else rate
    bent, directed = n[5] != 0.0 or used[5], n[23] != 0.0 or used[23]
    state = _elastic(taut, speed, n, bent, directed)
    elastic = state[0]
    damped = (n[14] != 0.0 or used[14]) and speed != 0.0
    thinned, log_rate = _damper(speed, n, damped)
    force = elastic + n[27] * speed + n[14] * speed * thinned
    above, below = stop_slopes(u, n, 8, 1.0), stop_slopes(u, n, 10, -1.0)
    force += above[0] + below[0]
    strap = min(max(1.0 + n[20] * u, 0.0), 1.0)
    yielding = n[19] if 0.0 < 1.0 + n[20] * u < 1.0 or (n[20] == 0.0 and u < 0.0) else 0.0
    force += n[19] * strap
    branched = n[12] != 0.0 or used[12]
    parts = relaxed(h, n[13]) if branched else (1.0, 0.0, 0.0)
    if branched:
        force += old[BRANCH] * parts[0] - n[12] * (elastic - old[ELASTIC]) * parts[2] * parts[1]
    rubs = (n[17] != 0.0 or used[17]) and h > 0.0
    step, friction, left, towards = u - old[DEFLECTION], 0.0, 1.0, 0.0
    if rubs:
        friction = old[FRICTION]
        if step != 0.0:
            towards, left = math.copysign(1.0, step), math.exp(-abs(step) / n[18])
            friction = towards + (old[FRICTION] - towards) * left
        force += n[17] * friction
    creep = math.tanh(rate / n[22]) if n[21] != 0.0 or used[21] else 0.0
    force += n[21] * creep
    opens = n[28] != -math.inf
    through, rounded = _opening(force, n) if opens else (0.0, 0.0)
    for k in range(du.size):
        dspeed = 0.0 if held else drate[k]
        dtaut = _beyond_play(taut, held, du[k], n, dn[k, 3], dn[k, 4])
        delastic = _elastic_slope(state, taut, speed, dtaut, dspeed, n, dn, k, bent, directed)
        total = delastic + n[27] * dspeed + speed * dn[k, 27]
        if damped:
            total += n[14] * n[15] * thinned * dspeed + speed * thinned * dn[k, 14]
            total += n[14] * speed * thinned * (log_rate * dn[k, 15] - (n[15] - 1.0) / n[16] * dn[k, 16])
        total += above[1] * (du[k] - dn[k, 9]) + above[2] * dn[k, 8] + above[3] * dn[k, 25] + above[4] * dn[k, 26]
        total += below[1] * (du[k] - dn[k, 11]) + below[2] * dn[k, 10] + below[3] * dn[k, 25] + below[4] * dn[k, 26]
        total += strap * dn[k, 19] + yielding * (n[20] * du[k] + u * dn[k, 20])
        dbranch = 0.0
        if branched:
            rise, drise = elastic - old[ELASTIC], delastic - dold[k, ELASTIC]
            dbranch = branch_slope(
                h, n[13], n[12], old[BRANCH], rise, parts, dold[k, BRANCH], drise, dn[k, 12], dn[k, 13]
            )
            total += dbranch
        dfriction = 0.0
        if rubs:
            moved, of_old = du[k] - dold[k, DEFLECTION], dold[k, FRICTION]
            dfriction = _friction(step, n[18], towards, left, old[FRICTION], moved, of_old, dn[k, 18])
            total += n[17] * dfriction + friction * dn[k, 17]
        if n[21] != 0.0 or used[21]:
            total += creep * dn[k, 21] + n[21] * (1.0 - creep * creep) * (drate[k] - rate / n[22] * dn[k, 22]) / n[22]
        if opens:
            total = through * (total - n[30] * dn[k, 28]) + n[30] * rounded * dn[k, 29]
        dforce[k] = total
        dnew[k, DEFLECTION], dnew[k, SLIP], dnew[k, FRICTION] = du[k], 0.0, dfriction
        dnew[k, BRANCH], dnew[k, ELASTIC] = dbranch, delastic
