"""STL, binary and ASCII: found whole by a check of our own; then numpy reads binary records, trimesh reads text.

Nothing is skipped and nothing is guessed: a count, a size or a keyword that does not agree refuses the file. Normals
and attribute bytes are not used (exporters leave nan there for thin faces), the order of the vertices decides.
trimesh alone reads truncated, padded or foreign files as an empty mesh. In text it takes the rest of a line for a
vertex and the words of a solid's name for keywords: it is given one keyword per line and no names.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.data.mesh import AXES
from geocontact.io.mesh import mesh_checks
from geocontact.io.text.file_preflight import (
    BLOCK,
    BYTE_ORDER_MARK,
    UNKNOWN,
    is_number,
    looks_like,
    not_a,
    remedy,
    require_numbers,
    shown,
)

HEADER = 256
"""Bytes of a file that are looked at: the free text of a binary STL, the first line of an ASCII one."""
_SPACE = re.compile(rf"\bSPACE=({'|'.join(AXES)})\b".encode())


def space_of_stl(data: bytes) -> str:
    """ "LPS" or "RAS"; empty where the header says nothing."""
    head = data[:80] if b"\0" in data[:HEADER] else data[:HEADER].split(b"\n", 1)[0]
    found = _SPACE.search(head)
    return found[1].decode() if found else ""


RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""One facet of a binary STL file, 50 bytes."""

HEAD = 84
"""Bytes before the first facet of a binary STL file: 80 of free text and the number of facets."""

_WORDS = b"facet normal 0 0 0 outer loop vertex 1 1 1 vertex 1 1 1 vertex 1 1 1 endloop endfacet".split()
_COORDINATES = [i for i, word in enumerate(_WORDS) if word == b"1"]
_NORMAL = [i for i, word in enumerate(_WORDS) if word == b"0"]
_BREAKS = [i for i, word in enumerate(_WORDS) if word in (b"facet", b"outer", b"vertex", b"endloop")]
_MARK = re.compile(rb"^[ \t]*(end ?)?solid\b[^\n]*", re.IGNORECASE | re.MULTILINE)
_SOLID = re.compile(rb"(?:\xef\xbb\xbf)?\s*solid\b", re.IGNORECASE)
_CONTROL = re.compile(rb"[\x00-\x08\x0e-\x1f]")
_END = re.compile(rb"endfacet", re.IGNORECASE)
_AGAIN = "export it again"


def read_stl(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Corners of an STL file in its own unit, three for every facet, and the faces that join them.

    float32 from binary, float64 from ASCII: the precision the file carries. A binary header may start with "solid".
    """
    corners = _read_binary(data) if _is_binary(data, file) else _read_ascii(data, file)
    return corners, np.arange(len(corners), dtype=np.int64).reshape(-1, 3)


def _read_binary(data: bytes) -> Float[np.ndarray, "n 3"]:
    return np.frombuffer(data, RECORD, offset=HEAD)["corners"].reshape(-1, 3)


def _is_binary(data: bytes, file: str) -> bool:
    declared = int.from_bytes(data[80:HEAD], "little")
    if len(data) >= HEAD and len(data) == HEAD + RECORD.itemsize * declared:
        mesh_checks.require_count(declared, mesh_checks.MAX_FACES, "faces", file)
        return True
    text = not _CONTROL.search(data, 0, 512)
    if _SOLID.match(data):
        if text:
            return False
    elif text or len(data) < HEAD or looks_like(data) != UNKNOWN:
        raise not_a("an STL file", data, file)
    held = (len(data) - HEAD) / RECORD.itemsize
    what = (
        f"binary STL declares {declared} faces, {HEAD + RECORD.itemsize * declared} bytes, "
        f"but the file has {len(data)} bytes, {held:.10g} faces"
    )
    raise InputError(file, "", what, "the file is cut off or damaged, export or download it again")


def _read_ascii(data: bytes, file: str) -> Float[np.ndarray, "n 3"]:
    from trimesh.exchange.stl import load_stl_ascii

    data = data.removeprefix(BYTE_ORDER_MARK)
    if b"\n" not in data:
        data = data.replace(b"\r", b"\n")
    blocks: list[Float[np.ndarray, "n 3"]] = []
    face = 0
    for start, stop in _solids(data, file):
        for words in _blocks(data, start, stop):
            _require_facets(words, face, file)
            count = len(words) // len(_WORDS)
            face += count
            mesh_checks.require_at_most(face, mesh_checks.MAX_FACES, "faces", file)
            if count:
                blocks.append(_whole(load_stl_ascii(BytesIO(_one_keyword_a_line(words)))["vertices"], count, file))
    mesh_checks.require_count(face, mesh_checks.MAX_FACES, "faces", file)
    return np.concatenate(blocks)


def _whole(vertices: object, count: int, file: str) -> Float[np.ndarray, "n 3"]:
    """What trimesh made of `count` facets."""
    corners = np.asarray(vertices)
    if len(corners) != 3 * count:
        raise InputError(file, "", "trimesh read another number of facets than the file holds", _AGAIN)
    return corners


def _solids(data: bytes, file: str) -> Iterator[tuple[int, int]]:
    """Where the facets between each `solid` line and its `endsolid` line begin and end."""
    inside, last = False, 0
    for mark in _MARK.finditer(data):
        ends = mark[1] is not None
        if ends != inside:
            what = "'endsolid' without 'solid'" if ends else "'solid' before the previous 'endsolid'"
            raise InputError(file, _line(data, mark.start()), what, _AGAIN)
        if inside:
            yield last, mark.start()
        elif data[last : mark.start()].strip():
            raise InputError(file, _line(data, last), "text outside 'solid' … 'endsolid'", _AGAIN)
        inside, last = ends is False, mark.end()
    if inside:
        raise InputError(file, "", "ASCII STL without 'endsolid' at its end: it is cut off", f"{_AGAIN} or download it")
    if data[last:].strip():
        raise InputError(file, _line(data, last + 1), "text after the last 'endsolid'", _AGAIN)


def _line(data: bytes, position: int) -> str:
    ends = data.count(b"\n", 0, position)
    return f"line {ends + 1}"


def _blocks(data: bytes, start: int, stop: int) -> Iterator[list[bytes]]:
    """Words of whole facets, a few megabytes at a time, in lower case."""
    while start < stop:
        end = _END.search(data, min(start + BLOCK, stop), stop)
        cut = end.end() if end else stop
        yield data[start:cut].lower().split()
        start = cut


def _require_facets(words: list[bytes], face: int, file: str) -> None:
    """Refuse `words` that do not spell out whole facets; `face` is the number of the first."""
    size = len(_WORDS)
    keywords = ((i, word) for i, word in enumerate(_WORDS) if word.isalpha())
    if len(words) % size or any(set(words[i::size]) - {word} for i, word in keywords):
        raise _first_mismatch(words, face, file)
    for i in _COORDINATES:
        _require_column(words[i::size], face, file)
    for i in _NORMAL:
        _require_column([b"0" if b"nan" in word else word for word in words[i::size]], face, file)


def _require_column(words: list[bytes], face: int, file: str) -> None:
    try:
        require_numbers(words)
    except ValueError as error:
        place = f"face {face + next(i for i, word in enumerate(words) if not is_number(word))}"
        raise InputError(file, place, str(error), remedy(error, _AGAIN)) from None


def _one_keyword_a_line(words: list[bytes]) -> bytes:
    """One solid of the facets that `words` spell out; their normals are not."""
    size = len(_WORDS)
    count = len(words) // size
    for i in _NORMAL:
        words[i::size] = [b"0"] * count
    for i in _BREAKS:
        words[i::size] = [b"\n" + _WORDS[i]] * count
    return b" ".join([b"solid", *words, b"\nendsolid\n"])


def _first_mismatch(words: list[bytes], face: int, file: str) -> InputError:
    size = len(_WORDS)
    for i, word in enumerate(words):
        expected = _WORDS[i % size]
        if expected.isalpha() and word != expected:
            what = f"'{expected.decode()}' expected but {shown(word)} found; every facet has 3 vertices of 3 numbers"
            return InputError(file, f"face {face + i // size}", what, _AGAIN)
    return InputError(file, f"face {face + len(words) // size}", "the facet is not complete", _AGAIN)


def write_stl(file: Path, corners: Float[np.ndarray, "m 3 3"], text: str) -> None:
    """Write a binary STL of the corners of every face; `text` goes into its header. Places are float32."""
    facets = np.zeros(len(corners), RECORD)
    facets["corners"] = corners
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    facets["normal"] = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0.0)
    head = text.encode("ascii", "replace")[:80].ljust(80, b" ") + np.uint32(len(corners)).tobytes()
    file.write_bytes(head + facets.tobytes())
