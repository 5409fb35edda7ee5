"""What a study starts from: its description, its device, and every trial's motion and recordings."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.level import level
from geocontact.analyses.shoulder.recorded_channels import Channels, recorded_channels
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.simulate.read import Worn
from geocontact.analyses.shoulder.simulate.read import read as read_worn
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.data.errors import InputError
from geocontact.io.recordings.shoulder_study import StudyTrial, read_study_file


@dataclass(frozen=True, eq=False)
class StudyTrialInputs:
    """A trial with what its files hold: the arm of `trial.side` alone."""

    trial: StudyTrial
    level: float
    within: Worn
    without: Worn | None
    recorded: Channels | None


def read(o: StudyOptions, record: Record) -> tuple[StudyTrialInputs, ...]:
    """Everything the study names; a file that two trials share is read twice."""
    described = read_study_file(o.study)
    record.add_input("study", o.study, trials=len(described.trials))
    return tuple(_trial(described.device, each, o, record) for each in described.trials)


def _trial(device: str, trial: StudyTrial, o: StudyOptions, record: Record) -> StudyTrialInputs:
    share = level(trial.level, f"[[trial]] {trial.name} level")
    if not 0.0 <= share <= 1.0:
        raise InputError(o.study, f"[[trial]] {trial.name}", f"level is {trial.level}", "give 0 to 100%")
    within = _worn(device, trial, trial.markers, trial.tool, share, o, record)
    without = None
    if trial.without is not None:
        without = _worn(device, trial, trial.without, trial.without_tool, share, o, record)
    recorded = None
    if trial.recorded is not None:
        recorded = recorded_channels(trial.recorded)
        record.add_input(f"{trial.name} recorded", trial.recorded, samples=len(recorded.time))
    return StudyTrialInputs(trial, share, within, without, recorded)


def _worn(
    device: str, trial: StudyTrial, markers: Path, tool: Path | None, share: float, o: StudyOptions, record: Record
) -> Worn:
    asked = ShoulderSimulateOptions(
        markers,
        device=device,
        person=trial.wearer,
        level=share,
        side="right" if trial.side == "right" else "left",
        cutoff=o.cutoff,
        gap_limit=o.gap_limit,
        tool=tool,
    )
    own = Record("shoulder simulate", {})
    found = read_worn(asked, own)
    for entry in own.inputs:
        record.inputs.append(entry | {"role": f"{trial.name} {entry['role']}"})
    for line in own.warnings:
        if not any(line in known for known in record.warnings):
            record.warn(f"{trial.name}: {line}")
    return found
