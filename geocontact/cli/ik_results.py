"""Results of inverse kinematics to files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.cli.ik import IkOptions
from geocontact.cli.record import Record
from geocontact.data.errors import InputError
from geocontact.data.joint import Coordinate
from geocontact.data.knee_angles import SIGN, angles_of_tibia
from geocontact.data.multibody import Multibody
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.io.results import write_table
from geocontact.io.storage_writer import write_storage
from geocontact.io.tables import listed


def printed(coordinates: tuple[Coordinate, ...], values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t n"]:
    """Values as OpenSim's files in degrees have them: rotations in degrees, all else as it is."""
    return values * np.array([np.degrees(1.0) if c.kind == "rotational" else 1.0 for c in coordinates])


def write_results(record: Record, model: Multibody, found: Poses, draft: Path, seconds: float) -> None:
    """Coordinates for OpenSim, distances of the markers, and what sums them up."""
    values = printed(model.coordinates, found.values)
    write_storage(draft / "ik.mot", found.time, found.names, values, title="Coordinates", degrees=True)
    off = {f"{name} [mm]": 1e3 * d for name, d in zip(found.markers, found.distances.T, strict=True)}
    write_table(pd.DataFrame({"time [s]": found.time, **off}), draft, False, "markers")
    rms = np.sqrt(np.nanmean(found.distances**2))
    worst = int(np.nanargmax(np.sqrt(np.nanmean(found.distances**2, axis=0))))
    told = {
        "frames": len(found.time),
        "frames_per_second": len(found.time) / seconds,
        "steps_mean": float(found.steps.mean()),
        "unsettled_frames": int((~found.settled).sum()),
        "rms_mm": 1e3 * float(rms),
        "max_mm": 1e3 * float(np.nanmax(found.distances)),
        "markers": {
            name: {"rms_mm": 1e3 * float(np.sqrt(np.nanmean(d**2))), "max_mm": 1e3 * float(np.nanmax(d))}
            for name, d in zip(found.markers, found.distances.T, strict=True)
        },
    }
    record.results.update(told)
    (draft / "ik.json").write_text(json.dumps(told, indent=2) + "\n", encoding="utf-8")
    if not found.settled.all():
        record.warn(f"{told['unsettled_frames']} frames did not settle: markers and model may not belong together")
    record.say(
        f"{len(found.time)} frames, {len(found.markers)} markers: {1e3 * rms:.1f} mm from the model, root mean square, "
        f"most at {found.markers[worst]}"
    )


def knee_table(model: Multibody, found: Poses, o: IkOptions) -> pd.DataFrame:
    """Angles after Grood and Suntay of the knees that were asked for [deg]."""
    table = {"time [s]": found.time}
    poses = model.poses(found.values)
    for text in o.knee:
        side, equals, bodies = text.partition("=")
        femur, comma, tibia = bodies.partition(",")
        if not (equals and comma) or side not in SIGN:
            raise InputError("", "--knee", f"'{text}' is not a side and two bodies", "write right=femur_r,tibia_r")
        for body in (femur, tibia):
            if body not in poses:
                raise InputError("", "--knee", f"no body '{body}'", f"bodies are: {listed(tuple(poses))}")
        turned = poses[femur].rotation.inv() * poses[tibia].rotation
        for name, angle in zip(("flexion", "adduction", "rotation"), angles_of_tibia(turned, side), strict=True):
            table[f"{side}_{name} [deg]"] = np.degrees(np.unwrap(angle))
    return pd.DataFrame(table)
