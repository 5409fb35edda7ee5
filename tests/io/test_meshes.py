"""Meshes from files: every format against trimesh or pyvista, order and precision kept, warnings, units."""

from __future__ import annotations

import hashlib
import struct
import subprocess
import sys
from io import BytesIO
from itertools import pairwise
from operator import attrgetter
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.mesh import repeated_faces
from geocontact.io.mesh.faces import read_face_indices
from geocontact.io.mesh.merging import merge_coincident
from geocontact.io.mesh.mesh_checks import SIZES, degenerate, require_plausible
from geocontact.io.mesh.meshes import READERS, read_mesh
from geocontact.io.mesh.stl import read_stl
from geocontact.io.text.units import ANGLE, LENGTH, split_header

BALL = trimesh.creation.icosphere(subdivisions=2, radius=31.4159)


def tetrahedron(faces: str, vertices: str = "v 0 0 0\nv 50 0 0\nv 0 50 0\nv 0 0 50\n") -> str:
    return vertices + faces


def write_obj(folder: Path, text: str, name: str = "bone.obj") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def save_vtp(folder: Path, mode: int, base64: bool, compressed: bool, big_endian: bool, wide: bool) -> Path:
    pyvista = pytest.importorskip("pyvista", reason="pyvista writes the VTP files; pip install 'geocontact[view]'")
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    surface = pyvista.PolyData.from_regular_faces(BALL.vertices, BALL.faces)
    surface.points_to_double()
    path = folder / "ball.vtp"
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(surface)
    writer.SetFileName(str(path))
    writer.SetDataMode(mode)
    writer.SetEncodeAppendedData(base64)
    writer.SetByteOrderToBigEndian() if big_endian else writer.SetByteOrderToLittleEndian()
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    writer.SetCompressorTypeToZLib() if compressed else writer.SetCompressorTypeToNone()
    writer.SetBlockSize(1024)
    writer.Write()
    return path


@pytest.mark.parametrize(
    ("extension", "options", "kind"),
    [
        ("stl", {}, np.float32),
        ("stl", {"file_type": "stl_ascii"}, np.float64),
        ("ply", {}, np.float32),
        ("ply", {"encoding": "ascii"}, np.float32),
        ("obj", {"digits": 17, "include_normals": True}, np.float64),
        ("off", {"digits": 17}, np.float64),
    ],
)
def test_round_trip_is_exact(tmp_path, extension, options, kind):
    path = tmp_path / f"ball.{extension}"
    BALL.export(path, **options)
    mesh = read_mesh(path, "mm")
    expected = BALL.triangles.astype(kind).astype(float) * 1e-3
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], expected)
    assert len(mesh.vertices) == len(BALL.vertices), "coincident corners of the soup are merged"
    assert mesh.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert (mesh.name, mesh.unit) == (path.name, "mm")


@pytest.mark.parametrize(
    "text",
    [
        "OFF\n4 4 6\n{}{}",
        "OFF 4 4\n{}{}",
        "# a bone\n\nOFF # of 2019\r\n\n4 4 0 # counts\n{}# faces\n\n{}",
        "COFF\n4 4 0\n{colours}{}",
        "STCNOFF\n4 4 0\n{colours}{coloured}",
    ],
)
def test_off_in_every_way_that_it_is_written(tmp_path, text):
    corners, faces = ["0 0 0", "50 0 0", "0 5e1 0", "0 0 +50.0"], ["3 0 2 1", "3 0 1 3", "3 0 3 2", "3 1 2 3"]
    rows = {
        "colours": "".join(f"{row} 255 0 0 255\n" for row in corners),
        "coloured": "".join(f"{row}  0.1 0.2 0.3\n" for row in faces),
    }
    plain = "".join(f"{row}\n" for row in corners), "".join(f"{row}\n" for row in faces)
    left = [part for part, name in zip(plain, ("colours", "coloured"), strict=True) if f"{{{name}}}" not in text]
    mesh = read_mesh(write_obj(tmp_path, text.format(*left, **rows), "bone.off"), "mm")
    np.testing.assert_array_equal(mesh.vertices, 50e-3 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]))
    np.testing.assert_array_equal(mesh.faces, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def test_polygons_of_off_keep_their_place_among_triangles(tmp_path):
    """trimesh alone puts the triangles first."""
    text = "OFF\n5 2 0\n0 0 0\n50 0 0\n50 50 0\n0 50 0\n0 0 50\n4 0 1 2 3\n3 0 4 1\n"
    with pytest.warns(InputWarning, match=r"bone\.off: 1 polygon with more than 3 corners"):
        mesh = read_mesh(write_obj(tmp_path, text, "bone.off"), "mm")
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [0, 2, 3], [0, 4, 1]])


@pytest.mark.parametrize("wide", [False, True])
@pytest.mark.parametrize("big_endian", [False, True])
@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize(("mode", "base64"), [(0, True), (1, True), (2, True), (2, False)])
def test_every_vtp_encoding_equals_what_vtk_wrote(tmp_path, mode, base64, compressed, big_endian, wide):
    mesh = read_mesh(save_vtp(tmp_path, mode, base64, compressed, big_endian, wide), "mm")
    tolerance = 1e-9 if mode == 0 else 0  # VTK prints fewer digits than a double has
    np.testing.assert_allclose(mesh.vertices[mesh.faces], BALL.triangles * 1e-3, rtol=tolerance, atol=tolerance)


def ply_bytes(order: str, vertex_type: str, polygons: list[list[int]], vertices: np.ndarray) -> bytes:
    name = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = (
        f"ply\nformat {name} 1.0\ncomment a test\nelement vertex {len(vertices)}\n"
        + "".join(f"property {vertex_type} {axis}\n" for axis in "xyz")
        + "property uchar quality\n"
        + f"element face {len(polygons)}\nproperty ushort flags\nproperty list uchar int vertex_indices\n"
        + "property list uchar float texcoord\nelement edge 2\nproperty int v1\nproperty int v2\nend_header\n"
    )
    code = {"double": "d", "float": "f"}[vertex_type]
    body = b"".join(struct.pack(f"{order}3{code}B", *vertex, 7) for vertex in vertices)
    for polygon in polygons:
        body += struct.pack(f"{order}HB{len(polygon)}i", 1, len(polygon), *polygon)
        body += struct.pack(f"{order}B2f", 2, 0.5, 0.5)
    return head.encode() + body + struct.pack(f"{order}4i", 0, 1, 1, 2)


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("vertex_type", ["float", "double"])
def test_binary_ply_with_other_elements_and_properties(tmp_path, order, vertex_type):
    path = tmp_path / "ball.PLY"
    path.write_bytes(ply_bytes(order, vertex_type, BALL.faces.tolist(), BALL.vertices))
    mesh = read_mesh(path, "mm")
    kind = {"float": np.float32, "double": np.float64}[vertex_type]
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], BALL.triangles.astype(kind).astype(float) * 1e-3)


def test_mixed_polygons_of_binary_ply_become_fans(tmp_path):
    path = tmp_path / "box.ply"
    square = np.array([[0, 0, 0], [50, 0, 0], [50, 50, 0], [0, 50, 0], [25, 25, 40]], dtype=float)
    path.write_bytes(ply_bytes("<", "double", [[0, 1, 4], [3, 2, 1, 0], [1, 2, 4]], square))
    with pytest.warns(InputWarning, match="1 polygon with more than 3 corners"):
        mesh = read_mesh(path, "mm")
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 4], [3, 2, 1], [3, 1, 0], [1, 2, 4]])


def test_obj_indices_materials_and_polygons(tmp_path):
    text = (
        "# quads, negative indices, materials that alternate\nmtllib ../../etc/passwd\no one\n"
        "v 0 0 0\nv 50 0 0\nv 0 50 0 1.0\nusemtl a\nf -3 -2 -1\n"
        "v 0 0 50 0.5 0.5 0.5\nvt 0 0\nvn 0 0 1\nusemtl b\nf 1/1 2/1 4/1\nusemtl a\nf 1//1 3//1 4//1\n"
        "f 2/1/1 \\\n 3/1/1 4/1/1\nf 1 2 3 4\n"
    )
    with pytest.warns(InputWarning, match="duplicate"), pytest.warns(InputWarning, match="polygon"):
        mesh = read_mesh(write_obj(tmp_path, text), "mm")
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3], [0, 1, 2], [0, 2, 3]])


def test_negative_obj_indices_count_from_their_own_line(tmp_path):
    rows = "v 0 0 0\nv 50 0 0\nv 0 50 0\nf -3 -2 -1\nv 0 0 50\nv 50 0 50\nv 0 50 50\nf -3 -2 -1\n"
    mesh = read_mesh(write_obj(tmp_path, rows), "mm")
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [3, 4, 5]])


def ascii_stl(facets: np.ndarray, solids: int = 1, end: str = "\n") -> bytes:
    text = ""
    for part in np.array_split(facets, solids):
        text += f"solid knee facet{end}"
        for facet in part:
            corners = "".join(f"vertex {x!r} {y!r} {z!r}{end}" for x, y, z in facet.tolist())
            text += f"  facet normal nan 0 -NaN(ind){end} outer loop{end}{corners} endloop{end} endfacet{end}"
        text += f"endsolid knee facet{end}"
    return text.encode()


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("upper", [False, True])
def test_ascii_stl_dialects(tmp_path, end, upper):
    path = tmp_path / "ball.stl"
    text = ascii_stl(BALL.triangles, solids=3, end=end)
    path.write_bytes(b"\xef\xbb\xbf" + (text.upper() if upper else text))
    mesh = read_mesh(path, "mm")
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], BALL.triangles * 1e-3)


@pytest.mark.parametrize("extension", ["stl", "obj", "ply"])
def test_precision_far_from_the_origin(tmp_path, extension):
    """At 1e6 mm float32 rounds to 0.06 mm; formats that carry double lose nothing."""
    moved = BALL.vertices + 1e6
    path = tmp_path / f"far.{extension}"
    if extension == "stl":
        path.write_bytes(ascii_stl(moved[BALL.faces]))
    elif extension == "obj":
        rows = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in moved.tolist()]
        rows += [f"f {a} {b} {c}\n" for a, b, c in (BALL.faces + 1).tolist()]
        write_obj(tmp_path, "".join(rows), path.name)
    else:
        path.write_bytes(ply_bytes("<", "double", BALL.faces.tolist(), moved))
    mesh = read_mesh(path, "mm")
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], moved[BALL.faces] * 1e-3)


def test_binary_stl_may_start_with_solid(tmp_path):
    path = tmp_path / "ball.stl"
    data = BALL.export(file_type="stl")
    path.write_bytes(b"solid exported by a careless program".ljust(80) + data[80:])
    assert len(read_mesh(path, "mm").faces) == len(BALL.faces)


def test_text_is_read_the_same_whatever_the_block_size(tmp_path, monkeypatch):
    path = tmp_path / "ball.stl"
    path.write_bytes(ascii_stl(BALL.triangles, solids=2))
    whole = read_mesh(path, "mm")
    monkeypatch.setattr("geocontact.io.mesh.stl.BLOCK", 700)
    parts = read_mesh(path, "mm")
    np.testing.assert_array_equal(whole.vertices, parts.vertices)
    np.testing.assert_array_equal(whole.faces, parts.faces)


FAN = "0 0 0 50 0 0 0 50 0.1 0 0 50"


def vtp_piece(points: str, polygons: str, ends: str, kind: str = "Float64") -> str:
    return (
        f'<Piece NumberOfPoints="{len(points.split()) // 3}" NumberOfPolys="{len(ends.split())}">'
        f'<Points><DataArray type="{kind}" NumberOfComponents="3" format="ascii">{points}</DataArray></Points>'
        f'<Polys><DataArray type="Int64" Name="connectivity" format="ascii">{polygons}</DataArray>'
        f'<DataArray type="Int64" Name="offsets" format="ascii">{ends}</DataArray></Polys></Piece>'
    )


def vtp_of(*pieces: str) -> bytes:
    head = '<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData>'
    return (head + "".join(pieces) + "</PolyData></VTKFile>").encode()


TWO_FACES = vtp_piece(FAN, "0 1 2 0 2 3", "3 6")


@pytest.mark.parametrize(
    ("pieces", "vertices", "faces"),
    [
        ((TWO_FACES, TWO_FACES), 8, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]),
        ((vtp_piece(FAN, "", ""), TWO_FACES), 8, [[4, 5, 6], [4, 6, 7]]),
        ((vtp_piece("", "", ""), TWO_FACES), 4, [[0, 1, 2], [0, 2, 3]]),
        ((TWO_FACES, vtp_piece("", "", "")), 4, [[0, 1, 2], [0, 2, 3]]),
    ],
)
def test_pieces_of_a_vtp_file_follow_each_other(pieces, vertices, faces):
    pytest.importorskip("vtkmodules", reason="VTK reads .vtp; pip install 'geocontact[view]'")
    points, found = READERS[".vtp"](vtp_of(*pieces), "x.vtp")
    assert len(points) == vertices
    np.testing.assert_array_equal(found, faces)


@pytest.mark.parametrize("kinds", [("Float32", "Float64"), ("Float64", "Float32")])
def test_pieces_of_a_vtp_file_keep_their_precision(kinds):
    pytest.importorskip("vtkmodules", reason="VTK reads .vtp; pip install 'geocontact[view]'")
    points, _ = READERS[".vtp"](vtp_of(*(vtp_piece(FAN, "0 1 2", "3", kind) for kind in kinds)), "x.vtp")
    tenth = {"Float32": float(np.float32(0.1)), "Float64": 0.1}
    np.testing.assert_array_equal(points[[2, 6], 2], [tenth[kind] for kind in kinds])


@pytest.mark.parametrize(
    ("corners", "ends", "wrong"), [("0 1 4", "3", "4 is outside 0 to 3"), ("0 1 -1", "3", "-1 is outside 0 to 3")]
)
def test_a_vtp_piece_cannot_reach_the_vertices_of_another(corners, ends, wrong):
    pytest.importorskip("vtkmodules", reason="VTK reads .vtp; pip install 'geocontact[view]'")
    piece = vtp_piece(FAN, corners, ends)
    for pieces in ((piece, TWO_FACES), (TWO_FACES, piece)):
        with pytest.raises(InputError, match=wrong):
            READERS[".vtp"](vtp_of(*pieces), "x.vtp")


def test_vtp_without_vtk_is_one_line_with_the_remedy(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "vtkmodules.vtkIOXML", None)
    path = tmp_path / "bone.vtp"
    path.write_bytes(vtp_of(TWO_FACES))
    with pytest.raises(InputError, match=r"^bone\.vtp: \.vtp is read by VTK, .*; pip install 'geocontact\[view\]', or"):
        read_mesh(path, "mm")


def test_a_library_that_finds_no_memory_is_no_fault_of_the_file(tmp_path, monkeypatch):
    class Loader:
        def find_spec(self, name, path=None, target=None):
            if name == "vtkmodules.vtkIOXML":
                raise ImportError("libvtkIOXML.so: failed to map segment from shared object")

    monkeypatch.delitem(sys.modules, "vtkmodules.vtkIOXML", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Loader(), *sys.meta_path])
    path = tmp_path / "bone.vtp"
    path.write_bytes(vtp_of(TWO_FACES))
    with pytest.raises(ImportError, match="failed to map segment"):
        read_mesh(path, "mm")


@pytest.mark.parametrize(
    ("extension", "options", "parser"),
    [
        ("stl", {"file_type": "stl_ascii"}, "stl.load_stl_ascii"),
        ("ply", {}, "ply.load_ply"),
        ("ply", {"encoding": "ascii"}, "ply.load_ply"),
        ("obj", {}, "obj.load_obj"),
    ],
)
def test_what_trimesh_reads_is_what_comes_back(tmp_path, monkeypatch, extension, options, parser):
    """Its coordinates moved by one: the package's own are moved by one."""
    path = tmp_path / f"ball.{extension}"
    BALL.export(path, **options)
    expected = read_mesh(path, "mm").vertices + 1e-3
    original = attrgetter(parser)(trimesh.exchange)

    def moved(*arguments, **settings):
        parsed = original(*arguments, **settings)
        mesh = next(iter(parsed["geometry"].values())) if "geometry" in parsed else parsed
        mesh["vertices"] = mesh["vertices"] + np.ones(3, np.float32)
        return parsed

    monkeypatch.setattr(f"trimesh.exchange.{parser}", moved)
    np.testing.assert_allclose(read_mesh(path, "mm").vertices, expected, atol=1e-8)


def test_binary_records_are_those_that_trimesh_reads(tmp_path):
    path = tmp_path / "ball.stl"
    BALL.export(path)
    corners, faces = read_stl(path.read_bytes(), "ball.stl")
    parsed = trimesh.exchange.stl.load_stl_binary(BytesIO(path.read_bytes()))
    assert corners.dtype == np.float32 and np.array_equal(corners, parsed["vertices"])
    assert np.array_equal(faces, parsed["faces"])


def test_why_trimesh_is_given_a_plain_file():
    """What it makes of legal files; when one of these fails, the step that makes the file plain may go."""
    obj, ply, stl = trimesh.exchange.obj.load_obj, trimesh.exchange.ply.load_ply, trimesh.exchange.stl.load_stl_ascii
    v = "v 0 0 0\nv 50 0 0\nv 0 50 0\n"
    rows = (v + "f -3 -2 -1\n" + v + "f -3 -2 -1\n").encode()
    assert obj(BytesIO(rows))["geometry"]["geometry"]["faces"].tolist() == [[0, 1, 2]] * 2
    with pytest.raises(IndexError, match="22"):  # 2 and the 3 of the next line become 23
        obj(BytesIO((v + "f 1 2\\\n3\n").encode()))
    square = np.array([[0, 0, 0], [50, 0, 0], [50, 50, 0], [0, 50, 0], [25, 25, 40]], dtype=float)
    with pytest.raises(ValueError, match="unexpected length"):
        ply(BytesIO(ply_bytes("<", "double", [[0, 1, 4], [3, 2, 1, 0]], square)))
    named = BALL.export(file_type="stl_ascii").replace("solid", "solid vertex 7", 1)
    with pytest.raises(ValueError, match="incorrect number"):
        stl(BytesIO(named.encode()))


def test_why_vtk_is_given_one_piece_at_a_time():
    vtk = pytest.importorskip("vtkmodules.vtkIOXML")
    reader = vtk.vtkXMLPolyDataReader()
    reader.ReadFromInputStringOn()
    reader.SetInputString(vtp_of(vtp_piece(FAN, "", ""), TWO_FACES))
    reader.Update()
    corner = reader.GetOutput().GetPolys().GetConnectivityArray().GetValue(0)
    assert corner == 0, "numbered from the first point of the file; the piece's own first point is number 4"


VTK_ON = """
import resource, sys
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="how a process ends is told by its signal there")
def test_why_vtk_is_not_given_a_file_as_it_is(tmp_path):
    """One absurd offset ends the process; the package refuses the file in one line."""
    pytest.importorskip("vtkmodules.vtkIOXML")
    path = tmp_path / "bone.vtp"
    path.write_bytes(vtp_of(vtp_piece(FAN, "0 1 2", "900000000000000000")))
    done = subprocess.run([sys.executable, "-c", VTK_ON, str(path)], capture_output=True, timeout=60)
    assert done.returncode < 0
    with pytest.raises(InputError, match="900000000000000000 polygon corners, more than"):
        read_mesh(path, "mm")


def test_units_agree_with_each_other(tmp_path):
    meshes = []
    for unit in ("m", "cm", "mm", "in"):
        path = tmp_path / f"{unit}.stl"
        trimesh.Trimesh(BALL.vertices / 1e3 / LENGTH[unit], BALL.faces, process=False).export(path)
        meshes.append(read_mesh(path, unit))
    for one, other in pairwise(meshes):
        np.testing.assert_allclose(one.vertices[one.faces], other.vertices[other.faces], rtol=3e-7, atol=1e-9)


@pytest.mark.parametrize(
    ("length", "shown", "given_unit", "plea"),
    [
        (0.1, "0.1", "mm", "too small for an implant; the file looks like metres, pass `unit` m"),
        (100.0, "100", "m", "too large for an implant or a body; the file looks like millimetres, pass `unit` mm"),
        (1500.0, "1500", "cm", "the file looks like millimetres, pass `unit` mm"),
        (1e-7, "1e-07", "m", "too small for an implant; check the unit"),
        (1e9, "1e+09", "mm", "too large for an implant or a body; check the unit"),
        (1e300, "1e+300", "mm", "check the unit"),
    ],
)
def test_absurd_unit_is_refused_with_the_likely_one(tmp_path, length, shown, given_unit, plea):
    text = f"v 0 0 0\nv {length!r} 0 0\nv 0 {length!r} 0\nf 1 2 3\n"
    with pytest.raises(InputError) as caught:
        read_mesh(write_obj(tmp_path, text, "femur.obj"), given_unit)
    assert str(caught.value).startswith(f"femur.obj: bounding box {shown} x {shown} x 0 {given_unit} is too")
    assert plea in str(caught.value)


def test_absurd_unit_says_what_the_style_guide_prints(tmp_path):
    text = "v 0 0 0\nv 0.068 0 0\nv 0 0.054 0\nv 0 0 0.061\nf 1 2 3\nf 1 2 4\n"
    with pytest.raises(InputError) as caught:
        read_mesh(write_obj(tmp_path, text, "femur.obj"), "mm")
    assert str(caught.value) == (
        "femur.obj: bounding box 0.068 x 0.054 x 0.061 mm is too small for an implant; "
        "the file looks like metres, pass `unit` m"
    )


def test_a_size_that_a_commoner_unit_would_make_usual_is_warned_about(tmp_path):
    """An implant of 60 mm read as inches is 2 m long; bodies and bones are silent in their own unit."""
    text = "v 0 0 0\nv {0!r} 0 0\nv 0 {0!r} 0\nf 1 2 3\n"
    with pytest.warns(InputWarning) as said:
        read_mesh(write_obj(tmp_path, text.format(60.0), "insert.obj"), "in")
    assert str(said[0].message) == (
        "insert.obj: bounding box 60 x 60 x 0 in is 2155 mm across, unusual for an implant or a bone; "
        "mm would make it 85 mm: check `unit`"
    )
    with pytest.warns(InputWarning, match="is 8 mm across.* cm would make it 85 mm: check `unit`"):
        read_mesh(write_obj(tmp_path, text.format(6.0), "insert.obj"), "mm")
    for length, unit in ((60.0, "mm"), (1200.0, "mm"), (1.2, "m"), (6.0, "cm"), (2.4, "in")):
        read_mesh(write_obj(tmp_path, text.format(length), "body.obj"), unit)


def test_plausible_size_can_be_widened_and_ignores_unused_vertices(tmp_path):
    path = write_obj(tmp_path, "v 1e6 0 0\nv 0 0 0\nv 2 0 0\nv 0 2 0\nf 2 3 4\n")
    with pytest.warns(InputWarning, match="1 vertex belongs to no face"):
        mesh = read_mesh(path, "mm", plausible=(1e-3, 3.0))
    np.testing.assert_array_equal(mesh.vertices, np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0]]) * 1e-3)


def test_degenerate_faces_stay_and_are_warned_about(tmp_path):
    path = write_obj(tmp_path, tetrahedron("v 25 0 0\nf 1 2 3\nf 1 2 2\nf 1 5 2\nf 1 2 4\n"))
    message = "^bone.obj: 2 degenerate faces .zero area., ignored in areas; first is face 1$"
    with pytest.warns(InputWarning, match=message):
        mesh = read_mesh(path, "mm")
    assert len(mesh.faces) == 4


def test_duplicate_faces_stay_and_are_warned_about(tmp_path):
    path = write_obj(tmp_path, tetrahedron("f 1 2 3\nf 1 2 4\nf 2 3 1\nf 3 2 1\n"))
    with pytest.warns(
        InputWarning, match=r"2 duplicate faces \(same three vertices as an earlier face\); first is face 2"
    ):
        mesh = read_mesh(path, "mm")
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [0, 1, 3], [1, 2, 0], [2, 1, 0]])


def test_thin_but_real_triangles_are_not_called_degenerate():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 1e-9, 0], [0.5, 1e-13, 0]])
    np.testing.assert_array_equal(degenerate(vertices, np.array([[0, 1, 2], [0, 1, 3]])), [False, True])


@given(st.lists(st.tuples(*[st.sampled_from([-1.0, -0.0, 0.0, 1.0])] * 3), min_size=3, max_size=30), st.randoms())
def test_merging_equals_a_dictionary_of_rows(rows, random):
    vertices = np.array(rows)
    faces = np.array([[random.randrange(len(rows)) for _ in range(3)] for _ in range(9)] + [[0, 1, 2]])
    faces = np.concatenate([faces, np.resize(np.arange(len(rows)), (-(-len(rows) // 3), 3))])  # all are used
    numbers: dict[tuple[float, ...], int] = {}
    expected = [numbers.setdefault(tuple(float(x) + 0.0 for x in row), len(numbers)) for row in rows]
    merged, renumbered = merge_coincident(vertices, faces, "x.stl")
    np.testing.assert_array_equal(renumbered, np.array(expected)[faces])
    np.testing.assert_array_equal(merged, list(numbers))
    assert not np.signbit(merged[merged == 0]).any()


@given(st.lists(st.tuples(*[st.integers(0, 4)] * 3), min_size=1, max_size=40))
def test_repeated_equals_a_set_of_rows(rows):
    seen: set[tuple[int, ...]] = set()
    expected = []
    for row in rows:
        key = tuple(sorted(row))
        expected.append(key in seen)
        seen.add(key)
    np.testing.assert_array_equal(repeated_faces(np.array(rows)), expected)


@pytest.mark.parametrize(
    ("header", "parts"),
    [
        ("tx [mm]", ("tx", "mm")),
        ("  time[s] ", ("time", "s")),
        ("qw", ("qw", "")),
        ("area [ mm^2 ]", ("area", "mm^2")),
        ("a ]b[", ("a ]b[", "")),
        ("", ("", "")),
    ],
)
def test_header_with_unit(header, parts):
    assert split_header(header) == parts


def test_units_are_exact():
    assert LENGTH["in"] == 0.0254
    assert 180 * ANGLE["deg"] == np.pi


def test_face_indices(tmp_path):
    path = tmp_path / "faces.txt"
    path.write_text("# condyle\n3, 1 0\n\n7 # rim\n", encoding="utf-8")
    np.testing.assert_array_equal(read_face_indices(path, 8), [3, 1, 0, 7])


@pytest.mark.parametrize(
    ("text", "where", "plea"),
    [
        ("1\n2 x\n", "line 2", "'x' is not a face index"),
        ("1\n8\n", "line 2", "outside 0 to 7"),
        ("-1", "line 1", "start at 0"),
        ("1 2\n3\n2", "line 3", "listed already in line 1"),
        ("1.0", "line 1", "not a face index"),
        ("1_0", "line 1", "not a face index"),
        ("9" * 5000, "line 1", "not a face index"),
        ("# nothing\n", "faces.txt", "lists no faces"),
        ("", "faces.txt", "empty"),
    ],
)
def test_bad_face_indices_are_refused(tmp_path, text, where, plea):
    path = tmp_path / "faces.txt"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_face_indices(path, 8)
    assert "faces.txt" in str(caught.value)
    assert where in str(caught.value)
    assert plea in str(caught.value)


def test_a_person_with_stretched_arms_is_a_body_in_metres() -> None:
    """2.6 m from hand to foot; 2.6 m made of inches stay refused, and 4 m of metres."""
    box = np.array([[0.0, 0.0, 0.0], [1.84, 1.79, 0.31]])
    require_plausible(box, "m", SIZES, "scan.obj")
    for vertices, unit in ((box / 0.0254, "in"), (1.6 * box, "m")):
        with pytest.raises(InputError, match="too large"):
            require_plausible(vertices, unit, SIZES, "scan.obj")
