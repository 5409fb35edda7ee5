"""The files of a synthetic study of a shoulder exoskeleton: `python -m benchmarks.shoulder.trials OUT`.

Three synthetic participants, two tasks, two support levels; motion with the device and without it; loggers of both
arms and the mat on the dominant one by the finer truth of `benchmarks.shoulder.truth`; what the mat's cells read goes
through `geocontact mat`, whose resultant is the recorded force. OUT/study.toml is what `geocontact shoulder study`
takes. Some seconds of processor time for each of the twelve trials.
"""

from __future__ import annotations

import argparse
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from itertools import product
from pathlib import Path
from zlib import crc32

import numpy as np
import pandas as pd

from benchmarks.shoulder.mat import lifting_force, readings, with_noise, write_mat
from benchmarks.shoulder.truth import NOTHING, Measured, Truth, Withheld, measure
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.arms_from_markers import arm_motions
from geocontact.shoulder_exoskeleton.cuff_contact import mirrored_arm
from geocontact.shoulder_exoskeleton.device import Wearer, lucy
from geocontact.shoulder_exoskeleton.support.phase_machine import SCREW
from geocontact.shoulder_exoskeleton.synthetic import (
    CONDITIONS,
    PARTICIPANTS,
    TASKS,
    Condition,
    OverheadTask,
    OverheadTrial,
    Participant,
    synthetic_trial,
)
from meshes.overhead_files import trial_files

WORN = tuple(each for each in CONDITIONS if each.level is not None)
(BARE,) = (each for each in CONDITIONS if each.level is None)
TRUE = Withheld(push=0.15, strap=4e-3, seal=0.3)
"""What happens in the study besides the model: push force, strap, seals. Sizes are invented."""


def wearer_of(person: Participant) -> Wearer:
    """Lengths that the device is adjusted to."""
    return Wearer(upper_arm=person.upper_arm, shoulder_width=person.shoulders)


def arm_as_right(trial: OverheadTrial, side: Side) -> ArmMotion:
    """One arm of a trial, as a right one."""
    found = next(arm for arm in arm_motions(trial.markers).arms if arm.side == side)
    return mirrored_arm(found)


def dominant_arm(trial: OverheadTrial) -> ArmMotion:
    """The arm that holds the tool and has the mat on it, as a right one."""
    return arm_as_right(trial, trial.participant.dominant)


def measured(trial: OverheadTrial, withheld: Withheld = NOTHING, side: Side | None = None) -> Measured:
    """Logger and mat of one arm, the dominant one unless told, in a trial with the device; that one alone pushes."""
    level, dominant = trial.condition.level, trial.participant.dominant
    if level is None:
        raise ValueError(f"{trial.name}: the device was not worn")
    own = side or dominant
    push = trial.task.push * trial.participant.push if own == dominant else 0.0
    pushing = np.where(trial.phase == SCREW, push, 0.0)
    truth = Truth(lucy(), wearer_of(trial.participant), level, withheld)
    seed = trial.name if own == dominant else f"{trial.name} other"
    return measure(truth, arm_as_right(trial, own), crc32(seed.encode()), pushing)


def write_trial(folder: Path, made: tuple[Participant, OverheadTask, Condition]) -> str:
    """Markers, tool and, where the device is worn, what was recorded; the trial's part of study.toml."""
    person, task, condition = made
    trial = synthetic_trial(*made)
    place = folder / trial.name
    place.mkdir(parents=True, exist_ok=True)
    for name, text in trial_files(trial).items():
        (place / name).write_text(text, encoding="utf-8")
    lines = {
        "name": trial.name,
        "person": person.name,
        "task": task.name,
        "markers": f"{trial.name}/markers.trc",
        "tool": f"{trial.name}/tool.csv",
    }
    if condition.level is None:
        return part(lines)
    found = measured(trial, TRUE)
    pressure = with_noise(readings(lucy(), found.cells), crc32(f"mat {trial.name}".encode()))
    write_mat(place, found.time, pressure)
    at, force = lifting_force(place)
    shown = np.interp(found.time, at, force)
    columns = {"time [s]": found.time, "elevation [deg]": np.degrees(found.logger), "force [N]": shown}
    pd.DataFrame(columns).round(4).to_csv(place / "recorded.csv", index=False)
    other = measured(trial, TRUE, "left" if person.dominant == "right" else "right")
    columns = {"time [s]": other.time, "elevation [deg]": np.degrees(other.logger)}
    pd.DataFrame(columns).round(4).to_csv(place / "recorded_other.csv", index=False)
    lines |= {
        "level": f"{100 * condition.level:g}%",
        "recorded": f"{trial.name}/recorded.csv",
        "recorded_other": f"{trial.name}/recorded_other.csv",
        "without": f"{person.name}{task.name}{BARE.name}",
    }
    return part(lines)


def part(lines: dict[str, str]) -> str:
    """A trial in study.toml."""
    return "\n[[trials]]\n" + "".join(f'{key} = "{value}"\n' for key, value in lines.items())


def heads(persons: tuple[Participant, ...], tasks: tuple[OverheadTask, ...]) -> str:
    """Tasks and persons in study.toml."""
    text = "# synthetic: see benchmarks/shoulder/trials.py\n"
    for task in tasks:
        text += f'\n[tasks.{task.name}]\ntool = {{ value = {task.tool}, unit = "kg" }}\n'
        text += f'push = {{ value = {task.push}, unit = "N" }}\n'
    for person in persons:
        text += f'\n[persons.{person.name}]\nmass = {{ value = {person.mass}, unit = "kg" }}\n'
        text += f'sex = "{person.sex}"\ndominant = "{person.dominant}"\n'
        lengths = {"upper_arm": person.upper_arm, "shoulder_width": person.shoulders}
        text += "".join(f'{name} = {{ value = {1e3 * size:g}, unit = "mm" }}\n' for name, size in lengths.items())
    return text


def write_study(
    folder: Path,
    persons: tuple[Participant, ...] = PARTICIPANTS,
    tasks: tuple[OverheadTask, ...] = TASKS,
    workers: int = 2,
) -> Path:
    """Everything; the file that describes it."""
    folder.mkdir(parents=True, exist_ok=True)
    made = list(product(persons, tasks, (BARE, *WORN)))
    with ProcessPoolExecutor(workers) as pool:
        parts = list(pool.map(partial(write_trial, folder), made))
    file = folder / "study.toml"
    file.write_text(heads(persons, tasks) + "".join(parts), encoding="utf-8")
    return file


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    print(write_study(parser.parse_args().out))


if __name__ == "__main__":
    main()
