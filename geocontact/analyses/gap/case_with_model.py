"""A gap case from its folder, with its base model."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from geocontact.analyses.run_record import Record
from geocontact.chain.system import System
from geocontact.data.gap.case import GapCase
from geocontact.io.cases.case_cells import cells_file
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems.catalogue import system_of


@dataclass(frozen=True)
class CaseWithModel:
    """A case, the base model that it names, and the folder that it was read from."""

    folder: Path
    case: GapCase
    system: System


def read_case(folder: Path, run_simulator: bool, record: Record) -> CaseWithModel:
    """Case in a folder; `run_simulator` allows one of the system "command" to run the program that it names."""
    case = read_gap_case(folder, run_programs=run_simulator)
    system = system_of(case)
    add_inputs(record, folder, case)
    return CaseWithModel(folder, case, system)


def add_inputs(record: Record, folder: Path, case: GapCase) -> None:
    """What was read: case.toml, the tables that lie beside it, the trials, and the meshes."""
    record.add_input("case", folder / "case.toml", system=case.system)
    for side, trials in (("calibration", case.calibration), ("evaluation", case.evaluation)):
        for trial in trials:
            record.add_input(side, folder / "trials" / f"{trial.name}.csv", samples=len(trial))
    for file in sorted(folder.glob("*.csv")):
        record.add_input("table", file)
    for site, cells in case.cells.items():
        for name in cells.trials:
            record.add_input(f"cells {site}", cells_file(folder, name, site), cells=len(cells.ids))
    for name, one in case.meshes.items():
        record.add_input(f"mesh {name}", one.mesh.name, sha256=one.mesh.sha256, unit=one.mesh.unit)
