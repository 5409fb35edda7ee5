"""Stiffness, link and offsets of an exoskeleton: `geocontact elbow fit`, `gc.misalignment.identify`.

>>> import geocontact as gc
>>> trials = gc.misalignment.simulate(rate=20.0, seconds=20.0, trials=2, seed=3).write("trials")
>>> locked = sorted(trials.glob("locked_*.csv"))
>>> known = {"l": gc.mm(169), "z": gc.mm(127)}
>>> result = gc.misalignment.identify(locked, known=known, bootstrap=0)
>>> {name: round(result.numbers[name], 3) for name in ("k", "x", "y")}
{'k': 234.884, 'x': 0.045, 'y': 0.059}
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import as_it_fits, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import write_json
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.misalignment.identify.beside import beside_curves, known_table
from geocontact.analyses.misalignment.identify.curves import (
    Boxes,
    Over,
    condition_curves,
    force_curves,
    identified_curves,
    residual_curves,
)
from geocontact.analyses.misalignment.identify.fitted import (
    Fitted,
    Free,
    ShownInterval,
    fitted,
    free_joint,
    require_bins,
)
from geocontact.analyses.misalignment.identify.numbers import IdentifyInputs, numbers_table, read
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.misalignment.identify.sentences import described, reserve_doubts, say_numbers
from geocontact.analyses.misalignment.identify.show import fit_page
from geocontact.analyses.misalignment.identify.tracking import (
    Performance,
    described_performance,
    performance_of,
    performance_sentences,
    performance_tables,
)
from geocontact.analyses.misalignment.law_numbers import PER_SI, WRITTEN
from geocontact.axis_misalignment.beside_force import Sensors
from geocontact.axis_misalignment.bins import Binned, binned
from geocontact.axis_misalignment.compensation import bin_means
from geocontact.axis_misalignment.law import NAMES, CuffLoads, cuff_loads, offsets_of, yielded
from geocontact.axis_misalignment.least_squares import ElbowFit, ElbowProblem, Prior, estimated, problem_of
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.identify.signals.angle_bins import bin_numbers

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page


QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
QUANTILE_COLUMNS = tuple(f"{share:.0%} [N]" for share in QUANTILES)


def tables_of(found: Fitted, free: Free | None) -> dict[str, pd.DataFrame]:
    """All of them by name; `identifiability` where more than the force was measured, `conditions` and `boxes_free`
    where the joint was free too.
    """
    tables = {
        "intervals": interval_table(found),
        "bins": _with_fit(spread_table(found.recordings, found.data), found),
        "boxes": spread_table(found.recordings, found.boxes),
        "scale_line": line_table(found),
        "held_out": held_table(found),
    }
    if found.beside.sensors:
        tables["identifiability"] = known_table(found.beside)
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


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class IdentifyResult(Result):
    """Stiffness, link and offsets of an exoskeleton, and what these recordings cannot identify.

    Parameters
    ----------
    fit
        What recordings with a locked joint tell.
    free
        What those with a free joint tell; None without.
    summary
        What `elbow.json` holds, with units in the keys.
    performance
        Tracking error and scores beside the force; None without target and scores.
    """

    options: IdentifyOptions
    fit: Fitted
    free: Free | None
    summary: dict[str, Any]
    performance: Performance | None = None

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of the law: k [N/m], x, y, l, z [m], b [N s/m], s [1/Pa], c [m/N].

        Where nothing sets the scale they are one point of the line that fits alike, `scale_line`.
        """
        return self.fit.estimate.named

    def curves(self) -> dict[str, CurveSheet]:
        """`forces`, `identifiability`, `residuals`, `beside_force` with a measured moment or angle of the arm, and
        `conditions` with a free joint.
        """
        f, r = self.fit, self.fit.residuals
        boxes = self._boxes("boxes", f.boxes)
        profiles = {each.words: each.profile for each in f.intervals}
        sheets = {
            "forces": force_curves(self._over(), boxes),
            "identifiability": identified_curves(f.line.numbers, f.line.r2, f.line.alone_r2, profiles),
            "residuals": residual_curves(r.beta, r.off, r.standard, f"Normality: Lilliefors {r.normality.shown}."),
        }
        if f.beside.sensors:
            sheets["beside_force"] = beside_curves(f.beside, f.estimate)
        if self.free is not None:
            free = self._boxes("boxes_free", self.free.boxes)
            sheets["conditions"] = condition_curves(bin_means(f.data), self.free.stroke, boxes, free)
        return sheets

    def tables(self) -> dict[str, pd.DataFrame]:
        """`intervals`, `bins`, `boxes`, `scale_line`, `held_out`, `identifiability` with a measured moment or angle of
        the arm, `tracking`, `tracking_conditions`, `performance` with a target or scores, with a free joint
        `conditions` and `boxes_free`; then `numbers`, all that ran.
        """
        of_task = {} if self.performance is None else performance_tables(self.performance)
        numbers = numbers_table(self.fit, self.free, self.options)
        return tables_of(self.fit, self.free) | of_task | {"numbers": numbers}

    def figure(self, name: str = "forces") -> Figure:
        """One of the figures: force over the angle unless named."""
        sheets = self.curves()
        if name not in sheets:
            raise KeyError(f"no figure {name!r}; there are {', '.join(sheets)}")
        from geocontact.view.curves.drawn import drawn  # late, like all that draws

        return drawn(sheets[name])

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Force over the angle, what the data identify, curves and tables."""
        return {REPORT: fit_page(self.fit, self.free, self.tables(), self.curves())}

    def write_files(self, folder: Path) -> None:
        """elbow.json besides."""
        write_json(folder / "elbow.json", self.summary)
        super().write_files(folder)

    def _over(self) -> Over:
        problem, bins = self.fit.estimate.problem, self.table("bins").dropna(subset="mean [N]")
        middle = np.radians(bins["beta [deg]"].to_numpy())
        measured, predicted = bins["mean [N]"].to_numpy(), bins["fitted [N]"].to_numpy()
        return Over(problem.law.beta, problem.force, middle, measured, predicted)

    def _boxes(self, name: str, data: Binned) -> Boxes:
        table = self.table(name)
        table = table[table["samples"] > 0]
        width = float(data.visits.edges[1] - data.visits.edges[0])
        return Boxes(np.radians(table["beta [deg]"].to_numpy()), table[list(QUANTILE_COLUMNS)].to_numpy(), width)


def run(recorded: IdentifyInputs, o: IdentifyOptions) -> IdentifyResult:
    """The best numbers, their intervals, and what the recordings do not tell."""
    data = binned(recorded.locked, o.bin)
    require_bins(o.recordings, recorded.locked, data)
    free = free_joint(o, recorded.unlocked, data)
    priors = {name: Prior(*pair) for name, pair in (o.prior or {}).items()}
    sensors = Sensors(o.turning, o.alpha_zeroed)
    problem = problem_of(data, recorded.parameters, priors, sensors=sensors)
    if problem.scale_free and free is not None:
        problem = _scaled_by(problem, free)
    found = fitted(recorded.locked, data, estimated(problem), recorded.held_out, o)
    reserve_doubts(found, free)
    say_numbers(found, free)
    of_task = performance_of(
        {"locked": recorded.locked, "held out": recorded.held_out, "free": recorded.unlocked}, recorded.scores
    )
    summary = as_it_fits(described(found, free))
    if of_task is not None:
        summary["performance"] = described_performance(of_task)
        for line in performance_sentences(of_task):
            say(line)
    note("elbow", summary)
    return IdentifyResult(options=o, fit=found, free=free, summary=summary, performance=of_task)


def _scaled_by(problem: ElbowProblem, free: Free) -> ElbowProblem:
    """The problem with the free joint's displacement beside it; as it was where that has no standard error."""
    if free.scale is None:
        reserve("the free joint's displacement sets no scale without a standard error, which takes two free trials")
        return problem
    reserve(
        f"the scale is set by the free joint's displacement (SE {free.scale.error:.2%} over {free.scale.trials} "
        "trials), which supposes the same offsets while the joint was free"
        + ("" if free.rotary_free else ", and no other joint of the device free at the same time (else `rotary_free`)")
    )
    return replace(problem, scale=free.scale)


identify = Job("elbow fit", IdentifyOptions, read, run)
