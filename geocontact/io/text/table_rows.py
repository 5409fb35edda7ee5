"""Rows of numbers below the column labels of a text table, with the line each stands in."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.data.magnitude import too_large
from geocontact.data.plausible import TOO_LARGE

_BLOCK = 2048
_NOT_A_NUMBER = ("", "1.#qnan", "-1.#qnan", "1.#ind", "-1.#ind")
"""Empty cells, and what C on Windows prints for NaN."""


def read_rows(
    stream: Iterable[str], first: int, names: tuple[str, ...], file: str, split: Callable[[str, None, int], list[str]]
) -> tuple[Float[np.ndarray, "t c"], Int[np.ndarray, " t"]]:
    """Numbers below the labels and the line of each row; blank lines are passed over."""
    blocks: list[Float[np.ndarray, "r c"]] = []
    lines: list[int] = []
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
            blocks.append(_numbers(rows, lines[-_BLOCK:], names, file, plain))
            rows, plain = [], True
    if not lines:
        raise InputError(file, f"line {first}", "no rows below the column labels", "is the file complete?")
    if rows:
        blocks.append(_numbers(rows, lines[-len(rows) :], names, file, plain))
    return np.concatenate(blocks), np.array(lines, dtype=np.int64)


def unequal(cells: int, line: str, named: int, file: str, number: int) -> InputError:
    """For a row that is not as long as its header; a longer one between commas may have decimal commas."""
    what = f"{'more' if cells > named else cells} cells where {named} columns are named"
    if cells > named and line.count(",") >= named and "\t" not in line:
        remedy = "write decimal points, and rows as long as the header"
        return InputError(file, f"line {number}", f"{what} (decimal commas?)", remedy)
    return InputError(file, f"line {number}", what, "rows must be as long as the header")


def _numbers(
    rows: list[list[str]], lines: list[int], names: tuple[str, ...], file: str, plain: bool
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
