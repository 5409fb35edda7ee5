"""What recorded stances leave over at given numbers of the zones, in units of the noise, and its derivatives.

Below its threshold speed, some millimetres a second, friction is proportional to the speed of slipping: far less than
markers tell. So the recorded speed is taken as known up to its error, and in every frame the correction is sought with
which the model's force along the floor is the plate's. It counts as a residual, in units of that error. Friction is
identified by it only where a foot slips in earnest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from geocontact.below_knee_prosthesis.calibration.recorded_stance import (
    RecordedStance,
    sizes_by_trial,
    standing_trials,
)
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel
from geocontact.identify.optimise.least_squares import divided

ALONG = (0, 2)
"""Axes of the floor."""
PRESSED, MOST = 20.0, 4.0
"""N, below which nothing is corrected, and most of a correction in units of the speed's error."""


def slipping(
    stance: RecordedStance, keel: QuasiStaticKeel, slip: Float[np.ndarray, "t 2"], turns: int
) -> tuple[KeelMotion, Float[np.ndarray, "t 2"]]:
    """Motion of the keel and the correction [m/s] after some turns from another correction.

    ArithmeticError where the keel finds no equilibrium.
    """
    motion = with_slip(stance, slip).solved(keel)
    for _ in range(turns):
        pressing = motion.loads.pressing
        whole = pressing.sum(axis=1)
        slope = (pressing @ np.broadcast_to(keel.law.kinetic, pressing.shape[1])) / keel.law.threshold_speed
        lacking = (stance.force - motion.force)[:, ALONG]
        step = np.where((whole > PRESSED)[:, None], -lacking / np.maximum(slope, 1e-9)[:, None], 0.0)
        most = MOST * stance.errors.speed
        slip = np.clip(slip + step, -most, most)
        motion = with_slip(stance, slip).solved(keel)
    return motion, slip


def with_slip(stance: RecordedStance, slip: Float[np.ndarray, "t 2"]) -> RecordedStance:
    """The stance with its speed along the floor corrected."""
    rate = stance.rate.copy()
    rate[:, ALONG, 3] += slip
    return replace(stance, rate=rate)


STEP = 1e-5
"""Step of a logarithm, for differences."""
FIRST, AGAIN = 6, 4
"""Turns of the search for the slip: at the usual numbers, and from there at any others."""
FARTHEST = 5.0
"""Standard deviations that height and pitch may be off."""
NO_BALANCE = 100.0
"""Residual, in units of the noise, of a stance along which the keel finds no equilibrium."""

PAUSE = 1000.0
"""Lengths of a stance between channels, so that none remembers another."""


@dataclass(eq=False)
class SoleResiduals:
    """Residuals of all stances as functions of what is sought.

    That is the logarithms of the numbers over the usual ones, then of each standing trial the errors of the foot's
    height and of its pitch in standard deviations (`Errors`); where the latter are left out, poses are as recorded.
    Every search for a slip starts from that of the usual numbers, so that residuals hang on nothing but their argument.

    Parameters
    ----------
    noise
        Of each stance, in the channels' units, the two of the slip last.
    slips
        Correction of each stance's speed along the floor at the usual numbers [m/s].
    solved
        How often the keel was solved along a stance.
    """

    stances: Sequence[RecordedStance]
    foot: VariableStiffnessFoot
    zones: ZoneParameters
    noise: list[Float[np.ndarray, "_ c"]]
    slips: list[Float[np.ndarray, "_ 2"]]
    solved: int = 0

    @classmethod
    def of(cls, stances: Sequence[RecordedStance], foot: VariableStiffnessFoot) -> SoleResiduals:
        """Around the foot's law, with the noise at it."""
        noise, slips = [], []
        for stance in stances:
            keel = foot.at(stance.fulcrum)
            still = np.zeros((len(stance.time), 2))
            slips.append(slipping(stance, keel, still, FIRST)[1])
            noise.append(np.hstack([with_slip(stance, slips[-1]).noise(keel), still + stance.errors.speed]))
        return cls(stances, foot, ZoneParameters(foot.sole, foot.law), noise, slips)

    @property
    def sd(self) -> Float[np.ndarray, " p"]:
        """Standard deviation of everything that is sought, beforehand."""
        return np.concatenate([self.zones.sd, np.ones(len(self.sizes))])

    @property
    def sizes(self) -> Float[np.ndarray, " a"]:
        """One standard deviation of height [m] and pitch [rad] beforehand, by standing trial."""
        return sizes_by_trial(self.stances)

    @property
    def standing(self) -> tuple[int, ...]:
        """Number of the standing trial of each stance."""
        return standing_trials(self.stances)

    @property
    def reach(self) -> Float[np.ndarray, " p"]:
        """Reach of everything that is sought, to either bound."""
        return np.concatenate([self.zones.reach, np.full(len(self.sizes), FARTHEST)])

    def values(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " k"]:
        """The numbers."""
        usual = self.zones.values_of(self.zones.usual)
        return np.asarray(usual * np.exp(z[: len(usual)]))

    def errors(self, z: Float[np.ndarray, " p"], place: int) -> tuple[float, float]:
        """Errors of height [m] and pitch [rad] of one stance."""
        aside = z[len(self.zones.names) :].reshape(-1, 2)
        height, pitch = aside[self.standing[place]] if len(aside) else (0.0, 0.0)
        e = self.stances[place].errors
        return e.standing * float(height), e.pitch * float(pitch)

    def stance(self, z: Float[np.ndarray, " p"], place: int) -> RecordedStance:
        """One stance without the errors of its height and pitch."""
        return self.stances[place].moved(*self.errors(z, place))

    def keel(self, z: Float[np.ndarray, " p"], stance: RecordedStance) -> QuasiStaticKeel:
        """With these numbers at the stance's fulcrum."""
        law = self.zones.law(self.values(z))
        return QuasiStaticKeel(self.foot.keel, stance.fulcrum, self.foot.sole, law)

    def motion(self, z: Float[np.ndarray, " p"], place: int) -> tuple[KeelMotion, Float[np.ndarray, "t 2"]]:
        """Along one stance, and its slip [m/s]; ArithmeticError where the keel finds no equilibrium."""
        self.solved += 1 + AGAIN
        stance = self.stance(z, place)
        return slipping(stance, self.keel(z, stance), self.slips[place], AGAIN)

    def of_data(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
        """Predicted less measured over the noise, stance by stance, frame by frame."""
        parts = []
        for place, noise in enumerate(self.noise):
            stance = self.stance(z, place)
            measured = self.measured(place) / noise
            try:
                motion, slip = self.motion(z, place)
            except ArithmeticError:
                parts.append(np.full(int(np.isfinite(measured).sum()), NO_BALANCE))
                continue
            predicted = np.hstack([stance.predicted(self.keel(z, stance), motion), slip]) / noise
            parts.append(divided(predicted, measured, np.ones(noise.shape[1])))
        return np.concatenate(parts)

    def measured(self, place: int) -> Float[np.ndarray, "t c"]:
        """Channels of one stance, no slip last."""
        stance = self.stances[place]
        return np.hstack([stance.measured, np.zeros((len(stance.time), 2))])

    def __call__(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " m"]:
        """Those of the data, then what everything differs from the usual in standard deviations beforehand."""
        return np.concatenate([self.of_data(z), z / self.sd[: len(z)]])

    def slope(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "m p"]:
        """Derivatives of `__call__` by the logarithms."""
        return np.vstack([self.slope_of_data(z), np.diag(1.0 / self.sd[: len(z)])])

    def slope_of_data(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "n p"]:
        """Derivatives of `of_data` by the logarithms, by one-sided differences."""
        base = self.of_data(z)
        return np.stack([(self.of_data(z + STEP * unit) - base) / STEP for unit in np.eye(len(z))], axis=1)

    def channel_by_channel(self) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]:
        """Times of the data's residuals in that order [s], a pause after each channel, and the residuals' places."""
        return by_channel(
            [stance.time for stance in self.stances], [self.measured(k) for k in range(len(self.stances))]
        )

    def slid(self, z: Float[np.ndarray, " p"]) -> Iterator[tuple[RecordedStance, KeelMotion]]:
        """Each stance, and the keel along it."""
        for place in range(len(self.stances)):
            yield self.stance(z, place), self.motion(z, place)[0]


def by_channel(
    times: Sequence[Float[np.ndarray, " _"]], measured: Sequence[Float[np.ndarray, "_ c"]]
) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    """Times of what was measured, channel by channel [s], a pause after each, and its places frame by frame."""
    found, places, first, late = [], [], 0, 0.0
    for time, of in zip(times, measured, strict=True):
        there = np.isfinite(of)
        number = np.full(there.shape, -1)
        number[there] = first + np.arange(int(there.sum()))
        first += int(there.sum())
        for column, on in zip(number.T, there.T, strict=True):
            found.append(time[on] - time[0] + late)
            places.append(column[on])
            late += PAUSE * float(time[-1] - time[0])
    return np.concatenate(found), np.concatenate(places)
