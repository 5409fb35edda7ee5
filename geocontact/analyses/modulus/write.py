"""Everything an identification writes."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.json_file import finite, plain
from geocontact.analyses.modulus.figure import ForcePair, modulus_figure
from geocontact.analyses.modulus.inputs import BOTH, HALVES
from geocontact.analyses.modulus.page import write_modulus_report
from geocontact.analyses.options_table import options_table
from geocontact.analyses.run_record import Record
from geocontact.cli.modulus import ModulusOptions
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, MODULUS, SLOPE, THRESHOLD
from geocontact.elastic_modulus.identify import Identification, agreement
from geocontact.identify.identifiability import Identifiability
from geocontact.io.text.results import write_table
from geocontact.view.page.content import Table
from geocontact.view.page.tables import frame_table, inputs_table

if TYPE_CHECKING:
    from geocontact.analyses.modulus.run import Identified

ONE_NUMBER = "E and nu are one number here: area and force tell E* = E/(1 - nu^2) only, and E for a stated nu"
RADIUS = "E* and a constant R are one number as well, E*/R: the radius is an input, not a result"
RADII = "of R the forces tell only how it changes with flexion (slope): its size at 0 degrees is one number with E*"
PER_SI = {MODULUS: 1.0, THRESHOLD: 1e3, LAG: 1.0, ADDUCTION: math.degrees(1.0), SLOPE: 1.0}
UNITS = {MODULUS: "Pa", THRESHOLD: "mm", LAG: "s", ADDUCTION: "deg", SLOPE: "1/rad"}


def write_results(record: Record, found: Identified, o: ModulusOptions, folder: Path) -> None:
    """Numbers, tables, figure, page."""
    text = json.dumps(describe(found), indent=2, ensure_ascii=False, allow_nan=False)
    (folder / "modulus.json").write_text(text + "\n", encoding="utf-8")
    write_table(curve_table(found), folder, o.parquet, "curves")
    sensitivity = sensitivity_table(found)
    write_table(sensitivity, folder, o.parquet, "sensitivity")
    if found.predictions:
        write_table(prediction_table(found), folder, o.parquet, "prediction")
    pairs = curves(found)
    profiles = {side: i.profiles[MODULUS] for side, i in found.sides.items()}
    drawing = save_both(modulus_figure(pairs, profiles), folder, "modulus")
    tables = [
        _moduli(found), _apart(found), frame_table("Threshold and reading: what E* depends on", sensitivity),
        inputs_table(record.inputs), options_table(record),
    ]  # fmt: skip
    title = f"E* from {Path(o.area[0]).name} and {Path(o.force).name}"
    write_modulus_report(
        folder / "report.html", title, pairs, drawing, tables, (ONE_NUMBER, *_lost(found)), record.warnings
    )


def describe(found: Identified) -> dict[str, Any]:
    """`modulus.json`: the first side's numbers at the top, every side's under `compartments`."""
    sides = {side: _numbers(each, found) for side, each in found.sides.items()}
    first, head = next(iter(found.sides.items()))
    content: dict[str, Any] = {
        "side": first,
        **sides[first],
        "identifiable": ["E*", *(n for n in head.fit.names if n not in {MODULUS, *_swallowed(head)})],
        "not_identifiable": [ONE_NUMBER, *_lost(found)],
        "compartments": {side: numbers for side, numbers in sides.items() if side not in ("total", BOTH)},
        "threshold_sensitivity": [
            {key: plain(value) for key, value in row.items()}
            for row in sensitivity_table(found).to_dict(orient="records")
        ],
    }
    if found.calibration is not None:
        c = found.calibration
        content["calibration"] = {
            "threshold_mm": c.threshold * 1e3, "rms_relative": c.rms, "frames": c.frames, "on_end": c.on_end,
        }  # fmt: skip
    if found.predictions:
        content["prediction"] = {p.side: {"rmse_N": finite(p.rmse), "r2": finite(p.r2)} for p in found.predictions}
    return content


def _lost(found: Identified) -> list[str]:
    """Whether E* and R are one number depends on the reading, whether E* and a free number are, on the data."""
    each = next(iter(found.sides.values()))
    lines = [f"E* and {name} are one number here: {name} is not identifiable" for name in _swallowed(each)]
    if each.told_apart["E*, R"].verdict != "one number":
        return lines
    return [RADIUS, *([RADII] if SLOPE in each.fit.names else []), *lines]


def _swallowed(each: Identification) -> list[str]:
    """Free numbers that change nothing, or nothing that E* does not change alike."""
    groups = {name: each.told_apart.get(f"E*, {name}") for name in each.fit.names if name != MODULUS}
    return [name for name, group in groups.items() if group is None or group.verdict == "one number"]


def _numbers(each: Identification, found: Identified) -> dict[str, Any]:
    model = each.model
    values = dict(each.fit.values)
    rmse, r2 = agreement(each.measured, each.predicted)
    radius = model.evolution.radius
    star, drawn = each.profiles[MODULUS], each.replicates
    return {
        "E_star_Pa": each.modulus,
        "E_star_ci95_Pa": [star.lower, star.upper],
        "E_Pa": {f"{nu:g}": each.modulus * (1.0 - nu**2) for nu in found.poisson},
        "E_ci95_Pa": {f"{nu:g}": [end * (1.0 - nu**2) for end in (star.lower, star.upper)] for nu in found.poisson},
        "reading": model.reading.name,
        "reading_words": model.reading.words,
        "threshold_mm": values.get(THRESHOLD, model.threshold) * 1e3,
        "radius_mm": [float(radius.min()) * 1e3, float(radius.max()) * 1e3],
        "lag_s": values.get(LAG, model.taken),
        **({"adduction_deg": math.degrees(values[ADDUCTION])} if ADDUCTION in values else {}),
        **({"slope_per_rad": values[SLOPE]} if SLOPE in values else {}),
        "rmse_N": rmse,
        "r2": finite(r2),
        "frames": _once(found, each),
        "window_s": [float(model.frames[0]), float(model.frames[_once(found, each) - 1])],
        "intervals": {
            name: {
                "unit": UNITS[name],
                "value": p.best * PER_SI[name],
                "profile_likelihood": [p.lower * PER_SI[name], p.upper * PER_SI[name]],
                "open": [p.lower_open, p.upper_open],
                "block_bootstrap": None if drawn is None else [
                    float(end[k]) * PER_SI[name] for end in (drawn.lower, drawn.upper)
                ],
            }
            for k, (name, p) in enumerate(each.profiles.items())
        },
        "residual_correlation_time_s": each.memory.typical,
        "bootstrap": None if drawn is None else {
            "replicates": len(drawn.estimates), "block_s": drawn.block, "blocks": drawn.blocks
        },
        "starts": {"count": len(each.fit.costs), "costs": list(each.fit.costs)},
        "identifiability": {name: _apartness(group) for name, group in each.told_apart.items()},
    }  # fmt: skip


def _apartness(group: Identifiability) -> dict[str, Any]:
    return {
        "numbers": list(group.names),
        "singular_values": group.singular_values.tolist(),
        "condition": finite(group.condition),
        "correlation": group.correlation.tolist(),
        "verdict": group.verdict,
    }


def _once(found: Identified, each: Identification) -> int:
    """Frames of the motion that were used; both halves have the same."""
    return len(each.model.frames) // (len(HALVES) if each is found.sides.get(BOTH) else 1)


def curves(found: Identified) -> dict[str, ForcePair]:
    """Measured and predicted force by side; both halves, where they were met at once, each for itself."""
    shown = {}
    for side, each in found.sides.items():
        count = _once(found, each)
        time = each.model.frames[:count]
        for k, name in enumerate(HALVES if side == BOTH else (side,)):
            part = slice(k * count, (k + 1) * count)
            shown[name] = ForcePair(time, each.measured[part], each.predicted[part])
    return shown


def curve_table(found: Identified) -> pd.DataFrame:
    """Measured and predicted force at each frame that was used, sides one after another."""
    parts = [
        pd.DataFrame({
            "time [s]": pair.time, "side": side, "measured [N]": pair.measured, "predicted [N]": pair.predicted,
        })
        for side, pair in curves(found).items()
    ]  # fmt: skip
    return pd.concat(parts, ignore_index=True)


def prediction_table(found: Identified) -> pd.DataFrame:
    """The trial that was not used; empty where its force is not known."""
    parts = [
        pd.DataFrame({
            "time [s]": p.time, "side": p.side, "predicted [N]": p.predicted,
            "measured [N]": np.nan if p.measured is None else p.measured,
        })
        for p in found.predictions
    ]  # fmt: skip
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


def _moduli(found: Identified) -> Table:
    header = ("side", "number", "value", "profile likelihood, 95 %", "block bootstrap, 95 %", "RMSE [N]", "R²")
    rows = []
    for side, each in found.sides.items():
        rmse, r2 = agreement(each.measured, each.predicted)
        for k, (name, p) in enumerate(each.profiles.items()):
            per, unit = (1e-6, "MPa") if name == MODULUS else (PER_SI[name], UNITS[name])
            drawn = each.replicates
            ends = None if drawn is None else (float(drawn.lower[k]), float(drawn.upper[k]))
            label = "E*" if name == MODULUS else name
            rows.append((
                side, label, f"{p.best * per:.4g} {unit}", f"{p.lower * per:.4g} … {p.upper * per:.4g}",
                "" if ends is None else f"{ends[0] * per:.4g} … {ends[1] * per:.4g}", f"{rmse:.0f}", f"{r2:.2f}",
            ))  # fmt: skip
        rows += [
            (side, f"E for ν = {nu:g}", f"{each.modulus * (1.0 - nu**2) * 1e-6:.4g} MPa", "", "", "", "")
            for nu in found.poisson
        ]
    return Table("What was identified", header, rows)


def _apart(found: Identified) -> Table:
    header = ("side", "numbers", "singular values", "condition", "correlation", "verdict")
    rows = [
        (side, ", ".join(g.names), ", ".join(f"{v:.3g}" for v in g.singular_values), _condition(g.condition),
         f"{g.correlation[0, 1]:.4f}" if len(g.names) == 2 else "see modulus.json", g.verdict)
        for side, each in found.sides.items() for g in each.told_apart.values()
    ]  # fmt: skip
    return Table("What the data tell apart", header, rows)


def _condition(value: float) -> str:
    return f"{value:.3g}" if math.isfinite(value) else "infinite"
