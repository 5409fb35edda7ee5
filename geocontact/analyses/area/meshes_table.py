"""The two surfaces of an analysis, as its page describes them."""

from __future__ import annotations

import numpy as np

from geocontact.data.evolution import MM
from geocontact.geometry.surface import Surface
from geocontact.view.page.content import Table

HEADER = ("body", "vertices", "faces", "edge, median [mm]", "edge, longest [mm]", "size [mm]", "closed")


def meshes_table(moving: Surface, fixed: Surface) -> Table:
    """What the areas rest on."""
    return Table("The two surfaces", HEADER, [_row("moving", moving), _row("fixed", fixed)])


def _row(role: str, body: Surface) -> tuple[str, ...]:
    used = body.vertices[body.used]
    size = np.ptp(used, axis=0) * MM
    edges = body.edge_length * MM
    return (
        f"{role}: {body.name}",
        f"{len(used)}",
        f"{len(body.faces)}",
        f"{np.median(edges):.2f}",
        f"{edges.max():.2f}",
        " × ".join(f"{length:.1f}" for length in size),
        "yes" if body.topology.closed else ("assumed" if body.closed else "no: distances to it are unsigned"),
    )
