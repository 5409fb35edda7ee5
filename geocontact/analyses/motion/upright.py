"""Whether the body that is free of the ground stands upright: markers in other axes fit as well, but on their side."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.frame.quantities import turned_axes
from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.model import GROUND, Multibody

TILTED = np.radians(60.0)
"""From upright, in half of the frames: who stands, walks or sits stays below; who lies or has other axes does not."""

FREE = 6
"""Coordinates of a joint that leaves a body free of the ground."""


def warn_of_tilt(model: Multibody, values: Float[np.ndarray, "t n"], axes: str | None) -> None:
    """A warning where the root body is far from how the model stands by default, with the axes that would mend it."""
    root = next((j for j in model.joints if j.parent == GROUND and len(j.coordinates) == FREE), None)
    if root is None or not np.any(model.gravity):
        return
    up, ups = -model.gravity / np.linalg.norm(model.gravity), _ups(model, root, values)
    tilt = np.arccos(np.clip(ups @ up, -1.0, 1.0))
    if not len(tilt) or np.median(tilt) <= TILTED:
        return
    meant = axes_upright(ups.mean(axis=0), up, axes)
    reserve(
        f"{root.child} is {np.degrees(np.median(tilt)):.0f} degrees from upright in half of the frames: gravity of "
        f"{model.name} does not point down in the recording; unless the subject lies, try `axes` {meant}"
    )


def _ups(model: Multibody, root: JointModel, values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "s 3"]:
    """Where what is up in the body by default points, in the frames that tell the root's coordinates."""
    names = [c.name for c in model.coordinates]
    own = [names.index(c.name) for c in root.coordinates]
    known = values[np.isfinite(values[:, own]).all(axis=1)][:, own]
    default = np.array([[c.default for c in root.coordinates]])
    first, *rest = (
        root.pose(dict(zip((c.name for c in root.coordinates), rows.T, strict=True)), len(rows))
        for rows in (default, known)
    )
    up = -model.gravity / np.linalg.norm(model.gravity)
    inner = first.rotation.inv().apply(up)
    return np.asarray(rest[0].rotation.apply(inner)).reshape(-1, 3)


def axes_upright(found: Float[np.ndarray, " 3"], up: Float[np.ndarray, " 3"], axes: str | None) -> str:
    """Axes, as the option takes them, that turn the coordinate axis next to `found` into the one next to `up`.

    The shortest turn, after the one that was asked for: which way the subject faces is not known from this.
    """
    start, end = _nearest_axis(found), _nearest_axis(up)
    turn = np.eye(3)
    if np.array_equal(start, -end):  # half a turn about any axis across it
        across = np.roll(np.abs(end), 1)
        turn = 2.0 * np.outer(across, across) - np.eye(3)
    elif not np.array_equal(start, end):
        pivot = np.cross(start, end)
        turn = np.outer(end, start) - np.outer(start, end) + np.outer(pivot, pivot)
    given = np.eye(3) if axes is None else turned_axes(axes, "`axes`").as_matrix()
    rows = np.rint(turn @ given).astype(int)
    return ",".join(f"{'-' if row.min() < 0 else ''}{'xyz'[int(np.argmax(np.abs(row)))]}" for row in rows)


def _nearest_axis(direction: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " 3"]:
    """Unit vector along the coordinate axis that a direction is nearest to."""
    found = np.zeros(3)
    largest = int(np.argmax(np.abs(direction)))
    found[largest] = np.sign(direction[largest]) or 1.0
    return found
