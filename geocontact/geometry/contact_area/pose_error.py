"""Contact area when the pose is known with an error: drawn, and to first order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd
from jaxtyping import Float
from scipy.spatial.transform import Rotation
from scipy.special import gammaincinv

from geocontact.data.evolution import MM, MM2, AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.repeated import RepeatedArea
from geocontact.geometry.register.landmarks import fit_landmarks
from geocontact.geometry.surface import Surface

Axes = Literal["fixed", "moving"]
ENDS = (0.025, 0.975)
"""Quantiles of a 95 % interval."""
NORMAL = 1.959963984540054
"""97.5 % quantile of the normal distribution."""
ALIKE = 0.1
"""Share by which the two standard deviations may differ, beside the chance of the draws."""
SHIFTED = 0.25
"""Standard deviations that the mean of the draws may be off the area itself, beside their chance."""
CHANCE = 3.0
"""Standard errors of the draws that are their chance: the same draws serve all frames, and all would disagree."""


@dataclass(frozen=True, eq=False)
class PoseError:
    """Small motions by which a pose may be off.

    Parameters
    ----------
    draws
        Shift [m] and turn [rad, a rotation vector] of each draw.
    matrix
        Their covariance to first order.
    axes
        fixed: along FIXED's axes, x = exp(turn) R a + t + shift, turned about MOVING's origin. moving: along MOVING's,
        x = R (exp(turn) a + shift) + t.
    """

    draws: Float[np.ndarray, "n 6"]
    matrix: Float[np.ndarray, "6 6"]
    axes: Axes

    @classmethod
    def normal(cls, sd: Float[np.ndarray, " 6"], axes: Axes, count: int, seed: int) -> PoseError:
        """Independent normal errors with these standard deviations [m, rad]."""
        draws = np.random.default_rng(seed).standard_normal((count, 6)) * sd
        return cls(draws, np.diag(sd**2), axes)

    @classmethod
    def of_markers(cls, markers: Float[np.ndarray, "m 3"], sd: float, count: int, seed: int) -> PoseError:
        """What normal errors of markers on MOVING [m, in its frame, each coordinate] do to a rigid fit of them.

        Each draw is a fit (`register.landmarks`). The covariance is that of the fit to first order (Sibson 1979):
        sd^2/m for the shift of the centroid, sd^2 (sum (|r|^2 I - r r^t))^-1 for the turn.
        """
        noise = np.random.default_rng(seed).standard_normal((count, *markers.shape)) * sd
        poses = [fit_landmarks(markers, markers + each).pose for each in noise]
        draws = np.array([[*pose.translation, *pose.rotation.as_rotvec()] for pose in poses])
        about = markers.mean(axis=0)
        arm = markers - about
        inertia = np.eye(3) * float((arm**2).sum()) - arm.T @ arm
        turn = sd**2 * np.linalg.inv(inertia)
        carried = np.array([np.cross(about, axis) for axis in np.eye(3)]).T  # shift of the origin = about x turn
        matrix = np.zeros((6, 6))
        matrix[:3, :3] = sd**2 / len(markers) * np.eye(3) + carried @ turn @ carried.T
        matrix[:3, 3:] = carried @ turn
        matrix[3:, :3] = matrix[:3, 3:].T
        matrix[3:, 3:] = turn
        return cls(draws, matrix, "moving")

    def poses(
        self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]
    ) -> tuple[Float[np.ndarray, "n 3 3"], Float[np.ndarray, "n 3"]]:
        """The pose moved by each draw."""
        turns, shifts = Rotation.from_rotvec(self.draws[:, 3:]).as_matrix(), self.draws[:, :3]
        if self.axes == "fixed":
            return turns @ rotation, translation + shifts
        return rotation @ turns, translation + shifts @ rotation.T


@dataclass(frozen=True, eq=False)
class ErrorOfArea:
    """FIXED's area over the draws at one pose [m^2], triangles cut as given.

    nominal is the area at the pose itself, drawn (n,) those of the draws; slope (6,) is the derivative to shift [m] and
    turn [rad] of the error's own axes; first_order the standard deviation that follows from it.
    """

    nominal: float
    drawn: Float[np.ndarray, " n"]
    slope: Float[np.ndarray, " 6"]
    first_order: float


def error_of_area(
    areas: RepeatedArea,
    error: PoseError,
    rotation: Float[np.ndarray, "3 3"],
    translation: Float[np.ndarray, " 3"],
    workers: int | None = None,
) -> ErrorOfArea:
    """Both at one pose of MOVING; `areas` measures FIXED in the field of MOVING.

    A small motion (shift, turn) of MOVING along its own axes moves FIXED by its opposite, in MOVING's frame and about
    MOVING's origin; so do errors along FIXED's axes, after a turn into MOVING's.
    """
    turned, shifted = error.poses(rotation, translation)
    every, at = np.concatenate([rotation[None], turned]), np.concatenate([translation[None], shifted])
    back = every.transpose(0, 2, 1)
    found = areas.at(back, -np.einsum("nij,nj->ni", back, at), workers)
    slope = -found.slope[0]
    if error.axes == "fixed":
        slope = np.concatenate([rotation @ slope[:3], rotation @ slope[3:]])
    variance = float(slope @ error.matrix @ slope)
    return ErrorOfArea(float(found.area[0]), found.area[1:], slope, float(np.sqrt(max(variance, 0.0))))


@dataclass(frozen=True, eq=False)
class AreaUncertainty:
    """Error of the poses carried into FIXED's area, over frames (t) and thresholds (k).

    Parameters
    ----------
    error
        By which the poses may be off.
    area
        Reported area [m^2], which intervals are about.
    cells
        What `error_of_area` finds in each frame, at each threshold.
    """

    error: PoseError
    area: Float[np.ndarray, "t k"]
    cells: tuple[tuple[ErrorOfArea, ...], ...]

    def drawn(self, k: int) -> Float[np.ndarray, "t n"]:
        """Areas of the draws at threshold `k` [m^2]: the reported one and how far the clip of each draw is from its."""
        moved = [row[k].drawn - row[k].nominal for row in self.cells]
        return np.asarray(np.maximum(self.area[:, k, None] + np.array(moved), 0.0))

    def interval(self, k: int) -> Float[np.ndarray, "2 t"]:
        """95 % interval of the draws at threshold `k` [m^2]."""
        return np.asarray(np.quantile(self.drawn(k), ENDS, axis=1))

    def deviation(self, k: int) -> Float[np.ndarray, "3 t"]:
        """Standard deviation of the draws at threshold `k`, and the ends of its own 95 % interval [m^2]."""
        return np.asarray(known_deviation(self.drawn_sd(k), len(self.error.draws)))

    def drawn_sd(self, k: int) -> Float[np.ndarray, " t"]:
        """Standard deviation of the draws at threshold `k` [m^2]."""
        return np.array([float(row[k].drawn.std(ddof=1)) for row in self.cells])

    def verdict(self, frame: int, k: int) -> str:
        """Whether first order and draws agree, or why not."""
        return agreement(self.cells[frame][k])

    def table(self, time: Float[np.ndarray, " t"], thresholds: tuple[float, ...]) -> pd.DataFrame:
        """A row per frame and threshold, as in `AreaEvolution.table`; times [s] and thresholds [m] of the evolution."""
        rows = []
        ends = [self.interval(k) for k in range(len(thresholds))]
        known = [self.deviation(k) for k in range(len(thresholds))]
        for frame, row in enumerate(self.cells):
            for k, cell in enumerate(row):
                area, sd = self.area[frame, k] * MM2, cell.first_order * MM2
                slope = dict(zip("xyz", cell.slope[:3] * MM2 / MM, strict=True))
                turn = dict(zip("xyz", cell.slope[3:] * MM2 * np.pi / 180.0, strict=True))
                rows.append(
                    {
                        "time [s]": time[frame],
                        "threshold [mm]": thresholds[k] * MM,
                        "area_fixed [mm^2]": area,
                        "drawn_sd [mm^2]": known[k][0, frame] * MM2,
                        "drawn_lower [mm^2]": ends[k][0, frame] * MM2,
                        "drawn_upper [mm^2]": ends[k][1, frame] * MM2,
                        "drawn_bias [mm^2]": (float(cell.drawn.mean()) - cell.nominal) * MM2,
                        "first_order_sd [mm^2]": sd,
                        "first_order_lower [mm^2]": max(area - NORMAL * sd, 0.0),
                        "first_order_upper [mm^2]": area + NORMAL * sd,
                        "agree": self.verdict(frame, k),
                        **{f"slope_t{axis} [mm^2/mm]": value for axis, value in slope.items()},
                        **{f"slope_r{axis} [mm^2/deg]": value for axis, value in turn.items()},
                        "drawn_sd_lower [mm^2]": known[k][1, frame] * MM2,
                        "drawn_sd_upper [mm^2]": known[k][2, frame] * MM2,
                    }
                )
        return pd.DataFrame(rows)


def known_deviation(sd: Float[np.ndarray, " t"], draws: int) -> Float[np.ndarray, "3 t"]:
    """A standard deviation of so many draws, and the ends of its 95 % interval.

    (n - 1) s^2 / sigma^2 has a chi-square distribution of n - 1 degrees of freedom where areas are normal; they nearly
    are where they are linear in the pose. With 50 draws the ends are 16 % below and 25 % above.
    """
    lower, upper = (np.sqrt((draws - 1) / (2.0 * gammaincinv(0.5 * (draws - 1), end))) for end in reversed(ENDS))
    return np.stack([sd, sd * lower, sd * upper])


def agreement(cell: ErrorOfArea) -> str:
    """Whether first order and draws of one cell agree: "yes", or "no: " and why.

    They do not where contact appears or vanishes in some draws, where their standard deviations differ by more than
    `ALIKE` of the larger one and the chance of so many draws, or the mean of the draws is off the area by more than
    `SHIFTED` of it and their chance.
    """
    without = float((cell.drawn <= 0.0).mean())
    if 0.0 < without < 1.0:
        what = "vanishes" if cell.nominal > 0.0 else "appears"
        return f"no: contact {what} in {without if cell.nominal > 0.0 else 1.0 - without:.0%} of the draws"
    sd, n = float(cell.drawn.std(ddof=1)), len(cell.drawn)
    larger = max(sd, cell.first_order)
    if abs(cell.first_order - sd) > (ALIKE + CHANCE / np.sqrt(2.0 * (n - 1))) * larger:
        return "no: the area is not linear in the pose over these errors"
    if abs(float(cell.drawn.mean()) - cell.nominal) > (SHIFTED + CHANCE / np.sqrt(n)) * larger:
        return "no: the mean of the draws is off the area"
    return "yes"


def area_uncertainty(
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    settings: Settings,
    evolution: AreaEvolution,
    error: PoseError,
    workers: int | None,
    step: Callable[[], None],
) -> AreaUncertainty:
    """The area with the error of the poses in every frame and at every threshold.

    The same draws serve all frames, as of one constant error.

    Parameters
    ----------
    moving, fixed, motion, settings
        The two bodies [m], poses of MOVING in FIXED, thresholds and faces that count.
    evolution
        Areas of the same, which intervals are about.
    error
        By which the poses may be off.
    workers
        Threads; all cores unless stated. The figures do not depend on it.
    step
        Called after each frame.
    """
    fields = [RepeatedArea(fixed, moving, t, settings.fixed_faces) for t in settings.thresholds]
    rotation = motion.poses.rotation.as_matrix().reshape(-1, 3, 3)
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    rows = []
    for r, t in zip(rotation, translation, strict=True):
        rows.append(tuple(error_of_area(field, error, r, t, workers) for field in fields))
        step()
    return AreaUncertainty(error, evolution.fixed.area, tuple(rows))
