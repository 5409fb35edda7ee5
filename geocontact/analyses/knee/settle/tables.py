"""Tables of an equilibrium: what was found in each frame, and poses that `area` reads again."""

from __future__ import annotations

import numpy as np
import pandas as pd

from geocontact.analyses.knee.settle.settled import SIDES, Settled
from geocontact.loads.settling.coordinates import NAMES

MM, MM2, MPA = 1e3, 1e6, 1e-6


def settle_table(s: Settled) -> pd.DataFrame:
    """A row per frame; cells are empty where it did not come to rest."""
    flexion, adduction, rotation = np.degrees(s.knee_angles).T
    columns: dict[str, object] = {
        s.inputs.clock: s.inputs.motion.time,
        "load [N]": s.inputs.load,
        "flexion [deg]": flexion,
        "adduction [deg]": adduction,
        "rotation [deg]": rotation,
    }
    columns |= {f"{name} [mm]": s.coordinates[:, k] * MM for k, name in enumerate(NAMES[:3])}
    columns |= {"contact_area [mm^2]": s.areas * MM2, "peak [MPa]": s.peaks * MPA}
    for side in SIDES:
        columns[f"force_{side} [N]"] = s.forces(side)
    for side in SIDES:
        centre = s.centres(side) * MM
        columns |= {f"cop_{side}_{letter} [mm]": centre[:, axis] for axis, letter in enumerate("xyz")}
    steps = [np.nan if frame.rest is None else frame.rest.steps for frame in s.frames]
    columns |= {"stored_energy [J]": s.stored, "residual [N]": s.residuals, "newton_steps [-]": steps}
    return pd.DataFrame(columns)


def pose_table(s: Settled) -> pd.DataFrame:
    """Poses of MOVING in FIXED in the frames at rest, as `area` reads them."""
    poses = s.poses
    shift, turn = poses.translation * MM, poses.rotation.as_quat(scalar_first=True)
    columns: dict[str, object] = {s.inputs.clock: s.inputs.motion.time[s.kept]}
    columns |= {f"t{letter} [mm]": shift[:, axis] for axis, letter in enumerate("xyz")}
    columns |= {f"q{letter} [-]": turn[:, k] for k, letter in enumerate("wxyz")}
    return pd.DataFrame(columns)
