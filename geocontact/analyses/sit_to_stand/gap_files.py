"""Files from which `geocontact gap gather` makes a case of the base model `sit_to_stand`."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.io.text.results import write_table
from geocontact.io.text.written_units import CASES
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import DAMPING
from geocontact.standing_up.strap_motion import StrapMotion, strap_motion
from geocontact.standing_up.trials import StandingTrial

TEXT = """# One strap at the thigh: displacements of both chains as recorded, beside what the mat sees.
# Trials of the calibration are no held-out ones: put trials that it did not use in their place.
format = 1
system = "sit_to_stand"
calibration = {calibration}
evaluation = {evaluation}

{sources}[constants]
b = {damping:g}

[parameters.k_n_thigh]
start = {stiffness:.6g}
lower = {least:.6g}
upper = {most:.6g}
unit = "N/m"

[parameters.rho_thigh]
start = 0.0
lower = -0.1
upper = 0.1
unit = "m"
"""
ROOM = 10.0
"""Factor on the stiffness within which a fit may move it."""


def write_strap_case(
    folder: Path,
    subject: Subject,
    trials: Sequence[StandingTrial],
    values: Mapping[str, float],
    held_out: int = 1,
) -> None:
    """NAME_strap.csv (displacements), NAME_mat.csv (normal force) and gather.toml, the last `held_out` to evaluate on.

    Nothing for fewer trials with the thigh's strap than that and one more.

    Parameters
    ----------
    values
        Of the strap's parameters, in SI.
    """
    trials = [trial for trial in trials if trial.strap is not None and np.isfinite(trial.strap).all()]
    if len(trials) <= held_out:
        return
    folder.mkdir(parents=True, exist_ok=True)
    for trial in trials:
        moved = strap_motion(subject, trial.q, values["strap place"])
        write_table(motion_table(trial, moved), folder, f"{trial.name}_strap", CASES)
        mat = pd.DataFrame({"time [s]": trial.time, "thigh_force [N]": trial.strap})
        write_table(mat, folder, f"{trial.name}_mat", CASES)
    names = [trial.name for trial in trials]
    sources = "".join(f'[from.{n}]\ninputs = "{n}_strap.csv"\noutputs = "{n}_mat.csv"\n\n' for n in names)
    stiffness = values["strap normal"]
    text = TEXT.format(
        calibration=json.dumps(names[:-held_out]),
        evaluation=json.dumps(names[-held_out:]),
        sources=sources,
        damping=DAMPING,
        stiffness=stiffness,
        least=stiffness / ROOM,
        most=stiffness * ROOM,
    )
    (folder / "gather.toml").write_text(text, encoding="utf-8")


def motion_table(trial: StandingTrial, moved: StrapMotion) -> pd.DataFrame:
    """Inputs of the base model."""
    columns = {
        "thigh_normal [m]": moved.normal,
        "thigh_tangential [m]": moved.tangential,
        "thigh_rotation [rad]": moved.rotation,
    }
    return pd.DataFrame({"time [s]": trial.time, **columns})
