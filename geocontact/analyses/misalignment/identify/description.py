"""An identification as `elbow.json` holds it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from geocontact.analyses.json_file import finite
from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.analyses.misalignment.identify.free_joint import Free, stroke_stiffness
from geocontact.analyses.misalignment.identify.intervals import ShownInterval
from geocontact.analyses.misalignment.law_numbers import MMHG, with_units
from geocontact.axis_misalignment.bins import Binned
from geocontact.axis_misalignment.end_stop import EndStop
from geocontact.axis_misalignment.law import LENGTHS
from geocontact.axis_misalignment.uncertainty import Direction
from geocontact.identify.intervals.bin_tests import BinPair, BinTest


def described(found: Fitted, free: Free | None) -> dict[str, Any]:
    """Numbers, intervals, what is told and what is not, tests; units in the keys."""
    e, residuals, noise = found.estimate, found.residuals, found.data.noise
    content: dict[str, Any] = {
        "numbers": with_units(e.named),
        "free": list(e.problem.names),
        "scale_free": e.problem.scale_free,
        "ratios": ratios(e.named),
        "intervals": {each.key: _interval(each) for each in found.intervals},
        "identifiability": _directions(found),
        "r2": finite(found.r2),
        "r2_along_the_scale": [float(found.line.r2.min()), float(found.line.r2.max())],
        "r2_of_the_force_turned_over": finite(found.mirrored_r2),
        "held_out": [{"name": h.name, "r2": finite(h.r2), "rmse_N": h.rmse, "bins": h.bins} for h in found.held],
        "between_bins": _tested(found.bins_differ, found.neighbours, found.boxes),
        "residuals": {
            "p_lilliefors": residuals.normality.p,
            "in_words": residuals.normality.words,
            "over_noise": residuals.excess.ratio,
            "p_over_noise": residuals.excess.p,
        },
        "noise": {"sd_N": float(noise.sd[0]), "correlation_time_s": float(noise.tau[0])},
        "stretches": {"count": found.stretches, "length_s": found.data.stretch},
        "pressure_mmHg": found.data.pressure / MMHG if found.data.pressure else None,
        "starts": {"count": len(e.costs), "costs": list(e.costs)},
    }
    return content if free is None else {**content, "free_joint": _free_joint(found, free)}


def ratios(numbers: dict[str, float]) -> dict[str, float]:
    """What no scale changes: the force k l, and lengths over the link."""
    lengths = {f"{name}_over_l": numbers[name] / numbers["l"] for name in LENGTHS if name != "l"}
    return {"k_times_l_N": numbers["k"] * numbers["l"], **lengths}


def _interval(one: ShownInterval) -> dict[str, Any]:
    return {
        "unit": one.unit,
        "value": one.value,
        "profile_likelihood": [one.lower, one.upper],
        "parts": [list(part) for part in one.parts],
        "open": [one.lower_open, one.upper_open],
        "wild_bootstrap": None if one.drawn is None else list(one.drawn),
    }


def _directions(found: Fitted) -> dict[str, Any]:
    known = {"k_and_lengths": found.all_directions, "free": found.free_directions}
    told = {key: _direction(each) for key, each in known.items() if each is not None}
    apart = found.separable
    fixation = {"own_beside_k": apart.from_cuff, "own_beside_all_free": apart.from_all, "told_apart": apart.told}
    return {**told, "fixation_from_cuff": fixation}


def _direction(one: Direction) -> dict[str, Any]:
    return {
        "numbers": list(one.names),
        "singular_values_N": one.singular_values.tolist(),
        "told_least": one.least.tolist(),
        "flat": one.flat,
    }


def _free_joint(found: Fitted, free: Free) -> dict[str, Any]:
    s, scale, k = free.stiffness, free.scale, stroke_stiffness(found.estimate, free)
    told = None if s is None else {"value": s.value, "se": finite(s.error), "trials": s.trials, "bins": s.bins}
    return {
        "stops": [_stop(stop, k) for stop in free.stroke.stops],
        "level_while_sliding_N": free.stroke.level,
        "spread_while_sliding_N": free.stroke.spread,
        "k_by_displacement_N_per_m": told,
        "scale": None if scale is None else {"se": scale.error, "trials": scale.trials},
        "between_bins": _tested(free.bins_differ, free.neighbours, free.boxes),
    }


def _stop(stop: EndStop, stiffness: float | None) -> dict[str, Any]:
    return {
        "side": stop.side,
        "position_mm": stop.position * 1e3,
        "leaves_at_deg": math.degrees(stop.leaves),
        "from_deg": math.degrees(stop.first),
        "to_deg": math.degrees(stop.last),
        "force_N": stop.force,
        "stroke_wanting_mm": None if stiffness is None else abs(stop.force) / stiffness * 1e3,
    }


def _tested(test: BinTest | None, pairs: Sequence[BinPair], boxes: Binned) -> dict[str, Any] | None:
    if test is None:
        return None
    middle = np.degrees(boxes.centres)
    neighbours = [
        {
            "between_deg": [float(middle[k]) for k in pair.places],
            "mann_whitney": pair.statistic,
            "p": pair.p,
            "p_holm": pair.p_holm,
        }
        for pair in pairs
    ]
    return {
        "kruskal_wallis": test.statistic,
        "p": test.p,
        "bins": test.bins,
        "counted_visits": test.counted,
        "samples": test.samples,
        "neighbours": neighbours,
    }
