"""Everything that an identification at an elbow writes."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.json_file import finite
from geocontact.analyses.misalignment.figures import (
    Boxes,
    Over,
    conditions_figure,
    force_figure,
    residual_figure,
    told_figure,
)
from geocontact.analyses.misalignment.identify.intervals import Interval, intervals
from geocontact.analyses.misalignment.identify.unknowns import SCALE_WORDS
from geocontact.analyses.misalignment.pages import CONDITIONS, FORCES, RESIDUALS, TOLD, write_fit_report
from geocontact.analyses.misalignment.parameters import MMHG, PER_SI, TYPED, unit_in_key
from geocontact.analyses.options_table import options_table
from geocontact.analyses.page_words import counted
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.bins import Binned
from geocontact.axis_misalignment.end_stop import bin_means
from geocontact.axis_misalignment.law import LENGTHS, NAMES
from geocontact.axis_misalignment.least_squares import r_squared
from geocontact.axis_misalignment.residuals import residual_by_bin, standard_residuals
from geocontact.cli.elbow_fit import ElbowFitOptions
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.identify.intervals.bin_tests import LEVEL, BinPair, BinTest
from geocontact.identify.signals.angle_bins import bin_numbers
from geocontact.io.text.results import write_table
from geocontact.view.page.tables import frame_table, inputs_table

if TYPE_CHECKING:
    from geocontact.analyses.misalignment.identify.run import Fitted, Free

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)


def write_results(record: Record, found: Fitted, free: Free | None, o: ElbowFitOptions, folder: Path) -> None:
    """Numbers, tables, figures, page."""
    text = json.dumps(describe(found, free), indent=2, ensure_ascii=False, allow_nan=False)
    (folder / "elbow.json").write_text(text + "\n", encoding="utf-8")
    bins = _with_fit(spread_table(found.recordings, found.data), found)
    boxes = spread_table(found.recordings, found.boxes)
    tables = {"bins": bins, "boxes": boxes, "intervals": interval_table(found), "scale_line": line_table(found),
              "held_out": held_table(found)}  # fmt: skip
    if free is not None:
        tables["conditions"] = condition_table(found, free)
        tables["boxes_free"] = spread_table(free.recordings, free.boxes)
    for name, table in tables.items():
        write_table(table, folder, o.parquet, name)
    told_in = save_both(_told_figure(found), folder, "identifiability")
    locked_boxes = _boxes(boxes, found.boxes)
    drawings = [
        ("Force over the angle", FORCES, save_both(force_figure(_over(found), locked_boxes), folder, "forces")),
        ("What the recordings tell apart", TOLD, told_in),
        ("Residuals", RESIDUALS, save_both(_residual_figure(found), folder, "residuals")),
    ]  # fmt: skip
    if free is not None:
        free_boxes = _boxes(tables["boxes_free"], free.boxes)
        figure = conditions_figure(bin_means(found.data), free.stroke, locked_boxes, free_boxes)
        drawing = save_both(figure, folder, "conditions")
        drawings.append(("Joint locked and free", CONDITIONS, drawing))
    shown = [
        frame_table("What was identified", tables["intervals"].dropna(axis="columns", how="all")),
        frame_table("Force that was not used", tables["held_out"]),
        frame_table("Along the scale: numbers that give the same force", tables["scale_line"].iloc[::5]),
        inputs_table(record.inputs), options_table(record),
    ]  # fmt: skip
    there = bins["mean [N]"].notna()
    write_fit_report(
        folder / "report.html",
        f"Offsets and stiffness at an elbow from {counted(len(found.recordings), 'recording')}",
        np.radians(bins["beta [deg]"][there].to_numpy()),
        bins["mean [N]"][there].to_numpy(),
        bins["fitted [N]"][there].to_numpy(),
        _headline(found),
        _sentences(found, free),
        drawings,
        shown,
        record.warnings,
    )


def describe(found: Fitted, free: Free | None) -> dict[str, Any]:
    """`elbow.json`."""
    e = found.estimate
    directions = {"k_and_lengths": found.all_directions}
    if found.free_directions is not None:
        directions["free"] = found.free_directions
    content: dict[str, Any] = {
        "numbers": {f"{n}_{unit_in_key(n)}": v * PER_SI[n] for n, v in e.named.items()},
        "free": list(e.problem.names),
        "scale_free": e.problem.scale_free,
        "ratios": ratios(found),
        "intervals": {
            each.key: {
                "unit": each.unit,
                "value": each.value,
                "profile_likelihood": [each.lower, each.upper],
                "parts": [list(part) for part in each.parts],
                "open": [each.lower_open, each.upper_open],
                "wild_bootstrap": None if each.drawn is None else list(each.drawn),
            }
            for each in intervals(found)
        },
        "identifiability": {
            key: {
                "numbers": list(d.names),
                "singular_values_N": d.singular_values.tolist(),
                "told_least": d.least.tolist(),
                "flat": d.flat,
            }
            for key, d in directions.items()
        },
        "r2": finite(found.r2),
        "r2_along_the_scale": [float(found.line_r2.min()), float(found.line_r2.max())],
        "r2_of_the_force_turned_over": finite(found.mirrored_r2),
        "held_out": [{"name": h.name, "r2": finite(h.r2), "rmse_N": h.rmse, "bins": h.bins} for h in found.held],
        "between_bins": _tested(found.bins_differ, found.neighbours, found.boxes),
        "residuals": {
            "p_lilliefors": found.normality.p,
            "in_words": found.normality.words,
            "over_noise": found.excess.ratio,
            "p_over_noise": found.excess.p,
        },
        "noise": {"sd_N": float(found.data.noise.sd[0]), "correlation_time_s": float(found.data.noise.tau[0])},
        "stretches": {"count": found.stretches, "length_s": found.data.stretch},
        "pressure_mmHg": found.data.pressure / MMHG if found.data.pressure else None,
        "starts": {"count": len(e.costs), "costs": list(e.costs)},
    }
    if free is not None:
        content["free_joint"] = _free_joint(found, free)
    return content


def ratios(found: Fitted) -> dict[str, float]:
    """What no scale changes: the force k l, and lengths over the link."""
    n = found.estimate.named
    lengths = {f"{name}_over_l": n[name] / n["l"] for name in LENGTHS if name != "l"}
    return {"k_times_l_N": n["k"] * n["l"], **lengths}


def stroke_stiffness(found: Fitted, free: Free) -> float | None:
    """k that says how much stroke is wanting [N/m]: by displacement, else as fitted; None where the scale is free."""
    if free.stiffness is not None and free.stiffness.value > 0.0:
        return free.stiffness.value
    return None if found.estimate.problem.scale_free else found.estimate.named["k"]


def _free_joint(found: Fitted, free: Free) -> dict[str, Any]:
    s, k, scale = free.stiffness, stroke_stiffness(found, free), free.scale
    return {
        "stops": [
            {
                "side": stop.side, "position_mm": stop.position * 1e3, "leaves_at_deg": math.degrees(stop.leaves),
                "from_deg": math.degrees(stop.first), "to_deg": math.degrees(stop.last), "force_N": stop.force,
                "stroke_wanting_mm": None if k is None else abs(stop.force) / k * 1e3,
            }
            for stop in free.stroke.stops
        ],
        "level_while_sliding_N": free.stroke.level,
        "spread_while_sliding_N": free.stroke.spread,
        "k_by_displacement_N_per_m": None if s is None else {
            "value": s.value, "se": finite(s.error), "trials": s.trials, "bins": s.bins,
        },
        "scale": None if scale is None else {"se": scale.error, "trials": scale.trials},
        "between_bins": _tested(free.bins_differ, free.neighbours, free.boxes),
    }  # fmt: skip


def _tested(test: BinTest | None, pairs: Sequence[BinPair], boxes: Binned) -> dict[str, Any] | None:
    if test is None:
        return None
    middle = np.degrees(boxes.centres)
    neighbours = [
        {"between_deg": [float(middle[k]) for k in pair.places], "mann_whitney": pair.statistic, "p": pair.p,
         "p_holm": pair.p_holm}
        for pair in pairs
    ]  # fmt: skip
    return {"kruskal_wallis": test.statistic, "p": test.p, "bins": test.bins, "counted_visits": test.counted,
            "samples": test.samples, "neighbours": neighbours}  # fmt: skip


def spread_table(recordings: Sequence[ElbowRecording], data: Binned) -> pd.DataFrame:
    """Samples of all trials by bin: counts, mean, SD, quantiles; empty where nothing was recorded."""
    edges = data.visits.edges
    place = np.concatenate([bin_numbers(r.beta, edges) for r in recordings])
    force = np.concatenate([r.force for r in recordings])
    order = np.argsort(place, kind="stable")
    groups = np.split(force[order], np.searchsorted(place[order], np.arange(1, len(edges) - 1)))
    cells = data.cells
    rows = []
    for k, values in enumerate(groups):
        there = len(values) > 0
        q = np.quantile(values, QUANTILES) if there else np.full(len(QUANTILES), np.nan)
        rows.append({
            "beta [deg]": math.degrees(data.centres[k]), "trials": int((cells.place == k).sum()),
            "visits": int((data.visits.place == k).sum()), "samples": len(values),
            "mean [N]": float(values.mean()) if there else np.nan,
            "sd [N]": float(values.std(ddof=1)) if len(values) > 1 else np.nan,
            **{f"{share:.0%} [N]": float(v) for share, v in zip(QUANTILES, q, strict=True)},
        })  # fmt: skip
    return pd.DataFrame(rows)


def _with_fit(table: pd.DataFrame, found: Fitted) -> pd.DataFrame:
    beta, residual = residual_by_bin(found.data, found.estimate)
    off = dict(zip(np.round(np.degrees(beta), 6), residual, strict=True))
    table["residual [N]"] = [off.get(round(value, 6), np.nan) for value in table["beta [deg]"]]
    table["fitted [N]"] = table["mean [N]"] - table["residual [N]"]
    return table


def interval_table(found: Fitted) -> pd.DataFrame:
    """Every number of the law, then ratios where nothing sets the scale, with the intervals there are."""
    told = {each.key: each for each in intervals(found)}
    problem = found.estimate.problem
    source = {name: "recordings and prior" if name in problem.priors else "recordings" for name in problem.names}
    rows = [
        _row(name, TYPED[name], source.get(name, "known beforehand"), value * PER_SI[name], told.pop(name, None))
        for name, value in found.estimate.named.items()
    ]
    return pd.DataFrame(rows + [_row(each.words, each.unit, "recordings", each.value, each) for each in told.values()])


def _row(name: str, unit: str, source: str, value: float, told: Interval | None) -> dict[str, Any]:
    ends = (np.nan, np.nan) if told is None else (
        np.nan if told.lower_open else told.lower, np.nan if told.upper_open else told.upper,
    )  # fmt: skip
    low, high = (np.nan, np.nan) if told is None or told.drawn is None else told.drawn
    return {
        "number": name, "unit": unit, "from": source, "value": value, "profile lower": ends[0],
        "profile upper": ends[1], "profile parts": told.ends if told is not None and len(told.parts) > 1 else np.nan,
        "bootstrap lower": low, "bootstrap upper": high,
    }  # fmt: skip


def line_table(found: Fitted) -> pd.DataFrame:
    """Numbers along the scale and R² of each row."""
    columns = {f"{n} [{TYPED[n]}]": found.line[:, k] * PER_SI[n] for k, n in enumerate(NAMES[:5])}
    return pd.DataFrame({"scale [-]": found.line[:, 3] / found.estimate.theta[3], **columns, "r2 [-]": found.line_r2})


def held_table(found: Fitted) -> pd.DataFrame:
    """R² and RMSE of what was not fitted."""
    columns = ["trial", "r2 [-]", "rmse [N]", "bins"]
    return pd.DataFrame([(h.name, h.r2, h.rmse, h.bins) for h in found.held], columns=columns)


def condition_table(found: Fitted, free: Free) -> pd.DataFrame:
    """Bin means with the joint locked and free."""
    locked, curve = bin_means(found.data), free.stroke.curve
    one = pd.DataFrame({"beta [deg]": np.degrees(locked.beta).round(6), "place": _places(locked.beta, found.data),
                        "locked [N]": locked.force})  # fmt: skip
    other = pd.DataFrame({"place": _places(curve.beta, found.data), "free beta [deg]": np.degrees(curve.beta),
                          "free [N]": curve.force, "displacement [mm]": curve.joint * 1e3})  # fmt: skip
    both = one.merge(other, on="place", how="outer").sort_values("place")
    both["beta [deg]"] = both["beta [deg]"].fillna(both["free beta [deg]"])
    return both[["beta [deg]", "locked [N]", "free [N]", "displacement [mm]"]]


def _places(beta: np.ndarray, data: Binned) -> np.ndarray:
    width = float(data.visits.edges[1] - data.visits.edges[0])
    return np.floor(beta / width).astype(int)


def _over(found: Fitted) -> Over:
    law = found.estimate.problem.law
    order = np.argsort(law.beta)
    return Over(law.beta, found.estimate.problem.force, law.beta[order],
                found.estimate.predicted[order])  # fmt: skip


def _boxes(table: pd.DataFrame, data: Binned) -> Boxes:
    there = table["samples"] > 0
    columns = [f"{share:.0%} [N]" for share in QUANTILES]
    edges = data.visits.edges
    return Boxes(np.radians(table["beta [deg]"][there].to_numpy()), table[columns][there].to_numpy(),
                 float(edges[1] - edges[0]))  # fmt: skip


def _told_figure(found: Fitted) -> Any:
    e = found.estimate
    alone = np.tile(e.theta, (len(found.line), 1))
    alone[:, 0] = found.line[:, 0]
    r2 = np.array([r_squared(e.problem.force, e.problem.law.force(theta)) for theta in alone])
    return told_figure(found.all_directions, found.line, found.line_r2, r2,
                       {each.words: each.profile for each in intervals(found)})  # fmt: skip


def _residual_figure(found: Fitted) -> Any:
    beta, residual = residual_by_bin(found.data, found.estimate)
    standard = standard_residuals(found.data, found.estimate)
    return residual_figure(beta, residual, standard, f"Lilliefors {found.normality.shown}")


def _headline(found: Fitted) -> list[tuple[str, str]]:
    lines = [(each.words, each.shown) for each in intervals(found)]
    return [*lines, ("R² of bin means", f"{found.r2:.3f}")]


def _sentences(found: Fitted, free: Free | None) -> list[str]:
    told = []
    if found.estimate.problem.scale_free:
        r = ratios(found)
        shares = ", ".join(f"{key.replace('_over_', '/')} {value:.3f}" for key, value in r.items() if "over" in key)
        told.append(f"{SCALE_WORDS}. What no scale changes: k l = {r['k_times_l_N']:.4g} N, {shares}.")
    else:
        told.append(_scale_words(found))
    told.append(f"Residuals are {found.normality.words}." if found.normality.p < 0.05 else
                f"Residuals: {found.normality.words}.")  # fmt: skip
    if found.bins_differ is not None:
        b = found.bins_differ
        told.append(
            f"Bins of the box plots differ with p = {b.p:.2g} (Kruskal-Wallis over {b.counted} visits, one for each "
            f"stretch of {found.boxes.stretch:.2g} s in a bin, not {b.samples} samples)."
        )
        middle = np.degrees(found.boxes.centres)
        apart = [f"{middle[a]:.0f}|{middle[b]:.0f}°" for a, b in (
            pair.places for pair in found.neighbours if pair.p_holm < LEVEL)]  # fmt: skip
        told.append(
            f"Neighbouring bins that differ (Mann-Whitney, Holm's correction over {len(found.neighbours)} pairs): "
            f"{', '.join(apart) or 'none'}."
        )
    if free is not None:
        k = stroke_stiffness(found, free)
        for stop in free.stroke.stops:
            side = "lower" if stop.side == "lower" else "raise"
            wanting = "" if k is None else (
                f": {side} that end by {abs(stop.force) / k * 1e3:.1f} mm for k = {k:.4g} N/m"
            )  # fmt: skip
            told.append(
                f"The free joint stands at its {stop.side} end to one side of {math.degrees(stop.leaves):.0f}°, "
                f"under {stop.force:+.1f} N{wanting}."
            )
    return told


def _scale_words(found: Fitted) -> str:
    """What set the scale."""
    scale = found.estimate.problem.scale
    if scale is not None:
        return (
            "The scale of k and the lengths is set by the free joint's displacement, over which d_tot rises one for "
            f"one (SE {scale.error:.2%})."
        )
    return "The scale of k and the lengths is set by what was known beforehand, not by these recordings."
