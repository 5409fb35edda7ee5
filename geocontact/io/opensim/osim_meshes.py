"""Where the meshes of an OpenSim body sit in its frame."""

from __future__ import annotations

from os import PathLike, fspath
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.opensim.osim_xml import Frames, numbers_of, offset, read_model, text_of
from geocontact.io.text.tables import listed

_ONES, _ZEROS = (1.0, 1.0, 1.0), (0.0,) * 6


def mesh_placements(path: str | PathLike[str], body: str) -> dict[str, Float[np.ndarray, "4 4"]]:
    """Mesh file → 4×4 affine that takes the numbers in that file to the body's frame [m].

    The scale factors are in it. OpenSim takes a mesh file's numbers for metres, so a model of a mesh in mm has scale
    factors of 0.001: do not convert the mesh's unit as well.
    """
    file = fspath(path)
    frames = Frames(file, read_model(path))
    bodies = {p: e for p, e in frames.elements.items() if e.tag in ("Body", "Ground")}
    paths = [p for p, e in bodies.items() if e.get("name") == body]
    if len(paths) != 1:
        names = tuple(e.get("name", "") for e in bodies.values())
        raise InputError(file, "", f"no body '{body}'", f"bodies are: {listed(names)}")
    found = _display_geometry(file, bodies[paths[0]])
    for path_of, element in frames.elements.items():
        meshes = element.findall("attached_geometry/Mesh")
        if meshes and (owner := frames.in_body(path_of))[0] == body:
            for mesh in meshes:
                scale = numbers_of(file, mesh, "scale_factors", 3, _ONES)
                found[text_of(mesh, "mesh_file")] = owner[1].as_matrix() @ np.diag([*scale, 1.0])
    return found


def mesh_placement(path: str | PathLike[str], body: str, mesh: str = "") -> Float[np.ndarray, "4 4"]:
    """The affine of one mesh of a body; `mesh` names the file where the body has several."""
    found = mesh_placements(path, body)
    chosen = [name for name in found if not mesh or name == mesh]
    if len(chosen) != 1:
        what = f"body '{body}' has {len(found)} meshes" if not mesh else f"body '{body}' has no mesh '{mesh}'"
        raise InputError(fspath(path), "", what, f"name one of: {listed(tuple(found))}")
    return found[chosen[0]]


def _display_geometry(file: str, body: Element) -> dict[str, Float[np.ndarray, "4 4"]]:
    """OpenSim 3: VisibleObject and DisplayGeometry each have a transform and scale factors.

    Composed as OpenSim 4 does when it converts such a file: transforms multiplied, then the product of the scales.
    """
    found: dict[str, Float[np.ndarray, "4 4"]] = {}
    for visible in body.findall("VisibleObject"):
        outer = numbers_of(file, visible, "transform", 6, _ZEROS)
        size = numbers_of(file, visible, "scale_factors", 3, _ONES)
        for geometry in visible.findall("GeometrySet/objects/DisplayGeometry"):
            inner = numbers_of(file, geometry, "transform", 6, _ZEROS)
            scale = size * numbers_of(file, geometry, "scale_factors", 3, _ONES)
            pose = offset(outer[:3], outer[3:]) * offset(inner[:3], inner[3:])
            found[text_of(geometry, "geometry_file")] = pose.as_matrix() @ np.diag([*scale, 1.0])
    return found
