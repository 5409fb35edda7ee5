"""Offsets and strokes that keep a limit: what is read and found, tables, design.json."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.misalignment.design.options import DesignOptions
from geocontact.analyses.misalignment.planar import STATES, WITHOUT_FORCE, axis_drift, rounded
from geocontact.axis_misalignment.axis_drift import AxisDrift
from geocontact.axis_misalignment.compensation import Compensation, needed_ends
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


def read(o: DesignOptions) -> AxisDrift:
    """How the joint's axis drifts."""
    return axis_drift(o.drift, o.range)


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


MM = 1e3
PER_SI = {"k": 1.0}
UNITS = {"k": "N/m"}


def map_table(d: Designed) -> pd.DataFrame:
    """Offsets of the map: largest |F|, deflection, the stroke each asks for; empty cells for a pole or a fold."""
    least, largest = d.map.extremes.T
    lower, upper = needed_ends(d.map.extremes, d.task.slack).T
    columns = {
        "x [mm]": d.map.offsets[:, 0] * MM,
        "y [mm]": d.map.offsets[:, 1] * MM,
        "peak_force [N]": d.map.peak,
        "admissible": np.where(d.map.peak <= d.task.limit, "yes", "no"),
        "least_deflection [mm]": least * MM,
        "largest_deflection [mm]": largest * MM,
        "lower_end_at_most [mm]": lower * MM,
        "upper_end_at_least [mm]": upper * MM,
        "stroke [mm]": np.maximum(upper - lower, 0.0) * MM,
        "state": [STATES[int(fate)] for fate in d.map.fate],
    }
    return pd.DataFrame(columns)


def boundary_table(d: Designed) -> pd.DataFrame:
    """Where the limit is first exceeded in each direction from the offsets."""
    b = d.boundary
    columns = {
        "direction [deg]": np.degrees(b.angles),
        "distance [mm]": b.distances * MM,
        "x [mm]": (d.offset[0] + b.distances * np.cos(b.angles)) * MM,
        "y [mm]": (d.offset[1] + b.distances * np.sin(b.angles)) * MM,
        "passed": np.where(b.distances < b.most, "yes", "no"),
    }
    return pd.DataFrame(columns)


def sensitivity_table(d: Designed) -> pd.DataFrame:
    """Slopes in N per N/m or per mm, and elasticities."""
    rows = [
        {
            "number": one.name,
            "unit": UNITS.get(one.name, "mm"),
            "value": one.value * PER_SI.get(one.name, MM),
            "peak_slope": one.peak_slope / PER_SI.get(one.name, MM),
            "rms_slope": one.rms_slope / PER_SI.get(one.name, MM),
            "peak_elasticity": one.peak_elasticity,
            "rms_elasticity": one.rms_elasticity,
        }
        for one in d.sensitivities
    ]
    return pd.DataFrame(rows)


def force_table(d: Designed) -> pd.DataFrame:
    """Force over the angle at the offsets, and the band of all offsets within the uncertainty."""
    columns = {
        "beta [deg]": np.degrees(d.beta),
        "force [N]": d.force,
        "lowest [N]": d.band[0],
        "highest [N]": d.band[1],
    }
    return pd.DataFrame(columns)


def described(d: Designed) -> dict[str, Any]:
    """What was asked for and found, with units in the keys."""
    task, c = d.task, d.task.compensation
    content: dict[str, Any] = {
        "limit_N": task.limit,
        "k_N_per_m": c.stiffness,
        "l_mm": task.length * MM,
        "z_mm": task.distance * MM,
        "range_deg": [math.degrees(task.start), math.degrees(task.stop)],
        "stroke_mm": [c.lower * MM, c.upper * MM],
        "offset": _offset(d),
        "admissible_radius": _radius(d),
        "needed_stroke": _stroke(d),
        "map": {
            "offsets": len(d.map.peak),
            "admissible": int((d.map.peak <= task.limit).sum()),
            **{STATES[fate]: int((d.map.fate == fate).sum()) for fate in WITHOUT_FORCE},
        },
        "sensitivity": sensitivity_table(d).to_dict(orient="records"),
    }
    told: dict[str, Any] = rounded(content)
    return told


def _offset(d: Designed) -> dict[str, Any]:
    forces = d.task.compensation.force(d.ends)
    worst = int(np.argmax(np.abs(forces)))
    return {
        "x_mm": d.offset[0] * MM,
        "y_mm": d.offset[1] * MM,
        "peak_N": float(np.abs(forces[worst])),
        "peak_at_deg": math.degrees(d.where[worst]),
        "least_deflection_mm": float(d.ends[0]) * MM,
        "largest_deflection_mm": float(d.ends[1]) * MM,
        "admissible": d.keeps_limit,
        "limit": "kept" if d.keeps_limit else "exceeded",
    }


def _radius(d: Designed) -> dict[str, Any]:
    way = d.boundary.angles[int(np.argmin(d.boundary.distances))]
    steps = math.cos(way), math.sin(way)
    within = bool(d.boundary.least < d.boundary.most)
    first = [(start + d.boundary.least * step) * MM for start, step in zip(d.offset, steps, strict=True)]
    return {
        "radius_mm": d.boundary.least * MM,
        "exceeded_within_map": within,
        "exceeded_first_at_mm": first,
        "passed_within_map": within,  # two names of version 0.1, which stay for one more
        "passed_first_at_mm": first,
    }


def _stroke(d: Designed) -> dict[str, Any]:
    c, needed = d.task.compensation, d.stroke
    return {
        "uncertainty_mm": d.uncertainty * MM,
        "free_of_force_mm": [needed.least * MM, needed.largest * MM],
        "lower_end_at_most_mm": needed.lower * MM,
        "upper_end_at_least_mm": needed.upper * MM,
        "length_mm": needed.length * MM,
        "lower_end_to_be_decreased_by_mm": max(c.lower - needed.lower, 0.0) * MM,
        "upper_end_to_be_increased_by_mm": max(needed.upper - c.upper, 0.0) * MM,
        "words": stroke_words(c, needed),
    }


def stroke_words(c: Compensation, needed: NeededStroke) -> str:
    """What the stroke ends would have to be, and by how much those given miss it."""
    lower, upper = f"{needed.lower * MM:.2f} mm", f"{needed.upper * MM:.2f} mm"
    if needed.length == 0.0:
        said = f"no stroke is needed, a joint locked anywhere from {needed.upper * MM:.2f} to {lower}"
    else:
        said = f"a stroke from {lower} or less to {upper} or more"
    missing = []
    if c.lower > needed.lower:
        missing.append(f"the lower end must be decreased by {(c.lower - needed.lower) * MM:.2f} mm")
    if c.upper < needed.upper:
        missing.append(f"the upper end must be increased by {(needed.upper - c.upper) * MM:.2f} mm")
    return f"{said} keeps the limit: {' and '.join(missing) or 'the one given does'}"
