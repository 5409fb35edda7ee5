"""How the motion of an arm on its hinge changes with the numbers of arm and interface: derivatives along its steps.

Forward mode along a motion that is known: each step's equation, e'' = f(e, e', what the step before left), is linear in
small changes, and its steps are the same ones.
"""

from __future__ import annotations

from math import cos, exp, sin, tanh

import numpy as np
from jaxtyping import Bool, Float

from geocontact.chain.interface_law import MEMORY, interface_force
from geocontact.chain.interface_slopes import interface_slopes
from geocontact.geometry.kernels.compile import kernel
from geocontact.systems.shoulder_motion import (
    ACCELERATION,
    ANGLE,
    ARM,
    ARM_RATE,
    CHORD,
    FORCE,
    FRICTION,
    GRAVITY,
    JERK,
    PLACE,
    RATE,
    REMEMBERED,
    SAMPLE,
    SMOOTH,
    STATE,
    STEP,
    WX,
    WX_RATE,
    WY,
    WY_RATE,
    attachment,
    support,
)

FLAT = 1e-9
"""Slope of e'' by the angle [1/s²] below which an arm at rest is anywhere."""


@kernel
def slope_of_support(angle: float, table: Float[np.ndarray, "two k"], place: int) -> float:
    """Derivative of τ(e), between the rows of the table that `place` says."""
    last = table.shape[1] - 1
    if last == 0 or angle <= table[0, 0] or angle >= table[0, last]:
        return 0.0
    return float((table[1, place + 1] - table[1, place]) / (table[0, place + 1] - table[0, place]))


@kernel
def acceleration_slopes(
    h: float,
    arm: float,
    arm_rate: float,
    before: Float[np.ndarray, " ten"],
    after: Float[np.ndarray, " ten"],
    memory: Float[np.ndarray, " memory"],
    n: Float[np.ndarray, " slots"],
    table: Float[np.ndarray, "two k"],
    law: Float[np.ndarray, " numbers"],
    used: Bool[np.ndarray, " numbers"],
    rubs: Bool[np.ndarray, " two"],
    dn: Float[np.ndarray, "q slots"],
    dlaw: Float[np.ndarray, "q numbers"],
    dbefore: Float[np.ndarray, "q ten"],
    dmemory: Float[np.ndarray, "q memory"],
    dafter: Float[np.ndarray, "q ten"],
    dnew: Float[np.ndarray, "q memory"],
    scratch: Float[np.ndarray, "four q"],
) -> None:
    """How e'' and what else a step leaves change along each direction, its angle and rate changing as `dafter` says.

    `after` holds where the step ended, `memory` what the law remembered before it; `rubs` says of friction over a
    stroke and of friction by rate whether there is any.
    """
    du, drate, dalong, dforce = scratch[0], scratch[1], scratch[2], scratch[3]
    w = np.empty(4)
    attachment(arm, arm_rate, n, w)
    angle, rate, force = after[ANGLE], after[RATE], after[FORCE]
    sine, cosine = sin(angle), cos(angle)
    along, off = w[WX] * sine - w[WY] * cosine, w[WX] * cosine + w[WY] * sine
    off_rate = w[WX_RATE] * cosine + w[WY_RATE] * sine - rate * along
    along_rate = w[WY_RATE] * cosine - w[WX_RATE] * sine
    s, c, free = sin(arm), cos(arm), arm - n[10]
    for k in range(len(dn)):
        turned, sped = dafter[k, ANGLE], dafter[k, RATE]
        x = dn[k, 0] * s - dn[k, 1] - free * (dn[k, 8] + free * dn[k, 9]) + (n[8] + 2.0 * n[9] * free) * dn[k, 10]
        y = -dn[k, 0] * c - dn[k, 2]
        x_rate = (dn[k, 0] * c - dn[k, 8] - 2.0 * free * dn[k, 9] + 2.0 * n[9] * dn[k, 10]) * arm_rate
        y_rate = dn[k, 0] * s * arm_rate
        dalong[k] = x * sine - y * cosine + off * turned
        du[k] = along * turned - x * cosine - y * sine
        drate[k] = sped * along + rate * dalong[k] - x_rate * cosine - y_rate * sine - along_rate * turned
    interface_slopes(-off, -off_rate, h, law, memory, used, du, drate, dlaw, dmemory, dnew, dforce)
    step = angle - before[ANGLE]
    friction, left, towards = 0.0, 1.0, 0.0
    if rubs[0] and h > 0.0:
        friction = before[FRICTION]
        if step != 0.0:
            towards = 1.0 if step > 0.0 else -1.0
            left = exp(-abs(step) / n[15])
            friction = towards + (before[FRICTION] - towards) * left
    creep = tanh(rate / n[17]) if rubs[1] else 0.0
    lifted = support(angle, table, after)
    steeper = slope_of_support(angle, table, int(after[PLACE]))
    hangs = n[6] * GRAVITY * n[5] * cosine + n[18] * cos(angle + n[19]) - n[7] * steeper
    for k in range(len(dn)):
        turned, sped = dafter[k, ANGLE], dafter[k, RATE]
        torque = lifted * dn[k, 7] - hangs * turned - GRAVITY * (dn[k, 6] * n[5] + n[6] * dn[k, 5]) * sine
        torque -= dforce[k] * along + force * dalong[k] + dn[k, 4] * rate + n[4] * sped
        torque -= dn[k, 18] * sin(angle + n[19]) + n[18] * cos(angle + n[19]) * dn[k, 19]
        dfriction = 0.0
        if rubs[0] and h > 0.0:
            dfriction = dbefore[k, FRICTION] * left
            if step != 0.0:
                moved = towards * (turned - dbefore[k, ANGLE])
                dfriction += (before[FRICTION] - towards) * left * (abs(step) / n[15] * dn[k, 15] - moved) / n[15]
            torque -= dn[k, 14] * friction + n[14] * dfriction
        if rubs[1]:
            torque -= dn[k, 16] * creep + n[16] * (1.0 - creep * creep) * (sped - rate / n[17] * dn[k, 17]) / n[17]
        dafter[k, FRICTION], dafter[k, FORCE] = dfriction, dforce[k]
        dafter[k, ACCELERATION] = (torque - after[ACCELERATION] * (dn[k, 3] + dn[k, 20])) / (n[3] + n[20])


@kernel
def moved_slopes(
    h: float, smooth: bool, step_before: float, dbefore: Float[np.ndarray, "q ten"], dafter: Float[np.ndarray, "q ten"]
) -> None:
    """Changes of angle, rate and slopes of e'' over a step at whose end e'' stays; in the last direction it grows by 1
    and nothing else does.
    """
    beta, ahead = (1.0 / 12.0, h * h / 12.0) if smooth else (0.25, 0.0)
    bends = h / (h + step_before) if step_before > 0.0 else 0.0
    last = len(dbefore) - 1
    for k in range(last):
        start = dbefore[k, RATE] + ahead * dbefore[k, JERK]
        chord = -dbefore[k, ACCELERATION] / h
        jerk = chord + (chord - dbefore[k, CHORD]) * bends
        dafter[k, CHORD], dafter[k, JERK] = chord, jerk
        dafter[k, ANGLE] = dbefore[k, ANGLE] + h * (start + h * (0.5 - beta) * dbefore[k, ACCELERATION])
        dafter[k, RATE] = start + 0.5 * h * dbefore[k, ACCELERATION] - ahead * jerk
    dafter[last, CHORD], dafter[last, JERK] = 1.0 / h, (1.0 + bends) / h
    dafter[last, ANGLE], dafter[last, RATE] = beta * h * h, 0.5 * h - ahead * (1.0 + bends) / h


@kernel
def solved(dafter: Float[np.ndarray, "q ten"], dnew: Float[np.ndarray, "q memory"]) -> None:
    """Each direction with as much of the last one as the step's equation asks for."""
    last = len(dafter) - 1
    for k in range(last):
        by = dafter[k, ACCELERATION] / (1.0 - dafter[last, ACCELERATION])
        for i in range(dafter.shape[1]):
            dafter[k, i] += by * dafter[last, i]
        dafter[k, ACCELERATION] = by
        for i in range(dnew.shape[1]):
            dnew[k, i] += by * dnew[last, i]


@kernel
def swing_slopes(
    path: Float[np.ndarray, "rows nineteen"],
    samples: int,
    n: Float[np.ndarray, " slots"],
    table: Float[np.ndarray, "two k"],
    law: Float[np.ndarray, " numbers"],
    dn: Float[np.ndarray, "q slots"],
    dlaw: Float[np.ndarray, "q numbers"],
) -> Float[np.ndarray, "two t q"]:
    """Changes of the angle e [rad] and of the force F [N] at every sample along each direction of the numbers.

    `path` is that of `swing` under the numbers themselves. The last direction is one of nothing, where the steps'
    equation is solved.
    """
    out = np.zeros((2, samples, len(dn) - 1))
    used, rubs = np.zeros(law.size, np.bool_), np.array([n[14] != 0.0, n[16] != 0.0])
    for k in range(len(dn)):
        used |= dlaw[k] != 0.0
        rubs[0] |= dn[k, 14] != 0.0
        rubs[1] |= dn[k, 16] != 0.0
    dbefore, dafter = np.zeros((len(dn), 10)), np.zeros((len(dn), 10))
    dold, dnew, scratch = np.zeros((len(dn), MEMORY)), np.zeros((len(dn), MEMORY)), np.empty((4, len(dn)))
    nothing, still = np.zeros(MEMORY), path[0, STATE:REMEMBERED].copy()
    arm, last = path[0, ARM], len(dn) - 1
    w = np.empty(4)
    attachment(arm, 0.0, n, w)
    off = w[WX] * cos(still[ANGLE]) + w[WY] * sin(still[ANGLE])
    still[FORCE] = interface_force(-off, 0.0, 0.0, law, nothing, np.empty(MEMORY))
    still[ACCELERATION], dafter[last, ANGLE] = 0.0, 1.0
    acceleration_slopes(
        0.0, arm, 0.0, still, still, nothing, n, table, law, used, rubs, dn, dlaw, dbefore, dold, dafter, dnew, scratch
    )
    for k in range(last):
        by = -dafter[k, ACCELERATION] / dafter[last, ACCELERATION] if abs(dafter[last, ACCELERATION]) > FLAT else 0.0
        dafter[k, ANGLE] = by
    dafter[last] = 0.0
    for row in range(len(path)):
        after, h = path[row, STATE:REMEMBERED], path[row, STATE + STEP]
        before, memory = path[max(row - 1, 0), STATE:REMEMBERED], path[max(row - 1, 0), REMEMBERED:]
        if row:
            moved_slopes(h, path[row, SMOOTH] > 0.0, before[STEP], dbefore, dafter)
        else:
            memory = nothing
        acceleration_slopes(
            h,
            path[row, ARM],
            path[row, ARM_RATE],
            before,
            after,
            memory,
            n,
            table,
            law,
            used,
            rubs,
            dn,
            dlaw,
            dbefore,
            dold,
            dafter,
            dnew,
            scratch,
        )
        if row:
            solved(dafter, dnew)
        sample = int(path[row, SAMPLE])
        if sample >= 0:
            for k in range(last):
                out[0, sample, k], out[1, sample, k] = dafter[k, ANGLE], dafter[k, FORCE]
        dbefore, dafter, dold, dnew = dafter, dbefore, dnew, dold
        dold[last] = dbefore[last] = 0.0
    return out
