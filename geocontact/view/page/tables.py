"""Tables of a page that say what its numbers rest on: surfaces and files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.data.evolution import MM
from geocontact.geometry.surface import Surface
from geocontact.view.page.content import Table


def meshes_table(moving: Surface, fixed: Surface) -> Table:
    """What the areas rest on."""
    header = ("body", "vertices", "faces", "edge, median [mm]", "edge, longest [mm]", "size [mm]", "closed")
    rows = []
    for role, body in (("moving", moving), ("fixed", fixed)):
        used = body.vertices[body.used]
        size = np.ptp(used, axis=0) * MM
        edges = body.edge_length * MM
        closed = "yes" if body.topology.closed else ("assumed" if body.closed else "no: distances to it are unsigned")
        rows.append((
            f"{role}: {body.name}", f"{len(used)}", f"{len(body.faces)}", f"{np.median(edges):.2f}",
            f"{edges.max():.2f}", " × ".join(f"{length:.1f}" for length in size), closed,
        ))  # fmt: skip
    return Table("The two surfaces", header, rows)


def inputs_table(inputs: Sequence[Mapping[str, object]]) -> Table:
    """Files that went in, as `run.json` lists them."""
    rows = [(str(i["role"]), Path(str(i["file"])).name, str(i.get("unit", "")), str(i["sha256"])) for i in inputs]
    return Table("Input files", ("role", "file", "unit", "SHA-256"), rows)


def frame_table(title: str, rows: pd.DataFrame, digits: int = 4) -> Table:
    """A data frame as the page shows it; what is not known is empty."""

    def text(value: object) -> str:
        if not isinstance(value, float):
            return str(value)
        return "" if np.isnan(value) else f"{value:.{digits}g}"

    return Table(title, tuple(map(str, rows.columns)), rows.map(text).to_numpy().tolist())
