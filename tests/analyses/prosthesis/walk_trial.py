"""Files of a synthetic walk of both legs whose motion and forces are known: exact markers, plates of the simulation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from meshes.amputee import standing_trials
from meshes.amputee_trial import AmputeeTrial, amputee_trial
from meshes.gait_persons import PARTICIPANTS
from meshes.gait_trial_files import amputee_files, amputee_walk_files


def known_walk(folder: Path) -> tuple[AmputeeTrial, dict[str, Any]]:
    """Writes all trials and the plates of the first person; what was walked, and the options."""
    person, fulcrum = PARTICIPANTS[0], fulcrum_of("medium", "pinned")
    trials = standing_trials(person, vsf_foot(), fulcrum, errors=0.0)
    trial = amputee_trial(trials.truth, "medium", errors=0.0)
    for name, text in (amputee_files(person.name, trials) | amputee_walk_files(person.name, trial)).items():
        (folder / name).write_text(text, encoding="ascii")
    options = {
        "static": folder / "standing.trc",
        "functional": folder / "functional.trc",
        "mass": person.mass,
        "height": person.stature,
        "side": person.side,
        "plates": folder / "plates.mot",
        "plate": "own_force",
        "other_plate": "other_force",
        "cutoff": 0.0,
        "machine_code": True,
    }
    return trial, options
