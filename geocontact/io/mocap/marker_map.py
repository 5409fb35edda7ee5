"""Which marker of a recording is which of a model, as a file or as typed: `RHEE=R.Heel,LHEE=L.Heel`."""

from __future__ import annotations

from os import PathLike, fspath

from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import read_bytes

EXAMPLE = "RHEE=R.Heel"
HEAD = ("recorded", "lab", "label")
"""First cells that begin a head of two columns."""


def read_marker_map(path: str | PathLike[str]) -> dict[str, str]:
    """Names of the model by those of the recording, a pair in each line: `RHEE=R.Heel` or `RHEE,R.Heel`.

    Empty lines and those that begin with # are passed over, and so is a head of the columns recorded and model.
    """
    file = fspath(path)
    found: dict[str, str] = {}
    for number, line in enumerate(read_bytes(path).decode("utf-8-sig", errors="replace").splitlines(), 1):
        text = line.strip().rstrip(",;")
        if not text or text.startswith("#"):
            continue
        for mark in ("=", "\t", ";", ","):
            if mark in text:
                break
        cells = [cell.strip().strip('"') for cell in text.split(mark)]
        if cells[0].lower() in HEAD and not found:
            continue
        _add(found, cells, file, f"line {number}")
    if not found:
        raise InputError(file, "", "holds no pair of markers", f"write {EXAMPLE} in each line")
    return found


def marker_map_typed(text: str, option: str) -> dict[str, str]:
    """The same from one text, pairs between commas."""
    found: dict[str, str] = {}
    for part in text.split(","):
        _add(found, [cell.strip() for cell in part.split("=")], "", option)
    return found


def _add(found: dict[str, str], cells: list[str], file: str, place: str) -> None:
    if len(cells) != 2 or not all(cells):
        what = f"'{'='.join(cells)[:60]}' is not a recorded marker and one of the model"
        raise InputError(file, place, what, f"write for example {EXAMPLE}")
    recorded, name = cells
    if recorded in found or name in found.values():
        twice = recorded if recorded in found else name
        raise InputError(file, place, f"'{twice[:60]}' is named twice", "name each marker once")
    found[recorded] = name
