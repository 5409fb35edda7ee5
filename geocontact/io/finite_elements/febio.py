"""Models for FEBio: two rigid surfaces, a prescribed motion and contact (FEBio User Manual 4.x, file format 4.0).

Rigid rotations are those of `rigid_rotation_vector`: where all three components are prescribed FEBio turns the body
from its reference orientation by the whole vector, about the centre of mass, which is therefore MOVING's origin here.
Contact is `sliding-elastic` with a penalty that is not scaled: pressure = penalty × depth, which is the law of a linear
elastic foundation (Fregly et al. 2003, J Biomech 36:1659) where the penalty is the layer's modulus by its thickness.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from xml.etree.ElementTree import Comment, Element, ElementTree, SubElement, indent

import numpy as np
from jaxtyping import Float, Int

from geocontact.io.finite_elements.rigid_pair import MPA_PER_MM, RigidPair

SHELL = 0.01
"""Thickness of the rigid shells [mm]; FEBio asks for one, and nothing depends on it."""
BODIES = ("FIXED", "MOVING")
UNITS = "units: mm, N, MPa, s, rad"
_RIGID = ("Rx_dof", "Ry_dof", "Rz_dof", "Ru_dof", "Rv_dof", "Rw_dof")
_PLOTTED = (
    "displacement",
    "contact gap",
    "contact pressure",
    "contact force",
    "rigid position",
    "rigid rotation vector",
)


def write_febio(file: Path, pair: RigidPair, program: str) -> None:
    """Write a model that FEBio 4 opens, of both bodies, the motion, and the contact where its stiffness is known."""
    root = Element("febio_spec", version="4.0")
    for line in (f"written by {program}", UNITS, *pair.notes):
        root.append(Comment(f" {re.sub('-{2,}', '-', line)} "))
    SubElement(root, "Module", type="solid")
    _control(SubElement(root, "Control"), pair)
    constants = SubElement(SubElement(root, "Globals"), "Constants")
    for name, value in (("T", "298"), ("P", "0"), ("R", "8.314e-06"), ("Fc", "9.6485e-05")):
        _text(constants, name, value)
    _materials(SubElement(root, "Material"), pair)
    _mesh(SubElement(root, "Mesh"), pair)
    domains = SubElement(root, "MeshDomains")
    for body in BODIES:
        _text(SubElement(domains, "ShellDomain", name=body, mat=body), "shell_thickness", f"{SHELL:g}")
    _motion(SubElement(root, "Rigid"))
    if pair.stiffness is not None:
        _contact(SubElement(root, "Contact"), pair.stiffness)
    _curves(SubElement(root, "LoadData"), pair)
    plot = SubElement(SubElement(root, "Output"), "plotfile", type="febio")
    for name in _PLOTTED if pair.stiffness is not None else (_PLOTTED[0], *_PLOTTED[-2:]):
        SubElement(plot, "var", type=name)
    indent(root)
    ElementTree(root).write(file, encoding="ISO-8859-1", xml_declaration=True)


def _control(control: Element, pair: RigidPair) -> None:
    """A static analysis that stops at every frame, whose times are points of the curve of the largest step."""
    clock = pair.clock
    steps = len(clock) - 1
    _text(control, "analysis", "STATIC")
    _text(control, "time_steps", str(steps))
    _text(control, "step_size", _number(float(clock[-1]) / steps))
    _text(control, "plot_zero_state", "1")
    _text(control, "plot_level", "PLOT_MUST_POINTS")
    stepper = SubElement(control, "time_stepper", type="default")
    _text(stepper, "max_retries", "10")
    _text(stepper, "dtmax", "1").set("lc", "7")
    solver = SubElement(control, "solver", type="solid")
    _text(solver, "symmetric_stiffness", "non-symmetric")


def _materials(materials: Element, pair: RigidPair) -> None:
    for k, (body, centre) in enumerate(zip(BODIES, (np.zeros(3), pair.centre), strict=True), start=1):
        material = SubElement(materials, "material", id=str(k), name=body, type="rigid body")
        _text(material, "density", "1")
        _text(material, "center_of_mass", _row(centre))


def _mesh(mesh: Element, pair: RigidPair) -> None:
    nodes = dict(zip(BODIES, (pair.fixed_nodes, pair.moving_nodes), strict=True))
    faces = {"FIXED": pair.fixed[1] + 1, "MOVING": pair.moving[1] + 1 + len(pair.fixed_nodes)}
    first = 1
    for body in BODIES:
        group = SubElement(mesh, "Nodes", name=body)
        for k, place in enumerate(nodes[body], start=first):
            SubElement(group, "node", id=str(k)).text = _row(place)
        first += len(nodes[body])
    first = 1
    for body in BODIES:
        group = SubElement(mesh, "Elements", type="tri3", name=body)
        _facets(group, "elem", faces[body], first)
        first += len(faces[body])
    for body, some in zip(BODIES, pair.contact_faces(), strict=True):
        _facets(SubElement(mesh, "Surface", name=f"{body}_surface"), "tri3", faces[body][some], 1)
    both = SubElement(mesh, "SurfacePair", name="FIXED_MOVING")
    _text(both, "primary", "FIXED_surface")
    _text(both, "secondary", "MOVING_surface")


def _facets(group: Element, tag: str, faces: Int[np.ndarray, "m 3"], first: int) -> None:
    for k, corners in enumerate(faces.tolist(), start=first):
        SubElement(group, tag, id=str(k)).text = ",".join(map(str, corners))


def _motion(rigid: Element) -> None:
    """FIXED is held; MOVING's displacement follows curves 1 to 3, its rotation vector curves 4 to 6."""
    held = SubElement(rigid, "rigid_bc", name="FIXED_held", type="rigid_fixed")
    _text(held, "rb", "FIXED")
    for name in _RIGID:
        _text(held, name, "1")
    for k, axis in enumerate("xyz", start=1):
        shift = SubElement(rigid, "rigid_bc", name=f"MOVING_{axis}", type="rigid_displacement")
        for name, value in (("rb", "MOVING"), ("dof", axis), ("relative", "0")):
            _text(shift, name, value)
        _text(shift, "value", "1").set("lc", str(k))
    turn = SubElement(rigid, "rigid_bc", name="MOVING_rotation", type="rigid_rotation_vector")
    _text(turn, "rb", "MOVING")
    for k, axis in enumerate("xyz", start=4):
        _text(turn, f"v{axis}", "1").set("lc", str(k))


def _contact(contact: Element, stiffness: float) -> None:
    """FIXED's surface is the primary one: the pressure is that of its points along its normals, without friction."""
    law = SubElement(contact, "contact", name="layer", surface_pair="FIXED_MOVING", type="sliding-elastic")
    for name, value in (
        ("laugon", "PENALTY"),
        ("two_pass", "0"),
        ("penalty", _number(stiffness * MPA_PER_MM)),
        ("auto_penalty", "0"),
        ("symmetric_stiffness", "0"),
        ("fric_coeff", "0"),
    ):
        _text(law, name, value)


def _curves(data: Element, pair: RigidPair) -> None:
    clock = pair.clock
    longest = np.full((len(clock), 1), np.diff(clock).max())
    columns = np.hstack([pair.displacement, pair.rotation, longest])
    for k, column in enumerate(columns.T, start=1):
        curve = SubElement(data, "load_controller", id=str(k), type="loadcurve")
        _text(curve, "interpolate", "LINEAR")
        _text(curve, "extend", "CONSTANT")
        points = SubElement(curve, "points")
        for row in np.column_stack([clock, column]):
            _text(points, "pt", _row(row))


def _text(parent: Element, tag: str, text: str) -> Element:
    element = SubElement(parent, tag)
    element.text = text
    return element


def _row(values: Float[np.ndarray, " k"] | Iterable[float]) -> str:
    return ",".join(_number(float(value)) for value in values)


def _number(value: float) -> str:
    return f"{value:.12g}"
