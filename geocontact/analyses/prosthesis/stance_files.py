"""Files of a stance for other programs: OpenSim, ParaView, and `geocontact gap gather` for the base model `foot`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.evaluation import PlateStance, at_times, longest_stance
from geocontact.below_knee_prosthesis.foot_in_plane import FootInPlane, RowNumbers, in_plane, row_numbers, rows_of
from geocontact.below_knee_prosthesis.from_markers import of_side
from geocontact.below_knee_prosthesis.keel.on_tree import coordinates
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.below_knee_prosthesis.leg_tree import RECORDED, SOCKET
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.io.opensim.external_loads import write_external_loads
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.results import CASES, write_table
from geocontact.loads.sphere_set import SoleLaw, SphereSet
from geocontact.view.surfaces.vtp_series import LineSeries, write_line_series

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


AROUND = 0.05
"""s; before and after the stance that belong to the trial."""
STIFFEST, MOST_DAMPED = 12.0, 30.0
"""Factors on a sphere's own numbers, up to which those of a row may be fitted."""
HEAD = """# the foot in its plane; a rigid foot of these numbers is {off:.0f} N (rms) off the simulated one
format = 1
system = "foot"
spheres = "spheres.csv"
calibration = ["t01"]
evaluation = ["t02"]

[from.t01]
inputs = "foot.csv"
outputs = "plate.csv"

[constants]
n = {n:.9g}
delta_full = {full:.9g}
mu_s = {static:.9g}
mu_k = {kinetic:.9g}
v_th = {speed:.9g}

"""


def write_plane(
    folder: Path, time: Float[np.ndarray, " t"], poses: RigidTransform, plate: PlateStance | None, s: Stance
) -> None:
    """foot.csv (x, y, pitch by markers), plate.csv where one was named, spheres.csv, foot.toml for a gather.toml.

    Parameters
    ----------
    time, poses
        When the keel was seen [s], and its frame by the markers on the socket.
    plate
        Under the prosthetic foot; None where it is not named.
    s
        The stance that was simulated.
    """
    loaded = (s.time, s.force[:, 1]) if plate is None else (plate.time, plate.force[:, 1])
    span = longest_stance(*loaded)
    if span is None:
        return
    inside = (time >= span[0] - AROUND) & (time <= span[1] + AROUND)
    foot = in_plane(time[inside], poses[inside])
    folder.mkdir(parents=True, exist_ok=True)
    write_table(pose_table(foot), folder, "foot", CASES)
    if plate is not None:
        force, centre = (at_times(foot.time, plate.time, each) for each in (plate.force, plate.centre))
        write_table(reaction_table(foot, *foot.reaction(force, centre)), folder, "plate", CASES)
    simulated = in_plane(s.time, s.poses)
    _, up, centre = simulated.reaction(s.force, s.centre("ground"))
    spheres, law = s.foot.sole.spheres, s.foot.law
    write_sole(folder, spheres, law, row_numbers(simulated, spheres, law, up, centre))


def pose_table(foot: FootInPlane) -> pd.DataFrame:
    """Inputs of the base model."""
    return pd.DataFrame({"time [s]": foot.time, "x [m]": foot.x, "y [m]": foot.y, "pitch [rad]": foot.pitch})


def reaction_table(
    foot: FootInPlane,
    forward: Float[np.ndarray, " t"],
    up: Float[np.ndarray, " t"],
    centre: Float[np.ndarray, " t"],
) -> pd.DataFrame:
    """Force and centre of pressure that are measured beside them."""
    return pd.DataFrame({"time [s]": foot.time, "force_x [N]": forward, "force_y [N]": up, "cop_x [m]": centre})


def write_sole(folder: Path, spheres: SphereSet, law: SoleLaw, numbers: RowNumbers) -> None:
    """spheres.csv with a zone for each row across the sole, and foot.toml with constants and free numbers."""
    rows = rows_of(spheres)
    place = {f"p{axis} [m]": spheres.centre[:, k] for k, axis in enumerate("xy")}
    table = pd.DataFrame(place | {"radius [m]": spheres.radius, "zone": rows})
    write_table(table, folder, "spheres", CASES)
    text = HEAD.format(
        off=numbers.off,
        n=law.exponent,
        full=law.full_depth,
        static=float(np.mean(law.static)),
        kinetic=float(np.mean(law.kinetic)),
        speed=law.threshold_speed,
    )
    kinds = (
        ("k", numbers.stiffness, STIFFEST * float(law.stiffness.max()), "N/m^n"),
        ("b", numbers.damping, MOST_DAMPED * float(law.damping.max()), "N s/m"),
    )
    for letter, of, upper, unit in kinds:
        for name, start in of.items():
            within = f"start = {min(start, upper):.6g}\nlower = 0.0\nupper = {upper:.6g}"
            text += f'[parameters.{letter}_{name}]\n{within}\nunit = "{unit}"\n\n'
    (folder / "foot.toml").write_text(text, encoding="utf-8")
