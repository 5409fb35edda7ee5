"""What is found of a mat on a body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from geocontact.analyses.mat.closest_point import ClosestPoint
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.result import Result
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_landmarks import MatLandmarks
from geocontact.loads.mat.errors import MatErrors
from geocontact.loads.mat.load import MatLoad
from geocontact.loads.mat.map import MatMap


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MatFindings(Result):
    """Fields of a `MatResult`, which tables, figure and page are made of.

    Parameters
    ----------
    frames
        Pressures as they are used: offset taken off, smoothed, dead cells seen to.
    saturated
        Cells that count and clip.
    surface
        Scan, in the frame of the body where it is registered to one.
    landmarks
        Places of the mat and their points of the surface [m].
    drape, cells
        How the mat lies, and where its cells are on the faces.
    pressure
        Of each of these cells [Pa].
    loads, segments
        Force, moment, centre of pressure and area of the whole mat, and of each named part.
    uncertainty
        Covariance of force [N] and moment [N m].
    errors
        What it rests on.
    home
        Name of the frame that surface and cells are in; that of the loads is another where the segment moves.
    registration
        How well scan and body fit; None without a body.
    closest_point
        The mat as a flat one would lie; None where it is laid that way or cannot be.
    agreement
        With the forces of a model, by channel and phase; None without one.
    """

    options: MatOptions
    frames: PressureFrames
    saturated: Bool[np.ndarray, "t r c"]
    surface: Surface
    landmarks: MatLandmarks
    drape: Drape
    cells: MatMap
    pressure: Float[np.ndarray, "t n"]
    loads: MatLoad
    segments: Mapping[str, MatLoad]
    uncertainty: Float[np.ndarray, "t six six"]
    errors: MatErrors
    home: str
    registration: Registration | None
    closest_point: ClosestPoint | None
    agreement: pd.DataFrame | None

    @property
    def heaviest(self) -> int:
        """Frame with the largest force."""
        return int(np.argmax(self.loads.pressing))

    @cached_property
    def on_faces(self) -> Float[np.ndarray, " t"]:
        """Largest pressure of a face in each frame [Pa]: colours of page and figure end at the largest of all."""
        area = self.surface.face_area
        return np.array([self.cells.face_pressure(one[None], area).max(initial=0.0) for one in self.pressure])

    @property
    def deviation(self) -> Float[np.ndarray, "t six"]:
        """Standard deviations of force [N] and moment [N m]."""
        return np.asarray(np.sqrt(np.maximum(np.diagonal(self.uncertainty, axis1=1, axis2=2), 0.0)))
