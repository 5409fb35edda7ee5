"""What was recorded of several trials brought together into a gap case."""

from __future__ import annotations

from dataclasses import replace

from geocontact.analyses.gap.gather.cells import alike_mats, cell_channels
from geocontact.analyses.gap.gather.channels import with_mat, with_outputs, with_plate, with_sides
from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.gap.gather.read import GatheredTrial, Recordings
from geocontact.analyses.gap.gather.result import GatherResult
from geocontact.analyses.results_folder import Scratch
from geocontact.analyses.run_record import Record
from geocontact.data.gap.case import GapCase
from geocontact.io.cases.case_consistency import parameters_of
from geocontact.io.cases.gap_case import case_of, read_gap_case
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.io.cases.trial_set import alike
from geocontact.io.cases.trial_table import TrialTable


def run(recordings: Recordings, o: GatherOptions, record: Record) -> GatherResult:
    """The case, which can be read again as it will be written."""
    case = _case(recordings, o, record)
    scratch = Scratch()
    write_gap_case(case, scratch.folder)
    read_gap_case(scratch.folder)
    sites = "".join(f", {site} ({len(own.ids)} cells)" for site, own in case.cells.items())
    record.say(f"{len(recordings.trials)} trials{sites}")
    return GatherResult(record=record, options=o, case=case, scratch=scratch)


def _case(recordings: Recordings, o: GatherOptions, record: Record) -> GapCase:
    mats = {site: alike_mats(record, site, own) for site, own in recordings.mats.items()}
    trials = {}
    for name, one in recordings.trials.items():
        table = one.inputs
        for own in ((site, each[name]) for site, each in mats.items()):
            table = with_mat(table, *own)
        trials[name] = _with_loads(table, one)
    settings = recordings.plan.settings
    parameters = parameters_of(settings, o.settings)
    case = case_of(settings, parameters, o.settings, o.settings.stem, alike(trials), recordings.tables)
    return replace(case, cells={site: cell_channels(record, site, own) for site, own in mats.items()})


def _with_loads(table: TrialTable, one: GatheredTrial) -> TrialTable:
    """The trial with generalised forces, the reaction of a plate, and loads of the sides of a knee."""
    if one.outputs is not None:
        table = with_outputs(table, one.outputs)
    if one.plate is not None and one.source.plate is not None:
        table = with_plate(table, one.plate, one.source.plate)
    if one.forces is not None and one.source.sides is not None:
        table = with_sides(table, one.areas, one.forces, one.source.sides.threshold)
    return table
