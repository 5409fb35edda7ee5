"""Force plates under the feet, found by place or named, and what they show beside the spheres.

A plate is under the foot that the line between its two spheres farthest apart is nearest to, in the median of the
plate's loaded centre of pressure, seen along the plate's normal: within `BESIDE_FOOT`, and half as far as from any
other foot.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.cop.feet import BESIDE, Carrier, seen_from_first
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.frame.collector import add_input, reserve, say
from geocontact.analyses.frame.words import counted
from geocontact.analyses.motion.checked_trial import check_trial, turned_plates
from geocontact.analyses.motion.markers import turn_of
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.data.multibody.force_plate import ForcePlate, sum_of
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.sides import stem_and_side
from geocontact.data.wrench import Wrench
from geocontact.io.mocap.force_plates import plate_named, read_force_plates
from geocontact.io.motion.poses import read_pose
from geocontact.io.text.results import frame_of
from geocontact.loads.centre_of_pressure import CentreOfPressure
from geocontact.loads.plate_load import PlateCurves, load_on_plate, same_way_up
from geocontact.loads.sphere_set import SphereSet
from geocontact.standing_up.plate_places import from_line
from geocontact.trial_checks.recorded import UP, FootPlate, TrialInputs

AXES = "xyz"
FOOT = "foot"
"""Column of a comparison of several feet."""
BESIDE_FOOT = 0.09
"""m, from a foot's line, in the median, as for plates of `sit-to-stand`."""
ONE_LEVEL = 5e-3
"""m, by which the surfaces of plates under one foot may differ in height: their loads are added up."""
REMEDY = "check `axes` and `plate_pose`, or name the plates with `plate`"


def plates_under(
    o: CopOptions, carriers: Sequence[Carrier], up: Float[np.ndarray, " 3"] | None
) -> dict[str, ForcePlate]:
    """The plate under each foot by its name, in our frame, in which `up` is upwards; none where none is asked for.

    That of one foot is named, or the only one; those of several are named in their order, or found by place.
    """
    if o.compare is None:
        return {}
    plates = turned_plates(
        read_force_plates(o.compare, o.c3d_unit), turn_of(o.axes), o.compare, UP if up is None else up
    )
    soles = {name: [one for one in carriers if one.foot == name] for name in dict.fromkeys(c.foot for c in carriers)}
    pose = None if o.plate_pose is None else read_pose(o.plate_pose)
    if o.plate_pose is not None:
        add_input("`plate_pose`", o.plate_pose)
    if len(soles) > 1 and o.plate is None:
        found = _by_place(plates, pose, soles, o.compare)
    else:
        names = [o.plate] if len(soles) == 1 or o.plate is None else [name.strip() for name in o.plate.split(BESIDE)]
        if len(names) != len(soles):
            what = f"names {counted(len(names), 'plate')} for {len(soles)} feet"
            raise InputError("", "`plate`", what, "name one for each foot of `body`, or leave it out")
        named = [plate_named(plates, name, o.compare, "`plate`") for name in names]
        if len({id(plate) for plate in named}) < len(named):
            raise InputError("", "`plate`", f"{o.plate} names a plate twice", "name each plate once")
        found = {name: _placed(plate, pose) for name, plate in zip(soles, named, strict=True)}
    add_input("`compare`", o.compare, plate=BESIDE.join(plate.name for plate in found.values()))
    for name, plate in found.items():
        own = soles[name]
        _check(seen_from_first(own), own[0].motion, plate, o, up, name)
    return found


def _placed(plate: ForcePlate, pose: RigidTransform | None) -> ForcePlate:
    """The plate in our frame, where `pose` is that of its own."""
    if pose is None:
        return plate
    wrench = plate.wrench.seen_from(pose, "ground")
    corners = None if plate.corners is None else pose.apply(plate.corners)
    point, normal = pose.apply(plate.point), pose.rotation.apply(plate.normal)
    return replace(plate, wrench=wrench, point=point, normal=normal, corners=corners)


def _check(
    sole: SphereSet,
    motion: Motion,
    plate: ForcePlate,
    o: CopOptions,
    up: Float[np.ndarray, " 3"] | None,
    name: str,
) -> None:
    """The plate against the foot: heel and toes lie below the two spheres of the sole that are farthest apart."""
    ends = _ends(sole)
    above = plate.normal if up is None else up
    places = np.stack(
        [motion.poses.apply(sole.centre[k]).reshape(-1, 3) - sole.radius[k] * above for k in ends], axis=1
    )
    foot = MarkerTrajectories(motion.time, places, ("heel", "toe"), str(o.motion))
    side = stem_and_side(name)[1]
    if side:
        foot = replace(foot, names=tuple(f"{side}{name}" for name in foot.names))
    on = FootPlate(plate, str(o.compare), side)
    turn = turn_of(o.axes)
    check_trial(TrialInputs(foot, plates=(on,), up=above, turn=turn, on_sole=True))


def _by_place(
    plates: tuple[ForcePlate, ...],
    pose: RigidTransform | None,
    soles: Mapping[str, Sequence[Carrier]],
    file: Path,
) -> dict[str, ForcePlate]:
    """Plates under each foot, added up; warnings for a foot without one and for a plate under several feet.

    What makes a plate useless, such as the force on the plate in place of that on the foot, is an InputError under a
    foot and where no plate is found, and a warning where another foot has none.
    """
    under: dict[str, list[ForcePlate]] = {name: [] for name in soles}
    nearest = np.inf
    for each in plates:
        plate = _placed(each, pose)
        away = {name: _away(plate, own) for name, own in soles.items()}
        if not np.isfinite(list(away.values())).any():
            continue
        name = min(away, key=lambda foot: away[foot])
        rest = min(other for foot, other in away.items() if foot != name)
        nearest = min(nearest, away[name])
        if away[name] <= BESIDE_FOOT and away[name] < 0.5 * rest:
            plate_named(plates, each.name, file, "`plate`")
            under[name].append(plate)
            say(f"plate {plate.name} is under {name} ({1e3 * away[name]:.0f} mm)")
        elif away[name] <= BESIDE_FOOT:
            reserve(f"{file} {plate.name}: carries several feet, whose loads one plate does not separate: not compared")
    found = {name: _added(own, file) for name, own in under.items() if own}
    if len(found) < len(soles):
        used = {plate.name for own in under.values() for plate in own}
        _explain([plate for plate in plates if plate.name not in used], plates, file, bool(found))
    if not found:
        loaded = np.isfinite(nearest)
        where = f"no plate is under one foot alone; the nearest is {nearest:.2f} m from one" if loaded else "no load"
        raise InputError(file, "", f"{where} during the motion", REMEDY)
    missing = [name for name in under if name not in found]
    if missing:
        others = ", ".join(plate.name for plate in found.values())
        what = f"no plate is under {', '.join(missing)} alone: not compared"
        reserve(f"{file}: {what}; does {others} carry both feet, of which one bears more?")
    return found


def _explain(others: Sequence[ForcePlate], plates: tuple[ForcePlate, ...], file: Path, warn: bool) -> None:
    """InputError for a plate that is not sound, a warning in its place if so asked for."""
    for plate in others:
        try:
            plate_named(plates, plate.name, file, "`plate`")
        except InputError as error:
            if not warn:
                raise
            reserve(str(error))


def _ends(sole: SphereSet) -> tuple[int, int]:
    """The two spheres that are farthest apart."""
    apart = np.linalg.norm(sole.centre[:, None] - sole.centre[None], axis=2)
    one, other = np.unravel_index(int(np.argmax(apart)), apart.shape)
    return int(one), int(other)


def _away(plate: ForcePlate, own: Sequence[Carrier]) -> float:
    """Distance of the loaded centre of pressure from a foot's line, along the plate, in the median [m]; infinite
    without load during the motion.
    """
    motion, sole = own[0].motion, seen_from_first(own)
    heavy = plate.heavy(motion.time[0], motion.time[-1])
    if not heavy.any():
        return float("inf")
    heel, toe = (_at(plate.time[heavy], motion, sole.centre[k]) for k in _ends(sole))
    flat = np.eye(3) - np.outer(plate.normal, plate.normal)
    return float(np.median(from_line(plate.centre_of_pressure()[heavy] @ flat, heel @ flat, toe @ flat)))


def _at(time: Float[np.ndarray, " s"], motion: Motion, place: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "s 3"]:
    """A place of the foot over time, in the ground [m]."""
    over = motion.poses.apply(place).reshape(-1, 3)
    return np.column_stack([np.interp(time, motion.time, column) for column in over.T])


def _added(plates: Sequence[ForcePlate], file: Path) -> ForcePlate:
    """Plates under one foot as one: their loads about the origin are added up."""
    first, *others = plates
    if not others:
        return first
    names = " + ".join(plate.name for plate in plates)
    rise = max(abs(float((plate.point - first.point) @ first.normal)) for plate in others)
    if rise > ONE_LEVEL or any(not np.array_equal(plate.time, first.time) for plate in others):
        what = f"lie {1e3 * rise:.0f} mm apart in height, or have other times"
        raise InputError(file, names, what, "name one plate for each foot with `plate`")
    force, moment = sum_of([plate.wrench.moved_to(np.zeros(3)) for plate in plates])
    wrench = Wrench(force, moment, np.zeros_like(force), first.wrench.frame)
    return replace(first, name=names, wrench=wrench, corners=None)


def plate_curves(
    plate: ForcePlate, time: Float[np.ndarray, " t"], ours: CentreOfPressure, o: CopOptions
) -> PlateCurves:
    """The plate at our times within its own; InputError where there are none, or its normal is not that of ours."""
    path = o.compare or Path()
    inside = np.flatnonzero((time >= plate.time[0]) & (time <= plate.time[-1]))
    if not len(inside):
        what = f"runs from {plate.time[0]:g} to {plate.time[-1]:g} s, the motion from {time[0]:g} to {time[-1]:g} s"
        raise InputError(path, plate.name, what, "shift the clock of one of them")
    if not same_way_up(ours.normal, plate.normal):
        mean = np.nanmean(ours.normal, axis=0)
        mine, theirs = (", ".join(f"{value:.2f}" for value in n) for n in (mean, plate.normal))
        what = f"its normal is ({theirs}), that of our ground ({mine})"
        raise InputError(path, plate.name, what, "give the pose of the plates' frame in ours with `plate_pose`")
    return load_on_plate(inside, plate.at(time[inside]), plate.point, plate.normal, o.gate)


def comparison_table(time: Float[np.ndarray, " t"], ours: CentreOfPressure, plate: PlateCurves) -> pd.DataFrame:
    """Ours, the plate's and the difference (ours - plate), one row per frame within the plate's recording."""
    at = plate.frames
    columns: dict[str, Float[np.ndarray, " f"]] = {"time [s]": time[at]}
    pairs = [(f"force_{axis} [N]", ours.wrench.force[at, k], plate.force[:, k]) for k, axis in enumerate(AXES)]
    pairs += [(f"cop_{axis} [m]", ours.centre[at, k], plate.centre[:, k]) for k, axis in enumerate(AXES)]
    pairs.append(("free_moment [N m]", ours.free_moment[at], plate.free_moment))
    for name, mine, theirs in pairs:
        columns |= {name: mine, f"plate_{name}": theirs, f"difference_{name}": mine - theirs}
    return frame_of(columns)


def root_mean_squares(table: pd.DataFrame) -> dict[str, float | None]:
    """Root mean square of each difference over the rows that have it; None where no row has."""
    differences = {str(name): table[name].dropna() for name in table.columns if str(name).startswith("difference_")}
    return {
        name.replace("difference_", "rms_"): float(np.sqrt(np.mean(values**2))) if len(values) else None
        for name, values in differences.items()
    }


def compared(table: pd.DataFrame | None) -> dict[str, pd.DataFrame]:
    """Comparisons by foot, without a name where there is one foot; none without a table."""
    if table is None:
        return {}
    if FOOT not in table.columns:
        return {"": table}
    return {str(name): rows.drop(columns=FOOT) for name, rows in table.groupby(FOOT, sort=False)}
