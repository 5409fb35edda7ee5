"""States, controls and accelerations as OpenSim's `MocoTrajectory` reads them (.sto)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.seconds import seconds

DIGITS = 15
"""Of a number: with 10 a foot on a stiff ground is accelerated by 1e-5 rad/s^2 otherwise than the solution says."""
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
    cells = ("\t".join(f"{x:.{DIGITS}g}" for x in row) for row in np.column_stack(list(columns.values())).tolist())
    rows = (f"{seconds(each, DIGITS)}\t{row}" for each, row in zip(time.tolist(), cells, strict=True))
    path.write_text("\n".join((*head, *rows)) + "\n", encoding="utf-8")
