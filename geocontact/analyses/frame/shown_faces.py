"""Faces of a mesh file that a region names and the sides of a splitting plane, for a picture of the file.

They are chosen by the functions that an analysis uses itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.frame import places
from geocontact.analyses.frame.bodies import chosen_faces, read_input_surface
from geocontact.analyses.frame.quantities import length
from geocontact.analyses.frame.shared_options import medial_side, refuse_other_axes
from geocontact.data.errors import InputError
from geocontact.geometry.plane import Plane
from geocontact.geometry.regions import Values
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.text.units import LENGTH

MM = 1e3
NORMAL = 1.0
"""Largest component of a unit normal."""


@dataclass(frozen=True)
class FaceQuestion:
    """What is asked of a mesh file, as typed into the options of an analysis; "" for what is not given.

    Parameters
    ----------
    surface, unit
        Mesh file and unit of its numbers.
    option, region
        Name of the option for the region, and what it holds.
    placement, merge_tolerance
        Values of the options `place` and `merge_tolerance`.
    assume_closed
        Whether the surface is taken for closed.
    split, side, medial
        Values of the options of these names.
    elsewhere
        Names, with commas between them, that the region may use and that only the analysis can compute.
    """

    surface: str
    unit: str
    option: str
    region: str = ""
    placement: str = ""
    merge_tolerance: str = ""
    assume_closed: bool = False
    split: str = ""
    side: str = ""
    medial: str = ""
    elsewhere: str = ""


@dataclass(frozen=True, eq=False)
class ShownFaces:
    """The answer.

    Parameters
    ----------
    chosen
        Faces that count, in the order of the file.
    box
        Least and largest values of x, y, z over face centroids (in the mesh unit) and of nx, ny, nz, in the frame of
        the body.
    area
        Area of these faces [mm^2].
    medial
        Plane n . x = d in the frame of the mesh file, [n, d] with x and d in mm; the medial side is n . x > d. None
        without a plane.
    scale
        Millimetres of the unit of the file.
    words
        Number and area of the faces that count, and which side is medial.
    """

    chosen: Bool[np.ndarray, " f"]
    box: list[tuple[float, float]]
    area: float
    medial: tuple[float, float, float, float] | None
    scale: float
    words: str


def body_of(asked: FaceQuestion) -> Surface:
    """The surface that faces are chosen on, in the frame of its body.

    Raises
    ------
    InputError
        As the analysis does; also where merging vertices leaves fewer faces than the file has.
    """
    merged = length(asked.merge_tolerance, "`merge_tolerance`", "mm") if asked.merge_tolerance else None
    path = Path(asked.surface)
    body = read_input_surface("surface", path, asked.unit, asked.placement or None, asked.assume_closed, merged)
    if merged is not None and len(read_mesh(path, asked.unit).faces) != len(body.faces):
        remedy = "the analysis counts them nevertheless"
        raise InputError(path, "", "has other faces once vertices are merged, which this picture does not show", remedy)
    return body


def shown_faces(asked: FaceQuestion, body: Surface) -> ShownFaces:
    """Faces that count on `body_of(asked)`, and the medial side; InputError as the analysis has it."""
    more = {name: _only_in_the_analysis(name) for name in asked.elsewhere.split(",") if name}
    faces = chosen_faces(asked.option, asked.region or None, body, asked.unit, more)
    chosen = np.ones(len(body.faces), bool) if faces is None else faces
    centroid = body.vertices[body.faces].mean(axis=1) / LENGTH[asked.unit]
    box = [(float(each.min()), float(each.max())) for each in centroid.T] + [(-NORMAL, NORMAL)] * 3
    area = float(body.face_area[chosen].sum()) * MM**2
    words = f"{int(chosen.sum())} of {len(chosen)} faces count, {area:.1f} mm^2"
    plane, sides = _medial(asked, body)
    return ShownFaces(chosen, box, area, plane, LENGTH[asked.unit] * MM, words + sides)


def _only_in_the_analysis(name: str) -> Values:
    def refuse() -> Float[np.ndarray, " m"]:
        raise ValueError(f"{name} depends on other options as well: the run has it, this picture has not")

    return refuse


def _medial(asked: FaceQuestion, body: Surface) -> tuple[tuple[float, float, float, float] | None, str]:
    """The plane in the frame of the file with its normal to the medial side, and words for it."""
    if not asked.split:
        return None, ""
    plane = places.splitting_plane(asked.split, asked.unit)
    side = medial_side(asked.split, asked.side or None, asked.medial or None)
    refuse_other_axes(body.space, body.name, asked.side or None, asked.medial or None)
    corner, *along = _heights(plane, body)
    scale = side.sign / float(np.linalg.norm([each - corner for each in along]))
    x, y, z = ((float(each) - float(corner)) * scale for each in along)
    return (x, y, z, -float(corner) * scale * MM), f"; medial is {side.words}"


def _heights(plane: Plane, body: Surface) -> Float[np.ndarray, " 4"]:
    """Heights over the plane of the origin of the file's frame and of the ends of its unit vectors [m]."""
    points = np.vstack([np.zeros(3), np.eye(3)])
    return plane.height(points if body.file is None else body.file.placed(points))
