"""What was recorded of several trials, as gather.toml names it, brought together into one case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.gap.gather.checks import check_gathered
from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.gap.gather.recorded_trial import check_recorded
from geocontact.analyses.motion.checked_trial import check_apart, turned_plates
from geocontact.analyses.motion.markers import turn_of
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.gap_cells import CellChannels, CellTrial
from geocontact.data.multibody.force_plate import LOADED, ForcePlate
from geocontact.io.cases.case_settings import parameters_of
from geocontact.io.cases.gap_case import case_of
from geocontact.io.cases.gathering import Gathering, Source, is_storage, read_gathering, read_storage_trial
from geocontact.io.cases.trial_table import TrialTable, alike, read_trial
from geocontact.io.mocap.force_plates import plate_named, read_force_plates
from geocontact.io.recordings.area_table import AreaTable, ForceCurves, read_area_table, read_force_curves
from geocontact.io.recordings.mat_results import CELLS, FRAMES, MatFolder, read_mat_result
from geocontact.io.text.csv_text import Column
from geocontact.io.text.side_table import read_side_table
from geocontact.loads.centre_of_pressure import centre_in_foot

ELSEWHERE = 0.01  # m, that a cell may lie away from where it lies on average without a word
SHARED = 0.5  # of a trial's samples that what is put beside them must have been recorded at
HALF_LOADED, FEW, SLIDES = 0.5, 5, 0.4  # of the largest load; samples; m/s between a rolling foot and its ground
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
    _doubt_belt(time, x, reaction.force[:, 1], belt, plate, file)
    values = table.signals.values.copy()  # noqa: PD011
    values[:, table.signals.channels.index("x")] += belt * time
    run = replace(table, signals=replace(table.signals, values=values))
    return _widened(run, RecordedChannels(f"{plate.name} in {file.name}", plate.time, channels))


def _doubt_belt(
    time: Float[np.ndarray, " t"],
    x: Float[np.ndarray, " t"],
    force: Float[np.ndarray, " t"],
    belt: float,
    plate: ForcePlate,
    file: Path,
) -> None:
    """A warning where the foot under load does not move with the ground, `belt` [m/s] backwards."""
    rate = np.gradient(x, time)
    load = np.where(np.isfinite(force) & np.isfinite(rate), force, 0.0)
    under = load > max(HALF_LOADED * float(load.max(initial=0.0)), LOADED)
    if under.sum() < FEW:
        return
    speed = float(np.median(rate[under]))
    if abs(speed + belt) > SLIDES:
        what = f"the foot under load moves along x at {speed:.2f} m/s, its ground at {-belt:.2f} m/s"
        reserve(f"{file} {plate.name}: {what}; is `belt` right, in m/s, and x forwards?")


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
            raise InputError(table.file, "line 1", what, f"delete it, or leave {found.what} out")
    inside = (signals.time >= found.time[0]) & (signals.time <= found.time[-1])
    if inside.mean() < SHARED:
        what = f"runs from {signals.time[0]:g} to {signals.time[-1]:g} s, {found.what}"
        times = f"{found.time[0]:g} to {found.time[-1]:g} s"
        raise InputError(
            table.file,
            "",
            f"{what} from {times}",
            "is it of another trial? name its own file, or put both on one clock",
        )
    units = tuple(unit for unit, _ in found.channels.values())
    widened = replace(
        signals,
        values=np.column_stack([signals.values, *(values for _, values in found.channels.values())]),  # noqa: PD011
        channels=(*signals.channels, *found.channels),
        units=(*signals.units, *units),
    )
    columns = (Column(name, unit, unit, 1.0) for name, (unit, _) in found.channels.items())
    return replace(table, signals=widened, columns=(*table.columns, *columns))


@dataclass(frozen=True)
class GatheredTrial:
    """One trial: its inputs, and what was measured beside them."""

    source: Source
    inputs: TrialTable
    outputs: TrialTable | None
    plate: ForcePlate | None
    areas: AreaTable | None
    forces: ForceCurves | None


@dataclass(frozen=True)
class Recordings:
    """All trials by id, mats by site and trial, and the tables that settings name."""

    plan: Gathering
    trials: Mapping[str, GatheredTrial]
    mats: Mapping[str, Mapping[str, MatFolder]]
    tables: Mapping[str, pd.DataFrame]


def read(o: GatherOptions) -> Recordings:
    """Everything that gather.toml names."""
    path = o.settings
    plan = read_gathering(path)
    add_input("settings", path)
    if plan.settings.mesh:
        raise InputError(path, "mesh", "a case with meshes is not gathered", "add them to the case by hand")
    mats = {site: _mats(path, plan, site) for site in plan.sites}
    trials = {name: _recording(plan, name, source, o) for name, source in plan.sources.items()}
    tables = {key: read_side_table(path.parent / file) for key, file in plan.settings.tables.items()}
    if o.axes is not None and all(one.plate is None for one in trials.values()):
        raise InputError("", "`axes`", "has no effect without plates", "leave it out")
    for one in trials.values():
        check_recorded(one.inputs, one.outputs, one.plate, one.source.plates, tables.get("spheres"), turn_of(o.axes))
    by_file = {str(one.source.plates): one.plate.wrench.force for one in trials.values() if one.plate is not None}
    check_apart({file: force for file, force in by_file.items() if force.any()}, "trials that are one count twice")
    return Recordings(plan, trials, mats, tables)


def gathered(recordings: Recordings, o: GatherOptions) -> GapCase:
    """Trials with all that was measured beside them, as one case."""
    mats = {site: alike_mats(site, own) for site, own in recordings.mats.items()}
    trials = {}
    for name, one in recordings.trials.items():
        table = one.inputs
        for own in ((site, each[name]) for site, each in mats.items()):
            table = with_mat(table, *own)
        trials[name] = _with_loads(table, one)
    settings = recordings.plan.settings
    parameters = parameters_of(settings, o.settings)
    case = case_of(settings, parameters, o.settings, o.settings.stem, alike(trials), recordings.tables)
    measured = {
        name: tuple(
            each for each in table.signals.channels if each not in recordings.trials[name].inputs.signals.channels
        )
        for name, table in trials.items()
    }
    check_gathered(case, measured, o.settings)
    return replace(case, cells={site: cell_channels(site, own) for site, own in mats.items()})


def _with_loads(table: TrialTable, one: GatheredTrial) -> TrialTable:
    """The trial with generalised forces, the reaction of a plate, and loads of the sides of a knee."""
    if one.outputs is not None:
        table = with_outputs(table, one.outputs)
    if one.plate is not None and one.source.plates is not None:
        table = with_plate(table, one.plate, one.source.plates, one.source.belt)
    if one.forces is not None:
        table = with_sides(table, one.areas, one.forces, one.source.threshold)
    return table


def _mats(path: Path, plan: Gathering, site: str) -> dict[str, MatFolder]:
    """Mats of one site, by trial."""
    found = {}
    for name, source in plan.sources.items():
        if site not in source.mats:
            raise InputError(path, f"[from.{name}]", f"has no mat of {site}", "every trial needs every site")
        found[name] = own = read_mat_result(source.mats[site])
        add_input(f"{name} {site}", own.folder / FRAMES, cells=len(own.cells))
    return found


def _recording(plan: Gathering, name: str, source: Source, o: GatherOptions) -> GatheredTrial:
    inputs, outputs = _inputs_and_outputs(plan, name, source)
    plate = areas = forces = None
    if source.plates is not None:
        plates = turned_plates(read_force_plates(source.plates, o.c3d_unit), turn_of(o.axes), source.plates)
        plate = plate_named(plates, source.plate, source.plates, "plate =")
        add_input(f"{name} plates", source.plates, plate=plate.name)
    if source.areas is not None:
        areas = read_area_table([source.areas])
        add_input(f"{name} areas", source.areas)
    if source.forces is not None:
        forces = read_force_curves(source.forces, source.force_unit, {})
        add_input(f"{name} forces", source.forces, unit=forces.unit)
    return GatheredTrial(source, inputs, outputs, plate, areas, forces)


def _inputs_and_outputs(plan: Gathering, name: str, source: Source) -> tuple[TrialTable, TrialTable | None]:
    """Both files of a trial; together they have every column that the settings name."""
    storage = is_storage(source.inputs)
    inputs = read_storage_trial(source.inputs, plan.columns) if storage else read_trial(source.inputs)
    add_input(name, source.inputs, samples=len(inputs.signals.time))
    outputs = None
    if source.outputs is not None:
        own = is_storage(source.outputs)
        outputs = read_storage_trial(source.outputs, plan.columns) if own else read_trial(source.outputs)
        add_input(f"{name} outputs", source.outputs, samples=len(outputs.signals.time))
    found = {*inputs.signals.channels, *(() if outputs is None else outputs.signals.channels)}
    missing = [one.label for one in plan.columns if one.channel.name not in found]
    if missing and (storage or outputs is not None):
        files = " and ".join(str(each) for each in (source.inputs, source.outputs) if each is not None)
        raise InputError(files, "", f"no column {missing[0]!r}, which [columns] names", "correct [columns]")
    return inputs, outputs
