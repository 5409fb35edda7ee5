"""A study of overhead work against itself, before an arm is moved: persons, pushes, trials that belong together."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.frame.marks import LengthUnit
from geocontact.analyses.motion.checked_trial import check_apart, check_trial
from geocontact.analyses.motion.markers import unit_of_c3d
from geocontact.data.errors import InputError
from geocontact.io.mocap.markers import read_markers
from geocontact.io.recordings.overhead_study import OverheadStudy, StudyTrial
from geocontact.trial_checks.plate_checks import GRAVITY
from geocontact.trial_checks.recorded import TrialInputs

HEAVY = 0.4
"""Share of a person's weight above which a push overhead is doubted; drilling overhead takes 35 to 200 N."""
HALF = 0.5
"""Share of a push below which the other hand exerts more of it."""


def check_study(study: OverheadStudy, file: Path, c3d_unit: LengthUnit | None) -> None:
    """Warn of what a study says twice in different ways; InputError for a trial that stands for its own opposite."""
    for name, person in study.persons.items():
        mass_option = f"mass of [persons.{name}] in {file}"
        size = TrialInputs(mass=person.mass, height=person.height, upper_arm=person.upper_arm, age=person.age)
        check_trial(replace(size, mass_option=mass_option))
    for name, task in study.tasks.items():
        if task.push > 0.0 and task.push_direction[1] < 0.0 and task.push_direction[1] == min(task.push_direction):
            what = f"{list(task.push_direction)} is downwards in the markers' axes, of work overhead"
            reserve(f"{file} [tasks.{name}] push_direction: {what}; it is the force on the work, and y is up")
        doubt_share(task.dominant_share, f"{file} [tasks.{name}] dominant_share")
    by_name = {each.name: each for each in study.trials}
    for trial in study.trials:
        _doubt_push(study, trial, file)
        if trial.without is not None:
            _check_without(trial, by_name[trial.without], file)
    for bare in (True, False):
        check_copies([each for each in study.trials if (each.level is None) == bare], c3d_unit)


def doubt_share(share: float | None, place: str) -> None:
    """A warning where the dominant hand exerts less of a push than the other one."""
    if share is not None and share < HALF:
        reserve(
            f"{place}: {share:.0%} of the push by the dominant hand is less than by the other one; is the rest meant?"
        )


def _doubt_push(study: OverheadStudy, trial: StudyTrial, file: Path) -> None:
    """A warning for a push that is much of the weight of who pushes."""
    push, weight = study.tasks[trial.task].push, study.persons[trial.person].mass * GRAVITY
    if push > HEAVY * weight:
        what = f"{push:g} N are {push / weight:.0%} of the weight of {trial.person}"
        reserve(f"{file} [tasks.{trial.task}] push: {what}, much for work overhead; is it in N?")


def _check_without(trial: StudyTrial, bare: StudyTrial, file: Path) -> None:
    place = f"[[trials]] {trial.name} without"
    if bare.level is not None:
        what = f"{bare.name!r} was recorded in the device, at a level of {bare.level}"
        raise InputError(file, place, what, "name the trial of the same work without the device")
    for kind, own, other in (("person", trial.person, bare.person), ("task", trial.task, bare.task)):
        if own != other:
            reserve(f"{file} {place}: {bare.name} is of {kind} {other}, {trial.name} of {own}; is another one meant?")


def check_copies(trials: list[StudyTrial], c3d_unit: LengthUnit | None) -> None:
    """A warning for two trials, by name, whose markers are one and the same recording."""
    if len(trials) > 1:
        seen = {each.name: read_markers(each.markers, unit_of_c3d(c3d_unit, each.markers)).positions for each in trials}
        check_apart(seen, "it counts twice")
