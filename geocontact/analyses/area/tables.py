"""The tables of one motion: areas, pressures, differences to measured areas."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.area.motion_result import MotionResult
from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.pose_error.along import uncertainty_table
from geocontact.analyses.area.pressure.along import PressureEvolution
from geocontact.data.motion import Motion
from geocontact.loads.pressure_load import PressureLoad


def tables_of(one: MotionResult, o: AreaOptions) -> dict[str, pd.DataFrame]:
    """`area`, and `pressure`, `comparison` and `pose_error` where they were asked for."""
    found = {"area": area_table(one, o)}
    if one.pressure is not None:
        found["pressure"] = pressure_table(one.motion, one.pressure)
    if one.comparison is not None:
        found["comparison"] = one.comparison
    if one.uncertainty is not None:
        found["pose_error"] = uncertainty_table(one.motion.time, one.evolution.thresholds, one.uncertainty)
    return found


def area_table(one: MotionResult, o: AreaOptions) -> pd.DataFrame:
    """A row per frame and threshold, with congruence, the angle that a sweep prescribes and the offset of adduction."""
    table = one.evolution.table()
    if one.congruence is not None:
        table = table.assign(**one.congruence.columns())
    if one.motion.coordinate is not None:
        name, angle = one.motion.coordinate
        table[f"{name} [deg]"] = np.repeat(np.degrees(angle), len(one.evolution.thresholds))
    if o.adduction is not None:
        table["adduction offset [deg]"] = np.round(np.degrees(o.adduction[1]), 9)
    return table


def pressure_table(motion: Motion, e: PressureEvolution) -> pd.DataFrame:
    """A row per frame: force on FIXED, its moment about the frame's origin, centre of pressure (empty without load)."""
    wrenches = [load.wrench for load in e.loads]
    columns: dict[str, object] = {"time [s]": motion.time, "force [N]": e.pressing}
    for axis, letter in enumerate("xyz"):
        columns[f"force_{letter} [N]"] = [w.force[axis] for w in wrenches]
    for axis, letter in enumerate("xyz"):
        columns[f"moment_{letter} [N m]"] = [w.moment[axis] for w in wrenches]
    columns |= _columns("", e.loads)
    for side, loads in e.parts.items():
        columns[f"force_{side} [N]"] = [load.pressing for load in loads]
        columns |= _columns(f"_{side}", loads)
    return pd.DataFrame(columns)


def _columns(suffix: str, loads: Sequence[PressureLoad]) -> dict[str, object]:
    centres = np.array([load.centre for load in loads]) * 1e3
    return {
        f"peak{suffix} [MPa]": [load.peak * 1e-6 for load in loads],
        f"pressed_area{suffix} [mm^2]": [load.area * 1e6 for load in loads],
        **{f"cop{suffix}_{letter} [mm]": centres[:, axis] for axis, letter in enumerate("xyz")},
    }
