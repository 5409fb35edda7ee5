"""Surfaces of mesh files and their motion: the bodies of an analysis, read, placed in their frames, checked for what
can be signed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Literal, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool

from geocontact.analyses.frame import places
from geocontact.analyses.frame.collector import add_input, reserve, say
from geocontact.analyses.frame.landmarks import (
    Picked,
    faces_of_landmarks,
    picked,
    points_named,
    region_kind,
)
from geocontact.analyses.frame.quantities import named_file
from geocontact.data.errors import InputError
from geocontact.data.mesh import AXES, Mesh
from geocontact.data.motion import Motion
from geocontact.geometry.placement import placed
from geocontact.geometry.regions import Values, faces_where
from geocontact.geometry.sagittal import Vector
from geocontact.geometry.surface import Surface
from geocontact.geometry.sweep import Axis
from geocontact.geometry.union import UnitedSurface, closed_pieces, united
from geocontact.io.mesh.faces import read_face_indices
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.motion.motion import read_motion
from geocontact.io.motion.poses import read_pose
from geocontact.io.opensim.osim_meshes import mesh_placement
from geocontact.io.text.file_preflight import BYTE_ORDER_MARK, read_bytes
from geocontact.io.text.units import LENGTH
from geocontact.trial_checks.mesh_checks import SurfacePair, surface_contradictions


@runtime_checkable
class MotionOptions(Protocol):
    """Options that say where poses come from; see `read_motion`."""

    @property
    def osim(self) -> Path | None:
        """Model whose joint turns coordinates into poses."""

    @property
    def joint(self) -> str | None:
        """Name of that joint."""

    @property
    def moving_body(self) -> Literal["child", "parent"] | None:
        """Which of its bodies moves."""

    @property
    def map(self) -> str | None:
        """Columns instead of a model."""

    @property
    def order(self) -> str | None:
        """Order of intrinsic rotations."""

    @property
    def angles(self) -> Literal["deg", "rad"] | None:
        """Unit of angles where the file does not say."""


def read_body_motion(file: Path, o: MotionOptions) -> Motion:
    """Poses over seconds; InputError where `order` or `angles` has no effect, or time is in per cent of a cycle."""
    motion = read_motion(
        file,
        osim=o.osim,
        joint=o.joint,
        moving=o.moving_body or "child",
        mapping=o.map,
        order=o.order,
        angles=o.angles,
    )
    for option, value in (("order", o.order), ("angles", o.angles)):
        if value is not None and option not in motion.heeded:
            what = f"has no effect here: {file} is read without it"
            raise InputError("", f"`{option}`", what, "leave it out")
    if motion.time_unit != "s":
        raise InputError(file, "", "time is in per cent of a cycle", "write its time in s: rates and loads need it")
    add_input("motion", file, frames=len(motion), source=motion.source)
    if o.osim is not None:
        add_input("model", o.osim, joint=o.joint)
    return motion


NOTHING: Mapping[str, Values] = MappingProxyType({})


def read_surface(
    path: str | PathLike[str], unit: str, assume_closed: bool = False, merge_tolerance: float | None = None
) -> Surface:
    """Surface of a mesh file whose numbers are in `unit` (m, cm, mm or in), ready for queries.

    Parameters
    ----------
    path
        `.stl`, `.ply`, `.obj`, `.off`, `.vtp` or `.step`; see `read_mesh`.
    unit
        Unit of the file's numbers. Never guessed.
    assume_closed
        Take it for the boundary of a body although edges are open, so that distances inside it are negative.
    merge_tolerance
        Distance [m] within which vertices are merged; see `read_mesh`.

    Raises
    ------
    InputError
        The file cannot be used.

    Examples
    --------
    >>> import geocontact as gc
    >>> ball = gc.read_surface("meshes/sphere_r20.stl", "mm")
    >>> ball.vertices.shape, ball.faces.shape, ball.closed
    ((1442, 3), (2880, 3), True)
    """
    return Surface.of(read_mesh(path, unit, merge_tolerance=merge_tolerance), assume_closed)


@runtime_checkable
class UnitsOfBodies(Protocol):
    """Options of two bodies whose meshes may be in two units."""

    @property
    def unit(self) -> str:
        """Unit of FIXED, and of MOVING by default."""

    @property
    def unit_moving(self) -> str | None:
        """Unit of MOVING where it is another one."""


def unit_of_moving(o: UnitsOfBodies) -> str:
    """Unit of MOVING's mesh and of places on it."""
    return o.unit_moving or o.unit


@contextmanager
def naming_unit_of_moving(o: UnitsOfBodies) -> Iterator[None]:
    """A remedy that speaks of `unit` is one about `unit_moving` where that is given."""
    try:
        yield
    except InputError as error:
        if o.unit_moving is None:
            raise
        remedy = error.remedy.replace("`unit`", "`unit_moving`")
        raise InputError(error.file, error.place, error.what, remedy) from error


def read_body(
    role: str,
    path: Path,
    unit: str,
    placement: str | None,
    assume_closed: bool,
    merge_tolerance: float | None = None,
) -> Surface:
    """Surface of one body that is pressed; warns of what about it needs care.

    `placement` and `merge_tolerance` are those of `read_input_surface`.
    """
    surface = read_input_surface(role, path, unit, placement, assume_closed, merge_tolerance)
    _warn_of_sides(role, surface, areas=False)
    return surface


def read_body_and_outer(
    role: str,
    path: Path,
    unit: str,
    placement: str | None,
    assume_closed: bool,
    merge_tolerance: float | None = None,
    *,
    areas: bool = True,
) -> tuple[Surface, UnitedSurface | None]:
    """The same, and its outer surface where closed surfaces of the file lie inside or across others, not warned of.

    `areas` is whether signed areas are written of it.
    """
    surface = _read_surface(role, path, unit, placement, assume_closed, merge_tolerance)
    _warn_of_sides(role, surface, areas=areas)
    return surface, united(surface)


def read_input_surface(
    role: str,
    path: Path,
    unit: str,
    placement: str | None,
    assume_closed: bool = False,
    merge_tolerance: float | None = None,
) -> Surface:
    """Surface in its body frame; says which anatomical axes its file names, warns of closed surfaces inside others.

    `placement` is a text file with a 4x4 matrix (translation in the mesh unit), or `model.osim:body[:mesh]`;
    `merge_tolerance` [m] is that of `read_mesh`.
    """
    surface = _read_surface(role, path, unit, placement, assume_closed, merge_tolerance)
    warn_of_inner_surfaces(surface)
    return surface


def warn_of_inner_surfaces(surface: Surface) -> None:
    """A reservation where a mesh holds closed surfaces that lie inside or across others."""
    found = united(surface)
    if found is not None:
        reserve(f"{found.reservation}; if they are not surface, remove them from the file")


def _read_surface(
    role: str, path: Path, unit: str, placement: str | None, assume_closed: bool, merge_tolerance: float | None
) -> Surface:
    mesh = read_mesh(path, unit, merge_tolerance=merge_tolerance)
    if placement is not None:
        mesh = _placed(role, mesh, placement, unit)
    surface = Surface.of(mesh, assume_closed)
    topology = surface.topology
    span = (mesh.vertices.max(axis=0) - mesh.vertices.min(axis=0)) * 1e3
    add_input(
        role,
        path,
        sha256=mesh.sha256,
        unit=unit,
        vertices=len(mesh.vertices),
        faces=len(mesh.faces),
        box_mm=[round(float(length), 4) for length in span],
        closed=topology.closed,
        open_edges=topology.open_edges,
        irregular_edges=topology.irregular_edges,
        closed_surfaces=closed_pieces(surface).count,
        area_mm2=round(float(surface.face_area.sum()) * 1e6, 4),
        median_edge_mm=_median_edge(surface),
        **({"space": mesh.space} if mesh.space else {}),
    )
    if mesh.space:
        say(f"{mesh.name}: its header says SPACE={mesh.space}, {AXES[mesh.space]}")
    return surface


def refuse_two_spaces(moving: Surface, fixed: Surface) -> None:
    """InputError for two bodies whose files name different anatomical axes; one that was placed names none."""
    if moving.space and fixed.space and moving.space != fixed.space:
        what = f"is in {moving.space} and {fixed.name} in {fixed.space}: their x and y point opposite ways"
        remedy = "export both from 3D Slicer with the same coordinate system, or turn one by half a turn about z with "
        raise InputError(moving.name, "", what, f"{remedy}`place_moving` (-1 0 0 0 / 0 -1 0 0 / 0 0 1 0 / 0 0 0 1)")


def check_surfaces(
    moving: Surface,
    fixed: Surface,
    roles: tuple[str, str] = ("MOVING", "FIXED"),
    bodies: tuple[str, str] | None = None,
    layered: bool = False,
    beside: tuple[str, ...] = (),
) -> None:
    """A warning for whatever two surfaces contradict each other in; arguments as of `SurfacePair`."""
    for one in surface_contradictions(SurfacePair(moving, fixed, roles, bodies, layered, beside)):
        reserve(str(one), cause=True)


def chosen_faces(
    option: str, text: str | None, surface: Surface, unit: str, more: Mapping[str, Values] = NOTHING
) -> Bool[np.ndarray, " f"] | None:
    """Faces named by an expression, by a file of face numbers or by landmarks; None when all count.

    `more` are names that the expression may use beside places and normals.
    """
    if text is None:
        return None
    if region_kind(text)[0]:
        return faces_of_landmarks(option, text, surface, unit)
    file = named_file(text)
    if file is not None:
        add_input(option, file)
        chosen = np.zeros(len(surface.faces), bool)
        chosen[read_face_indices(file, len(surface.faces))] = True
        return chosen
    try:
        chosen = faces_where(surface, text, LENGTH[unit], more)
    except ValueError as error:
        raise InputError("", option, str(error), "or give a file of face numbers") from error
    if not chosen.any():
        raise InputError("", option, f"{text!r} holds for no face of {surface.name}", "check axis, sign and unit")
    return chosen


def typed_axis(option: str, text: str, surface: Surface, unit: str) -> Axis:
    """Axis as typed, of a file, or from one landmark of a surface to another: FILE.csv:A:B."""
    given = picked(text)
    if given is not None and not _six_numbers(given):
        start, end = (np.array(point) for point in points_named(option, given, 2, surface, unit))
        try:
            return Axis((start[0], start[1], start[2]), tuple((end - start).tolist()))
        except ValueError as error:
            raise InputError(given.file, "", str(error), "name two landmarks that lie apart") from error
    file = named_file(text)
    if file is not None:
        add_input(option, file)
    return places.axis(text, unit)


def typed_centre(option: str, text: str, surface: Surface, unit: str) -> Vector:
    """Point as typed, centre of a fit, or a landmark of a surface: FILE.csv:NAME."""
    given = picked(text)
    if given is not None:
        return points_named(option, given, 1, surface, unit)[0]
    file = named_file(text)
    if file is not None:
        add_input(option, file)
    return places.centre(text, unit, option)


def _six_numbers(given: Picked) -> bool:
    """Whether a file holds the numbers of an axis and not a table of landmarks, which has letters."""
    if given.names or given.file.suffix.lower() != ".csv":
        return False
    text = read_bytes(given.file, places.LONGEST_AXIS, "give six numbers, or name two landmarks")
    return not any(chr(byte).isalpha() and byte not in b"eE" for byte in text.removeprefix(BYTE_ORDER_MARK))


def _placed(role: str, mesh: Mesh, placement: str, unit: str) -> Mesh:
    model, colon, body = placement.partition(".osim:")
    if colon:
        name, _, file = body.partition(":")
        matrix = mesh_placement(f"{model}.osim", name, file)
        add_input(f"placement of {role}", f"{model}.osim", body=name)
        return placed(mesh, matrix, LENGTH[unit])
    pose = read_pose(placement, unit)
    add_input(f"placement of {role}", placement)
    return placed(mesh, pose.as_matrix())


def _median_edge(surface: Surface) -> float:
    return round(float(np.median(surface.edge_length)) * 1e3, 4)


def _warn_of_sides(role: str, surface: Surface, *, areas: bool) -> None:
    """Reservations of inside and outside; without areas only MOVING's inside counts, in which layers are pressed."""
    other = {"moving": "area_fixed", "fixed": "area_moving"}[role]
    if not (surface.closed or areas):
        why = surface.topology.why_open or "it has no closed edge"
        if role == "moving":
            reserve(f"{surface.name} is open ({why}): it has no inside, so no force and pressure of it as MOVING")
    elif not surface.closed:
        why = surface.topology.why_open or "it has no closed edge"
        doubled = f"; its doubled faces alone keep it open: see `assume_closed` {role}"
        reserve(f"{surface.name} is open ({why}): {other} is unsigned{doubled if surface.topology.closed_once else ''}")
    elif not surface.topology.closed:
        reserve(f"{surface.name} is treated as closed, as you requested ({surface.topology.why_open})")
    if surface.inside_out:
        reserve(f"{surface.name}: faces point inwards; taken the other way round")
    if surface.topology.closed and not surface.normals_trusted:
        reserve(f"{surface.name}: parts overlap or are turned over; inside is decided by the winding number")
