"""The foot as it is read: sole, force law, motion over the ground, and a force plate beside it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float, Int
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.analyses.cop.options import LAW, CopOptions
from geocontact.analyses.frame.bodies import read_body_motion, warn_of_inner_surfaces
from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.ground_words import LEVEL, plane_or_stairs
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.data.plausible import numbers_in
from geocontact.geometry.surface import Surface
from geocontact.identify.signals.filters import UNEVEN, zero_lag
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.mocap.force_plates import ForcePlate, plate_named, read_force_plates
from geocontact.io.motion.poses import read_pose
from geocontact.io.opensim.osim import bodies_at_rest, read_joint
from geocontact.io.opensim.osim_contact import read_contact_spheres
from geocontact.io.recordings.spheres import LawFile, SphereTable, read_law, read_spheres
from geocontact.loads.centre_of_pressure import CentreOfPressure
from geocontact.loads.ground import Ground, Sheet
from geocontact.loads.sphere_set import SoleLaw, SphereSet


def smoothed_motion(motion: Motion, cutoff: float | None, file: Path) -> Motion:
    """The motion through the filter; 0 Hz and None leave it as it is.

    Entries of the pose matrices are filtered, and the nearest rotation is taken (from the singular value
    decomposition): so it does not matter in which frame of the ground, or of the foot, the motion is given.
    """
    if not cutoff:
        return motion
    matrices = motion.poses.as_matrix().reshape(-1, 4, 4)
    smooth = low_passed(motion.time, matrices[:, :3].reshape(-1, 12), cutoff, file, "`motion_cutoff`").reshape(-1, 3, 4)
    left, _, right = np.linalg.svd(smooth[:, :, :3])
    poses = RigidTransform.from_components(smooth[:, :, 3], Rotation.from_matrix(left @ right))
    return replace(motion, poses=poses)


def smoothed_plate(plate: ForcePlate, cutoff: float | None, file: Path) -> ForcePlate:
    """Force and moment of a plate through the filter, at its own times."""
    if not cutoff:
        return plate
    w = plate.wrench
    force, moment = (low_passed(plate.time, each, cutoff, file, "`force_cutoff`") for each in (w.force, w.moment))
    return replace(plate, wrench=replace(w, force=force, moment=moment))


def low_passed(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t k"], cutoff: float, file: Path, option: str
) -> Float[np.ndarray, "t k"]:
    """Columns at even times through `zero_lag`; InputError where times are not even, a value is missing, or too few."""
    remedy = f"resample the recording, or leave {option} out"
    step = float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    if step == 0.0 or np.abs(np.diff(time) - step).max() > 2.0 * UNEVEN * step:
        raise InputError(file, "time", "is not evenly spaced, as a filter needs it", remedy)
    if not np.isfinite(values).all():
        raise InputError(file, "", "has gaps that a filter cannot cross", remedy)
    try:
        return zero_lag(values, step, cutoff)
    except ValueError as error:
        raise InputError(file, "", str(error), f"give another {option}") from error


SIZES = (50e-3, 100.0)  # m; diagonals of a ground's mesh that are plausible, from a plate to a walkway


def ground_of(o: CopOptions) -> Ground:
    """The plane, stairs or mesh that the option names."""
    text = LEVEL if o.ground is None else o.ground
    written = plane_or_stairs(text)
    if written is not None:
        if o.unit is not None:
            raise InputError("", "`unit`", "has no effect here: only a mesh needs a unit", "leave it out")
        return written
    path = Path(text)
    if not path.suffix:
        what = f"{text!r} is neither a file nor of a known form"
        raise InputError("", "`ground`", what, "write plane:nx,ny,nz,offset, stairs:h0,x1:h1, or name a mesh")
    if o.unit is None:
        raise InputError("", "`unit`", "is missing: mesh files carry no unit", "pass `unit` mm, cm, m or in")
    return _mesh(path, o.unit)


def _mesh(path: Path, unit: str) -> Ground:
    mesh = read_mesh(path, unit, plausible=SIZES)
    surface = Surface.of(mesh)
    add_input("ground", path, sha256=mesh.sha256, unit=unit, faces=len(mesh.faces), closed=surface.topology.closed)
    warn_of_inner_surfaces(surface)
    if surface.inside_out:
        reserve(f"{surface.name}: faces point inwards; taken the other way round")
    if surface.closed:
        return surface
    up = np.einsum("f,fi->i", surface.face_area, surface.face_normal)
    up /= max(float(np.linalg.norm(up)), 1e-30)
    reserve(
        f"{surface.name} is open ({surface.topology.why_open}): taken as a sheet, above is where its faces look, "
        f"on the whole ({up[0]:.2f}, {up[1]:.2f}, {up[2]:.2f})"
    )
    return Sheet(surface)


STIFFNESS, EXPONENT = 8e4, 1.2  # N/m^1.2: 75 N press a sphere 3 mm deep
DAMPING, FULL_DEPTH = 200.0, 2e-3  # N s/m, m
STATIC, KINETIC, THRESHOLD_SPEED = 0.9, 0.7, 0.25  # -, -, m/s: rubber on a laboratory floor


def sole_law(table: SphereTable, o: CopOptions) -> SoleLaw:
    """The law; a number that is given in two places is refused, one that is given nowhere has its default, told."""
    file = LawFile() if o.law is None else read_law(o.law)
    if o.law is not None:
        add_input("law", o.law)
    if file.foot is not None:
        reserve(f"{o.law}: [foot] is beside the standing trial of a prosthesis and has no effect here")
    _refuse_strange_zones(o, file, table)
    assumed: dict[str, float] = {}
    static, kinetic = (None, None) if o.friction is None else o.friction
    one = _Numbers(o, assumed)
    exponent = table.exponent if o.exponent is None and file.n is None else None  # the unit of k says it
    if exponent is None:
        exponent = one("exponent", "n", o.exponent, file.n, EXPONENT)
    if table.exponent is not None and table.exponent != exponent:
        what = f"column k is in N/m^{table.exponent:g} but the exponent is {exponent:g}"
        raise InputError("", "`exponent`", what, f"give `exponent` {table.exponent:g}")
    try:
        law = SoleLaw(
            stiffness=_each(one, table, file, "k"),
            damping=_each(one, table, file, "b"),
            exponent=exponent,
            full_depth=one("full_depth", "delta_full", o.full_depth, file.delta_full, FULL_DEPTH),
            static=_friction(one, table, file, "mu_s", static, STATIC),
            kinetic=_friction(one, table, file, "mu_k", kinetic, KINETIC),
            threshold_speed=one("threshold_speed", "v_th", o.threshold_speed, file.v_th, THRESHOLD_SPEED),
        )
    except InputError:
        raise
    except ValueError as error:
        raise InputError(o.law or "", "force law", str(error), "correct the number") from error
    _check_sizes(o, law)
    _tell_assumed(assumed, law)
    return law


def _check_sizes(o: CopOptions, law: SoleLaw) -> None:
    """Refuse numbers of files that a law cannot have, and warn of unusual ones; those of options are checked there."""
    found = {
        "k": None if o.stiffness is not None else (float(law.stiffness.min()), float(law.stiffness.max())),
        "b": None if o.damping is not None else (float(law.damping.min()), float(law.damping.max())),
        "n": None if o.exponent is not None else law.exponent,
        "delta_full": None if o.full_depth is not None else law.full_depth,
        "mu_s": None if o.friction is not None else (float(law.static.min()), float(law.static.max())),
        "mu_k": None if o.friction is not None else (float(law.kinetic.min()), float(law.kinetic.max())),
        "v_th": None if o.threshold_speed is not None else law.threshold_speed,
    }
    for name, known, value in numbers_in(LAW, found):
        if refusal := known.refusal(value):
            raise InputError(o.law or o.spheres, name, *refusal)
        if doubt := known.doubt(value):
            reserve(f"force law: {name}: {doubt}")


class _Numbers:
    """One number of the law from the options or the file; what neither gives is noted as assumed."""

    def __init__(self, o: CopOptions, assumed: dict[str, float]) -> None:
        self.options, self.assumed = o, assumed

    def __call__(self, option: str, key: str, given: float | None, filed: float | None, default: float) -> float:
        if given is not None and filed is not None:
            what = f"is given a second time by {key} in {self.options.law}"
            raise InputError("", f"`{option}`", what, "give it once")
        if given is None and filed is None:
            self.assumed[key] = default
            return default
        return given if given is not None else filed if filed is not None else default


UNITS = {"n": "", "b": " N s/m", "delta_full": " m", "mu_s": "", "mu_k": "", "v_th": " m/s"}


def _tell_assumed(assumed: dict[str, float], law: SoleLaw) -> None:
    """Say which numbers nobody gave, of those that have an effect."""
    idle = {"delta_full": not law.damping.any(), "v_th": not (law.static.any() or law.kinetic.any())}
    shown = [f"{key} = {assumed[key]:g}{unit}" for key, unit in UNITS.items() if key in assumed and not idle.get(key)]
    if shown:
        reserve(f"numbers of the force law that were not given are assumed: {', '.join(shown)}")


def _each(one: _Numbers, table: SphereTable, file: LawFile, key: str) -> Float[np.ndarray, " n"]:
    """k or b of every sphere."""
    option, given, filed, column, default = {
        "k": ("stiffness", one.options.stiffness, file.k, table.stiffness, STIFFNESS),
        "b": ("damping", one.options.damping, file.b, table.damping, DAMPING),
    }[key]
    zones = {name: value for name, zone in file.zone.items() if (value := getattr(zone, key)) is not None}
    if column is not None:
        if given is not None or filed is not None or zones:
            source = f"`{option}`" if given is not None else f"{key} in {one.options.law}"
            raise InputError("", source, f"has no effect with the column {key} of the spheres", "give it once")
        return column
    without = set(table.zone) - set(zones)
    rest = one(option, key, given, filed, default) if without or given is not None or filed is not None else default
    if key == "k" and key in one.assumed:
        where = "every sphere" if not zones else f"zone {', '.join(sorted(without))}"
        reserve(f"no stiffness given for {where}: {default:g} N/m^n is taken; forces are only as good as that")
    return np.array([zones.get(zone, rest) for zone in table.zone])


def _friction(
    one: _Numbers, table: SphereTable, file: LawFile, key: str, given: float | None, default: float
) -> Float[np.ndarray, " n"]:
    """Static or kinetic friction of every sphere."""
    zones = {name: value for name, zone in file.zone.items() if (value := getattr(zone, key)) is not None}
    without = set(table.zone) - set(zones)
    filed = getattr(file, key)
    rest = one("friction", key, given, filed, default) if without or given is not None or filed is not None else default
    return np.array([zones.get(zone, rest) for zone in table.zone])


def _refuse_strange_zones(o: CopOptions, file: LawFile, table: SphereTable) -> None:
    strange = sorted(set(file.zone) - set(table.zone))
    if strange:
        known = ", ".join(dict.fromkeys(table.zone))
        raise InputError(o.law or "", f"zone.{strange[0]}", "no sphere is in that zone", f"zones are: {known}")


ALIGNED = 0.7  # smallest cosine between our ground's normal and the plate's
AXES = "xyz"


@dataclass(frozen=True)
class PlateCurves:
    """What a plate shows at some of our frames, in our frame; NaN below the gate."""

    frames: Int[np.ndarray, " f"]
    force: Float[np.ndarray, "f 3"]
    centre: Float[np.ndarray, "f 3"]
    free_moment: Float[np.ndarray, " f"]


def chosen_plate(o: CopOptions) -> ForcePlate | None:
    """The plate to compare with, in our frame; None where none is asked for."""
    if o.compare is None:
        return None
    plate = plate_named(read_force_plates(o.compare, o.c3d_unit), o.plate, o.compare, "`plate`")
    add_input("`compare`", o.compare, plate=plate.name)
    if o.plate_pose is None:
        return plate
    pose = read_pose(o.plate_pose)
    add_input("`plate_pose`", o.plate_pose)
    wrench = plate.wrench.seen_from(pose, "ground")
    corners = None if plate.corners is None else pose.apply(plate.corners)
    point, normal = pose.apply(plate.point), pose.rotation.apply(plate.normal)
    return replace(plate, wrench=wrench, point=point, normal=normal, corners=corners)


def plate_curves(
    plate: ForcePlate, time: Float[np.ndarray, " t"], ours: CentreOfPressure, o: CopOptions
) -> PlateCurves:
    """The plate at our times within its own; its wrench is interpolated, and the centre follows from that."""
    path = o.compare or Path()
    inside = np.flatnonzero((time >= plate.time[0]) & (time <= plate.time[-1]))
    if not len(inside):
        what = f"runs from {plate.time[0]:g} to {plate.time[-1]:g} s, the motion from {time[0]:g} to {time[-1]:g} s"
        raise InputError(path, plate.name, what, "shift the clock of one of them")
    _refuse_other_frame(path, plate, ours)
    wrench = plate.at(time[inside])
    centre = wrench.centre_of_pressure(plate.point, plate.normal, o.gate)
    return PlateCurves(inside, wrench.force, centre, wrench.free_moment(centre, plate.normal))


def comparison_table(time: Float[np.ndarray, " t"], ours: CentreOfPressure, plate: PlateCurves) -> pd.DataFrame:
    """Ours, the plate's and the difference (ours - plate), one row per frame within the plate's recording."""
    at = plate.frames
    columns: dict[str, Float[np.ndarray, " f"]] = {"time [s]": time[at]}
    pairs = [(f"force_{axis} [N]", ours.wrench.force[at, k], plate.force[:, k]) for k, axis in enumerate(AXES)]
    pairs += [(f"cop_{axis} [m]", ours.centre[at, k], plate.centre[:, k]) for k, axis in enumerate(AXES)]
    pairs.append(("free_moment [N m]", ours.free_moment[at], plate.free_moment))
    for name, mine, theirs in pairs:
        columns |= {name: mine, f"plate_{name}": theirs, f"difference_{name}": mine - theirs}
    return pd.DataFrame(columns)


def root_mean_squares(table: pd.DataFrame) -> dict[str, float | None]:
    """Root mean square of each difference over the rows that have it; None where no row has."""
    differences = {str(name): table[name].dropna() for name in table.columns if str(name).startswith("difference_")}
    return {
        name.replace("difference_", "rms_"): float(np.sqrt(np.mean(values**2))) if len(values) else None
        for name, values in differences.items()
    }


def _refuse_other_frame(path: Path, plate: ForcePlate, ours: CentreOfPressure) -> None:
    normals = ours.normal[np.isfinite(ours.normal[:, 0])]
    if len(normals) and float((normals @ plate.normal).mean()) < ALIGNED:
        mine, theirs = (", ".join(f"{value:.2f}" for value in n) for n in (normals.mean(axis=0), plate.normal))
        what = f"its normal is ({theirs}), that of our ground ({mine})"
        raise InputError(path, plate.name, what, "give the pose of the plates' frame in ours with `plate_pose`")


@dataclass(frozen=True)
class Foot:
    """A sole with its law and its motion over the ground, and a force plate beside it where there is one."""

    name: str
    sole: SphereSet
    law: SoleLaw
    motion: Motion
    ground: Ground
    plate: ForcePlate | None


def read(o: CopOptions) -> Foot:
    """Everything the options name."""
    ground = ground_of(o)
    table = _spheres(o)
    add_input("spheres", o.spheres, spheres=len(table.radius))
    sole = SphereSet(table.centre, table.radius, table.zone)
    law = sole_law(table, o)
    _require_ground(o)
    motion = smoothed_motion(read_body_motion(o.motion, o), o.motion_cutoff, o.motion)
    plate = chosen_plate(o)
    if plate is not None and o.compare is not None:
        plate = smoothed_plate(plate, o.force_cutoff, o.compare)
    return Foot(o.spheres.name, sole, law, motion, ground, plate)


def _require_ground(o: CopOptions) -> None:
    """InputError for a joint whose other body moves: the foot's poses in it are none over the ground."""
    if o.osim is None or o.joint is None:
        return
    joint, at_rest = read_joint(o.osim, o.joint), bodies_at_rest(o.osim)
    foot, other = (joint.parent, joint.child) if o.moving_body == "parent" else (joint.child, joint.parent)
    if other not in at_rest:
        what = f"'{o.joint}' gives {foot} in {other}, which is not the ground"
        remedy = f"give poses of {foot} in the ground (.csv), or a joint of the ground"
        raise InputError(o.osim, "`joint`", what, remedy)


def _spheres(o: CopOptions) -> SphereTable:
    if o.spheres.suffix.lower() == ".osim":
        return read_contact_spheres(o.spheres, o.body)
    if o.body is not None:
        raise InputError(o.spheres, "`body`", "has no effect: the spheres are not those of a model", "leave it out")
    return read_spheres(o.spheres)
