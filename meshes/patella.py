"""A domed patellar button and how it slides in the groove of the sample femoral component (synthetic; right side; mm).

Frame P: x anterior, y superior, z right, origin in the middle of the rim of the dome, which faces backwards. The button
is a piece of a sphere on a disc. It follows flexion along the anterior arc of the component: the direction from which
it looks at the component goes from 4° above anterior at most towards distal. Nothing here was measured.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from meshes.femoral_component import ANTERIOR, TURNS, arc_ends, coronal_drop, direction, sagittal_profile
from meshes.gait import DEPTH, Gait, vertex_distances
from meshes.sheets import hexagonal_disc
from meshes.solids import thicken

DOME, RIM, BASE = 25.0, 16.0, 4.0
"""Radius of the dome, radius of its rim, and thickness of the disc behind it [mm]."""
HEIGHT = DOME - np.sqrt(DOME**2 - RIM**2)
"""Of the dome above its rim [mm]."""
COARSE = 12
"""Rings of cells of the shipped button."""
AT_EXTENSION, PER_FLEXION = -1.0, -0.72
"""Direction towards the button, from anterior [deg], and how much it turns with each degree of flexion."""


def patella(rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices [mm, frame P] and faces of the closed button."""
    distance, turn, faces = hexagonal_disc(rings)
    polar, around = distance * np.arcsin(RIM / DOME), 2 * np.pi * turn
    across = DOME * np.sin(polar)
    y, z = across * np.sin(around), across * np.cos(around)
    dome = np.column_stack([DOME - HEIGHT - DOME * np.cos(polar), y, z])
    back = np.column_stack([np.full(len(y), BASE), y, z])
    return thicken(dome, back, faces, max(1, round(BASE / (RIM / rings))))


def groove(turn: float) -> np.ndarray:
    """Bottom of the groove (x, y) [mm, frame F] where the profile of the anterior arc faces `turn` [rad]."""
    s = np.array([arc_ends()[0] + ANTERIOR * (TURNS[0] - turn)])
    point, normal = sagittal_profile(s)
    return (point - coronal_drop(s, np.zeros(1))[:, None] * normal)[0]


def settled(femoral: tuple, button: tuple, turn: float, start: float = HEIGHT + 8.0) -> float:
    """Distance of P's origin from the groove's bottom at `turn` [mm]; the deepest vertex lies DEPTH inside.

    As in `gait.settled_height`: moving by the distance itself never oversteps, and after the first query only vertices
    within 1 mm of the smallest distance are asked again.
    """
    way, bottom = np.append(direction(turn), 0.0), np.append(groove(turn), 0.0)
    turned, away, move = Rotation.from_euler("z", turn).apply(button[0]), start, np.inf
    of_component, of_button = femoral[0], turned
    while abs(move) > 1e-6:
        place = bottom + away * way
        to_button = vertex_distances(of_component - place, (turned, button[1]))
        to_component = vertex_distances(of_button + place, femoral)
        smallest = min(to_button.min(), to_component.min())
        if np.isinf(move):
            of_component = of_component[to_button < smallest + 1.0]
            of_button = of_button[to_component < smallest + 1.0]
        move = smallest + DEPTH
        away -= move
        if abs(away - start) > 0.5:
            return settled(femoral, button, turn, away)
    return away


def patella_in_insert(gait: Gait, femoral: tuple, button: tuple) -> tuple[np.ndarray, Rotation]:
    """Position of P in T (t, 3) [mm] and R_TP along a gait cycle, the button settled on the component in each frame."""
    turns = np.radians(AT_EXTENSION + PER_FLEXION * gait.angles[:, 0])
    away = [HEIGHT + 8.0]
    for turn in turns:
        away.append(settled(femoral, button, turn, away[-1]))
    ways = direction(turns)
    places = np.column_stack(
        [[groove(turn) for turn in turns] + np.array(away[1:])[:, None] * ways, np.zeros(len(ways))]
    )
    rotation = gait.rotation()
    return np.round(gait.translation + rotation.apply(places), 4), rotation * Rotation.from_euler("z", turns[:, None])


PAIRS = """\
# A total knee with a patellar button over a gait cycle (synthetic): `geocontact pairs meshes/knee_pairs.toml`
unit = "mm"

[[bodies]]
name = "femur"
mesh = "femoral_component_right_coarse.stl"
motion = "gait.csv"

[[bodies]]
name = "insert"
mesh = "tibial_insert_right_coarse.stl"

[[bodies]]
name = "patella"
mesh = "patella_right_coarse.stl"
motion = "gait_patella.csv"

[[pairs]]
name = "medial"
moving = "femur"
fixed = "insert"
region = "z < 0"

[[pairs]]
name = "lateral"
moving = "femur"
fixed = "insert"
region = "z > 0"

[[pairs]]
name = "patellofemoral"
moving = "patella"
fixed = "femur"
"""
"""Description of the pairs, in the frame of the insert."""

RESTING = """\
# A total knee with a patellar button that come to rest (synthetic): `geocontact settle-pairs meshes/resting_knee.toml`
unit = "mm"

[[bodies]]
name = "femur"
mesh = "femoral_component_right_coarse.stl"
motion = "gait.csv"

[[bodies]]
name = "insert"
mesh = "tibial_insert_right_coarse.stl"

[[bodies]]
name = "patella"
mesh = "patella_right_coarse.stl"
motion = "gait_patella.csv"

[[pairs]]
name = "tibiofemoral"
moving = "femur"
fixed = "insert"
region = "ny > 0.25"
layer = { modulus = { value = 463, unit = "MPa" }, poisson = 0.46, piece = { value = 1, unit = "mm" } }

[[pairs]]
name = "patellofemoral"
moving = "femur"
fixed = "patella"
[pairs.layer]
modulus = { value = 463, unit = "MPa" }
poisson = 0.46
thickness = { value = 8, unit = "mm" }
piece = { value = 1, unit = "mm" }

[[free]]
body = "femur"
axes = "insert"
settles = ["ty", "rx"]
fy = { value = -2000, unit = "N" }

[[free]]
body = "patella"
axes = "insert"
settles = ["tx"]
fx = { value = -300, unit = "N" }
"""
"""Description of bodies that come to rest: femur under 2 kN on the insert, button pulled onto the femur."""
