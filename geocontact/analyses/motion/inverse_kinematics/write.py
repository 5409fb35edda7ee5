"""Results of inverse kinematics to files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.json_file import plain, write_json
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.multibody.joint import Coordinate
from geocontact.data.multibody.knee_angles import SIGN, angles_of_tibia
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.results import write_table
from geocontact.io.text.tables import listed

FAR = 50.0  # mm between markers and model that no subject has who stood model for it


def printed(coordinates: tuple[Coordinate, ...], values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t n"]:
    """Values as OpenSim's files in degrees have them: rotations in degrees, all else as it is."""
    return np.asarray(values * np.array([np.degrees(1.0) if c.kind == "rotational" else 1.0 for c in coordinates]))


def write_results(record: Record, model: Multibody, found: Poses, draft: Path, seconds: float) -> None:
    """Coordinates for OpenSim, distances of the markers, and what sums them up."""
    values = printed(model.coordinates, found.values)
    write_storage(draft / "ik.mot", found.time, found.names, values, title="Coordinates", degrees=True)
    off = {f"{name} [mm]": 1e3 * d for name, d in zip(found.markers, found.distances.T, strict=True)}
    write_table(pd.DataFrame({"time [s]": found.time, **off}), draft, False, "markers")
    squares = {
        name: (float(np.sqrt(np.mean(d[there] ** 2))), float(d[there].max()))
        for name, d in zip(found.markers, 1e3 * found.distances.T, strict=True)
        if (there := np.isfinite(d)).any()
    }
    rms = 1e3 * float(np.sqrt(np.nanmean(found.distances**2)))
    worst = max(squares, key=lambda name: squares[name][0])
    missing = ~np.isfinite(found.values)
    filled = ~found.told & ~missing & found.told.any(axis=0)
    told = {
        "frames": len(found.time),
        "frames_per_second": len(found.time) / seconds,
        "steps_mean": float(found.steps.mean()),
        "unsettled_frames": int((~found.settled).sum()),
        "filled_frames": {n: int(k) for n, k in zip(found.names, filled.sum(axis=0), strict=True) if k},
        "missing_frames": {n: int(k) for n, k in zip(found.names, missing.sum(axis=0), strict=True) if k},
        "rms_mm": rms,
        "max_mm": 1e3 * float(np.nanmax(found.distances)),
        "markers": {name: {"rms_mm": each[0], "max_mm": each[1]} for name, each in squares.items()},
    }
    record.results.update(plain(told))
    write_json(draft / "ik.json", told)
    _warn(record, found, rms)
    record.say(
        f"{len(found.time)} frames, {len(found.markers)} markers: {rms:.1f} mm from the model, root mean square, "
        f"most at {worst}"
    )


def _warn(record: Record, found: Poses, rms: float) -> None:
    if not found.settled.all():
        count = int((~found.settled).sum())
        record.warn(f"{count} frames did not settle: markers and model may not belong together")
    if rms > FAR:
        record.warn(f"markers are {rms:.0f} mm from the model: another subject's size, axes (--axes) or unit?")
    never = np.asarray(~found.told.any(axis=0))
    if never.any():
        names = tuple(name for name, each in zip(found.names, never, strict=True) if each)
        record.warn(f"no frame tells {listed(names)}: kept at the model's default")
    for lost, what in (
        (~found.told & np.isfinite(found.values) & ~never, "filled between frames that tell them"),
        (~np.isfinite(found.values), "left empty, markers do not tell them"),
    ):
        names = tuple(name for name, each in zip(found.names, lost.any(axis=0), strict=True) if each)
        if names:
            frames = found.time[lost.any(axis=1)]
            span = f"{len(frames)} frames from {frames[0]:g} to {frames[-1]:g} s"
            record.warn(f"{span}: {what}: {listed(names)}")


@dataclass(frozen=True)
class Knee:
    """A knee whose angles are wanted: its side and the bodies of femur and tibia."""

    side: str
    femur: str
    tibia: str


def knees_of(texts: tuple[str, ...], model: Multibody) -> list[Knee]:
    """`--knee right=femur_r,tibia_r`, each side once."""
    found: list[Knee] = []
    names = tuple(body.name for body in model.bodies)
    for text in texts:
        side, equals, bodies = text.partition("=")
        femur, comma, tibia = (part.strip() for part in bodies.partition(","))
        if not (equals and comma) or side not in SIGN:
            raise InputError("", "--knee", f"'{text}' is not a side and two bodies", "write right=femur_r,tibia_r")
        for body in (femur, tibia):
            if body not in names:
                raise InputError("", "--knee", f"no body '{body}'", f"bodies are: {listed(names)}")
        if side in [knee.side for knee in found]:
            raise InputError("", "--knee", f"the {side} knee is given twice", "give each side once")
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
