"""A joint of one degree of freedom beside the hinge of an exoskeleton: how far its attachment is deflected.

The elbow's model for any such joint (hip, knee, elbow), with offsets (x, y) that may drift with the angle. The hinge
is at the origin of the plane, the limb's own point o at (x, -y) in front of it and along the straight limb, the tip of
the link at l (sin β, cos β). The limb lies along the line from o to the tip, and

    d = L - |tip - o| - z tan γ,    tan γ = (x cos β + y sin β)/(l + y cos β - x sin β)

with L = y + sqrt(l² - x²) where the limb is straight (α = β - γ = 0, l sin β = x): the cuff is strapped to one place
of the limb. With offsets that stay this is the elbow's d_tot. (The effect `axis_migration` of a gap case puts the
offset of each instant into the elbow's formula, into L too.)
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, atan2, sqrt

import numpy as np
from jaxtyping import Float, Int

from geocontact.axis_misalignment.axis_drift import STILL, AxisDrift, drift_at
from geocontact.axis_misalignment.explicit import POLE_SHARE, attachment
from geocontact.geometry.kernels.compile import kernel

SOUND, POLE, FOLD, LOST = 0, 1, 2, 3
"""What became of a joint: it has a deflection at every angle; γ reaches 90° at some; |x| > l, the limb is straight at
no angle; the drift is so fast that no angle of the joint, or more than one, belongs to one of the exoskeleton's."""

STEP = np.radians(2.0)
"""rad; step of the grid in which extremes are looked for before each is refined."""

ROUNDS = 100
"""Most rounds of the search for an angle on which the drift at that angle depends."""

SETTLED = 1e-13
"""rad; that angle is found when a round moves it by less."""


@kernel
def straight_length(
    l: float,
    x: float,
    y: float,
    breaks: Float[np.ndarray, " p1"],
    x_drift: Float[np.ndarray, "d p"],
    y_drift: Float[np.ndarray, "d p"],
    over_joint: bool,
) -> tuple[float, int]:
    """Distance L of the cuff from the limb's point where the limb is straight [m], and what became of it."""
    beta = 0.0
    for _ in range(ROUNDS):
        dx, dy = drift_at(0.0 if over_joint else beta, breaks, x_drift, y_drift)
        if abs(x + dx) > l:
            return np.nan, FOLD
        before = beta
        beta = asin((x + dx) / l)
        if over_joint or abs(beta - before) <= SETTLED:
            return y + dy + sqrt(l * l - (x + dx) * (x + dx)), SOUND
    return np.nan, LOST


@kernel
def offsets_at(
    beta: float,
    s: float,
    c: float,
    l: float,
    x: float,
    y: float,
    breaks: Float[np.ndarray, " p1"],
    x_drift: Float[np.ndarray, "d p"],
    y_drift: Float[np.ndarray, "d p"],
    over_joint: bool,
) -> tuple[float, float]:
    """Offsets with their drift at the exoskeleton's angle, of sine `s` and cosine `c`; NaN where none is found."""
    dx, dy = drift_at(beta, breaks, x_drift, y_drift)
    if not over_joint:
        return x + dx, y + dy
    alpha = beta
    for _ in range(ROUNDS):
        before = alpha
        alpha = beta - atan2((x + dx) * c + (y + dy) * s, l + (y + dy) * c - (x + dx) * s)
        dx, dy = drift_at(alpha, breaks, x_drift, y_drift)
        if abs(alpha - before) <= SETTLED:
            return x + dx, y + dy
    return np.nan, np.nan


@kernel
def deflection_at(s: float, c: float, l: float, z: float, x: float, y: float, straight: float) -> tuple[float, float]:
    """Deflection d [m], and the denominator of tan γ [m], at the angle of that sine and cosine."""
    across, along, top, bottom = attachment(s, c, l, x, y)
    return straight - sqrt(across * across + along * along) - z * top / bottom, bottom


@kernel
def exact_at(
    beta: float,
    l: float,
    z: float,
    x: float,
    y: float,
    straight: float,
    breaks: Float[np.ndarray, " p1"],
    x_drift: Float[np.ndarray, "d p"],
    y_drift: Float[np.ndarray, "d p"],
    over_joint: bool,
) -> tuple[float, float]:
    """`deflection_at` with the sines, the cosines and the drift of this angle."""
    s, c = np.sin(beta), np.cos(beta)
    u, v = offsets_at(beta, s, c, l, x, y, breaks, x_drift, y_drift, over_joint)
    return deflection_at(s, c, l, z, u, v, straight)


@kernel
def deflections(
    beta: Float[np.ndarray, " m"],
    joints: Float[np.ndarray, "n 4"],
    breaks: Float[np.ndarray, " p1"],
    x_drift: Float[np.ndarray, "d p"],
    y_drift: Float[np.ndarray, "d p"],
    over_joint: bool,
) -> tuple[Float[np.ndarray, "n m"], Float[np.ndarray, "n m"]]:
    """Deflection of every joint (l, z, x, y) at every angle [m] and the denominator of tan γ there; NaN for a fold."""
    d, bottom = np.empty((len(joints), beta.size)), np.empty((len(joints), beta.size))
    for k in range(len(joints)):
        l, z, x, y = joints[k, 0], joints[k, 1], joints[k, 2], joints[k, 3]
        straight, _ = straight_length(l, x, y, breaks, x_drift, y_drift, over_joint)
        for i in range(beta.size):
            d[k, i], bottom[k, i] = exact_at(beta[i], l, z, x, y, straight, breaks, x_drift, y_drift, over_joint)
    return d, bottom


@kernel
def vertex_in_cell(values: Float[np.ndarray, " m"], i: int) -> float:
    """Where the parabola through the values at i - 1, i, i + 1 has its vertex, in steps from i.

    0 where that is nearer to another inner node, which then finds it; next to an end the cell reaches to the end.
    """
    bend = values[i - 1] - 2.0 * values[i] + values[i + 1]
    if abs(values[i - 1] - values[i + 1]) > 2.0 * abs(bend) or bend == 0.0:
        return 0.0
    step = 0.5 * (values[i - 1] - values[i + 1]) / bend
    least = -1.0 if i == 1 else -0.5
    most = 1.0 if i == values.size - 2 else 0.5
    return step if least <= step <= most else 0.0


@kernel
def wider(ends: tuple[float, float, float, float], value: float, at: float) -> tuple[float, float, float, float]:
    """Least and largest value, the angles where, once this value is among them."""
    low, high, low_at, high_at = ends
    if value < low:
        low, low_at = value, at
    if value > high:
        high, high_at = value, at
    return low, high, low_at, high_at


@kernel
def fate_of(least: float, l: float) -> int:
    """What the least denominator of tan γ says [m]; a thousandth of the link is a pole already, as at the elbow."""
    return SOUND if least > POLE_SHARE * l else POLE if least <= POLE_SHARE * l else LOST


@kernel
def extremes(
    beta: Float[np.ndarray, " m"],
    joints: Float[np.ndarray, "n 4"],
    breaks: Float[np.ndarray, " p1"],
    x_drift: Float[np.ndarray, "d p"],
    y_drift: Float[np.ndarray, "d p"],
    over_joint: bool,
) -> tuple[Float[np.ndarray, "n 2"], Float[np.ndarray, "n 2"], Int[np.ndarray, " n"]]:
    """Least and largest deflection [m] of every joint (l, z, x, y), the angles where, and what became of it.

    `beta` is an even grid of five angles or more. Around each local extreme of its values the exact deflection at the
    vertex of the parabola through three of them counts too, so the error is of the fourth order in the step, and an
    extreme is never overstated. The denominator of tan γ is searched alike for a pole. NaN where there is no value.
    """
    m, h = beta.size, beta[1] - beta[0]
    s, c = np.sin(beta), np.cos(beta)
    drift = np.empty((m, 2))
    for i in range(m):
        drift[i, 0], drift[i, 1] = drift_at(beta[i], breaks, x_drift, y_drift)
    d, bottom = np.empty(m), np.empty(m)
    value, angle = np.full((len(joints), 2), np.nan), np.full((len(joints), 2), np.nan)
    fate = np.zeros(len(joints), np.int64)
    for k in range(len(joints)):
        l, z, x, y = joints[k, 0], joints[k, 1], joints[k, 2], joints[k, 3]
        straight, fate[k] = straight_length(l, x, y, breaks, x_drift, y_drift, over_joint)
        if fate[k] != SOUND:
            continue
        ends = (np.inf, -np.inf, np.nan, np.nan)
        for i in range(m):
            u, v = x + drift[i, 0], y + drift[i, 1]
            if over_joint:
                u, v = offsets_at(beta[i], s[i], c[i], l, x, y, breaks, x_drift, y_drift, over_joint)
            d[i], bottom[i] = deflection_at(s[i], c[i], l, z, u, v, straight)
            ends = wider(ends, d[i], beta[i])
        for i in range(1, m - 1):
            at = beta[i] + h * vertex_in_cell(d, i)
            if at != beta[i]:
                ends = wider(ends, exact_at(at, l, z, x, y, straight, breaks, x_drift, y_drift, over_joint)[0], at)
        value[k, 0], value[k, 1], angle[k, 0], angle[k, 1] = ends
        near = min(max(int(np.argmin(bottom)), 1), m - 2)
        at = beta[near] + h * vertex_in_cell(bottom, near)
        least = min(bottom.min(), exact_at(at, l, z, x, y, straight, breaks, x_drift, y_drift, over_joint)[1])
        fate[k] = fate_of(least, l)
        if fate[k] != SOUND:
            value[k], angle[k] = np.nan, np.nan
    return value, angle, fate


def grid(start: float, stop: float, step: float = STEP) -> Float[np.ndarray, " m"]:
    """Even angles from `start` to `stop` [rad], at most `step` apart and five at least."""
    return np.linspace(start, stop, max(int(np.ceil(abs(stop - start) / step - 1e-9)), 4) + 1)


@dataclass(frozen=True, eq=False)
class PlanarJoint:
    """Link length l, distance z of the attachment from the limb, offsets x and y [m], and how these drift."""

    length: float
    distance: float
    x: float
    y: float
    drift: AxisDrift = STILL

    @property
    def words(self) -> str:
        """The numbers in words."""
        return f"l = {self.length * 1e3:g} mm, x = {self.x * 1e3:g} mm, y = {self.y * 1e3:g} mm"

    @property
    def numbers(self) -> Float[np.ndarray, "1 4"]:
        """The numbers in the order in which the kernels take them."""
        return np.array([[self.length, self.distance, self.x, self.y]])

    def deflection(self, beta: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """Deflection d [m] at angles of the exoskeleton [rad]; ValueError names the angle of a pole, or the fold."""
        drift = drift_numbers(self.drift)
        _, fate = straight_length(self.length, self.x, self.y, *drift)
        if fate != SOUND:
            raise ValueError(f"{self.words}: {FATES[fate]}")
        (value,), (bottom,) = deflections(beta, self.numbers, *drift)
        if not (bottom > POLE_SHARE * self.length).all():
            k = int(np.argmin(np.where(np.isnan(bottom), -np.inf, bottom)))
            fate = LOST if np.isnan(bottom[k]) else POLE
            raise ValueError(f"{self.words}: {FATES[fate]} (at {np.degrees(beta[k]):.4g} deg)")
        return np.asarray(value)

    def extremes(self, start: float, stop: float) -> tuple[Float[np.ndarray, " 2"], Float[np.ndarray, " 2"]]:
        """Least and largest deflection [m] from `start` to `stop` [rad] and where; ValueError as of `deflection`."""
        beta = grid(start, stop)
        self.deflection(beta)
        value, angle, fate = extremes_of(beta, self.numbers, self.drift)
        if fate[0] != SOUND:
            raise ValueError(f"{self.words}: {FATES[fate[0]]} (between two angles of the grid)")
        return value[0], angle[0]


FATES = {
    POLE: "tan γ has a pole in the range, the link comes to stand across the limb",
    FOLD: "the offset x is longer than the link, the limb is straight at no angle",
    LOST: "the axis drifts so fast that no single angle of the joint belongs to one of the exoskeleton's",
}
"""What became of a joint that has no deflection somewhere, in words."""


def drift_numbers(
    drift: AxisDrift,
) -> tuple[Float[np.ndarray, " p1"], Float[np.ndarray, "d p"], Float[np.ndarray, "d p"], bool]:
    """A drift as the kernels take it."""
    return drift.breaks, drift.x, drift.y, drift.over_joint


def extremes_of(
    beta: Float[np.ndarray, " m"], joints: Float[np.ndarray, "n 4"], drift: AxisDrift
) -> tuple[Float[np.ndarray, "n 2"], Float[np.ndarray, "n 2"], Int[np.ndarray, " n"]]:
    """`extremes` with the drift as it is."""
    return extremes(beta, joints, *drift_numbers(drift))
