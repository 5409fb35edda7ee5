"""What the choice of a support profile starts from: arms in their trials, and the device's support."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from geocontact.analyses.motion.markers import markers_given, renamed_as_told
from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.devices import device_named, wearer_of_lengths
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.tool import tool_current
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.identify.signals.filled import filled_and_smoothed
from geocontact.io.recordings.overhead_study import OverheadStudy, StudyTrial, read_overhead_study
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.cylinder import lever
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.from_markers.arm_motions import MarkerSettings
from geocontact.shoulder_exoskeleton.human_arm.arm_weight import arm_moment
from geocontact.shoulder_exoskeleton.human_arm.hand_load import ToolWork
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial, Support
from geocontact.shoulder_exoskeleton.support.phase_machine import Thresholds
from geocontact.shoulder_exoskeleton.support.recorded_arms import ToolUse, Worker, recorded_arms
from geocontact.shoulder_exoskeleton.synthetic.arm_trials import all_arms

SYNTHETIC = "no `study`: the persons are synthetic, all their numbers invented"


@dataclass(frozen=True, eq=False)
class WorkersAndDevice:
    """Arms in their trials, and what the device can do.

    Parameters
    ----------
    unseen
        Moment of the arm's weight of persons without a trial, by name [N m].
    """

    trials: tuple[ArmTrial, ...]
    device: Device
    support: Support
    unseen: Mapping[str, float] = field(default_factory=dict)


def read(o: ShoulderOptimiseOptions, record: Record) -> WorkersAndDevice:
    """Everything the options name."""
    device = device_named(record, o.device)
    if o.study is None:
        record.warn(SYNTHETIC)
        arms = all_arms(dominant_share=o.dominant_share, cutoff=o.cutoff)
        return WorkersAndDevice(tuple(arms), device, support_of(device))
    study = read_overhead_study(o.study)
    record.add_input("`study`", o.study, persons=len(study.persons), trials=len(study.trials))
    bare = [trial for trial in study.trials if trial.level is None]
    if not bare:
        record.warn("every trial was recorded in the device: the shoulder's torque is that of arms that it supported")
    lengths = {name: wearer_of_lengths(record, o.study, each.lengths) for name, each in study.persons.items()}
    arms = [arm for trial in bare or study.trials for arm in _arms(o, record, study, trial, lengths[trial.person])]
    unseen = {
        name: arm_moment(each.mass, each.sex, lengths[name].upper_arm)
        for name, each in study.persons.items()
        if name not in {trial.person for trial in bare or study.trials}
    }
    return WorkersAndDevice(tuple(arms), device, support_of(device), unseen)


def support_of(device: Device) -> Support:
    """Torque of the device's cylinder at full level over the elevation of its arm."""
    a, b, phase = (np.array(device[name]) for name in ("lever_a", "lever_b", "lever_phase"))

    def torque(elevation: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        return np.asarray(device.peak_force * lever(elevation, a, b, phase))

    return Support(torque, device["lag"])


def _arms(
    o: ShoulderOptimiseOptions, record: Record, study: OverheadStudy, trial: StudyTrial, lengths: Wearer
) -> list[ArmTrial]:
    person, task = study.persons[trial.person], study.tasks[trial.task]
    recorded = renamed_as_told(record, markers_given(trial.markers, o.axes, None, o.c3d_unit), o.markers_map)
    seen = _filled(recorded, o.gap_limit)
    record.add_input(f"{trial.person} {trial.task}", trial.markers, frames=len(seen))
    current = tool_current(record, trial.tool, seen.time)
    share = o.dominant_share if task.dominant_share is None else task.dominant_share
    use = ToolUse(ToolWork(task.tool, task.push, dominant_share=share), current > Thresholds().on, current)
    dominant: Side = "right" if person.dominant == "right" else "left"
    worker = Worker(trial.person, person.mass, person.sex, dominant, lengths)
    settings = MarkerSettings(upright=trial.upright, gap_limit=o.gap_limit)
    arms, notes = recorded_arms(f"{trial.person}{trial.task}", worker, trial.task, seen, settings, use, o.cutoff)
    for note in notes:
        record.warn(f"{trial.markers.name}: {note}")
    return arms


def _filled(seen: MarkerTrajectories, longest: float) -> MarkerTrajectories:
    """Markers at even times without gaps; those that begin late or end early are left out."""
    known = np.isfinite(seen.positions).all(axis=2)
    kept = [k for k in range(len(seen.names)) if known[0, k] and known[-1, k]]
    if not kept:
        raise InputError(seen.source, "", "no marker is seen from the first to the last frame", "cut the trial")
    names = tuple(seen.names[k] for k in kept)
    columns = seen.positions[:, kept].reshape(len(seen), -1)
    try:
        time, values = filled_and_smoothed(seen.time, columns, cutoff=None, longest_gap=longest)
    except ValueError as error:
        raise InputError(seen.source, "", str(error), "fill the gap, or give a larger `gap_limit`") from error
    return MarkerTrajectories(time, values.reshape(len(time), len(kept), 3), names, seen.source)
