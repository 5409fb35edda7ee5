"""Which offsets and strokes keep a force under its limit: everything found for one exoskeleton."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.design.options import DesignOptions
from geocontact.axis_misalignment.axis_drift import AxisDrift
from geocontact.axis_misalignment.compensation import Compensation
from geocontact.axis_misalignment.design import (
    Boundary,
    DesignTask,
    NeededStroke,
    OffsetMap,
    Sensitivity,
    boundary,
    force_band,
    needed_stroke,
    offset_map,
    sensitivities,
)
from geocontact.axis_misalignment.planar_joint import grid
from geocontact.data.errors import InputError

MOST_POINTS = 1_000_000
SHOWN = math.radians(1.0)
"""rad; step of the force over the angle in tables and pictures."""


@dataclass(frozen=True, eq=False)
class Designed:
    """Everything found for one exoskeleton; lengths in m, angles in rad, forces in N.

    Parameters
    ----------
    ends, where
        Least and largest deflection at the offsets, and the angles where they are.
    map, axes
        Over the offsets x and y of a grid.
    boundary
        Where the limit is first exceeded in each direction.
    stroke
        That the uncertainty asks for.
    beta, force, band
        Force over the angle at the offsets, its least and its largest value within the uncertainty.
    """

    task: DesignTask
    offset: tuple[float, float]
    uncertainty: float
    ends: Float[np.ndarray, " 2"]
    where: Float[np.ndarray, " 2"]
    map: OffsetMap
    axes: tuple[Float[np.ndarray, " a"], Float[np.ndarray, " b"]]
    boundary: Boundary
    stroke: NeededStroke
    sensitivities: list[Sensitivity]
    beta: Float[np.ndarray, " m"]
    force: Float[np.ndarray, " m"]
    band: tuple[Float[np.ndarray, " m"], Float[np.ndarray, " m"]]

    @property
    def peak(self) -> float:
        """Largest |F| over the angles at the offsets [N]."""
        return float(self.task.compensation.peak(self.ends[None, :])[0])

    @property
    def keeps_limit(self) -> bool:
        """Whether |F| stays at or under the limit at the offsets."""
        return self.peak <= self.task.limit


def designed(drift: AxisDrift, o: DesignOptions) -> Designed:
    """Map, boundary, stroke and sensitivities; InputError where the offsets have no force."""
    locked = (0.0, 0.0)
    task = DesignTask(o.l, o.z, *o.range, o.limit, Compensation(o.k, *(o.stroke or locked)), drift)
    across = _across(o)
    axes = o.offset[0] + across, o.offset[1] + across
    try:
        ends, where = task.joint(*o.offset).extremes(task.start, task.stop)
        needed = needed_stroke(task, o.offset, o.uncertainty)
    except ValueError as error:
        raise InputError("", "`offset`", str(error), "give a longer link or smaller offsets") from error
    beta = grid(task.start, task.stop, SHOWN)
    return Designed(
        task=task,
        offset=o.offset,
        uncertainty=o.uncertainty,
        ends=ends,
        where=where,
        map=offset_map(task, *axes),
        axes=axes,
        boundary=boundary(task, o.offset, o.map),
        stroke=needed,
        sensitivities=sensitivities(task, *o.offset),
        beta=beta,
        force=task.compensation.force(task.joint(*o.offset).deflection(beta)),
        band=force_band(task, o.offset, o.uncertainty, beta),
    )


def _across(o: DesignOptions) -> Float[np.ndarray, " n"]:
    """Distances from the offsets along each axis of the map."""
    count = math.ceil(o.map / o.step - 1e-9)
    if (2 * count + 1) ** 2 > MOST_POINTS:
        what = f"{o.step * 1e3:g} mm makes {(2 * count + 1) ** 2} points"
        raise InputError("", "`step`", what, "give a larger step")
    return np.linspace(-o.map, o.map, 2 * count + 1)
