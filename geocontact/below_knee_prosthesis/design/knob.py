"""What is changed about the foot, and what comes of it: fulcrum, alignment, or stiffness of the keel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.aims import Aim
from geocontact.below_knee_prosthesis.design.foot_map import (
    REACH,
    CarriedLoad,
    FootMap,
    carried,
    feet_on_ground,
    foot_map,
    needed,
    with_angles_kept,
    with_torque_kept,
)
from geocontact.below_knee_prosthesis.design.foot_task import LEVEL, FootTask, Terrain
from geocontact.below_knee_prosthesis.design.joint_torques_kept import OtherFeet, curve, recorded_motion, stacked
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, outcomes
from geocontact.below_knee_prosthesis.evaluation import at_times
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel

Vary = Literal["fulcrum", "alignment", "stiffness"]
Response = Literal["angles kept", "torque kept", "joint torques kept"]
RESPONSES: tuple[Response, ...] = ("angles kept", "torque kept", "joint torques kept")
"""Responses of the person: angles of all joints, the ankle's torque without inertia, torques of hip and knee with
it."""
JUDGED = RESPONSES[:2]
"""Those that a best value has to hold for; the third is reported beside it."""
AIMS: tuple[Aim, ...] = tuple(MEASURES)


@dataclass(frozen=True, eq=False)
class Knob:
    """Values of one thing that is changed, all else as it is.

    Parameters
    ----------
    vary
        Fulcrum [m], alignment [rad] (toes up against the socket), or stiffness (factor on the keel's EI).
    settings
        Its values, increasing.
    fulcrum
        That the stance was recorded on [m], which stays where something else is varied.
    terrain
        That the values are judged on; the stance was recorded on level ground.
    turned
        Alignment that goes with every value [rad]; where alignment itself is varied its values stand for it.
    """

    vary: Vary
    settings: Float[np.ndarray, " n"]
    fulcrum: float
    terrain: Terrain = LEVEL
    turned: float = 0.0

    @property
    def alignments(self) -> Float[np.ndarray, " n"]:
        """Alignment of each value [rad]."""
        return self.settings if self.vary == "alignment" else np.full(len(self.settings), self.turned)

    @property
    def present(self) -> float:
        """Value that the stance was recorded with."""
        return {"fulcrum": self.fulcrum, "alignment": 0.0, "stiffness": 1.0}[self.vary]

    def maps(self, foot: VariableStiffnessFoot, task: FootTask) -> tuple[FootMap, ...]:
        """Maps of each value on the terrain, the present one on level ground last, for stances not much beyond this
        one.

        ArithmeticError as `foot_map`.
        """
        reach = REACH + float(np.abs(self.alignments).max())
        met = self.terrain.met(task)
        rows, level = needed(met.pitch, met.load, reach), needed(task.pitch, task.load, REACH)
        if self.vary == "alignment":
            one = foot_map(foot.at(self.fulcrum), *rows, self.terrain)
            found = [one] * len(self.settings)
            return (*found, one if self.terrain == LEVEL else foot_map(foot.at(self.fulcrum), *level))
        found = [foot_map(self._changed(foot, float(value)), *rows, self.terrain) for value in self.settings]
        return (*found, foot_map(self._changed(foot, self.present), *level))

    def _changed(self, foot: VariableStiffnessFoot, value: float) -> QuasiStaticKeel:
        keel, fulcrum = foot.keel, value
        if self.vary == "stiffness":
            keel, fulcrum = replace(keel, bending=value * keel.bending), self.fulcrum
        return replace(foot, keel=keel).at(fulcrum)

    def carried(self, maps: Sequence[FootMap], task: FootTask) -> Mapping[Response, tuple[CarriedLoad, ...]]:
        """The foot along the stance at each value, for each response of the person."""
        return {**self.still(maps, task), "joint torques kept": self._moved(maps, task, self._tasks(task))}

    def still(self, maps: Sequence[FootMap], task: FootTask) -> Mapping[Response, tuple[CarriedLoad, ...]]:
        """The same for the responses without inertia, which are `JUDGED`."""
        moment = with_angles_kept(maps[-1], task).ankle_moment
        pairs = list(zip(maps[:-1], self._tasks(task), strict=True))
        return {
            "angles kept": tuple(with_angles_kept(*each) for each in pairs),
            "torque kept": tuple(with_torque_kept(*each, moment) for each in pairs),
        }

    def _tasks(self, task: FootTask) -> list[FootTask]:
        met = self.terrain.met(task)
        return [met.aligned(float(angle)) for angle in self.alignments]

    def other_feet(self, maps: Sequence[FootMap], task: FootTask, tracking: float = 1.0) -> OtherFeet:
        """What the leg stands on at each value with its joint torques kept."""
        turn = self.alignments
        legs = [task.leg.aligned(float(angle), task.ankle[:2]) for angle in turn]
        recorded, met = recorded_motion(maps[-1], task), self.terrain.met(task)
        forward = curve(recorded.time, met.time, met.forward)
        feet, start = feet_on_ground(maps[:-1]), float(met.load[0])
        return OtherFeet(recorded, feet, stacked(legs), turn, self.terrain.slope, start, forward, tracking)

    def _moved(self, maps: Sequence[FootMap], task: FootTask, tasks: Sequence[FootTask]) -> tuple[CarriedLoad, ...]:
        """Hip and knee torques are those of the present foot with angles kept, and of the tracking.

        What drives the motion, `RecordedLeg.driven`, are the first: at the hip of the shipped stance within 5 N m root
        mean square over its first 0.1 s, and 2 N m at its frames after.
        """
        moved, kept = self.other_feet(maps, task).moved(), with_angles_kept(maps[-1], task).leg_torques
        found = []
        for k, (foot, own) in enumerate(zip(maps[:-1], tasks, strict=True)):
            columns = np.column_stack(
                [moved.off[:, k, 2:], moved.load[:, k], moved.forward[:, k], moved.tracking[:, k]]
            )
            thigh, tilt, load, forward, *tracking = at_times(own.time, moved.time, columns).T
            one = replace(own, load=load, forward=forward, thigh=own.thigh + thigh)
            found.append(carried(foot, one, tilt, 1.0).with_torques(kept + np.column_stack(tracking)))
        return tuple(found)

    def measured(self, maps: Sequence[FootMap], task: FootTask) -> Float[np.ndarray, "responses n aims"]:
        """Outcomes by response, value and `AIMS`."""
        return _numbers(self.carried(maps, task))

    def measured_still(self, maps: Sequence[FootMap], task: FootTask) -> Float[np.ndarray, "judged n aims"]:
        """The same for `JUDGED`."""
        return _numbers(self.still(maps, task))


def _numbers(found: Mapping[Response, tuple[CarriedLoad, ...]]) -> Float[np.ndarray, "responses n aims"]:
    return np.array([[[outcomes(each)[aim] for aim in AIMS] for each in own] for own in found.values()])
