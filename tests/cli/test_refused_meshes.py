"""Meshes that cannot be used: exit 2, one line that names the file and the remedy, nothing left behind."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from meshes.simple_shapes import sphere
from meshes.stl import stl_bytes
from tests.cli.calls import call, inventory, stl
from tests.cli.spoilt import BALL, FLOOR, Cases, Given, each, file, made, refuse, sound, tokens

HTML = b"<!DOCTYPE html>\n<html><body>404 not found" + b" " * 500 + b"</body></html>\n"

FLAT = np.array([[[0.0, 0.0, 0.0], [40.0, 30.0, 0.0], [8.0, 6.0, 0.0]]] * 3)
"""Corners of faces that lie on a line."""


def ball(content: bytes) -> Given:
    """The moving body has this content."""
    return {"MOVING": file("ball.stl", content)}


def vertex(value: float) -> bytes:
    """The ball with one coordinate replaced in face 7."""
    at = 84 + 50 * 7 + 12
    return BALL[:at] + struct.pack("<f", value) + BALL[at + 4 :]


MESHES: Cases = {
    "truncated STL": (ball(BALL[:-20]), ("ball.stl", "cut off or damaged", "export or download it again")),
    "padded STL": (ball(BALL + b"\0\0"), ("ball.stl", "cut off or damaged", "export or download it again")),
    "one face too many declared": (
        ball(BALL[:80] + struct.pack("<I", 321) + BALL[84:]),
        ("ball.stl", "declares 321 faces", "again"),
    ),
    "huge count": (ball(BALL[:80] + b"\xff" * 4 + BALL[84:]), ("ball.stl", "declares 4294967295 faces", "again")),
    "truncated ASCII STL": (ball(b"solid x\nfacet normal 0 0 1\nouter loop\n"), ("ball.stl", "endsolid", "again")),
    "NaN vertex": (ball(vertex(np.nan)), ("ball.stl face 7", "not finite", "repair")),
    "infinite vertex": (ball(vertex(np.inf)), ("ball.stl face 7", "not finite", "repair")),
    "no faces": (ball(BALL[:80] + b"\0" * 4), ("ball.stl", "no faces", "export")),
    "no face has an area": (ball(stl(FLAT)), ("ball.stl", "none of its faces (3) has an area", "export")),
    "no face of the fixed body has an area": ({"FIXED": file("floor.stl", stl(FLAT))}, ("floor.stl", "area", "export")),
    "empty file": (ball(b""), ("ball.stl", "empty", "again")),
    "HTML named .stl": (ball(HTML), ("ball.stl", "an HTML page", "download the file itself")),
    "PLY named .stl": (ball(b"ply\nformat ascii 1.0\nend_header\n"), ("ball.stl", "a PLY file", "name it .ply")),
    "STL named .ply": ({"FIXED": file("floor.ply", FLOOR)}, ("floor.ply", "not a PLY file", "export")),
    "unknown format": ({"MOVING": file("ball.iges", BALL)}, ("ball.iges", ".stl", "convert")),
    "no extension": ({"MOVING": file("ball", BALL)}, ("ball", ".stl", "convert")),
    "missing file": ({"FIXED": "nowhere/floor.stl"}, ("nowhere/floor.stl", "no such file", "check the path")),
    "folder as mesh": ({"MOVING": made("ball.stl")}, ("ball.stl", "is a folder", "name a file")),
    "metres taken for mm": (
        ball(stl_bytes(*sphere(0.02, 4), "m")),
        ("ball.stl", "too small for an implant", "metres", "--unit m"),
    ),
    "mm taken for metres": ({"--unit": "m"}, ("ball.stl", "too large", "millimetres", "--unit mm")),
}


def test_the_call_that_is_spoilt_here_works(tmp_path: Path) -> None:
    assert call(*tokens(tmp_path, sound(tmp_path))).code == 0
    assert "area.csv" in inventory(tmp_path / "place/deep/out")


@each(MESHES)
def test_damaged_meshes_are_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refuse(tmp_path, changes, *said)
