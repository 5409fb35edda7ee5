"""Which way a model's root body is upright in a recorded motion, and the axes that would turn it upright."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.model import GROUND, Multibody

AXES = "xyz"
FREE = 6
"""Coordinates of a joint that leaves a body free of the ground."""


@dataclass(frozen=True)
class Tilt:
    """How the root body is turned against how the model stands by default.

    Parameters
    ----------
    body
        Its name.
    angle
        Between what is up in it by default and what is up in the ground, median over the known frames [rad].
    up
        Where what is up in it by default points in the ground, mean over the known frames; no unit vector.
    """

    body: str
    angle: float
    up: Float[np.ndarray, " 3"]


def root_tilt(model: Multibody, values: Float[np.ndarray, "t n"]) -> Tilt | None:
    """Tilt of the body that a joint of six coordinates frees from the ground, for coordinates [rad, m].

    None without such a joint, without gravity, or where no frame has all of its coordinates.
    """
    root = next((j for j in model.joints if j.parent == GROUND and len(j.coordinates) == FREE), None)
    if root is None or not np.any(model.gravity):
        return None
    ups = _ups(model, root, values)
    if not len(ups):
        return None
    tilt = np.arccos(np.clip(ups @ model.up, -1.0, 1.0))
    return Tilt(root.child, float(np.median(tilt)), ups.mean(axis=0))


def _ups(model: Multibody, root: JointModel, values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "s 3"]:
    """Where what is up in the body by default points, in the frames that have all of the root's coordinates."""
    names = [c.name for c in model.coordinates]
    own = [names.index(c.name) for c in root.coordinates]
    known = values[np.isfinite(values[:, own]).all(axis=1)][:, own]
    default = np.array([[c.default for c in root.coordinates]])
    first, moved = (
        root.pose(dict(zip((c.name for c in root.coordinates), rows.T, strict=True)), len(rows))
        for rows in (default, known)
    )
    inner = first.rotation.inv().apply(model.up)
    return np.asarray(moved.rotation.apply(inner)).reshape(-1, 3)


def shortest_turn(start: Float[np.ndarray, " 3"], end: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "3 3"]:
    """The shortest turn from the coordinate axis next to one direction to the one next to another: a signed
    permutation.

    Half a turn is about one of the axes across it.
    """
    first, last = _nearest_axis(start), _nearest_axis(end)
    if np.array_equal(first, last):
        return np.eye(3)
    if np.array_equal(first, -last):
        across = np.roll(np.abs(last), 1)
        return np.asarray(2.0 * np.outer(across, across) - np.eye(3))
    pivot = np.cross(first, last)
    return np.asarray(np.outer(last, first) - np.outer(first, last) + np.outer(pivot, pivot))


def _nearest_axis(direction: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " 3"]:
    """Unit vector along the coordinate axis that a direction is nearest to."""
    found = np.zeros(3)
    largest = int(np.argmax(np.abs(direction)))
    found[largest] = np.sign(direction[largest]) or 1.0
    return found


def axes_upright(found: Float[np.ndarray, " 3"], up: Float[np.ndarray, " 3"], turned: Rotation | None = None) -> str:
    """Axes, in the form "x,z,-y", that turn the coordinate axis next to `found` into the one next to `up`.

    The shortest turn, after `turned`, by which the recording was turned already: which way the subject faces is not
    known from this.
    """
    before = np.eye(3) if turned is None else turned.as_matrix()
    rows = np.rint(shortest_turn(found, up) @ before).astype(int)
    return ",".join(f"{'-' if row.min() < 0 else ''}{AXES[int(np.argmax(np.abs(row)))]}" for row in rows)
