"""Files for other programs: coordinates and external loads for OpenSim, spheres with forces for ParaView."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.below_knee_prosthesis.from_markers.sides import of_side
from geocontact.below_knee_prosthesis.keel.on_tree import coordinates
from geocontact.below_knee_prosthesis.model.leg import Side
from geocontact.below_knee_prosthesis.model.leg_tree import RECORDED, SOCKET
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.io.opensim.external_loads_writer import write_external_loads
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.view.surfaces.line_series import LineSeries, write_line_series

FOOT: dict[Side, str] = {"right": "calcn_r", "left": "calcn_l"}
"""Bodies of OpenSim's models that the force acts on."""
TURNED = ("pelvis_rotation", "pelvis_list", "pelvis_tz")
"""Coordinates whose sign is the laboratory's, not the leg's."""
LENGTHS = ("pelvis_tx", "pelvis_ty", "pelvis_tz", *SOCKET[3:])
EVERY = 5
"""Which sample ParaView gets: 100 Hz."""


def write_coordinates(folder: Path, s: Stance, side: Side) -> None:
    """coordinates.sto: pelvis, hip and knee as driven but for the pelvis' free places; socket and keel as found.

    Between the recorded frames pelvis, hip and knee are on splines. What was driven is the bushing's frame, on splines
    through its poses at these frames: the same there, and within micrometres between them.
    """
    values = s.motion.at(s.time)
    values[:, 3:5] = s.found.q[:, :2]
    names = [*RECORDED, *SOCKET, *coordinates(s.foot.keel)]
    table = np.hstack([values, s.found.q[:, 2:]])
    for k, name in enumerate(names):
        sign = -1.0 if side == "left" and name in TURNED else 1.0
        table[:, k] = sign * (table[:, k] if name in LENGTHS else np.degrees(table[:, k]))
    ending = side[0]
    called = [name if name.startswith("pelvis") else f"{name}_{ending}" for name in names]
    title = "Coordinates of a prosthetic side"
    write_storage(folder / "coordinates.sto", s.time, called, table, title=title, degrees=True)


def write_loads(folder: Path, s: Stance, side: Side) -> None:
    """ground_reaction.mot and .xml: force of the ground on the prosthetic foot at its centre of pressure.

    The free moment about the vertical is left out; where nothing presses the point is that below the keel's end.
    """
    force, centre = of_side(s.force, side), of_side(s.centre("ground"), side)
    below = of_side(s.poses.translation, side) * np.array([1.0, 0.0, 1.0])
    place = np.where(np.isfinite(centre), centre, below)
    stem = f"ground_{side}_force"
    names = [f"{stem}_{kind}{axis}" for kind in "vp" for axis in "xyz"]
    title = "Ground reaction under a prosthetic foot"
    write_storage(folder / "ground_reaction.mot", s.time, names, np.hstack([force, place]), title=title, degrees=False)
    write_external_loads(folder / "ground_reaction.xml", "ground_reaction.mot", {stem: FOOT[side]})


def write_spheres(folder: Path, s: Stance, side: Side) -> None:
    """foot.pvd: centres of the spheres, row by row as lines, with the force on each."""
    kept = slice(None, None, EVERY)
    centres, force = of_side(s.loads.centre[kept], side), of_side(s.loads.force[kept], side)
    lines = [tuple(range(start, centres.shape[1], 2)) for start in (0, 1)]
    write_line_series(folder, "foot", LineSeries(s.time[kept], centres, lines), {"force of the ground [N]": force})
