"""Error of the poses carried into the area: what is typed of it, draws, first order, table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.frame import quantities
from geocontact.data.errors import InputError
from geocontact.data.evolution import MM, MM2, AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.pose_error import ErrorOfArea, PoseError, error_of_area
from geocontact.geometry.contact_area.repeated import RepeatedArea
from geocontact.geometry.surface import Surface
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.units import ANGLE, LENGTH


def pose_sd(text: str, option: str) -> tuple[float, ...]:
    """ "t=0.5,r=1" or "tx=0.5,rz=2" (mm, degrees) to three lengths [m] and three angles [rad]; 0 where not named."""
    names, found = ("tx", "ty", "tz", "rx", "ry", "rz"), dict[str, float]()
    for part in text.split(","):
        name, _, value = (piece.strip() for piece in part.partition("="))
        meant = [each for each in names if each == name or each[0] == name]
        if not meant or not value or any(each in found for each in meant):
            raise InputError("", option, f"{part.strip()!r} is no standard deviation", f"write {option} t=0.5,r=1")
        size = quantities.number(value, option, "t=0.5,r=1")
        found |= {each: size * (LENGTH["mm"] if each[0] == "t" else ANGLE["deg"]) for each in meant}
    if min(found.values()) < 0.0:
        raise InputError("", option, f"{text!r} is negative", "a standard deviation is not")
    return tuple(found.get(each, 0.0) for each in names)


DRAWS, SEED = 400, 1
ENDS = (0.025, 0.975)
NORMAL = 1.959963984540054
"""97.5 % quantile of the normal distribution."""
ALIKE = 0.1
"""Share by which the two standard deviations may differ, beside the chance of the draws."""
SHIFTED = 0.25
"""Standard deviations that the mean of the draws may be off the area itself, beside their chance."""
CHANCE = 3.0
"""Standard errors of the draws that are their chance: the same draws serve all frames, and all would disagree."""
COLUMNS = ["x [m]", "y [m]", "z [m]"]


@dataclass(frozen=True, eq=False)
class AreaUncertainty:
    """Over frames (t) and thresholds (k), as in the evolution; each cell is what `error_of_area` finds.

    area (t, k) is the reported area [m^2], which intervals are about.
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


def known_deviation(sd: Float[np.ndarray, " t"], draws: int) -> Float[np.ndarray, "3 t"]:
    """A standard deviation of so many draws, and the ends of its 95 % interval.

    (n - 1) s^2 / sigma^2 has a chi-square distribution of n - 1 degrees of freedom where areas are normal; they nearly
    are where they are linear in the pose. With 50 draws the ends are 16 % below and 25 % above.
    """
    from scipy.stats import chi2  # late: half a second

    lower, upper = (np.sqrt((draws - 1) / chi2.ppf(end, draws - 1)) for end in reversed(ENDS))
    return np.stack([sd, sd * lower, sd * upper])


def agreement(cell: ErrorOfArea) -> str:
    """Whether first order and draws agree, or why not."""
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


def pose_error_of(o: AreaOptions) -> PoseError | None:
    """The error that the options describe; None where they describe none."""
    draws, seed = o.draws or DRAWS, SEED if o.seed is None else o.seed
    if o.pose_sd is not None:
        return PoseError.normal(np.asarray(o.pose_sd), o.pose_axes or "fixed", draws, seed)
    if o.markers is None or o.marker_sd is None:
        return None
    table = read_side_table(o.markers, COLUMNS)
    if missing := [name for name in COLUMNS if name not in table.columns]:
        raise InputError(o.markers, "line 1", f"no column {', '.join(missing)}", "write x [mm], y [mm], z [mm]")
    try:
        return PoseError.of_markers(table[COLUMNS].to_numpy(float), o.marker_sd, draws, seed)
    except ValueError as error:
        raise InputError(o.markers, "", str(error), "give the markers in MOVING's frame") from error


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
    """Every frame and threshold; the same draws in all frames, as of one constant error; calls `step` after each."""
    fields = [RepeatedArea(fixed, moving, t, settings.fixed_faces) for t in settings.thresholds]
    rotation = motion.poses.rotation.as_matrix().reshape(-1, 3, 3)
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    rows = []
    for r, t in zip(rotation, translation, strict=True):
        rows.append(tuple(error_of_area(field, error, r, t, workers) for field in fields))
        step()
    return AreaUncertainty(error, evolution.fixed.area, tuple(rows))


def uncertainty_table(time: Float[np.ndarray, " t"], thresholds: tuple[float, ...], u: AreaUncertainty) -> pd.DataFrame:
    """A row per frame and threshold, as in `area`."""
    rows = []
    ends = [u.interval(k) for k in range(len(thresholds))]
    known = [u.deviation(k) for k in range(len(thresholds))]
    for frame, row in enumerate(u.cells):
        for k, cell in enumerate(row):
            area, sd = u.area[frame, k] * MM2, cell.first_order * MM2
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
                    "agree": u.verdict(frame, k),
                    **{f"slope_t{axis} [mm^2/mm]": value for axis, value in slope.items()},
                    **{f"slope_r{axis} [mm^2/deg]": value for axis, value in turn.items()},
                    "drawn_sd_lower [mm^2]": known[k][1, frame] * MM2,
                    "drawn_sd_upper [mm^2]": known[k][2, frame] * MM2,
                }
            )
    return pd.DataFrame(rows)
