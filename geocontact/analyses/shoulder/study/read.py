"""What a study starts from: every trial's motion in the device and without it, and what was recorded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from geocontact.analyses.motion.markers import unit_of_c3d
from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.devices import wearer_of_lengths
from geocontact.analyses.shoulder.level import level
from geocontact.analyses.shoulder.recorded_channels import Channels, recorded_channels
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.simulate.read import Worn, worn_along
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.data.errors import InputError
from geocontact.io.recordings.overhead_study import OverheadStudy, StudyTrial, read_overhead_study
from geocontact.shoulder_exoskeleton.arm_motion import Side


@dataclass(frozen=True, eq=False)
class StudyTrialInputs:
    """A trial in the device with what its files hold: the arms that were recorded, and logger and mat by their side."""

    trial: StudyTrial
    level: float
    within: Worn
    without: Worn | None
    recorded: Mapping[Side, Channels]


def read(o: StudyOptions, record: Record) -> tuple[StudyTrialInputs, ...]:
    """Every trial with a level; InputError where there is none."""
    study = read_overhead_study(o.study)
    record.add_input("study", o.study, trials=len(study.trials))
    found = tuple(
        _trial(study, each, share, o, record) for each in study.trials if (share := _level(each, o)) is not None
    )
    if not found:
        raise InputError(o.study, "[[trials]]", "none was recorded in the device", 'write level = "100%" into those')
    return found


def _level(trial: StudyTrial, o: StudyOptions) -> float | None:
    if trial.level is None:
        return None
    share = level(trial.level, f"{o.study.name} [[trials]] {trial.name} level")
    if not 0.0 <= share <= 1.0:
        raise InputError(o.study, f"[[trials]] {trial.name}", f"level is {trial.level}", "give 0 to 100%")
    return share


def _trial(study: OverheadStudy, trial: StudyTrial, share: float, o: StudyOptions, record: Record) -> StudyTrialInputs:
    within = _worn(study, trial, share, o, record)
    bare = next((each for each in study.trials if each.name == trial.without), None)
    without = None if bare is None else _worn(study, bare, share, o, record)
    recorded: dict[Side, Channels] = {}
    for side, file in zip(_sides(study, trial), (trial.recorded, trial.recorded_other), strict=True):
        if file is None:
            continue
        if side not in [arm.side for arm in within.arms]:
            raise InputError(file, "", f"the {side} arm has no markers in {trial.markers.name}", "leave it out")
        recorded[side] = recorded_channels(file)
        record.add_input(f"{trial.name} recorded, {side}", file, samples=len(recorded[side].time))
    return StudyTrialInputs(trial, share, within, without, recorded)


def _sides(study: OverheadStudy, trial: StudyTrial) -> tuple[Side, Side]:
    """Sides of the dominant arm and of the other."""
    return ("right", "left") if study.persons[trial.person].dominant == "right" else ("left", "right")


def _worn(study: OverheadStudy, trial: StudyTrial, share: float, o: StudyOptions, record: Record) -> Worn:
    person = study.persons[trial.person]
    asked = ShoulderSimulateOptions(
        trial.markers,
        device=o.device,
        level=share,
        cutoff=o.cutoff,
        gap_limit=o.gap_limit,
        upright=trial.upright,
        tool=trial.tool,
        markers_map=o.markers_map,
        axes=o.axes,
        c3d_unit=unit_of_c3d(o.c3d_unit, trial.markers),
    )
    own = Record("shoulder simulate", {})
    found = worn_along(asked, wearer_of_lengths(own, o.study, person.lengths), own)
    for entry in own.inputs:
        record.inputs.append(entry | {"role": f"{trial.name} {entry['role']}"})
    for line in own.warnings:
        if not any(line in known for known in record.warnings):
            record.warn(f"{trial.name}: {line}")
    return found
