"""A whole body in space that moves as the planar chain does, turned in the laboratory; legs may differ."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.multibody.joint import cardan
from geocontact.data.multibody.model import Body, Multibody
from geocontact.standing_up.chain import Subject

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
