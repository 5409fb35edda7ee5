"""Decimal commas are named as such by every reader of text: no damage, no missing column, never read as two numbers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from geocontact.data.errors import InputError
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.mocap.markers import read_csv_markers
from geocontact.io.mocap.trc import read_trc
from geocontact.io.motion.poses import motion_from_csv, read_pose
from geocontact.io.recordings.spheres import read_spheres
from geocontact.io.text.tables import read_table


def mesh(path: Path) -> object:
    return read_mesh(path, "mm")


def pose(path: Path) -> object:
    return read_pose(path, "mm")


FACET = "facet normal 0 0 1\nouter loop\nvertex 0,0 0 0\nvertex 15,5 0 0\nvertex 0 15,5 0\nendloop\nendfacet\n"
PLY = """ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z
element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n15,5 0 0\n0 15,5 0\n3 0 1 2\n"""
TRC = """PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n100\t100\t1\t1\tmm
Frame#\tTime\tA\t\t\n\t\tX1\tY1\tZ1\n1\t0.00\t1,5\t2\t4\n"""
POSES = "time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz\n"
COMMA, POINTS = "has a decimal comma; export it with decimal points", "(decimal commas?); write decimal points"

WRITTEN: dict[str, tuple[Callable[[Path], object], str, str, str]] = {
    "stl": (mesh, "a.stl", f"solid a\n{FACET}endsolid a\n", f"face 0: '0,0' {COMMA}"),
    "obj": (mesh, "a.obj", "v 0,0 0,0 0,0\nv 15,5 0 0\nv 0 15,5 0\nf 1 2 3\n", f"line 1: '0,0' {COMMA}"),
    "ply": (mesh, "a.ply", PLY, f"line 11: vertex: '15,5' {COMMA}"),
    "poses": (motion_from_csv, "p.csv", f"{POSES}0,0,1,5,0,0,0,1,0,0,0\n", POINTS),
    "quoted poses": (motion_from_csv, "p.csv", f'{POSES}0,"1,5",0,0,1,0,0,0\n', POINTS),
    "spheres": (read_spheres, "s.csv", "px [m],py [m],radius [m],zone\n0,1,0,2,0,03,heel\n", POINTS),
    "markers": (read_csv_markers, "m.csv", "time [s],A_x [mm],A_y [mm],A_z [mm]\n0,1,5,2,5,3,5\n", POINTS),
    "trc": (read_trc, "a.trc", TRC, "line 6: '1,5' in column 'A x' is not a number; use decimal points"),
    "mot": (
        read_table,
        "a.mot",
        "a\nversion=1\nnRows=1\nnColumns=2\ninDegrees=yes\nendheader\ntime\tk\n0.00\t1,5\n",
        "'1,5' in column 'k' is not a number; use decimal points",
    ),
    "matrix": (
        pose,
        "x.txt",
        "1 0 0 1,5\n0 1 0 2,5\n0 0 1 0\n0 0 0 1\n",
        "(decimal commas?); give 4 rows of 4 numbers, with",
    ),
}


@pytest.mark.parametrize(("read", "name", "text", "words"), WRITTEN.values(), ids=WRITTEN.keys())
def test_decimal_commas_are_named(
    read: Callable[[Path], object], name: str, text: str, words: str, tmp_path: Path
) -> None:
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        read(file)
    assert words in str(error.value)
    assert "damaged" not in str(error.value)


def test_other_words_keep_their_remedy(tmp_path: Path) -> None:
    file = tmp_path / "a.stl"
    file.write_text(f"solid a\n{FACET}endsolid a\n".replace("0,0", "x1").replace("15,5", "15.5"), encoding="utf-8")
    with pytest.raises(InputError, match="face 0: 'x1' is not a number; export it again"):
        mesh(file)
