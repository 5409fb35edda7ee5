"""The foot as it is read: sole, force law, motion over the ground, and a force plate beside it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.analyses.cop.feet import (
    BESIDE,
    Carrier,
    bodies_by_foot,
    floor_of,
    joined,
    law_of_model,
    read_motions,
    read_tables,
    seen_from_first,
)
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.cop.plates import plates_under
from geocontact.analyses.frame.bodies import warn_of_inner_surfaces
from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.ground_words import LEVEL, plane_or_stairs
from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import blocks, parts, release, room
from geocontact.data.motion import MATRIX, Motion, poses_in_parts
from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.data.plausible import FOOT_LAW, numbers_in
from geocontact.geometry.shapes import HalfSpace
from geocontact.geometry.surface import Surface
from geocontact.identify.signals.filters import UNEVEN, zero_lag
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.opensim.osim import bodies_at_rest, read_joint
from geocontact.io.recordings.spheres import LawFile, SphereTable, read_law
from geocontact.loads.ground import Ground, Sheet, Stairs, ground_of_surface
from geocontact.loads.opensim_law import OpenSimLaw
from geocontact.loads.sole_law import law_of_sole
from geocontact.loads.sphere_set import SoleLaw, SphereSet


def smoothed_motion(motion: Motion, cutoff: float | None, file: Path) -> Motion:
    """The motion through the filter; 0 Hz and None leave it as it is.

    Entries of the pose matrices are filtered, and the nearest rotation is taken (from the singular value
    decomposition): so it does not matter in which frame of the ground, or of the foot, the motion is given.
    """
    if not cutoff:
        return motion
    rows = room((len(motion), 12))
    for some in blocks(len(motion), MATRIX):
        rows[some] = motion.poses[some].as_matrix()[:, :3].reshape(-1, 12)
        release()

    def nearest(row: Float[np.ndarray, "t 12"]) -> RigidTransform:
        smooth = row.reshape(-1, 3, 4)
        left, _, right = np.linalg.svd(smooth[:, :, :3])
        return RigidTransform.from_components(smooth[:, :, 3], Rotation.from_matrix(left @ right))

    return replace(
        motion, poses=poses_in_parts(nearest, low_passed(motion.time, rows, cutoff, file, "`motion_cutoff`"))
    )


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
    if not all(np.isfinite(part).all() for (part,) in parts(values)):
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
    return _mesh(path, o.unit, o.merge_tolerance)


def _mesh(path: Path, unit: str, merge_tolerance: float | None) -> Ground:
    mesh = read_mesh(path, unit, plausible=SIZES, merge_tolerance=merge_tolerance)
    surface = Surface.of(mesh)
    add_input("ground", path, sha256=mesh.sha256, unit=unit, faces=len(mesh.faces), closed=surface.topology.closed)
    warn_of_inner_surfaces(surface)
    if surface.inside_out:
        reserve(f"{surface.name}: faces point inwards; taken the other way round")
    ground = ground_of_surface(surface)
    if isinstance(ground, Sheet):
        x, y, z = ground.up
        reserve(
            f"{surface.name} is open ({surface.topology.why_open}): taken as a sheet; its upper side is the one to "
            f"which its faces point on average ({x:.2f}, {y:.2f}, {z:.2f})"
        )
    return ground


def sole_law(table: SphereTable, o: CopOptions) -> SoleLaw:
    """The law; a number that is given in two places is refused, one that is given nowhere is assumed with a warning."""
    file = LawFile() if o.law is None else read_law(o.law)
    if o.law is not None:
        add_input("law", o.law)
    if file.columns is not None:
        raise InputError(o.law or "", "columns", "k and b are of columns of foam", "give a law of spheres")
    if file.foot is not None:
        reserve(f"{o.law}: [foot] is an offset from the standing trial of a prosthesis and has no effect here")
    columns = {key: each for key, each in (("k", table.stiffness), ("b", table.damping)) if each is not None}
    zones = {name: zone.model_dump(exclude_none=True) for name, zone in file.zone.items()}
    given = _numbers(o, file, table.exponent, columns)
    for key in columns:
        if any(key in zone for zone in zones.values()):
            raise _beside_column(f"{key} in {o.law}", key)
    try:
        law, assumed = law_of_sole(table.zone, given, zones, columns)
    except InputError as error:
        raise replace(error, file=o.law or "") from error
    except ValueError as error:
        raise InputError(o.law or "", "force law", str(error), "correct the number") from error
    if "k" in assumed:
        without = sorted({zone for zone in table.zone if "k" not in zones.get(zone, {})})
        some = any("k" in zone for zone in zones.values())
        where = f"zone {', '.join(without)}" if some else "every sphere"
        reserve(f"no stiffness given for {where}: {assumed['k']:g} N/m^n is taken; forces depend on this value")
    _check_sizes(o, law)
    shown = [f"{key} = {assumed[key]:g}{unit}" for key, unit in UNITS.items() if key in assumed]
    if shown:
        reserve(f"numbers of the force law that were not given are assumed: {', '.join(shown)}")
    return law


UNITS = {"n": "", "b": " N s/m", "delta_full": " m", "mu_s": "", "mu_k": "", "v_th": " m/s"}


def _numbers(o: CopOptions, file: LawFile, exponent: float | None, columns: Collection[str]) -> dict[str, float]:
    """Numbers for all spheres by key, from the options or the file; `exponent` is the n that the unit of k names."""
    static, kinetic = (None, None) if o.friction is None else o.friction
    found: dict[str, float] = {}
    for key, option, given in (
        ("n", "exponent", o.exponent),
        ("k", "stiffness", o.stiffness),
        ("b", "damping", o.damping),
        ("delta_full", "full_depth", o.full_depth),
        ("mu_s", "friction", static),
        ("mu_k", "friction", kinetic),
        ("v_th", "threshold_speed", o.threshold_speed),
    ):
        filed = getattr(file, key)
        if key in columns and (given is not None or filed is not None):
            raise _beside_column(f"`{option}`" if given is not None else f"{key} in {o.law}", key)
        if given is not None and filed is not None:
            raise InputError("", f"`{option}`", f"is given a second time by {key} in {o.law}", "give it once")
        number = given if given is not None else filed
        if number is not None:
            found[key] = number
    if exponent is not None and found.setdefault("n", exponent) != exponent:
        what = f"column k is in N/m^{exponent:g} but the exponent is {found['n']:g}"
        raise InputError("", "`exponent`", what, f"give `exponent` {exponent:g}")
    return found


def _beside_column(source: str, key: str) -> InputError:
    return InputError("", source, f"has no effect with the column {key} of the spheres", "give it once")


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
    for name, known, value in numbers_in(FOOT_LAW, found):
        if refusal := known.refusal(value):
            raise InputError(o.law or o.spheres, name, *refusal)
        if doubt := known.doubt(value):
            reserve(f"force law: {name}: {doubt}")


def up_of(ground: Ground) -> Float[np.ndarray, " 3"] | None:
    """Which way is up on a plane, on stairs and on a sheet; None on a closed mesh, which does not say."""
    if isinstance(ground, HalfSpace):
        return np.asarray(ground.normal, float)
    return np.asarray(ground.up, float) if isinstance(ground, Stairs | Sheet) else None


@dataclass(frozen=True)
class Foot:
    """A sole with its law and its motion over the ground, and force plates beside it where there are some.

    Parameters
    ----------
    name
        Of the file of its spheres.
    sole, motion
        All spheres in the frame of the first body, and its motion: those of another body as in the first frame.
    law
        Of all spheres.
    plates
        Plate under each foot, by the foot's name.
    carriers
        Each body with its own spheres and motion, in the order of the spheres; of one foot or of several.
    weight
        Of the model through whose chain they move [N]; 0 without one.
    """

    name: str
    sole: SphereSet
    law: SoleLaw | OpenSimLaw
    motion: Motion
    ground: Ground
    plates: Mapping[str, ForcePlate]
    carriers: tuple[Carrier, ...]
    weight: float

    @property
    def feet(self) -> tuple[str, ...]:
        """Names of the feet."""
        return tuple(dict.fromkeys(one.foot for one in self.carriers))


def read(o: CopOptions) -> Foot:
    """Everything the options name."""
    feet = bodies_by_foot(o)
    _require_one_foot(o, len(feet))
    bodies = [body for own in feet.values() for body in own]
    ground = ground_of(o)
    tables, forces = read_tables(o, bodies)
    table = joined(tables)
    add_input("spheres", o.spheres, spheres=len(table.radius))
    law = sole_law(table, o) if forces is None else law_of_model(forces, table.radius, o.spheres)
    if forces is not None and o.ground is None:
        ground = floor_of(forces, o)
    _require_ground(o)
    soles = [SphereSet(each.centre, each.radius, each.zone) for each in tables]
    names = [foot for foot, own in feet.items() for _ in own]
    motions, weight = read_motions(o, bodies)
    motions = [smoothed_motion(motion, o.motion_cutoff, o.motion) for motion in motions]
    carriers = tuple(Carrier(*each) for each in zip(names, soles, motions, strict=True))
    sole, motion = seen_from_first(carriers), motions[0]
    up = up_of(ground)
    plates = {
        name: smoothed_plate(plate, o.force_cutoff, o.compare or o.motion)
        for name, plate in plates_under(o, carriers, up).items()
    }
    return Foot(o.spheres.name, sole, law, motion, ground, plates, carriers, weight)


def _require_one_foot(o: CopOptions, feet: int) -> None:
    """InputError for what is of one foot where there are several."""
    for name, given in (("toe", o.toe), ("stances", o.stances)):
        if feet > 1 and given:
            one, *others = (o.body or "").split(BESIDE)
            remedy = f"give `body` {one}, then run it again with {BESIDE.join(others)}"
            raise InputError("", f"`{name}`", f"is of one foot, `body` names {feet}", remedy)


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
