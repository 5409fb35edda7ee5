"""A step of an intact foot whose outcomes are known: a shank that rolls on a wheel, over a foot that is carried along.

Synthetic, of the person of the shipped standing trial of both legs.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.analyses.motion.markers import markers_given
from geocontact.below_knee_prosthesis.both_sides.intact_leg import IntactLeg
from geocontact.below_knee_prosthesis.both_sides.standing import standing_intact_leg
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.trc import write_trc
from tests.cli.calls import MESHES

STANDING = MESHES / "amputee_P1" / "standing.trc"
MASS, RADIUS, LENGTH, TOE_OUT = 77.3, 0.31, 0.7, np.radians(8.0)
"""kg; m, of the wheel; s, of the stance; rad, by which the foot points outwards."""
RATE, SUNK = 200.0, 2e-3
"""Hz; m, by which the foot's markers are lower than while standing."""
PLATE = "intact_force"


@dataclass(frozen=True, eq=False)
class KnownStep:
    """Files of the step, and the peak ankle moment that was made [N m]."""

    markers: Path
    plates: Path
    ankle_moment: float


def known_step(folder: Path, late: float = 0.0, away: float = 0.0) -> KnownStep:
    """Writes `intact.trc` and `intact.mot`, the foot on the floor from 0 to `LENGTH`, and 0.15 s before and after.

    `late` is by how much the plate's clock is off [s], `away` how far the plate's points are behind [m].
    """
    leg = standing_intact_leg(markers_given(STANDING, None, None, None), Person(MASS))
    time = np.arange(-0.15, LENGTH + 0.15, 1.0 / RATE)
    lean = np.interp(time, [0.0, LENGTH], np.radians([-16.0, 26.0]))
    ahead, side = (Rotation.from_euler("y", TOE_OUT).apply(axis) for axis in np.eye(3)[::2])
    hub = np.outer(RADIUS * lean, ahead) + np.array([0.0, RADIUS, 0.0])
    turn = Rotation.from_euler("y", TOE_OUT) * Rotation.from_euler("z", -lean[:, None])
    ankle = hub - (RADIUS - leg.sole) * turn.apply([0.0, 1.0, 0.0])
    up, across = -leg.ankle / np.linalg.norm(leg.ankle), np.array([0.0, 0.0, 1.0])
    own = Rotation.from_matrix(np.column_stack([np.cross(up, across), up, across])).inv()
    shank = RigidTransform.from_rotation(turn * own)
    shank = RigidTransform.from_translation(ankle - shank.apply(leg.ankle)) * shank
    lift = np.interp(time, [-0.15, 0.0, LENGTH, LENGTH + 0.15], [0.1, 0.0, 0.0, 0.1])
    held = np.column_stack([ankle[:, 0], leg.sole - SUNK + lift, ankle[:, 2]])
    foot = RigidTransform.from_components(held, Rotation.from_euler("y", np.full((len(time), 1), TOE_OUT)))
    share = np.clip(time / LENGTH, 0.0, 1.0)
    load = 1.1 * MASS * 9.81 * np.clip(1.6 * np.sin(np.pi * share), 0.0, 1.0)
    force = load[:, None] * (np.array([0.0, 1.0, 0.0]) + np.outer(-0.15 * np.cos(np.pi * share), ahead))
    centre = hub * [1.0, 0.0, 1.0]
    made = np.cross(centre - ankle, force) @ side
    _markers(folder / "intact.trc", leg, time, {"intact_shank": shank, "intact_foot": foot})
    _plates(folder / "intact.mot", time + late, force, centre - [away, 0.0, 0.0])
    return KnownStep(folder / "intact.trc", folder / "intact.mot", float(made.max()))


def _markers(file: Path, leg: IntactLeg, time: Float[np.ndarray, " t"], poses: dict[str, RigidTransform]) -> None:
    seen = [marker for marker in leg.markers if marker.body in poses]
    places = np.stack([poses[marker.body].apply(marker.location) for marker in seen], axis=1)
    write_trc(file, MarkerTrajectories(time, places, tuple(marker.name for marker in seen), "synthetic"))


def _plates(
    file: Path, time: Float[np.ndarray, " t"], force: Float[np.ndarray, "t 3"], centre: Float[np.ndarray, "t 3"]
) -> None:
    columns = {"time": time}
    for name, values in (("force_v", force), ("force_p", centre), ("torque_", 0.0 * force)):
        columns |= {f"intact_{name}{axis}": values[:, k] for k, axis in enumerate("xyz")}
    table = pd.DataFrame(columns).to_csv(sep="\t", index=False, float_format="%.6f")
    head = f"synthetic\nversion=1\nnRows={len(time)}\nnColumns={len(columns)}\ninDegrees=no\nendheader\n"
    file.write_text(head + table)
