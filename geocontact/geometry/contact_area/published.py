"""A run beside published contact areas: which of them it can be compared with, and why not with the others.

An area that a film or a sensor marks is where surfaces press under a load at a flexion; one within a distance counts
surfaces that need not touch. Only like is compared with like. The distance within which this run's area is as large
as a published one is reported for every row: it is what a calibration of the threshold on that row would give.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from geocontact.data.published_areas import PUBLISHED_AREAS, PublishedArea

NEAR = np.radians(2.5)
"""Flexion up to which a frame counts as at that of a publication [rad]; films are taken every 15° or more."""
ALIKE = 0.1
"""Share by which the load may differ; the area of a Hertzian contact changes by two thirds of that."""
YES, NO = "yes", "no"


@dataclass(frozen=True, eq=False)
class AreasWithin:
    """Areas (t, k) [m^2] within thresholds (k,) [m], which increase."""

    thresholds: Float[np.ndarray, " k"]
    area: Float[np.ndarray, "t k"]


@dataclass(frozen=True, eq=False)
class KneeRun:
    """What a run knows of its frames.

    Parameters
    ----------
    flexion
        [rad]; None where it is not known.
    load
        Force on the layer [N]; None where nothing is pressed.
    pressed
        Area under pressure by side [m^2]; empty where nothing is pressed.
    within
        Areas within distances by side; empty where none were computed.
    swept
        Whether an angle is prescribed; else it is a recorded motion.
    """

    flexion: Float[np.ndarray, " t"] | None = None
    load: Float[np.ndarray, " t"] | None = None
    pressed: Mapping[str, Float[np.ndarray, " t"]] = field(default_factory=dict)
    within: Mapping[str, AreasWithin] = field(default_factory=dict)
    swept: bool = False


def beside_published(run: KneeRun, rows: Sequence[PublishedArea] = PUBLISHED_AREAS) -> pd.DataFrame:
    """A row for each published area.

    Returns
    -------
    DataFrame
        The publication; "ours [mm^2]", the mean over the frames that are comparable, or the peak where the published
        number is one; "difference [mm^2]" and "relative [-]" from the nearest end of the published range, 0 within it;
        "comparable" and "why" not; "threshold_least [mm]" and "threshold_most [mm]", within which the area of frames at
        that flexion is as large as the ends of the range, least and most of these frames. Empty without a number.
    """
    return pd.DataFrame([_row(run, row) for row in rows])


def _row(run: KneeRun, row: PublishedArea) -> dict[str, object]:
    why, ours = _ours(run, row)
    off = np.nan if why else _beyond(ours, row)
    end = row.most if off > 0.0 else row.least
    relative = off / end if off and not why else off
    low, high = _thresholds(run, row)
    return {
        "published": row.name,
        "knee": row.knee,
        "basis": row.basis,
        "method": row.method,
        "side": row.side,
        "flexion [deg]": "" if row.flexion is None else _span(*np.degrees(row.flexion)),
        "load [N]": np.nan if row.load is None else row.load,
        "area_least [mm^2]": row.least * 1e6,
        "area_most [mm^2]": row.most * 1e6 if np.isfinite(row.most) else np.nan,
        "sd [mm^2]": np.nan if row.sd is None else row.sd * 1e6,
        "ours [mm^2]": np.nan if why else ours * 1e6,
        "difference [mm^2]": off * 1e6,
        "relative [-]": relative,
        "comparable": NO if why else YES,
        "why": why,
        "threshold_least [mm]": low * 1e3,
        "threshold_most [mm]": high * 1e3,
        "citation": row.citation,
        "doi": row.doi,
        "read_in": row.read_in,
    }


def _ours(run: KneeRun, row: PublishedArea) -> tuple[str, float]:
    """Why the row cannot be compared with the run, or an empty text and this run's area [m^2]."""
    if row.basis == "within a distance":
        return _ours_within(run, row)
    if not run.pressed:
        return f"{row.basis}; this run counts a distance and presses nothing", np.nan
    if row.knee != "total knee implant":
        return f"it is of a {row.knee}", np.nan
    if row.flexion is None or row.load is None:
        return "its load and flexion were not read", np.nan
    if run.flexion is None:
        return "the flexion of this run is not known", np.nan
    at = _frames(run.flexion, row)
    if not at.any():
        reach = _span(*np.degrees([run.flexion.min(), run.flexion.max()]))
        return f"this run flexes by {reach}°, not by {_span(*np.degrees(row.flexion))}°", np.nan
    load = np.zeros(0) if run.load is None else run.load[at]
    alike = np.abs(load / row.load - 1.0) <= ALIKE
    if not alike.any():
        return f"its load is {row.load:.0f} N, that of this run {_span(load.min(), load.max(), '.0f')} N there", np.nan
    area = run.pressed.get(row.side)
    if area is None:
        return f"this run has no {row.side} side", np.nan
    return "", float(area[at][alike].mean())


def _ours_within(run: KneeRun, row: PublishedArea) -> tuple[str, float]:
    """The peak over the motion within the threshold of the row."""
    if row.side not in run.within or row.threshold is None:
        return "it counts a distance, this run does not", np.nan
    if run.swept:
        return "it is the peak of a walk, this run sweeps an angle", np.nan
    known = run.within[row.side]
    same = np.isclose(known.thresholds, row.threshold, rtol=1e-9, atol=1e-12)
    if not same.any():
        return f"its threshold, {row.threshold * 1e3:g} mm, was not evaluated", np.nan
    return "", float(known.area[:, same].max())


def _beyond(ours: float, row: PublishedArea) -> float:
    """How far an area is beyond the published range [m^2]; 0 within it."""
    return max(ours - row.most, 0.0) + min(ours - row.least, 0.0)


def _frames(flexion: Float[np.ndarray, " t"], row: PublishedArea) -> Bool[np.ndarray, " t"]:
    """Frames at the flexion of the row."""
    low, high = (0.0, 0.0) if row.flexion is None else row.flexion
    return np.asarray((flexion >= low - NEAR) & (flexion <= high + NEAR))


def _thresholds(run: KneeRun, row: PublishedArea) -> tuple[float, float]:
    """Distances [m] within which this run's area is as large as the ends of the row; NaN where none is."""
    known = run.within.get(row.side)
    if known is None:
        return np.nan, np.nan
    areas = known.area
    if row.flexion is None:
        curves = areas.max(axis=0, keepdims=True) if row.basis == "within a distance" else areas[:0]
    else:
        curves = areas[:0] if run.flexion is None else areas[_frames(run.flexion, row)]
    ends = [[_distance(known.thresholds, curve, area) for area in (row.least, row.most)] for curve in curves]
    low, high = np.array(ends).reshape(-1, 2).T
    least = float(np.nanmin(low)) if np.isfinite(low).any() else np.nan
    return least, float(np.nanmax(high)) if np.isfinite(high).any() else np.nan


def _distance(thresholds: Float[np.ndarray, " k"], curve: Float[np.ndarray, " k"], area: float) -> float:
    """Threshold [m] with this area, linear between those evaluated; NaN outside of them."""
    if not 0.0 < area < np.inf or not curve[0] <= area <= curve[-1]:
        return np.nan
    k = int(np.searchsorted(curve, area))
    if k == 0:
        return float(thresholds[0])
    share = (area - curve[k - 1]) / (curve[k] - curve[k - 1])
    return float(thresholds[k - 1] + share * (thresholds[k] - thresholds[k - 1]))


def _span(low: float, high: float, form: str = ".3g") -> str:
    """Two ends in words, once where they are written alike."""
    first, last = format(low, form), format(high, form)
    return first if first == last else f"{first} … {last}"


def published_sentences(rows: pd.DataFrame) -> list[str]:
    """What is to be said: rows that are comparable, why the others are not, and the thresholds that they would give."""
    said = []
    for row in rows[rows["comparable"] == YES].to_dict(orient="records"):
        off = row["difference [mm^2]"]
        verdict = "within it" if off == 0.0 else f"{abs(off):.1f} mm^2 {'above' if off > 0.0 else 'below'} it"
        said.append(
            f"{row['published']}: {_published(row)} mm^2 published, {row['ours [mm^2]']:.1f} mm^2 here, {verdict}"
        )
    others = rows[rows["comparable"] == NO]
    if len(others):
        why = "; ".join(f"{len(own)}: {reason}" for reason, own in others.groupby("why", sort=False))
        said.append(f"{len(others)} of {len(rows)} published areas are not comparable ({why})")
    for knee, own in rows.groupby("knee", sort=False):
        ends = own[own["basis"] != "within a distance"][["threshold_least [mm]", "threshold_most [mm]"]].to_numpy(float)
        if np.isfinite(ends).any():
            span = _span(np.nanmin(ends), np.nanmax(ends), ".2g")
            said.append(f"areas measured or computed of a {knee} would need a threshold of {span} mm here")
    return said


def _published(row: Mapping[Hashable, object]) -> str:
    least, most = (float(str(row[f"area_{end} [mm^2]"])) for end in ("least", "most"))
    if np.isnan(most):
        return f"{least:.0f} or more"
    return f"up to {most:.0f}" if least == 0.0 else _span(least, most, ".0f")
