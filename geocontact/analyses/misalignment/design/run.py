"""A design: reads, computes, writes, says what it found."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses import quantities
from geocontact.analyses.misalignment.design.write import describe, stroke_words, write_results
from geocontact.analyses.misalignment.device import above_zero, drift, link, stroke
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
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
from geocontact.axis_misalignment.planar_joint import FATES, grid
from geocontact.cli.elbow_design import DesignOptions
from geocontact.data.errors import InputError

MM = 1e3
MOST_POINTS = 1_000_000
SHOWN = math.radians(1.0)
"""rad; step of the force over the angle in tables and pictures."""


@dataclass(frozen=True, eq=False)
class Designed:
    """Everything found for one exoskeleton; lengths in m, angles in rad, forces in N."""

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


def analyse(o: DesignOptions) -> int:
    """Run the whole analysis."""
    record = Record("elbow design", asdict(o))
    with record.catching_warnings(), written_whole(o.out) as draft:
        found = _designed(record, o)
        _reserve(record, found)
        record.results["design"] = describe(found)
        write_results(record, found, o, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    _tell(record, found)
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _designed(record: Record, o: DesignOptions) -> Designed:
    task = _task(record, o)
    offset = quantities.length_pair(o.offset_mm, "--offset-mm")
    if not (math.isfinite(o.uncertainty_mm) and o.uncertainty_mm >= 0.0):
        raise InputError("", "--uncertainty-mm", f"{o.uncertainty_mm:g} is not 0 or more", "give mm")
    half = above_zero(o.map_mm, "--map-mm", "mm") / MM
    count = math.ceil(half / (above_zero(o.step_mm, "--step-mm", "mm") / MM) - 1e-9)
    if (2 * count + 1) ** 2 > MOST_POINTS:
        raise InputError("", "--step-mm", f"{o.step_mm:g} makes {(2 * count + 1) ** 2} points", "give a larger step")
    across = np.linspace(-half, half, 2 * count + 1)
    axes = offset[0] + across, offset[1] + across
    radius = o.uncertainty_mm / MM
    try:
        ends, where = task.joint(*offset).extremes(task.start, task.stop)
        needed = needed_stroke(task, offset, radius)
    except ValueError as error:
        raise InputError("", "--offset-mm", str(error), "give a longer link or smaller offsets") from error
    beta = grid(task.start, task.stop, SHOWN)
    return Designed(
        task, offset, radius, ends, where, offset_map(task, *axes), axes, boundary(task, offset, half), needed,
        sensitivities(task, *offset), beta, task.compensation.force(task.joint(*offset).deflection(beta)),
        force_band(task, offset, radius, beta),
    )  # fmt: skip


def _task(record: Record, o: DesignOptions) -> DesignTask:
    start, stop = quantities.angle_span(o.range, "--range")
    if not math.isfinite(o.z_mm):
        raise InputError("", "--z-mm", f"{o.z_mm:g} is not a finite number", "give mm")
    return DesignTask(
        link(o.l_mm), o.z_mm / MM, start, stop, above_zero(o.limit, "--limit", "N"),
        Compensation(above_zero(o.k, "--k", "N/m"), *stroke(o.stroke_mm)), drift(record, o.drift, (start, stop)),
    )  # fmt: skip


def _reserve(record: Record, d: Designed) -> None:
    for fate, words in FATES.items():
        count = int((d.map.fate == fate).sum())
        if count:
            x, y = d.map.offsets[int(np.argmax(d.map.fate == fate))] * MM
            record.warn(f"{count} of {len(d.map.fate)} offsets of the map (x = {x:g} mm, y = {y:g} mm …): {words}")
    if d.boundary.least >= d.boundary.most:
        record.warn("the limit is passed nowhere within the map: how far offsets may go is told up to its edge only")
    if np.isnan(d.sensitivities[0].peak_slope):
        record.warn("no sensitivities where there is no force: give --offset-mm that are not what is aimed at")


def _tell(record: Record, d: Designed) -> None:
    c = d.task.compensation
    peak = float(c.peak(d.ends[None, :])[0])
    state = "locked" if c.lower == c.upper == 0.0 else f"stroke {c.lower * MM:g} … {c.upper * MM:g} mm"
    x, y = d.offset[0] * MM, d.offset[1] * MM
    record.say(f"{state}, x = {x:g} mm, y = {y:g} mm: |F| up to {peak:.2f} N, limit {d.task.limit:g} N")
    record.say(f"offsets may go {d.boundary.least * MM:.2f} mm from there in any direction")
    record.say(f"offsets within {d.uncertainty * MM:g} mm: {stroke_words(c, d.stroke)}")
