"""A whole body in space that moves as the planar chain does, turned in the laboratory; legs may differ.

`python -m meshes.whole_body` writes the first trial of `standing_up` so, with a plate under each foot and the chair's:
body.osim, ik.mot and plates.mot in `whole_body`. Synthetic, as that trial is.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.multibody.joint import cardan
from geocontact.data.multibody.model import Body, Multibody
from geocontact.io.opensim.osim_writer import write_osim
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.tables import read_table
from geocontact.standing_up.chain import COORDINATES, Subject

HERE = Path(__file__).resolve().parent
SAMPLE, HEADING, SHARE = HERE / "standing_up", 0.6, 0.35
"""Trial, heading about y [rad], and the right foot's share of the load."""
WIDE = 0.09
"""From the middle to either hip [m]."""
X, Y, Z = np.eye(3)


def whole_body(subject: Subject) -> Multibody:
    """Trunk on six coordinates, and two legs of half of the chain's masses."""
    parts = subject.segments
    trunk = parts["trunk"]
    bodies = [Body("trunk", trunk.mass, trunk.centre * Y, trunk.mass * trunk.gyration**2 * np.diag([0.9, 0.2, 1.0]))]
    turns = [("pelvis_rotation", Y), ("pelvis_tilt", Z), ("pelvis_list", X)]
    joints = [
        cardan("root", "ground", "trunk", turns, [(f"pelvis_t{a}", v) for a, v in zip("xyz", (X, Y, Z), strict=True)])
    ]
    for end, side in (("r", 1.0), ("l", -1.0)):
        parent, at = "trunk", side * WIDE * Z
        for name, joint in (("thigh", "hip_flexion"), ("shank", "knee_angle"), ("foot", "ankle_angle")):
            own = parts[name]
            low = 0.0 if name == "foot" else own.length
            centre = np.array([own.centre, -0.05, 0.0]) if name == "foot" else (own.centre - low) * Y
            inertia = 0.5 * own.mass * own.gyration**2 * np.eye(3)
            bodies.append(Body(f"{name}_{end}", 0.5 * own.mass, centre, inertia))
            moves = [(f"{joint}_{end}", Z)] + ([(f"hip_adduction_{end}", X)] if name == "thigh" else [])
            place = RigidTransform.from_translation(at)
            joints.append(cardan(f"{name}_joint_{end}", parent, f"{name}_{end}", moves, at=place))
            parent, at = f"{name}_{end}", -low * Y
    return Multibody("whole_body", tuple(bodies), tuple(joints), (), np.array([0.0, -9.81, 0.0]))


def values_of(model: Multibody, subject: Subject, q: np.ndarray, heading: float, off: np.ndarray) -> np.ndarray:
    """Coordinates of the body that has the planar ones; the right leg's joints have `off` more, the left's less [rad].

    The middle of the ankles is where the chain's ankle is only without `off`.
    """
    parts = subject.segments
    shank, thigh = q[:, 2] + q[:, 3], q[:, 2] + q[:, 3] + q[:, 4]
    trunk = thigh + q[:, 5]
    lengths = parts["shank"].length, parts["thigh"].length
    x = q[:, 0] - lengths[0] * np.sin(shank) - lengths[1] * np.sin(thigh)
    y = q[:, 1] + lengths[0] * np.cos(shank) + lengths[1] * np.cos(thigh)
    place = Rotation.from_euler("y", heading).apply(np.column_stack([x, y, 0.0 * x]))
    made = {f"pelvis_t{axis}": place[:, k] for k, axis in enumerate("xyz")}
    made |= {"pelvis_rotation": np.full(len(q), heading), "pelvis_tilt": trunk}
    for end, side in (("r", 1.0), ("l", -1.0)):
        for k, name in enumerate(("hip_flexion", "knee_angle", "ankle_angle")):
            made[f"{name}_{end}"] = -q[:, 5 - k] + side * off[:, k]
    return np.column_stack([made.get(c.name, np.zeros(len(q))) for c in model.coordinates])


def write_body(folder: Path, model: Multibody, time: np.ndarray, values: np.ndarray) -> None:
    """body.osim and ik.mot."""
    write_osim(folder / "body.osim", model, note="Synthetic: made of a planar chain by meshes/whole_body.py.")
    printed = np.where([c.kind == "rotational" for c in model.coordinates], np.degrees(values), values)
    names = [c.name for c in model.coordinates]
    write_storage(folder / "ik.mot", time, names, printed, title="A whole body, synthetic", degrees=True)


def write_plates(folder: Path, time: np.ndarray, loads: dict[str, np.ndarray]) -> None:
    """plates.mot: force and moment about the origin of the plane, turned into the laboratory."""
    names, values = [], []
    for name, load in loads.items():
        names += [f"{name}_force_{kind}{axis}" for kind in "vp" for axis in "xyz"]
        names += [f"{name}_torque_{axis}" for axis in "xyz"]
        turned = Rotation.from_euler("y", HEADING).apply(load.reshape(-1, 3)).reshape(len(time), 6)
        values += [turned[:, :3], np.zeros((len(time), 3)), turned[:, 3:]]
    write_storage(folder / "plates.mot", time, names, np.hstack(values), title="Plates, synthetic", degrees=False)


def main(folder: Path = HERE / "whole_body", sample: Path = SAMPLE, trial: str = "T1") -> None:
    """Write the files of a trial."""
    folder.mkdir(parents=True, exist_ok=True)
    table, subject = read_table(sample / f"{trial}_coordinates.sto"), Subject()
    q = np.column_stack([table.column(name) for name in COORDINATES])
    q[:, 2:] = np.radians(q[:, 2:])
    model = whole_body(subject)
    write_body(folder, model, table.time, values_of(model, subject, q, HEADING, np.zeros((len(q), 3))))
    own, loads = read_table(sample / f"{trial}_plates.mot"), {}
    for name in ("feet", "chair"):
        kinds = (f"{name}_force_v", f"{name}_force_p", f"{name}_torque_")
        force, place, moment = (np.column_stack([own.column(f"{of}{a}") for a in "xyz"]) for of in kinds)
        loads[name] = np.hstack([force, moment + np.cross(place, force)])
    feet = loads["feet"]
    shares = {"right": beside(SHARE * feet, WIDE), "left": beside((1.0 - SHARE) * feet, -WIDE)}
    write_plates(folder, own.time, {**shares, "chair": loads["chair"]})


def beside(load: np.ndarray, off: float) -> np.ndarray:
    """The same force and moment about the origin of the plane, `off` [m] to the right."""
    return load + np.hstack([np.zeros((len(load), 3)), np.cross([0.0, 0.0, off], load[:, :3])])


if __name__ == "__main__":
    main()
