"""Panels of a page with the coordinates of a model, joint by joint: all in one would be a thicket."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.multibody.model import Multibody
from geocontact.view.page.content import Curve, Curves, Section


def panels_by_joint(
    model: Multibody, unit: str, values: Float[np.ndarray, "t n"], which: Bool[np.ndarray, " n"]
) -> list[Section]:
    """One panel for each joint that has some of these coordinates, in the model's order."""
    found: list[Section] = []
    start = 0
    for joint in model.joints:
        stop = start + len(joint.coordinates)
        curves = [Curve(c.name, values[:, start + k]) for k, c in enumerate(joint.coordinates) if which[start + k]]
        if curves:
            found.append(Curves(joint.name, unit, curves))
        start = stop
    return found
