"""Knees whose clinical angles are wanted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from geocontact.data.errors import InputError
from geocontact.data.multibody.knee_angles import SIGN, angles_of_tibia
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.io.text.tables import listed


@dataclass(frozen=True)
class Knee:
    """A knee whose angles are wanted: its side and the bodies of femur and tibia."""

    side: str
    femur: str
    tibia: str


def knees_of(texts: tuple[str, ...], model: Multibody) -> list[Knee]:
    """From right=femur_r,tibia_r, each side once."""
    found: list[Knee] = []
    names = tuple(body.name for body in model.bodies)
    for text in texts:
        side, equals, bodies = text.partition("=")
        femur, comma, tibia = (part.strip() for part in bodies.partition(","))
        if not (equals and comma) or side not in SIGN:
            raise InputError("", "`knee`", f"'{text}' is not a side and two bodies", "write right=femur_r,tibia_r")
        for body in (femur, tibia):
            if body not in names:
                raise InputError("", "`knee`", f"no body '{body}'", f"bodies are: {listed(names)}")
        if side in [knee.side for knee in found]:
            raise InputError("", "`knee`", f"the {side} knee is given twice", "give each side once")
        found.append(Knee(side, femur, tibia))
    return found


def knee_table(model: Multibody, found: Poses, knees: list[Knee]) -> pd.DataFrame:
    """Angles after Grood and Suntay [deg]; empty where the coordinates are."""
    table = {"time [s]": found.time}
    whole = np.isfinite(found.values).all(axis=1)
    poses = model.poses(np.asarray(found.values)[whole])
    for knee in knees:
        turned = poses[knee.femur].rotation.inv() * poses[knee.tibia].rotation
        for name, angle in zip(("flexion", "adduction", "rotation"), angles_of_tibia(turned, knee.side), strict=True):
            column = np.full(len(found.time), np.nan)
            column[whole] = np.degrees(np.unwrap(angle))
            table[f"{knee.side}_{name} [deg]"] = column
    return pd.DataFrame(table)
