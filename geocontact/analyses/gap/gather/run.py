"""What was recorded of several trials brought together into a gap case: reads, matches cells, writes, says so."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from geocontact.analyses.gap.gather.channels import with_mat, with_plate, with_sides
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.data.cell_channels import CellChannels, CellTrial
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.io.cases.case_consistency import parameters_of
from geocontact.io.cases.gap_case import case_of, read_gap_case
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.io.cases.gathering import Gathering, read_gathering
from geocontact.io.cases.trial_set import alike
from geocontact.io.cases.trial_table import read_trial
from geocontact.io.recordings.mat_results import CELLS, FRAMES, MatResult, read_mat_result
from geocontact.io.text.side_table import read_side_table

ELSEWHERE = 0.01  # m, that a cell may lie away from where it lies on average without a word


def gathered(path: Path, out: Path) -> int:
    """Run the whole gathering."""
    record = Record("gap gather", {"settings": path, "out": out})
    with record.catching_warnings(), written_whole(out) as draft:
        plan = read_gathering(path)
        record.add_input("settings", path)
        case = _case(record, path, plan, out)
        write_gap_case(case, draft)
        read_gap_case(draft)
        record.write(draft)
    sites = "".join(f", {site} ({len(own.ids)} cells)" for site, own in case.cells.items())
    record.say(f"{len(plan.settings.trials)} trials{sites} in {out}; next: geocontact gap diagnose {out} --out …")
    record.speak()
    return 0


def _case(record: Record, path: Path, plan: Gathering, out: Path) -> GapCase:
    if plan.settings.mesh:
        raise InputError(path, "mesh", "a case with meshes is not gathered", "add them to the case by hand")
    mats = {site: _alike(record, site, _mats(record, path, plan, site)) for site in plan.sites}
    trials = {}
    for name, source in plan.sources.items():
        table = read_trial(source.inputs)
        record.add_input(name, source.inputs, samples=len(table.signals.time))
        for site, own in mats.items():
            table = with_mat(table, site, own[name])
        if source.plate is not None:
            table = with_plate(record, name, table, source.plate)
        if source.sides is not None:
            table = with_sides(record, name, table, source.sides)
        trials[name] = table
    tables = {key: read_side_table(path.parent / file) for key, file in plan.settings.tables.items()}
    parameters = parameters_of(plan.settings, path)
    case = case_of(plan.settings, parameters, path, out.name, alike(trials), tables)
    return replace(case, cells={site: _cells(record, site, own) for site, own in mats.items()})


def _mats(record: Record, path: Path, plan: Gathering, site: str) -> dict[str, MatResult]:
    """Of one site, by trial."""
    found = {}
    for name, source in plan.sources.items():
        if site not in source.mats:
            raise InputError(path, f"[from.{name}]", f"has no mat of {site}", "every trial needs every site")
        found[name] = own = read_mat_result(source.mats[site])
        record.add_input(f"{name} {site}", own.folder / FRAMES, cells=len(own.cells))
    return found


def _alike(record: Record, site: str, mats: Mapping[str, MatResult]) -> dict[str, MatResult]:
    """The mats with the cells that every trial has, in one order: force and cells are of the same ones everywhere."""
    first, *others = mats.values()
    common = tuple(cell for cell in first.cells if all(cell in other.cells for other in others))
    if not common:
        raise InputError(first.folder / CELLS, "", f"no cell of {site} is in every trial", "are these the same mat?")
    found = {}
    for name, own in mats.items():
        order = [own.cells.index(cell) for cell in common]
        found[name] = kept = replace(
            own, cells=common, place=own.place[order], area=own.area[order], pressure=own.pressure[:, order]
        )
        if len(own.cells) > len(common):
            lost = 1.0 - float(kept.force.sum()) / max(float(own.force.sum()), 1e-300)
            what = f"{len(own.cells) - len(common)} cells of {site} in {name} are not in every trial"
            record.warn(f"{what} and left out, with {lost:.1%} of its force")
    return found


def _cells(record: Record, site: str, mats: Mapping[str, MatResult]) -> CellChannels:
    """Cells that every trial has, where they lie on average."""
    places = np.array([own.place for own in mats.values()])
    area = np.mean([own.area for own in mats.values()], axis=0)
    off = np.linalg.norm(places - places.mean(axis=0), axis=2).max(axis=1)
    if off.max() > ELSEWHERE:
        worst = list(mats)[int(np.argmax(off))]
        record.warn(f"the mat of {site} lies up to {off.max() * 1e3:.0f} mm elsewhere in {worst}; places are averages")
    ids = tuple(f"r{row}c{column}" for row, column in next(iter(mats.values())).cells)
    trials = {name: CellTrial(own.time, own.pressure) for name, own in mats.items()}
    return CellChannels(f"{site}_force", ids, places.mean(axis=0), area, trials)
