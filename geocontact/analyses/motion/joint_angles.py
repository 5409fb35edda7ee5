"""The table of joint angles in a form of choice, which inverse kinematics and the walk on a prosthesis write."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import reserve
from geocontact.data.multibody.joint_angle_forms import JointAngleForm
from geocontact.data.multibody.joint_angles import UNSURE, joint_angles, joint_rotations
from geocontact.data.multibody.model import Multibody


def joint_angles_table(
    model: Multibody, time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t n"], form: JointAngleForm
) -> pd.DataFrame:
    """A column for each turn of each joint that turns about several axes [deg, -]; empty where coordinates are.

    Parameters
    ----------
    values
        Coordinates of the model [rad, m].
    """
    whole = np.isfinite(values).all(axis=1)
    table: dict[str, Float[np.ndarray, " t"]] = {"time [s]": time}
    quaternion = form == "quaternion"
    for name, rotation in joint_rotations(model, values[whole]).items():
        for turn, column in joint_angles(rotation, form, name).columns.items():
            own = np.full(len(time), np.nan)
            own[whole] = column if quaternion else np.degrees(column)
            table[f"{name} {turn} [{'-' if quaternion else 'deg'}]"] = own
    return pd.DataFrame(table)


def warn_of_gimbal_lock(
    model: Multibody, time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t n"], form: JointAngleForm
) -> None:
    """A warning for joints whose second angle comes near its end."""
    whole = np.isfinite(values).all(axis=1)
    for name, rotation in joint_rotations(model, values[whole]).items():
        lock = joint_angles(rotation, form, name).lock
        if len(lock) and (least := float(lock.min())) < UNSURE:
            reserve(
                f"{name}: the second angle of {form} comes within {np.degrees(least):.1f} degrees of gimbal lock at "
                f"{time[whole][int(lock.argmin())]:.2f} s, where first and third are not separable: ask for another "
                "sequence, or for quaternions"
            )
