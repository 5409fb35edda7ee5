"""What was identified in numbers: tables, and modulus.json."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.frame.json_file import finite, plain
from geocontact.analyses.modulus.identified import Identified, confounded
from geocontact.analyses.modulus.inputs import BOTH
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, MODULUS, SLOPE, THRESHOLD
from geocontact.elastic_modulus.identify import Identification, agreement
from geocontact.identify.identifiability import Identifiability


def modulus_table(found: Identified) -> pd.DataFrame:
    """E* of each side with its 95 % interval by profile likelihood, E for each stated Poisson's ratio, and the fit."""
    rows: list[dict[str, object]] = []
    for side, each in found.sides.items():
        profile = each.profiles[MODULUS]
        rmse, r2 = agreement(each.measured, each.predicted)
        rows.append(
            {
                "side": side,
                "E_star [Pa]": each.modulus,
                "E_star_lower [Pa]": profile.lower,
                "E_star_upper [Pa]": profile.upper,
                **{f"E at nu {nu:g} [Pa]": each.modulus * (1.0 - nu**2) for nu in found.poisson},
                "rmse [N]": rmse,
                "r2 [-]": r2,
            }
        )
    return pd.DataFrame(rows)


def curve_table(found: Identified) -> pd.DataFrame:
    """Measured and predicted force at each frame that was used, sides one after another."""
    parts = []
    for side, pair in found.curves().items():
        columns = {"measured [N]": pair.measured, "predicted [N]": pair.predicted}
        parts.append(pd.DataFrame({"time [s]": pair.time, "side": side, **columns}))
    return pd.concat(parts, ignore_index=True)


def prediction_table(found: Identified) -> pd.DataFrame:
    """The trial that was not used; empty where its force is not known."""
    parts = []
    for p in found.predictions:
        columns = {"predicted [N]": p.predicted, "measured [N]": np.nan if p.measured is None else p.measured}
        parts.append(pd.DataFrame({"time [s]": p.time, "side": p.side, **columns}))
    return pd.concat(parts, ignore_index=True)


def sensitivity_table(found: Identified) -> pd.DataFrame:
    """E* by side, reading and threshold; empty where the reading sees no contact."""
    rows = [
        {
            "side": row.side,
            "reading": row.reading,
            "threshold [mm]": row.threshold * 1e3,
            "E_star [Pa]": row.modulus if math.isfinite(row.modulus) else np.nan,
            "rmse [N]": row.rmse,
            "r2 [-]": row.r2,
        }
        for row in found.sensitivity
    ]
    return pd.DataFrame(rows)


PER_SI = {MODULUS: 1.0, THRESHOLD: 1e3, LAG: 1.0, ADDUCTION: math.degrees(1.0), SLOPE: 1.0}
UNITS = {MODULUS: "Pa", THRESHOLD: "mm", LAG: "s", ADDUCTION: "deg", SLOPE: "1/rad"}


def describe(found: Identified) -> dict[str, Any]:
    """The first side's numbers at the top, every side's under `compartments`."""
    sides = {side: _numbers(side, each, found) for side, each in found.sides.items()}
    first, head = next(iter(sides)), found.first
    content: dict[str, Any] = {
        "side": first,
        **sides[first],
        "identifiable": ["E*", *(n for n in head.fit.names if n not in {MODULUS, *confounded(head)})],
        "not_identifiable": found.not_identifiable(),
        "compartments": {side: numbers for side, numbers in sides.items() if side not in ("total", BOTH)},
        "threshold_sensitivity": [
            {key: plain(value) for key, value in row.items()}
            for row in sensitivity_table(found).to_dict(orient="records")
        ],
    }
    if found.calibration is not None:
        c = found.calibration
        content["calibration"] = {
            "threshold_mm": c.threshold * 1e3,
            "rms_relative": c.rms,
            "frames": c.frames,
            "on_end": c.on_end,
        }
    if found.predictions:
        content["prediction"] = {p.side: {"rmse_N": finite(p.rmse), "r2": finite(p.r2)} for p in found.predictions}
    return content


def _numbers(side: str, each: Identification, found: Identified) -> dict[str, Any]:
    model, star, values = each.model, each.profiles[MODULUS], dict(each.fit.values)
    rmse, r2 = agreement(each.measured, each.predicted)
    radius, count, sticks = model.evolution.radius, found.frames_once(side), model.adhesion
    return {
        "E_star_Pa": each.modulus,
        "E_star_ci95_Pa": [star.lower, star.upper],
        "E_Pa": {f"{nu:g}": each.modulus * (1.0 - nu**2) for nu in found.poisson},
        "E_ci95_Pa": {f"{nu:g}": [end * (1.0 - nu**2) for end in (star.lower, star.upper)] for nu in found.poisson},
        "reading": model.reading.name,
        "reading_words": model.reading.words,
        **({} if sticks is None else {"adhesion": sticks.law, "work_of_adhesion_J_per_m2": sticks.work}),
        "threshold_mm": values.get(THRESHOLD, model.threshold) * 1e3,
        "radius_mm": [float(radius.min()) * 1e3, float(radius.max()) * 1e3],
        "lag_s": values.get(LAG, model.taken),
        **({"adduction_deg": math.degrees(values[ADDUCTION])} if ADDUCTION in values else {}),
        **({"slope_per_rad": values[SLOPE]} if SLOPE in values else {}),
        "rmse_N": rmse,
        "r2": finite(r2),
        "frames": count,
        "window_s": [float(model.frames[0]), float(model.frames[count - 1])],
        "intervals": _intervals(each),
        "residual_correlation_time_s": each.memory.typical,
        "bootstrap": _bootstrap(each),
        "starts": {"count": len(each.fit.costs), "costs": list(each.fit.costs)},
        "identifiability": {name: _group(group) for name, group in each.told_apart.items()},
    }


def _intervals(each: Identification) -> dict[str, Any]:
    """Intervals of every free number, by profile likelihood and by block bootstrap."""
    drawn, found = each.replicates, {}
    for k, (name, p) in enumerate(each.profiles.items()):
        ends = None if drawn is None else [float(end[k]) * PER_SI[name] for end in (drawn.lower, drawn.upper)]
        found[name] = {
            "unit": UNITS[name],
            "value": p.best * PER_SI[name],
            "profile_likelihood": [p.lower * PER_SI[name], p.upper * PER_SI[name]],
            "open": [p.lower_open, p.upper_open],
            "block_bootstrap": ends,
        }
    return found


def _bootstrap(each: Identification) -> dict[str, Any] | None:
    drawn = each.replicates
    if drawn is None:
        return None
    return {"replicates": len(drawn.estimates), "block_s": drawn.block, "blocks": drawn.blocks}


def _group(group: Identifiability) -> dict[str, Any]:
    return {
        "numbers": list(group.names),
        "singular_values": group.singular_values.tolist(),
        "condition": finite(group.condition),
        "correlation": group.correlation.tolist(),
        "verdict": group.verdict,
    }
