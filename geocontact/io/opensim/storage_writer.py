"""Tables that OpenSim reads: .mot and .sto, version 1, with the head that older and newer programs want."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.seconds import seconds

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
