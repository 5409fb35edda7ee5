"""STEP (ISO 10303-21): exact surfaces, cut into triangles by OpenCASCADE in a process of its own.

cascadio (MIT, with OpenCASCADE under LGPL-2.1) tessellates and writes glTF in metres, trimesh reads that. Chords are
within `CHORD` of the surface and turn by `TURN` at most from one triangle to the next. OpenCASCADE passes over faces
that it cannot read: they are counted in the text. Numbers come back with seven digits; corners that are equal up to
those are made one, and triangles without corners of their own, at poles, are left out. The unit is what the file's
GLOBAL_UNIT_ASSIGNED_CONTEXT says.

`python -m geocontact.io.mesh.step FILE OUT.npz` does so in the other process.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import warnings
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.mesh import mesh_checks
from geocontact.io.text.apart import run_apart
from geocontact.io.text.file_preflight import not_a
from geocontact.io.text.units import LENGTH, MESH_UNITS

CHORD, TURN = 1e-5, 0.2
"""Largest distance of the triangles from the surface [m], and angle between neighbours [rad]."""
SAME = 2e-7
"""Share of the largest extent within which seven digits leave corners apart."""
PATIENCE = 600.0
"""Seconds for one file."""
_HEAD = b"ISO-10303-21"
_ENTITY = re.compile(rb"#(\d+)\s*=\s*(.*?);\s*(?=#|ENDSEC)", re.DOTALL)
_FACES = re.compile(rb"\b(?:ADVANCED_FACE|FACE_SURFACE)\s*\(")
_CONTEXT = re.compile(rb"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^)]*)\)")
_SI = re.compile(rb"SI_UNIT\s*\(\s*(\$|\.\w+\.)\s*,\s*\.METRE\.\s*\)")
_OTHER = re.compile(rb"CONVERSION_BASED_UNIT\s*\(\s*'([^']*)'")
_COMMENTS = re.compile(rb"('[^']*(?:''[^']*)*')|/\*.*?\*/", re.DOTALL)
_STRINGS = re.compile(rb"(CONVERSION_BASED_UNIT\s*\(\s*)?'[^']*(?:''[^']*)*'")
_PREFIXED = {b"$": "m", b".CENTI.": "cm", b".MILLI.": "mm"}
_NAMED = {b"INCH": "in", b"INCHES": "in"}
_AGAIN = "export it again as STEP in mm, or as .stl"


def read_step(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Triangles of all surfaces of a STEP file, vertices in the unit that it states; a warning says how fine."""
    unit = unit_of_step(data, file)
    if find_spec("cascadio") is None:
        remedy = "pip install 'geocontact[step]', or export the surface as .stl"
        raise InputError(file, "", "reading .step needs cascadio", remedy)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "in.step").write_bytes(_uncommented(data))
        _run(file, Path(folder))
        with np.load(Path(folder) / "out.npz", allow_pickle=False) as arrays:
            vertices, faces, surfaces = arrays["vertices"], arrays["faces"], int(arrays["surfaces"])
    declared = len(_FACES.findall(_bare(data)))
    if surfaces < declared:
        what = f"OpenCASCADE reads {surfaces} of its {declared} faces: the surface would have holes"
        raise InputError(file, "", what, _AGAIN)
    mesh_checks.require_count(len(faces), mesh_checks.MAX_FACES, "faces", file)
    vertices, faces = _welded(vertices, faces)
    said = f"{len(faces)} triangles within {1e3 * CHORD:g} mm and {TURN:g} rad of its exact surfaces"
    warnings.warn(InputWarning(f"{file}: STEP, {said}"), stacklevel=3)
    return vertices / LENGTH[unit], faces


def unit_of_step(data: bytes, file: str) -> str:
    """Unit of length that the file states; InputError where it states none, several, or one that is not read."""
    if not data.lstrip().startswith(_HEAD):
        raise not_a("a STEP file", data, file)
    entities = dict(_ENTITY.findall(_bare(data)))
    found = set()
    for text in entities.values():
        for names in _CONTEXT.findall(text):
            own = [entities.get(name.strip().lstrip(b"#"), b"") for name in names.split(b",")]
            found |= {_length(each) for each in own if b"LENGTH_UNIT" in each}
    if len(found) == 1 and (unit := min(found)) in MESH_UNITS:
        return unit
    what = (
        f"states its unit of length as {' and '.join(sorted(found))}" if found else "does not state its unit of length"
    )
    raise InputError(file, "GLOBAL_UNIT_ASSIGNED_CONTEXT", what, f"export it in one of {', '.join(MESH_UNITS)}")


def require_unit_of_step(data: bytes, unit: str, file: str) -> None:
    """InputError where the unit that the user gives is not the file's own."""
    own = unit_of_step(data, file)
    if own != unit:
        raise InputError(file, "", f"states that it is in {own}, the unit given is {unit}", f"give the unit {own}")


def _uncommented(data: bytes) -> bytes:
    """The file without comments, which may stand anywhere but in strings; OpenCASCADE does not read all of these."""
    return _COMMENTS.sub(lambda found: found[1] or b" ", data)


def _bare(data: bytes) -> bytes:
    """The file without comments, and with empty strings except for names of units."""
    return _STRINGS.sub(lambda found: found[0] if found[1] else b"''", _uncommented(data))


def _length(entity: bytes) -> str:
    """Name of a unit of length."""
    if named := _OTHER.search(entity):
        return _NAMED.get(named[1].upper(), named[1].decode(errors="replace")[:20])
    found = _SI.search(entity)
    return _PREFIXED.get(found[1], found[1].decode(errors="replace") + "METRE") if found else "unknown"


def _welded(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]
) -> tuple[Float[np.ndarray, "a 3"], Int[np.ndarray, "b 3"]]:
    """Corners of faces that were cut apart made one, with all vertices, and faces that have three of them."""
    pairs = cKDTree(vertices).query_pairs(SAME * float(np.ptp(vertices, axis=0).max()), output_type="ndarray")
    linked = coo_array((np.ones(len(pairs), np.int8), pairs.T), shape=(len(vertices), len(vertices)))
    _, group = connected_components(linked, directed=False)
    _, first = np.unique(group, return_index=True)
    corners = first[group[faces]].astype(np.int64)
    whole = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    used, number = np.unique(corners[whole], return_inverse=True)
    return vertices[used], number.reshape(-1, 3).astype(np.int64)


def _run(file: str, folder: Path) -> None:
    """The other process; what OpenCASCADE prints stays there."""
    try:
        child = run_apart(__name__, [str(folder / "in.step"), str(folder / "out.npz")], PATIENCE)
    except subprocess.TimeoutExpired as error:
        raise InputError(file, "", f"is not read within {PATIENCE:.0f} s", _AGAIN) from error
    if child.returncode:
        raise InputError(file, "", "OpenCASCADE finds no surface in it", f"is it complete? {_AGAIN}")


def write_triangles(path: str, out: str) -> None:
    """Vertices [m], faces, and how many surfaces they are of; ValueError where there is none."""
    import cascadio  # type: ignore[import-not-found, unused-ignore]
    import trimesh

    millimetres = 1e3 * CHORD  # OpenCASCADE counts in mm, whatever the file's unit is
    glb = cascadio.load(
        Path(path).read_bytes(), tol_linear=millimetres, tol_angular=TURN, merge_primitives=False, use_parallel=False
    )
    scene = trimesh.load_scene(BytesIO(glb), file_type="glb", process=False)
    mesh = scene.to_mesh()
    if not len(mesh.faces):
        raise ValueError("no surface")
    surfaces = len(scene.geometry)
    np.savez(out, vertices=np.asarray(mesh.vertices, float), faces=np.asarray(mesh.faces), surfaces=np.array(surfaces))


if __name__ == "__main__":
    write_triangles(*sys.argv[1:])
