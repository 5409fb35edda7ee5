"""Tables over time: OpenSim's .mot and .sto, and .csv with `name [unit]` headers."""

from __future__ import annotations

import csv
import re
import warnings
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from io import TextIOBase
from os import PathLike, fspath
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.frame_blocks import Growing, blocks, release, room
from geocontact.data.magnitude import too_large
from geocontact.data.motion import Signals
from geocontact.data.plausible import TOO_LARGE
from geocontact.io.text.column_names import ColumnNames
from geocontact.io.text.file_preflight import EMPTY, UTF8, encoding_of, open_file, open_text, refuse_no_text
from geocontact.io.text.plain_table import SHEET, open_plain
from geocontact.io.text.storage_header import LONGEST_LINE, AngleEvidence, StorageHeader, read_storage_header
from geocontact.io.text.units import split_header

_BLOCK = 2048
_NOT_A_NUMBER = ("", "1.#qnan", "-1.#qnan", "1.#ind", "-1.#ind")
"""Empty cells, and what C on Windows prints for NaN."""


def read_rows(
    stream: Iterable[str], first: int, names: tuple[str, ...], file: str, split: Callable[[str, None, int], list[str]]
) -> tuple[Float[np.ndarray, "t c"], Int[np.ndarray, " t"]]:
    """Numbers below the labels and the line of each row; blank lines are passed over."""
    values, lines = Growing(), array("q")
    rows: list[list[str]] = []
    plain = True
    for number, line in enumerate(stream, first):
        cells = split(line, None, len(names))
        if not cells:
            continue
        if len(cells) != len(names):
            raise unequal(len(cells), line, len(names), file, number)
        plain = plain and "_" not in line and line.isascii()
        rows.append(cells)
        lines.append(number)
        if len(rows) == _BLOCK:
            values.extend_by(_numbers(rows, lines[-_BLOCK:], names, file, plain))
            rows, plain = [], True
    if not lines:
        raise InputError(file, f"line {first}", "no rows below the column labels", "is the file complete?")
    if rows:
        values.extend_by(_numbers(rows, lines[-len(rows) :], names, file, plain))
    return values.values().reshape(-1, len(names)), np.array(lines, dtype=np.int64)


def unequal(cells: int, line: str, named: int, file: str, number: int) -> InputError:
    """For a row that is not as long as its header; a longer one between commas may have decimal commas."""
    what = f"{'more' if cells > named else cells} cells where {named} columns are named"
    if cells > named and line.count(",") >= named and "\t" not in line:
        remedy = "write decimal points, and rows as long as the header"
        return InputError(file, f"line {number}", f"{what} (decimal commas?)", remedy)
    return InputError(file, f"line {number}", what, "rows must be as long as the header")


def _numbers(
    rows: list[list[str]], lines: Sequence[int], names: tuple[str, ...], file: str, plain: bool
) -> Float[np.ndarray, "r c"]:
    """Cells as floats; `plain` rules out what Python takes for a number and a table does not mean as one."""
    values = _plain(rows) if plain else None
    if values is None:
        values = np.array([list(_row(row, line, names, file)) for row, line in zip(rows, lines, strict=True)], float)
    odd = np.argwhere(too_large(values))
    if len(odd):
        row, column = odd[0]
        what = f"{values[row, column]:g} in column '{names[column]}' {TOO_LARGE}"
        raise InputError(file, f"line {lines[row]}", what, "is the file damaged?")
    return values


def _plain(rows: list[list[str]]) -> Float[np.ndarray, "r c"] | None:
    """All cells at once; None where one is no number for numpy."""
    try:
        return np.array(rows, dtype=np.float64)
    except ValueError:
        return None


def _row(row: list[str], line: int, names: tuple[str, ...], file: str) -> Iterator[float]:
    for cell, name in zip(row, names, strict=True):
        text = cell.strip().strip('"').strip()
        try:
            if "_" in text or not text.isascii():
                raise ValueError(text)
            yield float("nan") if text.lower() in _NOT_A_NUMBER else float(text)
        except ValueError as error:
            what = f"'{text[:40]}' in column '{name}' is not a number"
            raise InputError(file, f"line {line}", what, "use decimal points, leave missing cells NaN") from error


CELLS = (".csv", SHEET)
"""Endings of tables whose headers say the unit of each column."""

LARGEST_FILE = 256_000_000
"""Bytes; a table of 60 columns at 1 kHz for two hours."""

_TIME = re.compile(r"time\s*(?:\((?P<unit>[^()]*)\))?", re.IGNORECASE)
"""Name of the time column; recorders also write its unit in round brackets: Time(sec)."""

_PLACE = re.compile(r"gait|(?:gait\s+|stance\s+)?(?:cycle|phase)", re.IGNORECASE)
"""Name of the time column in per cent, where there is none that is called time: gait cycle [%], cycle [%]."""

CYCLE = np.arange(101.0)
"""Times of a cycle in per cent, as gait software writes it; nobody records 101 frames at one a second."""


@dataclass(frozen=True)
class TextTable(Signals):
    """A table as its file has it; conversion to SI happens where a column is used (`columns.py`).

    Parameters
    ----------
    file
        Path as given, for messages.
    lines
        Line of the file that each row stands in.
    angles
        What the header says of angles (OpenSim files; a .csv says it per column in `units`).
    opensim
        True for .mot and .sto: lengths are in m.
    time_unit
        Unit of `time`: "s", or "%" of a cycle. Without a unit it is "s", but 0, 1, … 100 is "%", with a warning.
    words
        Names of columns that hold words and were left out.
    """

    file: str
    lines: Int[np.ndarray, " t"]
    angles: AngleEvidence
    opensim: bool
    time_unit: str = "s"
    words: tuple[str, ...] = ()

    def column(self, name: str) -> Float[np.ndarray, " t"]:
        """Values of one channel; KeyError where there is none of that name, InputError where there are several."""
        if (count := self.channels.count(name)) > 1:
            what = f"column '{name}' occurs {count} times"
            raise InputError(self.file, "", what, f"columns are: {listed(self.channels)}")
        return super().column(name)

    def needed(self, name: str) -> Float[np.ndarray, " t"]:
        """Values of a column that must be there once and finite; InputError otherwise."""
        if name not in self.channels:
            raise InputError(self.file, "", f"no column '{name}'", f"columns are: {listed(self.channels)}")
        values = self.column(name)
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            what = f"column '{name}' is {values[bad[0]]} in {len(bad)} of {len(values)} rows"
            raise InputError(self.file, f"line {self.lines[bad[0]]}", what, "fill the gap or cut the frames")
        return values


def listed(names: tuple[str, ...], most: int = 30) -> str:
    """Names for a message, the tail cut."""
    shown = ", ".join(name[:80] for name in names[:most])
    return f"{shown} … ({len(names)} in all)" if len(names) > most else shown or "none"


def read_table(path: str | PathLike[str], leave_words: bool = False) -> TextTable:
    """Table in a .mot, .sto (versions 1 to 3, SIMM's form too), .csv or .xlsx file.

    With `leave_words`, columns of a .csv or .xlsx that hold words in all rows are left out; they are refused without.

    Refused with InputError: other content, ragged rows, cells that are not numbers, and time that is missing, NaN or
    not strictly increasing. Warned of: counts that the header declares and the rows do not bear out, bytes that are
    not UTF-8 (taken as Latin-1). NaN elsewhere is kept until the column is used: force plates are full of it.
    """
    file, suffix = fspath(path), Path(path).suffix.lower()
    if suffix not in (".mot", ".sto", *CELLS):
        raise InputError(file, "", f"'{suffix}' is not a table of motion", "give a .mot, .sto, .csv or .xlsx file")
    if suffix != SHEET:
        _preflight(file)
    encoding = UTF8 if suffix == SHEET else encoding_of(file)
    if suffix in CELLS:
        with open_plain(file, encoding=encoding) as stream:
            return _read_csv(stream, file, leave_words)
    with open_text(file, encoding) as stream:
        return _read_storage(stream, file)


def _preflight(file: str) -> None:
    with open_file(file, LARGEST_FILE) as raw:
        head = raw.read(4096)
    refuse_no_text(head, file)
    if not head.strip():
        raise InputError(file, "", EMPTY, "export it again")
    if b"\0" in head:
        raise InputError(file, "", "binary content, not a text table", "export it as text (UTF-8)")
    if head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        raise InputError(file, "line 1", "HTML or XML, not a table", "was a web page saved in place of the file?")


def _read_storage(stream: TextIOBase, file: str) -> TextTable:
    header = read_storage_header(stream, file)
    names = tuple(_label_line(stream, file, header.lines + 1).split())
    values, lines = read_rows(stream, header.lines + 2, names, file, str.split)
    _warn_of_counts(header, len(values), len(names), file)
    return _table(file, names, ("",) * len(names), values, lines, header.angles)


def read_quaternions(path: str | PathLike[str]) -> TextTable:
    """Table of OpenSense (.sto, `DataType=Quaternion`): four columns for each, its name and w, x, y or z."""
    file = fspath(path)
    _preflight(file)
    with open_text(file, encoding_of(file)) as stream:
        header = read_storage_header(stream, file, "quaternion")
        labels = tuple(_label_line(stream, file, header.lines + 1).split())
        names = (*labels[:1], *(f"{label} {part}" for label in labels[1:] for part in "wxyz"))
        values, lines = read_rows(stream, header.lines + 2, names, file, _split_quaternions)
        return _table(file, names, ("",) * len(names), values, lines, header.angles)


def _split_quaternions(line: str, _separator: None, _most: int) -> list[str]:
    """Time and the four numbers of each cell; a cell that is NaN as a whole is four of them."""
    first, *cells = line.split() or [""]
    parts = [part for cell in cells for part in (cell.split(",") if "," in cell else 4 * [cell])]
    return [first, *parts] if first else []


def _warn_of_counts(header: StorageHeader, rows: int, columns: int, file: str) -> None:
    """Counts of the header that are not those of the table: OpenSim reads on without a word."""
    counts = [
        (header.rows, rows, "rows follow: is the file complete?"),
        (header.columns, columns, "column labels follow"),
    ]
    for declared, found, what in counts:
        for count, text, line in declared:
            if count != found:
                warnings.warn(
                    InputWarning(f"{file} line {line}: header says '{text}' but {found} {what}"), stacklevel=4
                )


def _read_csv(stream: TextIOBase, file: str, leave_words: bool) -> TextTable:
    number, line = 1, _label_line(stream, file, 1)
    while line.lstrip().startswith("#"):
        number, line = number + 1, _label_line(stream, file, number + 1)
    headers = [split_header(cell) for cell in next(csv.reader([line], skipinitialspace=True), [])]
    names, units = tuple(name for name, _ in headers), tuple(unit for _, unit in headers)
    words = _WordColumns(names, file)
    values, lines = read_rows(stream, number + 1, names, file, words.split if leave_words else _split_commas)
    return _table(file, names, units, values, lines, None, frozenset(words.first))


class _WordColumns:
    """Columns whose cells are words from the first row to the last, but for empty ones; they are read as NaN.

    A column with a word in the first row and a number in another one is refused, as one with a damaged number.
    """

    def __init__(self, names: tuple[str, ...], file: str) -> None:
        self.names, self.file = names, file
        self.first: dict[int, str] = {}
        self.begun = False

    def split(self, line: str, separator: None, most: int) -> list[str]:
        """Cells of a line as `_split_commas` has them."""
        cells = _split_commas(line, separator, most)
        if cells and not self.begun:
            self.begun = True
            places = [i for i, name in enumerate(self.names[: len(cells)]) if not _TIME.fullmatch(name)]
            self.first = {i: cells[i] for i in places if not _is_number(cells[i])}
        for i, word in self.first.items():
            if i < len(cells):
                if cells[i].strip() and _is_number(cells[i]):
                    what = f"'{word.strip()[:40]}' in column '{self.names[i]}' is not a number"
                    raise InputError(self.file, "", what, "use decimal points, leave missing cells NaN")
                cells[i] = "nan"
        return cells


def _is_number(cell: str) -> bool:
    """Whether a cell is a number, empty, or another word for NaN."""
    text = cell.strip().strip('"').strip()
    if text.lower() in _NOT_A_NUMBER:
        return True
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text and text.isascii()


def _split_commas(line: str, _separator: None, most: int) -> list[str]:
    """At most `most` + 1 cells of a line; a comma at its end, as some recorders write it, is not one more cell."""
    cells = line.split(",", most) if line.strip() else []
    return cells[:most] if len(cells) > most and not cells[most].strip() else cells


def _label_line(stream: TextIOBase, file: str, number: int) -> str:
    line = stream.readline(LONGEST_LINE)
    if not line.strip() or len(line) >= LONGEST_LINE:
        raise InputError(file, f"line {number}", "no column labels found", "is the file complete?")
    return line


def _table(
    file: str,
    names: tuple[str, ...],
    units: tuple[str, ...],
    values: Float[np.ndarray, "t c"],
    lines: Int[np.ndarray, " t"],
    angles: AngleEvidence | None,
    words: frozenset[int] = frozenset(),
) -> TextTable:
    """Take the time column out and check it; `angles` is None for .csv. Columns at the places `words` are left out."""
    places = [i for i, name in enumerate(names) if _TIME.fullmatch(name)]
    if not places:
        places = [i for i, name in enumerate(names) if units[i] == "%" and _PLACE.fullmatch(name)]
    if len(places) != 1:
        what = f"{len(places) or 'no'} columns named 'time'"
        raise InputError(file, f"line {lines[0] - 1}", what, f"one is needed; columns are: {listed(names)}")
    rest = [i for i in range(len(names)) if i != places[0] and i not in words]
    found = _TIME.fullmatch(names[places[0]])
    unit = units[places[0]] or (found["unit"] or "" if found else "")
    time, time_unit = _time(values[:, places[0]], unit, lines, file)
    return TextTable(
        time=time,
        values=_columns(values, rest),
        channels=ColumnNames(names[i] for i in rest),
        units=tuple(units[i] for i in rest),
        file=file,
        lines=lines,
        angles=angles or AngleEvidence(),
        opensim=angles is not None,
        time_unit=time_unit,
        words=tuple(names[i] for i in sorted(words)),
    )


def _columns(values: Float[np.ndarray, "t c"], places: list[int]) -> Float[np.ndarray, "t k"]:
    """Some of the columns, each of them lying together: who reads one of a long table reads no other."""
    found = room((len(places), len(values)))
    for some in blocks(len(values), values.shape[1]):
        found[:, some] = values[some][:, places].T
        release()
    return found.T


def _time(
    values: Float[np.ndarray, " t"], unit: str, lines: Int[np.ndarray, " t"], file: str
) -> tuple[Float[np.ndarray, " t"], str]:
    seconds = {"": 1.0, "s": 1.0, "sec": 1.0, "ms": 1e-3, "%": 1.0}
    if unit not in seconds:
        raise InputError(file, "", f"time is in '{unit}'", "write `time [s]`, [ms] or [%]")
    bad = np.flatnonzero(~np.isfinite(values))
    if len(bad):
        raise InputError(file, f"line {lines[bad[0]]}", f"time is {values[bad[0]]}", "every row needs its time")
    late = np.flatnonzero(np.diff(values) <= 0.0)
    if len(late):
        i = late[0]
        what = f"time {values[i + 1]:.9g} does not follow {values[i]:.9g}"
        raise InputError(file, f"line {lines[i + 1]}", what, "time must increase from row to row")
    if not unit and np.array_equal(values, CYCLE):
        told = f"{file}: time without a unit is 0, 1, … 100: taken as per cent of a cycle; write `time(s)` for seconds"
        warnings.warn(InputWarning(told), stacklevel=5)
        unit = "%"
    return values * seconds[unit], "%" if unit == "%" else "s"
