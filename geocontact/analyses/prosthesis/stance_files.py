"""A stance in files and words: for OpenSim, ParaView, and `geocontact gap gather` with the base model `foot`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.foot_in_plane import FootInPlane, RowNumbers, plane_trial, rows_of
from geocontact.below_knee_prosthesis.from_markers import of_side
from geocontact.below_knee_prosthesis.leg import FootOffset, Side
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket
from geocontact.below_knee_prosthesis.own_side import coordinates_of_side, ground_reaction
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.data.parameter import Number
from geocontact.io.opensim.external_loads import write_external_loads
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.recordings.spheres import PLAUSIBLE
from geocontact.io.text.results import CASES, write_table
from geocontact.loads.sphere_set import SoleLaw, SphereSet
from geocontact.view.surfaces.vtp_series import LineSeries, write_line_series

FOOT: dict[Side, str] = {"right": "calcn_r", "left": "calcn_l"}
"""Bodies of OpenSim's models that the force acts on."""
EVERY = 5
"""Which sample ParaView gets: 100 Hz."""


def write_coordinates(folder: Path, s: Stance, side: Side) -> None:
    """coordinates.sto: pelvis, hip and knee as driven but for the pelvis' free places; socket and keel as found."""
    found, title = coordinates_of_side(s, side), "Coordinates of a prosthetic side"
    write_storage(folder / "coordinates.sto", s.time, list(found.names), found.in_degrees, title=title, degrees=True)


def write_loads(folder: Path, s: Stance, side: Side) -> None:
    """ground_reaction.mot and .xml: force of the ground on the prosthetic foot at its centre of pressure."""
    stem, title = f"ground_{side}_force", "Ground reaction under a prosthetic foot"
    names = [f"{stem}_{kind}{axis}" for kind in "vp" for axis in "xyz"]
    table = np.hstack(ground_reaction(s, side))
    write_storage(folder / "ground_reaction.mot", s.time, names, table, title=title, degrees=False)
    write_external_loads(folder / "ground_reaction.xml", "ground_reaction.mot", {stem: FOOT[side]})


def write_spheres(folder: Path, s: Stance, side: Side) -> None:
    """foot.pvd: centres of the spheres, or lower ends of the foam, in lines along the foot, with the force on each."""
    kept = slice(None, None, EVERY)
    centres, force = of_side(s.loads.centre[kept], side), of_side(s.loads.force[kept], side)
    beside = s.foot.sole.spheres.centre[:, 2]
    lines = [tuple(np.flatnonzero(beside == z).tolist()) for z in np.unique(beside)]
    write_line_series(folder, "foot", LineSeries(s.time[kept], centres, lines), {"force of the ground [N]": force})


STIFFEST, MOST_DAMPED = 12.0, 30.0
"""Factors on a sphere's own numbers, up to which those of a row may be fitted."""
HEAD = """# the foot in its plane; a rigid foot of these numbers is {off:.0f} N (rms) off the simulated one
# a diagnosis needs two trials to fit to, and others to hold out
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
    trial = plane_trial(time, poses, plate, s)
    if trial is None:
        return
    folder.mkdir(parents=True, exist_ok=True)
    write_table(pose_table(trial.foot), folder, "foot", CASES)
    if trial.reaction is not None:
        write_table(reaction_table(trial.foot, *trial.reaction), folder, "plate", CASES)
    write_sole(folder, s.foot.sole.spheres, s.foot.law, trial.numbers)


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
    """spheres.csv with a zone for each row across the sole, and foot.toml with constants and free numbers.

    The base model has spheres alone: a column of foam is a small one with the same lowest point, whose depth differs by
    the radius times 1 - cos(pitch).
    """
    rows = rows_of(spheres)
    radius = np.maximum(spheres.radius, PLAUSIBLE[0])
    height = spheres.centre[:, 1] - spheres.radius + radius
    places = {"px [m]": spheres.centre[:, 0], "py [m]": height}
    table = pd.DataFrame(places | {"radius [m]": radius, "zone": rows})
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


def numbers_table(numbers: Mapping[str, Number]) -> pd.DataFrame:
    """Every number in SI, and where it is from."""
    rows = [(name, number.value, number.source, number.note) for name, number in numbers.items()]
    return pd.DataFrame(rows, columns=["number", "value", "source", "note"])


def offset_words(offset: FootOffset) -> str:
    """The foot beside its standing trial, as the law has it, in a sentence."""
    return f"the foot is {offset.words} offset from its standing trial, according to the law's file"


def counted_twice(limb: LimbInSocket) -> str:
    """The socket's motion that stays in the leg's angles, where taking it out did not settle, in words."""
    if limb.turns == 0:
        turned = np.degrees(np.abs(limb.stance.found.q[:, 2:5]).max())
        piston = 1e3 * np.abs(limb.stance.pistoning).max()
        return (
            f"the socket's motion, up to {turned:.1f} degrees and {piston:.0f} mm, is counted twice: in the leg's "
            "angles and in the bushing"
        )
    return (
        f"fit and simulated socket do not agree yet: the last of {limb.turns} turns changed the force by "
        f"{limb.change:.1%} of body weight"
    )
