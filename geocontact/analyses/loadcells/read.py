"""What the forces of an instrumented implant are computed from: recordings, weights of the cells, times of cycles."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from geocontact.analyses import quantities
from geocontact.analyses.loadcells.options import FOUND, LoadcellOptions
from geocontact.analyses.run_record import Record
from geocontact.data.cell_regression import CellRegression
from geocontact.data.errors import InputError
from geocontact.identify.signals.cycles import Span
from geocontact.io.recordings.cycle_table import read_cycle_table
from geocontact.io.recordings.load_cells import CellRecording, read_load_cells, read_regression
from geocontact.io.text.columns import parse_map
from geocontact.loads.loadcells import PUBLISHED

GivenCycle = tuple[str, Path, Span]
"""Style, recording, times."""


@dataclass(frozen=True)
class LoadCellInputs:
    """Recordings by file, weights of their cells, and the cycles whose times are given; None where none are."""

    regression: CellRegression
    recordings: dict[Path, CellRecording]
    cycles: list[GivenCycle] | None


def read(o: LoadcellOptions, record: Record) -> LoadCellInputs:
    """Everything the options name."""
    regression = PUBLISHED
    if o.matrix is not None:
        regression = read_regression(o.matrix)
        record.add_input("`matrix`", o.matrix)
    mapping = {} if o.map is None else parse_map(o.map, regression.cells)
    recordings = {path: read_load_cells(path, regression.cells, o.unit, mapping) for path in o.recordings}
    for path, folder in o.folders.items():
        r = recordings[path]
        record.add_input("recording", path, unit=r.unit, frames=len(r.time), folder=folder or ".")
    return LoadCellInputs(regression, recordings, _given_cycles(record, o))


def _given_cycles(record: Record, o: LoadcellOptions) -> list[GivenCycle] | None:
    asked = (o.cycles or "").strip()
    if o.cycles is None or asked in FOUND:
        return None
    file = quantities.named_file(asked)
    if file is not None:
        record.add_input("`cycles`", file)
        return _from_table(file, o.recordings)
    if len(o.recordings) > 1:
        raise InputError("", "`cycles`", "times do not say which recording they are of", "give a table of cycles")
    (path,) = o.recordings
    return [(path.stem, path, span) for span in _typed(asked)]


def _typed(text: str) -> list[Span]:
    spans = []
    for part in text.split(","):
        start, colon, end = part.partition(":")
        if not colon:
            what = f"{part.strip()!r} is neither stride, stance, a file nor start:end"
            raise InputError("", "`cycles`", what, "write for example stride or 1.7:2.8,2.8:3.9")
        span = Span(*(quantities.number(value, "`cycles`", "1.7:2.8,2.8:3.9") for value in (start, end)))
        if not span.start < span.end:
            raise InputError("", "`cycles`", f"{part.strip()!r} ends before it starts", "write start:end in seconds")
        spans.append(span)
    return spans


def _from_table(file: Path, paths: tuple[Path, ...]) -> list[GivenCycle]:
    known = {path.stem: path for path in paths}
    spans = []
    for row in read_cycle_table(file):
        path = known.get(row.recording) or (paths[0] if len(paths) == 1 and not row.recording else None)
        if path is None:
            what = f"recording {row.recording!r} is not among those given: {', '.join(known)}"
            raise InputError(file, "", what, "write the name of a file without its ending")
        spans.append((row.style, path, Span(row.start, row.end)))
    return spans
