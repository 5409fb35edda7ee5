"""Tables of a simulated arm, of the device's numbers and of what they change."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.shoulder.simulate.simulated_arm import SimulatedArm
from geocontact.shoulder_exoskeleton.device import JOINTS, QUANTITIES, Device
from geocontact.shoulder_exoskeleton.sensitivity import Influence
from geocontact.shoulder_exoskeleton.work_phases import PHASES

WAYS = ("distal", "medial", "raising")
"""Axes of the cuff."""


def arm_table(arm: SimulatedArm) -> pd.DataFrame:
    """Angles, forces and slip over time; forces of the cuff on the arm, in the device's frame and in the cuff's."""
    s = arm.simulation
    told, motion = s.told, s.motion
    led = {}
    if arm.detected is not None and arm.factor is not None:
        led = {"detected phase": np.array(PHASES)[arm.detected], "factor [-]": arm.factor}
    slide = 1e3 * told["sliding"]
    columns = {
        "time [s]": motion.time,
        "phase": np.array(PHASES)[arm.phase],
        **led,
        "shoulder elevation [deg]": np.degrees(motion.elevation),
        **{f"{joint} [deg]": np.degrees(column) for joint, column in zip(JOINTS, s.angles.T, strict=True)},
        "support torque [N m]": told["support"][:, 0],
        "cylinder [N]": s.cylinder,
        **{f"force_{axis} [N]": column for axis, column in zip("xyz", told["force"].T, strict=True)},
        "distal [N]": told["in_cuff"][:, 0],
        "medial [N]": told["in_cuff"][:, 1],
        "supporting [N]": told["in_cuff"][:, 2],
        "normal [N]": told["pressing"][:, 0],
        "shear [N]": s.shear,
        "sliding along [mm/s]": slide[:, 0],
        "sliding across [mm/s]": np.hypot(slide[:, 1], slide[:, 2]),
        "slip [mm]": 1e3 * s.slip,
        "place in the cuff [mm]": 1e3 * told["place"][:, 0],
        "off its axis [mm]": 1e3 * np.hypot(told["place"][:, 1], told["place"][:, 2]),
        "out of the cuff": s.out_of_cuff.astype(int),
        **{f"{joint} at a stop": column.astype(int) for joint, column in zip(JOINTS, s.at_stop.T, strict=True)},
    }
    if s.cuff == "surface":
        columns |= {
            **{f"couple {way} [N m]": column for way, column in zip(WAYS, told["couple"].T, strict=True)},
            "centre of pressure [mm]": 1e3 * told["centre"][:, 0],
            "peak pressure [Pa]": told["peak"][:, 0],
            "pressed share [-]": told["share"][:, 0],
        }
    return pd.DataFrame(columns)


def numbers_table(device: Device) -> pd.DataFrame:
    """Every number of the device in the unit that files have, and where it is from."""
    rows = []
    for name, number in device.numbers.items():
        unit, factor = QUANTITIES[name].written
        rows.append((name, number.value * factor, unit, number.source, number.note or QUANTITIES[name].what))
    return pd.DataFrame(rows, columns=["number", "value", "unit", "source", "note"])


def sensitivity_table(side: str, found: Sequence[Influence]) -> pd.DataFrame:
    """What each number changes, root mean square; the largest change of the supporting force first."""
    rows = []
    for one in sorted(found, key=lambda each: -each.supporting):
        unit, factor = QUANTITIES[one.number].written
        changed = (np.degrees(one.elevation), one.supporting, one.shear, one.most)
        rows.append((side, one.number, one.source, one.step * factor, unit, *changed))
    names = ["side", "number", "source", "step", "unit", "elevation [deg]", "supporting [N]", "shear [N]"]
    names.append("supporting at most [N]")
    return pd.DataFrame(rows, columns=names)
