"""Files that must be refused: one InputError that names the file and a remedy; and a seeded fuzz over all formats."""

from __future__ import annotations

import gzip
import os
import random
import struct
import warnings
import zipfile
from io import BytesIO

import numpy as np
import pytest
import trimesh

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.mesh import mesh_checks
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.mesh.ply import read_header
from geocontact.io.text import file_preflight

BALL = trimesh.creation.icosphere(subdivisions=1, radius=31.4159)
STL = BALL.export(file_type="stl")
STL_ASCII = BALL.export(file_type="stl_ascii").encode()
PLY = BALL.export(file_type="ply")
PLY_ASCII = BALL.export(file_type="ply", encoding="ascii")
OBJ = BALL.export(file_type="obj").encode()
OFF = BALL.export(file_type="off").encode()
OFF_HEAD = b"OFF\n3 1 0\n"
HTML = b"<!DOCTYPE html>\n<html><body>404 not found" + b" " * 500 + b"</body></html>\n"
FACET = b"facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 50 0 0\nvertex 0 50 0\nendloop\nendfacet\n"


def vtp(
    points="0 0 0 50 0 0 0 50 0", polys="0 1 2", ends="3", head="", attributes='type="PolyData"', **counts
) -> bytes:
    declared = {"NumberOfPoints": 3, "NumberOfPolys": 1} | counts
    piece = " ".join(f'{name}="{value}"' for name, value in declared.items())
    return (
        f'<?xml version="1.0"?>{head}<VTKFile {attributes} version="0.1" byte_order="LittleEndian"><PolyData>'
        f'<Piece {piece}><Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">{points}</DataArray>'
        f'</Points><Polys><DataArray type="Int64" Name="connectivity" format="ascii">{polys}</DataArray>'
        f'<DataArray type="Int64" Name="offsets" format="ascii">{ends}</DataArray></Polys></Piece>'
        "</PolyData></VTKFile>\n"
    ).encode()


def stl_with(value: float) -> bytes:
    data = bytearray(STL)
    data[84 + 50 * 7 + 12 : 84 + 50 * 7 + 16] = struct.pack("<f", value)
    return bytes(data)


def recounted(count: int) -> bytes:
    return STL[:80] + struct.pack("<I", count) + STL[84:]


def zipped() -> bytes:
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("ball.stl", STL)
    return stream.getvalue()


def ply_header(*lines: str, form: str = "binary_little_endian 1.0") -> bytes:
    return ("\n".join(["ply", f"format {form}", *lines, "end_header"]) + "\n").encode()


def ply_ascii(vertices: str, faces: str, vertex_count: int = 3, face_count: int = 1, kind: str = "int") -> bytes:
    head = ply_header(
        f"element vertex {vertex_count}",
        *[f"property float {axis}" for axis in "xyz"],
        f"element face {face_count}",
        f"property list uchar {kind} vertex_indices",
        form="ascii 1.0",
    )
    return head + (vertices + faces).encode()


LINE = FACET.replace(b"0 50 0", b"20 0 0")
VERTICES = "0 0 0\n50 0 0\n0 50 0\n"
XYZ = tuple(f"property float {axis}" for axis in "xyz")
LIST = "property list uchar int vertex_indices"
ENTITY = '<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/passwd">]>'
LAUGHS = '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'

MALFORMED = {
    # name of the file: bytes, a part of the message
    "truncated.stl": (STL[:-1], "binary STL declares 80 faces, 4084 bytes, but the file has 4083 bytes"),
    "cut in the header.stl": (STL[:60], "not an STL file"),
    "one byte more.stl": (STL + b"\0", "but the file has 4085 bytes"),
    "one line end more.stl": (STL + b"\n", "but the file has 4085 bytes"),
    "count too large.stl": (recounted(81), "declares 81 faces"),
    "count too small.stl": (recounted(79), "declares 79 faces"),
    "count absurd.stl": (recounted(4_000_000_000), "declares 4000000000 faces"),
    "truncated, starts with solid.stl": (b"solid".ljust(80) + STL[80:-7], "binary STL declares 80 faces"),
    "no faces.stl": (STL[:80] + bytes(4), "no faces"),
    "nan.stl": (stl_with(np.nan), "face 7"),
    "inf.stl": (stl_with(-np.inf), "not finite"),
    "page.stl": (HTML, "looks like an HTML page"),
    "page.PLY": (HTML, "looks like an HTML page"),
    "page.obj": (HTML, "looks like an HTML page"),
    "page.vtp": (HTML, "looks like an HTML page"),
    "xml.stl": (vtp(), "looks like a VTK XML file"),
    "text.stl": (b"this is the tibial insert\n" * 30, "looks like plain text"),
    "short text.stl": (b"hello", "looks like plain text"),
    "gzip.stl": (gzip.compress(STL), "looks like a gzip archive; unpack it"),
    "gzip.ply": (gzip.compress(PLY), "looks like a gzip archive"),
    "gzip.obj": (gzip.compress(OBJ), "looks like a gzip archive"),
    "gzip.vtp": (gzip.compress(vtp()), "looks like a gzip archive"),
    "zip.stl": (zipped(), "looks like an archive"),
    "lfs.stl": (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "Git LFS pointer"),
    "ply inside.stl": (PLY, "looks like a PLY file; name it .ply"),
    "stl inside.ply": (STL_ASCII, "looks like an ASCII STL file; name it .stl"),
    "stl inside.obj": (STL_ASCII, "looks like an ASCII STL file"),
    "empty.stl": (b"", "empty"),
    "empty.vtp": (b"", "empty"),
    "no end.stl": (b"solid a\n" + FACET, "without 'endsolid'"),
    "cut in a facet.stl": (b"solid a\n" + FACET + FACET[:50], "without 'endsolid'"),
    "incomplete facet.stl": (b"solid a\n" + FACET + FACET[:50] + b"\nendsolid\n", "face 1"),
    "no area.stl": (
        STL[:80] + struct.pack("<I", 2) + 2 * struct.pack("<12fH", *[0] * 6, *[40, 30, 0], *[8, 6, 0], 0),
        "none of its faces (2) has an area",
    ),
    "no area ascii.stl": (b"solid a\n" + 3 * LINE + b"endsolid\n", "none of its faces (3) has an area"),
    "no area.ply": (ply_ascii("0 0 0\n50 0 0\n20 0 0\n", "3 0 1 2\n"), "none of its faces (1) has an area"),
    "no area.obj": (b"v 0 0 0\nv 50 50 0\nf 1 2 2\nf 1 1 2\n", "none of its faces (2) has an area"),
    "no area.vtp": (vtp(points="0 0 0 50 0 0 20 0 0"), "none of its faces (1) has an area"),
    "no facets.stl": (b"solid a\nendsolid a\n", "no faces"),
    "four vertices.stl": (
        b"solid a\n" + FACET.replace(b"endloop", b"vertex 1 1 1\nendloop") + b"endsolid\n",
        "face 0: 'endloop' expected but 'vertex' found",
    ),
    "two vertices.stl": (b"solid a\n" + FACET.replace(b"vertex 50 0 0\n", b"") + b"endsolid\n", "face 0"),
    "two numbers.stl": (b"solid a\n" + FACET + FACET.replace(b"50 0 0", b"50 0") + b"endsolid\n", "face 1"),
    "word.stl": (b"solid a\n" + FACET + FACET.replace(b"50 0 0", b"5O 0 0") + b"endsolid\n", "face 1: '5o' is not a"),
    "decimal comma.stl": (b"solid a\n" + FACET.replace(b"50", b"50,0") + b"endsolid\n", "'50,0' has a decimal comma"),
    "underscore.stl": (b"solid a\n" + FACET.replace(b"50", b"5_0") + b"endsolid\n", "'5_0' is not a number"),
    "nan ascii.stl": (b"solid a\n" + FACET + FACET.replace(b"50", b"nan") + b"endsolid\n", "face 1"),
    "inf ascii.stl": (b"solid a\n" + FACET.replace(b"50", b"1e999") + b"endsolid\n", "not finite"),
    "no facet end.stl": (b"solid a\n" + FACET.replace(b"endfacet", b"") + FACET + b"endsolid\n", "'endfacet' expected"),
    "text after the end.stl": (b"solid a\n" + FACET + b"endsolid a\n" + FACET, "after the last 'endsolid'"),
    "text before.stl": (b"solid a\nendsolid\nx\nsolid b\n" + FACET + b"endsolid\n", "text outside"),
    "solid twice.stl": (b"solid a\nsolid b\n" + FACET + b"endsolid\n", "line 2: 'solid' before"),
    "endsolid twice.stl": (b"solid a\n" + FACET + b"endsolid\nendsolid\n", "'endsolid' without 'solid'"),
    "not ply.ply": (b"plx" + PLY[3:], "not a PLY file"),
    "no end of header.ply": (PLY[:60], "no 'end_header'"),
    "bad format.ply": (PLY.replace(b"binary_little_endian", b"binary_middle_endian"), "PLY format line"),
    "bad version.ply": (PLY.replace(b"endian 1.0", b"endian 2.0"), "PLY format line"),
    "bad type.ply": (PLY.replace(b"property float y", b"property flaot y"), "bad PLY header line"),
    "bad count.ply": (PLY.replace(b"vertex 42", b"vertex -4"), "bad PLY header line"),
    "no y.ply": (PLY.replace(b"property float y", b"property float q"), "has no property y"),
    "x twice.ply": (PLY.replace(b"property float y", b"property float x"), "repeated properties"),
    "no list.ply": (PLY.replace(b"vertex_indices", b"vertex_indexes"), "no list property vertex_indices"),
    "4e9 faces.ply": (PLY.replace(b"face 80", b"face 4000000000"), "4000000000 faces, more than"),
    "2e7 faces.ply": (PLY.replace(b"face 80", b"face 20000000"), "at least 20000"),
    "1e18 edges.ply": (
        ply_header(
            "element vertex 1", *XYZ, "element face 1", LIST, "element edge 100000000000000000", "property int a"
        ),
        "at least 400",
    ),
    "endless rows of nothing.ply": (
        ply_header("element vertex 1", *XYZ, "element face 1", LIST, "element edge 100000000000000000"),
        "no or repeated properties",
    ),
    "property first.ply": (ply_header("property float x"), "bad PLY header line"),
    "no vertices.ply": (ply_header("element vertex 0", *XYZ, "element face 1", LIST), "no vertices"),
    "points only.ply": (ply_header("element vertex 1", *XYZ) + bytes(12), "no faces"),
    "truncated.ply": (PLY[:-1], "cut off or damaged"),
    "cut in the vertices.ply": (PLY[:-1300], "at least"),
    "one byte more.ply": (PLY + b"\0", "1 bytes follow"),
    "corner count.ply": (PLY[:-13] + b"\4" + PLY[-12:], "do not fit"),
    "index.ply": (PLY[:-4] + struct.pack("<i", 42), "face 79: vertex index 42 is outside 0 to 41"),
    "negative index.ply": (PLY[:-4] + struct.pack("<i", -1), "face 79: vertex index -1 is outside"),
    "row missing.ply": (ply_ascii(VERTICES, "3 0 1 2\n", face_count=2), "declares 2 rows of face, the file has 1"),
    "row too many.ply": (ply_ascii(VERTICES, "3 0 1 2\n3 0 1 2\n"), "line 14: more rows"),
    "column missing.ply": (ply_ascii(VERTICES.replace("50 0 0", "50 0"), "3 0 1 2\n"), "line 11: vertex: 2 values"),
    "corner missing.ply": (ply_ascii(VERTICES, "3 0 1\n"), "line 13: face: 3 values"),
    "minus three corners.ply": (ply_ascii(VERTICES, "-3 0 1 2\n"), "a list of -3"),
    "two corners.ply": (ply_ascii(VERTICES, "2 0 1\n"), "face 0: has 2 corners"),
    "index ascii.ply": (ply_ascii(VERTICES, "3 0 1 3\n"), "face 0: vertex index 3 is outside 0 to 2"),
    "nan ascii.ply": (ply_ascii(VERTICES.replace("50", "nan", 1), "3 0 1 2\n"), r"face 0 (vertex 1)"),
    "float overflow.ply": (ply_ascii(VERTICES.replace("50", "1e39", 1), "3 0 1 2\n"), "not finite"),
    "word ascii.ply": (ply_ascii(VERTICES.replace("50", "5O", 1), "3 0 1 2\n"), "line 11"),
    "float index.ply": (ply_ascii(VERTICES, "3 0 1 2\n", kind="float"), "no integers"),
    "huge index.ply": (ply_ascii(VERTICES, f"3 0 1 {2**63}\n"), "line 13"),
    "index.obj": (b"v 0 0 0\nv 50 0 0\nv 0 50 0\nf 1 2 4\n", "face 0: vertex index 3 is outside 0 to 2"),
    "index 0.obj": (b"v 0 0 0\nv 50 0 0\nv 0 50 0\nf 1 2 0\n", "line 4: vertex index 0 is out of range"),
    "negative index.obj": (b"v 0 0 0\nv 50 0 0\nv 0 50 0\nf -1 -2 -4\n", "line 4: vertex index -4"),
    "huge index.obj": (b"v 0 0 0\nv 50 0 0\nv 0 50 0\nf 1 2 " + b"9" * 5000 + b"\n", "is not a face corner"),
    "two corners.obj": (b"v 0 0 0\nv 50 0 0\nf 1 2\n", "line 3: a face of 2 corners"),
    "no faces.obj": (b"v 0 0 0\nv 50 0 0\nv 0 50 0\n", "no faces"),
    "no vertices.obj": (b"f 1 2 3\n", "no vertices"),
    "keyword.obj": (b"v 0 0 0\nw 50 0 0\nv 0 50 0\nf 1 2 3\n", "line 2: 'w' is not an OBJ keyword"),
    "two numbers.obj": (b"v 0 0 0\nv 50 0\nv 0 50 0\nf 1 2 3\n", "line 2: a vertex of 2 numbers"),
    "word.obj": (b"v 0 0 0\nv 5O 0 0\nv 0 50 0\nf 1 2 3\n", "line 2"),
    "nan.obj": (b"v 0 0 0\nv nan 0 0\nv 0 50 0\nf 1 2 3\n", "face 0 (vertex 1)"),
    "inf of an unused vertex.obj": (b"v 0 0 0\nv 50 0 0\nv 0 50 0\nv 0 0 inf\nf 1 2 3\n", "vertex 3"),
    "corner.obj": (b"v 0 0 0\nv 50 0 0\nv 0 50 0\nf 1 2 3.0\n", "'3.0' is not a face corner"),
    "binary.obj": (STL, "not an OBJ file"),
    "page.off": (HTML, "looks like an HTML page"),
    "gzip.off": (gzip.compress(OFF), "looks like a gzip archive"),
    "off inside.obj": (OFF, "looks like an OFF file; name it .off"),
    "obj inside.off": (OBJ, "not an OFF file"),
    "binary.off": (b"OFF BINARY\n\0\0", "is a binary OFF file"),
    "4 dimensions.off": (OFF_HEAD.replace(b"OFF", b"4OFF"), "'4OFF' files have coordinates of another number than 3"),
    "keyword later.off": (b"a\nOFF\n3 1 0\n" + VERTICES.encode() + b"3 0 1 2\n", "not an OFF file"),
    "no counts.off": (b"OFF\n", "0 numbers where the counts"),
    "one count.off": (b"OFF\n3\n", "line 2: 1 numbers where the counts"),
    "count.off": (b"OFF\n3.0 1 0\n", "line 2: counts of vertices and faces: '3.0' is not a whole number"),
    "no faces.off": (b"OFF\n3 0 0\n" + VERTICES.encode(), "no faces"),
    "4e9 vertices.off": (b"OFF\n4000000000 1 0\n", "4000000000 vertices, more than"),
    "vertices missing.off": (b"OFF\n9 1 0\n" + VERTICES.encode(), "its counts declare 9 vertices, the file has 3"),
    "faces missing.off": (OFF[: OFF.rstrip().rfind(b"\n") + 1], "its counts declare 80 faces, the file has 79"),
    "one face more.off": (OFF + b"3 0 1 2\n", "line 125: more rows than its counts declare"),
    "cut in a face.off": (OFF_HEAD + VERTICES.encode() + b"3 0 1\n", "line 6: faces: 2 numbers follow"),
    "two corners.off": (OFF_HEAD + VERTICES.encode() + b"2 0 1\n", "face 0: has 2 corners"),
    "negative corners.off": (OFF_HEAD + VERTICES.encode() + b"-3 0 1 2\n", "line 6: faces: 3 numbers follow"),
    "index.off": (OFF_HEAD + VERTICES.encode() + b"3 0 1 3\n", "vertex index 3 is outside 0 to 2"),
    "negative index.off": (OFF_HEAD + VERTICES.encode() + b"3 0 1 -1\n", "vertex index -1 is outside 0 to 2"),
    "index of a fraction.off": (OFF_HEAD + VERTICES.encode() + b"3 0 1 2.5\n", "line 6: faces: '2.5' is not a whole"),
    "two coordinates.off": (OFF_HEAD + b"0 0\n50 0 0\n0 50 0\n3 0 1 2\n", "line 3: vertices: a row of 2 numbers"),
    "four coordinates.off": (OFF_HEAD + b"0 0 0 1\n50 0 0\n0 50 0\n3 0 1 2\n", "line 3: vertices: a row of 4 numbers"),
    "word.off": (OFF_HEAD + b"0 0 0\n5O 0 0\n0 50 0\n3 0 1 2\n", "line 4: vertices: '5O' is not a number"),
    "decimal comma.off": (OFF_HEAD + b"0 0 0\n50,0 0 0\n0 50 0\n3 0 1 2\n", "export it with decimal points"),
    "nan.off": (OFF_HEAD + b"0 0 0\nnan 0 0\n0 50 0\n3 0 1 2\n", "face 0 (vertex 1)"),
    "no area.off": (OFF_HEAD + b"0 0 0\n50 0 0\n20 0 0\n3 0 1 2\n", "none of its faces (1) has an area"),
    "external entity.vtp": (vtp(head=ENTITY, points="&e;"), "document type"),
    "billion laughs.vtp": (vtp(head=LAUGHS, points="&b;"), "document type"),
    "truncated.vtp": (vtp()[:-30], "not well-formed"),
    "grid.vtp": (vtp(attributes='type="UnstructuredGrid"'), "holds VTKFile UnstructuredGrid"),
    "other xml.vtp": (b"<a/>", "looks like XML"),
    "no polys.vtp": (vtp(NumberOfPolys=0, polys="", ends=""), "no faces"),
    "strips.vtp": (vtp(NumberOfStrips=1), "triangle strips"),
    "4e9 polys.vtp": (vtp(NumberOfPolys=4_000_000_000), "4000000000 faces, more than"),
    "4e9 points.vtp": (vtp(NumberOfPoints=4_000_000_000), "4000000000 vertices, more than"),
    "count.vtp": (vtp(NumberOfPoints="three"), "'three' is not a count"),
    "points missing.vtp": (vtp(NumberOfPoints=4), "Points: cannot be read: 9 numbers where 12"),
    "index.vtp": (vtp(polys="0 1 3"), "vertex index 3 is outside 0 to 2"),
    "negative index.vtp": (vtp(polys="0 1 -1"), "vertex index -1 is outside"),
    "offsets.vtp": (vtp(ends="-3"), "do not ascend"),
    "offset absurd.vtp": (vtp(ends="4000000000"), "polygon corners, more than"),
    "offset.vtp": (vtp(ends="4"), "3 numbers where 4"),
    "nan.vtp": (vtp(points="0 0 0 nan 0 0 0 50 0"), "face 0 (vertex 1)"),
    "word.vtp": (vtp(points="0 0 0 5O 0 0 0 50 0"), "Points: cannot be read"),
    "lz4.vtp": (vtp(attributes='type="PolyData" compressor="vtkLZ4DataCompressor"'), "vtkLZ4DataCompressor"),
    "base64.vtp": (vtp(points="AAAA!").replace(b'"ascii"', b'"binary"', 1), "Points: cannot be read"),
    "nowhere.vtp": (vtp().replace(b'format="ascii"', b'format="appended" offset="99"', 1), "offset 99 is outside"),
    "mesh.3mf": (zipped(), "not one of the formats that are read (.stl, .ply, .obj, .off, .vtp, .step, .stp)"),
    "mesh": (STL, "not one of the formats"),
    "mesh.stl.gz": (gzip.compress(STL), "not one of the formats"),
}


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed_file_is_refused_with_name_and_remedy(tmp_path, name):
    data, part = MALFORMED[name]
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(InputError) as caught:
        read_mesh(path, "mm")
    assert name in str(caught.value)
    assert part in str(caught.value)
    assert caught.value.remedy
    assert "\n" not in str(caught.value)


def test_what_is_no_file_is_refused(tmp_path):
    (tmp_path / "folder.stl").mkdir()
    for name, part in {"missing.stl": "no such file", "folder.stl": "is a folder", "a\0b.stl": "usable path"}.items():
        with pytest.raises(InputError, match=part) as caught:
            read_mesh(tmp_path / name, "mm")
        assert caught.value.remedy


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_refused_without_waiting_for_it(tmp_path):
    os.mkfifo(tmp_path / "pipe.stl")
    with pytest.raises(InputError, match="not a regular file"):
        read_mesh(tmp_path / "pipe.stl", "mm")


@pytest.mark.parametrize("unit", ["ft", "", "MM", "um"])
def test_unknown_unit_is_refused_with_the_known_ones(tmp_path, unit):
    path = tmp_path / "ball.stl"
    path.write_bytes(STL)
    with pytest.raises(InputError, match=r"ball\.stl: unknown unit .* pass `unit` m, cm, mm or in"):
        read_mesh(path, unit)


@pytest.mark.parametrize("name", ["ball.stl", "ascii.stl", "ball.ply", "ascii.ply", "ball.obj", "ball.off", "ball.vtp"])
def test_too_many_faces_are_refused(tmp_path, monkeypatch, name):
    path = tmp_path / name
    data = {"ball.stl": STL, "ascii.stl": STL_ASCII, "ball.ply": PLY, "ascii.ply": PLY_ASCII, "ball.obj": OBJ}
    data |= {"ball.off": OFF}
    path.write_bytes(data.get(name, ball_vtp()))
    monkeypatch.setattr(mesh_checks, "MAX_FACES", 79)
    with pytest.raises(InputError, match=r"80 faces.*, more than the 79 that are read; decimate"):
        read_mesh(path, "mm")


def test_too_large_a_file_is_not_opened(tmp_path, monkeypatch):
    path = tmp_path / "ball.stl"
    path.write_bytes(STL)
    monkeypatch.setattr(file_preflight, "MAX_BYTES", 4083)
    with pytest.raises(InputError, match="4084 bytes is more than the 4083 bytes that are read"):
        read_mesh(path, "mm")


def test_running_out_of_memory_is_said(tmp_path, monkeypatch):
    def exhausted(*_: object) -> None:
        raise MemoryError

    path = tmp_path / "ball.stl"
    path.write_bytes(STL)
    monkeypatch.setattr("geocontact.io.mesh.meshes.merge_coincident", exhausted)
    with pytest.raises(InputError, match="does not fit into memory; decimate"):
        read_mesh(path, "mm")


@pytest.mark.parametrize(
    ("name", "data"), [("cut.obj", OBJ.rstrip()), ("cut.off", OFF.rstrip()), ("cut.ply", PLY_ASCII.rstrip())]
)
def test_missing_last_line_end_is_warned_about(tmp_path, name, data):
    """None of these formats has an end mark: `f 12 13 145` cut to `f 12 13 14` is valid, the missing line end tells."""
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.warns(InputWarning, match=f"^{name}: the last line has no line end"):
        read_mesh(path, "mm")


def ball_vtp() -> bytes:
    points = " ".join(map(str, BALL.vertices.ravel().tolist()))
    polys = "\n".join(map(str, BALL.faces.ravel().tolist()))
    ends = " ".join(str(3 * (i + 1)) for i in range(len(BALL.faces)))
    return vtp(points, polys, ends, NumberOfPoints=len(BALL.vertices), NumberOfPolys=len(BALL.faces))


def mutated(data: bytes, chance: random.Random) -> bytes:
    """Flip bytes, cut, extend, repeat or drop a part."""
    body = bytearray(data)
    here = chance.randrange(len(body))
    there = min(here + chance.randrange(1, 80), len(body))
    match chance.choice(["flip", "digit", "cut", "extend", "repeat", "drop"]):
        case "flip":
            for _ in range(chance.randrange(1, 4)):
                body[chance.randrange(len(body))] = chance.randrange(256)
        case "digit":
            body[here] = chance.choice(b'0123456789-+.eEnNaA _/#<>"\n\r\0')
        case "cut":
            del body[here:]
        case "extend":
            body += chance.randbytes(chance.randrange(1, 60))
        case "repeat":
            body[there:there] = body[here:there]
        case "drop":
            del body[here:there]
    return bytes(body)


def declared_faces(name: str, data: bytes) -> int:
    """What the file itself says, counted without the readers; at least so many for what has polygons."""
    if name == "ball.stl":
        return int.from_bytes(data[80:84], "little")
    if name == "ascii.stl":
        return data.lower().count(b"endfacet")
    if name.endswith(".ply"):
        return {e.name: e.rows for e in read_header(data, name).elements}["face"]
    if name == "ball.obj":
        return sum(line.split()[:1] == [b"f"] for line in data.splitlines())
    if name == "ball.off":
        return int(data.split()[2])
    return int(data.split(b'NumberOfPolys="')[1].split(b'"')[0])


@pytest.mark.parametrize("name", ["ball.stl", "ascii.stl", "ball.ply", "ascii.ply", "ball.obj", "ball.off", "ball.vtp"])
def test_mutated_files_are_refused_or_read_whole(tmp_path, name):
    """Only InputError may escape; what is read is finite and has as many faces as the file declares."""
    valid = {
        "ball.stl": STL, "ascii.stl": STL_ASCII, "ball.ply": PLY, "ascii.ply": PLY_ASCII, "ball.obj": OBJ,
        "ball.off": OFF
    }.get(name, ball_vtp())  # fmt: skip
    path = tmp_path / name
    read = 0
    refusals: list[str] = []
    for seed in range(int(os.environ.get("GEOCONTACT_FUZZ", "60"))):
        data = mutated(valid, random.Random(f"{name} {seed}"))
        path.write_bytes(data)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                mesh = read_mesh(path, "mm")
            except InputError as error:
                refusals.append(str(error))
                continue
        read += 1
        assert all(issubclass(w.category, InputWarning) for w in caught), f"seed {seed}: {caught}"
        assert np.isfinite(mesh.vertices).all(), f"seed {seed}"
        assert mesh.faces.min() >= 0, f"seed {seed}"
        assert mesh.faces.max() < len(mesh.vertices), f"seed {seed}"
        polygons = any("polygon" in str(w.message) for w in caught)
        declared = declared_faces(name, data)
        assert len(mesh.faces) > declared if polygons else len(mesh.faces) == declared > 0, f"seed {seed}"
    assert all(name in line for line in refusals), refusals
    assert read, "no mutation left the file readable: the fuzz does not reach behind the preflight"
