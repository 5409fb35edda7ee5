"""The page of one surface, on which landmarks are picked: what `geocontact view SURFACE.stl` shows."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import current
from geocontact.analyses.frame.landmarks import check_mesh
from geocontact.data.errors import InputError
from geocontact.data.mesh import AXES, Mesh
from geocontact.data.version import VERSION
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import READERS, read_mesh
from geocontact.io.recordings.landmarks import read_landmarks
from geocontact.io.text.file_preflight import open_file
from geocontact.io.text.units import LENGTH
from geocontact.view.page.content import MeshSource, Page, Scene, SceneBody, SetLandmark, Table, Words
from geocontact.view.page.write import write_page

WAYS = {
    f"{sign}{axis}": tuple(turn * float(axis == other) for other in "xyz")
    for axis in "xyz"
    for sign, turn in (("+", 1.0), ("−", -1.0))
}
HOW = (
    (
        "Press “pick points” and click the surface; name the points and save them. The file is a table with the "
        "coordinates in the unit and frame of the mesh file, its name and its SHA-256: a command that reads it refuses "
        "another mesh or another unit."
    ),
    (
        "Options that read it: region and segment, as polygon:FILE.csv or sphere:FILE.csv:NAME:12mm; axis, as "
        "FILE.csv:A:B; centre, first-corner and load-point, as FILE.csv:NAME; landmarks of mat, with row and column of "
        "the mat; body-landmarks and picked-on-body."
    ),
    "A landmark of a file keeps its coordinates until it is moved; one off the surface is shown at its nearest point.",
    "A vertex has the coordinates of the mesh file. A point on a face is as exact as the pixel clicked: zoom in.",
)


def is_surface(path: Path) -> bool:
    """Whether a path is that of a mesh file."""
    return path.is_file() and path.suffix.lower() in READERS


def surface_page(mesh: Mesh, landmarks: Path | None = None) -> Page:
    """The surface in the frame of its file, from all sides, with the landmarks of a file where one is named.

    Raises
    ------
    ValueError
        The mesh does not come from a file: landmarks are saved with its hash.
    InputError
        The landmarks cannot be read, or are those of another mesh or unit.
    """
    if mesh.file is None:
        raise ValueError(f"{mesh.name} does not come from a file")
    frame = f"that of the mesh file ({mesh.space}: {AXES[mesh.space]})" if mesh.space else "that of the mesh file"
    numbers = mesh.vertices / LENGTH[mesh.unit]
    standing = [] if landmarks is None else _standing(landmarks, mesh)
    source = MeshSource(mesh.name, mesh.sha256, mesh.unit, frame, numbers, standing)
    lower, upper = numbers.min(axis=0), numbers.max(axis=0)
    facts = [
        ("Faces", str(len(mesh.faces))),
        *((axis, f"{a:.6g} … {b:.6g} {mesh.unit}") for axis, a, b in zip("xyz", lower, upper, strict=True)),
    ]
    return Page(
        title=mesh.name,
        subtitle=f"coordinates in {mesh.unit}, frame {frame}; geocontact {VERSION}",
        time=np.zeros(1),
        time_label="time [s]",
        facts=facts,
        reservations=list(current().warnings),
        plays=False,
        sections=(
            Scene(
                bodies=[SceneBody(mesh.name, mesh.vertices, mesh.faces, source=source)],
                thresholds=(1e-3,),
                span=(0.0, 1e-3),
                directions=WAYS,
            ),
            Words("What landmarks are for", HOW),
            Table("Inputs", ("file", "unit", "sha256"), [(mesh.name, mesh.unit, mesh.sha256)], folded=True),
        ),
    )


def _standing(file: Path, mesh: Mesh) -> list[SetLandmark]:
    """Landmarks of a file, each with the face nearest to it."""
    surface = Surface.of(mesh)
    found = read_landmarks(file)
    check_mesh(found, surface, mesh.unit)
    near = surface.proximity(found.points)
    standing = []
    for k, name in enumerate(found.names):
        corners = mesh.faces[near.face[k]]
        a, b, c = mesh.vertices[corners]
        (u, v), *_ = np.linalg.lstsq(np.column_stack([b - a, c - a]), near.closest[k] - a, rcond=None)
        x, y, z = (float(value) for value in found.points[k] / LENGTH[mesh.unit])
        place = (str(found.table[key][k]) if key in found.table else "" for key in ("row", "column"))
        i, j, n = (int(corner) for corner in corners)
        standing.append(SetLandmark(name, (x, y, z), (i, j, n), (float(1.0 - u - v), float(u), float(v)), *place))
    return standing


def write_surface_page(surface: Path, unit: str, out: Path | None = None, landmarks: Path | None = None) -> Path:
    """Write the page of a mesh file and return its path: NAME_surface.html here by default, renewed where it is its.

    Raises
    ------
    InputError
        The mesh or the landmarks cannot be used, or something else stands where the page would be written.
    """
    page = surface_page(read_mesh(surface, unit), landmarks)
    target = Path(f"{surface.stem}_surface.html") if out is None else out
    if target.exists() and not _is_page_of_a_surface(target):
        raise InputError(target, "", "is there already and is no page of a surface", "name another file with `out`")
    if target.exists() and out is None and not _is_page_of_a_surface(target, surface.name):
        what = f"is there already and is the page of another surface than {surface.name}"
        raise InputError(target, "", what, "name another file with `out`")
    try:
        write_page(page, target)
    except FileNotFoundError as error:
        raise InputError(target, "", "its folder is not there", "make it, or name another file with `out`") from error
    return target


def _is_page_of_a_surface(path: Path, name: str | None = None) -> bool:
    """Whether a file is such a page, of the mesh file of that name where one is given."""
    if not path.is_file():
        return False
    with open_file(path) as stream:
        text = stream.read()
    title = re.search(rb"<title>(.*?)</title>", text)
    same = name is None or (title is not None and unescape(title[1].decode("utf-8", "replace")) == name)
    return b'id="picking"' in text and same
