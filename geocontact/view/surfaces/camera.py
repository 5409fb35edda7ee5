"""From where a still is taken, and what of the scene it takes in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.view.surfaces.scene import ContactScene


def camera_directions(medial: Float[np.ndarray, " 3"]) -> Mapping[str, tuple[float, float, float]]:
    """View-from vectors in FIXED's frame, named by its axes; anatomy is named where the caller knows it.

    Meshes do not say which way their axes point in the body: public data of implants that are described with x anterior
    have x posterior, and y is superior in a knee and not in a scan of a foot. What is known is what was asked for: the
    medial direction, and lateral opposite to it.

    Parameters
    ----------
    medial
        Unit vector towards medial in FIXED's frame; zero when it is not known.
    """
    ways = [(s * float(k == 0), s * float(k == 1), s * float(k == 2)) for k in range(3) for s in (1, -1)]
    names = {way: _axis(*way) for way in ways}
    towards = tuple(float(value) for value in medial)
    if any(towards):
        x, y, z = towards
        opposite = (0.0 - x, 0.0 - y, 0.0 - z)
        sides = {(x, y, z): f"medial ({_axis(x, y, z)})", opposite: f"lateral ({_axis(*opposite)})"}
        names = {**sides, **{way: name for way, name in names.items() if way not in sides}}
    return {name: way for way, name in names.items()}


def _axis(x: float, y: float, z: float) -> str:
    """+x, −z, … for a coordinate axis, the numbers for anything else."""
    for name, value in zip("xyz", (x, y, z), strict=True):
        if abs(value) == 1.0:
            return ("+" if value > 0.0 else "−") + name
    return f"{x:.2f}, {y:.2f}, {z:.2f}"


MARGIN = 1.06
LARGEST = (1500, 1300)  # pixels


@dataclass(frozen=True)
class View:
    """Named direction of view.

    Parameters
    ----------
    name
        What the picture says ("superior").
    seen_from
        Direction from the bodies to the eye, in FIXED's frame; any length.
    up
        Direction that points up in the picture, in FIXED's frame; y by default, x when seen along y.
    """

    name: str
    seen_from: tuple[float, float, float]
    up: tuple[float, float, float] | None = None

    def axes(self) -> Float[np.ndarray, "3 3"]:
        """Unit vectors to the right, up and towards the eye, as rows, in FIXED's frame."""
        towards = np.asarray(self.seen_from, float)
        size = np.linalg.norm(towards)
        if not (np.isfinite(size) and size > 0.0):
            raise ValueError(f"view {self.name}: no direction in {self.seen_from}")
        towards /= size
        choices = [(0.0, 1.0, 0.0), (1.0, 0.0, 0.0)] if self.up is None else [self.up]
        for up in choices:
            right = np.cross(up, towards)
            size = np.linalg.norm(right)
            if size > 1e-3 * np.linalg.norm(up):
                right /= size
                return np.array([right, np.cross(towards, right), towards])
        raise ValueError(f"view {self.name}: up {self.up} is the direction of view")


@dataclass(frozen=True)
class Shot:
    """A parallel projection of a part of space.

    axes
        Unit vectors to the right, up and towards the eye, as rows, in FIXED's frame.
    centre
        Middle of what is shown, in FIXED's frame [m].
    half
        Half the width, height and depth of what is shown [m].
    pixels
        Width and height of the picture.
    """

    axes: Float[np.ndarray, "3 3"]
    centre: Float[np.ndarray, " 3"]
    half: Float[np.ndarray, " 3"]
    pixels: tuple[int, int]

    @classmethod
    def of(cls, scene: ContactScene, view: View) -> Shot:
        """Shot that takes in all faces of both bodies."""
        axes = view.axes()
        bodies = ((scene.fixed_vertices, scene.fixed_faces), (scene.moving_vertices, scene.moving_faces))
        points = np.vstack([vertices[faces.ravel()] for vertices, faces in bodies]) @ axes.T
        lower, upper = points.min(axis=0), points.max(axis=0)
        half = np.maximum(0.5 * (upper - lower) * MARGIN, 1e-4)
        half[:2] = np.maximum(half[:2], half[:2].max() / 3.0)
        scale = min(LARGEST[0] / half[0], LARGEST[1] / half[1])
        pixels = (round(half[0] * scale), round(half[1] * scale))
        return cls(axes, 0.5 * (lower + upper) @ axes, half, pixels)

    def project(self, points: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
        """Points of FIXED's frame as (right, up, towards the eye) about the centre [m]."""
        return np.asarray((points - self.centre) @ self.axes.T)
