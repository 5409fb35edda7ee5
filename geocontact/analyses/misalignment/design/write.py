"""Everything a design writes."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.misalignment.design.figure import design_figure
from geocontact.analyses.misalignment.design.page import write_design_report
from geocontact.analyses.options_table import options_table
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.compensation import Compensation, needed_ends
from geocontact.axis_misalignment.design import NeededStroke
from geocontact.axis_misalignment.planar_joint import FOLD, LOST, POLE, SOUND
from geocontact.cli.elbow_design import DesignOptions
from geocontact.io.text.results import write_table
from geocontact.view.page.content import Table
from geocontact.view.page.tables import inputs_table

if TYPE_CHECKING:
    from geocontact.analyses.misalignment.design.run import Designed

MM = 1e3
DIGITS = 9
"""Decimals of a number in the JSON: nanometres where it is in mm."""
WORDS = {SOUND: "ok", POLE: "pole", FOLD: "fold", LOST: "lost"}
PER_SI = {"k": 1.0}
UNITS = {"k": "N/m"}


def write_results(record: Record, d: Designed, o: DesignOptions, folder: Path) -> None:
    """Numbers, tables, figure, page."""
    text = json.dumps(describe(d), indent=2, ensure_ascii=False, allow_nan=False)
    (folder / "design.json").write_text(text + "\n", encoding="utf-8")
    for name, rows in (
        ("map", map_table(d)), ("boundary", boundary_table(d)), ("sensitivity", sensitivity_table(d)),
        ("force", force_table(d)),
    ):  # fmt: skip
        write_table(rows, folder, o.parquet, name)
    drawing = save_both(design_figure(d.axes, d.map.peak, d.boundary, d.offset, d.uncertainty, d.task.limit, (
        d.beta, d.force, *d.band
    )), folder, "design")  # fmt: skip
    tables = [_numbers(d), table_of("Sensitivity at these offsets", sensitivity_table(d)), inputs_table(record.inputs),
              options_table(record)]  # fmt: skip
    title = f"Offsets and stroke that keep the force under {o.limit:g} N"
    write_design_report(
        folder / "report.html", title, np.degrees(d.beta), d.force, d.band, drawing, tables,
        stroke_words(d.task.compensation, d.stroke), record.warnings,
    )  # fmt: skip


def describe(d: Designed) -> dict[str, Any]:
    """`design.json`."""
    task, c, needed = d.task, d.task.compensation, d.stroke
    forces = c.force(d.ends)
    worst = int(np.argmax(np.abs(forces)))
    first = int(np.argmin(d.boundary.distances))
    x, y = d.offset
    way = d.boundary.angles[first]
    content: dict[str, Any] = {
        "limit_N": task.limit,
        "k_N_per_m": c.stiffness,
        "l_mm": task.length * MM,
        "z_mm": task.distance * MM,
        "range_deg": [math.degrees(task.start), math.degrees(task.stop)],
        "stroke_mm": [c.lower * MM, c.upper * MM],
        "offset": {
            "x_mm": x * MM,
            "y_mm": y * MM,
            "peak_N": float(np.abs(forces[worst])),
            "peak_at_deg": math.degrees(d.where[worst]),
            "least_deflection_mm": float(d.ends[0]) * MM,
            "largest_deflection_mm": float(d.ends[1]) * MM,
            "admissible": bool(np.abs(forces[worst]) <= task.limit),
        },
        "admissible_radius": {
            "radius_mm": d.boundary.least * MM,
            "passed_within_map": bool(d.boundary.least < d.boundary.most),
            "passed_first_at_mm": [
                (x + d.boundary.least * math.cos(way)) * MM, (y + d.boundary.least * math.sin(way)) * MM
            ],
        },
        "needed_stroke": {
            "uncertainty_mm": d.uncertainty * MM,
            "free_of_force_mm": [needed.least * MM, needed.largest * MM],
            "lower_end_at_most_mm": needed.lower * MM,
            "upper_end_at_least_mm": needed.upper * MM,
            "length_mm": needed.length * MM,
            "lower_end_to_be_decreased_by_mm": max(c.lower - needed.lower, 0.0) * MM,
            "upper_end_to_be_increased_by_mm": max(needed.upper - c.upper, 0.0) * MM,
            "words": stroke_words(c, needed),
        },
        "map": {
            "offsets": len(d.map.peak),
            "admissible": int((d.map.peak <= task.limit).sum()),
            **{WORDS[fate]: int((d.map.fate == fate).sum()) for fate in (POLE, FOLD, LOST)},
        },
        "sensitivity": sensitivity_table(d).to_dict(orient="records"),
    }  # fmt: skip
    rounded: dict[str, Any] = plain(content)
    return rounded


def map_table(d: Designed) -> pd.DataFrame:
    """Offsets of the map: largest |F|, deflection, the stroke each asks for; empty cells for a pole or a fold."""
    least, largest = d.map.extremes.T
    lower, upper = needed_ends(d.map.extremes, d.task.slack).T
    return pd.DataFrame({
        "x [mm]": d.map.offsets[:, 0] * MM,
        "y [mm]": d.map.offsets[:, 1] * MM,
        "peak_force [N]": d.map.peak,
        "admissible": np.where(d.map.peak <= d.task.limit, "yes", "no"),
        "least_deflection [mm]": least * MM,
        "largest_deflection [mm]": largest * MM,
        "lower_end_at_most [mm]": lower * MM,
        "upper_end_at_least [mm]": upper * MM,
        "stroke [mm]": np.maximum(upper - lower, 0.0) * MM,
        "state": [WORDS[int(fate)] for fate in d.map.fate],
    })  # fmt: skip


def boundary_table(d: Designed) -> pd.DataFrame:
    """Where the limit is first passed in each direction from the offsets."""
    b = d.boundary
    return pd.DataFrame({
        "direction [deg]": np.degrees(b.angles),
        "distance [mm]": b.distances * MM,
        "x [mm]": (d.offset[0] + b.distances * np.cos(b.angles)) * MM,
        "y [mm]": (d.offset[1] + b.distances * np.sin(b.angles)) * MM,
        "passed": np.where(b.distances < b.most, "yes", "no"),
    })  # fmt: skip


def sensitivity_table(d: Designed) -> pd.DataFrame:
    """Slopes in N per N/m or per mm, and elasticities."""
    return pd.DataFrame([
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
    ])  # fmt: skip


def force_table(d: Designed) -> pd.DataFrame:
    """Force over the angle at the offsets, and the band of all offsets within the uncertainty."""
    return pd.DataFrame({
        "beta [deg]": np.degrees(d.beta), "force [N]": d.force, "lowest [N]": d.band[0], "highest [N]": d.band[1],
    })  # fmt: skip


def stroke_words(c: Compensation, needed: NeededStroke) -> str:
    """What the stroke ends would have to be, and by how much those given miss it."""
    if needed.length == 0.0:
        said = (
            f"no stroke is needed, a joint locked anywhere from {needed.upper * MM:.2f} to {needed.lower * MM:.2f} mm"
        )
    else:
        said = f"a stroke from {needed.lower * MM:.2f} mm or less to {needed.upper * MM:.2f} mm or more"
    missing = []
    if c.lower > needed.lower:
        missing.append(f"the lower end must be decreased by {(c.lower - needed.lower) * MM:.2f} mm")
    if c.upper < needed.upper:
        missing.append(f"the upper end must be increased by {(needed.upper - c.upper) * MM:.2f} mm")
    return f"{said} keeps the limit: {' and '.join(missing) or 'the one given does'}"


def _numbers(d: Designed) -> Table:
    told = describe(d)
    one, radius, stroke, points = told["offset"], told["admissible_radius"], told["needed_stroke"], told["map"]
    beyond = "" if radius["passed_within_map"] else " or more"
    rows = [
        ("largest |F| at these offsets", f"{one['peak_N']:.2f} N", f"at {one['peak_at_deg']:.1f}°"),
        ("limit", f"{told['limit_N']:g} N", "kept" if one["admissible"] else "passed"),
        ("offsets may go in any direction", f"{radius['radius_mm']:.2f} mm{beyond}", "robust radius"),
        ("free of force between", f"{stroke['free_of_force_mm'][0]:.2f} … {stroke['free_of_force_mm'][1]:.2f} mm",
         f"offsets within {stroke['uncertainty_mm']:g} mm"),
        ("lower stroke end at most", f"{stroke['lower_end_at_most_mm']:.2f} mm", "for the limit"),
        ("upper stroke end at least", f"{stroke['upper_end_at_least_mm']:.2f} mm", "for the limit"),
        ("offsets of the map that keep it", f"{points['admissible']} of {points['offsets']}",
         f"{points['pole']} with a pole, {points['fold']} with a fold"),
    ]  # fmt: skip
    return Table("What the limit asks for", ("what", "value", "note"), rows)


def table_of(title: str, rows: pd.DataFrame) -> Table:
    """The table with four digits, for the page."""
    texts = rows.map(lambda value: f"{value:.4g}" if isinstance(value, float) else str(value))
    return Table(title, tuple(map(str, rows.columns)), texts.to_numpy().tolist())


def plain(value: Any) -> Any:
    """The same with numbers rounded, and None for what is not finite."""
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, list):
        return [plain(each) for each in value]
    if isinstance(value, float):
        return round(value, DIGITS) if math.isfinite(value) else None
    return value
