"""What the files of one trial hold: coordinates and rates, plates on the same clock, forces of straps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.motion.checked_trial import turned_plates
from geocontact.analyses.sit_to_stand.worn_trials import columns_at
from geocontact.data.errors import InputError
from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.data.multibody.model import Multibody
from geocontact.data.wrench import Wrench
from geocontact.identify.signals.filters import UNEVEN
from geocontact.io.mocap.force_plates import plate_named, read_force_plates
from geocontact.io.opensim.coordinates import columns_of, motion_of
from geocontact.io.recordings.load_cells import column_in_newtons
from geocontact.io.recordings.standing_study import StandingTrialFiles
from geocontact.io.text.tables import read_table
from geocontact.loads.friction_limit import friction_limit, noise_of
from geocontact.standing_up.trial_forces import steady

FEWEST = 20
"""Samples of a trial."""
NORMAL, FORWARDS = "normal", "fx"
"""Columns of a strap's force: in a file of its own, and in the wrench.csv of a mat, whose scan has x forwards."""
SHEAR = "shear"
"""Column of the force along the segment, beside `NORMAL`."""
FRICTION = 1.0
"""Coefficient that shear is confronted with, generous: dry skin on textiles has less (review: Derler & Gerhardt 2012,
Tribol Lett 45:1)."""
SCANS = {"thigh": "thigh", "shank": "shank", "pelvis": "torso"}
"""What a scan of a site is of."""
CELL = "r0c0"
"""First cell in a mat's own recording."""
OFF, DROPPED = 5, 0.2
"""Samples at exactly 0 N, and parts of the largest force right before or after them: what slackens does not jump."""
EDGE, SLOPE, SLACKENS = 0.05, 0.1, 0.2
"""s, beside a jump, which sampling may draw out; over which the slope before it is taken, and in which a strap that
slackens at it would come to 0 N; invented."""
Times = Float[np.ndarray, " t"]
Table = Float[np.ndarray, "t c"]
Used = Bool[np.ndarray, " t"]


def motion_of_file(file: Path, chain: Multibody, role: str) -> tuple[Times, Table]:
    """Times and coordinates of a chain; InputError where columns lack, or where times are few or not even."""
    table = read_table(file)
    add_input(role, file, frames=len(table.time))
    known = columns_of(table, chain.joints)
    lacking = [c.name for c in chain.coordinates if c.name not in known]
    if lacking:
        remedy = f"all trials are of one model, with {', '.join(c.name for c in chain.coordinates)}"
        raise InputError(file, "", f"no column for {', '.join(lacking)}", remedy)
    if len(table.time) < FEWEST:
        raise InputError(file, "", f"{len(table.time)} frames are too few", f"{FEWEST} are needed")
    step = float(np.ptp(table.time)) / (len(table.time) - 1)
    if np.abs(np.diff(table.time) - step).max() > UNEVEN * step:
        raise InputError(file, "", f"frames are not {step:g} s apart everywhere", "fill the gaps")
    return table.time, motion_of(table, chain)


def rates_of(file: Path, chain: Multibody, name: str, time: Times) -> Table:
    """Rates of a chain at the times of its coordinates; InputError where they do not cover them."""
    own, rates = motion_of_file(file, chain, f"{name} rates")
    if own[0] > time[0] + 1e-9 or own[-1] < time[-1] - 1e-9:
        what = f"runs from {own[0]:g} to {own[-1]:g} s, the coordinates from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, "", what, "is it of another trial? name its own file, or put both on one clock")
    return np.column_stack([np.interp(time, own, column) for column in rates.T])


def require_one_clock(file: Path, plate: ForcePlate, time: Times) -> None:
    """A plate that was not recording while the markers were is on another clock."""
    begin, end = plate.time[[0, -1]]
    step = float(np.ptp(time)) / (len(time) - 1)
    if begin > time[0] + step or end < time[-1] - step:
        what = f"runs from {begin:g} to {end:g} s, the coordinates from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, plate.name, what, "put plates and markers on one clock, or cut the coordinates")


def plates_of_trial(
    files: StandingTrialFiles, place: str, time: Times, c3d_unit: str | None, turn: Rotation | None
) -> tuple[ForcePlate | None, ForcePlate | None]:
    """Those of feet and chair; None where there is none."""
    if files.plates is None:
        return None, None
    plates = turned_plates(read_force_plates(files.plates, c3d_unit), turn, files.plates)
    add_input(f"{files.name} plates", files.plates, plates=len(plates))
    feet = plate_named(plates, files.feet, files.plates, f"{place} feet")
    require_one_clock(files.plates, feet, time)
    if files.chair is None:
        return feet, None
    return feet, plate_named(plates, files.chair, files.plates, f"{place} chair")


def wrench_at(plate: ForcePlate, time: Times) -> Wrench:
    """Reaction at the times of the trial; beyond its own the nearest."""
    return plate.at(np.clip(time, *plate.time[[0, -1]]))


@contextmanager
def named_plate(file: Path, plate: ForcePlate) -> Iterator[None]:
    """InputErrors about a plate's values with its file and name."""
    try:
        yield
    except InputError as error:
        raise InputError(file, plate.name, error.what, error.remedy) from error


def chair_force(chair: ForcePlate) -> Times:
    """Normal force on the chair at its own times, without a sign and without brief noise [N]."""
    return steady(chair.time, np.abs(chair.wrench.force @ chair.normal))


def site_force(files: Sequence[Path], role: str, site: str, time: Times) -> Times:
    """Sum over the mats of one strap [N]; not a number where there is none."""
    forces = [strap_force(file, role, site, time) for file in files]
    return np.asarray(np.sum(forces, axis=0)) if forces else np.full(len(time), np.nan)


def strap_force(file: Path, role: str, site: str, time: Times) -> Times:
    """Normal force on the person, forwards positive [N]; InputError for pressures of cells that lie on no body."""
    names = read_table(file).channels
    if CELL in names:
        what = "is a mat's own recording: pressures of cells, and the mat is not registered to a body"
        remedy = (
            f"register it: run geocontact mat {file.name} with a scan of the {SCANS[site]} as `surface`, `landmarks`"
        )
        remedy += " and `layout`, and give the wrench.csv that it writes"
        raise InputError(file, "", what, remedy)
    found = columns_at(file, [FORWARDS if FORWARDS in names else NORMAL], role, time)[:, 0]
    _doubt_dropped(file, time, found)
    return found


def _doubt_dropped(file: Path, time: Times, force: Times) -> None:
    """A warning for a force that jumps to exactly 0 N, and comes back or stays there until the end."""
    edges = np.flatnonzero(np.diff(np.r_[False, force == 0.0, False].astype(int)))
    size = np.abs(force)
    most = float(np.nanmax(size, initial=0.0))
    for start, stop in zip(edges[::2], edges[1::2], strict=True):
        ends = stop == len(force)
        if start < 2 or (not ends and stop > len(force) - 2) or stop - start < OFF:
            continue
        before = _jump(time[:start], size[:start])
        after = 0.0 if ends else _jump(-time[stop:][::-1], size[stop:][::-1])
        if max(before, after) > DROPPED * most:
            when = f"from {time[start]:.2f} {'s on' if ends else f'to {time[stop - 1]:.2f} s'}"
            back = "" if ends else f" and {size[stop : stop + 2].max():.0f} N right after"
            what = f"is exactly 0 N {when}, {size[start - 2 : start].max():.0f} N right before{back}"
            reserve(f"{file}: the strap's force {what}: was its cell off? a strap that slackens does not jump")
            return


def _jump(time: Times, size: Times) -> float:
    """Force [N] that a recording ends with; 0 where it comes down so steadily that it soon is 0.

    A mat shows nothing below its threshold: a strap that slackens reads 0 N from there on.
    """
    near, far = np.interp(time[-1] - np.array([EDGE, EDGE + SLOPE]), time, size)
    return 0.0 if near <= (far - near) / SLOPE * (EDGE + SLACKENS) else float(size[-2:].max())


def site_shear(files: Sequence[Path], time: Times) -> Times | None:
    """Sum of the measured shear of one strap's files [N], along the segment, towards the hip; None where none has it.

    InputError where only some have it: their sum would lack the others' part.
    """
    having = [file for file in files if SHEAR in read_table(file).channels]
    if not having:
        return None
    lacking = [file for file in files if file not in having]
    if lacking:
        what = f"no column shear, which {having[0].name} of the same strap has"
        raise InputError(lacking[0], "", what, "give shear [N] in all files of a strap, or in none")
    return np.asarray(np.sum([_in_newtons(file, time) for file in having], axis=0))


def _in_newtons(file: Path, time: Times) -> Times:
    return np.asarray(np.interp(time, read_table(file).time, _shear_in(file)))


def _shear_in(file: Path) -> Float[np.ndarray, " s"]:
    """At the file's own times [N]."""
    return np.asarray(column_in_newtons(read_table(file), SHEAR, None)[0])


def confront_shear(files: StandingTrialFiles, shear: Times | None, normal: Times, time: Times) -> None:
    """A warning for shear beyond what friction can pass on under the net normal force of the mats."""
    if shear is None:
        return
    noise = float(np.linalg.norm([noise_of(_shear_in(file)) for file in files.strap]))
    found = friction_limit(shear, np.abs(normal), FRICTION, noise)
    if not found.kept:
        reserve(
            f"{files.name} strap: the measured shear exceeds friction {FRICTION:g} times the normal force for "
            f"{found.beyond:.0%} of the time, first at {time[found.first]:.2f} s (median ratio {found.usual:.2g}): "
            "does the strap's tension press on both sides, or is a unit another one?"
        )


def require_tracked(files: StandingTrialFiles, tracks: tuple[str, ...], study: Path, place: str) -> None:
    """InputError where a channel that is tracked has no file."""
    for channel, file, key in (
        ("rates", files.rates, "rates"),
        ("force", files.plates, "plates"),
        ("centre", files.plates, "plates"),
        ("torque", files.torques, "torques"),
        ("strap", next(iter([*files.strap, *sum(files.elsewhere.values(), ())]), None), "strap"),
    ):
        if channel in tracks and file is None:
            what = f"{channel} is tracked, and this trial has none"
            raise InputError(study, place, what, f"name its file as {key}, or leave {channel} out of tracks")
