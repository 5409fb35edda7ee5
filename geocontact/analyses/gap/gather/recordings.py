"""What was recorded of several trials, as gather.toml names it, brought together into one case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import pandas as pd

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.gap.gather.channels import (
    alike_mats,
    cell_channels,
    with_mat,
    with_outputs,
    with_plate,
    with_sides,
)
from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.io.cases.case_settings import parameters_of
from geocontact.io.cases.gap_case import case_of
from geocontact.io.cases.gathering import Gathering, Source, is_storage, read_gathering, read_storage_trial
from geocontact.io.cases.trial_table import TrialTable, alike, read_trial
from geocontact.io.mocap.force_plates import ForcePlate, plate_named, read_force_plates
from geocontact.io.recordings.area_table import AreaTable, ForceCurves, read_area_table, read_force_curves
from geocontact.io.recordings.mat_results import FRAMES, MatFolder, read_mat_result
from geocontact.io.text.side_table import read_side_table


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
    trials = {name: _recording(plan, name, source, o.c3d_unit) for name, source in plan.sources.items()}
    tables = {key: read_side_table(path.parent / file) for key, file in plan.settings.tables.items()}
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


def _recording(plan: Gathering, name: str, source: Source, c3d_unit: str | None) -> GatheredTrial:
    inputs, outputs = _inputs_and_outputs(plan, name, source)
    plate = areas = forces = None
    if source.plates is not None:
        plate = plate_named(read_force_plates(source.plates, c3d_unit), source.plate, source.plates, "plate =")
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
