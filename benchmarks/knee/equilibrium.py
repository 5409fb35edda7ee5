"""Contact equilibrium by time, forces left over, balance of energy, convergence: `python -m
benchmarks.knee.equilibrium`.

The shipped synthetic knee in five frames of its gait under 2000 N, by resolution and length of the pieces, with only
adduction free and with all coordinates, each against the finest. With `--data`, subject DM's implants (closed, poses by
fluoroscopy) and subject JW's (of 188 and 49 faces, both open: the component is taken as closed, the layer has 8 mm;
poses simulated by others), five frames of each under 1500 N. Loads, modulus (463 MPa), Poisson's ratio (0.46) and the
8 mm are invented numbers of a usual size. Seconds are those of the equilibria and of one balance of energy, without
reading.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from benchmarks.machine import as_json, stamp
from geocontact.analyses.frame.record import Record
from geocontact.analyses.knee.settle import result as settle_run
from geocontact.analyses.knee.settle.equilibrium import read
from geocontact.analyses.knee.settle.options import SettleOptions
from geocontact.data.errors import InputError

HERE = Path(__file__).resolve().parents[1]
MESHES = HERE.parent / "meshes"
ALL = ("adduction", "anterior", "mediolateral", "rotation")
KEPT = ("peak [MPa]", "contact_area [mm^2]", "force_medial [N]", "axial [mm]", "adduction [deg]", "anterior [mm]")
"""Columns whose largest difference to the finest run is told."""


@dataclass(frozen=True)
class Case:
    """Meshes and length of the pieces [m], with which coordinates free, and of how many frames one is taken."""

    name: str
    options: dict[str, Any]
    free: tuple[str, ...]
    edge: float
    every: int = 25


def main() -> None:
    """Measure, print, write the JSON after every row."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.knee.equilibrium", description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, help="folder of the real recordings")
    parser.add_argument("--only", help="JW: only cases whose name begins so, beside the others that the file holds")
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    report: dict[str, Any] = {**stamp({"scipy"}), "rows": []}
    if options.only:
        held = json.loads((options.out / "equilibrium.json").read_text(encoding="utf-8"))["rows"]
        report["rows"] = [row for row in held if not row["case"].startswith(options.only)]
    finest: dict[object, pd.DataFrame] = {}
    for case in [*shipped(), *([*fluoroscopy(options.data), *decimated(options.data)] if options.data else ())]:
        if not case.name.startswith(options.only or ""):
            continue
        row, table = measured(case)
        if table is not None:
            key = case.name.split(",")[0], case.free
            row["largest_difference_to_finest"] = apart(table, finest.setdefault(key, table))
        report["rows"].append(row)
        print(json.dumps(row), flush=True)
        (options.out / "equilibrium.json").write_text(as_json(report), encoding="utf-8")


def shipped() -> Iterator[Case]:
    """The synthetic knee, the finest first."""
    for free in (("adduction",), ALL):
        for resolution, edge in (("medium", 0.5e-3), ("medium", 1e-3), ("coarse", 0.5e-3), ("coarse", 1e-3)):
            names = (f"{body}_right_{resolution}.stl" for body in ("femoral_component", "tibial_insert"))
            moving, fixed = (MESHES / name for name in names)
            given = {"moving": moving, "fixed": fixed, "unit": "mm", "motion": MESHES / "gait.csv", "load": 2000.0}
            yield Case(f"sample knee, {resolution}", given, free, edge)


def fluoroscopy(data: Path) -> Iterator[Case]:
    """Subject DM of the 6th Grand Challenge; labels of the file are wrong, as its spreadsheet shows."""
    home = data / "gc6_dm_knee"
    given = {
        "moving": home / "stl" / "Femoral Component decimated.stl",
        "fixed": home / "stl" / "Tibial Insert decimated.stl",
        "unit": "m",
        "motion": home / "fluoroscopy" / "Fluoroscopic Gait Data.sto",
        "map": "rx=knee_flex_r,ry=knee_add_r,rz=knee_rot_r,tx=knee_ant_r,ty=knee_sup_r,tz=knee_lat_r",
        "angles": "rad",
        "load": 1500.0,
    }
    for free, edge in ((("adduction",), 0.5e-3), (("adduction",), 1e-3), (ALL, 1e-3)):
        yield Case("DM", given, free, edge)


def decimated(data: Path) -> Iterator[Case]:
    """Subject JW of the 4th Grand Challenge, as a workshop decimated and moved it."""
    home = data / "gc4_jw_predsim_workshop"
    given = {
        "moving": home / "Femoral_Component_simpler.stl",
        "fixed": home / "Tibial_Insert_simpler_superior.stl",
        "unit": "m",
        "motion": home / "KneeProsthesis.mot",
        "osim": home / "KneeProsthesis.osim",
        "joint": "knee_joint",
        "moving_body": "parent",
        "angles": "deg",
        "assume_closed": "moving",
        "thickness": 8e-3,
        "load": 1500.0,
    }
    for free, edge in ((("adduction",), 1e-3), (("adduction",), 2e-3), (ALL, 2e-3)):
        yield Case("JW", given, free, edge, every=10)


def measured(case: Case) -> tuple[dict[str, Any], pd.DataFrame | None]:
    """What one run took and left over; no table where it was refused."""
    o = SettleOptions(
        **case.options, side="right", modulus=463e6, poisson=0.46, region="ny>0.25", free=case.free, piece=case.edge
    )
    row: dict[str, Any] = {"case": case.name, "free": case.free, "piece_mm": case.edge * 1e3}
    record = Record("knee settle", o.in_si(), o.in_si())
    with record.catching_warnings():
        inputs = thinned(read(o), case.every)
        started = time.process_time()
        try:
            result = settle_run.run(inputs, o)
        except InputError as error:
            return {**row, "refused": str(error)}, None
    seconds, s, told = time.process_time() - started, result.settled, record.results["equilibrium"]
    row |= {
        "faces": [len(inputs.bed.moving.faces), len(inputs.fixed.faces)],
        "frames": len(s.frames),
        "at_rest": int(s.converged.sum()),
        "cpu_s_per_frame": round(seconds / len(s.frames), 4),
        "largest_residual_of_load": float(np.nanmax(s.residuals / inputs.load)),
        "balance_of_energy": None if result.balance is None else result.balance.difference,
        **(told if isinstance(told, dict) else {}),
        "warnings": [_without_folders(line, case.options) for line in record.warnings],
    }
    return row, result.table()


def _without_folders(line: str, options: dict[str, Any]) -> str:
    """A warning with names of files in place of their paths."""
    for value in options.values():
        line = line.replace(str(value), value.name) if isinstance(value, Path) else line
    return line


def thinned(inputs: Any, every: int) -> Any:
    """One of so many frames."""
    kept = np.arange(0, len(inputs.motion), every)
    motion = replace(inputs.motion, time=inputs.motion.time[kept], poses=inputs.motion.poses[kept])
    return replace(inputs, motion=motion, load=inputs.load[kept])


def apart(table: pd.DataFrame, finest: pd.DataFrame) -> dict[str, float]:
    """Largest difference of each column over the frames."""
    return {name: float(np.nanmax(np.abs(table[name] - finest[name]))) for name in KEPT}


if __name__ == "__main__":
    main()
