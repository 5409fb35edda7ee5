"""How far the attachment of an elbow exoskeleton is deflected when its axis and the joint's do not coincide.

After the explicit model of constraint forces from misaligned axes, with its printed equations put right: tan γ without
a branch, and y outside the root.
"""

from __future__ import annotations

from math import cos, hypot, sin, sqrt

import numpy as np
from jaxtyping import Float

from geocontact.chain.law_parameters import LawParameters
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
"""Of the link: where the denominator of tan γ is so small or smaller, tan γ is refused."""


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
