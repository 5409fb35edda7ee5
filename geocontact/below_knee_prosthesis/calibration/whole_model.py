"""Stances of the whole model at given numbers of the sole: exact derivatives, and residuals in units of the noise.

The motion is simulated as `simulate` does; its derivatives are those of its variational equations
(`dynamics.variation`), and what the plate shows is differentiated in symbols.

Those by the numbers of the zones are exact; those by height and pitch of the foot are differences.

Socket, inertia and the pelvis' free place act here, so that the force is what the simulation shows of the stance rather
than what the recorded poses press.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.below_knee_prosthesis.calibration.recorded_stance import (
    RecordedStance,
    WalkedStance,
    sizes_by_trial,
    standing_trials,
)
from geocontact.below_knee_prosthesis.calibration.sole_residuals import FARTHEST, NO_BALANCE, by_channel
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion
from geocontact.below_knee_prosthesis.leg import FootOffset
from geocontact.below_knee_prosthesis.simulate import FIRST, GATE, TOLERANCE, outputs_at, recorded_start
from geocontact.below_knee_prosthesis.stance_model import (
    FLOOR,
    StanceModel,
    sole_places,
    stance_model,
    stance_numbers,
)
from geocontact.dynamics.variation import Variation, nodes_of
from geocontact.identify.optimise.least_squares import divided

if TYPE_CHECKING:
    from casadi import Function


@dataclass(frozen=True, eq=False)
class ShownStance:
    """A simulated stance at the recording's times.

    Parameters
    ----------
    p
        Of the equations.
    x
        States.
    ends
        Of the steps [s].
    wrench
        Of the ground on the foot and its moment about the ground's origin [N, N m].
    """

    p: Float[np.ndarray, " p"]
    x: Float[np.ndarray, "t x"]
    ends: Float[np.ndarray, " s"]
    wrench: Float[np.ndarray, "t 6"]


class WholeStance:
    """One stance on the whole model, floor y = 0.

    Parameters
    ----------
    stance, foot
        Whose law gives way to that which is asked for.
    tolerance
        Of the steps.
    """

    def __init__(
        self,
        stance: WalkedStance,
        foot: VariableStiffnessFoot,
        *,
        tolerance: float = TOLERANCE,
        machine_code: bool = True,
    ) -> None:
        self.stance, self.foot, self.tolerance, self.machine_code = stance, foot, tolerance, machine_code
        self.model = stance_model(foot, machine_code=machine_code)
        self.tools = _tools(self.model, sole_places(foot), machine_code)
        self.inputs = stance.inputs()
        self.begin = stance.begin

    def shown(self, foot: VariableStiffnessFoot) -> ShownStance:
        """ArithmeticError where the motion cannot go on."""
        recorded = self.stance.recorded
        p = stance_numbers(self.stance.motion.leg, foot, recorded.fulcrum, self.stance.bushing)
        x, ends = self._moved(p, recorded.time)
        wrench = self.tools.wrench.map(len(x))(*self._arguments(x, p)).full().T
        return ShownStance(p, x, ends, wrench)

    def _moved(
        self, p: Float[np.ndarray, " p"], time: Float[np.ndarray, " t"]
    ) -> tuple[Float[np.ndarray, "t x"], Float[np.ndarray, " s"]]:
        """States at some times, and where steps end [s]; the steps do not depend on the times but for the last."""
        start = recorded_start(self.model, self.stance.motion, self.begin)
        wanted = np.concatenate([[self.begin], time])
        found = self.model.stepper.simulate(
            start, wanted, inputs=self.inputs, parameters=p, tolerance=self.tolerance, first=FIRST
        )
        return np.hstack([found.q, found.u, found.z])[1:], found.ends

    def channels(self, shown: ShownStance) -> Float[np.ndarray, "t 4"]:
        """Force, and centre of pressure from the heel over the keel's length; NaN where less than `GATE` presses."""
        force, moment = shown.wrench[:, :3], shown.wrench[:, 3:]
        forward, origin = self._along()
        up = np.where(force[:, 1] >= GATE, force[:, 1], np.nan)
        centre = (forward[:, 0] * moment[:, 2] - forward[:, 2] * moment[:, 0]) / up - origin
        return np.column_stack([force, centre / self.foot.keel.length])

    def slope(self, shown: ShownStance, chain: Float[np.ndarray, "p k"]) -> Float[np.ndarray, "t 4 k"]:
        """Derivatives of the channels.

        Parameters
        ----------
        chain
            Of the numbers of the sole (`stance_model.sole_places`) by what is sought.
        """
        times = np.unique(np.concatenate([[self.begin], shown.ends, self.stance.recorded.time]))
        when = nodes_of(times)
        states, _ = self._moved(shown.p, when)
        none = np.zeros((shown.x.shape[1], len(chain)))
        along = self.tools.variation.along(times, states, self.inputs.at(when), shown.p, none)
        by_numbers = along[np.searchsorted(times, self.stance.recorded.time)]
        by_x, by_p = (
            each.full().reshape(6, len(shown.x), -1).swapaxes(0, 1)
            for each in self.tools.slope.map(len(shown.x))(*self._arguments(shown.x, shown.p))
        )
        slope = (by_x @ by_numbers + by_p) @ chain
        force, moment = shown.wrench[:, :3], shown.wrench[:, 3:]
        forward, _ = self._along()
        with np.errstate(divide="ignore", invalid="ignore"):
            arm = (forward[:, 0] * moment[:, 2] - forward[:, 2] * moment[:, 0]) / force[:, 1]
            about = forward[:, :1] * slope[:, 5] - forward[:, 2:] * slope[:, 3] - arm[:, None] * slope[:, 1]
            centre = about / force[:, 1:2] / self.foot.keel.length
        centre[~(force[:, 1] >= GATE)] = 0.0
        return np.concatenate([slope[:, :3], centre[:, None]], axis=1)

    def keel_motion(self, shown: ShownStance, foot: VariableStiffnessFoot) -> KeelMotion:
        """What each sphere does."""
        outputs = outputs_at(self.model, *self._arguments(shown.x, shown.p))
        n = len(self.model.equations.names)
        angles, speeds = shown.x[:, n - foot.keel.hinges : n], shown.x[:, 2 * n - foot.keel.hinges : 2 * n]
        return foot.at(self.stance.recorded.fulcrum).at(angles, speeds, outputs.poses, FLOOR, outputs.rate)

    def _along(self) -> tuple[Float[np.ndarray, "t 3"], Float[np.ndarray, " t"]]:
        """The recorded keel's direction, and its end along it [m]."""
        poses = self.stance.recorded.poses
        forward = poses.rotation.apply([1.0, 0.0, 0.0])
        return forward, np.einsum("ti,ti->t", forward, poses.translation)

    def _arguments(self, x: Float[np.ndarray, "t x"], p: Float[np.ndarray, " p"]) -> tuple[np.ndarray, ...]:
        """Arguments of the functions of a state, at the samples."""
        n = len(self.model.equations.names)
        w = self.inputs.at(self.stance.recorded.time)
        return x[:, :n].T, x[:, n : 2 * n].T, x[:, 2 * n :].T, w.T, np.repeat(p[:, None], len(x), axis=1)


@dataclass(frozen=True, eq=False)
class _Tools:
    """Wrench of a state, its derivatives by state and numbers of the sole, and the motion's."""

    wrench: Function
    slope: Function
    variation: Variation


@lru_cache(maxsize=4)
def _tools(model: StanceModel, places: range, machine_code: bool) -> _Tools:
    from casadi import Function, densify, horzcat, jacobian

    e = model.equations
    by_x = horzcat(*(jacobian(model.on_sole, each) for each in (e.q, e.u, e.z)))
    by_p = jacobian(model.on_sole, e.p)[:, list(places)]
    wrench = Function("wrench", e.state, [densify(model.on_sole)])
    slope = Function("wrench_slope", e.state, [densify(by_x), densify(by_p)])
    return _Tools(wrench, slope, Variation(e, places, machine_code=machine_code))


ASIDE = 0.2
"""Standard deviations of height and pitch, for differences: a tenth of a degree, far above what steps leave."""


class WholeResiduals:
    """Residuals of all stances as functions of what is sought.

    That is the logarithms of the numbers over the usual ones, then height and pitch of the foot relative to each
    standing trial in standard deviations (`Errors`); where the latter are left out, the foot is as it stood.

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
        """Standard deviation of everything that is sought, beforehand."""
        return np.concatenate([self.zones.sd, np.ones(len(self.sizes))])

    @property
    def sizes(self) -> Float[np.ndarray, " a"]:
        """One standard deviation of height [m] and pitch [rad] beforehand, by standing trial."""
        return sizes_by_trial([each.stance.recorded for each in self.wholes])

    @property
    def standing(self) -> tuple[int, ...]:
        """Number of the standing trial of each stance."""
        return standing_trials([each.stance.recorded for each in self.wholes])

    @property
    def reach(self) -> Float[np.ndarray, " p"]:
        """Reach of everything that is sought, to either bound."""
        return np.concatenate([self.zones.reach, np.full(len(self.sizes), FARTHEST)])

    def values(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " k"]:
        """The numbers."""
        usual = self.zones.values_of(self.zones.usual)
        return np.asarray(usual * np.exp(z[: len(usual)]))

    def whole(self, z: Float[np.ndarray, " p"], place: int) -> WholeStance:
        """One stance with the foot beside its standing trial."""
        one, aside, trial = self.wholes[place], z[len(self.zones.names) :].reshape(-1, 2), self.standing[place]
        if not len(aside) or not aside[trial].any():
            return one
        height, pitch = aside[trial] * self.sizes.reshape(-1, 2)[trial]
        stance = one.stance.with_foot(FootOffset(float(height), float(pitch)))
        return WholeStance(stance, self.foot, machine_code=self.machine_code)

    def at(self, z: Float[np.ndarray, " p"]) -> VariableStiffnessFoot:
        """The foot with these numbers."""
        return replace(self.foot, law=self.zones.law(self.values(z)))

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
        """Derivatives of the channels of one stance by height and pitch of all, by one-sided differences."""
        count = len(self.zones.names)
        found = np.zeros((*self.noise[place].shape, len(z) - count))
        base = self.whole(z, place).channels(shown)
        trial = self.standing[place]
        for k in (2 * trial, 2 * trial + 1) if len(z) > count else ():
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

    def measured(self, place: int) -> Float[np.ndarray, "t c"]:
        """Channels of one stance."""
        return self.wholes[place].stance.recorded.measured

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
