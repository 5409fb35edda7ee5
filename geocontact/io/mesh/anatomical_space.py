"""The anatomical axes that an STL file says it is in: 3D Slicer writes SPACE=LPS or SPACE=RAS into the header."""

from __future__ import annotations

import re

from geocontact.data.mesh import AXES

HEADER = 256
"""Bytes of a file that are looked at: the free text of a binary STL, the first line of an ASCII one."""
_SPACE = re.compile(rf"\bSPACE=({'|'.join(AXES)})\b".encode())


def space_of_stl(data: bytes) -> str:
    """ "LPS" or "RAS"; empty where the header says nothing."""
    head = data[:80] if b"\0" in data[:HEADER] else data[:HEADER].split(b"\n", 1)[0]
    found = _SPACE.search(head)
    return found[1].decode() if found else ""
