"""Contact force from the evolution of a contact area, with what may be unknown about the area and its clock."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator

from geocontact.contact.adhesion import dmt_pull_off, jkr_pull_off
from geocontact.contact.area_hertz import PatchGeometry, Reading
from geocontact.data.evolution import TiltedAreas

MODULUS, THRESHOLD, LAG, ADDUCTION, SLOPE = "modulus", "threshold", "lag", "adduction", "slope"
WORK = "work"
"""Names of the parameters: E* [Pa], threshold of the area [m], lag of the force's clock behind the area's [s], offset
of adduction that is added to the recorded pose [rad], the share by which R grows per flexion [1/rad], and the work of
adhesion [J/m^2]."""


@dataclass(frozen=True, eq=False)
class ThresholdAreas:
    """Area of one compartment, or of all, over time and threshold.

    Parameters
    ----------
    time
        (t,) [s], strictly increasing.
    thresholds
        (k,) [m], strictly increasing.
    area
        (t, k) [m^2].
    radius
        R at each frame [m]: one number repeated, or following flexion.
    length
        Of the strip in the reading "strip" [m].
    tilts
        The same areas at some offsets of adduction, where these were evaluated; `area` is that at no offset.
    flexion
        Angle at each frame [rad] that R may be made to follow; None where it is not known.
    """

    time: Float[np.ndarray, " t"]
    thresholds: Float[np.ndarray, " k"]
    area: Float[np.ndarray, "t k"]
    radius: Float[np.ndarray, " t"]
    length: float
    tilts: TiltedAreas | None = None
    flexion: Float[np.ndarray, " t"] | None = None

    def with_offsets(self, values: Mapping[str, float]) -> ThresholdAreas:
        """The evolution at an adduction offset, and R (1 + slope flexion) for R, as far as `values` name them."""
        given = self
        if ADDUCTION in values:
            if self.tilts is None:
                raise ValueError("areas are known at one adduction only")
            given = replace(given, area=self.tilts.at(values[ADDUCTION]))
        if SLOPE in values:
            if self.flexion is None:
                raise ValueError("the flexion of the frames is not known")
            given = replace(given, radius=self.radius * (1.0 + values[SLOPE] * self.flexion))
        return given

    @cached_property
    def _over_threshold(self) -> PchipInterpolator:
        return PchipInterpolator(self.thresholds, self.area, axis=1)

    def within(self, threshold: float) -> Float[np.ndarray, " t"]:
        """Area within a threshold [m^2]: monotone cubic in the threshold between those that were evaluated."""
        at = np.flatnonzero(self.thresholds == threshold)
        if len(at):
            return np.asarray(self.area[:, int(at[0])])
        if len(self.thresholds) == 1:
            raise ValueError(f"the area is known at {self.thresholds[0]:g} m only, not at {threshold:g} m")
        return np.asarray(self._over_threshold(threshold), float)

    def per_modulus(self, reading: Reading, threshold: float) -> Float[np.ndarray, " t"]:
        """Force over E* at each frame [m^2]."""
        patch = PatchGeometry(self.radius, self.length, threshold)
        return np.asarray(reading.force(self.within(threshold), patch, 1.0), float)


@dataclass(frozen=True)
class Adhesion:
    """What holds the bodies together at a patch of radius a = sqrt(A/pi), for a given work of adhesion.

    Both laws are Hertz's force less a pull (`contact.adhesion`): DMT 2 pi w R, JKR sqrt(E*) sqrt(8 pi w a^3).

    Parameters
    ----------
    law
        "dmt" or "jkr".
    work
        Work of adhesion w [J/m^2].
    """

    law: str
    work: float

    @property
    def words(self) -> str:
        """Law and work, as a sentence names them."""
        return f"{self.law.upper()}'s adhesion with a work of {self.work:.4g} J/m²"

    def pull_off(self, radius: float, work: float) -> float:
        """Force at which bodies of this relative radius [m] and work of adhesion [J/m^2] come apart, below 0 [N]."""
        return float(dmt_pull_off(radius, work) if self.law == "dmt" else jkr_pull_off(radius, work))

    def pull(self, area: Float[np.ndarray, " t"], radius: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """Pull [N] for DMT, over sqrt(E*) for JKR; 0 without area."""
        if self.law == "dmt":
            return np.asarray((area > 0.0) * radius * -dmt_pull_off(1.0, self.work))
        return np.asarray(np.sqrt(8.0 * np.pi * self.work) * (np.maximum(area, 0.0) / np.pi) ** 0.75)

    def force(
        self, unit: Float[np.ndarray, " n"], pull: Float[np.ndarray, " n"], modulus: float
    ) -> Float[np.ndarray, " n"]:
        """Force [N] from Hertz's over E* and what `pull` gives."""
        return np.asarray(modulus * unit - pull * (1.0 if self.law == "dmt" else np.sqrt(modulus)))

    def refit(
        self, unit: Float[np.ndarray, " n"], pull: Float[np.ndarray, " n"], measured: Float[np.ndarray, " n"]
    ) -> float:
        """E* of the least sum of squares; for JKR s = sqrt(E*) is a root of its slope, a cubic in s."""
        if self.law == "dmt":
            return float((measured + pull) @ unit / (unit @ unit))
        slope = (2.0 * unit @ unit, -3.0 * unit @ pull, pull @ pull - 2.0 * unit @ measured, pull @ measured)
        roots = np.roots(slope)
        real = roots[np.abs(roots.imag) <= 1e-9 * np.abs(roots).max()].real
        allowed = real[real > 0.0]
        if len(allowed) == 0:
            return 0.0
        off = [float(np.square(unit * s * s - pull * s - measured).sum()) for s in allowed]
        return float(allowed[int(np.argmin(off))] ** 2)


@dataclass(frozen=True, eq=False)
class AreaForce:
    """The area-integrated law as a model of one force curve.

    Parameters
    ----------
    evolution, reading
        Area over time, and what it is taken for.
    frames
        Times of the area's clock at which the force was measured [s].
    taken
        Lag with which the measured force was read [s]: force(t + taken) belongs to frame t.
    threshold
        Used unless it is a free parameter [m].
    adhesion
        What holds the bodies together besides; None where they do not stick. Its work is used unless it is free.
    """

    evolution: ThresholdAreas
    reading: Reading
    frames: Float[np.ndarray, " n"]
    taken: float
    threshold: float
    adhesion: Adhesion | None = None

    def per_modulus(self, values: Mapping[str, float]) -> Float[np.ndarray, " n"]:
        """Hertz's force over E* at the frames [m^2]."""
        evolution = self.evolution.with_offsets(values)
        return self._at_frames(evolution.per_modulus(self.reading, values.get(THRESHOLD, self.threshold)), values)

    def _at_frames(self, curve: Float[np.ndarray, " t"], values: Mapping[str, float]) -> Float[np.ndarray, " n"]:
        """A curve over the area's clock at the frames.

        Where the lag is not the one taken, the curve is shifted (monotone cubic in time), not the measured force: its
        noise must not be interpolated anew at each trial value.
        """
        shift = self.taken - values.get(LAG, self.taken)
        if shift == 0.0:
            return np.asarray(np.interp(self.frames, self.evolution.time, curve))
        return np.asarray(PchipInterpolator(self.evolution.time, curve)(self.frames + shift), float)

    def force(self, values: Mapping[str, float]) -> Float[np.ndarray, " n"]:
        """Force at the frames [N]."""
        unit = self.per_modulus(values)
        if self.adhesion is None:
            return np.asarray(values[MODULUS] * unit)
        return self.adhesion.force(unit, self._pull(values, self.adhesion), values[MODULUS])

    def sticking(self, values: Mapping[str, float]) -> Adhesion | None:
        """What holds the bodies together, with the free work where it is one of `values`."""
        return None if self.adhesion is None else replace(self.adhesion, work=values.get(WORK, self.adhesion.work))

    def _pull(self, values: Mapping[str, float], adhesion: Adhesion) -> Float[np.ndarray, " n"]:
        evolution = self.evolution.with_offsets(values)
        area = evolution.within(values.get(THRESHOLD, self.threshold))
        sticks = replace(adhesion, work=values.get(WORK, adhesion.work))
        return self._at_frames(sticks.pull(area, evolution.radius), values)

    def predict(self, values: Mapping[str, float]) -> list[Float[np.ndarray, "_ c"]]:
        """The same as `least_squares.Predict` has it: one trial, one channel."""
        return [self.force(values)[:, None]]

    def refit(
        self, measured: Float[np.ndarray, "b n"], values: Mapping[str, float], bounds: tuple[float, float]
    ) -> Float[np.ndarray, "b 1"]:
        """E* of each row of forces by least squares; in closed form, as the law is linear in E*, or in its root too."""
        unit = self.per_modulus(values)
        if self.adhesion is None:
            return np.asarray(np.clip(measured @ unit / (unit @ unit), *bounds)[:, None])
        pull = self._pull(values, self.adhesion)
        found = [self.adhesion.refit(unit, pull, row) for row in measured]
        return np.asarray(np.clip(found, *bounds)[:, None])


Sensitivity = Callable[[Mapping[str, float]], Float[np.ndarray, " n"]]


def derivative(of: Sensitivity, values: Mapping[str, float], name: str, step: float) -> Float[np.ndarray, " n"]:
    """Central difference with respect to one named value."""
    ahead, behind = (of({**values, name: values[name] + way * step}) for way in (1.0, -1.0))
    return np.asarray((ahead - behind) / (2.0 * step))
