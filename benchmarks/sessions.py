"""The recordings of a whole study of the papers, synthetic, by one command: `python -m benchmarks.sessions STUDY OUT`.

- `shoulder`: three participants, two tasks, three conditions, with loggers and mats of a finer device: 18 trials.
- `prosthesis`: four participants, three settings, three walks of each, two of them lost as in the study: 34 trials.
- `sit-to-stand`: nine trials of one session, markers on soft tissue, plates, motors and two mats, of a finer model; and
  what the commands make of them for a study: coordinates, torques and the strap's force.

OUT gets the files and the description of the study. The last line is the command that takes it. Nothing here was
recorded on a person.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

from benchmarks.one_core import pin


def shoulder(out: Path) -> str:
    """18 trials; some seconds of processor time for each of twelve."""
    from benchmarks.shoulder.trials import write_study

    return f"geocontact shoulder study {write_study(out)}"


def prosthesis(out: Path) -> str:
    """34 trials; two minutes of processor time. The sole is that of the shipped foot until one is calibrated."""
    from benchmarks.prosthesis.compare import recorded
    from meshes.gait_persons import PARTICIPANTS

    text = "".join(recorded(out, person, machine_code=True) for person in PARTICIPANTS)
    study = out / "study.toml"
    study.write_text(f"# synthetic: see benchmarks/sessions.py\n{text}", encoding="ascii")
    return f"geocontact prosthesis compare {study}"


def sit_to_stand(out: Path) -> str:
    """Nine trials; some minutes of processor time, most of it for the finer model's motions."""
    from benchmarks.standing.nine import pipelines

    pipelines(out)
    return f"geocontact sit-to-stand calibrate {out / 'calibration.toml'}"


STUDIES: dict[str, Callable[[Path], str]] = {
    "shoulder": shoulder,
    "prosthesis": prosthesis,
    "sit-to-stand": sit_to_stand,
}


def main(words: Sequence[str] | None = None) -> int:
    """Exit code: 0 when all files are there."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.sessions", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("study", choices=STUDIES)
    parser.add_argument("out", type=Path, help="folder of the recordings; what is there of a prosthesis is kept")
    given = parser.parse_args(words)
    pin()
    import geocontact as gc

    warnings.simplefilter("ignore", gc.InputWarning)
    given.out.mkdir(parents=True, exist_ok=True)
    command = STUDIES[given.study](given.out)
    sys.stdout.write(f"{command} --out {given.out / 'result'}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
