"""A copy of an OpenSim model with meshes attached to its bodies."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement

from geocontact.data.errors import InputError
from geocontact.io.opensim.osim_writer import add_numbers
from geocontact.io.opensim.osim_xml import numbers_of, read_document
from geocontact.io.text.tables import listed

_OLD = 40_000
"""Version from which on geometry hangs in `attached_geometry`; `VisibleObject` before."""


def write_with_meshes(
    source: str | PathLike[str], target: Path, attached: Mapping[str, tuple[str, str]], scale: float
) -> None:
    """Write the source again with a mesh more on some bodies; all else stays as it is written.

    Meshes of the same names, which an earlier copy has, are replaced, on whichever bodies they are.

    Parameters
    ----------
    attached
        Name and file of the mesh of each body; the numbers in the file are in the body's frame.
    scale
        Metres by unit of these files, 0.001 for mm: OpenSim takes them for metres and multiplies by scale factors.

    Raises
    ------
    InputError
        For a body that the model does not have, and one of OpenSim 3 that is drawn in another frame. A joint to ground
        needs OpenSim 4, where the ground is no body.
    """
    ElementTree(with_meshes(source, attached, scale)).write(target, encoding="UTF-8", xml_declaration=True)


def with_meshes(source: str | PathLike[str], attached: Mapping[str, tuple[str, str]], scale: float) -> Element:
    """The document that `write_with_meshes` writes; the same InputErrors."""
    file = fspath(source)
    root = read_document(source, "OpenSim model")
    model = root if root.tag == "Model" else root.find("Model")
    if model is None:
        raise InputError(file, "", f"root element is <{root.tag[:40]}>, not an OpenSim model", "give an .osim file")
    version = root.get("Version", "")
    old = version.isdecimal() and int(version) < _OLD
    bodies = {e.get("name", ""): e for e in model.iter() if e.tag in ("Body", "Ground")}
    names = {name for name, _ in attached.values()}
    for holder in list(model.iter()):
        for child in [e for e in holder if e.tag in ("Mesh", "DisplayGeometry") and e.get("name") in names]:
            holder.remove(child)
    for body, (name, mesh) in attached.items():
        if body not in bodies:
            raise InputError(file, "", f"no body '{body}'", f"bodies are: {listed(tuple(bodies))}")
        if old:
            _show_old(file, bodies[body], name, mesh, scale)
        else:
            _attach(bodies[body], name, mesh, scale)
    return root


def _attach(body: Element, name: str, mesh: str, scale: float) -> None:
    geometry = SubElement(_child(body, "attached_geometry"), "Mesh", name=name)
    SubElement(geometry, "socket_frame").text = ".."
    add_numbers(geometry, "scale_factors", [scale] * 3)
    SubElement(geometry, "mesh_file").text = mesh


def _show_old(file: str, body: Element, name: str, mesh: str, scale: float) -> None:
    """OpenSim 3. Scale factors of the body's picture multiply those of a mesh, and its transform comes before."""
    visible = _child(body, "VisibleObject")
    outer = numbers_of(file, visible, "scale_factors", 3, (1.0,) * 3)
    if numbers_of(file, visible, "transform", 6, (0.0,) * 6).any():
        what = f"body '{body.get('name', '')}' is drawn in a frame that is not its own"
        raise InputError(file, "", what, "open and save the model with OpenSim 4")
    objects = _child(_child(visible, "GeometrySet"), "objects")
    geometry = SubElement(objects, "DisplayGeometry", name=name)
    SubElement(geometry, "geometry_file").text = mesh
    add_numbers(geometry, "transform", [0.0] * 6)
    add_numbers(geometry, "scale_factors", [scale / factor for factor in outer])


def _child(parent: Element, tag: str) -> Element:
    found = parent.find(tag)
    return SubElement(parent, tag) if found is None else found
