"""Before a file is parsed: regular, readable, not empty, its size, its encoding, and its lines a block at a time.

Every file that a user names is opened by `open_file`, or looked at by `regular_file` before another library opens it:
pipes and devices, which have no end, are refused unopened, and so is what is larger than its reader takes.
`tests/house/test_one_preflight.py` keeps it so.
"""

from __future__ import annotations

import errno
import json
import re
import stat
import warnings
from array import array
from codecs import getincrementaldecoder
from collections.abc import Callable, Iterator
from io import TextIOWrapper
from os import PathLike, fspath
from os.path import islink
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from jaxtyping import Int

from geocontact.data.errors import OF_THE_MACHINE, InputError, InputWarning

UTF8, LATIN1 = "utf-8-sig", "latin-1"
PIECE = 1 << 20


def encoding_of(path: str | PathLike[str]) -> str:
    """UTF-8 where the whole file is that; else Latin-1, with a warning that names the first byte that is not."""
    decoder, before = getincrementaldecoder("utf-8")(), 0
    with open_file(path) as stream:
        while piece := stream.read(PIECE):
            try:
                decoder.decode(piece)
            except UnicodeDecodeError as error:
                _warn(path, before + error.start)
                return LATIN1
            before += len(piece)
    return UTF8


def decoded(data: bytes, path: str | PathLike[str]) -> str:
    """The same of bytes that were read."""
    try:
        return data.decode(UTF8)
    except UnicodeDecodeError as error:
        _warn(path, error.start)
        return data.decode(LATIN1)


def _warn(path: str | PathLike[str], byte: int) -> None:
    what = f"byte {byte} is not UTF-8; the file is read as Latin-1"
    warnings.warn(InputWarning(f"{fspath(path)}: {what}"), stacklevel=4)


MAX_BYTES = 4 * 2**30
"""Largest file that is read [bytes]."""

_PACKED = (
    (rb"\x1f\x8b", "a gzip archive", "unpack it first"),
    (rb"PK\x03\x04|7z\xbc\xaf|BZh|\xfd7zXZ", "an archive (zip, 7z, bz2 or xz)", "unpack it first"),
    (rb"\xff\xfe|\xfe\xff", "UTF-16 text", "save it as plain ASCII or UTF-8"),
    (rb"version https://git-lfs", "a Git LFS pointer", "fetch the file itself with `git lfs pull`"),
)
_LOOKS = (
    *_PACKED,
    (rb"(?i)\s*(?:<!--.*?-->\s*)?(?:<!doctype\s+html|<html)", "an HTML page", "download the file itself, not its page"),
    (rb"(?s)\s*(?:<\?xml.*?\?>\s*)?<VTKFile", "a VTK XML file", "name it .vtp if it holds PolyData"),
    (rb"\s*<", "XML", "export the surface again"),
    (rb"# vtk DataFile", "a legacy VTK file", "save it as .vtp or .stl"),
    (rb"ply\s", "a PLY file", "name it .ply"),
    (rb"(?i)\s*solid\b", "an ASCII STL file", "name it .stl"),
    (rb"(?:\s|#[^\n]*\n)*(?:ST)?C?N?4?n?OFF\s", "an OFF file", "name it .off"),
    (rb"%PDF", "a PDF document", "export the surface again"),
    (rb"\x89PNG|\xff\xd8\xff|GIF8", "a picture", "export the surface again"),
    (rb"\s*ISO-10303-21", "a STEP file", "name it .step"),
    (rb"glTF", "a binary glTF file", "convert it to .stl, .ply, .obj, .off or .vtp"),
    (rb"[\t\n\r\x20-\x7e]{1,512}\Z", "plain text", "export the surface again"),
)

_NO_TEXT = (
    *_PACKED,
    (rb"%PDF", "a PDF document", "export it as text"),
    (rb"\x89PNG|\xff\xd8\xff|GIF8", "a picture", "export it as text"),
)

UNKNOWN = ("something else", "export the surface again")


EMPTY = "the file is empty"
_NO_FILE = (
    (stat.S_ISDIR, "a folder", "name a file"),
    (stat.S_ISFIFO, "a named pipe, not a regular file", "write what comes out of it to a file, and name that"),
    (stat.S_ISCHR, "a device, not a regular file", "name a file"),
    (stat.S_ISBLK, "a device, not a regular file", "name a file"),
    (stat.S_ISSOCK, "a socket, not a regular file", "name a file"),
)


def regular_file(path: str | PathLike[str], most_bytes: int | None = None, remedy: str = "cut or resample it") -> int:
    """Size of a file that may be opened [bytes]; InputError for any other. It is not opened, so nothing hangs.

    Parameters
    ----------
    most_bytes
        Largest size that its reader takes; `MAX_BYTES` where it has no limit of its own.
    remedy
        What to do with a larger one.
    """
    shown, most = fspath(path), MAX_BYTES if most_bytes is None else most_bytes
    try:
        status = Path(path).stat()
    except OSError as error:
        if error.errno in OF_THE_MACHINE:
            raise
        raise _refusal(path, error) from error
    except ValueError as error:  # a NUL in the path
        raise InputError(shown, "", f"is not a usable path: {error}", "check the path") from error
    if not stat.S_ISREG(status.st_mode):
        kinds = ((what, remedy) for is_it, what, remedy in _NO_FILE if is_it(status.st_mode))
        what, instead = next(kinds, ("not a regular file", "name a file"))
        raise InputError(shown, "", f"is {what}", instead)
    if status.st_size > most:
        raise InputError(shown, "", f"{_sized(status.st_size)} is more than the {_sized(most)} that are read", remedy)
    if not status.st_size:
        raise InputError(shown, "", EMPTY, "export or download it again")
    return status.st_size


def _sized(size: int) -> str:
    """A number of bytes, in MB from 0.1 MB on."""
    if size < 100_000:
        return f"{size} bytes"
    return f"{size / 1e6:.{0 if size % 1_000_000 == 0 else 1}f} MB"


def _refusal(path: str | PathLike[str], error: OSError) -> InputError:
    """What cannot be looked at or opened, in one line."""
    shown, link = fspath(path), islink(path)
    if isinstance(error, (FileNotFoundError, NotADirectoryError)):
        what = "is a link to a file that is not there" if link else "there is no such file"
        return InputError(shown, "", what, "mend the link" if link else "check the path")
    if error.errno == errno.ELOOP:
        return InputError(shown, "", "cannot be read: its links lead in a circle", "name the file itself")
    remedy = "check its permissions" if isinstance(error, PermissionError) else "check the path"
    return InputError(shown, "", f"cannot be read: {error.strerror or error}", remedy)


def open_file(path: str | PathLike[str], most_bytes: int | None = None, remedy: str = "cut or resample it") -> BinaryIO:
    """A `regular_file`, open for reading."""
    regular_file(path, most_bytes, remedy)
    try:
        return Path(path).open("rb")
    except OSError as error:
        if error.errno in OF_THE_MACHINE:
            raise
        raise _refusal(path, error) from error


def open_text(
    path: str | PathLike[str], encoding: str = UTF8, errors: str = "strict", most_bytes: int | None = None
) -> TextIOWrapper:
    """The same as text; what is packed, a picture or in UTF-16 is refused."""
    stream = open_file(path, most_bytes)
    try:
        refuse_no_text(stream.read(512), path)
        stream.seek(0)
    except BaseException:
        stream.close()
        raise
    return TextIOWrapper(stream, encoding=encoding, errors=errors)


def read_bytes(
    path: str | PathLike[str], most_bytes: int | None = None, remedy: str = "decimate the mesh first"
) -> bytes:
    """Content of a `regular_file`."""
    with open_file(path, most_bytes, remedy) as stream:
        try:
            return stream.read()
        except OSError as error:
            if error.errno in OF_THE_MACHINE:
                raise
            raise _refusal(path, error) from error


def read_text_bytes(
    path: str | PathLike[str], most_bytes: int | None = None, remedy: str = "cut or resample it"
) -> bytes:
    """Content of a `regular_file` that may be text; what is packed, a picture or in UTF-16 is refused."""
    data = read_bytes(path, most_bytes, remedy)
    refuse_no_text(data, path)
    return data


def refuse_no_text(data: bytes, path: str | PathLike[str]) -> None:
    """InputError for what begins as an archive, UTF-16, a Git LFS pointer, a PDF document or a picture does."""
    for what, instead in (each[1:] for each in _NO_TEXT if re.match(each[0], data[:512])):
        raise InputError(fspath(path), "", f"is not a text file: it looks like {what}", instead)


LARGEST_JSON = 64_000_000
"""Bytes; a run.json of a study of thousands of files has a few MB."""


def read_json(path: str | PathLike[str]) -> Any:
    """Content of a JSON file; ValueError or RecursionError where it is none, InputError where it cannot be read.

    An object that has a key twice cannot: which of both values is meant nobody knows.
    """

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) < len(pairs):
            keys = [key for key, _ in pairs]
            twice = next(key for key in keys if keys.count(key) > 1)
            raise InputError(path, "", f"the key {json.dumps(twice)[:80]} is there twice", "keep one of them")
        return found

    return json.loads(read_bytes(path, LARGEST_JSON, "name the file itself"), object_pairs_hook=once)


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


BLOCK = 1 << 21
"""Bytes that are split into words at once."""

BYTE_ORDER_MARK = b"\xef\xbb\xbf"

_BLANK = re.compile(rb"\s")
_WITH_COMMA = re.compile(rb"[-+]?[0-9]*,[0-9]+([eE][-+]?[0-9]+)?")
_COMMA = "has a decimal comma"


def lines(data: bytes, start: int = 0) -> Iterator[bytes]:
    """Lines of `data` from byte `start` on, without their ends (LF, CR LF or CR)."""
    while start < len(data):
        cut = data.find(b"\n", start + BLOCK)
        stop = len(data) if cut < 0 else cut + 1
        yield from data[start:stop].splitlines()
        start = stop


def lines_in(read: Callable[[int], bytes], longest: int) -> Iterator[bytes]:
    """The same of an open file by its `read`, a block at a time; of a line beyond `longest` bytes only a beginning."""
    rest = b""
    while piece := read(BLOCK):
        rest += piece
        cut = 1 + max(rest.rfind(b"\n"), rest.rfind(b"\r", 0, -1))  # a CR at the end may be half of CR LF
        yield from rest[:cut].splitlines()
        rest = rest[cut:]
        if len(rest) > longest:
            yield rest
            rest = b""
    yield from rest.splitlines()


def is_number(word: bytes) -> bool:
    """Whether a word is a number; `nan` and `inf` are, Python's `1_000` is not."""
    try:
        float(word)
    except ValueError:
        return False
    return b"_" not in word


def require_numbers(words: list[bytes]) -> None:
    """ValueError names the first word that is no number (`is_number`)."""
    try:
        for _ in map(float, words):
            pass
        plain = not any(b"_" in word for word in words)
    except ValueError:
        plain = False
    if not plain:
        word = next(word for word in words if not is_number(word))
        raise ValueError(f"{shown(word)} {_COMMA if _WITH_COMMA.fullmatch(word) else 'is not a number'}")


def remedy(error: Exception, usual: str) -> str:
    """What to do about numbers that `require_numbers` refused; the usual remedy unless they have decimal commas."""
    return "export it with decimal points" if _COMMA in str(error) else usual


def integer(word: bytes) -> int:
    """A word as an integer; ValueError when it is none. Python's `1_000` is none here."""
    if b"_" in word or len(word) > 18:
        raise ValueError(f"{shown(word)} is not an integer of a mesh")
    return int(word)


def count_of_numbers(text: bytes, *, integers: bool) -> int:
    """How many numbers a text holds that blanks separate; ValueError names the first word that is none."""
    count = start = 0
    while start < len(text):
        cut = _BLANK.search(text, start + BLOCK)
        stop = cut.start() if cut else len(text)
        words = text[start:stop].split()
        count += len(words)
        if integers:
            for word in words:
                integer(word)
        else:
            require_numbers(words)
        start = stop
    return count


def shown(word: bytes) -> str:
    """A word of a file as it is quoted in a message: at most 24 characters, nothing but printable ASCII."""
    text = word[:24].decode("ascii", "backslashreplace")
    return "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in text).join("''")


def as_integers(values: array[int]) -> Int[np.ndarray, " n"]:
    """The numbers of an `array("q")`, not copied."""
    return np.frombuffer(values, np.int64) if values else np.empty(0, np.int64)


def warn_open_end(data: bytes, file: str) -> None:
    """Warn when a format without an end mark does not end with a line end: its last number may be cut short."""
    if not data.endswith((b"\n", b"\r")):
        message = f"{file}: the last line has no line end; make sure that the file is complete"
        warnings.warn(InputWarning(message), stacklevel=3)
