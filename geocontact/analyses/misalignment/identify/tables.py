"""Tables of an identification; angles in degrees, lengths in mm."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.analyses.misalignment.identify.free_joint import Free
from geocontact.analyses.misalignment.identify.intervals import ShownInterval
from geocontact.analyses.misalignment.law_numbers import PER_SI, WRITTEN
from geocontact.axis_misalignment.bins import Binned
from geocontact.axis_misalignment.end_stop import bin_means
from geocontact.axis_misalignment.fixation import yielded
from geocontact.axis_misalignment.law import NAMES, offsets_of
from geocontact.axis_misalignment.least_squares import ElbowFit
from geocontact.axis_misalignment.transmission import CuffLoads, cuff_loads
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.identify.signals.angle_bins import bin_numbers

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
QUANTILE_COLUMNS = tuple(f"{share:.0%} [N]" for share in QUANTILES)


def tables_of(found: Fitted, free: Free | None) -> dict[str, pd.DataFrame]:
    """All of them by name; `conditions` and `boxes_free` where the joint was free too."""
    tables = {
        "intervals": interval_table(found),
        "bins": _with_fit(spread_table(found.recordings, found.data), found),
        "boxes": spread_table(found.recordings, found.boxes),
        "scale_line": line_table(found),
        "held_out": held_table(found),
    }
    if free is not None:
        tables["conditions"] = condition_table(found, free)
        tables["boxes_free"] = spread_table(free.recordings, free.boxes)
    return tables


def spread_table(recordings: Sequence[ElbowRecording], data: Binned) -> pd.DataFrame:
    """Samples of all trials by bin: counts, mean, SD, quantiles; empty where nothing was recorded."""
    edges = data.visits.edges
    place = np.concatenate([bin_numbers(r.beta, edges) for r in recordings])
    force = np.concatenate([r.force for r in recordings])
    order = np.argsort(place, kind="stable")
    groups = np.split(force[order], np.searchsorted(place[order], np.arange(1, len(edges) - 1)))
    return pd.DataFrame([_spread(k, values, data) for k, values in enumerate(groups)])


def _spread(k: int, values: np.ndarray, data: Binned) -> dict[str, Any]:
    q = np.quantile(values, QUANTILES) if len(values) else np.full(len(QUANTILES), np.nan)
    return {
        "beta [deg]": math.degrees(data.centres[k]),
        "trials": int((data.cells.place == k).sum()),
        "visits": int((data.visits.place == k).sum()),
        "samples": len(values),
        "mean [N]": float(values.mean()) if len(values) else np.nan,
        "sd [N]": float(values.std(ddof=1)) if len(values) > 1 else np.nan,
        **dict(zip(QUANTILE_COLUMNS, map(float, q), strict=True)),
    }


def _with_fit(table: pd.DataFrame, found: Fitted) -> pd.DataFrame:
    r = found.residuals
    off = dict(zip(np.round(np.degrees(r.beta), 6), r.off, strict=True))
    table["residual [N]"] = [off.get(round(value, 6), np.nan) for value in table["beta [deg]"]]
    table["fitted [N]"] = table["mean [N]"] - table["residual [N]"]
    e = found.estimate
    if not e.problem.scale_free:  # a moment is a force times a length, and no length is known then
        there = table["fitted [N]"].notna()
        beta = np.radians(table.loc[there, "beta [deg]"].to_numpy())
        loads = _loads(e, beta, table.loc[there, "fitted [N]"].to_numpy())
        table.loc[there, "gamma [deg]"], table.loc[there, "cuff_moment [N m]"] = np.degrees(loads.gamma), loads.moment
    return table


def _loads(e: ElbowFit, beta: Float[np.ndarray, " b"], force: Float[np.ndarray, " b"]) -> CuffLoads:
    """What the cuff passes to the forearm with these forces, its stiffness against turning left out."""
    numbers = e.named
    rest = yielded(beta, np.zeros(len(beta)), offsets_of(e.theta), numbers["k"], compliance=numbers["c"])
    return cuff_loads(beta, (numbers["l"], numbers["z"]), replace(rest, force=force))


def interval_table(found: Fitted) -> pd.DataFrame:
    """Every number of the law, then ratios where nothing sets the scale, with the intervals there are."""
    told = {each.key: each for each in found.intervals}
    problem = found.estimate.problem
    source = {name: "recordings and prior" if name in problem.priors else "recordings" for name in problem.names}
    rows = [
        _row(name, WRITTEN[name], source.get(name, "known beforehand"), value * PER_SI[name], told.pop(name, None))
        for name, value in found.estimate.named.items()
    ]
    return pd.DataFrame(rows + [_row(each.words, each.unit, "recordings", each.value, each) for each in told.values()])


def _row(name: str, unit: str, source: str, value: float, told: ShownInterval | None) -> dict[str, Any]:
    row: dict[str, Any] = {
        "number": name,
        "unit": unit,
        "from": source,
        "value": value,
        "profile lower": np.nan,
        "profile upper": np.nan,
        "profile parts": np.nan,
        "bootstrap lower": np.nan,
        "bootstrap upper": np.nan,
    }
    if told is not None:
        row["profile lower"] = np.nan if told.lower_open else told.lower
        row["profile upper"] = np.nan if told.upper_open else told.upper
        if len(told.parts) > 1:
            row["profile parts"] = told.ends
        if told.drawn is not None:
            row["bootstrap lower"], row["bootstrap upper"] = told.drawn
    return row


def line_table(found: Fitted) -> pd.DataFrame:
    """Numbers along the scale and R² of each row."""
    line = found.line
    columns = {f"{n} [{WRITTEN[n]}]": line.numbers[:, k] * PER_SI[n] for k, n in enumerate(NAMES[:5])}
    return pd.DataFrame({"scale [-]": line.numbers[:, 3] / found.estimate.theta[3], **columns, "r2 [-]": line.r2})


def held_table(found: Fitted) -> pd.DataFrame:
    """R² and RMSE of what was not fitted."""
    columns = ["trial", "r2 [-]", "rmse [N]", "bins"]
    return pd.DataFrame([(h.name, h.r2, h.rmse, h.bins) for h in found.held], columns=columns)


def condition_table(found: Fitted, free: Free) -> pd.DataFrame:
    """Bin means with the joint locked and free."""
    locked, curve = bin_means(found.data), free.stroke.curve
    one = pd.DataFrame(
        {
            "beta [deg]": np.degrees(locked.beta).round(6),
            "place": _places(locked.beta, found.data),
            "locked [N]": locked.force,
        }
    )
    other = pd.DataFrame(
        {
            "place": _places(curve.beta, found.data),
            "free beta [deg]": np.degrees(curve.beta),
            "free [N]": curve.force,
            "displacement [mm]": curve.joint * 1e3,
        }
    )
    both = one.merge(other, on="place", how="outer").sort_values("place")
    both["beta [deg]"] = both["beta [deg]"].fillna(both["free beta [deg]"])
    return both[["beta [deg]", "locked [N]", "free [N]", "displacement [mm]"]]


def _places(beta: np.ndarray, data: Binned) -> np.ndarray:
    width = float(data.visits.edges[1] - data.visits.edges[0])
    return np.floor(beta / width).astype(int)
