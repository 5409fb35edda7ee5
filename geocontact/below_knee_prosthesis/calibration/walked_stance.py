"""A recorded stance that the whole model walks: inertia, socket and the pelvis' free place besides the sole."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.model.foot_offset import FootOffset
from geocontact.below_knee_prosthesis.model.leg_motion import LegMotion, driving_inputs
from geocontact.below_knee_prosthesis.model.leg_tree import HIP, KNEE, PELVIS, RECORDED
from geocontact.below_knee_prosthesis.simulate import Push
from geocontact.contact.bushing import SOCKET, Bushing
from geocontact.dynamics.recorded_inputs import RecordedInputs

ANGLE = np.radians(0.4)
"""rad; standard deviation of each turn of hip and knee, constant over the stance; invented. Pitch is 0.55° off."""
LEAD = 12
"""Samples that are simulated before the first that is compared, where the recording has them."""


@dataclass(frozen=True, eq=False)
class WalkedStance:
    """As of a right leg.

    Parameters
    ----------
    recorded
        Plate and poses of the foot by its markers, at even times; its errors are those of the start: height of the
        pelvis and its speed.
    motion
        Angles of pelvis, hip and knee.
    push
        Of the other leg.
    """

    recorded: RecordedStance
    motion: LegMotion
    push: Push
    bushing: Bushing = SOCKET

    @property
    def lead(self) -> int:
        """Samples before the first that is compared."""
        step = self.recorded.time[1] - self.recorded.time[0]
        room = int((self.recorded.time[0] - self.motion.time[0]) / step) - 2
        return int(np.clip(room, 0, LEAD))

    @property
    def begin(self) -> float:
        """When the simulation starts [s]."""
        time = self.recorded.time
        return float(time[0] - self.lead * (time[1] - time[0]))

    def inputs(self) -> RecordedInputs:
        """Of the equations."""
        return driving_inputs(self.motion, self.push.at(self.motion.time))

    def with_foot(self, offset: FootOffset) -> WalkedStance:
        """With the foot beside its standing trial; the recorded poses stay as they are."""
        return replace(self, motion=replace(self.motion, leg=self.motion.leg.with_foot(offset)))

    def moved(self) -> Iterator[WalkedStance]:
        """By one standard deviation of each error of the motion: height, speed, each turn of hip and knee."""
        e, since = self.recorded.errors, self.motion.time - self.recorded.time[0]
        shifts = [(PELVIS[4], np.full(len(since), e.height))]
        shifts += [(name, e.speed * since) for name in PELVIS[3:]]
        shifts += [(name, np.full(len(since), ANGLE)) for name in (*HIP, *KNEE)]
        for name, by in shifts:
            values = self.motion.values.copy()
            values[:, RECORDED.index(name)] += by
            yield replace(self, motion=LegMotion(self.motion.leg, self.motion.time, values))
