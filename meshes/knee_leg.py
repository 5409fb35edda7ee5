"""Two synthetic people with one leg and a knee implant whose contact is known in closed form.

The femoral component is a ball, the insert a flat plate in the tibia's frame, top at its origin. While the leg swings
the ball goes d deep into the plate, so that it overlaps it in a cap of area 2 pi R d, and cells in the tibia carry
Hertz' force 4/3 E* R^(1/2) d^(3/2) (Johnson 1985, Contact mechanics, 4.2) of the person's E*. Markers are rigid
and exact: what a laboratory's markers show of a knee is a hundred times coarser than these depths.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from meshes.leg_files import PLACES, RATE, SWING, body, custom_joint, document, joint, marker, motion_text

MASSES = {"pelvis": 10.0, "femur_r": 8.0, "femoral_component": 0.3, "tibia_r": 4.0, "foot_r": 1.0}
"""Masses of the generic bodies [kg]; that of a person is shared among them alike."""
MARKED = ("pelvis", "femur_r", "tibia_r", "foot_r")
FRAMES = 61
LENGTH = 0.4
"""m; of the generic thigh, and of the shank."""
COORDINATES = ("knee", "knee_tx", "knee_ty", "knee_tz")


@dataclass(frozen=True)
class ImplantedPerson:
    """Who has the implant.

    Parameters
    ----------
    mass
        Of the body with all of these segments [kg].
    thigh, shank
        Sizes over those of the generic model.
    radius
        Of the ball [mm].
    deep
        Least and largest depth [mm].
    modulus
        E* that the cells' force follows [Pa].
    """

    name: str
    mass: float
    thigh: float
    shank: float
    radius: float
    deep: tuple[float, float]
    modulus: float


PEOPLE = (
    ImplantedPerson("K1", 23.3, 1.0, 1.0, 20.0, (0.2, 0.9), 15e6),
    ImplantedPerson("K2", 28.0, 1.1, 0.95, 18.0, (0.3, 0.8), 22e6),
)


def depth(person: ImplantedPerson, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """Of the ball in the plate [m]: one cycle from the least to the largest and back."""
    least, most = person.deep
    return 1e-3 * (least + 0.5 * (most - least) * (1.0 - np.cos(2.0 * np.pi * time / time[-1])))


def knee_leg_files() -> dict[str, str]:
    """`knee_leg.osim`, and of each person the true model, the motion and the force of the cells, by name."""
    found = {"knee_leg.osim": leg_text(1.0, 1.0, sum(MASSES.values()))}
    for person in PEOPLE:
        folder = f"knee_leg_{person.name}"
        found[f"{folder}/leg.osim"] = leg_text(person.thigh, person.shank, person.mass)
        found[f"{folder}/swing.mot"] = _swing(person)
        found[f"{folder}/force.csv"] = _force(person)
    return found


def leg_text(thigh: float, shank: float, mass: float) -> str:
    """OpenSim 4 model of a leg whose segments have these sizes over the generic ones; x forward, y up, z right."""
    sizes = {"femur_r": thigh, "tibia_r": shank}
    by = mass / sum(MASSES.values())
    bodies = "\n".join(body(name, by * own, sizes.get(name, 1.0)) for name, own in MASSES.items())
    joints = "\n".join(
        (
            joint("FreeJoint", "base", "ground", "pelvis", (0, 0, 0), ("tilt", "list", "turn", "tx", "ty", "tz")),
            joint("BallJoint", "hip_r", "pelvis", "femur_r", (0, -0.1, 0.1), ("hip_x", "hip_y", "hip_z")),
            joint("WeldJoint", "cement", "femur_r", "femoral_component", (0, -LENGTH * thigh, 0), ()),
            custom_joint("knee_r", "femoral_component", "tibia_r", COORDINATES),
            joint("PinJoint", "ankle_r", "tibia_r", "foot_r", (0, -LENGTH * shank, 0), ("ankle",)),
        )
    )
    markers = "\n".join(marker(name, k, sizes.get(name, 1.0)) for name in MARKED for k in range(len(PLACES)))
    return document("synthetic_knee_leg", bodies, joints, markers)


def _swing(person: ImplantedPerson) -> str:
    """The swing of `leg_files`, the tibia moved so that the ball goes straight into the plate.

    Turned by q about z against the ball, and with the ball's centre (0, R - d, 0) in the tibia, its origin is at
    (R - d) (sin q, -cos q, 0) from that centre.
    """
    time = np.arange(FRAMES) / RATE
    columns = {"tilt": np.zeros(FRAMES), "ty": np.full(FRAMES, 1.0)}
    for name, (mean, amplitude, phase) in SWING.items():
        columns[name] = mean + amplitude * np.sin(2.0 * np.pi * (time / time[-1] + phase))
    apart, turn = 1e-3 * person.radius - depth(person, time), np.radians(columns["knee"])
    columns |= {"knee_tx": apart * np.sin(turn), "knee_ty": -apart * np.cos(turn), "knee_tz": np.zeros(FRAMES)}
    return motion_text(f"synthetic leg swing of {person.name}", time, columns)


def _force(person: ImplantedPerson) -> str:
    time = np.arange(FRAMES) / RATE
    force = 4.0 / 3.0 * person.modulus * np.sqrt(1e-3 * person.radius) * depth(person, time) ** 1.5
    rows = [f"{t:.2f},{f:.4f}" for t, f in zip(time, force, strict=True)]
    return "\n".join([f"# synthetic {person.name}: cells in the tibia", "time [s],total [N]", *rows]) + "\n"
