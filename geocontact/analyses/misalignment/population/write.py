"""Everything that a population writes."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.misalignment.design.write import WORDS, plain, table_of
from geocontact.analyses.misalignment.population.figure import population_figure
from geocontact.analyses.misalignment.population.page import write_population_report
from geocontact.analyses.options_table import options_table
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.planar_joint import FOLD, LOST, POLE
from geocontact.axis_misalignment.population import QUANTITIES
from geocontact.cli.elbow_population import PopulationOptions
from geocontact.identify.intervals.quantile_intervals import IntervalEstimate
from geocontact.io.text.results import write_table
from geocontact.view.page.content import Table
from geocontact.view.page.tables import inputs_table

if TYPE_CHECKING:
    from geocontact.analyses.misalignment.population.run import Drawn

SHOWN = {"k": ("N/m", 1.0)}
MILLIMETRES = ("mm", 1e3)


def write_results(record: Record, d: Drawn, o: PopulationOptions, folder: Path) -> None:
    """Numbers, tables, figure, page."""
    text = json.dumps(describe(d), indent=2, ensure_ascii=False, allow_nan=False)
    (folder / "population.json").write_text(text + "\n", encoding="utf-8")
    tables = {"quantiles": quantile_table(d), "exceedance": exceedance_table(d), "influence": influence_table(d)}
    if o.keep:
        tables["samples"] = sample_table(d)
    for name, rows in tables.items():
        write_table(rows, folder, o.parquet, name)
    finite = d.peak[np.isfinite(d.peak)]
    drawing = save_both(population_figure(finite, d.levels, d.exceedance, d.limit), folder, "population")
    shown = [
        _numbers(d), table_of("Quantiles of the largest |F|", tables["quantiles"]),
        table_of("Where the spread comes from", tables["influence"]), inputs_table(record.inputs),
        options_table(record),
    ]  # fmt: skip
    title = f"Largest force of {len(d.peak)} synthetic people"
    write_population_report(
        folder / "report.html", title, d.levels, d.exceedance, d.limit, drawing, shown, record.warnings
    )


def describe(d: Drawn) -> dict[str, Any]:
    """`population.json`; null stands for infinite and for what is not known."""
    told: dict[str, Any] = plain({
        "samples": len(d.peak),
        "synthetic": True,
        "limit_N": d.limit,
        "range_deg": [math.degrees(d.exposure.start), math.degrees(d.exposure.stop)],
        "stroke_mm": [d.exposure.lower * 1e3, d.exposure.upper * 1e3],
        "above_limit": _estimate(d.beyond),
        "without_a_force": {WORDS[fate]: int((d.fate == fate).sum()) for fate in (POLE, FOLD, LOST)},
        "quantiles_N": {f"{share:g}": _estimate(one) for share, one in d.quantiles.items()},
        "grid_error_N": d.grid_error,
        "influence": influence_table(d).to_dict(orient="records"),
        "rank_regression_explains": d.regression.explained,
    })  # fmt: skip
    return told


def _estimate(one: IntervalEstimate) -> dict[str, float]:
    return {"value": one.value, "lower": one.lower, "upper": one.upper}


def quantile_table(d: Drawn) -> pd.DataFrame:
    """Quantiles with their Monte Carlo interval of 95 %; `inf` where samples without a force reach that far."""
    return pd.DataFrame([
        {"share [-]": share, "peak_force [N]": one.value, "lower [N]": one.lower, "upper [N]": one.upper}
        for share, one in d.quantiles.items()
    ])  # fmt: skip


def exceedance_table(d: Drawn) -> pd.DataFrame:
    """Probability that the largest |F| is above a force, with exact intervals of 95 %."""
    return pd.DataFrame({
        "force [N]": d.levels,
        "probability [-]": [one.value for one in d.exceedance],
        "lower [-]": [one.lower for one in d.exceedance],
        "upper [-]": [one.upper for one in d.exceedance],
    })  # fmt: skip


def influence_table(d: Drawn) -> pd.DataFrame:
    """Coefficient of each quantity's rank, and the shares of the variance of the factor that it belongs to."""
    rows = []
    factors = [k for k, factor in enumerate(d.sampling.factors) for _ in factor.names]
    r = d.regression
    for name, k, own, far in zip(d.varying, factors, r.coefficients, r.of_distance, strict=True):
        row: dict[str, object] = {
            "quantity": name, "factor": " and ".join(d.sampling.factors[k].names),
            "rank_coefficient": float(own), "distance_rank_coefficient": float(far),
        }  # fmt: skip
        for kind in ("first", "total"):
            i = d.indices
            value = (np.nan, np.nan, np.nan) if i is None else (
                float(getattr(i, kind)[k]), *map(float, getattr(i, f"{kind}_interval")[k])
            )  # fmt: skip
            row |= dict(zip((f"sobol_{kind}", f"sobol_{kind}_lower", f"sobol_{kind}_upper"), value, strict=True))
        rows.append(row)
    return pd.DataFrame(rows)


def sample_table(d: Drawn) -> pd.DataFrame:
    """Every sample."""
    columns: dict[str, object] = {}
    for k, name in enumerate(QUANTITIES):
        unit, per_si = SHOWN.get(name, MILLIMETRES)
        columns[f"{name} [{unit}]"] = d.people[:, k] * per_si
    return pd.DataFrame({**columns, "peak_force [N]": d.peak, "state": [WORDS[int(fate)] for fate in d.fate]})


def _numbers(d: Drawn) -> Table:
    b, middle, high = d.beyond, d.quantiles[0.5], d.quantiles[0.95]
    without = ", ".join(f"{int((d.fate == fate).sum())} {WORDS[fate]}" for fate in (POLE, FOLD, LOST))
    rows = [
        (f"above {d.limit:g} N", f"{b.value:.3%}", f"{b.lower:.3%} … {b.upper:.3%}, exact"),
        ("median of the largest |F|", f"{middle.value:.3f} N", f"{middle.lower:.3f} … {middle.upper:.3f} N"),
        ("95 % stay below", f"{high.value:.3f} N", f"{high.lower:.3f} … {high.upper:.3f} N"),
        ("samples without a force", str(int((d.fate > 0).sum())), f"{without}: they count as beyond every force"),
        ("error of the grid of angles", f"{d.grid_error:.1e} N", "largest of those checked with a finer one"),
    ]
    return Table("What was found", ("what", "value", "interval or note"), rows)
