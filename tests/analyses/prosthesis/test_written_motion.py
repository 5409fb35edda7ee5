"""`coordinates.sto` is the motion that was driven, between the recorded frames too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.analyses.prosthesis.stance_files import write_coordinates
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.leg_tree import RECORDED, SOCKET, LegMotion
from tests.below_knee_prosthesis.model.legs import a_leg
from tests.below_knee_prosthesis.stances import a_stance


def read_back(folder: Path) -> dict[str, np.ndarray]:
    """Columns in rad and m."""
    lines = (folder / "coordinates.sto").read_text().split("endheader\n")[1].splitlines()
    columns = np.array([row.split() for row in lines[1:]], float).T
    table = dict(zip(lines[0].split(), columns, strict=True))
    long = ("time", *(f"{body}_t{axis}" for body in ("pelvis", "socket") for axis in "xyz"))
    return {name: of if name.startswith(long) else np.radians(of) for name, of in table.items()}


def keel_frames(q: dict[str, np.ndarray], leg: Leg) -> RigidTransform:
    """Of the written coordinates, by turns written out here: after Baker, Grood & Suntay, and the bushing's."""

    def pose(axes: str, angles: list[np.ndarray], place: np.ndarray) -> RigidTransform:
        turn = Rotation.from_euler(axes, np.column_stack(angles))
        return RigidTransform.from_components(np.broadcast_to(place, (len(angles[0]), 3)), turn)

    pelvis = pose(
        "YXZ",
        [q["pelvis_rotation"], q["pelvis_list"], q["pelvis_tilt"]],
        np.column_stack([q[f"pelvis_t{axis}"] for axis in "xyz"]),
    )
    thigh = pelvis * pose("ZXY", [q["hip_flexion_r"], q["hip_adduction_r"], q["hip_rotation_r"]], leg.hip)
    shank = thigh * pose("Z", [-q["knee_flexion_r"]], np.array([0.0, -leg.thigh, 0.0]))
    socket = pose(
        "XYZ",
        [q[f"{name}_r"] for name in SOCKET[:3]],
        np.column_stack([q[f"{name}_r"] for name in SOCKET[3:]]),
    )
    bushing = RigidTransform.from_components(leg.bushing, leg.turn)
    return shank * bushing * socket * RigidTransform.from_translation(leg.keel_place)


def test_coordinates_between_frames_are_those_of_the_motion(tmp_path: Path) -> None:
    """A motion in closed form, recorded at 100 Hz and written at 500: 5e-4 rad off where it is drawn in lines."""
    rng = np.random.default_rng(5)
    size, speed, phase = rng.uniform(0.1, 0.4, 10), rng.uniform(5.0, 15.0, 10), rng.uniform(0.0, 6.0, 10)

    def course(time: np.ndarray) -> np.ndarray:
        return np.asarray(size * np.sin(np.outer(time, speed) + phase))

    frames = np.arange(0.0, 0.8, 0.01)
    motion = LegMotion(a_leg(), frames, course(frames))
    stance = a_stance(np.arange(0.1, 0.7, 0.002), motion=motion)
    write_coordinates(tmp_path, stance, "right")
    written = read_back(tmp_path)
    wanted = course(stance.time)
    for k, name in enumerate(RECORDED):
        if name not in ("pelvis_tx", "pelvis_ty"):  # which are found, not recorded
            called = name if name.startswith("pelvis") else f"{name}_r"
            np.testing.assert_allclose(written[called], wanted[:, k], atol=2e-7)
