"""Mats of all trials brought together: the cells that every trial has, in one order, where they lie on average."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.gap.cell_channels import CellChannels, CellTrial
from geocontact.io.recordings.mat_results import CELLS, MatFolder

ELSEWHERE = 0.01  # m, that a cell may lie away from where it lies on average without a word


def alike_mats(record: Record, site: str, mats: Mapping[str, MatFolder]) -> dict[str, MatFolder]:
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


def cell_channels(record: Record, site: str, mats: Mapping[str, MatFolder]) -> CellChannels:
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
