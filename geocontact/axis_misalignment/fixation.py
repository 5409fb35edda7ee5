"""Upper arm's fixation that yields: the exoskeleton's axis moves by what is on it, in series with the forearm's cuff.

The explicit model takes that fixation as rigid and says that it is not. Here it has a compliance c [m/N], alike in
every direction of the plane, and does not turn. The link bears the cuff's force F along the limb and a force Q across
it, so its axis moves by δ = c (F u - Q t), u along and t across the limb. Along the limb this shares the misalignment
as springs in series do; across, it turns the limb by less than the link and changes z tan γ as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, sin

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.deflection import closure, misalignment
from geocontact.axis_misalignment.explicit import Offsets
from geocontact.geometry.kernels.compile import kernel

ROUNDS = 200
"""Most rounds of the search for where the axis comes to rest."""
SETTLED = 1e-14
"""Of the link: the axis is at rest when a round moves it by less."""


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
