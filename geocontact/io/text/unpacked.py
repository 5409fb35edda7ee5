"""What a packed file would unpack to, before it is: workbooks (.xlsx) and archives of arrays (.npz) are zip files.

A zip file names the size of each part, and nothing beyond it is unpacked (`zipfile`). Their sum is limited in bytes,
and beyond `HARMLESS` by its ratio to the file: text of numbers packs 3 to 20 times, the emptiest sheet or map that is
still one less than 200 times, what is made to fill memory 1000 times, the most that deflate can.
"""

from __future__ import annotations

import math
import re
from os import PathLike, fspath
from zipfile import BadZipFile, ZipFile

from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import open_file

HARMLESS = 64_000_000
"""Bytes that may be unpacked whatever they were packed to."""
MOST_TIMES = 300
"""Largest ratio of unpacked to packed size."""
_PIECE, _LONGEST_MARK = 1 << 22, 64
_CELL = re.compile(rb"""\br\s*=\s*["']([A-Z]{1,3})[0-9]{1,7}["']""")
_ROW = re.compile(rb"""\br\s*=\s*["'][A-Z]{0,3}([0-9]{1,7})["']""")


def refuse_unpacked(path: str | PathLike[str], most_bytes: int) -> None:
    """InputError for a zip file that unpacks to more than `most_bytes`, or to more than its size accounts for."""
    with open_file(path) as stream:
        try:
            with ZipFile(stream) as archive:
                parts = archive.infolist()
        except (BadZipFile, ValueError, OSError):
            return  # who reads it says so
        packed = stream.seek(0, 2)
    whole = sum(part.file_size for part in parts)
    if whole > most_bytes or whole > max(HARMLESS, MOST_TIMES * packed):
        what = f"unpacks to {whole / 1e6:.0f} MB, {whole / packed:.0f} times its size"
        limit = f"{most_bytes / 1e6:.0f} MB and, from {HARMLESS / 1e6:.0f} MB on, {MOST_TIMES} times"
        raise InputError(fspath(path), "", f"{what} (read are {limit})", "is the file damaged?")


def refuse_far_cells(path: str | PathLike[str], most_cells: int) -> None:
    """InputError for a workbook with a cell so far from A1 that the empty ones before it would fill memory."""
    with open_file(path) as stream, ZipFile(stream) as archive:
        for part in archive.infolist():
            if "worksheets/" not in part.filename.lower() or not part.filename.lower().endswith(".xml"):
                continue
            columns, rows = _extent(archive, part.filename)
            if columns * rows > most_cells:
                what = f"has cells as far as row {rows}, column {columns}, more than {most_cells} cells in all"
                raise InputError(fspath(path), part.filename, what, "delete what stands far from the table")


def _extent(archive: ZipFile, name: str) -> tuple[int, int]:
    """Number of the last column and of the last row that a sheet names."""
    columns, rows, before = 1, 1, b""
    with archive.open(name) as sheet:
        while piece := sheet.read(_PIECE):
            text = before + piece
            columns = max([columns, *map(_number, set(_CELL.findall(text)))])
            rows = max([rows, *map(int, set(_ROW.findall(text)))])
            before = text[-_LONGEST_MARK:]
    return columns, rows


def _number(letters: bytes) -> int:
    """Number of a column: A 1, Z 26, AA 27."""
    number = 0
    for letter in letters:
        number = 26 * number + letter - ord("A") + 1
    return number


def refuse_arrays_that_lie(path: str | PathLike[str]) -> None:
    """ValueError for an .npz with an array whose head names another number of bytes than the archive holds of it.

    numpy takes memory for what the head names before it reads.
    """
    from numpy.lib import format as npy

    with open_file(path) as stream, ZipFile(stream) as archive:
        for part in archive.infolist():
            with archive.open(part) as member:
                version = npy.read_magic(member)
                read_head = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
                shape, _, dtype = read_head(member)
                size = member.tell()
            if size + math.prod(shape) * dtype.itemsize != part.file_size:
                raise ValueError(f"{part.filename} is {part.file_size} bytes, and its head names {shape} of {dtype}")
