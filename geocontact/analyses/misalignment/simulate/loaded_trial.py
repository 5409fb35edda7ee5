"""A trial that was made, with what its cuff passes to the forearm."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from geocontact.analyses.misalignment.law_numbers import MMHG
from geocontact.analyses.misalignment.simulate.options import SimulateOptions
from geocontact.axis_misalignment.synthetic import SyntheticElbowTrial, at_rest
from geocontact.axis_misalignment.transmission import CuffLoads, cuff_loads
from geocontact.data.elbow_recording import ElbowRecording


@dataclass(frozen=True, eq=False)
class LoadedTrial:
    """A recording, and the loads that go with its force and angle.

    Parameters
    ----------
    numbers
        Of the law in this trial, in SI.
    stroke
        Of the compensation joint [m]; None where it is locked.
    mean_pressure
        At which the stiffness is k [Pa].
    turning
        Stiffness of the cuff against turning [N m/rad].
    """

    recording: ElbowRecording
    loads: CuffLoads
    numbers: Mapping[str, float]
    stroke: tuple[float, float] | None
    mean_pressure: float
    turning: float

    def table(self) -> pd.DataFrame:
        """What was recorded, γ and the cuff's moment; with an actuator's torque what becomes of it."""
        r, loads = self.recording, self.loads
        columns = {"time [s]": r.time, "beta [deg]": np.degrees(r.beta), "force [N]": r.force}
        if r.displacement is not None:
            columns["displacement [mm]"] = r.displacement * 1e3
        if r.pressure is not None:
            columns["pressure [mmHg]"] = r.pressure / MMHG
        columns |= {"gamma [deg]": np.degrees(loads.gamma), "cuff_moment [N m]": loads.moment}
        if r.torque is not None:
            columns |= {
                "torque [N m]": r.torque,
                "joint_torque [N m]": loads.joint_torque,
                "constraint_torque [N m]": loads.constraint_torque,
                "force_across [N]": loads.across,
            }
        return pd.DataFrame(columns)


def loaded(
    trial: SyntheticElbowTrial, stroke: tuple[float, float] | None, mean_pressure: float, o: SimulateOptions
) -> LoadedTrial:
    """The trial with the loads of its own force; ValueError as of the model.

    Without an actuator's torque that of 0 is meant: only γ and the moment are shown then.
    """
    r, numbers = trial.recording, trial.numbers
    torque = 0.0 if r.torque is None else r.torque
    pressure = 0.0 if r.pressure is None else r.pressure - mean_pressure
    rigid = numbers if numbers["c"] else {**numbers, "b": 0.0}
    rest = at_rest(r.time, r.beta, rigid, stroke, pressure, torque, o.turning)
    link = numbers["l"], numbers["z"]
    loads = cuff_loads(r.beta, link, replace(rest, force=r.force), turning=o.turning, torque=torque)
    return LoadedTrial(r, loads, numbers, stroke, mean_pressure, o.turning)
