"""The files of a synthetic study of a shoulder exoskeleton: `python -m benchmarks.shoulder_trials OUT`.

Three synthetic participants, two tasks, two support levels; motion with the device and without it; logger and mat by
the finer truth of `benchmarks.shoulder_truth`. OUT/study.toml is what `geocontact shoulder study` takes. A quarter of a
minute of processor time for each of the twelve trials.
"""

from __future__ import annotations

import argparse
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path
from zlib import crc32

import numpy as np
import pandas as pd

from benchmarks.shoulder_truth import NOTHING, Measured, Truth, Withheld, measure
from geocontact.analyses.shoulder.trial_files import trial_files
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.device import Wearer
from geocontact.shoulder_exoskeleton.from_markers.arm_motions import arm_motions
from geocontact.shoulder_exoskeleton.lucy import lucy
from geocontact.shoulder_exoskeleton.simulate import mirrored_arm
from geocontact.shoulder_exoskeleton.support.phases import SCREW
from geocontact.shoulder_exoskeleton.synthetic.design import (
    CONDITIONS,
    PARTICIPANTS,
    TASKS,
    Condition,
    OverheadTask,
    Participant,
)
from geocontact.shoulder_exoskeleton.synthetic.trial import OverheadTrial, synthetic_trial

WORN = tuple(each for each in CONDITIONS if each.level is not None)
(BARE,) = (each for each in CONDITIONS if each.level is None)
TRUE = Withheld(push=0.15, strap=4e-3, seal=0.3)
"""What happens in the study besides the model: push force, strap, seals. Sizes are invented."""


def wearer_of(person: Participant) -> Wearer:
    """Lengths that the device is adjusted to."""
    return Wearer(upper_arm=person.upper_arm, shoulder_width=person.shoulders)


def dominant_arm(trial: OverheadTrial) -> ArmMotion:
    """The arm that logger and mat are on, as a right one."""
    found = next(arm for arm in arm_motions(trial.markers).arms if arm.side == trial.participant.dominant)
    return mirrored_arm(found)


def measured(trial: OverheadTrial, withheld: Withheld = NOTHING) -> Measured:
    """Logger and mat of a trial with the device."""
    level = trial.condition.level
    if level is None:
        raise ValueError(f"{trial.name}: the device was not worn")
    pushing = np.where(trial.phase == SCREW, trial.task.push * trial.participant.push, 0.0)
    truth = Truth(lucy(), wearer_of(trial.participant), level, withheld)
    return measure(truth, dominant_arm(trial), crc32(trial.name.encode()), pushing)


def write_trial(folder: Path, made: tuple[Participant, OverheadTask, Condition]) -> str:
    """Markers, tool and, where the device is worn, what was recorded; the trial's part of study.toml."""
    person, task, condition = made
    trial = synthetic_trial(*made)
    place = folder / trial.name
    place.mkdir(parents=True, exist_ok=True)
    for name, text in trial_files(trial).items():
        (place / name).write_text(text, encoding="utf-8")
    if condition.level is None:
        return ""
    found = measured(trial, TRUE)
    columns = {"time [s]": found.time, "elevation [deg]": np.degrees(found.logger), "force [N]": found.mat}
    pd.DataFrame(columns).round(4).to_csv(place / "recorded.csv", index=False)
    bare = f"{person.name}{task.name}{BARE.name}"
    lines = {
        "name": trial.name,
        "person": person.name,
        "task": task.name,
        "level": f"{100 * condition.level:g}%",
        "side": person.dominant,
        "wearer": f"{person.name}.toml",
        "markers": f"{trial.name}/markers.trc",
        "tool": f"{trial.name}/tool.csv",
        "recorded": f"{trial.name}/recorded.csv",
        "without": f"{bare}/markers.trc",
        "without_tool": f"{bare}/tool.csv",
    }
    return "\n[[trial]]\n" + "".join(f'{key} = "{value}"\n' for key, value in lines.items())


def write_study(
    folder: Path,
    persons: tuple[Participant, ...] = PARTICIPANTS,
    tasks: tuple[OverheadTask, ...] = TASKS,
    workers: int = 2,
) -> Path:
    """Everything; the file that describes it."""
    folder.mkdir(parents=True, exist_ok=True)
    for person in persons:
        lengths = {"upper_arm": person.upper_arm, "shoulder_width": person.shoulders}
        text = "".join(f'{name} = {{ value = {1e3 * size:g}, unit = "mm" }}\n' for name, size in lengths.items())
        (folder / f"{person.name}.toml").write_text(f"# synthetic\n{text}", encoding="utf-8")
    made = list(product(persons, tasks, (BARE, *WORN)))
    with ProcessPoolExecutor(workers) as pool:
        parts = list(pool.map(partial(write_trial, folder), made))
    file = folder / "study.toml"
    file.write_text(
        '# synthetic: see benchmarks/shoulder_trials.py\ndevice = "lucy"\n' + "".join(parts), encoding="utf-8"
    )
    return file


def shortened(trial: OverheadTrial, frames: int) -> OverheadTrial:
    """The first frames of a trial."""
    markers = replace(trial.markers, time=trial.markers.time[:frames], position=trial.markers.position[:frames])
    return replace(trial, markers=markers, current=trial.current[:frames], phase=trial.phase[:frames])


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    print(write_study(parser.parse_args().out))


if __name__ == "__main__":
    main()
