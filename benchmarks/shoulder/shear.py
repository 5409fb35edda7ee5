"""Synthetic recordings of shear in a cuff, and what a comparison finds: `python -m benchmarks.shoulder.shear OUT`.

A two-axis mat all around the arm reads normal force and shear along and around the cuff, by the finer truth of
`benchmarks.shoulder.truth`: 176 cells that rub one by one, code of its own. OUT/NAME/recorded.csv and person.toml are
what `geocontact shoulder compare` and `simulate` take. `alone` has nothing besides the model's friction; `strap` is
pulled tight by 4 mm, as in the study. Noise and steps are invented. Nothing here was measured; some CPU seconds each.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from zlib import crc32

import numpy as np
import pandas as pd

import geocontact as gc
from benchmarks.shoulder.trials import measured
from benchmarks.shoulder.truth import NOTHING, Measured, Withheld
from geocontact.shoulder_exoskeleton.synthetic import condition, participant, synthetic_trial, task

NOISE, STEP = 0.15, 0.1
"""Standard deviation of the noise and step of each channel [N]; invented."""
KINDS = {"alone": NOTHING, "strap": Withheld(strap=4e-3)}
TRIAL = ("P1", "T1", "S100")
"""Whose trial is `meshes/overhead_P1T1S100`."""
MARKERS = Path(__file__).resolve().parents[2] / "meshes" / f"overhead_{''.join(TRIAL)}" / "markers.trc"


def shear_table(found: Measured, seed: int) -> pd.DataFrame:
    """What the mat records: time, elevation by the logger, normal force, shear along and around, with noise."""
    if found.normal is None or found.shear is None:
        raise ValueError("this truth has no shear")
    rng = np.random.default_rng(seed)

    def read(values: np.ndarray) -> np.ndarray:
        return np.asarray(np.round((values + rng.normal(0.0, NOISE, values.shape)) / STEP) * STEP)

    return pd.DataFrame(
        {
            "time [s]": found.time,
            "elevation [deg]": np.degrees(found.logger),
            "normal [N]": np.maximum(read(found.normal), 0.0),
            "shear_along [N]": read(found.shear[:, 0]),
            "shear_around [N]": read(found.shear[:, 1]),
        }
    )


def write_recording(folder: Path, kind: str) -> Path:
    """recorded.csv and person.toml of one kind; the first."""
    person, work, worn = TRIAL
    trial = synthetic_trial(participant(person), task(work), condition(worn))
    folder.mkdir(parents=True, exist_ok=True)
    own = trial.participant
    lengths = {"upper_arm": own.upper_arm, "shoulder_width": own.shoulders}
    text = "".join(f'{name} = {{ value = {1e3 * size:g}, unit = "mm" }}\n' for name, size in lengths.items())
    (folder / "person.toml").write_text(text, encoding="utf-8")
    file = folder / "recorded.csv"
    table = shear_table(measured(trial, KINDS[kind]), crc32(f"shear {kind}".encode()))
    lines = f"# synthetic: benchmarks.shoulder.shear, {kind}\n" + table.round(4).to_csv(index=False)
    file.write_text(lines, encoding="utf-8")
    return file


def main() -> None:
    """Make both recordings, simulate the shipped trial, compare, print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.shoulder.shear", description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    out = parser.parse_args().out
    for kind in KINDS:
        file = write_recording(out / kind, kind)
        person = file.with_name("person.toml")
        made = gc.shoulder.simulate(MARKERS, level=1.0, side="right", person=person, upright=(0.0, 0.5))
        simulated = made.write(out / kind / "simulated") / "right.csv"
        found = gc.shoulder.compare(simulated, file)
        found.write(out / kind / "compared")
        print(f"{kind}\n{found}\n{found.tables()['friction'].T}")


if __name__ == "__main__":
    main()
