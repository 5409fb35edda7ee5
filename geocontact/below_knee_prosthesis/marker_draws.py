"""What errors of the markers do to a simulated stance: drawn again and again, from the markers on.

Half of the variance of a marker's error is from frame to frame, half changes slowly, as skin does. A draw has its error
on top of that of the recording, so the band is about the recording's own curves: normal, as wide as the draws are away
from them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.special import ndtri

from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.data.multibody.markers import MarkerTrajectories

SLOW = 0.1
"""s; over which the slow half of a marker's error changes."""
FEWEST = 0.5
"""Share of the draws that must be left for a band."""
UNITS = {"vertical": "BW", "fore_aft": "BW", "medio_lateral": "BW", "cop_ground": "-", "ankle_moment": "N m/kg"}
"""Quantities of a band, and their units: of body weight, of the foot, of the body mass."""


def with_errors(seen: MarkerTrajectories, sd: float, rng: np.random.Generator) -> MarkerTrajectories:
    """With an error of a standard deviation [m] on every coordinate of every marker."""
    from scipy.ndimage import gaussian_filter1d

    shape = seen.positions.shape
    step = float(np.median(np.diff(seen.time))) if len(seen.time) > 1 else SLOW
    slow = gaussian_filter1d(rng.standard_normal(shape), SLOW / step, axis=0, mode="wrap")
    slow /= max(float(slow.std()), 1e-12)
    error = np.sqrt(0.5) * sd * (slow + rng.standard_normal(shape))
    return replace(seen, positions=seen.positions + error)


@dataclass(frozen=True, eq=False)
class MarkerBand:
    """Curves of a stance over time, and how far errors of the markers move them.

    Parameters
    ----------
    time
        [s].
    curves, half
        By the names of `UNITS`: as simulated, and half the width of the band.
    drawn, lost
        Draws that were simulated, and those that could not be.
    """

    time: Float[np.ndarray, " t"]
    curves: Mapping[str, Float[np.ndarray, " t"]]
    half: Mapping[str, Float[np.ndarray, " t"]]
    drawn: int
    lost: int

    def width(self, quantity: str, on: Bool[np.ndarray, " t"] | None = None) -> float:
        """Half the width, root mean square over the samples where it is known (and `on` holds)."""
        half = self.half[quantity]
        known = np.isfinite(half) if on is None else np.isfinite(half) & on
        return float(np.sqrt(np.mean(half[known] ** 2))) if known.any() else float("nan")

    def inside(
        self, quantity: str, measured: Float[np.ndarray, " t"], on: Bool[np.ndarray, " t"] | None = None
    ) -> float:
        """Share of the samples (where `on` holds) in which a measured curve, at the same times, is in the band."""
        off = np.abs(measured - self.curves[quantity])
        known = np.isfinite(off) & np.isfinite(self.half[quantity])
        known &= True if on is None else on
        return float((off <= self.half[quantity])[known].mean()) if known.any() else float("nan")


def curves_of(s: Stance) -> dict[str, Float[np.ndarray, " t"]]:
    """Quantities of a stance over time, by the names of `UNITS`."""
    mass = s.motion.leg.person.mass
    force = s.force / (mass * GRAVITY)
    found = {"vertical": force[:, 1], "fore_aft": force[:, 0], "medio_lateral": force[:, 2]}
    return found | {"cop_ground": s.along_foot("ground"), "ankle_moment": s.ankle_moment / mass}


def marker_band(
    stance: Stance,
    again: Callable[[np.random.Generator], Stance],
    count: int,
    *,
    seed: int = 0,
    level: float = 0.95,
    step: Callable[[], None] = lambda: None,
) -> MarkerBand:
    """The band of a number of draws about a stance.

    Parameters
    ----------
    again
        The stance along markers with other errors, at the same times; ArithmeticError where there is none.
    level
        Probability of the band.

    The half width is the normal quantile times the root mean square of the draws less the stance. ArithmeticError where
    more than half of the draws cannot be simulated.
    """
    own, found, lost = curves_of(stance), list[dict[str, Float[np.ndarray, " t"]]](), 0
    for k in range(count):
        try:
            drawn = again(np.random.default_rng([seed, k]))
        except ArithmeticError:
            lost += 1
        else:
            found.append(curves_of(drawn))
        step()
    if lost > FEWEST * count:
        raise ArithmeticError(f"{lost} of {count} draws of the markers' errors cannot be simulated")
    wide = float(ndtri(0.5 + 0.5 * level))
    half = {name: wide * _rms([one[name] - curve for one in found]) for name, curve in own.items()}
    return MarkerBand(stance.time, own, half, count - lost, lost)


def _rms(off: list[Float[np.ndarray, " t"]]) -> Float[np.ndarray, " t"]:
    """Root mean square over the draws that are known in a sample; NaN where fewer than half of them are."""
    table = np.array(off)
    known = np.isfinite(table)
    count = known.sum(axis=0)
    mean = np.where(known, table, 0.0) ** 2
    return np.where(2 * count >= len(off), np.sqrt(mean.sum(axis=0) / np.maximum(count, 1)), np.nan)
