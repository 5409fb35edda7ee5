"""The tray from above: where its cells are, and between which of them the force acts."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.view.page.content import Mark, Plan, Track

PLACES = {"PM": (-1.0, -1.0), "AM": (-1.0, 1.0), "AL": (1.0, 1.0), "PL": (1.0, -1.0)}
"""Posterior and anterior, medial and lateral cell, in half their distances."""
LEAST = 0.05  # of the largest total; a side with less has no centre worth a point
SLIGHT = 0.01  # of the largest total; less tension of a cell than that is an offset
WORDS = (
    "The four cells, seen from above. Each point lies between them as their forces share the load; distances are in "
    "half the spacing of the cells, because the size of the tray is not an input."
)
WIDE, DEEP, CORNER = 1.6, 1.45, 3.0  # outline in the same unit: a rounded plate, a sketch


def tray_plan(cells: dict[str, Float[np.ndarray, " t"]]) -> Plan | None:
    """Cells and the centre of pressure of each side and of the whole; None for a tray with other cells.

    The centre is that of the cells' forces at the cells. Where a side bears little or pulls there is none (NaN).
    """
    if set(cells) != set(PLACES):
        return None
    total = sum(cells.values(), np.zeros(()))
    least = LEAST * float(np.nanmax(total))
    tracks = [
        Track("medial", _centre({c: f for c, f in cells.items() if c.endswith("M")}, least)),
        Track("lateral", _centre({c: f for c, f in cells.items() if c.endswith("L")}, least)),
        Track("whole tray", _centre(cells, least)),
    ]
    turn = np.linspace(0.0, 2.0 * np.pi, 97)
    x, y = (np.sign(part) * np.abs(part) ** (2.0 / CORNER) for part in (np.cos(turn), np.sin(turn)))
    return Plan(
        "Where the force acts on the tray",
        "half spacing",
        "medial ← → lateral",
        "posterior ← → anterior",
        [np.column_stack([WIDE * x, DEEP * y]), np.array([[0.0, -DEEP], [0.0, DEEP]])],
        tracks,
        [Mark(name, place) for name, place in PLACES.items()],
        words=WORDS,
    )


def _centre(forces: dict[str, Float[np.ndarray, " t"]], least: float) -> Float[np.ndarray, "t 2"]:
    names = list(forces)
    each = np.stack([forces[name] for name in names], axis=1)
    total = each.sum(axis=1)
    bears = (total > least) & (each > -SLIGHT / LEAST * least).all(axis=1)
    moments = each @ np.array([PLACES[name] for name in names])
    found = np.full((len(total), 2), np.nan)
    found[bears] = moments[bears] / total[bears, None]
    return found
