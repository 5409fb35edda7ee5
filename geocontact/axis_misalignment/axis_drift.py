"""How the axis of a joint drifts with the angle: added to the offsets of a misaligned axis.

The drift is a piecewise polynomial over the exoskeleton's angle β or the joint's own α = β - γ: one piece for a
polynomial, cubic pieces through the rows of a table, which is held at its ends. It is that of a point which stays with
the limb. Literature often tells an instant centre of rotation instead; `from_instant_centre` turns one into the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.geometry.kernels.compile import kernel

FEWEST_ROWS = 4
"""Rows of a table; a cubic through fewer is not one."""

TWO_TURNS = 4.0 * np.pi
"""rad; no joint goes further."""

STEPS = 4000
"""Parts in which the path of a limb's point is integrated; the error falls with the fourth power."""


@kernel
def drift_at(
    angle: float,
    breaks: Float[np.ndarray, " p1"],
    x: Float[np.ndarray, "d p"],
    y: Float[np.ndarray, "d p"],
) -> tuple[float, float]:
    """Drift of the offsets [m] at that angle [rad]; beyond the breaks that of the nearest one."""
    last = breaks.size - 1
    at = min(max(angle, breaks[0]), breaks[last])
    i = min(max(np.searchsorted(breaks, at, side="right") - 1, 0), last - 1)
    step = at - breaks[i]
    dx, dy = 0.0, 0.0
    for k in range(x.shape[0]):
        dx = dx * step + x[k, i]
        dy = dy * step + y[k, i]
    return dx, dy


@dataclass(frozen=True, eq=False)
class AxisDrift:
    """Drift of the offsets (x, y) [m] over an angle [rad]: the exoskeleton's, or with `over_joint` the joint's own.

    `breaks` bound the pieces; `x` and `y` hold their coefficients, highest power first, in the distance from the break
    to the left. That is scipy's form of a piecewise polynomial.
    """

    breaks: Float[np.ndarray, " p1"]
    x: Float[np.ndarray, "d p"]
    y: Float[np.ndarray, "d p"]
    over_joint: bool = False

    def at(self, angles: Float[np.ndarray, " n"]) -> Float[np.ndarray, "n 2"]:
        """Drift (x, y) [m] at each angle [rad]."""
        return np.array([drift_at(float(angle), self.breaks, self.x, self.y) for angle in angles]).reshape(-1, 2)


def polynomial(x: Sequence[float], y: Sequence[float]) -> AxisDrift:
    """x = x[0] + x[1] β + x[2] β² + …, y likewise, within two turns either way; m, m/rad, m/rad², …."""
    from numpy.polynomial import Polynomial

    moved = [Polynomial(given or (0.0,))(Polynomial((-TWO_TURNS, 1.0))).coef for given in (tuple(x), tuple(y))]
    count = max(map(len, moved))
    columns = [np.pad(column, (0, count - len(column)))[::-1, None] for column in moved]
    in_x, in_y = (np.ascontiguousarray(column) for column in columns)
    return AxisDrift(np.array([-TWO_TURNS, TWO_TURNS]), in_x, in_y)


def table(
    angle: Float[np.ndarray, " n"], x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"], over_joint: bool = False
) -> AxisDrift:
    """Cubic spline (not-a-knot) through the rows of a table, angles [rad] rising, drift [m]; ValueError otherwise."""
    from scipy.interpolate import CubicSpline

    if len(angle) < FEWEST_ROWS:
        raise ValueError(f"{len(angle)} rows, a drift needs {FEWEST_ROWS} or more")
    if (np.diff(angle) <= 0.0).any():
        raise ValueError("angles do not rise from row to row")
    spline = CubicSpline(angle, np.column_stack([x, y]))
    in_x, in_y = (np.ascontiguousarray(spline.c[:, :, k]) for k in (0, 1))
    return AxisDrift(np.ascontiguousarray(spline.x), in_x, in_y, over_joint)


STILL = polynomial((), ())
"""An axis that stays."""


def from_instant_centre(
    alpha: Float[np.ndarray, " n"], x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"]
) -> AxisDrift:
    """Drift of the limb's own point over the joint's angle [rad], from where the instant centre is at each; all in m.

    The instant centre c is the point of the limb that stands still at that instant, given as offsets (x, y) are. The
    limb's line starts from where the centre is when the joint is straight (angle 0); that point o stays with the limb
    and moves by do/dα = i (o - c) in complex numbers x + i y. ValueError where the table does not hold angle 0.
    """
    from scipy.interpolate import CubicSpline

    if not alpha[0] <= 0.0 <= alpha[-1]:
        raise ValueError("the table does not hold the straight joint, angle 0")
    dense = np.linspace(alpha[0], alpha[-1], STEPS + 1)
    centre = table(alpha, x, y).at(np.append(dense, 0.0)) @ np.array([1.0, 1j])
    turned = CubicSpline(dense, np.exp(-1j * dense) * centre[:-1]).antiderivative()
    point = np.exp(1j * dense) * (centre[-1] - 1j * (turned(dense) - turned(0.0)))
    return table(dense, point.real, point.imag, over_joint=True)
