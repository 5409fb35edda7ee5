"""Bodies, points and lines over time on a page, coloured by distance or amount."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float, Int, UInt16
from scipy.spatial.transform import RigidTransform

from geocontact.view.page.pack import GRID, Grid

Tone = Literal["bone", "seen", "model", "force", "floor"]
MISSING = GRID
"""Word of a coordinate of a point that is not known; those of known points are below."""


@dataclass(frozen=True, eq=False)
class Linkage:
    """Points, and lines between some of them.

    Parameters
    ----------
    name
        Any text; it stays text.
    points
        In the scene's frame S [m], one row for each frame, or one row for all; NaN where a point is not known.
    lines
        Pairs of points; a line is drawn where both are known.
    tone
        Its colour by what it is.
    radius
        Of the points [m]; 0 draws lines only.
    width
        Thickness of the lines [m].
    """

    name: str
    points: Float[np.ndarray, "t n 3"]
    lines: Int[np.ndarray, "k 2"]
    tone: Tone
    radius: float
    width: float

    def __post_init__(self) -> None:
        if not self.known.any():
            raise ValueError(f"{self.name}: no point is known in any frame")
        if self.lines.size and (self.lines.min() < 0 or self.lines.max() >= self.points.shape[1]):
            raise ValueError(f"{self.name}: a line names a point that is not there")

    @property
    def known(self) -> Bool[np.ndarray, "t n"]:
        """Which points are known in which frame."""
        return np.asarray(np.isfinite(self.points).all(axis=2))

    @property
    def places(self) -> Float[np.ndarray, "k 3"]:
        """All places that a point is at in some frame [m]."""
        return np.asarray(self.points[self.known])

    @property
    def grid(self) -> Grid:
        """Around all places."""
        return Grid.around(self.places)

    def words(self) -> UInt16[np.ndarray, "t m"]:
        """Steps of the grid, x y z of each point in turn; `MISSING` where it is not known."""
        words = np.full(self.points.shape, MISSING, np.uint16)
        words[self.known] = np.minimum(self.grid.steps(self.places), MISSING - 1)
        return words.reshape(len(self.points), -1)


@dataclass(frozen=True, eq=False)
class SetLandmark:
    """A landmark that stands on a body when the page opens.

    Parameters
    ----------
    name, row, column
        Its name, and its place of a mat as written; "" where there is none.
    at
        Coordinates in the numbers of the mesh file.
    corners, weights
        Vertices of the face that it is shown on, and its barycentric coordinates there.
    """

    name: str
    at: tuple[float, float, float]
    corners: tuple[int, int, int]
    weights: tuple[float, float, float]
    row: str = ""
    column: str = ""


@dataclass(frozen=True, eq=False)
class MeshSource:
    """The mesh file of a body on which landmarks may be picked.

    Parameters
    ----------
    file, sha256
        Name and hash of the file, which landmarks are saved with.
    unit, frame
        Unit of length of the file's numbers, and words for the frame that they are in.
    vertices
        The body's vertices as the file has them, in that unit and frame and in the order of the body's: what is picked
        has these coordinates, not those of the picture, which are rounded.
    landmarks
        Landmarks that are there when the page opens.
    """

    file: str
    sha256: str
    unit: str
    frame: str
    vertices: Float[np.ndarray, "n 3"]
    landmarks: Sequence[SetLandmark] = ()


@dataclass(frozen=True, eq=False)
class SceneBody:
    """A triangle surface, possibly moving, possibly coloured.

    Parameters
    ----------
    name
        Any text; it stays text.
    vertices, faces
        Surface in the body's own frame B [m]; corners counter-clockwise seen from outside.
    poses
        `X_SB`, one per frame: maps the body's frame into the scene's frame S [m]. None: fixed, S is its own frame.
    distance
        Distance of each vertex to the other body per frame [m]; +inf (-inf) where it is farther (deeper) than
        was asked, NaN where unknown. None: the body is drawn plain.
    signed
        `distance` is negative inside the other body; False where that body is open and has no inside.
    source
        Its mesh file, where landmarks may be picked on it.
    opacity
        At the start, 0 … 1. None: moving bodies are see-through where a fixed one is there to be seen.
    """

    name: str
    vertices: Float[np.ndarray, "n 3"]
    faces: Int[np.ndarray, "m 3"]
    poses: RigidTransform | None = None
    distance: Float[np.ndarray, "t n"] | None = None
    opacity: float | None = None
    signed: bool = True
    source: MeshSource | None = None


@dataclass(frozen=True, eq=False)
class FaceMap:
    """An amount on each face of one body over time, for colours that the reader may choose instead of the distance.

    Parameters
    ----------
    name, unit
        What is shown: "mean pressure of each face" in "MPa".
    body
        Place in the scene's bodies.
    values
        In that unit; grey where not above 0.
    """

    name: str
    unit: str
    body: int
    values: Float[np.ndarray, "t m"]

    @property
    def upper(self) -> float:
        """Upper end of the colours, the same in all frames: the largest value, or 1 where nothing is above 0."""
        largest = float(self.values.max(initial=0.0))
        return largest if largest > 0.0 else 1.0

    def check(self, bodies: Sequence[SceneBody]) -> None:
        """Refuse a map of a body or of faces that are not there."""
        if not 0 <= self.body < len(bodies):
            raise ValueError(f"{self.name}: there is no body {self.body}")
        faces = len(bodies[self.body].faces)
        if self.values.shape[1] != faces:
            raise ValueError(f"{self.name}: {self.values.shape[1]} values for {faces} faces")


@dataclass(frozen=True, eq=False)
class Scene:
    """Bodies over time in the frame S.

    Parameters
    ----------
    thresholds
        Distances at which a contour is drawn [m], in any order; the largest is the main one.
    span
        Limits of the colours [m], the same in all frames.
    value_name
        What the colours mean: "signed distance to the other body".
    sides
        The distance is to either side of a shape: two hues that meet at zero, and no overlap.
    directions
        Camera presets: name and vector from which to look, in S: {"anterior (+x)": (1, 0, 0)}. Keys 1, 2, … in order.
    up
        Upwards in S.
    view
        Direction from which the page opens; None: the one from which the contact patch is seen.
    maps
        Amounts on faces; the page opens with the first one, where there is one.
    linkages
        Points and lines. Without bodies there is no distance: thresholds, span and value_name mean nothing.
    """

    bodies: Sequence[SceneBody] = ()
    thresholds: Sequence[float] = ()
    span: tuple[float, float] = (0.0, 1.0)
    value_name: str = ""
    sides: bool = False
    directions: Mapping[str, Sequence[float]] = field(default_factory=dict)
    up: Sequence[float] = (0.0, 1.0, 0.0)
    view: Sequence[float] | None = None
    maps: Sequence[FaceMap] = ()
    linkages: Sequence[Linkage] = ()

    def __post_init__(self) -> None:
        if not self.bodies and not self.linkages:
            raise ValueError("a scene needs a body or a linkage")
        if self.bodies:
            self._check_bodies()

    def _check_bodies(self) -> None:
        if not self.thresholds:
            raise ValueError("a threshold is missing")
        lower, upper = self.span
        if not lower < self.threshold <= upper:
            raise ValueError(f"span {lower:g} … {upper:g} m does not hold the threshold {self.threshold:g} m")
        for body in self.bodies:
            if len(body.faces) == 0 or not np.isfinite(body.vertices).all():
                raise ValueError(f"{body.name}: a body needs at least one face and finite vertices")
            if body.faces.min() < 0 or body.faces.max() >= len(body.vertices):
                raise ValueError(f"{body.name}: a face names a vertex that is not there")
            if body.distance is not None and body.distance.shape[1] != len(body.vertices):
                raise ValueError(f"{body.name}: {body.distance.shape[1]} distances for {len(body.vertices)} vertices")
            if body.source is not None and body.source.vertices.shape != body.vertices.shape:
                raise ValueError(f"{body.name}: {len(body.source.vertices)} vertices of its file, not its own number")
        for each in self.maps:
            each.check(self.bodies)

    @property
    def measured(self) -> bool:
        """Whether a body has distances, which colours may show."""
        return any(body.distance is not None for body in self.bodies)

    @property
    def pickable(self) -> bool:
        """Whether landmarks may be picked on one of its bodies."""
        return any(body.source is not None for body in self.bodies)

    @property
    def threshold(self) -> float:
        """The main threshold [m]; 0 without bodies."""
        return float(max(self.thresholds, default=0.0))
