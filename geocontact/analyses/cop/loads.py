"""Loads on a foot over its motion, the centre along the foot, and their tables."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.analyses.cop.foot import Foot
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.frame.result import Result
from geocontact.data.frame_blocks import blocks, parts, release, worked
from geocontact.data.motion import MATRIX
from geocontact.identify.signals.cycles import STEPS, Span, loaded_spans, normalised
from geocontact.io.text.results import frame_of
from geocontact.loads.centre_of_pressure import CentreOfPressure, FootAxis
from geocontact.loads.plate_load import PlateCurves
from geocontact.loads.sphere_set import SphereLoads


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FootLoads(Result):
    """Loads on a foot over its motion, in the frame of the ground.

    Parameters
    ----------
    foot
        Sole, law, motion and ground.
    loads
        Force of every sphere in every frame.
    centre
        Resultant, centre of pressure and free moment of every frame.
    centres
        The centre of each of `loads.centre_of_pressure.POINTS`, `centre.centre` among them.
    axis
        From the heel to the toe; None where nobody said which way the toe is.
    feet
        Resultant, centre of pressure and free moment of each foot where there are several.
    zones
        Sum of the normal forces of each zone, filtered where the forces are.
    plates
        What the force plate under each foot shows, by the foot's name.
    comparison
        The differences to it, with a column `foot` where there are several; None without a plate.
    """

    options: CopOptions
    foot: Foot
    loads: SphereLoads
    centre: CentreOfPressure
    centres: dict[str, Float[np.ndarray, "t 3"]]
    axis: FootAxis | None
    feet: dict[str, CentreOfPressure]
    zones: dict[str, Float[np.ndarray, " t"]]
    plates: dict[str, PlateCurves]
    comparison: pd.DataFrame | None

    @property
    def plate(self) -> PlateCurves | None:
        """What the plate shows where there is one foot; None without a plate and with several feet."""
        return None if self.feet else next(iter(self.plates.values()), None)


def loads_table(r: FootLoads) -> pd.DataFrame:
    """Force, centre and free moment of every frame; centre and free moment are empty below the gate."""
    c = r.centre
    vectors = {
        f"{name}_{axis} [{unit}]": values[:, k]
        for name, unit, values in (("force", "N", c.wrench.force), ("cop", "m", c.centre))
        for k, axis in enumerate("xyz")
    }
    return frame_of(
        {
            "time [s]": r.foot.motion.time,
            **vectors,
            "free_moment [N m]": c.free_moment,
            "normal [N]": c.pressing,
            "spheres [-]": worked(_touching, r.loads.depth),
            "max_depth [m]": worked(_deepest, r.loads.depth),
        }
    )


def feet_table(r: FootLoads) -> pd.DataFrame:
    """Normal force, force, centre and free moment of each foot, in columns that begin with its name."""
    columns: dict[str, Float[np.ndarray, " t"]] = {"time [s]": r.foot.motion.time}
    for name, c in r.feet.items():
        columns[f"{name} normal [N]"] = c.pressing
        for quantity, unit, values in (("force", "N", c.wrench.force), ("cop", "mm", c.centre * MM)):
            columns |= {f"{name} {quantity}_{axis} [{unit}]": values[:, k] for k, axis in enumerate("xyz")}
        columns[f"{name} free_moment [N m]"] = c.free_moment
    return frame_of(columns)


def _touching(depth: Float[np.ndarray, "t n"]) -> Int[np.ndarray, " t"]:
    return np.asarray(np.count_nonzero(depth > 0.0, axis=1))


def _deepest(depth: Float[np.ndarray, "t n"]) -> Float[np.ndarray, " t"]:
    return np.asarray(np.maximum(depth.max(axis=1), 0.0))


def mean_normal(r: FootLoads) -> Float[np.ndarray, " 3"] | None:
    """Mean of the ground's normals where they are known; None where there is no centre of pressure."""
    known, total = 0, np.zeros(3)
    for (part,) in parts(r.centre.normal):
        there = np.isfinite(part[:, 0])
        known, total = known + int(there.sum()), total + part[there].sum(axis=0)
    return total / known if known else None


def reach_of_centre(r: FootLoads) -> Float[np.ndarray, " 3"]:
    """Distance between the outermost centres of pressure along each axis of the ground [m]."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for (part,) in parts(r.centre.centre):
        low, high = np.fmin(low, np.fmin.reduce(part)), np.fmax(high, np.fmax.reduce(part))
    return np.asarray(high - low)


NAMES = {"ground": "ground_point", "sphere": "sphere_centre"}
"""Columns of the two centres, by what the normal forces weigh."""
SHARE = "_share [-]"
MM = 1e3


def along_foot(r: FootLoads) -> pd.DataFrame | None:
    """Centres of the ground points, of the sphere centres and of the plate: distance from the heel, and its share.

    None where nobody said which way the toe is.
    """
    axis, poses = r.axis, r.foot.motion.poses
    if axis is None:
        return None
    columns: dict[str, Float[np.ndarray, " t"]] = {"time [s]": r.foot.motion.time}
    centres = {NAMES[point]: centre for point, centre in r.centres.items()}
    if r.plate is not None:
        theirs = np.full_like(r.centre.centre, np.nan)
        theirs[r.plate.frames] = r.plate.centre
        centres["plate"] = theirs
    for name, centre in centres.items():
        distance = np.empty(len(centre))
        for some in blocks(len(centre), MATRIX):
            distance[some] = axis.from_heel(centre[some], poses[some])
            release()
        columns |= {f"{name} [mm]": distance * MM, f"{name}{SHARE}": axis.share(distance)}
    return frame_of(columns)


def stances(r: FootLoads) -> list[Span]:
    """Complete stances: the normal force reaches the gate and falls below it again."""
    return loaded_spans(r.foot.motion.time, r.centre.pressing, r.options.gate)


def stance_table(r: FootLoads, loads: pd.DataFrame) -> pd.DataFrame:
    """Each complete stance at 0, 1, … 100 % of its time: force, centre and free moment, and the centre in the foot.

    `loads` is the table over time. Where one of two samples has no centre there is none between them, so that the
    first and last per cent of a stance are empty.
    """
    within = along_foot(r)
    whole = loads if within is None else loads.join(within.drop(columns="time [s]"))
    whole = whole.drop(columns=["spheres [-]", "max_depth [m]"])
    metres = [str(name) for name in whole.columns if str(name).endswith(" [m]")]
    whole[metres] *= MM
    whole = whole.rename(columns={name: f"{name.removesuffix(' [m]')} [mm]" for name in metres})
    kept = [str(name) for name in whole.columns if name != "time [s]"]
    time, parts = r.foot.motion.time, []
    for number, span in enumerate(stances(r), 1):
        curves = {name: normalised(time, whole[name].to_numpy(float), span.start, span.end) for name in kept}
        times = span.start + (span.end - span.start) * STEPS / 100.0
        parts.append(pd.DataFrame({"stance [-]": number, "cycle [%]": STEPS, "time [s]": times, **curves}))
    if not parts:
        return pd.DataFrame(columns=["stance [-]", "cycle [%]", "time [s]", *kept], dtype=float)
    return pd.concat(parts, ignore_index=True)
