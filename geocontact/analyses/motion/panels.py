"""Coordinates of a model as they are shown: texts, a figure over time, panels of a page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from geocontact.data.multibody.joint import Coordinate
from geocontact.data.multibody.model import Multibody
from geocontact.data.sides import RIGHT, stem_and_side
from geocontact.view.curves.quantity import TIME
from geocontact.view.curves.sheet import plain
from geocontact.view.curves.style import DOUBLE, LINES, PALETTE, in_style, legend, panels
from geocontact.view.page.content import Curve, Curves, Scale, Section

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def printed(coordinates: tuple[Coordinate, ...], values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t n"]:
    """Values as OpenSim's files in degrees have them: rotations in degrees, all else as it is."""
    return np.asarray(values * np.array([np.degrees(1.0) if c.kind == "rotational" else 1.0 for c in coordinates]))


MOST = 8  # curves that a legend still names


@in_style
def curves_figure(time: Float[np.ndarray, " t"], tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Each table's columns over time [s] under its axis label; a legend where there are few columns."""
    shown = {label: table for label, table in tables.items() if len(table.columns)}
    figure, column = panels(max(len(shown), 1), 1, DOUBLE, 0.12)
    for axes, (label, table) in zip(column, shown.items(), strict=False):
        drawn = [
            (axes.plot(time, table[name], color=PALETTE[k % len(PALETTE)], ls=LINES[k % len(LINES)])[0], plain(name))
            for k, name in enumerate(map(str, table.columns))
        ]
        axes.set_ylabel(label)
        if len(drawn) <= MOST:
            legend(axes, drawn)
    column[-1].set_xlabel(TIME.label)
    return figure


def panels_of(
    model: Multibody,
    unit: str,
    values: Float[np.ndarray, "t n"],
    which: Bool[np.ndarray, " n"],
    beside: Scale | None = None,
) -> list[Section]:
    """Some coordinates of a model: a panel for each that both legs have, and one for the rest of each joint.

    `beside` is a second unit of the same values.
    """
    panels: dict[str, list[int]] = {}
    for place in (int(k) for k in np.flatnonzero(which)):
        panels.setdefault(_title(model, which, place), []).append(place)
    names = [c.name for c in model.coordinates]
    return [
        Curves(title, unit, [Curve(names[k], values[:, k]) for k in sorted(places, key=lambda k: _order(names[k]))],
               beside=beside)
        for title, places in panels.items()
    ]  # fmt: skip


def _order(name: str) -> bool:
    """Right before left, so that each side has one colour throughout."""
    return stem_and_side(name)[1] not in ("", RIGHT)


def _title(model: Multibody, which: Bool[np.ndarray, " n"], place: int) -> str:
    """What two sides have in common, else the joint."""
    names = [c.name for c in model.coordinates]
    stem, side = stem_and_side(names[place])
    twins = [k for k in np.flatnonzero(which) if k != place and stem_and_side(names[k])[0] == stem]
    if side and any(stem_and_side(names[k])[1] not in ("", side) for k in twins):
        return stem
    joints = [joint.name for joint in model.joints for _ in joint.coordinates]
    return joints[place]
