"""A motion that stands up, as OpenSim's Moco reads it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.io.opensim.moco_trajectory_writer import write_moco_trajectory
from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.exoskeleton import EXO_JOINTS


def write_solution(file: Path, trial: TrialResult, solved: bool) -> None:
    """The motion at its collocation points as OpenSim's Moco reads it; torques are those of both legs [N m].

    At these points it solves the equations; at the recording's own times something is left of the balance.
    """
    q, u = trial.points.q, trial.points.u
    names = (*COORDINATES, *(EXO_JOINTS if q.shape[1] > len(COORDINATES) else ()))

    def paths(ending: str, values: Float[np.ndarray, "t n"]) -> dict[str, Float[np.ndarray, " t"]]:
        return {f"/jointset/{name}/{name}/{ending}": values[:, k] for k, name in enumerate(names)}

    states = paths("value", q) | paths("speed", u)
    torque = np.zeros((len(q), 0)) if trial.points.torque is None else trial.points.torque
    controls = {f"/forceset/{name}_torque": column for name, column in zip(names[3:], torque.T, strict=True)}
    write_moco_trajectory(file, trial.points.time, states, controls, paths("accel", trial.acceleration), solved)
