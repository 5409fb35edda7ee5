"""Coordinates of a model as they are shown: numbers, and panels of curves over time."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.multibody.joint import Coordinate
from geocontact.data.multibody.model import Multibody
from geocontact.data.sides import RIGHT, stem_and_side
from geocontact.view.curves.declared import Curve, Curves, Scale


def printed(coordinates: tuple[Coordinate, ...], values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t n"]:
    """Values as OpenSim's files in degrees have them: rotations in degrees, all else as it is."""
    return np.asarray(values * np.array([np.degrees(1.0) if c.kind == "rotational" else 1.0 for c in coordinates]))


def panels_of(
    model: Multibody,
    unit: str,
    values: Float[np.ndarray, "t n"],
    which: Bool[np.ndarray, " n"],
    beside: Scale | None = None,
) -> list[Curves]:
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
