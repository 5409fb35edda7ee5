"""Transfer over the study's 34 trials: `python -m benchmarks.prosthesis.compare FOLDER [P1 ...] [--plain]`.

Synthetic trials of the four participants (`meshes.gait_trial`) are written to FOLDER as files, the sole
of each is calibrated on medium_1 with `prosthesis calibrate`, and all are judged by `prosthesis compare`, as a user
would. Like the study, the second participant lacks a medium and the fourth a high trial. Beside the study's table 3.
"""

from __future__ import annotations

import argparse
import time
import warnings
from pathlib import Path

import geocontact as gc
from benchmarks.machine import write_results
from meshes.gait_persons import PARTICIPANTS, Walker
from meshes.gait_trial import synthetic_trial
from meshes.gait_trial_files import trial_files

SETTINGS, TRIALS = ("medium", "low", "high"), 3
MISSING = {"P2_medium_3", "P4_high_3"}
STUDY = {
    ("low", "resultant"): (0.93, 0.12),
    ("medium", "resultant"): (0.93, 0.11),
    ("high", "resultant"): (0.93, 0.12),
    ("low", "impulse"): (0.98, 0.03),
    ("medium", "impulse"): (0.99, 0.02),
    ("high", "impulse"): (0.99, 0.02),
    ("low", "cop_ground"): (0.79, 0.13),
    ("medium", "cop_ground"): (0.73, 0.15),
    ("high", "cop_ground"): (0.73, 0.14),
}
"""R² and root mean square error of the study's table 3."""


def trials_of(person: Walker) -> list[tuple[str, str]]:
    """Name and setting of each trial."""
    names = [(f"{person.name}_{setting}_{k}", setting) for setting in SETTINGS for k in range(1, TRIALS + 1)]
    return [each for each in names if each[0] not in MISSING]


def recorded(folder: Path, person: Walker, machine_code: bool) -> str:
    """Files of all trials of a person that are not there yet; text of the description, without a law of the sole."""
    for name, setting in trials_of(person):
        place = folder / name
        if not place.is_dir():
            trial = synthetic_trial(person, setting, int(name[-1]), machine_code=machine_code)
            place.mkdir(parents=True)
            for file, text in trial_files(trial).items():
                (place / file).write_text(text, encoding="ascii")
    medium = f"{person.name}_medium_1"
    lines = [f"[persons.{person.name}]", f'mass = {{ value = {person.mass}, unit = "kg" }}']
    lines += [f'static = "{medium}/standing.trc"', f'side = "{person.side}"', f'sex = "{person.sex}"']
    for name, setting in trials_of(person):
        lines += ["", "[[trials]]", f'name = "{name}"', f'person = "{person.name}"', f'setting = "{setting}"']
        lines += [f'markers = "{name}/walking.trc"', f'plates = "{name}/plates.mot"']
        lines += ['plate = "own_force"', 'other_plate = "other_force"']
    return "\n".join(lines) + "\n\n"


def written(folder: Path, person: Walker, machine_code: bool) -> str:
    """The same with the sole calibrated on the first medium trial."""
    text = recorded(folder, person, machine_code)
    medium, law = folder / f"{person.name}_medium_1", folder / f"{person.name}_calibrated"
    if not law.is_dir():
        before = time.process_time()
        gc.prosthesis.calibrate(
            medium / "walking.trc",
            static=medium / "standing.trc",
            mass=person.mass,
            side=person.side,
            plates=medium / "plates.mot",
            plate="own_force",
        ).write(law)
        print(f"{person.name}: calibrated in {time.process_time() - before:.0f} s of processor")
    sex = f'sex = "{person.sex}"\n'
    name = f'name = "{medium.name}"\n'
    return text.replace(sex, f'{sex}law = "{law.name}/law.toml"\n').replace(name, f"{name}calibrated = true\n")


def main() -> None:
    """Print what `compare` says, its means by setting and the study's; benchmarks/results/prosthesis_compare.json."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("persons", nargs="*")
    parser.add_argument("--plain", action="store_true", help="without machine code")
    told = parser.parse_args()
    warnings.simplefilter("ignore", gc.InputWarning)
    persons = [each for each in PARTICIPANTS if not told.persons or each.name in told.persons]
    text = "".join(written(told.folder, each, not told.plain) for each in persons)
    study = told.folder / "study.toml"
    study.write_text(text, encoding="ascii")
    before = time.perf_counter()
    found = gc.prosthesis.compare(study, machine_code=not told.plain)
    print(f"{time.perf_counter() - before:.0f} s")
    print("\n".join((*found.sentences, *found.warnings)))
    rows = found.table("summary").to_dict("records")
    figures = {"sentences": found.sentences, "warnings": found.warnings, "summary": rows}
    write_results("prosthesis_compare", {"persons": [each.name for each in persons]}, figures, {"casadi"})
    for row in rows:
        beside = STUDY.get((row["setting"], row["quantity"]))
        study_words = "" if beside is None else f"   study {beside[0]:.2f} {beside[1]:.2f}"
        plain = f"{row['mean of the others rmse']:.4f} {row['another rmse']:.4f}"
        own = f"{row['r2 [-]']:7.3f} ± {row['r2 sd']:.3f}  {row['rmse']:.4f} ± {row['rmse sd']:.4f} {row['unit']:7s}"
        words = f"{row['setting']:10s} {row['quantity']:14s}"
        print(f"{words}{own} plain {plain}  better {row['better']}/{row['trials']}{study_words}")


if __name__ == "__main__":
    main()
