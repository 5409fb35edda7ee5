"""The files of a synthetic trial: markers, current of the tool, and the truth."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from geocontact.io.mocap.trc import trc_text
from geocontact.shoulder_exoskeleton.synthetic import OverheadTrial
from geocontact.shoulder_exoskeleton.work_phases import PHASES

DECIMALS = 2
"""Of a millimetre: finer than cameras see, and small."""


def trial_files(trial: OverheadTrial) -> dict[str, str]:
    """Text of `markers.trc` [mm], `tool.csv` and `truth.csv` by name."""
    time = [f"{t:.2f}" for t in trial.markers.time]
    current = [f"{value:.2f}" for value in trial.current]
    angles = {
        f"{angle}_{side} [deg]": [f"{value:.3f}" for value in np.degrees(getattr(course, angle))]
        for side, course in trial.courses.items()
        for angle in ("elevation", "plane", "flexion")
    }
    phase = [str(k) for k in trial.phase]
    kinds = ", ".join(f"{k} {name}" for k, name in enumerate(PHASES))
    return {
        "markers.trc": trc_text(f"synthetic {trial.name}", trial.markers, DECIMALS),
        "tool.csv": _table({"time [s]": time, "current [A]": current}, f"synthetic {trial.name}: current of the tool"),
        "truth.csv": _table(
            {"time [s]": time, "phase [-]": phase, **angles},
            f"synthetic {trial.name}: phase ({kinds}), true angles of the arms",
        ),
    }


def _table(columns: dict[str, list[str]], comment: str) -> str:
    rows: Iterable[tuple[str, ...]] = zip(*columns.values(), strict=True)
    return "\n".join([f"# {comment}", ",".join(columns), *(",".join(row) for row in rows)]) + "\n"
