"""Tables that OpenSim reads: .mot and .sto, version 1, and Moco's trajectories."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.text import seconds

DIGITS = 10


def write_storage(
    path: Path,
    time: Float[np.ndarray, " t"],
    names: Sequence[str],
    values: Float[np.ndarray, "t c"],
    *,
    title: str,
    degrees: bool,
) -> None:
    """Columns over time [s]; `degrees` is what the head says of angles, nothing is converted."""
    head = (
        title,
        "version=1",
        f"nRows={len(time)}",
        f"nColumns={len(names) + 1}",
        f"inDegrees={'yes' if degrees else 'no'}",
        "endheader",
        "\t".join(("time", *names)),
    )
    times = (seconds(each, DIGITS) for each in time.tolist())
    cells = ("\t".join(f"{x:.{DIGITS}g}" for x in row) for row in values.tolist())
    rows = (f"{each}\t{row}" for each, row in zip(times, cells, strict=True))
    path.write_text("\n".join((*head, *rows)) + "\n", encoding="utf-8")


TRAJECTORY_DIGITS = 15
"""Digits of a number: with 10 a foot on a stiff ground is accelerated by 1e-5 rad/s^2 otherwise than the solution
says."""
Table = Mapping[str, Float[np.ndarray, " t"]]


def write_moco_trajectory(
    path: Path, time: Float[np.ndarray, " t"], states: Table, controls: Table, derivatives: Table, success: bool
) -> None:
    """Columns in the order that `MocoTrajectory` counts them in; angles in rad.

    Parameters
    ----------
    states
        By path, /jointset/JOINT/COORDINATE/value and …/speed.
    controls
        By path of the actuator, /forceset/NAME.
    derivatives
        Accelerations, /jointset/JOINT/COORDINATE/accel.
    success
        Whether the solver met its tolerance: OpenSim wants a trajectory without it to be unsealed first.
    """
    columns = {**states, **controls, **derivatives}
    head = (
        "inDegrees=no",
        f"num_controls={len(controls)}",
        f"num_derivatives={len(derivatives)}",
        "num_input_controls=0",
        "num_iterations=0",
        "num_multipliers=0",
        "num_parameters=0",
        "num_slacks=0",
        f"num_states={len(states)}",
        f"success={'true' if success else 'false'}",
        "DataType=double",
        "version=3",
        "endheader",
        "\t".join(("time", *columns)),
    )
    cells = (
        "\t".join(f"{x:.{TRAJECTORY_DIGITS}g}" for x in row) for row in np.column_stack(list(columns.values())).tolist()
    )
    rows = (f"{seconds(each, TRAJECTORY_DIGITS)}\t{row}" for each, row in zip(time.tolist(), cells, strict=True))
    path.write_text("\n".join((*head, *rows)) + "\n", encoding="utf-8")
