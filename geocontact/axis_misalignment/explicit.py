"""The explicit model of misaligned axes: deflection of the attachment, and every quantity of the force.

A joint's axis lies at the origin, the limb along the second axis; the exoskeleton's axis lies `x` and `y` off, its link
of length `l` carries the attachment, `z` away from the limb. Turned by β, the attachment is at
(l sin β - x, y + l cos β), and

    d_lin = y + sqrt(l² - x²) - hypot(l sin β - x, y + l cos β)
    tan γ = (x cos β + y sin β)/(l + y cos β - x sin β),   α = β - γ
    d_rot = z tan γ,   d_tot = d_lin - d_rot,   F = k d_tot + b d(d_tot)/dt

These are the equations of the explicit model without its printed mistakes: y stands outside of the root of eq. 16, its
cosecant is squared, arctan(x/y) fails for y < 0 and the arcsine of eq. 14 folds over. Offsets may have either sign.

After the explicit model of constraint forces from misaligned axes, with its printed equations put right: tan γ without
a branch, and y outside the root.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, sin, sqrt

import numpy as np
from jaxtyping import Float

from geocontact.chain.links import LawParameters
from geocontact.geometry.kernels.compile import kernel

ELBOW_GEOMETRY = LawParameters(
    {
        "l": 1.0,
        "z": 0.0,
        "x": 0.0,
        "y": 0.0,
        "axis_migration.slope": 0.0,
        "axis_migration.curvature": 0.0,
        "axis_migration.centre": 0.0,
        "series_compliance.compliance": 0.0,
        "series_compliance.exponent": 1.0,
        "series_compliance.reference": 1.0,
    }
)
NEAR_POLE = 1e-6
"""Least magnitude of the denominator of tan γ [m]; the pole is a large finite number."""


POLE_SHARE = 1e-3
"""Share of the link: where the denominator of tan γ is so small or smaller, tan γ is refused."""


@kernel
def attachment(s: float, c: float, l: float, x: float, y: float) -> tuple[float, float, float, float]:
    """Attachment seen from the joint's axis at an elbow angle of sine `s` and cosine `c`.

    How far it lies across and along the limb's own frame, and top and bottom of tan γ [m, m, m, m].
    """
    return l * s - x, y + l * c, x * c + y * s, l + y * c - x * s


@kernel
def closure(s: float, c: float, l: float, x: float, y: float) -> tuple[float, float, float, float, float]:
    """Attachment seen from the joint's axis at an elbow angle of sine `s` and cosine `c` [m, m, m, m, m].

    How far it lies across, its distance, its distance at the stretched limb, and top and bottom of tan γ. Where |x| > l
    the root is taken as 0; the bottom keeps a magnitude of 1 µm.
    """
    across, along, top, bottom = attachment(s, c, l, x, y)
    reach = max(hypot(across, along), NEAR_POLE)
    height = sqrt(max(l * l - x * x, NEAR_POLE * NEAR_POLE))
    if abs(bottom) < NEAR_POLE:
        bottom = NEAR_POLE if bottom >= 0.0 else -NEAR_POLE
    return across, reach, height, top, bottom


@kernel
def misalignment(beta: float, rate: float, n: Float[np.ndarray, " slots"]) -> tuple[float, float]:
    """Deflection d_tot [m] and its rate [m/s] at elbow angle `beta` [rad].

    d_tot = d_lin - z tan γ, d_lin = y + sqrt(l² - x²) - hypot(l sin β - x, y + l cos β),
    tan γ = (x cos β + y sin β)/(l + y cos β - x sin β). Where |x| > l the root is taken as 0, and near the pole of
    tan γ its denominator keeps a magnitude of 1 µm, so that the deflection is finite for any finite numbers.
    """
    l, z, y = n[0], n[1], n[3]
    angle = beta - n[6]
    x = n[2] + angle * (n[4] + n[5] * angle)
    x_rate = rate * (n[4] + 2.0 * n[5] * angle)
    s, c = sin(beta), cos(beta)
    across, reach, height, top, bottom = closure(s, c, l, x, y)
    deflection = y + height - reach - z * top / bottom
    by_beta = l * top / reach - z * ((y * c - x * s) * bottom + top * top) / (bottom * bottom)
    by_x = across / reach - x / height - z * (c * bottom + s * top) / (bottom * bottom)
    return deflection, by_beta * rate + by_x * x_rate


@kernel
def deflect(
    beta: Float[np.ndarray, " t"], rate: Float[np.ndarray, " t"], n: Float[np.ndarray, " slots"]
) -> Float[np.ndarray, "two t"]:
    """Deflection and rate of every sample."""
    out = np.empty((2, beta.size))
    for i in range(beta.size):
        out[0, i], out[1, i] = misalignment(beta[i], rate[i], n)
    return out


NEUTRAL = ELBOW_GEOMETRY.numbers({})  # l, z, x, y come first


@dataclass(frozen=True)
class Offsets:
    """Link `l`, offset `z` of the attachment, and where the exoskeleton's axis lies, `x` and `y` [m]."""

    l: float
    z: float
    x: float
    y: float

    @property
    def numbers(self) -> Float[np.ndarray, " slots"]:
        """The numbers in the order in which the kernels take them."""
        n = NEUTRAL.copy()
        n[:4] = self.l, self.z, self.x, self.y
        return n

    @property
    def words(self) -> str:
        """For messages."""
        return f"l = {self.l * 1e3:g} mm, x = {self.x * 1e3:g} mm, y = {self.y * 1e3:g} mm"


@dataclass(frozen=True, eq=False)
class Displacement:
    """Angles of the joint and of the cuff [rad], and parts of the displacement [m]."""

    alpha: Float[np.ndarray, " n"]
    gamma: Float[np.ndarray, " n"]
    linear: Float[np.ndarray, " n"]
    rotary: Float[np.ndarray, " n"]
    total: Float[np.ndarray, " n"]


def displacement(beta: Float[np.ndarray, " n"], offsets: Offsets) -> Displacement:
    """Displacement of the attachment along the limb at exoskeleton angles `beta` [rad].

    ValueError, with the angle and the offsets, where the model has no value: |x| > l (the link does not reach the
    stretched limb) and a pole of tan γ (the attachment is beside the joint's axis).
    """
    require_reach(offsets)
    linear, top, bottom = _closures(beta, offsets.l, offsets.x, offsets.y)
    require_no_pole(beta, offsets)
    gamma = np.arctan2(top, bottom)
    rotary = offsets.z * top / bottom
    return Displacement(beta - gamma, gamma, linear, rotary, linear - rotary)


def constraint_force(
    beta: Float[np.ndarray, " n"],
    rate: Float[np.ndarray, " n"],
    offsets: Offsets,
    stiffness: float,
    damping: float = 0.0,
) -> Float[np.ndarray, " n"]:
    """Force on the attachment [N] at angles [rad] that change by `rate` [rad/s]; k [N/m], b [N s/m].

    ValueError as `displacement`.
    """
    require_reach(offsets)
    require_no_pole(beta, offsets)
    total, speed = deflect(beta, rate, offsets.numbers)
    return np.asarray(stiffness * total + damping * speed)


def require_reach(offsets: Offsets) -> None:
    """ValueError where the link is too short for its offset."""
    if offsets.l <= 0.0:
        raise ValueError(f"the link's length is {offsets.l * 1e3:g} mm, expected more than 0")
    if abs(offsets.x) > offsets.l:
        what = f"|x| = {abs(offsets.x) * 1e3:g} mm is more than the link's l = {offsets.l * 1e3:g} mm"
        raise ValueError(f"{what}: the attachment does not reach the stretched limb, and the root folds")


def require_no_pole(beta: Float[np.ndarray, " n"], offsets: Offsets) -> None:
    """ValueError where tan γ has a pole among the angles or beyond it (γ is then over 90°)."""
    below = _closures(beta, offsets.l, offsets.x, offsets.y)[2] <= POLE_SHARE * offsets.l
    if not below.any():
        return
    at = float(beta[int(np.argmax(below))])
    poles = pole_angles(offsets)
    if not poles:
        what = f"tan γ comes within {POLE_SHARE:.1%} of a pole at {np.degrees(at):.4g} degrees"
        raise ValueError(f"{what} with {offsets.words}")
    nearest = np.degrees(min(poles, key=lambda p: abs(p - at)))
    what = f"tan γ has a pole at {nearest:.4g} degrees, reached or passed at {np.degrees(at):.4g}"
    raise ValueError(f"{what}, with {offsets.words}")


def require_no_pole_at(beta: Float[np.ndarray, " n"], bottom: Float[np.ndarray, " n"], link: float) -> None:
    """ValueError with the angle where the denominator of tan γ [m] under load has come near 0, or below."""
    below = bottom <= POLE_SHARE * link
    if below.any():
        at = float(np.degrees(beta[int(np.argmax(below))]))
        raise ValueError(f"tan γ reaches a pole at {at:.4g} degrees, with the offsets that the load leaves")


def pole_angles(offsets: Offsets) -> tuple[float, ...]:
    """Angles within ± 180 degrees at which l + y cos β - x sin β = 0 [rad]; none where the offset is below the link."""
    size = float(np.hypot(offsets.x, offsets.y))
    if size < offsets.l:
        return ()
    turn, half = float(np.arctan2(offsets.x, offsets.y)), float(np.arccos(-offsets.l / size))
    return tuple(sorted({float(np.angle(np.exp(1j * (way * half - turn)))) for way in (-1.0, 1.0)}))


@kernel
def _closures(beta: Float[np.ndarray, " n"], l: float, x: float, y: float) -> Float[np.ndarray, "three n"]:
    out = np.empty((3, beta.size))
    for i in range(beta.size):
        _, reach, height, top, bottom = closure(np.sin(beta[i]), np.cos(beta[i]), l, x, y)
        out[0, i], out[1, i], out[2, i] = y + height - reach, top, bottom
    return out
