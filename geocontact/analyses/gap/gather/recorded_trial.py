"""One trial of a gap case as the checks of recorded trials see it: a foot on its plate, and channels by their unit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.cases.trial_table import TrialTable
from geocontact.trial_checks.foot_checks import FOOT_CHECKS
from geocontact.trial_checks.recorded import FootPlate, RecordedChannel, TrialInputs
from geocontact.trial_checks.table import contradictions

POSE = ("x", "y", "pitch")


def check_recorded(
    inputs: TrialTable,
    outputs: TrialTable | None,
    plate: ForcePlate | None,
    file: Path | None,
    spheres: pd.DataFrame | None,
    turn: Rotation | None,
) -> None:
    """Every check that a trial's inputs, its outputs and the plate under its foot have something for.

    Parameters
    ----------
    plate, file
        In the axes of the inputs, and where it is from; None where the trial has none.
    spheres
        Of the sole, in the foot's frame [m]; None where the case has none.
    turn
        By which the plate was turned.
    """
    channels = tuple(each for table in (inputs, outputs) if table is not None for each in _channels(table))
    on = () if plate is None or file is None else (FootPlate(plate, str(file)),)
    foot = None if plate is None else _foot(inputs, plate, spheres)
    trial = TrialInputs(foot, plates=on, channels=channels, turn=turn, on_sole=True)
    if plate is not None and foot is not None:
        found = _of_foot(trial)
        turned = replace(trial, markers=_foot(inputs, plate, spheres, -1.0))
        if found and not _of_foot(turned):
            what = "with its sign turned the sole agrees with the plate, and as it is it does not"
            reserve(
                f"{inputs.file} pitch: {what}: is pitch positive where the toes are higher than the heel?", cause=True
            )
    check_trial(trial)


def _of_foot(trial: TrialInputs) -> set[str]:
    """Names of checks of feet on plates that find something."""
    return {check.name for check, _ in contradictions(trial) if check in FOOT_CHECKS}


def _channels(table: TrialTable) -> list[RecordedChannel]:
    signals = table.signals
    return [
        RecordedChannel(name, unit, signals.time, signals.column(name), str(table.file))
        for name, unit in zip(signals.channels, signals.units, strict=True)
    ]


def _foot(
    inputs: TrialTable, plate: ForcePlate, spheres: pd.DataFrame | None, sign: float = 1.0
) -> MarkerTrajectories | None:
    """Lowest points of the rearmost and the foremost sphere, as far aside as the plate's load [m].

    `sign` is that of the pitch. None for inputs without a pose.
    """
    signals = inputs.signals
    if spheres is None or any(name not in signals.channels for name in POSE):
        return None
    x, y, pitch = (signals.column(name) for name in POSE)
    pitch = sign * pitch
    across = plate.centre_of_pressure()[:, 2]
    beside = float(np.nanmedian(across)) if np.isfinite(across).any() else 0.0
    ends = spheres.iloc[[int(spheres["px [m]"].argmin()), int(spheres["px [m]"].argmax())]]
    places = [
        np.column_stack(
            [x + a * np.cos(pitch) - b * np.sin(pitch), y + a * np.sin(pitch) + b * np.cos(pitch) - r, 0 * x + beside]
        )
        for a, b, r in zip(ends["px [m]"], ends["py [m]"], ends["radius [m]"], strict=True)
    ]
    return MarkerTrajectories(signals.time, np.stack(places, axis=1), ("heel", "toe"), str(inputs.file))
