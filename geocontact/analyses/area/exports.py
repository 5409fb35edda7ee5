"""Both bodies and their motion as models for other programs: FEBio, Abaqus, a model of OpenSim with the meshes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.analyses.area.bodies import Bodies
from geocontact.analyses.area.contact import AGREED, MotionResult
from geocontact.analyses.area.export_model import model_to_copy
from geocontact.analyses.area.options import AreaOptions
from geocontact.data.evolution import MM
from geocontact.data.version import VERSION
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import SurfaceQuadrature
from geocontact.io.finite_elements.abaqus import write_abaqus
from geocontact.io.finite_elements.febio import write_febio
from geocontact.io.finite_elements.rigid_pair import MPA_PER_MM, RigidPair
from geocontact.io.mesh.stl import write_stl
from geocontact.io.opensim.osim_attached import write_with_meshes
from geocontact.loads.overlap import overlap
from geocontact.loads.pressure_evolution import PressureEvolution

PROGRAM = f"geocontact {VERSION}"
EVEN = 0.01
"""Relative spread of a layer's thickness above which one stiffness for all of it is a simplification."""
THREE = np.full((3, 3), 1.0 / 6.0) + 0.5 * np.eye(3)
"""Barycentric coordinates of the points of a triangle at which FEBio takes the pressure unless asked (FE_TRI3G3)."""
GEOMETRY = "Geometry"
"""Folder beside a model where OpenSim looks for meshes."""
_WRITERS = {"febio": ("contact.feb", write_febio), "abaqus": ("contact.inp", write_abaqus)}


def write_exports(
    o: AreaOptions, programs: tuple[str, ...], bodies: Bodies, one: MotionResult, folder: Path
) -> list[str]:
    """Write the models of one motion into a folder of their own; what is to be said of them.

    `contact.feb` and `contact.inp` have both surfaces, the motion as it was, and where pressures were computed a
    contact law of one stiffness. A copy of the joint's model, under its own name, has the meshes on the joint's bodies.
    """
    folder.mkdir(exist_ok=True)
    notes: list[str] = []
    for name in programs:
        if name == "opensim":
            _write_model(o, bodies, folder)
            continue
        file, write = _WRITERS[name]
        pair = pair_of(o, bodies, one)
        write(folder / file, pair, PROGRAM)
        notes += [
            f"`export`: {line}"
            for line in (*_doubts(one.pressure), *_doubts_of_force(bodies, one), *_doubts_of_time(one))
        ]
    return list(dict.fromkeys(notes))


def pair_of(o: AreaOptions, bodies: Bodies, one: MotionResult) -> RigidPair:
    """Both surfaces with the motion, and the stiffness of the layer where pressures were computed."""
    fixed, moving, e = bodies.fixed, bodies.moving, one.pressure
    touching = bodies.settings.fixed_faces
    return RigidPair(
        time=one.motion.time,
        poses=one.motion.poses,
        fixed=(fixed.vertices, outward_faces(fixed)),
        moving=(moving.vertices, outward_faces(moving)),
        touching=None if touching is None else touching[_counted(fixed)],
        stiffness=None if e is None else stiffness_of(e),
        young=None if e is None else o.modulus,
        poisson=None if e is None else o.poisson,
        notes=(
            f"FIXED is {fixed.name}, MOVING is {moving.name}; all places are in FIXED's frame",
            f"time 0 is {one.motion.time[0]:g} {one.motion.time_unit} of the motion; MOVING's nodes are placed at it",
            *_law_words(e),
        ),
    )


def outward_faces(surface: Surface) -> Int[np.ndarray, "k 3"]:
    """Faces that have an area, each once, counter-clockwise seen from outside also where the file has them inwards."""
    faces = surface.faces[_counted(surface)]
    return np.asarray(faces[:, ::-1] if surface.inside_out else faces)


def _counted(surface: Surface) -> Bool[np.ndarray, " m"]:
    return np.asarray((surface.face_area > 0.0) & ~surface.repeated)


def force_of_triangles(bodies: Bodies, one: MotionResult, e: PressureEvolution) -> tuple[float, float]:
    """Pressure times area [N] of the written triangles in the frame of the largest force.

    Pressure is the exported stiffness times the depth below MOVING's triangles: over the pieces of the layer, and at
    the points where FEBio takes it. Depth is that to the nearest place; along FIXED's normals, as in FEBio, it is
    greater by one over the cosine between both surfaces.
    """
    pose, stiffness = one.motion.poses[e.heaviest], stiffness_of(e)
    rotation, translation = np.ascontiguousarray(pose.rotation.as_matrix()), np.asarray(pose.translation)

    def force(pieces: SurfaceQuadrature) -> float:
        depth = overlap(pieces, None, bodies.moving, rotation, translation, None).depth
        return stiffness * float(depth @ pieces.area)

    return force(e.layer.pieces), force(_three_points(bodies.fixed, np.unique(e.layer.pieces.face)))


def _three_points(surface: Surface, face: Int[np.ndarray, " k"]) -> SurfaceQuadrature:
    """Three points of each of these faces, with a third of its area."""
    point: Float[np.ndarray, "k 3 3"] = np.einsum("wc,kci->kwi", THREE, surface.vertices[surface.faces[face]])
    three = np.repeat(face, len(THREE))
    return SurfaceQuadrature(
        point.reshape(-1, 3), surface.face_area[three] / len(THREE), surface.face_normal[three], three
    )


def stiffness_of(e: PressureEvolution) -> float:
    """Pressure by depth [Pa/m] of a linear foundation of the median thickness; layers on both bodies are in series."""
    compliance = float(np.median(e.layer.thickness)) / e.layer.modulus
    if e.skin.thickness is not None:
        compliance += float(np.median(e.skin.thickness)) / e.skin.modulus
    return 1.0 / compliance


def _law_words(e: PressureEvolution | None) -> Iterator[str]:
    if e is None:
        yield "no contact law: pressures were not computed"
        return
    stiffness = stiffness_of(e) * MPA_PER_MM
    yield f"pressure = {stiffness:.6g} MPa/mm x depth: linear elastic foundation, confined modulus by thickness"


def _doubts(e: PressureEvolution | None) -> Iterator[str]:
    if e is None:
        yield "the models for finite elements have no contact law, since no pressures were computed (`pressure`)"
        return
    low, middle, high = (float(np.quantile(e.layer.thickness, q)) for q in (0.0, 0.5, 1.0))
    if high - low > EVEN * middle:
        yield (
            f"contact of the models has one stiffness, of the median thickness {middle * MM:.3g} mm; the layer is "
            f"{low * MM:.3g} to {high * MM:.3g} mm thick, so pressures differ"
        )
    if e.layer.law != "linear":
        yield f"contact of the models is linear, and `foundation` is {e.layer.law}: pressures differ at large strain"


def _doubts_of_force(bodies: Bodies, one: MotionResult) -> Iterator[str]:
    """Where triangles, which are flat in the models, do not press with the force that was computed."""
    e = one.pressure
    if e is None:
        return
    force, (flat, at_points) = e.loads[e.heaviest].pressing, force_of_triangles(bodies, one, e)
    if max(abs(flat - force), abs(at_points - force)) > AGREED * force:
        yield (
            f"triangles of the models are flat: in frame {e.heaviest + 1} of {len(one.motion)} they press with "
            f"{flat:.4g} N, and {at_points:.4g} N at the three points of each where FEBio takes pressures, but the "
            f"force computed here is {force:.4g} N; give finer meshes of both"
        )


def _doubts_of_time(one: MotionResult) -> Iterator[str]:
    if one.motion.time_unit != "s":
        yield f"time of the models is in {one.motion.time_unit}, as in the motion; velocities are by that"


def _write_model(o: AreaOptions, bodies: Bodies, folder: Path) -> None:
    """The joint's model with a mesh more on both of its bodies, in mm with scale factors of 0.001."""
    copied = model_to_copy(o)
    if copied is None:
        return
    source, joint = copied
    fixed, moving = (joint.parent, joint.child) if o.moving_body != "parent" else (joint.child, joint.parent)
    (folder / GEOMETRY).mkdir(exist_ok=True)
    attached = {}
    for body, part, surface in ((fixed, "fixed", bodies.fixed), (moving, "moving", bodies.moving)):
        _write_surface(folder / GEOMETRY / f"{part}.stl", surface, body)
        attached[body] = (f"geocontact_{part}", f"{part}.stl")
    write_with_meshes(source, folder / source.name, attached, 1.0 / MM)


def _write_surface(file: Path, surface: Surface, body: str) -> None:
    write_stl(file, surface.vertices[outward_faces(surface)] * MM, f"{surface.name} in the frame of {body}, mm")
