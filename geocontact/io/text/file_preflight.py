"""Before a file is parsed: is it a regular, readable, non-empty file, and what does it look like."""

from __future__ import annotations

import re
import stat
from os import PathLike, fspath
from pathlib import Path

from geocontact.data.errors import InputError

MAX_BYTES = 4 * 2**30
"""Largest file that is read [bytes]."""

_LOOKS = (
    (rb"\x1f\x8b", "a gzip archive", "unpack it first"),
    (rb"PK\x03\x04|7z\xbc\xaf|BZh|\xfd7zXZ", "an archive (zip, 7z, bz2 or xz)", "unpack it first"),
    (rb"\xff\xfe|\xfe\xff", "UTF-16 text", "save it as plain ASCII or UTF-8"),
    (rb"version https://git-lfs", "a Git LFS pointer", "fetch the file itself with `git lfs pull`"),
    (rb"(?i)\s*(?:<!--.*?-->\s*)?(?:<!doctype\s+html|<html)", "an HTML page", "download the file itself, not its page"),
    (rb"(?s)\s*(?:<\?xml.*?\?>\s*)?<VTKFile", "a VTK XML file", "name it .vtp if it holds PolyData"),
    (rb"\s*<", "XML", "export the surface again"),
    (rb"# vtk DataFile", "a legacy VTK file", "save it as .vtp or .stl"),
    (rb"ply\s", "a PLY file", "name it .ply"),
    (rb"(?i)\s*solid\b", "an ASCII STL file", "name it .stl"),
    (rb"%PDF", "a PDF document", "export the surface again"),
    (rb"\x89PNG|\xff\xd8\xff|GIF8", "a picture", "export the surface again"),
    (rb"glTF", "a binary glTF file", "convert it to .stl, .ply, .obj or .vtp"),
    (rb"[\t\n\r\x20-\x7e]{1,512}\Z", "plain text", "export the surface again"),
)

UNKNOWN = ("something else", "export the surface again")


def read_bytes(path: str | PathLike[str]) -> bytes:
    """Content of a regular, non-empty file of at most `MAX_BYTES`; nothing else is opened, so nothing hangs."""
    shown = fspath(path)
    try:
        status = Path(path).stat()
        if not stat.S_ISREG(status.st_mode):
            kind = "a folder" if stat.S_ISDIR(status.st_mode) else "not a regular file"
            raise InputError(shown, "", f"is {kind}", "name a file")
        if status.st_size > MAX_BYTES:
            what = f"{status.st_size} bytes, more than the {MAX_BYTES} that are read"
            raise InputError(shown, "", what, "decimate the mesh first")
        with Path(path).open("rb") as stream:
            data = stream.read(status.st_size + 1)
    except FileNotFoundError:
        raise InputError(shown, "", "there is no such file", "check the path") from None
    except OSError as error:
        raise InputError(shown, "", f"cannot be read: {error.strerror or error}", "check its permissions") from error
    except ValueError as error:  # a NUL in the path; InputError is a ValueError too
        if isinstance(error, InputError):
            raise
        raise InputError(shown, "", f"is not a usable path: {error}", "check the path") from error
    if not data:
        raise InputError(shown, "", "the file is empty", "export or download it again")
    return data


def looks_like(data: bytes) -> tuple[str, str]:
    """What the first bytes of a file look like, and what to do about it: `("an HTML page", "download …")`."""
    start = data[:512]
    for pattern, what, remedy in _LOOKS:
        if re.match(pattern, start):
            return what, remedy
    return UNKNOWN


def not_a(kind: str, data: bytes, file: str) -> InputError:
    """The refusal of a file whose content is not of the `kind` ("a PLY file") that its name promises."""
    what, remedy = looks_like(data)
    return InputError(file, "", f"is not {kind} although its name says so: it looks like {what}", remedy)
