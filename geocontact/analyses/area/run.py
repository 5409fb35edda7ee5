"""Contact areas of two bodies over their motions, with pressures and comparisons where they are asked for."""

from __future__ import annotations

import numpy as np
import pandas as pd

from geocontact.analyses.area.apart import (
    least_distance,
    refuse_strangers,
    warn_of_lift_off,
    warn_of_no_contact,
    warn_of_overlap,
)
from geocontact.analyses.area.closed_surfaces import say_inner_area
from geocontact.analyses.area.congruence.along import congruence_evolution
from geocontact.analyses.area.motion_result import MotionResult
from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.page import FRAMES
from geocontact.analyses.area.pose_error.along import ENDS, AreaUncertainty, area_uncertainty
from geocontact.analyses.area.pressure.along import pressure_evolution
from geocontact.analyses.area.read import Bodies
from geocontact.analyses.area.reference_areas import Reference, compared, largest_difference
from geocontact.analyses.area.result import AreaResult
from geocontact.analyses.run_record import Record
from geocontact.data.evolution import MM2, AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import FrameContact, Settings, area_evolution
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.contact_area.rules import REFINED
from geocontact.geometry.contact_area.warm_up import warm_up


def run(bodies: Bodies, o: AreaOptions, record: Record) -> AreaResult:
    """Every motion after the other."""
    with record.listener.preparing():
        warm_up()
    shared = tuple(record.warnings)
    motions = tuple(_over(record, bodies, o, name, motion, shared) for name, motion in bodies.motions)
    return AreaResult(record=record, options=o, bodies=bodies, motions=motions)


def _over(
    record: Record, bodies: Bodies, o: AreaOptions, name: str, motion: Motion, shared: tuple[str, ...]
) -> MotionResult:
    """One motion; `shared` are the reservations that hold for all of them."""
    before = len(record.warnings)
    evolution, maps = _evaluated(record, bodies, o, name, motion)
    pressure = pressure_evolution(record, bodies, o, name, motion, maps.frames) if o.pressure else None
    say_inner_area(record, bodies, o, name, motion, evolution)
    comparison = None if bodies.reference is None else _compared(record, evolution, bodies.reference)
    uncertainty = _uncertain(record, bodies, o, name, motion, evolution)
    alike = None if o.congruence is None else congruence_evolution(record, bodies, o.congruence, name, motion)
    reservations = (*shared, *record.warnings[before:])
    return MotionResult(name, motion, evolution, maps, pressure, comparison, uncertainty, alike, reservations)


def _evaluated(
    record: Record, bodies: Bodies, o: AreaOptions, name: str, motion: Motion
) -> tuple[AreaEvolution, DistanceMaps]:
    every = 1 if o.save_map or o.paraview else -(-len(motion) // FRAMES)
    maps = DistanceMaps(bodies.moving, bodies.fixed, every)
    with record.listener.progress(name or "frames", len(motion)) as step:

        def each(frame: int, contact: FrameContact) -> None:
            maps.add(frame, contact)
            step()

        evolution = area_evolution(bodies.moving, bodies.fixed, motion, bodies.settings, o.workers, each)
    refuse_strangers(evolution, motion, o)
    warn_of_no_contact(record, evolution, motion, name)
    warn_of_lift_off(record, evolution, motion, name)
    warn_of_overlap(record, evolution, motion, name)
    _warn_of_doubts(record, evolution, bodies.settings, o.bounds is not None)
    _summarise(record, evolution, name)
    record.say(least_distance(evolution, motion, name))
    return evolution, maps


def _uncertain(
    record: Record, bodies: Bodies, o: AreaOptions, name: str, motion: Motion, evolution: AreaEvolution
) -> AreaUncertainty | None:
    if bodies.error is None:
        return None
    with record.listener.progress(f"{name or 'frames'}, error of the pose", len(motion)) as step:
        found = area_uncertainty(
            bodies.moving, bodies.fixed, motion, bodies.settings, evolution, bodies.error, o.workers, step
        )
    summary: dict[str, object] = {}
    record.results[f"{name} pose_error".lstrip()] = summary
    for k, threshold in enumerate(evolution.thresholds):
        lower, upper = found.interval(k) * MM2
        odd = sum(found.verdict(frame, k) != "yes" for frame in range(len(motion)))
        peak = np.quantile(found.drawn(k).max(axis=0), ENDS) * MM2
        known = found.deviation(k) * MM2
        worst = int(np.argmax(known[0]))
        summary[f"at_{threshold * 1e3:g}_mm"] = {
            "draws": len(bodies.error.draws),
            "widest_interval_mm2": round(float((upper - lower).max()), 3),
            "largest_area_ci95_mm2": [round(float(end), 3) for end in peak],
            "largest_sd_mm2": round(float(known[0, worst]), 3),
            "largest_sd_ci95_mm2": [round(float(end), 3) for end in known[1:, worst]],
            "frames_where_first_order_disagrees": odd,
        }
        record.say(
            f"error of the pose: largest area within {threshold * 1e3:g} mm is {peak[0]:.1f} … {peak[1]:.1f} mm^2 "
            f"(95 %); first order agrees with the draws in {len(motion) - odd} of {len(motion)} frames"
        )
        record.say(
            f"largest standard deviation of the area {known[0, worst]:.3g} mm^2, in frame {worst + 1} of "
            f"{len(motion)}: {len(bodies.error.draws)} draws know it to "
            f"{known[1, worst]:.3g} … {known[2, worst]:.3g} mm^2 (95 %)"
        )
        if odd:
            record.warn(
                f"first order and draws of the pose disagree in {odd} frames at {threshold * 1e3:g} mm: "
                "trust the draws there (column agree of pose_error.csv)"
            )
    return found


def _warn_of_doubts(record: Record, e: AreaEvolution, settings: Settings, asked: bool) -> None:
    if e.undecided.any():
        worst = int(e.undecided.max())
        record.warn(f"up to {worst} points per frame have no side (winding number near 0.5); they count as outside")
    wanted = settings.refinement.bounds
    if settings.rule == REFINED or asked:
        for side, name in ((e.fixed, "area_fixed"), (e.moving, "area_moving")):
            with np.errstate(invalid="ignore"):
                width = np.nan_to_num((side.upper - side.lower) / side.upper)
            if (width > wanted).any():
                line = f"bounds of {name} stay {width.max():.1%} apart in the worst frame; asked for {wanted:.1%}"
                record.warn(line if asked else f"{line} (`bounds` {wanted:.0%} divides triangles longer)")


def _summarise(record: Record, e: AreaEvolution, name: str) -> None:
    lines: dict[str, object] = {
        "frames": len(e.time),
        "signed": e.signed,
        "min_distance_mm": round(float(e.min_distance.min()) * 1e3, 6),
    }
    for k, threshold in enumerate(e.thresholds):
        areas = e.fixed.area[:, k] * 1e6
        lines[f"area_fixed_mm2_at_{threshold * 1e3:g}_mm"] = [
            round(float(areas.min()), 3),
            round(float(areas.max()), 3),
        ]
        label = f"{name}: " if name else ""
        record.say(f"{label}area of FIXED within {threshold * 1e3:g} mm: {areas.min():.1f} … {areas.max():.1f} mm^2")
    record.results[name or "motion"] = lines


def _compared(record: Record, evolution: AreaEvolution, reference: Reference) -> pd.DataFrame:
    rows = compared(evolution.table(), reference.table, reference.path)
    worst = largest_difference(rows)
    record.say(rows.to_string(index=False, max_rows=40))
    verdict = "within" if reference.accepts(rows) else "beyond"
    record.say(f"largest relative difference {worst:.2%}, {verdict} the tolerance of {reference.tolerance:.2%}")
    return rows
