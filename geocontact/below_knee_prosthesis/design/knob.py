"""What is changed about the foot, and what comes of it: fulcrum, alignment, or stiffness of the keel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.carried_load import (
    REACH,
    CarriedLoad,
    with_angles_kept,
    with_torque_kept,
)
from geocontact.below_knee_prosthesis.design.foot_map import FootMap, foot_map, needed
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, Aim, outcomes
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot

Vary = Literal["fulcrum", "alignment", "stiffness"]
Response = Literal["angles kept", "torque kept"]
RESPONSES: tuple[Response, ...] = ("angles kept", "torque kept")
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
    """

    vary: Vary
    settings: Float[np.ndarray, " n"]
    fulcrum: float

    @property
    def present(self) -> float:
        """Value that the stance was recorded with."""
        return {"fulcrum": self.fulcrum, "alignment": 0.0, "stiffness": 1.0}[self.vary]

    def maps(self, foot: VariableStiffnessFoot, task: FootTask) -> tuple[FootMap, ...]:
        """Of each value, the present one last, for stances not much beyond this one; ArithmeticError as `foot_map`."""
        reach = REACH + (float(np.abs(self.settings).max()) if self.vary == "alignment" else 0.0)
        rows = needed(task.pitch, task.load, reach)
        if self.vary == "alignment":
            return (foot_map(foot.at(self.fulcrum), *rows),) * (len(self.settings) + 1)
        found = []
        for value in (*self.settings, self.present):
            keel, fulcrum = foot.keel, value
            if self.vary == "stiffness":
                keel, fulcrum = replace(keel, bending=value * keel.bending), self.fulcrum
            changed = VariableStiffnessFoot(keel, foot.sole, foot.law)
            found.append(foot_map(changed.at(float(fulcrum)), *rows))
        return tuple(found)

    def carried(self, maps: Sequence[FootMap], task: FootTask) -> Mapping[Response, tuple[CarriedLoad, ...]]:
        """The foot along the stance at each value, for both responses of the person."""
        moment = with_angles_kept(maps[-1], task).ankle_moment
        tasks = [task.aligned(value) if self.vary == "alignment" else task for value in self.settings]
        pairs = list(zip(maps[:-1], tasks, strict=True))
        return {
            "angles kept": tuple(with_angles_kept(*each) for each in pairs),
            "torque kept": tuple(with_torque_kept(*each, moment) for each in pairs),
        }

    def measured(self, maps: Sequence[FootMap], task: FootTask) -> Float[np.ndarray, "two n aims"]:
        """Outcomes by response, value and `AIMS`."""
        found = self.carried(maps, task)
        rows = [[[outcomes(each)[aim] for aim in AIMS] for each in found[response]] for response in RESPONSES]
        return np.array(rows)
