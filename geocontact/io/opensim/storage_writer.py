"""Tables that OpenSim reads: .mot and .sto, version 1, with the head that older and newer programs want."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float


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
    rows = ("\t".join(f"{x:.10g}" for x in row) for row in np.column_stack([time, values]).tolist())
    path.write_text("\n".join((*head, *rows)) + "\n", encoding="utf-8")
