"""The equilibrium of every frame: what is typed and read, and what the frames came to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.frame import places, quantities
from geocontact.analyses.frame.bodies import (
    check_surfaces,
    chosen_faces,
    naming_unit_of_moving,
    read_body,
    refuse_two_spaces,
    typed_centre,
    unit_of_moving,
)
from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.layers import confined_modulus, measured_thickness
from geocontact.analyses.frame.shared_options import medial_side
from geocontact.analyses.knee.settle.options import LOAD, SettleOptions
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.data.multibody.knee_angles import angles_of_tibia
from geocontact.geometry.curvature import corner_normals
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import surface_quadrature
from geocontact.geometry.sweep import swept_angles
from geocontact.io.motion.motion import read_motion
from geocontact.io.recordings.area_table import read_force_curves
from geocontact.io.text.units import ANGLE
from geocontact.loads.foundation import Layer, layer_loads, layer_on
from geocontact.loads.pressure_load import PressureLoad
from geocontact.loads.settling import Frame
from geocontact.loads.settling_potential import NAMES, Bed, poses_of
from geocontact.loads.start_pose import lowest_places
from geocontact.view.surfaces.vtp_series import require_pyvista

EXAMPLE = "anterior=30,rotation=0.36 (N/mm, N m/deg)"
PER_MM = ("anterior", "axial", "mediolateral")


def names(text: str, option: str) -> tuple[str, ...]:
    """ "adduction,rotation" to names; "none" to nothing."""
    return () if text.strip() == "none" else tuple(name.strip() for name in text.split(","))


def springs(text: str, option: str) -> dict[str, float]:
    """ "anterior=30,rotation=0.36" in N/mm and N m/deg to N/m and N m/rad by name."""
    found: dict[str, float] = {}
    for part in text.split(","):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals:
            raise InputError("", option, f"{part.strip()!r} is not name=value", f"write for example {EXAMPLE}")
        if name in found:
            raise InputError("", option, f"{name} is given twice", "give each once")
        number = quantities.number(value, option, EXAMPLE)
        found[name] = number * 1e3 if name in PER_MM else number / ANGLE["deg"]
    return found


PIECE = 0.5e-3  # m; longest edge of a piece by default
FAR = 3.0  # sizes of MOVING that its point may be away from it


@dataclass(frozen=True, eq=False)
class SettleInputs:
    """Bodies, the layer, and what is given in each frame.

    Parameters
    ----------
    fixed
        The body that the layer belongs to.
    bed
        MOVING over the layer.
    motion
        Poses of MOVING in FIXED.
    load
        Axial load of each frame [N].
    springs
        Of each coordinate [N/m, N m/rad].
    free
        Which coordinates settle, in the order of `NAMES`.
    medial
        Unit vector towards medial in FIXED's frame.
    """

    fixed: Surface
    bed: Bed
    motion: Motion
    load: Float[np.ndarray, " t"]
    springs: Float[np.ndarray, " 6"]
    free: Bool[np.ndarray, " 6"]
    medial: Float[np.ndarray, " 3"]

    @property
    def clock(self) -> str:
        """Column of the frames' times."""
        return "time [s]" if self.motion.time_unit == "s" else "cycle [%]"

    @property
    def title(self) -> str:
        """Heading of figures and pages."""
        return f"MOVING {self.bed.moving.name} at rest on FIXED {self.fixed.name}"


def read(o: SettleOptions) -> SettleInputs:
    """Everything the options name."""
    if o.paraview:
        require_pyvista()
    closed = {body: o.assume_closed in (body, "both") for body in ("moving", "fixed")}
    with naming_unit_of_moving(o):
        moving = read_body("moving", o.moving, unit_of_moving(o), o.place_moving, closed["moving"], o.merge_tolerance)
    fixed = read_body("fixed", o.fixed, o.unit, o.place_fixed, closed["fixed"], o.merge_tolerance)
    refuse_two_spaces(moving, fixed)
    beside = (*(() if o.motion is None else (o.motion.name,)), f"`side` {o.side}")
    check_surfaces(moving, fixed, bodies=o.bodies, layered=True, beside=beside)
    if not moving.closed:
        what = f"{moving.name} is open ({moving.topology.why_open}): it has no inside, so there is no depth"
        raise InputError("", "", what, "close it, or see `assume_closed` moving")
    _doubt_bodies(o)
    recorded = None if o.motion is None else _motion(o, o.motion)
    bed = Bed(layer_of(fixed, o), moving, corner_normals(moving), _point(o, moving))
    motion = _swept(bed, fixed, o) if recorded is None else recorded
    springs = np.array([(o.springs or {}).get(name, 0.0) for name in NAMES])
    free = np.array([name in (*o.free, "axial") for name in NAMES])
    side = medial_side(o.split, o.side, None)
    medial = side.sign * np.eye(3)["xyz".index(side.axis)]
    return SettleInputs(fixed, bed, motion, _load(o, motion), springs, free, medial)


def _doubt_bodies(o: SettleOptions) -> None:
    """A warning where each of the two `bodies` is in the name of the other one's file, and neither in its own's."""
    if o.bodies is None:
        return
    files = o.moving.stem.lower(), o.fixed.stem.lower()
    own = [name.lower() in file for name, file in zip(o.bodies, files, strict=True)]
    other = [name.lower() in file for name, file in zip(o.bodies, files[::-1], strict=True)]
    if not any(own) and any(other):
        names = f"{o.bodies[0]} of {o.moving.name} and {o.bodies[1]} of {o.fixed.name}"
        reserve(f"`bodies`: {names}: are they exchanged? MOVING's comes first")


def layer_of(fixed: Surface, o: SettleOptions) -> Layer:
    """FIXED's layer in pieces, medial and lateral apart."""
    faces = chosen_faces("`region`", o.region, fixed, o.unit)
    try:
        pieces = surface_quadrature(fixed, PIECE if o.piece is None else o.piece, faces)
    except ValueError as error:
        raise InputError("", "`piece`", str(error), "give a longer edge") from error
    thickness = measured_thickness(fixed, pieces.point, pieces.normal, o.thickness, "`thickness`")
    medial = medial_side(o.split, o.side, None)
    plane = places.splitting_plane(o.split, o.unit)
    modulus = confined_modulus(o.modulus, o.poisson)
    return layer_on(fixed, pieces, thickness, modulus, o.foundation, (plane, medial.sign))


def _swept(bed: Bed, fixed: Surface, o: SettleOptions) -> Motion:
    """Lowest places of MOVING over the flexion asked for."""
    name, start, stop, step = o.sweep or ("flexion", 0.0, 0.0, 0.0)
    try:
        angle = swept_angles(start, stop, step)
        values = lowest_places(bed, fixed, angle)
    except ValueError as error:
        raise InputError("", "`sweep`", str(error), "check range, unit and frames, or give a `motion`") from error
    poses = poses_of(values, bed.point)
    return Motion(np.arange(len(angle), dtype=float), poses, f"sweep of {name}", coordinate=(name, angle))


def _motion(o: SettleOptions, file: Path) -> Motion:
    """Poses; every frame is at rest, so that a cycle in per cent will do."""
    motion = read_motion(
        file,
        osim=o.osim,
        joint=o.joint,
        moving=o.moving_body or "child",
        mapping=o.map,
        order=o.order,
        angles=o.angles,
    )
    for option in ("order", "angles"):
        if o.given(option) and option not in motion.heeded:
            raise InputError("", f"`{option}`", f"has no effect here: {file} is read without it", "leave it out")
    if o.forces is not None and motion.time_unit != "s":
        raise InputError(file, "", "time is in per cent of a cycle, that of `forces` in s", "give `load`")
    add_input("motion", file, frames=len(motion), source=motion.source)
    if o.osim is not None:
        add_input("model", o.osim, joint=o.joint)
    return motion


def _point(o: SettleOptions, moving: Surface) -> Float[np.ndarray, " 3"]:
    """Point of MOVING that the load acts at [m]."""
    if o.load_point is not None:
        return np.asarray(typed_centre("`load_point`", o.load_point, moving, unit_of_moving(o)), float)
    size = float(np.linalg.norm(moving.local[moving.used], axis=1).max())
    away = float(np.linalg.norm(moving.centre))
    if away > FAR * size:
        what = f"is missing: the origin of {moving.name} is {away * 1e3:.0f} mm away from it, too far for a load"
        x, y, z = moving.centre
        raise InputError("", "`load_point`", what, f"give a point in it; its middle is {x:.4g},{y:.4g},{z:.4g} m")
    return np.zeros(3)


def _load(o: SettleOptions, motion: Motion) -> Float[np.ndarray, " t"]:
    """Axial load at the motion's times [N]."""
    if o.forces is None:
        return np.full(len(motion), o.load, float)
    curves = read_force_curves(o.forces, None, {})
    add_input("`forces`", o.forces)
    if "total" not in curves.forces:
        raise InputError(o.forces, "", "no column total, and not both sides", "give total [N] over time [s]")
    time, total = curves.time, curves.forces["total"]
    if motion.time[0] < time[0] or motion.time[-1] > time[-1]:
        what = f"is known from {time[0]:g} to {time[-1]:g} s, the motion runs from "
        what += f"{motion.time[0]:g} to {motion.time[-1]:g} s"
        raise InputError(o.forces, "", what, "cut the motion to times at which the force is known")
    load = np.interp(motion.time, time, total)
    if not (load > 0.0).all():
        when = float(motion.time[np.argmin(load)])
        what = f"the load is {load.min():.4g} N at {when:g} s: nothing presses the bodies together"
        raise InputError(o.forces, "", what, "cut the motion to times under load")
    largest = float(load.max())
    if refusal := LOAD.refusal(largest):
        raise InputError(o.forces, "total", *refusal)
    if doubt := LOAD.doubt(largest):
        reserve(f"{o.forces}: its largest force, {doubt}")
    return np.asarray(load)


SIDES = ("medial", "lateral", "total")


@dataclass(frozen=True, eq=False)
class Settled:
    """What every frame came to; not a number where it came to no rest.

    Parameters
    ----------
    inputs, frames
        What was asked for, and what was found in each frame.
    side
        Side of the body.
    """

    inputs: SettleInputs
    frames: tuple[Frame, ...]
    side: str

    @cached_property
    def converged(self) -> Bool[np.ndarray, " t"]:
        """Frames at rest."""
        return np.array([frame.converged for frame in self.frames])

    @property
    def heaviest(self) -> int:
        """Frame at rest with the largest load."""
        return int(np.argmax(np.where(self.converged, self.inputs.load, -np.inf)))

    @cached_property
    def coordinates(self) -> Float[np.ndarray, "t 6"]:
        """Coordinates [m, rad], as `loads.settling_potential` has them."""
        lost = np.full(6, np.nan)
        return np.array([f.rest.total.values if f.rest and f.converged else lost for f in self.frames])

    @property
    def kept(self) -> np.ndarray:
        """Numbers of the frames at rest."""
        return np.flatnonzero(self.converged)

    @property
    def poses(self) -> RigidTransform:
        """Poses of MOVING in FIXED in the frames at rest."""
        return poses_of(self.coordinates[self.kept], self.inputs.bed.point)

    @cached_property
    def knee_angles(self) -> Float[np.ndarray, "t 3"]:
        """Flexion, adduction and internal rotation of Grood and Suntay [rad]."""
        found = np.full((len(self.frames), 3), np.nan)
        turned = self.poses.rotation.inv()
        found[self.kept] = np.column_stack(angles_of_tibia(turned, self.side))
        return found

    @cached_property
    def loads(self) -> list[dict[str, PressureLoad] | None]:
        """Load on FIXED of each compartment and of all; None without rest."""
        layer = self.inputs.bed.layer
        return [layer_loads(layer, f.rest.total.foundation) if f.rest and f.converged else None for f in self.frames]

    def forces(self, side: str) -> Float[np.ndarray, " t"]:
        """Force of one compartment, or of the "total", along the load [N]."""
        return self._each(side, lambda load: -float(load.wrench.force[1]))

    @property
    def peaks(self) -> Float[np.ndarray, " t"]:
        """Largest pressure [Pa]."""
        return self._each("total", lambda load: load.peak)

    @property
    def areas(self) -> Float[np.ndarray, " t"]:
        """Area of FIXED under pressure [m^2]."""
        return self._each("total", lambda load: load.area)

    def centres(self, side: str) -> Float[np.ndarray, "t 3"]:
        """Centre of pressure [m]."""
        lost = np.full(3, np.nan)
        return np.array([lost if load is None else load[side].centre for load in self.loads])

    @property
    def residuals(self) -> Float[np.ndarray, " t"]:
        """Remaining force [N]; also where that is too much."""
        return np.array([np.nan if f.rest is None else f.rest.residual for f in self.frames])

    @property
    def stored(self) -> Float[np.ndarray, " t"]:
        """Energy of layer and springs [J]."""
        return np.array([f.rest.total.stored if f.rest and f.converged else np.nan for f in self.frames])

    @property
    def largest_strain(self) -> float:
        """Largest strain of the layer [-]."""
        thickness = self.inputs.bed.layer.thickness
        states = [f.rest.total.foundation for f in self.frames if f.rest and f.converged]
        return max(float((state.depth / thickness[state.pressed]).max()) for state in states)

    def face_pressure(self, frame: int) -> Float[np.ndarray, " f"]:
        """Mean pressure of each face of FIXED [Pa]; 0 without rest."""
        faces, found = len(self.inputs.fixed.faces), self.frames[frame]
        if found.rest is None or not found.converged:
            return np.zeros(faces)
        state, pieces = found.rest.total.foundation, self.inputs.bed.layer.pieces
        pressure = np.zeros(len(pieces.area))
        pressure[state.pressed] = state.pressure
        return pieces.face_means(pressure, faces)

    def _each(self, side: str, value: Callable[[PressureLoad], float]) -> Float[np.ndarray, " t"]:
        return np.array([np.nan if load is None else value(load[side]) for load in self.loads])
