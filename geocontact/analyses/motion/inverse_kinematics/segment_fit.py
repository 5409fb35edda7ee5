"""How far segments are from the bodies of a fitted model: angles, distances, a table, a test of fit."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.analyses.motion.inverse_kinematics.segments import ARM, Segments, axes_of, origin_of
from geocontact.analyses.motion.marker_tasks import FAR, MOVING
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.identify.goodness_of_fit import Doubt
from geocontact.view.curves.declared import Curve, Curves
from geocontact.view.page.content import Row, Table

LARGE, LARGEST, ABSURD = np.radians(5.0), np.radians(15.0), np.radians(30.0)
"""Root mean square and largest angle from which a fit is doubtful, and root mean square from which it contradicts the
recording; our own choice. A leg with one pin at the knee, faced the wrong way by 180 degrees, is 5.9 degrees off."""
SIDEWAYS = np.radians(60.0)
"""Angle between the way and where the model faces from which one is doubted; our own choice."""


@dataclass(frozen=True, eq=False)
class SegmentFit:
    """Segments beside the bodies of the model.

    Parameters
    ----------
    time
        [s].
    names
        Of the segments that count.
    angles
        Between each as recorded and in the model [rad]; NaN where it was not seen.
    distances
        Of the origins [m]; None of sensors.
    off_its_way
        Level angle between where the person went and where the model faces [rad]; None where nobody went far.
    """

    time: Float[np.ndarray, " t"]
    names: tuple[str, ...]
    angles: Float[np.ndarray, "t s"]
    distances: Float[np.ndarray, "t s"] | None
    off_its_way: float | None

    @classmethod
    def of(cls, found: Poses, segments: Segments) -> SegmentFit:
        """Angles from the directions: three of length a / √2 are 2 a sin(θ/2) apart, root of the sum of squares."""
        at = dict(zip(found.markers, found.distances.T, strict=True))
        nothing = np.full(len(found.time), np.nan)
        angles = []
        for name in segments.names:
            squares = sum(at.get(axis, nothing) ** 2 for axis in axes_of(name))
            angles.append(2.0 * np.arcsin(np.minimum(np.sqrt(squares) / (2.0 * ARM), 1.0)))
        places = None
        if segments.poses.origins is not None:
            places = np.column_stack([at.get(origin_of(name), nothing) for name in segments.names])
        return cls(found.time, segments.names, np.column_stack(angles), places, segments.off_its_way())

    @property
    def rms(self) -> float:
        """Root mean square angle of all segments [rad]; NaN where no orientation counts."""
        return _rms(self.angles)

    def table(self) -> pd.DataFrame:
        """Angle [deg] and distance [mm] of each segment over time."""
        columns = {f"{n} [deg]": np.degrees(a) for n, a in zip(self.names, self.angles.T, strict=True)}
        if self.distances is not None:
            columns |= {f"{origin_of(n)} [mm]": 1e3 * d for n, d in zip(self.names, self.distances.T, strict=True)}
        return pd.DataFrame({"time [s]": self.time, **columns})

    def summary(self) -> dict[str, object]:
        """Numbers of the whole recording, as `ik.json` holds them."""
        found: dict[str, object] = {"rms_deg": np.degrees(self.rms), "max_deg": np.degrees(_most(self.angles))}
        each: dict[str, dict[str, float]] = {}
        for k, name in enumerate(self.names):
            angles = self.angles[:, k]
            each[name] = {"rms_deg": np.degrees(_rms(angles)), "max_deg": np.degrees(_most(angles))}
            if self.distances is not None:
                shifts = 1e3 * self.distances[:, k]
                each[name] |= {"rms_mm": _rms(shifts), "max_mm": _most(shifts)}
        if self.distances is not None:
            found |= {"rms_mm": 1e3 * _rms(self.distances), "max_mm": 1e3 * _most(self.distances)}
        return {**found, "segments": each}

    def sentence(self) -> str:
        """How many segments there are, the numbers, and what they do not test."""
        counted = "joint angles count from the pose of the calibration, which is not tested"
        return f"{len(self.names)} segments: {self.words()}; {counted}"

    def words(self) -> str:
        """The numbers in one clause."""
        said = []
        if np.isfinite(self.angles).any():
            frame, k = _worst(self.angles)
            largest = (
                f"{np.degrees(self.angles[frame, k]):.1f} degrees at most, {self.names[k]} at {self.time[frame]:.3g} s"
            )
            said.append(f"{np.degrees(self.rms):.1f} degrees from the model, root mean square, and {largest}")
        if self.distances is not None and np.isfinite(self.distances).any():
            frame, k = _worst(self.distances)
            largest = f"{1e3 * self.distances[frame, k]:.1f} mm at most, {self.names[k]} at {self.time[frame]:.3g} s"
            said.append(f"origins {1e3 * _rms(self.distances):.1f} mm, root mean square, and {largest}")
        return "; ".join(said)

    def doubts(self) -> Iterable[Doubt]:
        """Angles and distances that are larger than is plausible."""
        if self.rms > LARGE:
            what = f"segments are {np.degrees(self.rms):.0f} degrees from the model, root mean square"
            yield Doubt(what, self.rms > ABSURD, self.rms / LARGE)
        if (most := _most(self.angles)) > LARGEST:
            frame, k = _worst(self.angles)
            what = f"{self.names[k]} is {np.degrees(most):.0f} degrees from the model at {self.time[frame]:.3g} s"
            yield Doubt(what, False, most / LARGEST)
        if self.off_its_way is not None and self.off_its_way > SIDEWAYS:
            what = f"the model faces {np.degrees(self.off_its_way):.0f} degrees from where the person goes"
            yield Doubt(f"{what}, unless backwards or sideways", False, self.off_its_way / SIDEWAYS)
        if self.distances is not None and (off := _rms(self.distances)) > MOVING.rms:
            what = f"origins of segments are {1e3 * off:.0f} mm from the model, root mean square"
            yield Doubt(what, off > FAR, off / MOVING.rms)

    def rows(self, frames: Int[np.ndarray, " k"]) -> list[Row]:
        """Root mean squares of each frame, for a page."""
        found = [Row("segments, root mean square", "deg", [_text(np.degrees(row)) for row in self.angles[frames]])]
        if self.distances is not None:
            found.append(Row("origins, root mean square", "mm", [_text(1e3 * row) for row in self.distances[frames]]))
        return found

    def curves(self) -> list[Curves]:
        """Angles and distances over time."""
        angles = [Curve(n, np.degrees(a)) for n, a in zip(self.names, self.angles.T, strict=True)]
        found = [Curves("Angle of segments", "deg", angles)]
        if self.distances is not None:
            shifts = [Curve(n, 1e3 * d) for n, d in zip(self.names, self.distances.T, strict=True)]
            found.append(Curves("Distance of origins", "mm", shifts))
        return found

    def section(self, segments: Segments) -> Table:
        """A row for each segment."""
        rows = []
        for k, (name, body) in enumerate(zip(self.names, segments.bodies, strict=True)):
            turn = np.degrees(segments.placed[k].rotation.magnitude())
            angles = np.degrees(self.angles[:, k])
            shifts = "-" if self.distances is None else _text(1e3 * self.distances[:, k])
            lost = str(int((~segments.poses.there[:, k]).sum()))
            rows.append((name, body, f"{turn:.1f}", _text(angles), f"{_most(angles):.1f}", shifts, lost))
        head = (
            "segment",
            "body",
            "turned in it [deg]",
            "rms [deg]",
            "largest [deg]",
            "origin, rms [mm]",
            "frames not seen",
        )
        return Table("Segments", head, rows)


def _rms(values: Float[np.ndarray, "*shape"]) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else float("nan")


def _most(values: Float[np.ndarray, "*shape"]) -> float:
    return float(np.nanmax(values)) if np.isfinite(values).any() else float("nan")


def _worst(values: Float[np.ndarray, "t s"]) -> tuple[int, int]:
    frame, which = np.unravel_index(int(np.nanargmax(values)), values.shape)
    return int(frame), int(which)


def _text(values: Float[np.ndarray, " k"]) -> str:
    return f"{size:.1f}" if np.isfinite(size := _rms(values)) else "-"
