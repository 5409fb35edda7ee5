"""A design as `design.json` holds it, and its stroke in words."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from geocontact.analyses.misalignment.design.designed import Designed
from geocontact.analyses.misalignment.design.tables import sensitivity_table
from geocontact.analyses.misalignment.planar_words import STATES, WITHOUT_FORCE, rounded
from geocontact.axis_misalignment.compensation import Compensation
from geocontact.axis_misalignment.design import NeededStroke

MM = 1e3


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
