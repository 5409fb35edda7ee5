"""Text that mats' programs export: its lines, and numbers with a decimal point or comma."""

from __future__ import annotations

import csv
import re
from codecs import getincrementaldecoder
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from os import fspath
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import Growing
from geocontact.io.mats.layout import MatLayout
from geocontact.io.text.file_preflight import (
    BYTE_ORDER_MARK,
    MAX_BYTES,
    PIECE,
    UNKNOWN,
    lines_in,
    looks_like,
    open_file,
)

LARGEST_RECORDING = MAX_BYTES
"""Bytes of one file; it is read a block at a time."""

MOST_VALUES = 512_000_000
"""Cells times frames of one mat: 1000 cells at 100 Hz for 85 minutes, 4 GB of a temporary file."""

HEAD = 1 << 16
"""Bytes in which a file has to show of what kind it is."""

LONGEST_LINE = 1_000_000
"""Bytes; 10 characters for each of 1e5 cells."""


_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(,\d{3})+")


@dataclass(frozen=True)
class MatText:
    """A file of text, read a block at a time.

    Parameters
    ----------
    file
        Its path.
    start
        Its first bytes, without a byte order mark.
    whole
        Whether these are all.
    encoding
        What its bytes are read with.
    """

    file: str
    start: bytes
    whole: bool
    encoding: str

    @cached_property
    def head(self) -> tuple[str, ...]:
        """The lines at its beginning, blank ones too; none that is cut."""
        found = [line.decode(self.encoding, "replace").strip(" ") for line in self.start.splitlines()]
        return tuple(found if self.whole or len(found) == 1 else found[:-1])

    def lines(self) -> Iterator[tuple[int, str]]:
        """Number and text of every line that is not blank, without blanks around it; tabs at its end are cells."""
        with open_file(self.file) as stream:
            for number, line in enumerate(lines_in(stream.read, LONGEST_LINE), 1):
                own = line.removeprefix(BYTE_ORDER_MARK) if number == 1 else line
                if len(own) > LONGEST_LINE:
                    raise InputError(self.file, f"line {number}", "is too long", "is this the export of a mat?")
                if text := own.decode(self.encoding, "replace").strip(" "):
                    yield number, text


def read_mat_text(path: Path) -> MatText:
    """Content of an export: text in UTF-8 or, as older programs write their `²`, in Windows-1252."""
    file = fspath(path)
    with open_file(path, LARGEST_RECORDING, "export it in parts") as stream:
        start = stream.read(HEAD + len(BYTE_ORDER_MARK)).removeprefix(BYTE_ORDER_MARK)
        blank, binary, encoding = _surveyed(start, stream.read)
    if blank:
        raise InputError(file, "", "the file is empty", "export it again")
    what, _ = looks_like(start)
    if what in ("plain text", UNKNOWN[0]):
        what = "binary data" if binary else ""
    if what:
        remedy = "export the recording as text (ASCII, CSV), or fetch the file itself"
        raise InputError(file, "", f"is not the recording of a mat: it looks like {what}", remedy)
    return MatText(file, start[:HEAD], len(start) < HEAD, encoding)


def _surveyed(start: bytes, read: Callable[[int], bytes]) -> tuple[bool, bool, str]:
    """Whether a file is blank, whether it has a NUL, and its encoding, from its first bytes and what follows."""
    blank, binary, encoding = True, False, "utf-8"
    decoder = getincrementaldecoder("utf-8")()
    for piece in chain([start], iter(lambda: read(PIECE), b""), [b""]):
        blank, binary = blank and not piece.strip(), binary or b"\0" in piece
        try:
            if encoding == "utf-8":
                decoder.decode(piece, final=not piece)
        except UnicodeDecodeError:
            encoding = "cp1252"
    return blank, binary, encoding


@dataclass(frozen=True)
class Notation:
    """How rows of numbers are written: what separates them and the decimal mark."""

    delimiter: str
    decimal: str

    def cells(self, line: str) -> list[str]:
        """Cells of a line; quoted ones keep the commas inside them, and a separator at the end begins no cell."""
        found = line.split(self.delimiter) if '"' not in line else self._unquoted(line)
        return found[:-1] if len(found) > 1 and not found[-1].strip() else found

    def _unquoted(self, line: str) -> list[str]:
        try:
            return next(csv.reader([line], delimiter=self.delimiter, skipinitialspace=True))
        except csv.Error:  # a quote left open before very many characters: one cell, and no number
            return [line]

    def add(self, cells: list[str], values: Growing, file: str, line: int, missing: str = "") -> None:
        """Append the numbers in `cells` to `values`; NaN where a cell is blank or says `missing`."""
        if len(values) + len(cells) > MOST_VALUES:
            what = f"more than the {MOST_VALUES} values that are read"
            raise InputError(file, f"line {line}", what, "export it in parts")
        try:
            text = cells if self.decimal == "." else [self._pointed(cell) for cell in cells]
            numbers = list(map(float, text))
            plain = not any("_" in cell for cell in cells)
        except ValueError:
            plain = False
        if not plain:
            numbers = [self._number(cell, column, file, line, missing) for column, cell in enumerate(cells, 1)]
        values.extend(numbers)

    def number(self, text: str) -> float:
        """Number of one cell; ValueError when it is none. Python's `1_000` is none here, and neither is 1.234,5."""
        if "_" in text:
            raise ValueError(text)
        return float(text if self.decimal == "." else self._pointed(text))

    def _pointed(self, text: str) -> str:
        if "." in text:
            raise ValueError(text)
        return text.replace(",", ".")

    def _number(self, cell: str, column: int, file: str, line: int, missing: str) -> float:
        text = cell.strip()
        if not text or text == missing:
            return float("nan")
        try:
            return self.number(text)
        except ValueError:
            mark = "point" if self.decimal == "." else "comma"
            what = f"'{shown(text)}' in cell {column} is not a number with a decimal {mark}"
            remedy = f"export it again, or say delimiter and decimal in the layout (read here: {self.words})"
            raise InputError(file, f"line {line}", what, remedy) from None

    @property
    def words(self) -> str:
        """For messages."""
        return f"delimiter '{'tab' if self.delimiter == chr(9) else self.delimiter}', decimal '{self.decimal}'"


def notation_of(sample: Iterable[str], layout: MatLayout | None, file: str) -> Notation:
    """How rows of cells are written, by the layout or by the rows at the beginning of the file.

    Tabs and semicolons separate wherever they occur; then a comma inside a cell is a decimal comma. With commas
    between the cells a decimal comma is one only inside quotes. Where every comma could as well part thousands, none of
    the two is guessed: InputError unless the layout says `decimal`.
    """
    rows = list(sample)
    delimiter = {"tab": "\t"}.get(said, said) if (said := layout.delimiter if layout else None) else None
    delimiter = delimiter or next((mark for mark in "\t;" if any(mark in row for row in rows)), ",")
    decimal = layout.decimal if layout else None
    if decimal is None:
        plain = Notation(delimiter, ".")
        with_comma = [cell.strip() for row in rows for cell in plain.cells(row) if "," in cell]
        if with_comma and all(_THOUSANDS.fullmatch(cell) for cell in with_comma):
            what = f"'{shown(with_comma[0])}' may be thousands or have a decimal comma, as every cell with a comma"
            raise InputError(file, "", what, 'say decimal = "," or "." in the layout, thousands written together')
        decimal = "," if with_comma else "."
    return Notation(delimiter, decimal)


def shown(text: str, most: int = 30) -> str:
    """The beginning of a text as it is quoted in a message."""
    return "".join(c if c.isprintable() else "?" for c in text[:most])
