"""The files of synthetic trials: markers while standing, walking and moving joints, force plates, the truth."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.io.mocap.trc import trc_text
from meshes.amputee import StandingTrials
from meshes.amputee_trial import AmputeeTrial, plates_of
from meshes.gait_trial import GaitTrial

DECIMALS = 2
"""Of a millimetre."""


def trial_files(trial: GaitTrial) -> dict[str, str]:
    """Text of `standing.trc`, `walking.trc` [mm], `plates.mot` [N, m] and `truth.csv` by name."""
    s = trial.truth
    truth = {
        "time [s]": s.time,
        **{f"force_{axis} [N]": s.force[:, k] for k, axis in enumerate("xyz")},
        "cop along foot [-]": s.along_foot("ground"),
        "ankle moment [N m]": s.ankle_moment,
        "stored [J]": s.stored,
    }
    said = f"# synthetic {trial.name}: what was true, as of a right leg\n"
    return {
        "standing.trc": trc_text(f"synthetic {trial.name}", trial.standing, DECIMALS),
        "walking.trc": trc_text(f"synthetic {trial.name}", trial.walking, DECIMALS),
        "plates.mot": _plates(trial),
        "truth.csv": said + _rows(truth, ",", 3),
    }


def amputee_files(name: str, trials: StandingTrials) -> dict[str, str]:
    """Text of `standing.trc` and `functional.trc` [mm] of a person with a right prosthesis, by name."""
    return {
        f"{stem}.trc": trc_text(f"synthetic {name}", seen, DECIMALS)
        for stem, seen in (("standing", trials.standing), ("functional", trials.functional))
    }


def amputee_walk_files(name: str, trial: AmputeeTrial) -> dict[str, str]:
    """Text of `walking.trc` [mm] and `plates.mot` [N, m] of both legs, by name."""
    columns = plates_of(trial)
    head = (f"synthetic {name}", "version=1", f"nRows={len(columns['time'])}", f"nColumns={len(columns)}")
    text = "\n".join((*head, "inDegrees=no", "endheader", _rows(columns, "\t", 4)))
    return {"walking.trc": trc_text(f"synthetic {name}", trial.walking, DECIMALS), "plates.mot": text}


def _plates(trial: GaitTrial) -> str:
    """Both feet; where nothing presses, and under the other foot always, the point is 0."""
    point = np.nan_to_num(trial.centre)
    columns = {"time": trial.time}
    for name, force, place in (("own", trial.own, point), ("other", trial.other, 0.0 * point)):
        columns |= {f"{name}_force_v{axis}": force[:, k] for k, axis in enumerate("xyz")}
        columns |= {f"{name}_force_p{axis}": place[:, k] for k, axis in enumerate("xyz")}
        columns |= {f"{name}_torque_{axis}": 0.0 * force[:, k] for k, axis in enumerate("xyz")}
    head = (f"synthetic {trial.name}", "version=1", f"nRows={len(trial.time)}", f"nColumns={len(columns)}")
    return "\n".join((*head, "inDegrees=no", "endheader", _rows(columns, "\t", 4)))


def _rows(columns: Mapping[str, Float[np.ndarray, " t"]], between: str, decimals: int) -> str:
    cells = [[f"{value:.{decimals}f}" for value in column] for column in columns.values()]
    rows = (between.join(row) for row in zip(*cells, strict=True))
    return "\n".join((between.join(columns), *rows)) + "\n"
