"""Every job that reads a mesh says that closed surfaces of it lie inside others: nothing else shows it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.cop.foot import ground_of
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.frame.bodies import read_body, read_input_surface
from geocontact.analyses.frame.record import Record
from geocontact.data.errors import InputWarning
from geocontact.data.gap_case import CaseMesh
from geocontact.io.mesh.meshes import read_mesh
from geocontact.systems.knee_full_chain import geometry_of
from tests.cli.calls import stl, written
from tests.geometry.bodies import cube, joined
from tests.recording import opened

SAID = "bone.stl holds 2 closed surfaces, one inside the other: 1536.0 of its 3936.0 mm^2 lie inside another one"


def bone(folder: Path, *, marrow: bool = True) -> Path:
    """A block of 20 mm with a cavity of 16 mm, 6 · 20² and 6 · 16² mm²; without it, one block."""
    block, hole = cube((0, 0, 0), 10), cube((0, 0, 0), 8)
    vertices, faces = joined(block, hole) if marrow else block
    return written(folder / "bone.stl", stl(vertices[faces]))


def surface(file: Path) -> None:
    """`fit` and `mat`."""
    read_input_surface("mesh", file, "mm", None)


def body(file: Path) -> None:
    """`knee settle`."""
    read_body("fixed", file, "mm", None, False)


def ground(file: Path) -> None:
    """`cop`, whose grounds are larger."""
    ground_of(CopOptions(Path("spheres.csv"), motion=Path("m.csv"), ground=str(file), unit="cm"))


@pytest.mark.parametrize("read", [surface, body])
def test_a_job_warns_of_a_cavity(read: Callable[[Path], None], tmp_path: Path) -> None:
    record = opened(Record("job", {}))
    read(bone(tmp_path))
    (line,) = record.warnings
    assert line == f"{SAID} and count as surface all the same; if they are not surface, remove them from the file"
    assert record.inputs[0]["closed_surfaces"] == 2


def test_a_ground_with_a_cavity_is_warned_of(tmp_path: Path) -> None:
    record = opened(Record("cop", {}))
    ground(bone(tmp_path))
    (line,) = record.warnings
    assert line.startswith("bone.stl holds 2 closed surfaces, one inside the other: 153600.0 of its 393600.0 mm^2")


@pytest.mark.parametrize("read", [surface, body, ground])
def test_one_block_is_not_warned_of(read: Callable[[Path], None], tmp_path: Path) -> None:
    record = opened(Record("job", {}))
    read(bone(tmp_path, marrow=False))
    assert record.warnings == []


def test_the_knee_chain_warns_of_a_cavity(tmp_path: Path) -> None:
    mesh = CaseMesh(read_mesh(bone(tmp_path), "mm"), "", 1e-3)
    with pytest.warns(InputWarning, match="bone.stl holds 2 closed surfaces, one inside the other") as said:
        knee = geometry_of({"moving": mesh, "fixed": mesh}, 4e-3, 1.0)
    assert len(said) == 2
    assert np.isfinite(knee.middle).all()
