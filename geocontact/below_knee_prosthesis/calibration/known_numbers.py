"""What stances tell of each number of the zones: known within an interval, not identified, or unknown.

Residuals of a model that is not quite right remember from frame to frame. So the covariance is that of least squares
under noise with a memory (`noise.autocorrelation`), the prior standing in as one more measurement of each number, with
its own standard deviation whatever the residuals are. Residuals that are smaller than the noise that is stated do not
make a number better known: errors of poses that are the same all through a stance do not show in them. So no variance
is less than that of least squares under the stated noise, without memory. Of a number that is not identified an
interval would be the prior's and the model's doing, and planted numbers were outside of it: it has none.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.special import ndtri

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.calibration.sole_residuals import PAUSE
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion
from geocontact.below_knee_prosthesis.leg import FootOffset
from geocontact.identify.identifiability import Identifiability, identifiability
from geocontact.identify.noise.autocorrelation import Autocorrelation, autocorrelation_of, sandwich, spread

Verdict = Literal["known", "not identified", "unknown"]
HALF = 0.5
"""Share of the prior's standard deviation that is left of a number that the data make known, at most."""
EARNEST, LASTING, BEARING = 2.5, 0.05, 0.05
"""A zone slips in earnest: faster than so many errors of the recorded speed, for at least so long [s] in sum, while it
bears that share of body weight. Below, friction is what the search for the slip makes of it."""
DEAD = 1e-9
"""Sensitivity, over the largest, of a number that has no effect."""


@dataclass(frozen=True)
class KnownNumber:
    """One number of a zone.

    Parameters
    ----------
    lower, upper
        Of the interval; NaN where the number is not known.
    verdict
        "known": the data at least halve the width of the prior, and of friction the zone slips in earnest.
        "not identified": they do not. "unknown": the stances never loaded the zone so that the number has any effect;
        its value is the usual one and says nothing.
    prior
        Lower and upper end of the prior's interval of the same probability.
    """

    name: str
    unit: str
    value: float
    lower: float
    upper: float
    verdict: Verdict
    prior: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Knowledge:
    """Knowledge of all numbers.

    Parameters
    ----------
    told_apart
        By the data alone, of those that have an effect.
    memory
        Of the residuals.
    half
        Half the interval of each number's logarithm; infinite where it has no effect.
    beside
        Height [m] and pitch [rad] of the foot beside each standing trial, where they were sought.
    beside_sd
        Their standard deviations.
    """

    numbers: tuple[KnownNumber, ...]
    told_apart: Identifiability
    memory: Autocorrelation
    half: Float[np.ndarray, " p"]
    beside: tuple[KnownNumber, ...] = ()
    beside_sd: tuple[float, ...] = ()

    @property
    def offsets(self) -> tuple[FootOffset, ...]:
        """Offsets of the foot beside each standing trial."""
        pairs = [(each.value, sd) for each, sd in zip(self.beside, self.beside_sd, strict=True)]
        return tuple(
            FootOffset(height, pitch, height_sd, pitch_sd)
            for (height, height_sd), (pitch, pitch_sd) in zip(pairs[::2], pairs[1::2], strict=True)
        )


@runtime_checkable
class StanceResiduals(Protocol):
    """Residuals of stances, by the logarithms of a sole's numbers: `SoleResiduals`, `WholeResiduals`."""

    @property
    def sd(self) -> Float[np.ndarray, " p"]:
        """Standard deviation of everything that is sought, beforehand."""

    @property
    def sizes(self) -> Float[np.ndarray, " a"]:
        """One standard deviation of height [m] and pitch [rad] beforehand, by standing trial."""

    @property
    def zones(self) -> ZoneParameters:
        """Whose numbers are sought."""

    def values(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " p"]:
        """The numbers."""

    def of_data(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
        """Predicted less measured over the noise."""

    def slope_of_data(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "n p"]:
        """Derivatives of the data."""

    def channel_by_channel(self) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]:
        """Times and places of the data's residuals."""

    def slid(self, z: Float[np.ndarray, " p"]) -> Iterable[tuple[RecordedStance, KeelMotion]]:
        """Each stance, and the keel along it."""


def knowledge(residuals: StanceResiduals, z: Float[np.ndarray, " p"], level: float = 0.95) -> Knowledge:
    """At the logarithms that a calibration found, with intervals of probability `level`."""
    zones, values = residuals.zones, residuals.values(z)
    usual = zones.values_of(zones.usual)
    off, slope = residuals.of_data(z), residuals.slope_of_data(z)
    size = np.linalg.norm(slope, axis=0)
    alive = size > DEAD * max(float(size.max()), DEAD)
    time, order = residuals.channel_by_channel()
    memory, covariance = with_memory(time, off[order], slope[order][:, alive], z[alive], residuals.sd[: len(z)][alive])
    half = np.full(len(z), np.inf)
    half[alive] = [memory.half_width(np.sqrt(covariance[:, k, k]), level) for k in range(int(alive.sum()))]
    sd = np.full(len(z), np.inf)
    sd[alive] = np.sqrt(np.einsum("g,gkk->k", memory.weight, covariance))
    rows, slips = [], np.concatenate([np.ones(2 * len(zones.zones), bool), slipping_zones(residuals, z)])
    for k, each in enumerate(zones.parameters()):
        known = sd[k] <= HALF * zones.sd[k] and slips[k]
        verdict: Verdict = "unknown" if not alive[k] else "known" if known else "not identified"
        ends = np.nan, np.nan
        if verdict == "known":
            reach = np.exp(half[k])
            ends = max(each.lower, values[k] / reach), min(each.upper, values[k] * reach)
        wide = np.exp(ndtri(0.5 + 0.5 * level) * zones.sd[k])
        prior = max(each.lower, usual[k] / wide), min(each.upper, usual[k] * wide)
        found = float(values[k]), float(ends[0]), float(ends[1])
        rows.append(KnownNumber(each.name, each.unit, *found, verdict, (float(prior[0]), float(prior[1]))))
    count = len(zones.names)
    names = [name for name, on in zip(zones.names, alive[:count], strict=True) if on]
    told_apart = identifiability(names, slope[:, :count][:, alive[:count]])
    sizes = residuals.sizes[: len(z) - count]
    besides = zip(z[count:], sd[count:], half[count:], sizes, strict=True)
    beside = tuple(_beside(k, *each, level) for k, each in enumerate(besides))
    beside_sd = tuple((sizes * np.minimum(sd[count:], 1.0)).tolist())
    return Knowledge(tuple(rows), told_apart, memory, half[:count], beside, beside_sd)


def _beside(place: int, z: float, sd: float, half: float, size: float, level: float) -> KnownNumber:
    """Height or pitch of the foot beside its standing trial, from what was sought in standard deviations."""
    name, unit = (("foot.height", "m"), ("foot.pitch", "rad"))[place % 2]
    name += f".{place // 2 + 1}" if place > 1 else ""
    known, wide = sd <= HALF, size * float(ndtri(0.5 + 0.5 * level))
    ends = (size * (z - half), size * (z + half)) if known else (np.nan, np.nan)
    verdict: Verdict = "known" if known else "not identified" if np.isfinite(sd) else "unknown"
    return KnownNumber(name, unit, float(size * z), float(ends[0]), float(ends[1]), verdict, (-wide, wide))


def slipping_zones(residuals: StanceResiduals, z: Float[np.ndarray, " p"]) -> Bool[np.ndarray, " zones"]:
    """Whether each zone slips in earnest in any of the stances, in their order."""
    chosen = list(residuals.zones.sole.spheres.zones.values())
    lasting = np.zeros(len(chosen))
    for stance, motion in residuals.slid(z):
        step = float(np.median(np.diff(stance.time)))
        speed, pressing = np.linalg.norm(motion.sliding, axis=2), motion.loads.pressing
        for k, of in enumerate(chosen):
            bearing = pressing[:, of].sum(axis=1)
            mean = (pressing * speed)[:, of].sum(axis=1) / np.maximum(bearing, 1.0)
            fast = (mean > EARNEST * stance.errors.speed) & (bearing > BEARING * stance.weight)
            lasting[k] += step * fast.sum()
    return lasting >= LASTING


def with_memory(
    time: Float[np.ndarray, " n"],
    off: Float[np.ndarray, " n"],
    slope: Float[np.ndarray, "n p"],
    z: Float[np.ndarray, " p"],
    sd: Float[np.ndarray, " p"],
) -> tuple[Autocorrelation, Float[np.ndarray, "g p p"]]:
    """Memory of the residuals and covariance of the numbers with each of its times, priors as measurements far off.

    Those of the residuals have the variance that the residuals show, the priors their own; variances are at least those
    of the stated noise.
    """
    far = time[-1] * (2.0 + np.arange(len(z))) + PAUSE
    at = np.concatenate([time, far])
    both = np.vstack([slope, np.diag(1.0 / sd)])
    memory = autocorrelation_of(at, np.concatenate([off, z / sd]), both)
    stated = spread(both)
    of_priors = (stated / sd**2) @ stated
    covariance = sandwich(memory, at, both) + (1.0 - memory.variance)[:, None, None] * of_priors
    at_least = np.maximum(np.diag(stated) - np.einsum("gkk->gk", covariance), 0.0)
    return memory, covariance + at_least[:, :, None] * np.eye(len(z))
