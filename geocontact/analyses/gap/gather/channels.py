"""Channels recorded elsewhere, put beside the inputs of a trial: mats, force plates, sides of a knee."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import reserve
from geocontact.data.errors import InputError
from geocontact.data.gap_cells import CellChannels, CellTrial
from geocontact.io.cases.trial_table import TrialTable
from geocontact.io.mocap.force_plates import LOADED, ForcePlate
from geocontact.io.recordings.area_table import AreaTable, ForceCurves
from geocontact.io.recordings.mat_results import CELLS, MatFolder
from geocontact.io.text.csv_text import Column
from geocontact.loads.centre_of_pressure import centre_in_foot

ELSEWHERE = 0.01  # m, that a cell may lie away from where it lies on average without a word
SHARED = 0.5  # of a trial's samples that what is put beside them must have been recorded at
UPRIGHT = 0.999  # smallest cosine between a plate's normal and y
POSE = {"x": "m", "y": "m", "pitch": "rad"}
SIDES = ("medial", "lateral")


def alike_mats(site: str, mats: Mapping[str, MatFolder]) -> dict[str, MatFolder]:
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
            reserve(f"{what} and left out, with {lost:.1%} of its force")
    return found


def cell_channels(site: str, mats: Mapping[str, MatFolder]) -> CellChannels:
    """Cells that every trial has, where they lie on average."""
    places = np.array([own.place for own in mats.values()])
    area = np.mean([own.area for own in mats.values()], axis=0)
    off = np.linalg.norm(places - places.mean(axis=0), axis=2).max(axis=1)
    if off.max() > ELSEWHERE:
        worst = list(mats)[int(np.argmax(off))]
        reserve(f"the mat of {site} lies up to {off.max() * 1e3:.0f} mm elsewhere in {worst}; places are averages")
    ids = tuple(f"r{row}c{column}" for row, column in next(iter(mats.values())).cells)
    trials = {name: CellTrial(own.time, own.pressure) for name, own in mats.items()}
    return CellChannels(f"{site}_force", ids, places.mean(axis=0), area, trials)


@dataclass(frozen=True)
class RecordedChannels:
    """Channels of one recording by name, with their unit and their values at a trial's times."""

    what: str
    time: Float[np.ndarray, " r"]
    channels: Mapping[str, tuple[str, Float[np.ndarray, " t"]]]


def with_mat(table: TrialTable, site: str, mat: MatFolder) -> TrialTable:
    """The trial with the mat's force."""
    force = np.interp(table.signals.time, mat.time, mat.force, np.nan, np.nan)
    return _widened(table, RecordedChannels(f"the mat in {mat.folder.name}", mat.time, {f"{site}_force": ("N", force)}))


def with_outputs(table: TrialTable, outputs: TrialTable) -> TrialTable:
    """The trial with channels of another file."""
    time, signals = outputs.signals.time, outputs.signals
    at = table.signals.time
    channels = {
        name: (unit, np.interp(at, time, signals.column(name), np.nan, np.nan))
        for name, unit in zip(signals.channels, signals.units, strict=True)
    }
    widened = _widened(table, RecordedChannels(Path(outputs.file).name, time, channels))
    return replace(widened, columns=(*table.columns, *outputs.columns))


def with_plate(table: TrialTable, plate: ForcePlate, file: Path, belt: float) -> TrialTable:
    """The trial with a plate's reaction as a foot on spheres predicts it.

    `file` is that of the plate; x counts along the belt, whose ground runs backwards at `belt` [m/s].
    """
    _require_pose(table, file, plate)
    time = table.signals.time
    x, y, pitch = (table.signals.column(name) for name in POSE)
    reaction = plate.at(time)
    centre = reaction.centre_of_pressure(plate.point, plate.normal, LOADED)
    channels = {
        "force_x": ("N", reaction.force[:, 0]),
        "force_y": ("N", reaction.force[:, 1]),
        "cop_x": ("m", centre_in_foot(centre[:, 0], x, y, pitch)),
    }
    values = table.signals.values.copy()
    values[:, table.signals.channels.index("x")] += belt * time
    run = replace(table, signals=replace(table.signals, values=values))
    return _widened(run, RecordedChannels(f"{plate.name} in {file.name}", plate.time, channels))


def with_sides(table: TrialTable, areas: AreaTable | None, forces: ForceCurves, threshold: float | None) -> TrialTable:
    """The trial with the forces of a knee's sides, and where they are given with areas within the threshold [m]."""
    if areas is not None:
        at = _threshold(areas, threshold)
        found = {side: areas.areas[side][:, at] for side in SIDES if side in areas.areas}
        table = _with_both(table, areas.file, "area", "m^2", areas.time, found)
    return _with_both(table, forces.file, "force", "N", forces.time, forces.forces)


def _with_both(
    table: TrialTable,
    file: str,
    name: str,
    unit: str,
    time: Float[np.ndarray, " r"],
    curves: Mapping[str, Float[np.ndarray, " r"]],
) -> TrialTable:
    """The trial with `name`_medial and `name`_lateral, linear between samples."""
    for side in SIDES:
        if side not in curves:
            raise InputError(file, "", f"has no {name} of the {side} side", "a knee's case needs both sides apart")
    at = table.signals.time
    channels = {f"{name}_{side}": (unit, np.interp(at, time, curves[side], np.nan, np.nan)) for side in SIDES}
    return _widened(table, RecordedChannels(Path(file).name, time, channels))


def _threshold(areas: AreaTable, wanted: float | None) -> int:
    """Place of the threshold [m] among those of the table."""
    there = ", ".join(f"{each:g}" for each in areas.thresholds)
    if wanted is None:
        if len(areas.thresholds) > 1:
            raise InputError(areas.file, "", f"holds thresholds of {there} m", "name one: threshold = 0.004")
        return 0
    near = np.flatnonzero(np.isclose(areas.thresholds, wanted, rtol=1e-6, atol=0.0))
    if not len(near):
        raise InputError(areas.file, "threshold", f"no area at {wanted:g} m", f"thresholds are {there} m")
    return int(near[0])


def _require_pose(table: TrialTable, file: Path, plate: ForcePlate) -> None:
    """Refuse a trial that does not say where the foot is, and plates that do not lie level with y up."""
    for name, unit in POSE.items():
        if name not in table.signals.channels or table.column(name).si != unit:
            what = f"no column '{name}' in {unit}"
            raise InputError(table.file, "line 1", what, "a plate's reaction needs x, y and pitch of the foot")
    if plate.normal[1] < UPRIGHT:
        normal = ", ".join(f"{value:.2f}" for value in plate.normal)
        raise InputError(file, plate.name, f"its normal is ({normal})", "give a file with y up, x forward")


def _widened(table: TrialTable, found: RecordedChannels) -> TrialTable:
    """The trial with these channels besides, nothing where they were not recorded."""
    signals = table.signals
    for name in found.channels:
        if name in signals.channels:
            what = f"has a column '{name}' already"
            raise InputError(table.file, "line 1", what, f"strike it, or leave {found.what} out")
    inside = (signals.time >= found.time[0]) & (signals.time <= found.time[-1])
    if inside.mean() < SHARED:
        what = f"runs from {signals.time[0]:g} to {signals.time[-1]:g} s, {found.what}"
        times = f"{found.time[0]:g} to {found.time[-1]:g} s"
        raise InputError(table.file, "", f"{what} from {times}", "put both on one clock")
    units = tuple(unit for unit, _ in found.channels.values())
    widened = replace(
        signals,
        values=np.column_stack([signals.values, *(values for _, values in found.channels.values())]),
        channels=(*signals.channels, *found.channels),
        units=(*signals.units, *units),
    )
    columns = (Column(name, unit, unit, 1.0) for name, (unit, _) in found.channels.items())
    return replace(table, signals=widened, columns=(*table.columns, *columns))
