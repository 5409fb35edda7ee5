"""What simulated stances leave over at given numbers of the zones, in units of the noise, and its derivatives.

Those by the numbers of the zones are exact; those by height and pitch of the foot are differences.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.calibration.sole_residuals import FARTHEST, NO_BALANCE, by_channel
from geocontact.below_knee_prosthesis.calibration.walked_stance import WalkedStance
from geocontact.below_knee_prosthesis.calibration.whole_stance import ShownStance, WholeStance
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.model.foot_offset import FootOffset
from geocontact.identify.optimise.least_squares import divided

ASIDE = 0.2
"""Standard deviations of height and pitch, for differences: a tenth of a degree, far above what steps leave."""


class WholeResiduals:
    """Residuals of all stances as functions of what is sought.

    That is the logarithms of the numbers over the usual ones, then of each stance height and pitch of the foot beside
    its standing trial in standard deviations (`Errors`); where the latter are left out, the foot is as it stood.

    Parameters
    ----------
    stances
        With the leg as its standing trial has it.
    foot
        With the usual law.
    begun
        At which the noise is taken: what errors of start and angles make of each sample, by a difference.
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
        self.machine_code = machine_code
        self.noise = [noise_of(self.whole(begun, k), self.at(begun)) for k in range(len(self.wholes))]
        self.last: tuple[Float[np.ndarray, " p"], list[ShownStance | None]] | None = None
        self.solved = 0

    @property
    def sd(self) -> Float[np.ndarray, " p"]:
        """Of everything that is sought, beforehand."""
        return np.concatenate([self.zones.sd, np.ones(2 * len(self.wholes))])

    @property
    def sizes(self) -> Float[np.ndarray, " a"]:
        """One standard deviation of height [m] and pitch [rad] beforehand, stance by stance."""
        errors = [each.stance.recorded.errors for each in self.wholes]
        return np.array([[e.standing, e.pitch] for e in errors]).ravel()

    @property
    def reach(self) -> Float[np.ndarray, " p"]:
        """Of everything that is sought, to either bound."""
        return np.concatenate([self.zones.reach, np.full(2 * len(self.wholes), FARTHEST)])

    def values(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " k"]:
        """The numbers."""
        usual = self.zones.values_of(self.zones.usual)
        return np.asarray(usual * np.exp(z[: len(usual)]))

    def whole(self, z: Float[np.ndarray, " p"], place: int) -> WholeStance:
        """One stance with the foot beside its standing trial."""
        one, aside = self.wholes[place], z[len(self.zones.names) :].reshape(-1, 2)
        if not len(aside) or not aside[place].any():
            return one
        height, pitch = aside[place] * self.sizes.reshape(-1, 2)[place]
        stance = one.stance.with_foot(FootOffset(float(height), float(pitch)))
        return WholeStance(stance, self.foot, machine_code=self.machine_code)

    def at(self, z: Float[np.ndarray, " p"]) -> VariableStiffnessFoot:
        """The foot with these numbers."""
        return VariableStiffnessFoot(self.foot.keel, self.foot.sole, self.zones.law(self.values(z)))

    def shown(self, z: Float[np.ndarray, " p"]) -> list[ShownStance | None]:
        """Each simulated stance; None where its motion cannot go on."""
        if self.last is None or not np.array_equal(self.last[0], z):
            self.last = z.copy(), [self._one(self.whole(z, k), self.at(z)) for k in range(len(self.wholes))]
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
        """Derivatives of `of_data` by all that is sought; 0 where it has none."""
        parts, chain = [], self.chain(z)
        for place, (noise, shown) in enumerate(zip(self.noise, self.shown(z), strict=True)):
            whole = self.whole(z, place)
            there = np.isfinite(whole.stance.recorded.measured)
            if shown is None:
                parts.append(np.zeros((int(there.sum()), len(z))))
            else:
                slope = np.concatenate([whole.slope(shown, chain), self._aside(z, place, shown)], axis=2)
                parts.append((slope / noise[..., None])[there])
        return np.concatenate(parts)

    def _aside(self, z: Float[np.ndarray, " p"], place: int, shown: ShownStance) -> Float[np.ndarray, "t 4 a"]:
        """Of the channels of one stance by height and pitch of all, by one-sided differences."""
        count = len(self.zones.names)
        found = np.zeros((*self.noise[place].shape, len(z) - count))
        base = self.whole(z, place).channels(shown)
        for k in (2 * place, 2 * place + 1) if len(z) > count else ():
            there = z.copy()
            there[count + k] += ASIDE
            other = self.whole(there, place)
            if (moved := self._one(other, self.at(z))) is not None:
                found[..., k] = np.nan_to_num(other.channels(moved) - base) / ASIDE
        return found

    def chain(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "n p"]:
        """Derivatives of stiffness, damping, static and kinetic friction by zone by the logarithms."""
        values, zones = self.values(z), len(self.zones.zones)
        static = self.zones.law(values).static
        own = [np.asarray(static)[np.flatnonzero(of)[0]] for of in self.zones.sole.spheres.zones.values()]
        chain = np.zeros((4 * zones, 3 * zones))
        at = np.arange(zones)
        for row, column, by in ((0, 0, values[:zones]), (1, 1, values[zones : 2 * zones]), (2, 2, np.array(own))):
            chain[row * zones + at, column * zones + at] = by
        chain[3 * zones + at, 2 * zones + at] = values[2 * zones :]
        return chain

    def __call__(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " m"]:
        """Those of the data, then what everything differs from the usual in standard deviations beforehand."""
        return np.concatenate([self.of_data(z), z / self.sd[: len(z)]])

    def slope(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "m p"]:
        """Derivatives of `__call__`."""
        return np.vstack([self.slope_of_data(z), np.diag(1.0 / self.sd[: len(z)])])

    def channel_by_channel(self) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]:
        """Times of the data's residuals in that order [s], a pause after each channel, and the residuals' places."""
        recorded = [each.stance.recorded for each in self.wholes]
        return by_channel([each.time for each in recorded], [each.measured for each in recorded])

    def slid(self, z: Float[np.ndarray, " p"]) -> Iterator[tuple[RecordedStance, KeelMotion]]:
        """Each stance, and the keel along it."""
        for place, shown in enumerate(self.shown(z)):
            if shown is not None:
                whole = self.whole(z, place)
                yield whole.stance.recorded, whole.keel_motion(shown, self.at(z))


def noise_of(whole: WholeStance, foot: VariableStiffnessFoot) -> Float[np.ndarray, "t 4"]:
    """Standard deviation of measured less predicted: the plate's, and what errors of start and angles make.

    ArithmeticError where the motion cannot go on.
    """
    recorded = whole.stance.recorded
    e, pressing = recorded.errors, np.maximum(recorded.force[:, 1], 1.0)
    plate = np.full((len(recorded.time), 3), e.force)
    square = np.column_stack([plate, e.couple / pressing / foot.keel.length]) ** 2
    base = whole.channels(whole.shown(foot))
    for moved in whole.stance.moved():
        there = WholeStance(moved, foot, machine_code=whole.machine_code)
        square += np.nan_to_num(there.channels(there.shown(foot)) - base) ** 2
    return np.asarray(np.sqrt(square))
