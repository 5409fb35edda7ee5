"""The load cells: reads, computes, writes, says what it found."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np

from geocontact.analyses.loadcells.cycles import Cut, cuts_asked_for, stacked, style_table
from geocontact.analyses.loadcells.write import write_ensemble, write_recording
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.loadcells import LoadcellOptions
from geocontact.data.cell_regression import CellRegression
from geocontact.data.errors import InputError
from geocontact.io.recordings.load_cells import CellRecording, read_load_cells, read_regression
from geocontact.io.text.columns import parse_map
from geocontact.loads.loadcells import PUBLISHED, CompartmentForces, compartment_forces

LITTLE = 500.0  # N; a knee under body weight bears more at some time
SLIGHT = 0.01  # of the largest total; less tension than that is an offset not worth a word
WHOLE = 1e-6  # how far the two weights of a cell may be from 1 together


def analyse(paths: tuple[Path, ...], o: LoadcellOptions) -> int:
    """Run the whole analysis."""
    record = Record("loadcells", {"recordings": list(paths), **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        regression = _regression(record, o)
        folders = _folders(paths)
        mapping = {} if o.map is None else parse_map(o.map, regression.cells)
        recordings = {path: read_load_cells(path, regression.cells, o.unit, mapping) for path in folders}
        forces = {path: compartment_forces(r.time, r.forces, regression) for path, r in recordings.items()}
        for path, name in folders.items():
            unit = recordings[path].unit
            record.add_input("recording", path, unit=unit, frames=len(forces[path].time), folder=name or ".")
            _summarise(record, recordings[path], forces[path], regression, name)
        cuts = cuts_asked_for(record, forces, o)
        _tell(record, cuts)
        ensemble = write_ensemble(record, cuts, o, draft)
        for path, name in folders.items():
            folder = draft / name
            folder.mkdir(exist_ok=True)
            write_recording(record, recordings[path], forces[path], regression, cuts, ensemble, o, folder, name)
        record.write(draft, *(draft / name for name in folders.values()))
        written = sorted(str(file.relative_to(draft)) for file in draft.rglob("*") if file.is_file())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _regression(record: Record, o: LoadcellOptions) -> CellRegression:
    """The published weights, or those of --matrix."""
    regression = PUBLISHED if o.matrix is None else read_regression(o.matrix)
    if o.matrix is not None:
        record.add_input("--matrix", o.matrix)
    odd = {cell: share for cell, share in regression.shares.items() if abs(share - 1.0) > WHOLE}
    if odd:
        told = ", ".join(f"{cell} {share:g}" for cell, share in odd.items())
        record.warn(f"medial and lateral together do not count each cell's force once: {told}")
    record.results["regression"] = {
        "name": regression.name,
        "source": regression.source,
        "cells": list(regression.cells),
        "medial": list(regression.medial),
        "lateral": list(regression.lateral),
    }
    return regression


def _folders(paths: tuple[Path, ...]) -> dict[Path, str]:
    """Recordings and their sub-folders; none where there is one recording."""
    if len(paths) == 1:
        return {paths[0]: ""}
    names = [path.stem for path in paths]
    for name in names:
        if name in ("", ".", "..") or names.count(name) > 1 or name.lower() == "run.json":
            raise InputError("", "", f"recording {name!r} cannot have a sub-folder of its own", "rename its file")
    return dict(zip(paths, names, strict=True))


def _summarise(record: Record, r: CellRecording, f: CompartmentForces, regression: CellRegression, name: str) -> None:
    peaks = {side: float(values.max()) for side, values in f.curves.items()}
    least = -SLIGHT * peaks["total"]
    pulling = {c: float(v.min()) for c, v in zip(regression.cells, r.forces.T, strict=True) if v.min() < least}
    if pulling:
        told = ", ".join(f"{cell} {low:.0f} N" for cell, low in pulling.items())
        record.warn(f"{r.file}: cells are in tension at times ({told}): offsets, or the sign is turned (--map PM=-PM)")
    if peaks["total"] < LITTLE:
        what = f"the total stays below {peaks['total']:.0f} N, little for a knee that walks"
        record.warn(f"{r.file}: {what}; if the file is in lbf pass --unit lbf")
    at = float(f.time[int(np.argmax(f.total))])
    record.results[name or "recording"] = {
        "frames": len(f.time),
        **{f"peak_{side}_N": round(value, 6) for side, value in peaks.items()},
        "peak_total_at_s": round(at, 6),
    }
    label = f"{name}: " if name else ""
    told = ", ".join(f"{side} {value:.1f} N" for side, value in peaks.items())
    record.say(f"{label}largest forces: {told} (total at {at:g} s)")


def _tell(record: Record, cuts: list[Cut]) -> None:
    if not cuts:
        return
    counts = {style: len(trials) for style, trials in stacked(cuts, "total").items()}
    record.results["cycles"] = counts
    record.say(f"cycles: {', '.join(f'{style} {count}' for style, count in counts.items())}")
    if max(counts.values()) == 1:
        record.warn("one cycle per style: means are single cycles, and there is no spread to show")
    if len(counts) > 1:
        table = style_table(cuts)
        record.results["styles"] = table.to_dict(orient="records")
        record.say(table.to_string(index=False, float_format=lambda value: f"{value:.1f}"))
