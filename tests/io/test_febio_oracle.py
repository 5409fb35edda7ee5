"""Models for FEBio and Abaqus against other libraries: pyfebio, whose classes refuse what FEBio has not, and meshio.

pyfebio cannot read the switches (0, 1) of its own files, so that the same model is put together with it, and each
element of ours has to be among what it writes.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.io.finite_elements.abaqus import write_abaqus
from geocontact.io.finite_elements.febio import write_febio
from geocontact.io.finite_elements.rigid_pair import RigidPair
from meshes.simple_shapes import block, sphere

pytestmark = pytest.mark.oracle
FLOOR, BALL = block(40.0, 40.0, 10.0, 2), sphere(20.0, 4)
TIME = np.array([0.5, 0.75, 1.5])
SHIFT = np.array([[0.0, 20.0, 0.0], [1.0, 19.9, 0.0], [2.0, 19.8, -1.0]])
"""mm"""
TURN = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.2, 0.0, 0.0]])
"""rad; about one axis, where rotation vectors are differences."""
STIFFNESS = 250.0
"""MPa/mm"""


@pytest.fixture
def pair() -> RigidPair:
    """A ball that rolls on a floor."""
    poses = RigidTransform.from_components(SHIFT * 1e-3, Rotation.from_rotvec(TURN))
    fixed, moving = ((vertices * 1e-3, faces) for vertices, faces in (FLOOR, BALL))
    upward = np.array([np.ptp(FLOOR[0][face][:, 1]) == 0.0 for face in FLOOR[1]])
    return RigidPair(TIME, poses, fixed, moving, touching=upward, stiffness=STIFFNESS * 1e9, notes=("a -- note",))


def assembled() -> bytes:
    """The same model by pyfebio."""
    pyfebio = pytest.importorskip("pyfebio")
    model = pyfebio.model.Model()
    mesh, rigid, data = model.mesh_, model.rigid_, model.loaddata_
    counts = 0, len(FLOOR[0])
    faces = FLOOR[1] + 1, BALL[1] + 1 + counts[1]
    for name, nodes, first in (("FIXED", FLOOR[0], 0), ("MOVING", BALL[0] + SHIFT[0], counts[1])):
        mesh.add_node_domain(pyfebio.mesh.numpy_to_nodes(nodes, name, first))
    for name, corners, first in (("FIXED", faces[0], 0), ("MOVING", faces[1], len(faces[0]))):
        mesh.add_element_domain(pyfebio.mesh.numpy_to_elements(corners, "tri3", name, first))
        model.meshdomains_.add_shell_domain(pyfebio.meshdomains.ShellDomain(name=name, mat=name, shell_thickness=0.01))
    upward = faces[0][np.ptp(FLOOR[0][FLOOR[1]][:, :, 1], axis=1) == 0.0]
    for name, corners in (("FIXED_surface", upward), ("MOVING_surface", faces[1])):
        some = pyfebio.mesh.numpy_to_surface_list(corners, "tri3")
        mesh.add_surface(pyfebio.mesh.Surface(name=name, all_tri3=some))
    mesh.add_surface_pair(
        pyfebio.mesh.SurfacePair(name="FIXED_MOVING", primary="FIXED_surface", secondary="MOVING_surface")
    )
    for k, (name, centre) in enumerate((("FIXED", "0,0,0"), ("MOVING", "0,20,0")), start=1):
        one = pyfebio.material.MaterialParameter(text=1)
        model.material_.add_material(pyfebio.material.RigidBody(name=name, id=k, density=one, center_of_mass=centre))
    held = dict.fromkeys(("Rx_dof", "Ry_dof", "Rz_dof", "Ru_dof", "Rv_dof", "Rw_dof"), 1)
    rigid.add_rigid_bc(pyfebio.rigid.RigidFixed(rb="FIXED", **held))
    for k, axis in enumerate("xyz", start=1):
        value = pyfebio.rigid.Value(lc=k, text=1.0)
        rigid.add_rigid_bc(pyfebio.rigid.RigidPrescribed(rb="MOVING", dof=axis, value=value))
    of = pyfebio.rigid.RigidBodyRotationVector
    vector = {"vx": of.X(lc=4, text=1), "vy": of.Y(lc=5, text=1), "vz": of.Z(lc=6, text=1)}
    rigid.add_rigid_bc(of(rb="MOVING", **vector))
    law = {"penalty": STIFFNESS, "symmetric_stiffness": 0}
    model.contact_.add_contact(pyfebio.contact.SlidingElastic(name="layer", surface_pair="FIXED_MOVING", **law))
    clock = TIME - TIME[0]
    for k, column in enumerate(np.hstack([SHIFT - SHIFT[0], TURN, np.full((3, 1), 0.75)]).T, start=1):
        points = [f"{t:.9g},{x:.9g}" for t, x in zip(clock, column, strict=True)]
        data.add_load_curve(pyfebio.loaddata.LoadCurve(id=k, points=pyfebio.loaddata.CurvePoints(points=points)))
    step = pyfebio.control.TimeStepper(max_retries=10, dtmax=pyfebio.control.TimeStepValue(lc=7, text=1))
    solver = pyfebio.control.SolidSolver(symmetric_stiffness="non-symmetric")
    steps = {"time_steps": 2, "step_size": 0.5, "plot_zero_state": 1, "plot_level": "PLOT_MUST_POINTS"}
    model.control_ = pyfebio.control.Control(time_stepper=step, solver=solver, **steps)
    plot = pyfebio.output.OutputPlotfile()
    for name in ("displacement", "contact gap", "contact pressure", "contact force", "rigid position"):
        plot.add_var(pyfebio.output.Var(type=name))
    plot.add_var(pyfebio.output.Var(type="rigid rotation vector"))
    model.output_.add_plotfile(plot)
    return model.to_xml(skip_empty=True)


def said(element: ET.Element, above: tuple[Any, ...] = ()) -> set[tuple[Any, ...]]:
    """Each element with its attributes, text and place; numbers as such, names of rigid conditions left out."""
    name = {key: value for key, value in element.attrib.items() if not (element.tag == "rigid_bc" and key == "name")}
    place = (*above, element.tag, *sorted(name.items()))
    if element.tag == "rigid_bc":
        place = (*place, element.findtext("dof", ""))
    words = (element.text or "").strip().split(",")
    try:
        content = tuple(round(float(word), 5) + 0.0 for word in words)
    except ValueError:
        content = tuple(words)
    return {(*place, content)}.union(*(said(child, place) for child in element))


def test_every_element_is_one_that_pyfebio_writes_for_this_model(tmp_path: Path, pair: RigidPair) -> None:
    theirs = said(ET.fromstring(assembled()))
    write_febio(tmp_path / "contact.feb", pair, "test")
    ours = said(ET.parse(tmp_path / "contact.feb").getroot())
    assert len(ours) > 300 and sorted(map(str, ours - theirs)) == []


def test_meshio_reads_the_model_for_abaqus(tmp_path: Path, pair: RigidPair) -> None:
    meshio = pytest.importorskip("meshio")
    write_abaqus(tmp_path / "contact.inp", pair, "test")
    mesh = meshio.read(tmp_path / "contact.inp")
    first = len(FLOOR[0])
    np.testing.assert_allclose(mesh.points[:first], FLOOR[0], atol=1e-9)
    np.testing.assert_allclose(mesh.points[first:-1], BALL[0] + SHIFT[0], atol=1e-9)
    np.testing.assert_allclose(mesh.points[mesh.point_sets["MOVING_REFERENCE"]], SHIFT[:1], atol=1e-9)
    assert [block.type for block in mesh.cells] == ["triangle", "triangle"]
    np.testing.assert_array_equal(mesh.cells[0].data, FLOOR[1])
    np.testing.assert_array_equal(mesh.cells[1].data, BALL[1] + first)
    (some, *_) = mesh.cell_sets["FIXED_FACES"]
    np.testing.assert_array_equal(some, np.flatnonzero(pair.touching))
    np.testing.assert_array_equal(mesh.point_sets["FIXED_NODES"], np.arange(first))
