"""What simulated stances leave over at given numbers of the zones, in units of the noise, and its exact derivatives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.calibration.sole_residuals import NO_BALANCE, by_channel
from geocontact.below_knee_prosthesis.calibration.walked_stance import WalkedStance
from geocontact.below_knee_prosthesis.calibration.whole_stance import ShownStance, WholeStance
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot
from geocontact.identify.optimise.least_squares import divided


class WholeResiduals:
    """Residuals of all stances as functions of the logarithms of the numbers over the usual ones.

    Parameters
    ----------
    foot
        With the usual law.
    begun
        Logarithms at which the noise is taken: what errors of start and angles make of each sample, by a difference.
    """

    def __init__(
        self,
        stances: Sequence[WalkedStance],
        foot: VariableStiffnessFoot,
        begun: Float[np.ndarray, " p"],
        *,
        machine_code: bool = True,
    ) -> None:
        self.foot, self.zones = foot, ZoneParameters(foot.sole, foot.law)
        self.wholes = [WholeStance(each, foot, machine_code=machine_code) for each in stances]
        self.noise = [noise_of(each, self.at(begun), machine_code=machine_code) for each in self.wholes]
        self.last: tuple[Float[np.ndarray, " p"], list[ShownStance | None]] | None = None
        self.solved = 0

    @property
    def sd(self) -> Float[np.ndarray, " p"]:
        """Of the logarithms, beforehand."""
        return self.zones.sd

    def values(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " p"]:
        """The numbers."""
        return np.asarray(self.zones.values_of(self.zones.usual) * np.exp(z))

    def at(self, z: Float[np.ndarray, " p"]) -> VariableStiffnessFoot:
        """The foot with these numbers."""
        return VariableStiffnessFoot(self.foot.keel, self.foot.sole, self.zones.law(self.values(z)))

    def shown(self, z: Float[np.ndarray, " p"]) -> list[ShownStance | None]:
        """Each simulated stance; None where its motion cannot go on."""
        if self.last is None or not np.array_equal(self.last[0], z):
            self.last = z.copy(), [self._one(each, self.at(z)) for each in self.wholes]
        return self.last[1]

    def _one(self, whole: WholeStance, foot: VariableStiffnessFoot) -> ShownStance | None:
        self.solved += 1
        try:
            return whole.shown(foot)
        except ArithmeticError:
            return None

    def of_data(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
        """Predicted less measured over the noise, stance by stance, frame by frame."""
        parts = []
        for whole, noise, shown in zip(self.wholes, self.noise, self.shown(z), strict=True):
            measured = whole.stance.recorded.measured / noise
            if shown is None:
                parts.append(np.full(int(np.isfinite(measured).sum()), NO_BALANCE))
            else:
                parts.append(divided(whole.channels(shown) / noise, measured, np.ones(noise.shape[1])))
        return np.concatenate(parts)

    def slope_of_data(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "n p"]:
        """Derivatives of `of_data` by the logarithms; 0 where it has none."""
        parts, chain = [], self.chain(z)
        for whole, noise, shown in zip(self.wholes, self.noise, self.shown(z), strict=True):
            there = np.isfinite(whole.stance.recorded.measured)
            if shown is None:
                parts.append(np.zeros((int(there.sum()), len(z))))
            else:
                parts.append((whole.slope(shown, chain) / noise[..., None])[there])
        return np.concatenate(parts)

    def chain(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "n p"]:
        """Derivatives of stiffness, damping, static and kinetic friction by zone by the logarithms."""
        values, zones = self.values(z), len(self.zones.zones)
        static = self.zones.law(values).static
        own = [np.asarray(static)[np.flatnonzero(of)[0]] for of in self.zones.sole.spheres.zones.values()]
        chain = np.zeros((4 * zones, len(z)))
        at = np.arange(zones)
        for row, column, by in ((0, 0, values[:zones]), (1, 1, values[zones : 2 * zones]), (2, 2, np.array(own))):
            chain[row * zones + at, column * zones + at] = by
        chain[3 * zones + at, 2 * zones + at] = values[2 * zones :]
        return chain

    def __call__(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " m"]:
        """Those of the data, then what the numbers differ from the usual ones in standard deviations beforehand."""
        return np.concatenate([self.of_data(z), z / self.zones.sd])

    def slope(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "m p"]:
        """Derivatives of `__call__` by the logarithms."""
        return np.vstack([self.slope_of_data(z), np.diag(1.0 / self.zones.sd)])

    def channel_by_channel(self) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]:
        """Times of the data's residuals in that order [s], a pause after each channel, and the residuals' places."""
        recorded = [each.stance.recorded for each in self.wholes]
        return by_channel([each.time for each in recorded], [each.measured for each in recorded])

    def slid(self, z: Float[np.ndarray, " p"]) -> Iterator[tuple[RecordedStance, KeelMotion]]:
        """Each stance, and the keel along it."""
        for whole, shown in zip(self.wholes, self.shown(z), strict=True):
            if shown is not None:
                yield whole.stance.recorded, whole.keel_motion(shown, self.at(z))


def noise_of(whole: WholeStance, foot: VariableStiffnessFoot, *, machine_code: bool) -> Float[np.ndarray, "t 4"]:
    """Standard deviation of measured less predicted: the plate's, and what errors of start and angles make.

    ArithmeticError where the motion cannot go on.
    """
    recorded = whole.stance.recorded
    e, pressing = recorded.errors, np.maximum(recorded.force[:, 1], 1.0)
    plate = np.full((len(recorded.time), 3), e.force)
    square = np.column_stack([plate, e.couple / pressing / foot.keel.length]) ** 2
    base = whole.channels(whole.shown(foot))
    for moved in whole.stance.moved():
        there = WholeStance(moved, foot, machine_code=machine_code)
        square += np.nan_to_num(there.channels(there.shown(foot)) - base) ** 2
    return np.asarray(np.sqrt(square))
