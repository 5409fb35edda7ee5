"""What the whole model shows of a stance at given numbers of the sole, and its exact derivatives by them.

The motion is simulated as `simulate` does; its derivatives are those of its variational equations
(`dynamics.variation`), and what the plate shows is differentiated in symbols.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.calibration.walked_stance import WalkedStance
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.model.stance_model import (
    FLOOR,
    StanceModel,
    sole_places,
    stance_model,
    stance_numbers,
)
from geocontact.below_knee_prosthesis.simulate import FIRST, GATE, TOLERANCE, recorded_start, told_at
from geocontact.dynamics.variation import Variation, nodes_of

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
        self.tools = _tools(self.model, sole_places(foot.keel), machine_code)
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
        told = told_at(self.model, *self._arguments(shown.x, shown.p))
        n = len(self.model.equations.names)
        angles, speeds = shown.x[:, n - foot.keel.joints : n], shown.x[:, 2 * n - foot.keel.joints : 2 * n]
        return foot.at(self.stance.recorded.fulcrum).at(angles, speeds, told.poses, FLOOR, told.rate)

    def _along(self) -> tuple[Float[np.ndarray, "t 3"], Float[np.ndarray, " t"]]:
        """The recorded keel's direction, and its end along it [m]."""
        poses = self.stance.recorded.poses
        forward = poses.rotation.apply([1.0, 0.0, 0.0])
        return forward, np.einsum("ti,ti->t", forward, poses.translation)

    def _arguments(self, x: Float[np.ndarray, "t x"], p: Float[np.ndarray, " p"]) -> tuple[np.ndarray, ...]:
        """Of the functions of a state, at the samples."""
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
