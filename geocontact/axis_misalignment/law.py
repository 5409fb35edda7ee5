"""The force law with everything that may be unknown in it, a fixation that yields, and what else the cuff passes on.

F = k (1 + s (p - p0)) d_tot + b d(d_tot)/dt with the cuff's pressure p as covariate of the stiffness: linear about the
mean pressure p0 of the recordings. With a compliance c of the upper arm's fixation d_tot is that of the axis under
load, no actuator pushing (`fixation`).

The explicit model takes that fixation as rigid and says that it is not. Here it has a compliance c [m/N], alike in
every direction of the plane, and does not turn. The link bears the cuff's force F along the limb and a force Q across
it, so its axis moves by δ = c (F u - Q t), u along and t across the limb. Along the limb this shares the misalignment
as springs in series do; across, it turns the limb by less than the link and changes z tan γ as well.

The explicit model's constraints fix the rest of its statics. The link's end stays on the forearm's line, which takes a
force Q across it and no friction; the force F along the limb acts z away from that line, at a bar across the link that
slides without friction; the cuff has a stiffness κ against turning by γ, 0 by default. In terms of the link's end

    M = κ γ - F z/cos² γ        moment on the forearm, the derivative of the cuff's energy by γ
    Q = (τ - M - F l sin γ)/(l cos γ)        from the moments about the exoskeleton's axis, τ the actuator's torque
    joint's torque = (τ - F l sin γ - M dγ/dβ)/(dα/dβ) = Q |tip| + M,        dα/dβ = l cos γ/|tip| = 1 - dγ/dβ

by virtual work: τ dβ = (joint's torque) dα + F dd + κ γ dγ with dd/dβ = l sin γ - z/cos² γ dγ/dβ. All are positive
towards flexion, moments and forces those on the forearm; F is positive away from the joint on the cuff, as everywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, sin

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.explicit import Offsets, closure, misalignment, require_no_pole_at
from geocontact.geometry.kernels.compile import kernel

ROUNDS = 200
"""Most rounds of the search for where the axis comes to rest."""
SETTLED = 1e-14
"""Share of the link: the axis is at rest when a round moves it by less."""


@kernel
def yielding(
    beta: float,
    rate: float,
    cuff: tuple[float, float, float],
    compliance: float,
    torque: float,
    end: float,
    n: Float[np.ndarray, " slots"],
) -> tuple[float, float, float, bool]:
    """Force of the cuff along the limb [N], the offsets x, y [m] at which the axis comes to rest, and whether it does.

    F = k (d - `end`) + b ḋ with d = L - |tip| - z tan γ at these offsets and L of those without load; the moment about
    the axis and the force across are as in `transmission`. A damper feels the rate of the unloaded link over
    1 + k c g: first order in b c over the time of the movement. Finite for any finite numbers; without compliance the
    explicit model as it is.

    Parameters
    ----------
    cuff
        Stiffness k [N/m], damping b [N s/m], stiffness against turning [N m/rad].
    compliance
        c of the upper arm's fixation [m/N].
    torque
        Of the actuator about the exoskeleton's axis [N m], flexion positive.
    end
        Stroke end at which a compensation joint stands [m]; 0 where it is locked.
    """
    stiffness, damping, turning = cuff
    d, v = misalignment(beta, rate, n)
    if compliance == 0.0:
        return stiffness * (d - end) + damping * v, n[2], n[3], True
    l, z = n[0], n[1]
    x, y = n[2], n[3]
    s, c = sin(beta), cos(beta)
    straight = y + closure(s, c, l, x, y)[2]
    force, rest = 0.0, False
    for _ in range(ROUNDS):
        across, reach, _, top, bottom = closure(s, c, l, x, y)
        along_x, along_y = across / reach, (y + l * c) / reach
        lever = l * bottom / reach
        share = z * (reach / bottom) ** 2
        back = (share - l * top / reach) / lever
        pushed = (torque - turning * atan2(top, bottom)) / lever
        moved_x, moved_y = n[2] - x, y - n[3]
        moved = moved_x * along_x + moved_y * along_y
        turned = (moved_x * along_y - moved_y * along_x) * share / reach
        gain = 1.0 + back * share / reach
        series = 1.0 + stiffness * compliance * gain
        left = straight - reach - z * top / bottom - end + moved - turned - compliance * pushed * share / reach
        force = (stiffness * left + damping * v / series) / series
        push = back * force + pushed
        next_x = n[2] - compliance * (force * along_x - push * along_y)
        next_y = n[3] + compliance * (force * along_y + push * along_x)
        rest = abs(next_x - x) + abs(next_y - y) <= SETTLED * l
        x, y = next_x, next_y
        if rest:
            break
    return force, x, y, rest


@kernel
def yields(
    beta: Float[np.ndarray, " n"],
    rate: Float[np.ndarray, " n"],
    cuff: Float[np.ndarray, "n 3"],
    compliance: float,
    torque: Float[np.ndarray, " n"],
    ends: tuple[float, float],
    n: Float[np.ndarray, " slots"],
) -> tuple[Float[np.ndarray, "n 3"], int]:
    """`yielding` of every sample, and at how many the axis does not come to rest.

    Between the stroke's ends there is no force along the limb.
    """
    out = np.empty((beta.size, 3))
    restless = 0
    for i in range(beta.size):
        one = (cuff[i, 0], cuff[i, 1], cuff[i, 2])
        low = yielding(beta[i], rate[i], one, compliance, torque[i], ends[0], n)
        if ends[0] != ends[1] and low[0] > 0.0:
            high = yielding(beta[i], rate[i], one, compliance, torque[i], ends[1], n)
            free = yielding(beta[i], rate[i], (0.0, 0.0, one[2]), compliance, torque[i], 0.0, n)
            low = high if high[0] > 0.0 else free
        out[i, 0], out[i, 1], out[i, 2] = low[0], low[1], low[2]
        restless += not low[3]
    return out, restless


@dataclass(frozen=True, eq=False)
class Yielded:
    """Force of the cuff along the limb [N], positive away from the joint, and offsets of the axis under load [m]."""

    force: Float[np.ndarray, " n"]
    x: Float[np.ndarray, " n"]
    y: Float[np.ndarray, " n"]

    def deflection(self, beta: Float[np.ndarray, " n"], offsets: Offsets) -> Float[np.ndarray, " n"]:
        """d_tot under load at exoskeleton angles [rad], the cuff strapped on with the offsets without load [m]."""
        s, c = np.sin(beta), np.cos(beta)
        top, bottom = self.x * c + self.y * s, offsets.l + self.y * c - self.x * s
        straight = offsets.y + np.sqrt(offsets.l**2 - offsets.x**2)
        return np.asarray(straight - np.hypot(top, bottom) - offsets.z * top / bottom)


def yielded(
    beta: Float[np.ndarray, " n"],
    rate: Float[np.ndarray, " n"],
    offsets: Offsets,
    stiffness: float | Float[np.ndarray, " n"],
    *,
    damping: float = 0.0,
    turning: float = 0.0,
    compliance: float = 0.0,
    torque: float | Float[np.ndarray, " n"] = 0.0,
    stroke: tuple[float, float] = (0.0, 0.0),
) -> Yielded:
    """Force and offsets under load at exoskeleton angles `beta` [rad] that change by `rate` [rad/s].

    Numbers as of `yielding`; between the ends of `stroke` [m] a compensation joint slides freely. ValueError where
    damping would have to be known at the stroke's ends, and where a load is more than so soft a fixation bears.
    """
    if damping != 0.0 and stroke[0] != stroke[1]:
        raise ValueError("damping b, a stroke and a fixation that yields are not in the model together")
    full = (np.broadcast_to(np.asarray(each, float), beta.shape) for each in (stiffness, damping, turning))
    cuff = np.ascontiguousarray(np.column_stack([*full]))
    given = np.ascontiguousarray(np.broadcast_to(np.asarray(torque, float), beta.shape))
    found, restless = yields(beta, rate, cuff, compliance, given, stroke, offsets.numbers)
    if restless:
        shift = f"at {restless} of {beta.size} angles the exoskeleton's axis does not come to rest"
        raise ValueError(f"{shift} with a fixation of {compliance * 1e3:g} mm/N")
    force, x, y = found.T
    return Yielded(np.ascontiguousarray(force), np.ascontiguousarray(x), np.ascontiguousarray(y))


NAMES = ("k", "x", "y", "l", "z", "b", "s", "c")
UNITS = {"k": "N/m", "x": "m", "y": "m", "l": "m", "z": "m", "b": "N s/m", "s": "1/Pa", "c": "m/N"}
LENGTHS = ("x", "y", "l", "z")
GROWING = (*LENGTHS, "c")
"""Numbers that grow with the scale."""
SCALED = ("k", "b", *GROWING)
"""Numbers that one factor changes without changing any force: k/s, b/s and s times the lengths and the compliance."""
ABSENT = {"b": 0.0, "s": 0.0, "c": 0.0}
STEP = 1e-6  # of the link, for derivatives with respect to lengths; of 1/k, for that to the compliance; of k, b, s


@kernel
def _force(
    beta: float, rate: float, pressure: float, theta: Float[np.ndarray, " 8"], n: Float[np.ndarray, " slots"]
) -> float:
    """Force of one sample; `n` is written to."""
    n[0], n[1], n[2], n[3] = theta[3], theta[4], theta[1], theta[2]
    cuff = (theta[0] * (1.0 + theta[6] * pressure), theta[5], 0.0)
    return float(yielding(beta, rate, cuff, theta[7], 0.0, 0.0, n)[0])


@kernel
def _forces(
    beta: Float[np.ndarray, " n"],
    rate: Float[np.ndarray, " n"],
    pressure: Float[np.ndarray, " n"],
    theta: Float[np.ndarray, " 8"],
    n: Float[np.ndarray, " slots"],
) -> Float[np.ndarray, " n"]:
    out = np.empty(beta.size)
    for i in range(beta.size):
        out[i] = _force(beta[i], rate[i], pressure[i], theta, n)
    return out


@kernel
def _by_difference(
    beta: float, rate: float, pressure: float, theta: Float[np.ndarray, " 8"], n: Float[np.ndarray, " slots"], k: int
) -> float:
    """Central difference of the force over one number; `theta` is left as it was."""
    kept = theta[k]
    h = STEP * (theta[3] if 0 < k < 5 else 1.0 / theta[0] if k == 7 else max(abs(kept), STEP))
    theta[k] = kept + h
    above = _force(beta, rate, pressure, theta, n)
    theta[k] = kept - h
    below = _force(beta, rate, pressure, theta, n)
    theta[k] = kept
    return float((above - below) / (2.0 * h))


@kernel
def _slopes(
    beta: Float[np.ndarray, " n"],
    rate: Float[np.ndarray, " n"],
    pressure: Float[np.ndarray, " n"],
    theta: Float[np.ndarray, " 8"],
    n: Float[np.ndarray, " slots"],
    fixation: bool,
) -> Float[np.ndarray, "n 8"]:
    """To k, b and s as the law is linear in them where the fixation is rigid; else by differences."""
    out = np.zeros((beta.size, 8))
    for i in range(beta.size):
        for k in range(1, 5):
            out[i, k] = _by_difference(beta[i], rate[i], pressure[i], theta, n, k)
        if fixation:
            out[i, 7] = _by_difference(beta[i], rate[i], pressure[i], theta, n, 7)
        if theta[7] == 0.0:
            n[0], n[1], n[2], n[3] = theta[3], theta[4], theta[1], theta[2]
            d, v = misalignment(beta[i], rate[i], n)
            out[i, 0], out[i, 5] = (1.0 + theta[6] * pressure[i]) * d, v
            out[i, 6] = theta[0] * pressure[i] * d
        else:
            for k in (0, 5, 6):
                out[i, k] = _by_difference(beta[i], rate[i], pressure[i], theta, n, k)
    return out


@dataclass(frozen=True, eq=False)
class ElbowLaw:
    """The law at some angles [rad], rates [rad/s] and pressures less their mean [Pa].

    `theta` holds the numbers of NAMES in that order.
    """

    beta: Float[np.ndarray, " n"]
    rate: Float[np.ndarray, " n"]
    pressure: Float[np.ndarray, " n"]

    def force(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " n"]:
        """Force [N]; finite for any finite numbers, as the base model of the gap."""
        return np.asarray(_forces(self.beta, self.rate, self.pressure, theta, offsets_of(theta).numbers))

    def slopes(self, theta: Float[np.ndarray, " 8"], *, fixation: bool = True) -> Float[np.ndarray, "n 8"]:
        """Derivative of the force with respect to each number; 0 for c without `fixation`, to save time."""
        numbers = offsets_of(theta).numbers
        return np.asarray(_slopes(self.beta, self.rate, self.pressure, theta.copy(), numbers, fixation))

    def offsets_under_load(
        self, theta: Float[np.ndarray, " 8"]
    ) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
        """Offsets x, y [m] at which the exoskeleton's axis comes to rest; finite for any finite numbers."""
        if theta[7] == 0.0:
            return np.full(len(self.beta), theta[1]), np.full(len(self.beta), theta[2])
        stiffness = theta[0] * (1.0 + theta[6] * self.pressure)
        cuff = np.column_stack([stiffness, np.full(len(self.beta), theta[5]), np.zeros(len(self.beta))])
        none = np.zeros(len(self.beta))
        found = yields(self.beta, self.rate, cuff, theta[7], none, (0.0, 0.0), offsets_of(theta).numbers)[0]
        return found[:, 1].copy(), found[:, 2].copy()


def offsets_of(theta: Float[np.ndarray, " 8"]) -> Offsets:
    """Lengths among the numbers."""
    return Offsets(l=float(theta[3]), z=float(theta[4]), x=float(theta[1]), y=float(theta[2]))


@dataclass(frozen=True, eq=False)
class CuffLoads:
    """On the forearm at the link's end, and at the joint; flexion positive.

    Parameters
    ----------
    gamma
        Angle of the link less that of the forearm [rad].
    moment
        On the forearm about the link's end [N m].
    across
        Force on the forearm across it [N], towards flexion.
    joint_torque
        What the forearm passes to the joint [N m]; muscles and gravity hold it, they are not in the model.
    constraint_torque
        What the constraint forces hold of the actuator's torque about the exoskeleton's axis [N m].
    ratio
        dα/dβ [-]: of the rest, the joint has 1/ratio.
    """

    gamma: Float[np.ndarray, " n"]
    moment: Float[np.ndarray, " n"]
    across: Float[np.ndarray, " n"]
    joint_torque: Float[np.ndarray, " n"]
    constraint_torque: Float[np.ndarray, " n"]
    ratio: Float[np.ndarray, " n"]


def cuff_loads(
    beta: Float[np.ndarray, " n"],
    link: tuple[float, float],
    under_load: Yielded,
    *,
    turning: float = 0.0,
    torque: float | Float[np.ndarray, " n"] = 0.0,
) -> CuffLoads:
    """Loads at exoskeleton angles `beta` [rad] with the force and the offsets that it has there.

    ValueError at a pole of tan γ.

    Parameters
    ----------
    link
        l and z [m].
    turning
        Stiffness κ of the cuff against turning [N m/rad].
    torque
        Of the actuator about the exoskeleton's axis [N m].
    """
    l, z = link
    force, x, y = under_load.force, under_load.x, under_load.y
    s, c = np.sin(beta), np.cos(beta)
    top, bottom = x * c + y * s, l + y * c - x * s
    require_no_pole_at(beta, bottom, l)
    reach, gamma = np.hypot(top, bottom), np.arctan2(top, bottom)
    ratio = l * bottom / reach**2
    moment = turning * gamma - force * z * (reach / bottom) ** 2
    held = force * l * top / reach + moment * (1.0 - ratio)
    joint = (torque - held) / ratio
    return CuffLoads(gamma, moment, (joint - moment) / reach, joint, held, ratio)
