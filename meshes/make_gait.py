"""Write the synthetic gait and standing trials that the documentation runs on: `python meshes/make_gait.py`.

It takes four minutes, for the truth is a stance on a finer foot.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # so that the script runs from anywhere

from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from meshes.amputee import standing_trials, true_amputee
from meshes.amputee_trial import amputee_trial
from meshes.gait_persons import PARTICIPANTS
from meshes.gait_trial import synthetic_trial
from meshes.gait_trial_files import amputee_files, amputee_walk_files, trial_files

PERSON = 0
RECORDED = ("walking.trc", "plates.mot")
SETTINGS = {"medium": (*RECORDED, "standing.trc", "truth.csv"), "low": RECORDED, "high": RECORDED}
"""Files of the trial of each setting: one trial has all of them."""


def gait_files() -> dict[str, bytes]:
    """One trial of one participant at each setting, by name."""
    found = {}
    for setting, kept in SETTINGS.items():
        trial = synthetic_trial(PARTICIPANTS[PERSON], setting, machine_code=False)
        files = trial_files(trial)
        found |= {f"gait_{trial.name}/{name}": files[name].encode("ascii") for name in kept}
    return found


def standing_files() -> dict[str, bytes]:
    """A participant who stands and moves both legs' joints, by name."""
    person = PARTICIPANTS[PERSON]
    trials = standing_trials(person, vsf_foot(), fulcrum_of("medium", "pinned"))
    texts = amputee_files(person.name, trials)
    return {f"amputee_{person.name}/{name}": text.encode("ascii") for name, text in texts.items()}


FOLDERS = {"medium": "amputee_{}", "low": "amputee_{}_low", "high": "amputee_{}_high"}
"""Where the walk of both legs at each setting is, by the person's name: that at medium beside the standing trial."""


def walking_files() -> dict[str, bytes]:
    """The same participant who walks, with both legs, at each setting, by name."""
    person, found = PARTICIPANTS[PERSON], {}
    for setting, folder in FOLDERS.items():
        truth = true_amputee(person, vsf_foot(), fulcrum_of(setting, "pinned"))
        texts = amputee_walk_files(person.name, amputee_trial(truth, setting, machine_code=False))
        found |= {f"{folder.format(person.name)}/{name}": text.encode("ascii") for name, text in texts.items()}
    return found


def main() -> None:
    """Write the files beside this script."""
    for name, data in (gait_files() | standing_files() | walking_files()).items():
        path = Path(__file__).parent / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


if __name__ == "__main__":
    main()
